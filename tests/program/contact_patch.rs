//! `fretwork contact-patch`: answers, and rejected questions.

use crate::temp::TempFolder;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn patch(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("contact-patch")
        .args(arguments)
        .output()
        .unwrap()
}

fn said(arguments: &[&str]) -> String {
    let output = patch(arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let text = said(&[arguments, &["--json"]].concat());
    serde_json::from_str(&text).unwrap()
}

fn number(of: &Value, path: &str) -> f64 {
    let found = of.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("{path} in {of:#}"))
}

fn near(got: f64, expected: f64, relative: f64) {
    assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
}

const WHEEL: [&str; 8] = [
    "--load",
    "75kN",
    "--radius",
    "0.46m,flat",
    "--across",
    "flat,0.30m",
    "--material",
    "wheel_steel_er7,rail_steel_r260",
];

/// The pressure in the header of cases/wheel_rail_fretting.ron is that of a circle with sqrt(R1
/// R2); the ellipse of these radii differs from it by less than a percent.
#[test]
fn a_wheel_on_a_rail() {
    let got = json(&WHEEL);
    assert_eq!(got["shape"], "ellipse");
    near(number(&got, "/effective_modulus"), 105e9 / 0.91, 1e-12);
    near(number(&got, "/patch/pressure"), 1.12e9, 0.01);
    let (along, across) = (
        number(&got, "/patch/semi_axis"),
        number(&got, "/patch/semi_axis_across"),
    );
    assert!(along > across, "the wheel is flatter than the crown");
    near(
        number(&got, "/patch/pressure"),
        1.5 * 75e3 / (std::f64::consts::PI * along * across),
        1e-12,
    );
    // R260 yields first, at 1.6 Y with the yield stress of its file; without a yield stress there
    // is the flow stress, H/2.8.
    near(number(&got, "/strength/first_yield"), 1.6 * 472e6, 1e-12);
    assert_eq!(got["strength"]["body"], "rail_steel_r260");
    assert_eq!(got["strength"]["estimated"], false);
    let hard = [&WHEEL[..6], &["--material", "rail_steel_r350ht"]].concat();
    let text = said(&hard);
    assert!(
        text.contains("flow stress, hardness/2.8, of rail_steel_r350ht"),
        "{text}"
    );
    assert!(text.contains("upper bound"), "{text}");
    near(
        number(&json(&hard), "/strength/first_yield"),
        1.6 * 350.0 * 9.80665e6 / 2.8,
        1e-12,
    );
}

/// Carter's case of the documentation (cases/carter_rolling.ron): a is 1 mm, full slip begins at
/// 0.06 %, and Q/(mu P) = 3/4 at half of it.
#[test]
fn a_line_that_rolls() {
    let got = json(&[
        "--load",
        "178.9 N/mm",
        "--radius",
        "500mm",
        "--material",
        "contact_steel",
        "--friction",
        "0.3",
        "--creepage",
        "0.03%",
    ]);
    assert_eq!(got["shape"], "line");
    let a = number(&got, "/patch/semi_axis");
    near(a, 1e-3, 2e-3);
    near(
        number(&got, "/rolling/saturation/value"),
        0.3 * a / 0.5,
        1e-12,
    );
    let s = 0.0003 / (0.3 * a / 0.5);
    near(
        number(&got, "/rolling/adhesion/value"),
        0.3 * (1.0 - (1.0 - s).powi(2)),
        1e-9,
    );
}

/// Mindlin's closed form for a sphere of steel on steel: delta* = 3 mu P (2 - nu)/(8 G a).
#[test]
fn a_ball_that_frets() {
    let base = [
        "--load",
        "50N",
        "--radius",
        "10mm",
        "--young",
        "210GPa",
        "--poisson",
        "0.3",
        "--friction",
        "0.6",
        "--displacement",
    ];
    let got = json(&[&base[..], &["5um"]].concat());
    let modulus = 105e9 / 0.91;
    let a = f64::cbrt(0.75 * 50.0 * 0.01 / modulus);
    let slip = 3.0 * 0.6 * 50.0 * 1.7 / (8.0 * 210e9 / 2.6 * a);
    near(
        number(&got, "/tangential/slip_displacement/value"),
        slip,
        1e-12,
    );
    near(
        number(&got, "/tangential/local_slip/value"),
        5e-6 - slip,
        1e-12,
    );
    let small = json(&[&base[..], &["0.1um"]].concat());
    let share = 1.0 - (1.0 - 1e-7 / slip).powf(1.5);
    near(number(&small, "/tangential/share/value"), share, 1e-10);
    near(
        number(&small, "/tangential/stuck/value"),
        (1.0 - share).cbrt(),
        1e-10,
    );
    assert_eq!(number(&small, "/tangential/local_slip/value"), 0.0);
}

