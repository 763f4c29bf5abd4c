//! `fretwork contact-patch`: answers, and rejected questions.

mod mistakes;
mod runs;

use serde_json::Value;
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
    // R260 yields first, at 1.6 Y with the yield stress of its file before it hardens; once it has
    // hardened the wheel is the softer, whose file has no such stress. Without a yield stress there
    // is the flow stress, H/2.8.
    near(number(&got, "/strength/first_yield"), 1.6 * 472e6, 1e-12);
    assert_eq!(got["strength"]["body"], "rail_steel_r260");
    assert_eq!(got["strength"]["kind"], "monotonic");
    let k = 520e6 / 3.0f64.sqrt();
    near(number(&got, "/strength/shakedown"), 4.7 * k, 1e-12);
    assert_eq!(got["strength"]["in_service"]["body"], "wheel_steel_er7");
    let rail = [&WHEEL[..6], &["--material", "rail_steel_r260"]].concat();
    let hardened = json(&rail);
    near(
        number(&hardened, "/strength/shakedown"),
        4.7 * 588e6 / 3.0f64.sqrt(),
        1e-12,
    );
    assert_eq!(hardened["strength"]["in_service"]["kind"], "hardened");
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

/// The shakedown limit is k/(Q/P) of the tangential force that acts, and k/mu in full slip where
/// none is given.
#[test]
fn shakedown_is_lowered_by_the_tangential_force() {
    let k = 520e6 / 3.0f64.sqrt();
    let limit = |more: &[&str]| {
        let got = json(&[&WHEEL[..], &["--friction", "0.4"], more].concat());
        let of = |name: &str| number(&got, &format!("/strength/{name}"));
        near(of("shakedown_rolling"), 4.7 * k, 1e-12);
        near(of("shakedown"), k / of("traction/ratio"), 1e-12);
        of("traction/ratio")
    };
    near(limit(&[]), 0.4, 1e-12);
    near(limit(&["--force", "22.5kN"]), 0.3, 1e-12);
    let creeps = limit(&["--creepage", "0.5%"]);
    let rolls = ["--friction", "0.4", "--creepage", "0.5%"];
    let got = json(&[&WHEEL[..], &rolls].concat());
    near(creeps, number(&got, "/rolling/adhesion/value"), 1e-12);
    let full = said(&[&WHEEL[..], &["--friction", "0.4"]].concat());
    for words in [
        "BEYOND SHAKEDOWN",
        "in full slip (1.411 GPa in free rolling;",
        "steel not yet deformed",
    ] {
        assert!(full.contains(words), "{words} in {full}");
    }
    let asked = said(&[&WHEEL[..], &rolls].concat());
    let ratio = format!("at Q/P {creeps:.3}; with");
    assert!(asked.contains(&ratio), "{asked}");
    let little = ["--friction", "0.4", "--force", "10kN"];
    let little = said(&[&WHEEL[..], &little].concat());
    assert!(little.contains("YIELDS AT FIRST"), "{little}");
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

/// The creep curve of CONTACT (github.com/eve70a/CONTACT) for 106.7 kN, G 82 GPa, nu 0.28, R 625 mm
/// along the rolling, mu 0.33 and semi-axes as 1 to 2, by 48 x 44 cells, which are about 1 % from
/// those of no size.
#[test]
fn an_ellipse_rolls_as_in_contact() {
    let bodies = "--load 106.7kN --radius 625mm,flat --across 1.77672m,flat --young 209.92GPa \
                  --poisson 0.28 --friction 0.33 --creepage";
    let base: Vec<&str> = bodies.split_whitespace().collect();
    for (creepage, share) in [
        ("0.04%", 0.2588),
        ("0.12%", 0.6482),
        ("0.2%", 0.8816),
        ("0.28%", 0.9832),
    ] {
        let got = json(&[&base[..], &[creepage]].concat());
        let [a, b] = ["", "_across"].map(|k| number(&got, &format!("/patch/semi_axis{k}")));
        near(a / b, 0.5, 1e-5);
        near(number(&got, "/rolling/adhesion/value"), 0.33 * share, 0.012);
        assert!(number(&got, "/rolling/grid") < 0.015);
    }
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
        severe.contains("has severe at this slip speed") && severe.contains("not 1e-4..1e-3"),
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
