//! The outside of the engine: model files in, tables out.
