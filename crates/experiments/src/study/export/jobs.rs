//! A list of commands.

use super::{Export, Written, absolute, quote, shell};
use crate::Error;

pub(super) fn write(export: &Export<'_>) -> Result<Written, Error> {
    let mut text = String::new();
    for (first, last) in export.tasks() {
        let range = range(first, last);
        text += &shell(&export.call("point", &[&range])?);
        text.push('\n');
    }
    let file = export.put("jobs.txt", &text)?;
    let name = quote(&absolute(&file));
    let collect = shell(&export.call("collect", &[])?);
    Ok(Written {
        start: format!(
            "xargs -P 2 -d '\\n' -n 1 sh -c < {name}; {collect}\n  or: parallel < {name}; {collect}"
        ),
        files: vec![file],
    })
}

/// Formats runs as `study point` takes them.
pub(super) fn range(first: usize, last: usize) -> String {
    match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    }
}
