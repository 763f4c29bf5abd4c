//! Parameters of laws that a material file gives with a range: what a run was given beside what
//! came out, and the factors of a study over the ranges.

use super::case::{Case, InterfaceSpec};
use super::material::{InterfaceParameters, Material, Sourced};
use super::source::Source;
use super::{units, wear_coefficient};
use fretwork_core::laws::{Interface, Kind};
use serde::Serialize;

/// A parameter of a law with its value, and the range in its source.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GivenRange {
    /// Name of the file of the value, without `.ron`.
    pub file: String,
    /// Kind of the law.
    pub kind: String,
    /// The law.
    pub law: String,
    /// The parameter.
    pub parameter: String,
    /// Value in the unit of the law.
    pub value: f64,
    /// Smallest and largest value in its source.
    pub range: [f64; 2],
    /// Unit of the law.
    pub unit: String,
    /// Source of the value.
    pub source: String,
    /// Keys of the case that would replace the value, one of each interface that uses it.
    pub keys: Vec<String>,
}

/// Returns the parameters of the laws of a case that come from a file with a range, each once; the
/// case itself gives none of them. `files` are the names and texts that were read, `laws` the
/// interfaces that were built.
pub fn given_ranges(
    case: &Case,
    files: &[(String, String)],
    laws: &[Interface],
) -> Vec<GivenRange> {
    let mut out: Vec<GivenRange> = Vec::new();
    for spec in &case.interfaces {
        let read = |name: &str| files.iter().find(|f| f.0 == name).map(|f| f.1.clone());
        let Some((file, parameters)) = parameters_of(case, spec, read) else {
            continue;
        };
        let built = laws.iter().find(|law| law.name == spec.name);
        for (kind, given) in parameters.slots.iter() {
            let Some(law) = spec.law(kind) else { continue };
            let numbers = given.get(law).into_iter().flatten();
            for (name, number) in numbers {
                let found = resolved(spec, kind, (name, number), built);
                let Some((value, range, unit)) = found else {
                    continue;
                };
                let key = format!("interfaces.{}.parameters.{kind}.{name}", spec.name);
                let same = |g: &&mut GivenRange| {
                    g.file == file && g.kind == kind.word() && g.law == law && g.parameter == *name
                };
                match out.iter_mut().find(same) {
                    Some(known) => known.keys.push(key),
                    None => out.push(GivenRange {
                        file: file.clone(),
                        kind: kind.word().to_owned(),
                        law: law.to_owned(),
                        parameter: name.clone(),
                        value,
                        range,
                        unit,
                        source: number.source.clone(),
                        keys: vec![key],
                    }),
                }
            }
        }
    }
    out
}

/// Returns the name and the parameters of the file from which an interface takes them; `read` gives
/// the text of a file by its name.
pub(super) fn parameters_of(
    case: &Case,
    spec: &InterfaceSpec,
    read: impl Fn(&str) -> Option<String>,
) -> Option<(String, InterfaceParameters)> {
    let name = spec.parameters_from.as_ref()?;
    let of_material = case.materials.get(name);
    let file = of_material.unwrap_or(name);
    let text = read(file)?;
    let source = Source::from_text(format!("{file}.ron"), text);
    let parameters = match of_material {
        Some(_) => source.parse::<Material>().ok()?.laws?,
        None => source.parse().ok()?,
    };
    Some((file.clone(), parameters))
}

/// Returns value, range and unit of a number of a file that an interface uses; `None` where the
/// case gives it, or the file has no range.
fn resolved(
    spec: &InterfaceSpec,
    kind: Kind,
    (name, number): (&str, &Sourced),
    built: Option<&Interface>,
) -> Option<(f64, [f64; 2], String)> {
    let range = number.range?;
    let own = spec.parameters.get(kind);
    // Archard's K and the coefficient that follows from it replace each other.
    let replaced = |own: &std::collections::BTreeMap<String, _>| {
        own.contains_key(name) || (name == wear_coefficient::NAME && !own.is_empty())
    };
    if own.is_some_and(replaced) {
        return None;
    }
    let mut loaded = built?.loaded();
    let plugin = &loaded.find(|l| l.plugin.kind == kind)?.plugin;
    let field = plugin.parameters.iter().find(|p| p.name == name);
    let unit = field.map_or("", |p| p.unit.as_str());
    let convert = |x: f64| units::convert(x, &number.unit, unit).ok();
    let range = [convert(range.0)?, convert(range.1)?];
    Some((convert(number.value)?, range, unit.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_contains_its_value() {
        let parse = |range: &str| {
            let text = format!(
                "(contact: {{\"coulomb\": {{\"mu\": (value: 0.4, range: {range}, source: \"s\")}}}})"
            );
            let source = Source::from_text("laws.ron", text.as_str());
            let parameters: InterfaceParameters = source.parse().unwrap();
            parameters.units()
        };
        assert!(parse("(0.4, 0.7)").is_ok());
        for wrong in ["(0.5, 0.7)", "(0.7, 0.1)"] {
            let fault = parse(wrong).unwrap_err();
            assert!(fault.path.ends_with("mu.range"), "{}", fault.path);
        }
    }
}
