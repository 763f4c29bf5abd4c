//! Typical mistakes in the text of a case: each message says what to change, in words of the user
//! and not of the parser or of Rust.

use super::trial::{PLANE, Trial, refusal, refused, with};

/// Words that no message about a case may have.
const OF_PROGRAMMERS: [&str; 6] = [
    "identifier",
    " std ",
    "Spec",
    "TimeFunction",
    "enum",
    "deserial",
];

/// A value of the case, the mistake with a mark at the place of the error, and what is said.
const MISTAKES: &[(&str, &str, &[&str])] = &[
    (
        "step: 1e-3, end",
        "step: 1e-3 ‸end",
        &["a comma is missing before this"],
    ),
    (
        "theta: 0.5",
        "theta: 0.5 ‸m",
        &["`time.theta` is a pure number, and `m` (m)"],
    ),
    (
        "step: 1e-3",
        "step: 1 ‸mm",
        &["`time.step` is a time, and `mm` (m)", "`s`"],
    ),
    ("step: 1e-3", "step: 1 ‸msq", &["`msq` is not a known unit"]),
    (
        "step: 1e-3",
        "step: ‸0,001",
        &["`0,001` has a decimal comma; write `0.001`"],
    ),
    (
        "step: 1e-3",
        "‸stp: 1e-3",
        &["unknown field `stp` in `time`", "did you mean `step`?"],
    ),
    (
        "step: 1e-3",
        "step ‸= 1e-3",
        &["a name and its value have `:` between them, not `=`"],
    ),
    (
        "step: 1e-3",
        "step ‸1e-3",
        &["a colon is missing after `step`"],
    ),
    (
        "step: 1e-3",
        "step: ‸\"1 ms\"",
        &["expected a number", "write `1 ms` without quotes"],
    ),
    ("step: 1e-3", "step: 1‸/1000", &["without arithmetic"]),
    (
        "step: 1e-3",
        "step: 2.0‸/kHz",
        &["begins with 1 here: write `2.0 1/kHz`"],
    ),
    (
        "step: 1e-3",
        "step: ‸1.0e",
        &["found the number `1.0e`; expected a number"],
    ),
    (
        "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))",
        "y: Force ‸-1.0",
        &["the value of `Force` stands in parentheses: `Force(...)`"],
    ),
    (
        "\"lid\",\n            material",
        "‸\"lid,\n            material",
        &["this text runs over several lines"],
    ),
    (
        "gravity: [0.0, -9.81],",
        "gravity: ‸[0.0, -9.81,",
        &["this `[` is not closed by `]`"],
    ),
    (
        "dimension: 2,",
        "dimension: 2, ‸# plane",
        &["a comment begins with `//`, not with `#`"],
    ),
    (
        "    dimension: 2,",
        "    ‸# plane\n    dimension: 2,",
        &["a comment begins with `//`, not with `#`"],
    ),
    (
        "dimension: 2,",
        "dimension: 2‸;",
        &["values have `,` between them, not `;`"],
    ),
    (
        "dimension: 2,",
        "dimension: ‸2.0,",
        &["found the number `2.0`; expected an integer"],
    ),
    (
        "contact: \"coulomb\"",
        "contact: ‸'coulomb'",
        &["a text has double quotes: write `\"coulomb\"`"],
    ),
    (
        "contact: \"coulomb\"",
        "contact: ‸\u{201c}coulomb\u{201d}",
        &["a text has straight double quotes"],
    ),
    (
        "contact: \"coulomb\"",
        "contact: ‸coulomb",
        &["write `\"coulomb\"`"],
    ),
    (
        "{\"grain\": \"stone\"}",
        "{‸grain: \"stone\"}",
        &["found the word `grain`", "write `\"grain\"`"],
    ),
    (
        "figures: false",
        "figures: ‸no",
        &["expected `true` or `false`"],
    ),
    (
        "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))",
        "y: ‸-1.0",
        &["`bodies.lid.dofs.y`", "found the number `-1.0`", "`Force`"],
    ),
    (
        "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))",
        "y: Force(-1 ‸kN)",
        &["`bodies.lid.dofs.y` is a force per depth, and `kN`"],
    ),
    (
        "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))",
        "y: ‸force(-1)",
        &[
            "unknown variant `force` for `bodies.lid.dofs.y`",
            "did you mean `Force`?",
        ],
    ),
    (
        "Table([(0.0, -1.0), (1.0, -2.0)])",
        "‸0,5",
        &["`0,5` has a decimal comma"],
    ),
    (
        "(name: \"floor\", material: \"grain\", shapes: [HalfSpace(normal: [0.0, 1.0])])",
        "‸{name: \"floor\", material: \"grain\", shapes: [HalfSpace(normal: [0.0, 1.0])]}",
        &["found a map; expected `(...)`"],
    ),
    (
        "{\"mu\": 0.3}",
        "‸(\"mu\": 0.3)",
        &["expected a map `{...}`"],
    ),
    (
        "\"mu\": 0.3",
        "\"mu\": ‸r#x",
        &[
            "wrong type for `interfaces.",
            "found the word `r#x`; expected a number",
        ],
    ),
    (
        "\"mu\": 0.3",
        "\"mu\": 0.3‸/Pa",
        &["begins with 1 here: write `0.3 1/Pa`"],
    ),
    (
        "\"mu\": 0.3",
        "\"mu\": (value: 0.3, unit: ‸\"um\")",
        &["`um` (m) does not measure the same as a pure number"],
    ),
    (
        "Sine(amplitude: 1e-4",
        "‸Sin(amplitude: 1e-4",
        &["unknown variant `Sin`", "did you mean `Sine`?"],
    ),
    (
        "gravity: [0.0, -9.81]",
        "gravity: [0.0, ‸\u{2212}9.81]",
        &["a minus is `-`"],
    ),
    ("name: \"lid\",", "name: ‸lid,", &["write `\"lid\"`"]),
];

