//! `holonom examples`.

use std::io::Write;
use std::process::ExitCode;

use crate::failure::Failure;
use crate::folder::Folder;
use crate::load::EXAMPLES;
use crate::options::ExamplesArguments;
use crate::table::list;

/// Lists the gallery, shows one of its files, or copies it.
pub fn examples(arguments: &ExamplesArguments) -> Result<ExitCode, Failure> {
    let Some(name) = &arguments.name else {
        let items: Vec<(&str, String)> = EXAMPLES.iter().map(|(name, text)| (*name, first_words(text))).collect();
        println!("{}\n\nrun one with `holonom run example:NAME`", list(&items));
        return Ok(ExitCode::SUCCESS);
    };
    let text = crate::load::example(name)?;
    match &arguments.copy {
        None => print!("{text}"),
        Some(folder) => {
            let folder = Folder::create(folder)?;
            let file = format!("{name}.toml");
            folder.write(&file, |out| out.write_all(text.as_bytes()))?;
            println!("wrote {}", folder.path.join(file).display());
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The title of a model file.
fn first_words(text: &str) -> String {
    let title = text.lines().find_map(|line| line.strip_prefix("title = "));
    title.unwrap_or("").trim_matches('"').to_string()
}
