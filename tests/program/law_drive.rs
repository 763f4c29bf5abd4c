//! `fretwork law drive` gives known reference values.

use serde_json::Value;
use std::process::Command;

fn drive(line: &str) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["law", "drive"])
        .args(line.split_whitespace())
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn rows(line: &str) -> Vec<Value> {
    let (code, out, error) = drive(&format!("{line} --json"));
    assert_eq!(code, Some(0), "{line}: {error}");
    serde_json::from_str(&out).unwrap()
}

fn number(row: &Value, name: &str) -> f64 {
    row[name]
        .as_f64()
        .unwrap_or_else(|| panic!("no {name} in {row}"))
}

fn close(name: &str, got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got / expected - 1.0).abs() <= tolerance,
        "{name}: {got} for {expected}"
    );
}

/// Peak sqrt(w C) and area w (1 - u_0^2/(2 u^2)...) of MAC: u_0^2 C/2 w of the energy w is still
/// stored at u.
#[test]
fn mac_has_its_peak_and_area() {
    let path =
        "--set c_n=1e12 --set w=0.1 --set beta_broken=0 --to 1e-5 --rate 0.045 --steps 100000";
    let rows = rows(&format!("mac {path}"));
    let peak = rows
        .iter()
        .map(|r| number(r, "traction_n"))
        .fold(0.0, f64::max);
    close("peak", peak, 0.316228e6, 1e-3);
    let last = rows.last().unwrap();
    // From u_0 on the traction is w^2/(C u^3), with the area w/2 + w/2 (1 - u_0^2/u^2).
    let share = 0.1 / 1e12 / 1e-10;
    close(
        "area",
        number(last, "work"),
        0.1 * (1.0 - 0.5 * share),
        1e-4,
    );
}

#[test]
fn viscous_mac_meets_its_table() {
    for (b, peak, area) in [
        (1e-6, 0.36159e6, 0.16741),
        (1e-5, 0.52941e6, 0.44568),
        (1e-4, 0.98853e6, 1.71835),
    ] {
        let rows = rows(&format!(
            "mac --set b={b:e} --set beta_broken=0 --to 1e-4 --rate 0.045 --steps 100000"
        ));
        let highest = rows
            .iter()
            .map(|r| number(r, "traction_n"))
            .fold(0.0, f64::max);
        close("peak", highest, peak, 1e-2);
        close("area", number(rows.last().unwrap(), "work"), area, 1e-2);
    }
}

/// For Benzeggagh and Kenane's mode mixes of AS4/PEEK, G_II/G_T is sin^2 of the angle.
#[test]
fn mixed_modes_take_their_energy() {
    for (share, energy) in [(0.2f64, 987.99), (0.5, 1123.00), (0.8, 1419.52)] {
        let angle = share.sqrt().asin().to_degrees();
        let rows = rows(&format!(
            "camanho-davila --mode mixed --angle {angle} --to 5e-5 --steps 20000"
        ));
        close("energy", number(rows.last().unwrap(), "work"), energy, 1e-3);
    }
}

/// A velocity ten times higher: at first + a ln 10, in the end (a - b) ln 10.
#[test]
fn rate_and_state_steps_as_it_should() {
    let set = "--set a=0.010 --set b=0.015 --set mu_0=0.6 --set v_0=1e-6 --set d_c=1e-5";
    let rows = rows(&format!(
        "rate-and-state {set} --mode slide --velocities 1e-6,1e-5 --to 1e-3 --steps 10000"
    ));
    let mu: Vec<f64> = rows.iter().skip(1).map(|r| number(r, "friction")).collect();
    close("steady", mu[9_999], 0.6, 1e-6);
    let highest = mu[10_000..].iter().copied().fold(0.0, f64::max);
    close("direct effect", highest - 0.6, 0.010 * 10f64.ln(), 1e-2);
    close(
        "evolved",
        mu.last().unwrap() - 0.6,
        -0.005 * 10f64.ln(),
        1e-2,
    );
}

#[test]
fn under_force_the_bond_fails_at_its_strength() {
    let (code, out, error) = drive("mac --mode force --to 4e5 --steps 400");
    assert_eq!(code, Some(0), "{error}");
    assert!(error.contains("the bond does not carry 3.16"), "{error}");
    assert!(out.contains("peak traction 3.15"), "{out}");
}

/// A neck carries the forces of JKR: 8/9 of the pull-off in contact, the pull-off at most, and
/// nothing after it breaks.
#[test]
fn a_neck_is_pulled() {
    let rows = rows("jkr --to 2e-9 --steps 2000 --set w=0.1 --set modulus=1e11");
    let area = std::f64::consts::PI * 1e-10;
    let pull_off = 1.5 * std::f64::consts::PI * 0.1 * 1e-5;
    let force = |r: &Value| number(r, "tension_strength") * area;
    close("in contact", force(&rows[0]), 8.0 / 9.0 * pull_off, 1e-6);
    close(
        "pull-off",
        rows.iter().map(force).fold(0.0, f64::max),
        pull_off,
        1e-3,
    );
    assert_eq!(force(rows.last().unwrap()), 0.0);
}

