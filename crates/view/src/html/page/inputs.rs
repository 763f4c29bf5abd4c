//! The table of all inputs of a case, and that of inputs that differ between runs.

use super::{escape, table};
use crate::html::folder::RunFolder;
use fretwork_scene::inputs::{Input, InputSource, of};
use std::collections::BTreeMap;

/// Table of all inputs of a run, with a search field.
pub(crate) fn html(run: &RunFolder) -> String {
    let inputs = match of(&run.case_text) {
        Ok(inputs) => inputs,
        Err(reason) => {
            return format!(
                "<p>The inputs cannot be listed: this version does not read the case ({}). Its text stands below.</p>\n{}",
                escape(&reason),
                text(run)
            );
        }
    };
    let row = |i: &Input| {
        let (class, from) = match i.from {
            InputSource::Given => ("given", "given"),
            InputSource::Default => ("default", "default"),
            InputSource::NotSet => ("unset", "not set"),
        };
        format!(
            "<tr class=\"{class}\"><th scope=\"row\"><code>{}</code></th><td>{}</td><td>{}</td><td>{from}</td></tr>\n",
            escape(&i.path),
            escape(&i.value),
            escape(i.unit)
        )
    };
    let rows: String = inputs.iter().map(row).collect();
    let given = inputs
        .iter()
        .filter(|i| i.from == InputSource::Given)
        .count();
    format!(
        "<p class=\"lead\">{given} of {} keys are given by the case, the others are defaults or not set. Any of them changes with \
         <code>--set KEY=VALUE</code>. Units are SI; texts and pure numbers have none. Where each parameter of the laws came from \
         (case, material with its source, default of the law): <code>fretwork check CASE --inputs</code>.</p>\n\
         <div class=\"tools\"><label class=\"search\">Search <input type=\"search\" data-filters=\"inputs-table\" \
         placeholder=\"solver, young, 0.5 ...\"></label>\n\
         <label><input type=\"checkbox\" data-hides=\"inputs-table\" data-class=\"given\"> only what is given</label></div>\n\
         <div class=\"tall\">{}</div>\n{}",
        inputs.len(),
        table(
            " id=\"inputs-table\"",
            "Inputs",
            &["Key", "Value", "Unit", "Origin"],
            &rows
        ),
        text(run)
    )
}

/// The text of the case, folded.
fn text(run: &RunFolder) -> String {
    format!(
        "<details><summary>The case as it was run</summary>\n<pre class=\"case\" tabindex=\"0\">{}</pre></details>\n",
        escape(&run.case_text)
    )
}

/// Inputs of several runs.
struct InputsOfRuns {
    /// Paths in their order.
    paths: Vec<String>,
    /// Inputs of each run, by path.
    values: Vec<BTreeMap<String, Input>>,
}

impl InputsOfRuns {
    fn of(runs: &[RunFolder]) -> Self {
        let mut paths: Vec<String> = Vec::new();
        let mut values: Vec<BTreeMap<String, Input>> = Vec::new();
        for run in runs {
            let mut own = BTreeMap::new();
            for input in of(&run.case_text).unwrap_or_default() {
                if !paths.contains(&input.path) {
                    paths.push(input.path.clone());
                }
                own.insert(input.path.clone(), input);
            }
            values.push(own);
        }
        Self { paths, values }
    }

    /// Returns an input of a run as text; empty where it is not set.
    fn shown(&self, run: usize, path: &str) -> String {
        let input = self.values[run].get(path);
        input.map(|i| i.value.clone()).unwrap_or_default()
    }

    /// Returns the paths of those that differ.
    fn differing(&self) -> impl Iterator<Item = &String> {
        let differs = |path: &&String| {
            (1..self.values.len()).any(|k| self.shown(k, path) != self.shown(0, path))
        };
        self.paths.iter().filter(differs)
    }
}

/// Returns the paths of the inputs that differ between runs.
pub(crate) fn differing(runs: &[RunFolder]) -> Vec<String> {
    InputsOfRuns::of(runs).differing().cloned().collect()
}

/// Table of the inputs that differ between runs, one column per run.
pub(crate) fn difference_table(runs: &[RunFolder], names: &[String]) -> String {
    let inputs = InputsOfRuns::of(runs);
    let mut rows = String::new();
    for path in inputs.differing() {
        let unit = inputs
            .values
            .iter()
            .find_map(|v| v.get(path.as_str()))
            .map_or("", |i| i.unit);
        rows += &format!(
            "<tr><th scope=\"row\"><code>{}</code></th><td>{}</td>",
            escape(path),
            escape(unit)
        );
        for k in 0..runs.len() {
            let value = inputs.shown(k, path);
            let value = if value.is_empty() {
                "not set".to_owned()
            } else {
                value
            };
            rows += &format!("<td>{}</td>", escape(&value));
        }
        rows += "</tr>\n";
    }
    if rows.is_empty() {
        return "<p>All inputs are the same.</p>\n".to_owned();
    }
    let fixed = ["Key", "Unit"].into_iter();
    let heads: Vec<&str> = fixed.chain(names.iter().map(String::as_str)).collect();
    table(" id=\"differences\"", "Inputs that differ", &heads, &rows)
}
