//! Columns that are asked for by name.

use holonom::model::nearest_few;
use holonom::record::Recording;

use crate::failure::Failure;

/// Near names that are told, or columns where none is near.
const NEAR: usize = 3;
const SHOWN: usize = 25;

/// The column of the size of a force or a moment, where that is asked for in words.
fn size(name: &str) -> Option<String> {
    let (owner, what) = name.rsplit_once('.')?;
    let letter = match what {
        "force" | "reaction" | "magnitude" => "f",
        "moment" | "torque" => "t",
        _ => return None,
    };
    Some(format!("{owner}.{letter}"))
}

/// Refuses a column that a recording does not have.
pub fn unknown(name: &str, recording: &Recording) -> Failure {
    let all = || recording.columns().iter().map(|column| column.heading.name.as_str());
    let near = match size(name).filter(|size| recording.place(size).is_some()) {
        Some(size) => vec![format!("`{size}`, its size")],
        None => nearest_few(name, all(), NEAR).into_iter().map(|near| format!("`{near}`")).collect(),
    };
    let cure = match near.split_last() {
        Some((last, [])) => format!("did you mean {last}?"),
        Some((last, others)) => format!("did you mean {} or {last}?", others.join(", ")),
        None => {
            let more = if all().count() > SHOWN { ", and more: columns.json of a run has all" } else { "" };
            format!("take some of: {}{more}", all().take(SHOWN).collect::<Vec<_>>().join(", "))
        }
    };
    Failure::usage(format!("there is no column `{name}`"), cure)
}
