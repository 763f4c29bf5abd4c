//! Snakemake: a rule that makes a chunk of runs, and one that collects their results.

use super::{Export, Written, absolute, quote, shell, shell_with};
use crate::Error;
use crate::study::spec::DesignSpec;
use std::path::{Path, PathBuf};

/// Writes a `Snakefile` and returns the command that starts it.
pub(super) fn write(export: &Export<'_>) -> Result<Written, Error> {
    let out = absolute(&export.plan.out);
    let tasks = export.tasks().len();
    let (count, chunk) = (export.plan.count(), export.chunk);
    // Snakemake formats commands and paths, so that literal braces are doubled.
    let escaped = |text: String| text.replace('{', "{{").replace('}', "}}");
    // A control character, which no other argument contains, is the placeholder for the numbers of
    // the runs.
    let point = shell_with(&export.call("point", &["\u{1}"])?, "\u{1}", "\u{1}");
    let point = escaped(point).replace('\u{1}', "{params.runs}");
    let collect = escaped(shell(&export.call("collect", &[])?));
    // A string literal of JSON is also one of Python.
    let python = |text: &str| serde_json::Value::from(text).to_string();
    let (point, collect, folder) = (python(&point), python(&collect), python(&out));
    // If one of these files has changed, Snakemake runs the rule again, which then skips existing
    // runs.
    let mut inputs = vec![export.plan.file.clone(), export.plan.launcher.case.clone()];
    if let DesignSpec::Table { file } = &export.plan.design {
        let beside = export.plan.file.parent().unwrap_or(Path::new(""));
        inputs.push(beside.join(file));
    }
    let input = |path: &PathBuf| python(&absolute(path).replace('{', "{{").replace('}', "}}"));
    let inputs: Vec<String> = inputs.iter().map(input).collect();
    let inputs = inputs.join(", ");
    let text = format!(
        "# {count} runs in {tasks} tasks of {chunk}; written by fretwork study export --to snakemake.\n\
         OUT = {folder}\n\
         TASKS, CHUNK, COUNT = {tasks}, {chunk}, {count}\n\n\
         def runs(wildcards):\n    \
             last = int(wildcards.task) * CHUNK\n    \
             return f\"{{last - CHUNK + 1}}-{{min(last, COUNT)}}\"\n\n\
         rule all:\n    \
             input: OUT + \"/table.csv\"\n\n\
         rule point:\n    \
             input: {inputs}\n    \
             output: touch(OUT + \"/tasks/{{task}}.done\")\n    \
             params: runs=runs\n    \
             threads: {}\n    \
             shell: {point}\n\n\
         rule collect:\n    \
             input: expand(OUT + \"/tasks/{{task}}.done\", task=range(1, TASKS + 1))\n    \
             output: OUT + \"/table.csv\"\n    \
             shell: {collect}\n",
        export.plan.launcher.threads
    );
    let file = export.put("Snakefile", &text)?;
    Ok(Written {
        start: format!(
            "snakemake --cores all --keep-going --snakefile {} --directory {}",
            quote(&absolute(&file)),
            quote(&out)
        ),
        files: vec![file],
    })
}
