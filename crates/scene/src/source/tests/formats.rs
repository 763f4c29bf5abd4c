//! Cases as JSON and YAML: the same cases, errors at their places, and conversion.

use super::*;
use crate::{Case, load_text};

const JSON: &str = r#"{
    "name": "a lid",
    "dimension": 2,
    "let": {"p0": "1.12 GPa", "L": "2 mm"},
    "time": {"step": "10 us", "end": 0.2},
    "materials": {"steel": "rail_steel_r260", "own": {
        "doc": "own", "density": {"value": "7.85 g/cm^3", "source": "s"}}},
    "interfaces": [{"name": "dry", "between": ["steel", "steel"], "contact": "coulomb",
        "parameters": {"contact": {"mu": "30 %"}}, "bonds": {"At": "20 ms"}}],
    "bodies": [{
        "name": "lid", "material": "steel", "mass": 2.5e0, "position": [0, "1 mm"],
        "shapes": [{"HalfSpace": {"normal": [0, 1]}}],
        "dofs": {
            "x": {"Displacement": {"Table": [[0, 0], ["1 ms", "5 um"]]}},
            "y": {"Force": "${-p0 * L}"}, "rz": "Free"
        }
    }],
    "accuracy": 0.03,
    "coupling": {"Implicit": {"tolerance": 1e-6}}
}"#;

const YAML: &str = r#"# A comment.
name: a lid
dimension: 2
let: {p0: 1.12 GPa, L: 2 mm}
time:
  step: 10 us
  end: 0.2
materials:
  steel: rail_steel_r260
  own:
    doc: own
    density: {value: 7.85 g/cm^3, source: s}
interfaces:
  - name: dry
    between: [steel, steel]
    contact: coulomb
    parameters: {contact: {mu: 30 %}}
    bonds: {At: 20 ms}
bodies:
  - name: lid
    material: steel
    mass: 2.5
    position: [0, 1 mm]
    shapes:
      - HalfSpace: {normal: [0, 1]}
    dofs:
      x: {Displacement: {Table: [[0, 0], [1 ms, 5 um]]}}
      y: {Force: "${-p0 * L}"}
      rz: Free
accuracy: 0.03
coupling: {Implicit: {tolerance: 1e-6}}
"#;

const RON: &str = r#"(
    name: "a lid", dimension: 2, time: (step: 1e-5, end: 0.2),
    materials: {"steel": "rail_steel_r260", "own": (
        doc: "own", density: (value: 7.85, unit: "g/cm^3", source: "s"))},
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb",
        parameters: (contact: {"mu": (value: 30, unit: "%")}), bonds: At(0.02))],
    bodies: [(
        name: "lid", material: "steel", mass: 2.5, position: [0, 1e-3],
        shapes: [HalfSpace(normal: (0, 1))],
        dofs: (x: Displacement(Table([(0, 0), (1e-3, 5e-6)])), y: Force(-2.24e6), rz: Free),
    )],
    accuracy: 0.03, coupling: Implicit(tolerance: 1e-6),
)"#;

fn read(name: &str, text: &str, sets: &[&str]) -> Result<Case, InputError> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    load_text(name, text, "".as_ref(), &sets).map(|loaded| loaded.case)
}

#[test]
fn the_same_case_in_three_formats() {
    let case = read("a.ron", RON, &[]).unwrap();
    assert_eq!(read("a.json", JSON, &[]).unwrap(), case);
    assert_eq!(read("a.yaml", YAML, &[]).unwrap(), case);
    assert_eq!(read("a.YML", YAML, &[]).unwrap(), case);
    for (name, text) in [("a.json", JSON), ("a.yml", YAML)] {
        let sets = ["bodies.lid.mass=3", "let.L=1 mm", "solver.tolerance=1e-3"];
        let set = read(name, text, &sets).unwrap();
        assert_eq!(set.bodies[0].mass, Some(3.0));
        assert_eq!(set.solver.tolerance, Some(1e-3));
        assert!(format!("{:?}", set.bodies[0].dofs.y).contains("1120000"));
    }
}

