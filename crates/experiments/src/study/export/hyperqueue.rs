//! HyperQueue: a job file with one task for each chunk of runs.

use super::jobs::range;
use super::{Export, Written, absolute, quote, shell};
use crate::Error;
use std::fmt::Write as _;

pub(super) fn write(export: &Export<'_>) -> Result<Written, Error> {
    let logs = absolute(&export.logs()?);
    let mut text = format!(
        "# {} runs; written by fretwork study export --to hq.\nname = {}\nmax_fails = 1000000\n",
        export.plan.count(),
        toml(&export.name())
    );
    for (k, (first, last)) in export.tasks().into_iter().enumerate() {
        let words = export.call("point", &[&range(first, last)])?;
        let words: Vec<String> = words.iter().map(|w| toml(w)).collect();
        let _ = write!(
            text,
            "\n[[task]]\nid = {}\nstdout = {}\nstderr = {}\ncommand = [{}]\n[[task.request]]\nresources = {{ \"cpus\" = {} }}\n",
            k + 1,
            toml(&format!("{logs}/hq-{}.log", k + 1)),
            toml(&format!("{logs}/hq-{}.err", k + 1)),
            words.join(", "),
            export.plan.launcher.threads
        );
    }
    let file = export.put("study.hq.toml", &text)?;
    let submit = format!("hq job submit-file {}", quote(&absolute(&file)));
    Ok(Written {
        start: format!(
            "{submit}; hq job wait last; {}",
            shell(&export.call("collect", &[])?)
        ),
        files: vec![file],
    })
}

/// A text in TOML.
fn toml(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
