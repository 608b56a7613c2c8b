//! One file a command.

pub mod check;
pub mod compare;
pub mod completions;
pub mod examples;
pub mod methods;
pub mod modes;
pub mod run;
pub mod schema;
pub mod stability;
pub mod sweep;
pub mod view;
