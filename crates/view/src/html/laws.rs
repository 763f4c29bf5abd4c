//! Laws of a run: the loaded libraries, and the parameters in use.

use crate::html::folder::RunFolder;
use crate::html::materials::Files;
use fretwork_scene::Case;
use fretwork_scene::material::Sourced;
use fretwork_scene::source::Source;
use fretwork_scene::wear_coefficient;

/// A law, as its library describes it.
#[derive(Clone, Debug, Default)]
pub struct LawInfo {
    /// One-line description.
    pub doc: String,
    /// Paper or DOI.
    pub reference: String,
    /// Parameters of the law.
    pub parameters: Vec<LawParameter>,
}

/// A parameter of a law.
#[derive(Clone, Debug, Default)]
pub struct LawParameter {
    /// Name.
    pub name: String,
    /// SI unit, empty for a pure number.
    pub unit: String,
    /// Default.
    pub default: f64,
    /// One-line description.
    pub doc: String,
}

/// A loaded library of a law.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadedLaw {
    /// Kind of the law.
    pub kind: String,
    /// Name.
    pub name: String,
    /// Version of the law.
    pub version: String,
    /// SHA-256 of the library.
    pub sha256: String,
    /// Whether the law passed certification; unknown if the run did not end.
    pub certified: Option<bool>,
}

/// A law of an interface with its parameters.
#[derive(Clone, Debug)]
pub(crate) struct Used {
    /// Kind of the law.
    pub kind: String,
    /// Name of the law.
    pub name: String,
    /// Name, value, unit, source of the value, and description of each parameter.
    pub parameters: Vec<[String; 5]>,
}

/// An interface with its laws.
#[derive(Clone, Debug)]
pub(crate) struct Interface {
    /// Name of the interface.
    pub name: String,
    /// The two materials.
    pub between: [String; 2],
    /// Laws of the interface.
    pub laws: Vec<Used>,
}

/// Returns the libraries that a run loaded.
pub(crate) fn loaded(run: &RunFolder) -> Vec<LoadedLaw> {
    let column = |name: &str| run.reader.texts(&format!("plugins/{name}"));
    let (kinds, names, versions, sums) = (
        column("kind"),
        column("name"),
        column("version"),
        column("sha256"),
    );
    let stamps = run.summary["plugins"].as_array();
    let law = |k: usize| {
        let text = |list: &[String]| list.get(k).cloned().unwrap_or_default();
        let (kind, name) = (text(&kinds), text(&names));
        let stamp =
            stamps.and_then(|s| s.iter().find(|s| s["kind"] == *kind && s["name"] == *name));
        LoadedLaw {
            kind,
            name,
            version: text(&versions),
            sha256: text(&sums),
            certified: stamp.and_then(|s| s["certified"].as_bool()),
        }
    };
    (0..names.len()).map(law).collect()
}

/// Returns the interfaces of a case with the parameters of their laws; `None` if the case cannot be
/// read.
pub(crate) fn interfaces(
    run: &RunFolder,
    files: &Files,
    law: &dyn Fn(&str, &str) -> Option<LawInfo>,
) -> Vec<Interface> {
    let Ok(case) = Case::read(&Source::from_text("case", run.case_text.as_str())) else {
        return Vec::new();
    };
    let of = |spec: &fretwork_scene::case::InterfaceSpec| {
        let used = spec.laws.iter().map(|(kind, name)| {
            let info = law(kind.word(), name);
            Used {
                kind: kind.word().to_owned(),
                name: name.clone(),
                parameters: parameters(
                    &case,
                    spec,
                    kind.word(),
                    name,
                    info.as_ref(),
                    files,
                    &run.summary,
                ),
            }
        });
        Interface {
            name: spec.name.clone(),
            between: [spec.between.0.clone(), spec.between.1.clone()],
            laws: used.collect(),
        }
    };
    case.interfaces.iter().map(of).collect()
}