/// The interface of a case with its parameters is driven along a path by the law's own scale: the
/// peak of MAC is sqrt(w C), and its curve has decreased to a hundredth of it at 4.64 u_0.
#[test]
fn an_interface_of_a_case_is_driven_with_its_parameters() {
    let peak = |rows: &[Value]| {
        let carried = rows.iter().map(|r| number(r, "traction_n"));
        carried.fold(0.0, f64::max)
    };
    let case = "--case cases/verification/bond_mode_1.ron";
    let u_0 = (0.1f64 / 1e12).sqrt();
    let own = rows(&format!("{case} --interface grain --steps 20000"));
    close("peak", peak(&own), (0.1f64 * 1e12).sqrt(), 1e-3);
    let last = number(own.last().unwrap(), "opening_n");
    close("path", last, 1.2 * 100f64.cbrt() * u_0, 2e-2);
    // A case with one interface needs no name; --set changes the case: four times w gives twice the
    // peak at twice the opening.
    let set = "--set interfaces.grain.parameters.damage.w=0.4";
    let other = rows(&format!("{case} {set} --steps 20000"));
    close("peak", peak(&other), 2.0 * peak(&own), 1e-3);
    let farther = number(other.last().unwrap(), "opening_n");
    close("path", farther, 2.0 * last, 2e-2);
    // Parameters may come from a file of materials, and the case composes the laws.
    let fretting = "--case cases/wheel_rail_fretting.ron --interface third_body --mode II";
    let (code, out, error) = drive(fretting);
    assert_eq!(code, Some(0), "{error}");
    assert!(
        out.starts_with(
            "third_body: contact hertz-mindlin, cohesion mac, damage mac, wear dissipated-energy"
        ),
        "{out}"
    );
}

/// Without `--to` a law is driven through its own scale: a neck and a bond until they break.
#[test]
fn a_path_without_a_length_has_the_laws_own() {
    let bond = rows("elastic-bond linear-softening --mode II");
    let last = bond.last().unwrap();
    assert_eq!(number(last, "damage"), 1.0);
    assert!(bond.iter().filter(|r| number(r, "damage") < 1.0).count() > bond.len() / 2);
    let neck = rows("jkr --set w=0.1 --set modulus=1e11");
    let held = neck.iter().filter(|r| number(r, "tension_strength") > 0.0);
    let held = held.count();
    assert!(
        held > neck.len() / 2 && held < neck.len(),
        "{held} of {}",
        neck.len()
    );
}

#[test]
fn bad_requests_are_refused() {
    for (line, part) in [
        ("mak", "did you mean `mac`?"),
        ("mac --mode III", "expected I, II, mixed"),
        ("mac --set strength=3", "no law here has this parameter"),
        ("mac elastic-bond", "are both cohesion laws"),
        ("linear-softening", "has no cohesion to damage"),
        ("jkr mohr-coulomb-brittle", "has no opening"),
        ("mac --to nan", "must be positive"),
        ("mac --cycles 0", "--cycles must be at least 1"),
        ("mac --mode mixed --angle nan", "between 0 and 90 degrees"),
        ("mac --pressure -1", "must not be negative"),
        ("mac --path /nowhere.csv", "/nowhere.csv"),
        ("mac --set w=-1", "must lie in"),
        ("mac --radius 0", "a number above 0 is expected"),
        ("--interface x", "--case"),
        ("mac --case cases/silo.ron", "cannot be used with"),
        ("--case cases/none.ron --interface x", "none.ron"),
        (
            "--case cases/wheel_rail_fretting.ron --interface third_bdy",
            "did you mean `third_body`?",
        ),
        (
            "--case cases/wheel_rail_fretting.ron",
            "several interfaces; name one with --interface: third_body, rail_oxide, wheel_oxide",
        ),
        (
            "--case cases/verification/bond_mode_1.ron --set interfaces.grain.damge=mac",
            "did you mean `damage`?",
        ),
    ] {
        let (code, _, error) = drive(line);
        assert_eq!(code, Some(2), "{line}: {error}");
        assert!(error.contains(part), "{line}: {error}");
    }
    // `--interface` requires a case: it is useless beside laws given by name.
    let (_, _, error) = drive("--interface x");
    assert!(!error.contains("<LAWS>"), "{error}");
}

/// The example with a case in the help text runs.
#[test]
fn the_example_of_the_help_runs() {
    let (_, help, _) = drive("--help");
    let example = help
        .lines()
        .find_map(|l| l.trim().strip_prefix("fretwork law drive --case"))
        .unwrap_or_else(|| panic!("{help}"));
    let example = example.split(" --png").next().unwrap_or_default();
    let (code, _, error) = drive(&format!("--case{example}"));
    assert_eq!(code, Some(0), "{example}: {error}");
}
