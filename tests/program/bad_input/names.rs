//! Names of laws, parameters and materials.

use super::trial::{PLANE, SOLID, Trial, refused, refused_with, with};

#[test]
fn an_unknown_plugin() {
    refused(
        &with(PLANE, r#"contact: "coulomb""#, r#"contact: ‸"columb""#),
        &[
            "no contact law named `columb`",
            "expected one of",
            "did you mean `coulomb`?",
        ],
    );
}

#[test]
fn an_unknown_plugin_by_set() {
    let more = ["--set", "interfaces.grains.cohesion=mak"];
    refused_with(
        &with(PLANE, r#"{"mu": 0.3})"#, r#"{"mu": 0.3})‸"#),
        &more,
        &[
            "from `--set interfaces.grains.cohesion=mak`",
            "did you mean `mac`?",
        ],
    );
}

#[test]
fn an_unknown_parameter() {
    refused(
        &with(PLANE, r#"{"mu": 0.3}"#, r#"{"mo": ‸0.3}"#),
        &[
            "`coulomb` has no parameter `mo`",
            "expected one of mu",
            "did you mean `mu`?",
        ],
    );
}

#[test]
fn a_parameter_of_a_law_that_is_not_there() {
    refused(
        &with(
            PLANE,
            r#"{"mu": 0.3})"#,
            r#"{"mu": 0.3}, damage: {"w": ‸0.1})"#,
        ),
        &["`w` is a parameter of the damage law", "no damage law"],
    );
}

#[test]
fn a_parameter_out_of_range() {
    refused(
        &with(PLANE, r#""mu": 0.3"#, r#""mu": ‸-0.3"#),
        &[
            "`mu` of the contact law `coulomb` is -0.3",
            "expected a value between 0e0 and",
        ],
    );
}

#[test]
fn a_parameter_that_is_no_number() {
    for bad in ["NaN", "inf", "-inf", "1e400"] {
        refused(
            &with(PLANE, r#""mu": 0.3"#, &format!(r#""mu": ‸{bad}"#)),
            &[
                "`mu` of the contact law `coulomb` is",
                "expected a value between",
            ],
        );
    }
}

#[test]
fn a_wrong_value_in_a_parameter_file() {
    for (name, value, words) in [
        ("mu", "-1.0", ["is -1", "expected a value between"]),
        ("mju", "0.4", ["no parameter `mju`", "did you mean `mu`?"]),
    ] {
        let trial = Trial::new();
        let laws = format!(
            "(contact: {{\"coulomb\": {{\n  \"{name}\": (value: ‸{value}, source: \"none\")}}}})"
        );
        let place = trial.write_marked("materials/laws.ron", &laws).1.unwrap();
        let case = trial.write("case.ron", with(PLANE, r#"{"mu": 0.3}"#, "{}"));
        let said = trial.refuses(&case, &[], &words);
        // A parameter with a wrong name is reported at its position, too.
        assert!(said.starts_with(&place), "not at {place}\n{said}");
    }
}

#[test]
fn a_missing_material_file() {
    refused(
        &with(PLANE, r#""grain": "stone""#, r#""grain": ‸"stonne""#),
        &[
            "no file `stonne.ron`",
            "expected one of laws, stone,",
            "materials, the program itself",
            "did you mean `stone`?",
        ],
    );
    refused(
        &with(
            PLANE,
            r#"parameters_from: "laws""#,
            r#"parameters_from: ‸"lavs""#,
        ),
        &["no file `lavs.ron`", "did you mean `laws`?"],
    );
}

#[test]
fn a_material_file_that_reaches_elsewhere() {
    refused(
        &with(
            PLANE,
            r#""grain": "stone""#,
            r#""grain": ‸"../materials/stone""#,
        ),
        &["no file `../materials/stone.ron`"],
    );
}

#[test]
fn a_density_that_is_none() {
    for bad in ["-2600.0", "NaN", "0"] {
        let trial = Trial::new();
        let stone = format!("(doc: \"\",\n density: (value: ‸{bad}, source: \"\"))");
        let place = trial.write_marked("materials/stone.ron", &stone).1.unwrap();
        let case = trial.write("case.ron", PLANE);
        let said = trial.refuses(&case, &[], &["a density must be positive"]);
        assert!(said.starts_with(&place), "not at {place}\n{said}");
    }
}

#[test]
fn an_unknown_material() {
    let words = [
        "no material `grian`",
        "expected one of grain",
        "did you mean `grain`?",
    ];
    refused(
        &with(PLANE, r#"("grain", "grain")"#, r#"("grain", ‸"grian")"#),
        &words,
    );
    refused(
        &with(
            PLANE,
            r#"List(material: "grain""#,
            r#"List(material: ‸"grian""#,
        ),
        &words,
    );
    refused(
        &with(
            PLANE,
            r#"(name: "floor", material: "grain""#,
            r#"(name: "floor", material: ‸"grian""#,
        ),
        &words,
    );
}

#[test]
fn a_damage_law_without_cohesion() {
    refused(
        &with(
            PLANE,
            r#"contact: "coulomb","#,
            r#"contact: "coulomb", damage: ‸"mac","#,
        ),
        &[
            "the damage law `mac` of interface `grains` has no cohesion",
            "give the interface a cohesion law",
        ],
    );
}

#[test]
fn a_law_for_three_dimensions_in_two() {
    let trial = Trial::new();
    trial.compile_law("solid-only", "FW_FLAG_3D_ONLY");
    let folder = trial.path("");
    let more = ["--plugin-path", folder.to_str().unwrap()];
    let changed = with(PLANE, r#"contact: "coulomb""#, r#"contact: ‸"solid-only""#);
    let changed = with(&changed, r#"{"mu": 0.3}"#, "{}");
    let (case, place) = trial.write_marked("case.ron", &changed);
    let words = ["the contact law `solid-only` is for three dimensions only, the case has 2"];
    let said = trial.refuses(&case, &more, &words);
    assert!(said.starts_with(&place.unwrap()), "{said}");
    // In three dimensions the case is valid.
    let case = with(SOLID, r#"contact: "coulomb""#, r#"contact: "solid-only""#);
    trial.write("case.ron", case);
    let output = trial.call(&["check", "case.ron", more[0], more[1]]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn two_phases_of_one_name() {
    let phases = r#"    phases: [(name: "press", until: After(1e-3)), (name: ‸"press")],
"#;
    let case = with(
        PLANE,
        "    friction: (",
        &format!("{phases}    friction: ("),
    );
    refused(
        &case,
        &["a phase before it is called `press` too; give each another name"],
    );
}

#[test]
fn two_interfaces_of_one_name() {
    let two = with(
        PLANE,
        r#"{"grain": "stone"}"#,
        r#"{"grain": "stone", "wall": "stone"}"#,
    );
    let second = "        (name: ‸\"grains\", between: (\"grain\", \"wall\"), contact: \"coulomb\"),\n    ],\n    bodies: [";
    refused(
        &with(&two, "    ],\n    bodies: [", second),
        &["two interfaces are named `grains`"],
    );
}

/// Names of bodies occur in names of files and columns, and in paths of the results.
#[test]
fn a_body_whose_name_is_a_path() {
    for bad in [
        "wheel/rail",
        "/abs",
        "a\\\\b",
        "..",
        ".hidden",
        "=1+1",
        "",
        "a\\nb",
        "c:",
    ] {
        refused(
            &with(PLANE, r#"name: "floor""#, &format!("name: ‸\"{bad}\"")),
            &["name"],
        );
    }
    let long = "x".repeat(300);
    refused(
        &with(PLANE, r#"name: "floor""#, &format!("name: ‸\"{long}\"")),
        &["at most 100 bytes"],
    );
    // Spaces, dots and letters of any language are invalid.
    let trial = Trial::new();
    let case = with(
        PLANE,
        r#"name: "floor""#,
        r#"name: "sol élastique 1.2 (bas)""#,
    );
    trial.write("case.ron", case);
    assert!(trial.call(&["run", "case.ron"]).status.success());
}

/// `run`, before anything is written, and `check` reject the case with one message.
fn taken(case: &str, words: &[&str]) {
    refused(case, words);
    let trial = Trial::new();
    let (case, place) = trial.write_marked("case.ron", case);
    let checked = trial.call(&["check", case.to_str().unwrap(), "--no-timing"]);
    let said = super::trial::refusal(&checked, words);
    assert!(said.starts_with(&place.unwrap()), "{said}");
}

#[test]
fn a_measure_with_the_name_of_a_file_of_every_run() {
    for name in ["statistics", "Statistics"] {
        let measure = format!(
            "    measures: [Profile(name: ‸\"{name}\", axis: 1, low: [0.0, 0.0], high: [0.4, 0.1], bins: 4)],\n    friction: ("
        );
        taken(
            &with(PLANE, "    friction: (", &measure),
            &["another file in the folder of the results is named `statistics.csv`"],
        );
    }
}

#[test]
fn a_measure_with_the_name_of_a_column_of_a_body() {
    let measure = "    measures: [Mass(name: ‸\"lid_x\", axis: 1, above: 0.0)],\n    friction: (";
    taken(
        &with(PLANE, "    friction: (", measure),
        &["another column of statistics.csv is named `lid_x`"],
    );
}

/// The name is that of two measures, or of a measure with a suffix.
#[test]
fn two_measures_with_one_file() {
    let profile = |name: &str| {
        format!("Profile(name: {name}, axis: 1, low: [0.0, 0.0], high: [0.4, 0.1], bins: 4)")
    };
    let two = |one: &str, other: &str| {
        let measures = format!("    measures: [{one}, {other}],\n    friction: (");
        with(PLANE, "    friction: (", &measures)
    };
    let layer = r#"ThirdBody(name: "gap", between: ("floor", "lid"), along: 0, across: 1)"#;
    taken(
        &two(layer, &profile("‸\"gap_energy\"")),
        &["is named `gap_energy.csv`"],
    );
    // Both names are one file on systems that ignore case.
    taken(
        &two(&profile("\"Top\""), &profile("‸\"top\"")),
        &["is named `top.csv`"],
    );
}
