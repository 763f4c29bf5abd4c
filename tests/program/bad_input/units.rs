//! Numbers with units are converted, or rejected at their position.

use super::trial::{PLANE, Trial, refused, with};

const STONE: &str =
    "(doc: \"stone\", density: (value: 2600.0, unit: \"kg/m^3\", source: \"quartz\"))";

fn summary(trial: &Trial) -> serde_json::Value {
    let output = trial.call(&["run", "case.ron", "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn units_are_converted() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    let energy = |trial: &Trial| summary(trial).pointer("/energy").cloned().unwrap();
    let si = energy(&trial);
    let grams = STONE.replace("2600.0, unit: \"kg/m^3\"", "2.6, unit: \"g/cm^3\"");
    trial.write("materials/stone.ron", grams);
    assert_eq!(energy(&trial), si);
    trial.write("materials/stone.ron", STONE.replace("2600.0", "2.6"));
    assert_ne!(energy(&trial), si);
    trial.write("materials/stone.ron", STONE);
    let percent = r#"{"mu": (value: 30, unit: "%", source: "a guess")}"#;
    trial.write("case.ron", with(PLANE, r#"{"mu": 0.3}"#, percent));
    assert_eq!(energy(&trial), si);
}

#[test]
fn units_of_another_kind_are_refused() {
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    for (old, new, at, words) in [
        (
            "\"kg/m^3\"",
            "\"MPa\"",
            "1:47",
            &[
                "`MPa` (kg m^-1 s^-2) does not measure the same as `kg/m^3` (kg m^-3)",
                "`g/cm^3`",
            ][..],
        ),
        ("\"kg/m^3\"", "\"g/cm4x\"", "1:47", &["unit"]),
        (
            "\"kg/m^3\"",
            "\"kgg/m^3\"",
            "1:47",
            &[
                "`kgg` in `kgg/m^3` is not a known unit",
                "did you mean `kg/m^3`?",
            ],
        ),
        ("2600.0", "-1", "1:33", &["a density must be positive"]),
    ] {
        let file = trial.write("materials/stone.ron", STONE.replace(old, new));
        let said = trial.refuses(&case, &[], words);
        assert!(
            said.starts_with(&format!("{}:{at}: ", file.display())),
            "{said}"
        );
    }
    for (property, words) in [
        ("\"young\": (value: 70, unit: \"GPa\", source: \"a\")", None),
        (
            "\"young\": (value: 70, unit: \"GPa m\", source: \"a\")",
            Some("does not measure the same as `Pa`"),
        ),
        (
            "\"poisson\": (value: 0.3, unit: \"Pa\", source: \"a\")",
            Some("a pure number"),
        ),
        (
            "\"hardness\": (value: 300, unit: \"HV 10\", source: \"a\")",
            None,
        ),
        (
            "\"hardness\": (value: 3, unit: \"GPa\", source: \"a\")",
            None,
        ),
        (
            "\"hardness\": (value: 3, unit: \"HVV\", source: \"a\")",
            Some("`HVV` is not a known unit"),
        ),
        (
            "\"grain_size\": (value: 3, unit: \"micron s\", source: \"a\")",
            None,
        ),
        (
            "\"grain_size\": (value: NaN, unit: \"um\", source: \"a\")",
            Some("must be finite"),
        ),
    ] {
        let text = format!(
            "{}, properties: {{{property}}})",
            STONE.trim_end_matches(')').to_owned() + ")"
        );
        trial.write("materials/stone.ron", text);
        match words {
            Some(words) => drop(trial.refuses(&case, &[], &["stone.ron:1:", words])),
            None => {
                let output = trial.call(&["check", "case.ron"]);
                let said = String::from_utf8_lossy(&output.stderr);
                assert_eq!(output.status.code(), Some(0), "{property}: {said}");
            }
        }
    }
}

#[test]
fn units_of_parameters_are_those_of_the_law() {
    let trial = Trial::new();
    // A value in the case would take precedence over the file.
    let own = "            parameters: (contact: {\"mu\": 0.3}),\n";
    let case = trial.write("case.ron", with(PLANE, own, ""));
    let laws = |unit: &str| {
        format!(
            "(contact: {{\"coulomb\": {{\"mu\": (value: 0.4, unit: \"{unit}\", source: \"a\")}}}},\n damage: {{\"mac\": {{\"w\": (value: 1, unit: \"J/m^2\", source: \"b\")}}}})"
        )
    };
    trial.write("materials/laws.ron", laws("deg"));
    trial.refuses(
        &case,
        &[],
        &[
            "laws.ron:1:",
            "`mu` of the contact law `coulomb`",
            "`deg` (an angle)",
            "a pure number",
        ],
    );
    // Units of laws that the case does not use are also checked for validity.
    trial.write("materials/laws.ron", laws("").replace("J/m^2", "kj/m^2"));
    trial.refuses(
        &case,
        &[],
        &["laws.ron:2:", "`kj", "did you mean `kJ/m^2`?"],
    );
    refused(
        &with(
            PLANE,
            r#"{"mu": 0.3}"#,
            r#"{"mu": (value: 3, unit: ‸"um")}"#,
        ),
        &["`um` (m) does not measure the same as a pure number"],
    );
    refused(
        &with(PLANE, r#"{"mu": 0.3}"#, r#"{"mu": (value: 3, ‸unt: "um")}"#),
        &["unknown field `unt`", "did you mean `unit`?"],
    );
    refused(
        &with(
            PLANE,
            r#"{"mu": 0.3}"#,
            r#"{"mu": (value: ‸-30, unit: "%")}"#,
        ),
        &["`mu` of the contact law `coulomb` is -0.3"],
    );
    refused(
        &with(PLANE, r#"{"mu": 0.3}"#, r#"{"mu": ‸"much"}"#),
        &["a number"],
    );
}

/// Every file of the repository can be read, and its numbers keep their values: their units are
/// those of the schema.
#[test]
fn shipped_materials_pass() {
    use fretwork::scene::material::{InterfaceParameters, Material};
    use fretwork::scene::source::Source;
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/materials");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let source = Source::read(entry.path()).unwrap();
        if source
            .tree()
            .find(source.text(), &["density".to_owned()])
            .is_ok()
        {
            let material: Material = source.parse().unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(material.density(), Ok(material.density.value));
        } else {
            let laws: InterfaceParameters = source.parse().unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(laws.units(), Ok(()));
        }
        read += 1;
    }
    assert!(read > 5);
}
