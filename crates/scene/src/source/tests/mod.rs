//! Tests of reading, `--set`, parsing and locating errors.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::numbers::{Fraction, NonNegative, Positive};
use super::*;

mod errors;
mod formats;
mod named_values;
mod noise;
mod sets;

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    loading: Loading,
    bodies: Vec<Body>,
    #[serde(default)]
    interfaces: Vec<Interface>,
    #[serde(default)]
    drive: Option<Drive>,
    #[serde(default)]
    materials: BTreeMap<String, Material>,
    #[serde(default)]
    seed: u32,
    #[serde(default)]
    comment: Option<String>,
    #[serde(default)]
    pressure: Option<Pascal>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Loading {
    amplitude: Positive,
    frequency: f64,
    #[serde(default)]
    phase: Option<f64>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Body {
    name: String,
    mass: Positive,
    #[serde(default)]
    position: Option<(f64, f64)>,
    #[serde(default)]
    shape: Option<Shape2>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
enum Shape2 {
    Disk { radius: Positive },
    Point,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Interface {
    mu: NonNegative,
    #[serde(default)]
    cohesion: Option<String>,
    #[serde(default)]
    share: Option<Fraction>,
}

#[derive(Debug, Deserialize, PartialEq)]
enum Drive {
    Sine(Loading),
    Constant(f64),
    Rest,
}

#[derive(Debug, Deserialize, PartialEq)]
struct Material {
    young: Positive,
}

#[derive(Debug, Deserialize, PartialEq)]
struct Pascal(f64);

const TEXT: &str = r##"#![enable(implicit_some)]
// The case has a comment with a brace { and a bracket ) in it.
Case(
    name: "wheel (on rail) }",
    /* nested /* comment ] */ still */
    loading: Loading(
        amplitude: 1.0e-3, // the stroke (m)
        frequency: 5.0,
    ),
    bodies: [
        (name: "wheel", mass: 2.0, position: (0.0, 1.0), shape: Disk(radius: 0.5)),
        (name: r#"rail "60""#, mass: Some(7.0e3)),
    ],
    interfaces: [(mu: 0.3, cohesion: "none")],
    drive: Some(Sine((amplitude: 2.0, frequency: 1.0))),
    materials: { "steel": (young: 2.1e11), "c.45": (young: 2.0e11) },
)
"##;

/// Returns `TEXT` without the one `Some` that no type requires.
fn text() -> String {
    TEXT.replace("Some(7.0e3)", "7.0e3")
}

fn source() -> Source {
    Source::from_text("case.ron", text())
}

fn parsed(source: &Source) -> Case {
    source.parse().unwrap()
}

/// Returns the first line of the error of a text with one change.
fn refusal(old: &str, new: &str) -> String {
    assert!(text().contains(old), "no `{old}` to change");
    let changed = Source::from_text("case.ron", text().replace(old, new));
    let error = changed.parse::<Case>().unwrap_err();
    assert!(error.to_string().starts_with(&error.compact()));
    error.compact()
}

#[track_caller]
fn found(source: &Source, path: &str) -> String {
    let parts = tree::split_path(path).unwrap();
    let node = source.tree().find(source.text(), &parts).unwrap();
    source.text()[node.span.clone()].to_owned()
}

#[test]
fn paths_lead_to_values() {
    let source = Source::from_text("case.ron", TEXT);
    assert_eq!(found(&source, "loading.amplitude"), "1.0e-3");
    assert_eq!(found(&source, "name"), "\"wheel (on rail) }\"");
    assert_eq!(found(&source, "bodies.0.mass"), "2.0");
    assert_eq!(found(&source, "bodies.wheel.mass"), "2.0");
    assert_eq!(found(&source, "bodies.wheel.position.1"), "1.0");
    assert_eq!(found(&source, "bodies.wheel.shape.radius"), "0.5");
    assert_eq!(found(&source, "bodies.1.mass"), "Some(7.0e3)");
    assert_eq!(found(&source, "drive.0.amplitude"), "2.0");
    assert_eq!(found(&source, "drive.amplitude"), "2.0");
    assert_eq!(
        found(&source, "drive.0"),
        "(amplitude: 2.0, frequency: 1.0)"
    );
    assert_eq!(found(&source, "materials.steel.young"), "2.1e11");
    assert_eq!(found(&source, "materials.\"c.45\".young"), "2.0e11");
    assert_eq!(source.position_of("loading.amplitude"), Some((7, 20)));
    assert_eq!(source.position_of("loading.nothing"), None);
    assert!(tree::split_path("a..b").is_none());
    assert!(tree::split_path("").is_none());
}

#[test]
fn both_spellings_of_newtype_variants_parse() {
    let drive = |text: &str| {
        let mut source = source();
        source.set::<Case>(&format!("drive={text}")).unwrap();
        parsed(&source).drive.unwrap()
    };
    let sine = drive("Sine((amplitude: 2, frequency: 1))");
    assert_eq!(sine, drive("Sine(amplitude: 2, frequency: 1)"));
    assert_eq!(drive("Constant(3.0)"), Drive::Constant(3.0));
    assert_eq!(drive("Rest"), Drive::Rest);
}
