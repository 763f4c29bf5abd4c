//! Values that may be written in several forms, and repeated keys of a map.

use super::trial::{PLANE, SOLID, Trial, refused, refused_with, with};

/// Returns the summary of a run without values of the clock.
fn summary(case: &str, more: &[&str]) -> serde_json::Value {
    let trial = Trial::new();
    trial.write("case.ron", case);
    let output = trial.call(&[&["run", "case.ron", "--json"], more].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let mut value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for pointer in fretwork::record::summary::NOT_REPRODUCIBLE {
        if let Some(found) = value.pointer_mut(pointer) {
            *found = serde_json::Value::Null;
        }
    }
    // The identity includes the text of the case, which differs.
    value["identity"] = serde_json::Value::Null;
    value
}

#[test]
fn a_key_given_twice() {
    refused(
        &with(PLANE, r#"{"mu": 0.3}"#, r#"{"mu": 0.5, ‸"mu": 0.0}"#),
        &[
            "the key `mu` is given twice in `interfaces.grains.parameters.contact`, first at line 14, column 36",
            "remove one of the two",
        ],
    );
    refused(
        &with(
            PLANE,
            r#"{"grain": "stone"}"#,
            r#"{"grain": "stone", ‸"gr\u{61}in": "stone"}"#,
        ),
        &["the key `grain` is given twice in `materials`"],
    );
    refused(
        &with(PLANE, "theta: 0.5", "theta: 0.5, ‸theta: 1.0"),
        &[
            "the field `theta` is given twice",
            "first given at line 4, column",
        ],
    );
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    let twice = r#"interfaces.grains.parameters.contact={"mu": 0.1, "mu": 0.2}"#;
    trial.refuses(
        &case,
        &["--set", twice],
        &["the key `mu` is given twice", "from `--set"],
    );
    let laws = r#"(contact: {"coulomb": {"mu": (value: 0.4, source: "a")},
  "coulomb": {"mu": (value: 0.1, source: "b")}})"#;
    let file = trial.write("materials/laws.ron", laws);
    let said = trial.refuses(
        &case,
        &[],
        &["the key `coulomb` is given twice", "line 1, column 12"],
    );
    assert!(
        said.starts_with(&format!("{}:2:3: ", file.display())),
        "{said}"
    );
}