/// With intervals of friction and of K each rate has an interval, and the harder wheel wears less:
/// V is proportional to 1/H.
#[test]
fn friction_and_wear_have_intervals() {
    let rolls = [
        "--friction",
        "0.3..0.5",
        "--creepage",
        "0.5%",
        "--speed",
        "30m/s",
    ];
    let got = json(&[&WHEEL[..], &rolls, &["--wear", "1e-4..1e-3"]].concat());
    for path in [
        "/rolling/adhesion",
        "/wear/archard/0/volume",
        "/wear/energy_map/volume",
    ] {
        let end = |name: &str| number(&got, &format!("{path}/{name}"));
        assert!(
            end("low") <= end("value") && end("value") <= end("high"),
            "{path}"
        );
    }
    // The work of friction per metre is Q times the creepage, and Archard's volume is k over mu
    // times it.
    let q = number(&got, "/rolling/adhesion/value") * 75e3;
    near(number(&got, "/rolling/energy/value"), 0.005 * q, 1e-12);
    let k = number(&got, "/wear/archard/0/coefficient/value");
    near(k, (1e-4f64 * 1e-3).sqrt() / (235.0 * 9.80665e6), 1e-12);
    let mu = number(&got, "/friction/coefficient/value");
    near(
        number(&got, "/wear/archard/0/volume/value"),
        k / mu * 0.005 * q,
        1e-12,
    );
    let hard = ["--wear", "1e-4..1e-3", "--hardness", "470 HBW,260 HBW"];
    let harder = json(&[&WHEEL[..], &rolls, &hard].concat());
    let of = |v: &Value| number(v, "/wear/archard/0/volume/value");
    near(of(&harder), 0.5 * of(&got), 1e-12);
    // The text gives depths that an engineer can judge.
    let text = said(&[&WHEEL[..], &rolls, &["--wear", "1e-4..1e-3"]].concat());
    for words in [
        "Hertz pressure",
        "in 1000 km",
        "in 1e6 passages",
        "T gamma/A",
        "window in the middle",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
}

/// Jendel's chart: wear is severe from 0.2 to 0.7 m/s of slip. The map over T gamma/A is that of
/// 900A rail, which R350HT is not.
#[test]
fn severe_wear_and_other_steels_than_those_of_the_map_are_named() {
    let rolls = ["--friction", "0.4", "--wear", "1e-4..1e-3", "--speed"];
    let of = |speed: &str, creepage: &str| {
        said(&[&WHEEL[..], &rolls, &[speed, "--creepage", creepage]].concat())
    };
    let mild = of("30m/s", "0.5%");
    assert!(
        mild.contains("Jendel's chart   mild at a slip of"),
        "{mild}"
    );
    assert!(
        !mild.contains("SEVERE WEAR") && !mild.contains("ANOTHER PAIR"),
        "{mild}"
    );
    assert!(mild.contains("measured on R8T wheel on 900A"), "{mild}");
    let severe = of("30m/s", "1%");
    assert!(
        severe.contains("SEVERE WEAR") && severe.contains("not 1e-4..1e-3"),
        "{severe}"
    );
    assert!(of("200m/s", "1%").contains("mild at a slip of"));
    let hard = [
        "--hardness",
        "235 HBW,350 HBW",
        "--friction",
        "0.4",
        "--creepage",
        "0.5%",
    ];
    let hard = said(&[&WHEEL[..], &hard].concat());
    assert!(hard.contains("MAP OF ANOTHER PAIR"), "{hard}");
}

/// A ball that slides on a plane, in a window of 1 mm under the pressure of the middle of the
/// patch, by as much as a point slips while it passes the patch.
const WINDOW: &str = r#"(
    name: "window",
    dimension: 2,
    seed: 1,
    time: (step: 1e-3, end: 0.1, theta: 1.0),
    periodic: (x: 1e-3),
    detection: (alert: 1e-5),
    materials: {"rail": "rail_steel_r260", "wheel": "wheel_steel_er7"},
    interfaces: [(name: "contact", between: ("rail", "wheel"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [
        (name: "rail", material: "rail", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "wheel",
            material: "wheel",
            shapes: [Balls([([0.0, 0.0], 1e-4)])],
            position: [0.0, 1e-4],
            mass: 1e6,
            dofs: (
                x: Displacement(Ramp(from: 0.0, to: 6.2e-5, start: 0.02, end: 0.1)),
                y: Force(Constant(-1.12e6)),
                rz: Fixed,
            ),
        ),
    ],
    friction: (body: "wheel", along: 0, normal: 1, start: 0.02),
    output: (frames: 0, views: 1),
)"#;

/// Runs the window in a folder, with changes.
fn run(folder: &Path, out: &str, sets: &[&str]) -> String {
    let case = folder.join("window.ron");
    std::fs::write(&case, WINDOW).unwrap();
    let out = folder.join(out);
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("run")
        .arg(&case)
        .arg("--out")
        .arg(&out)
        .args(sets.iter().flat_map(|set| ["--set", set]))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    out.to_str().unwrap().to_owned()
}

/// Runs give their friction to a patch of their steels, pressure and slip; what differs is refused,
/// or accepted by name and then said.
#[test]
fn runs_are_compared_with_each_other_and_with_the_patch() {
    let folder = TempFolder::new("patch-runs");
    let [one, seed, other] = [
        ("1", &[][..]),
        ("2", &["seed=2"]),
        ("3", &["interfaces.0.parameters.contact.mu=0.31"]),
    ]
    .map(|(out, sets)| run(&folder, out, sets));
    let rolls = |creepage: &'static str| [&WHEEL[..], &["--creepage", creepage]].concat();
    let with = |of: Vec<&'static str>, runs: &[&str], more: &[&str]| {
        let runs = runs.iter().flat_map(|r| ["--friction-of", r]);
        let all: Vec<&str> = of
            .into_iter()
            .chain(runs)
            .chain(more.iter().copied())
            .collect();
        let output = patch(&all);
        let text = [output.stdout, output.stderr].concat();
        (output.status.code(), String::from_utf8(text).unwrap())
    };
    let half = || rolls("0.5%");
    let (code, text) = with(half(), &[&one], &[]);
    assert_eq!(code, Some(0), "{text}");
    for words in ["from 1 run", "1.120 GPa in the mean", "one way", "ONE RUN"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    for again in [&one, &seed] {
        let (code, text) = with(half(), &[&one, again], &[]);
        let once = text.contains("COUNTED ONCE") && text.contains("from 1 run");
        assert!(code == Some(0) && once, "{text}");
    }
    let mut hard = half();
    hard[7] = "wheel_steel_er7,rail_steel_r350ht";
    let mut light = half();
    light[1] = "20kN";
    let fretting = [&WHEEL[..], &["--displacement", "100um"]].concat();
    for (of, runs, what, words) in [
        (
            half(),
            &[&one, &other][..],
            "inputs",
            "`interfaces.contact.parameters.contact",
        ),
        (
            hard,
            &[&one],
            "materials",
            "those of the patch of rail_steel_r350ht and wheel",
        ),
        (
            light,
            &[&one],
            "pressure,drive",
            "is under 1.120 GPa, the patch under",
        ),
        (
            rolls("1%"),
            &[&one],
            "drive",
            "slips one way by 62.00 um, the patch",
        ),
        (fretting, &[&one], "drive", "the patch to and fro"),
    ] {
        let runs: Vec<&str> = runs.iter().map(|r| r.as_str()).collect();
        let (code, text) = with(of.clone(), &runs, &[]);
        assert_eq!(code, Some(2), "{what}: {text}");
        assert!(
            text.contains(words) && text.contains("accept "),
            "{what}: {text}"
        );
        let (code, text) = with(of, &runs, &["--accept", what]);
        assert_eq!(code, Some(0), "{what}: {text}");
        let said = text.contains("INPUTS DIFFER") || text.contains("OTHER ");
        assert!(said, "{what}: {text}");
    }
    let (code, text) = with(half(), &[&one], &["--accept", "everything"]);
    assert!(code == Some(2) && text.contains("untrusted"), "{text}");
    // A run that is not trustworthy, and one whose case is not known.
    let summary = Path::new(&one).join("summary.json");
    let changed = std::fs::read_to_string(&summary).unwrap();
    let changed = changed
        .replace(r#""trustworthy": true"#, r#""trustworthy": false"#)
        .replace(
            r#""reasons": []"#,
            r#""reasons": ["NOT CONVERGED: of a test"]"#,
        );
    std::fs::write(&summary, changed).unwrap();
    std::fs::remove_file(Path::new(&one).join("results.h5")).unwrap();
    let (code, text) = with(half(), &[&one], &[]);
    assert_eq!(code, Some(2), "{text}");
    for words in [
        "NOT CONVERGED: of a test",
        "no results.h5",
        "accept untrusted,materials,pressure",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let (code, text) = with(
        half(),
        &[&one],
        &["--accept", "untrusted,materials,pressure"],
    );
    assert!(code == Some(0) && text.contains("NOT TRUSTED"), "{text}");
}

#[test]
fn where_hertz_does_not_hold_is_said() {
    let heavy = said(&[
        "--load",
        "75kN",
        "--radius",
        "10mm",
        "--material",
        "rail_steel_r260",
    ]);
    assert!(
        heavy.contains("NOT ELASTIC") && heavy.contains("NOT HERTZ"),
        "{heavy}"
    );
    let yields = said(&[&WHEEL[..], &["--yield", "650MPa"]].concat());
    assert!(
        yields.contains("YIELDS AT FIRST") && yields.contains("as yield stress"),
        "{yields}"
    );
    let creeps = said(&[&WHEEL[..], &["--yield", "650MPa", "--friction", "0.5"]].concat());
    assert!(creeps.contains("BEYOND SHAKEDOWN"), "{creeps}");
    let unknown = said(&[
        "--load",
        "1N",
        "--radius",
        "1m",
        "--young",
        "1GPa",
        "--poisson",
        "0.3",
    ]);
    assert!(unknown.contains("NO STRENGTH"), "{unknown}");
    let unlike = said(&[
        "--load",
        "1N",
        "--radius",
        "1m",
        "--young",
        "1GPa,210GPa",
        "--poisson",
        "0.3",
        "--friction",
        "0.3",
    ]);
    assert!(unlike.contains("UNLIKE MATERIALS"), "{unlike}");
}

#[test]
fn wrong_questions_are_refused_with_what_to_change() {
    let base = ["--radius", "1m", "--material", "rail_steel_r260"];
    for (arguments, words) in [
        (&["--load", "75 km"][..], "load: "),
        (&["--load", "-1N"], "above zero"),
        (&["--load", "1N", "--creepage", "1%"], "give friction"),
        (&["--load", "1N", "--displacement", "1um"], "give friction"),
        (&["--load", "1N/m", "--across", "1m"], "line contact"),
        (&["--load", "1N", "--across=-1m"], "conform"),
        (&["--load", "1N", "--friction", "2..1"], "no range"),
        (
            &["--load", "1N", "--friction", "0.3", "--wear", "1e-4"],
            "give friction and creepage",
        ),
        (
            &["--load", "1N", "--friction-of", "/nowhere"],
            "summary.json",
        ),
        (&["--load", "1N", "--accept", "pressure"], "--friction-of"),
        (&["--load", "1N", "--window", "1m"], "wider than the patch"),
        (&["--load", "1N", "--hardness", "50 HRC"], "hardness"),
        (
            &[
                "--load",
                "1N/m",
                "--friction",
                "0.3",
                "--displacement",
                "1um",
            ],
            "line contact",
        ),
    ] {
        let output = patch(&[&base[..], arguments].concat());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
    let output = patch(&[
        "--load",
        "1N",
        "--radius",
        "1m",
        "--material",
        "rail_steel_r26",
    ]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.contains("did you mean `rail_steel_r260`"), "{text}");
    let text = said(&["--help"]);
    assert!(text.contains("A wheel on a rail") && text.contains("--creepage"));
}
