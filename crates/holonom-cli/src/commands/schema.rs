//! `holonom schema`.

use std::process::ExitCode;

use crate::failure::Failure;

/// Prints the JSON Schema of the model file, from the tables that read it.
pub fn schema() -> Result<ExitCode, Failure> {
    let schema = holonom_io::to_json(&holonom::model::schema());
    println!("{}", serde_json::to_string_pretty(&schema).expect("a schema is plain data"));
    Ok(ExitCode::SUCCESS)
}
