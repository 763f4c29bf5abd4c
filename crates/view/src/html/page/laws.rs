//! Materials with sources, and interfaces and laws with their parameters and libraries.

use super::{escape, hash, table};
use crate::html::laws::{Interface, LoadedLaw};
use crate::html::materials::Files;
use crate::html::results::number;

/// Table of the materials, each number with its source.
pub(crate) fn materials(files: &Files) -> String {
    let mut rows = String::new();
    for (name, material) in &files.materials {
        let numbers = std::iter::once(("density", &material.density));
        let numbers = numbers.chain(material.properties.iter().map(|(k, v)| (k.as_str(), v)));
        let count = numbers.clone().count();
        for (k, (property, value)) in numbers.enumerate() {
            let head = match k {
                0 => format!(
                    "<th scope=\"rowgroup\" rowspan=\"{count}\">{}<br><span class=\"meaning\">{}</span></th>",
                    escape(name),
                    escape(&material.doc)
                ),
                _ => String::new(),
            };
            let unit = match (property, value.unit.as_str()) {
                ("density", "") => "kg/m^3",
                (_, unit) => unit,
            };
            rows += &format!(
                "<tr>{head}<td>{}</td><td class=\"value\">{} {}</td><td class=\"meaning\">{}</td></tr>\n",
                escape(property),
                number(value.value),
                escape(unit),
                escape(&value.source)
            );
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let heads = ["Material", "Property", "Value", "Source"];
    format!(
        "<h3>Materials</h3>\n{}",
        table("", "Materials", &heads, &rows)
    )
}

/// Table of the interfaces with the parameters of their laws.
pub(crate) fn interfaces(interfaces: &[Interface]) -> String {
    let mut out = String::new();
    for interface in interfaces {
        let laws: Vec<String> = interface
            .laws
            .iter()
            .map(|l| format!("{} <strong>{}</strong>", escape(&l.kind), escape(&l.name)))
            .collect();
        let mut rows = String::new();
        for law in &interface.laws {
            for [name, value, unit, from, doc] in &law.parameters {
                rows += &format!(
                    "<tr><td>{}/{}</td><td title=\"{}\"><code>{}</code></td><td class=\"value\">{} {}</td><td class=\"meaning\">{}</td></tr>\n",
                    escape(&law.kind),
                    escape(&law.name),
                    escape(doc),
                    escape(name),
                    escape(value),
                    escape(unit),
                    escape(from)
                );
            }
        }
        let table = match rows.is_empty() {
            true => String::new(),
            false => {
                let heads = ["Law", "Parameter", "Value", "Where it comes from"];
                table("", "Parameters", &heads, &rows)
            }
        };
        out += &format!(
            "<details><summary><strong>{}</strong>, between {} and {}: {}</summary>\n{table}</details>\n",
            escape(&interface.name),
            escape(&interface.between[0]),
            escape(&interface.between[1]),
            laws.join(", ")
        );
    }
    if out.is_empty() {
        out
    } else {
        format!("<h3>Interfaces</h3>\n{out}")
    }
}

/// The libraries of the laws.
pub(crate) fn libraries(laws: &[LoadedLaw]) -> String {
    if laws.is_empty() {
        return String::new();
    }
    let row = |l: &LoadedLaw| {
        let certified = match l.certified {
            Some(true) => "yes",
            Some(false) => "<strong class=\"bad-text\">no</strong>",
            None => "not known",
        };
        format!(
            "<tr><td>{}</td><th scope=\"row\">{}</th><td>{}</td><td>{certified}</td><td>{}</td></tr>\n",
            escape(&l.kind),
            escape(&l.name),
            escape(&l.version),
            hash(&l.sha256)
        )
    };
    let rows: String = laws.iter().map(row).collect();
    let heads = [
        "Kind",
        "Law",
        "Version",
        "Certified",
        "SHA-256 of its library",
    ];
    format!("<h3>Laws</h3>\n{}", table("", "Laws", &heads, &rows))
}