#[test]
fn lists_and_tuples_stand_for_each_other() {
    let all = PLANE
        .replace("[0.0, -9.81]", "(0.0, -9.81)")
        .replace(r#"("grain", "grain")"#, r#"["grain", "grain"]"#)
        .replace("[0.0, 1.0]", "(0, 1)")
        .replace(
            "Table([(0.0, -1.0), (1.0, -2.0)])",
            "Table(([0.0, -1.0], [1.0, -2.0]))",
        )
        .replace("at: [0.05, 0.011]", "at: (0.05, 0.011)");
    assert_ne!(all, PLANE);
    assert_eq!(summary(&all, &[]), summary(PLANE, &[]));
    // Errors keep their positions, also after values in another form.
    refused(
        &with(&all, "along: 0", "along: ‸4"),
        &["axis 4 does not exist"],
    );
    refused(
        &with(
            &all,
            "(at: [0.1, 0.011], radius: 0.01)",
            "(at: [0.1, 0.011], radius: ‸-0.01)",
        ),
        &["a radius must be positive"],
    );
    refused(
        &with(PLANE, "gravity: [0.0, -9.81]", "gravity: (0.0, ‸down)"),
        &["expected"],
    );
    let solid = SOLID
        .replace(
            "points: (4, 4), spacing: (0.1, 0.1)",
            "points: [4, 4], spacing: [0.1, 0.1]",
        )
        .replace("at: [0.15, 0.15, 0.02]", "at: (0.15, 0.15, 0.02)");
    assert_eq!(summary(&solid, &[]), summary(SOLID, &[]));
    refused(
        &with(
            PLANE,
            "time: (step: 1e-3, end: 0.002, theta: 0.5)",
            "time: ‸[1e-3, 0.002]",
        ),
        &["a list"],
    );
    refused(
        &with(SOLID, "spacing: (0.1, 0.1)", "spacing: ‸[0.1]"),
        &["expected"],
    );
}

#[test]
fn a_number_is_a_constant_function_of_time() {
    let force = "Force(Table([(0.0, -1.0), (1.0, -2.0)]))";
    for (short, long) in [
        ("Force(-1.5)", "Force(Constant(-1.5))"),
        ("Velocity(-1e-3)", "Velocity(Constant(-1e-3))"),
        ("Displacement(2)", "Displacement(Constant(2))"),
        (
            "Stages([(until: 1e-3, drive: Force(-1)), (drive: Velocity(0))])",
            "Stages([(until: 1e-3, drive: Force(Constant(-1))), (drive: Velocity(Constant(0)))])",
        ),
    ] {
        let (short, long) = (with(PLANE, force, short), with(PLANE, force, long));
        assert_eq!(summary(&short, &[]), summary(&long, &[]));
    }
    let drive = |text: &str| {
        with(
            PLANE,
            "periodic:",
            &format!("gravity_drive: {text},\n    periodic:"),
        )
    };
    for (short, long) in [
        ("Scaled(0.5)", "Scaled(Constant(0.5))"),
        ("Turned(angle: 0.1)", "Turned(angle: Constant(0.1))"),
        ("Axes([0, -9])", "Axes([Constant(0), Constant(-9)])"),
    ] {
        assert_eq!(summary(&drive(short), &[]), summary(&drive(long), &[]));
    }
    // This also holds for --set, and for errors after the value.
    let set = ["--set", "bodies.lid.dofs.y=Force(-1.5)"];
    assert_eq!(
        summary(PLANE, &set),
        summary(&with(PLANE, force, "Force(-1.5)"), &[])
    );
    let short = with(PLANE, force, "Force(-1.5)");
    refused(
        &with(&short, "normal: 1)", "normal: ‸1.5)"),
        &["an integer"],
    );
    refused(
        &with(PLANE, force, "Force(‸inf)").replace("y: Force(‸inf)", "y: ‸Force(inf)"),
        &["a constant must be finite"],
    );
    // If no enum has a constant, a number remains a number.
    refused_with(
        &with(
            PLANE,
            "friction: (body",
            "solver: (method: ‸3),\n    friction: (body",
        ),
        &[],
        &["solver"],
    );
}

#[test]
fn every_field_of_the_schema_can_be_set() {
    let found = summary(PLANE, &["--set", "solver.tolerance=1e-3"]);
    let tolerance = found.pointer("/solver/tolerance");
    assert_eq!(tolerance.and_then(|v| v.as_f64()), Some(1e-3), "{found:#}");
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    for set in [
        "detection.alert=1e-3",
        "time.theta=1",
        "coupling=Implicit(tolerance: 1e-6, max_iterations: 5)",
        "interfaces.grains.parameters.contact.mu=0.7",
        "interfaces.0.healing=0.1",
        "bodies.floor.dofs.x=Velocity(0.1)",
        "bodies.floor.wears.thickness=1e-3",
        "output.checkpoint=Never",
        "gravity_drive=Scaled(0.5)",
        "pins.contact/coulomb=0",
        "friction.period=1",
    ] {
        let output = trial.call(&["check", "case.ron", "--set", set]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!said.contains("there is no"), "{set}: {said}");
        assert!(!said.contains("unknown field"), "{set}: {said}");
    }
    for (set, words) in [
        (
            "solvr.tolerance=1",
            &[
                "there is no `solvr` in the file",
                "did you mean `solver.tolerance`?",
            ][..],
        ),
        (
            "solver.tolerence=1",
            &[
                "there is no `tolerence` in `solver`",
                "did you mean `solver.tolerance`?",
            ],
        ),
        ("solver.tolerance.x=1", &["`solver.tolerance` is one value"]),
        (
            "coupling.tolerance=1",
            &[
                "`coupling` is one of several kinds",
                "`Explicit`, `Midpoint`, `Implicit`",
                "--set 'coupling=Implicit(",
            ],
        ),
        (
            "phases.0.until=After(1)",
            &[
                "`phases` is a list that the file does not write",
                "--set 'phases=[...]'",
            ],
        ),
        ("bodies.lit.mass=2", &["did you mean `bodies.lid.mass`?"]),
        ("bodies.3.mass=2", &["`bodies` has 2 elements"]),
        (
            "solver.tolerance=fast",
            &["from `--set solver.tolerance=fast`", "expected a number"],
        ),
        (
            "solver.tolerance=-1",
            &["must not be negative", "from `--set solver.tolerance=-1`"],
        ),
    ] {
        trial.refuses(&case, &["--set", set], words);
    }
    // Keys of the maps and structs around a value are not written twice.
    let plain = with(
        PLANE,
        "            parameters: (contact: {\"mu\": 0.3}),\n",
        "",
    );
    let set = ["--set", "interfaces.grains.parameters.contact.mu=0.3"];
    assert_eq!(summary(&plain, &set), summary(PLANE, &[]));
}

#[test]
fn text_after_a_case_and_marks_of_editors() {
    refused(
        &format!("{PLANE}‸(name: \"b\")"),
        &["unexpected text after the end"],
    );
    let windows = format!("\u{feff}{}", PLANE.replace('\n', "\r\n"));
    assert_eq!(summary(&windows, &[]), summary(PLANE, &[]));
    refused(
        &with(PLANE, "along: 0", "along: ‸99999999999999999999999"),
        &["out of range"],
    );
    refused(
        &with(PLANE, "mass: 1.0", "mass: ‸1e400"),
        &["must be positive, got inf"],
    );
    refused(
        &with(PLANE, "dimension: 2", "dimension: 2,\n    ‸dimensions: 3"),
        &["unknown field"],
    );
}

/// A function of time in an invalid form: the message gives the valid forms, and no name.
#[test]
fn what_is_no_function_of_time() {
    let sine = "Displacement(Sine(amplitude: 1e-4, frequency: 20.0))";
    let expected = "expected a number, or a function of time: `Constant(...)`";
    for (new, found) in [
        (r#"Velocity(‸"0.1 m/s")"#, "write `0.1 m/s` without quotes"),
        ("Velocity(‸[0.1, 0.2])", "found a list"),
    ] {
        refused(&with(PLANE, sine, new), &[expected, found]);
    }
    let servo = "Force(Table([(0.0, -1.0), (1.0, -2.0)]))";
    let pressure = r#"Pressure(value: ‸"1 MPa")"#;
    refused(&with(PLANE, servo, pressure), &[expected]);
}
