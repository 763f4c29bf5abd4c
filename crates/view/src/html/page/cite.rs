//! Provenance of the numbers, and how to cite them.

use super::results::clock;
use super::{escape, hash};
use crate::html::folder::RunFolder;
use crate::html::laws::{LawInfo, LoadedLaw};
use serde_json::Value;

/// Table of the provenance: version, identity, seed, steps.
pub(crate) fn provenance(run: &RunFolder) -> String {
    let s = &run.summary;
    let mut rows: Vec<(&str, String)> = vec![
        ("Program", format!("fretwork {}", escape(&run.version))),
        ("Case", escape(&run.title)),
    ];
    let number = |key: &str| s[key].as_u64().map(|n| n.to_string());
    if let Some(identity) = s["identity"].as_str() {
        rows.push(("Identity", format!("{} <span class=\"meaning\">of case, materials, laws and scene; the same on every machine</span>", hash(identity))));
    }
    rows.extend(number("seed").map(|n| ("Seed", n)));
    rows.push(("Dimension", run.dimension().to_string()));
    rows.extend(number("threads").map(|n| {
        (
            "Threads",
            format!("{n} <span class=\"meaning\">results are bit-identical for any number</span>"),
        )
    }));
    if let (Some(steps), Some(time)) = (number("steps"), s["time"].as_f64()) {
        rows.push((
            "Steps",
            format!(
                "{steps}, to t = {}",
                escape(&crate::html::results::quantity(time, "s"))
            ),
        ));
    }
    if let Some(wall) = s["wall_seconds"].as_f64() {
        let cpu = s["cpu_seconds"]
            .as_f64()
            .map(|c| format!(", processor time {c:.1} s"));
        rows.push((
            "Wall time",
            format!("{wall:.1} s{}", cpu.unwrap_or_default()),
        ));
    }
    if let Some(method) = s["solver"]["method"].as_str() {
        let mean = s["solver"]["iterations_mean"]
            .as_f64()
            .map(|x| format!(", {x:.0} iterations a step"));
        rows.push(("Solver", escape(method) + &mean.unwrap_or_default()));
    }
    if let Value::String(why) = &s["stopped"] {
        rows.push(("Stopped", escape(why)));
    }
    let rows: String = rows
        .iter()
        .map(|(k, v)| {
            format!(
                "<tr{}><th scope=\"row\">{k}</th><td>{v}</td></tr>\n",
                clock(matches!(*k, "Threads" | "Wall time"))
            )
        })
        .collect();
    format!("<div class=\"scroll\"><table class=\"facts\"><tbody>\n{rows}</tbody></table></div>\n")
}

/// A text inside braces of BibTeX.
fn bibtex(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '{' | '}' | '\\' => {}
            '&' | '%' | '$' | '#' | '_' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// BibTeX entries for the program and the run, and the references of the laws.
pub(crate) fn cite(
    run: &RunFolder,
    laws: &[LoadedLaw],
    law: &dyn Fn(&str, &str) -> Option<LawInfo>,
) -> String {
    let version = bibtex(&run.version);
    let key: String = version
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    let identity = run.summary["identity"].as_str().unwrap_or_default();
    let run_of = match identity.is_empty() {
        true => format!("case `{}'", bibtex(&run.title)),
        false => format!(
            "case `{}', identity {}",
            bibtex(&run.title),
            bibtex(identity)
        ),
    };
    let entry = format!(
        "@software{{fretwork_{key},\n  title   = {{Fretwork: tribology of dry contacts by non-smooth contact dynamics}},\n  \
         author  = {{{{The Fretwork authors}}}},\n  version = {{{version}}},\n  note    = {{{run_of}}},\n}}"
    );
    let mut out = format!(
        "<p>Cite the program with its version, and the identity of the run:</p>\n<pre class=\"bibtex\" tabindex=\"0\">{}</pre>\n",
        escape(&entry)
    );
    let mut references: Vec<(String, String)> = Vec::new();
    for l in laws {
        if let Some(info) = law(&l.kind, &l.name).filter(|i| !i.reference.is_empty()) {
            references.push((format!("{}/{}", l.kind, l.name), info.reference));
        }
    }
    references.dedup();
    if !references.is_empty() {
        out += "<p>And the publications of its laws:</p>\n<ul>\n";
        for (name, reference) in references {
            out += &format!(
                "<li><strong>{}</strong>: {}</li>\n",
                escape(&name),
                escape(&reference)
            );
        }
        out += "</ul>\n";
    }
    out
}