#[test]
fn mistakes_are_errors_at_their_places() {
    // A bar stands before the place of the error.
    for (name, old, new, words) in [
        ("a.json", "\"10 us\"", "\"10 |um\"", "`time.step` is a time"),
        (
            "a.json",
            "\"10 us\"",
            "\"10 |uss\"",
            "`uss` is not a known unit",
        ),
        (
            "a.json",
            "\"${-p0 * L}\"",
            "\"${-p0 * |l}\"",
            "did you mean `L`?",
        ),
        ("a.json", "\"mass\"", "|\"mas\"", "did you mean `mass`?"),
        (
            "a.json",
            "{\"HalfSpace\"",
            "{|\"Halfspace\"",
            "did you mean `HalfSpace`?",
        ),
        ("a.json", "\"Free\"", "|\"Fre\"", "did you mean `Free`?"),
        ("a.json", "2.5e0", "|\"much\"", "expected a number"),
        ("a.json", "2.5e0", "2.5e0|.", "this is no JSON"),
        ("a.json", "[0, 1]", "[0, 1|", "this is no JSON"),
        (
            "a.json",
            "\"end\": 0.2",
            "\"end\": 0.2, |\"end\": 3",
            "the key `end` is given twice, first in line 5",
        ),
        ("a.json", "2.5e0", "|[1, 2]", "expected a number"),
        ("a.json", "\"dimension\": 2", "\"dimension\": |2.5", "2.5"),
        (
            "a.yaml",
            "step: 10 us",
            "step: 10 |um",
            "`time.step` is a time",
        ),
        (
            "a.yaml",
            "    mass: 2.5",
            "    |mas: 2.5",
            "did you mean `mass`?",
        ),
        ("a.yaml", "mass: 2.5", "mass: |much", "expected a number"),
        ("a.yaml", "rz: Free", "rz: |Fre", "did you mean `Free`?"),
        ("a.yaml", "position: [0", "position: |&a [0", "position"),
        ("a.yaml", "[0, 1]", "|*a", "this is no YAML"),
        ("a.yaml", "rz: Free", "rz: |!Free", "a value has a tag"),
        (
            "a.yaml",
            "name: a lid",
            "|name: a lid\nname: b",
            "the key `name` is given twice",
        ),
        ("a.yaml", "  end: 0.2", "  |[1, 2]: 0.2", "a key is a text"),
    ] {
        let text = if name == "a.json" { JSON } else { YAML };
        assert_eq!(text.matches(old).count(), 1, "{old}");
        let marked = text.replace(old, new);
        let at = marked.find('|').unwrap();
        let found = read(name, &marked.replace('|', ""), &[]);
        let Err(error) = found else {
            // Anchors without aliases change nothing.
            assert!(new.contains("&a"), "{new}");
            continue;
        };
        assert!(error.to_string().contains(words), "{new}: {error}");
        // Whose place the parser gives in its own way.
        if ["name: b", "*a", "!Free"]
            .iter()
            .any(|other| new.contains(other))
        {
            continue;
        }
        let before = &marked[..at];
        let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
        let place = (before.matches('\n').count() + 1, column);
        assert_eq!(error.position(), Some(place), "{new}: {error}");
    }
    let two = read("a.yaml", &format!("{YAML}---\n{YAML}"), &[]).unwrap_err();
    assert!(two.message.contains("one document"), "{two}");
    let deep = "[".repeat(1000) + &"]".repeat(1000);
    for name in ["a.json", "a.yaml"] {
        assert!(read(name, &deep, &[]).is_err(), "{name}");
        assert!(read(name, "[1, 2]", &[]).is_err(), "{name}");
        assert!(read(name, "3", &[]).is_err(), "{name}");
        // Any beginning of a text is answered.
        let text = if name == "a.json" { JSON } else { YAML };
        for (end, _) in text.char_indices() {
            let _ = read(name, &text[..end], &[]);
        }
    }
}

fn cases(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            cases(&path, out);
        } else if path.extension().is_some_and(|e| e == "ron") {
            out.push(path);
        }
    }
}