#[test]
fn messages_are_of_the_case_and_not_of_the_parser() {
    for &(old, new, words) in MISTAKES {
        let marked = with(PLANE, old, new);
        refused(&marked, words);
        let trial = Trial::new();
        trial.write_marked("case.ron", &marked);
        let said = refusal(&trial.call(&["check", "case.ron"]), &[]);
        let line = said.lines().next().unwrap_or_default();
        for word in OF_PROGRAMMERS {
            assert!(!line.contains(word), "`{word}` in {line}");
        }
    }
}

/// A bracket that is never closed is named, wherever the text after it first makes no sense.
#[test]
fn brackets_that_are_not_closed() {
    for (old, new, words) in [
        (
            "friction: (body: \"lid\", along: 0, normal: 1),",
            "friction: (body: \"lid\", along: 0, normal: 1,",
            "is never closed by `)`",
        ),
        (
            "materials: {\"grain\": \"stone\"},",
            "materials: {\"grain\": \"stone\",",
            "`{`",
        ),
    ] {
        let trial = Trial::new();
        trial.write("case.ron", with(PLANE, old, new));
        refusal(&trial.call(&["check", "case.ron"]), &[words]);
    }
}

/// Numbers may have units wherever they stand, in the file and in `--set`.
#[test]
fn numbers_with_units_make_the_same_run() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    let summary = |words: &[&str]| {
        let output = trial.call(&[&["run", "case.ron", "--json"], words].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{said}");
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        value["energy"].clone()
    };
    let plain = summary(&[]);
    let with_units = [
        ("step: 1e-3, end: 0.002", "step: 1ms, end: 2 ms"),
        ("periodic: (x: 0.4)", "periodic: (x: 400 mm)"),
        ("{\"mu\": 0.3}", "{\"mu\": 30 %}"),
        ("amplitude: 1e-4", "amplitude: 100um"),
        ("(1.0, -2.0)", "(1 s, -2 N/m)"),
        (
            "(at: [0.05, 0.011], radius: 0.01)",
            "(at: [50 mm, 11mm], radius: 1 cm)",
        ),
    ];
    let text = with_units
        .iter()
        .fold(PLANE.to_owned(), |text, (old, new)| with(&text, old, new));
    trial.write("case.ron", text);
    let stone = "(doc: \"stone\", density: (value: 2.6 g/cm^3, source: \"quartz\"))";
    trial.write("materials/stone.ron", stone);
    assert_eq!(summary(&[]), plain);
    trial.write("case.ron", PLANE);
    let sets = [
        "--set",
        "time.step=1ms",
        "--set",
        "bodies.lid.position=[0, 10 cm]",
    ];
    assert_eq!(summary(&sets), plain);
}