/// Returns the parameters that a run derived from `K` for the wear law of an interface.
fn derived_wear<'a>(
    summary: &'a serde_json::Value,
    interface: &str,
    law: &str,
) -> Option<&'a serde_json::Value> {
    let list = summary["wear_coefficients"].as_array()?;
    list.iter()
        .find(|w| w["interface"] == *interface && w["law"] == *law)
}

/// Returns the parameters of a law. Those that a run derived from a hardness take precedence, then
/// those of the case, of the file, properties of materials, and defaults.
fn parameters(
    case: &Case,
    spec: &fretwork_scene::case::InterfaceSpec,
    kind: &str,
    name: &str,
    info: Option<&LawInfo>,
    files: &Files,
    summary: &serde_json::Value,
) -> Vec<[String; 5]> {
    let own: Vec<(String, f64, String)> = spec
        .parameters
        .iter()
        .filter(|(k, _)| k.word() == kind)
        .flat_map(|(_, given)| given)
        .map(|(n, g)| (n.clone(), g.value, g.unit.clone().unwrap_or_default()))
        .collect();
    let file = files.laws_of(case, spec);
    let of_file: Vec<_> = file.into_iter().flat_map(|f| f.of(kind, name)).collect();
    let mut names: Vec<String> = info
        .iter()
        .flat_map(|i| &i.parameters)
        .map(|p| p.name.clone())
        .collect();
    for given in own.iter().map(|o| &o.0).chain(of_file.iter().map(|f| &f.0)) {
        if !names.contains(given) {
            names.push(given.clone());
        }
    }
    let gives_k = names.iter().any(|n| n == wear_coefficient::NAME);
    let schema_fields = info.iter().flat_map(|i| &i.parameters);
    let schema_fields = schema_fields.map(|p| (p.name.as_str(), p.unit.as_str()));
    let from_hardness = wear_coefficient::parameter(schema_fields).filter(|_| gives_k);
    let derived = derived_wear(summary, &spec.name, name);
    let row = |parameter: String| {
        let schema = info.and_then(|i| i.parameters.iter().find(|p| p.name == parameter));
        let si = || schema.map(|s| s.unit.clone()).unwrap_or_default();
        let unit = |given: &str| {
            if given.is_empty() {
                si()
            } else {
                given.to_owned()
            }
        };
        let doc = schema.map(|s| s.doc.clone()).unwrap_or_default();
        let (value, unit, from) =
            if let Some(w) = derived.filter(|w| kind == "wear" && w["parameter"] == *parameter) {
                let text = |key: &str| w[key].as_str().unwrap_or_default().to_owned();
                let value = w["value"].as_f64().unwrap_or(f64::NAN);
                (value, text("unit"), text("derivation"))
            } else if let Some((_, value, given)) = own.iter().find(|o| o.0 == parameter) {
                (*value, unit(given), "the case".to_owned())
            } else if let Some((_, number)) = of_file.iter().find(|f| f.0 == parameter) {
                (number.value, unit(&number.unit), with_range(number))
            } else if let Some((number, material)) = files.property(case, spec, &parameter) {
                (
                    number.value,
                    unit(&number.unit),
                    format!("material {material}: {}", with_range(&number)),
                )
            } else if kind == "wear" && from_hardness.is_some_and(|(name, _)| name == parameter) {
                let why = "from K and the hardness; the run left no summary that has the value";
                return [parameter, String::new(), si(), why.to_owned(), doc];
            } else {
                let default = schema.map_or(f64::NAN, |s| s.default);
                (default, si(), "default of the law".to_owned())
            };
        [
            parameter,
            crate::html::results::number(value),
            unit,
            from,
            doc,
        ]
    };
    names.into_iter().map(row).collect()
}

/// Returns the source of a number, with the range that it gives.
fn with_range(number: &Sourced) -> String {
    let range = number.range.map(|(low, high)| {
        let [low, high] = [low, high].map(crate::html::results::number);
        format!("range {low} to {high}; ")
    });
    range.unwrap_or_default() + &number.source
}