#[test]
fn the_shipped_cases_are_the_same_in_each_format() {
    let mut files = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    cases(&root, &mut files);
    let mut count = 0;
    for file in files {
        let source = Case::source(&file).unwrap();
        let Ok(case) = Case::read(&source) else {
            continue;
        };
        for (format, name) in [
            (Format::Json, "a.json"),
            (Format::Yaml, "a.yaml"),
            (Format::Ron, "a.ron"),
        ] {
            let text = source.in_format(format).unwrap();
            let converted = Case::source_of_text(name, &text).unwrap();
            let read = Case::read(&converted);
            let read = read.unwrap_or_else(|e| panic!("{} as {name}: {e}\n{text}", file.display()));
            assert_eq!(read, case, "{} as {name}", file.display());
            // And back.
            let back = converted.in_format(Format::Ron).unwrap();
            let back = Case::read(&Source::from_text("a.ron", back)).unwrap();
            assert_eq!(back, case, "{} by {name}", file.display());
        }
        count += 1;
    }
    assert!(count > 50, "{count} cases");
}

#[test]
fn a_converted_text_keeps_names_units_and_expressions() {
    let source = Case::source_of_text("a.yaml", YAML).unwrap();
    let json = source.in_format(Format::Json).unwrap();
    for part in [
        "\"1.12 GPa\"",
        "\"10 us\"",
        "\"${-p0 * L}\"",
        "\"30 %\"",
        "1e-6",
    ] {
        assert!(json.contains(part), "{part}: {json}");
    }
    let ron = source.in_format(Format::Ron).unwrap();
    for part in [
        "step: 10 us",
        "\"p0\": 1.12 GPa",
        "Force(\"${-p0 * L}\")",
        "bonds: At(20 ms)",
    ] {
        assert!(ron.contains(part), "{part}: {ron}");
    }
    assert!(ron.lines().all(|line| line.len() <= 100));
    let source = Source::from_text("a.ron", ron);
    assert_eq!(source.in_format(Format::Ron).unwrap(), source.text());
    // Numbers that JSON spells in another way, or not at all.
    let numbers = Source::from_text("a.ron", "[+.5, 5., 1_000, -007, 1E3, inf]");
    let yaml = numbers.in_format(Format::Yaml).unwrap();
    assert_eq!(yaml, "[0.5, 5.0, 1000, -7, 1E3, .inf]\n");
    let json = numbers.in_format(Format::Json).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json, serde_json::json!([0.5, 5.0, 1000, -7, 1e3, "inf"]));
}

#[test]
fn names_and_mistakes_before_other_fields_are_where_they_are() {
    let yaml = YAML.replace(
        "let: {p0: 1.12 GPa, L: 2 mm}",
        "let: {L: 2 * k, k: 1 mm, p0: 560 * 2 MPa}",
    );
    assert_ne!(yaml, YAML);
    let (one, other) = (
        read("a.yaml", YAML, &[]).unwrap(),
        read("a.yaml", &yaml, &[]).unwrap(),
    );
    assert_eq!(
        format!("{:?}", one.bodies[0].dofs),
        format!("{:?}", other.bodies[0].dofs)
    );
    for (first, words) in [
        ("sed: 3", "unknown field `sed`"),
        ("seed: 1.5", "seed"),
        ("doc: 12", "doc"),
    ] {
        let text = format!("{first}\n{YAML}");
        let error = read("a.yaml", &text, &[]).unwrap_err();
        assert!(error.message.contains(words), "{first}: {error}");
        assert_eq!(error.position().unwrap().0, 1, "{first}: {error}");
    }
    let sourced = JSON.replace("\"30 %\"", "{\"value\": \"30 %\", \"source\": \"own\"}");
    assert_ne!(sourced, JSON);
    let case = read("a.json", &sourced, &[]).unwrap();
    let mu = case.interfaces[0]
        .parameters
        .iter()
        .find_map(|(_, all)| all.get("mu"));
    assert_eq!(
        (mu.unwrap().value, mu.unwrap().unit.as_deref()),
        (30.0, Some("%"))
    );
}
