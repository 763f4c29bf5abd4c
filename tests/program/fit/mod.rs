//! `fretwork fit` through the program: planted parameters are found within their intervals;
//! directions that the measurements do not determine, ends of ranges, failed runs, resuming, and
//! invalid input.

use crate::temp::TempFolder;
use serde_json::Value;
use std::process::{Command, Output};

/// A slider whose velocity increases to 4 m/s: friction is mu_0 ((1 - A) exp(-B v) + A), Polach's
/// law, in every row.
const SLIDER: &str = r#"(
    name: "friction test", dimension: 2, time: (step: 1e-3, end: 0.4),
    materials: {"steel": "contact_steel"},
    solver: (tolerance: 1e-10, norm: Velocity, max_iterations: 1000, test_every: 1),
    detection: (alert: 1e-3, skin: 0.05),
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "rail-falling-friction",
        parameters: (contact: {"mu_0": 0.5, "a": 0.3, "b": 0.9}))],
    bodies: [
        (name: "flat", material: "steel", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "slider", material: "steel", shapes: [Balls([([0.0, 0.0], 0.1)])], position: [0.0, 0.1],
            dofs: (x: Velocity(Ramp(from: 0.0, to: 4.0, start: 0.0, end: 0.4)), y: Force(Constant(-1000.0)), rz: Fixed)),
    ],
    friction: (body: "slider", along: 0, normal: 1),
    output: (frames: 0, views: 0, figures: false, every: 4),
)"#;

/// A folder of a test with the case and a measured curve, removed at its end.
struct Folder(TempFolder);

impl Folder {
    fn new(name: &str) -> Self {
        let path = TempFolder::new(&format!("fit-{name}"));
        let folder = Self(path);
        folder.put("slider.ron", SLIDER);
        folder.put("measured.csv", &measured(0.3));
        folder
    }

    fn put(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).unwrap();
    }

    /// Returns a fit of the friction curve with these parameters and other fields.
    fn fit(&self, parameters: &str, more: &str, set: &str) -> Output {
        self.fit_against("slider_vx - 0.01", parameters, more, set)
    }

    /// Returns a fit with this expression for the velocity.
    fn fit_against(&self, velocity: &str, parameters: &str, more: &str, set: &str) -> Output {
        let text = format!(
            r#"(tests: [Curve(name: "friction", case: "slider.ron", set: [{set}],
                measured: (file: "measured.csv", x: "v", y: "mu", sigma: Value(0.01)), model: (x: "{velocity}", y: "mu"))],
                parameters: [{parameters}], {more})"#
        );
        self.put("fit.ron", &text);
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        command.current_dir(&self.0);
        command.args(["fit", "fit.ron", "--out", "out", "--jobs", "2", "--json"]);
        command.output().unwrap()
    }

    fn found(&self, parameters: &str, more: &str, set: &str) -> Value {
        let output = self.fit(parameters, more, set);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    fn refused(&self, parameters: &str, more: &str, set: &str) -> String {
        let output = self.fit(parameters, more, set);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    }
}

/// The law with mu_0 0.5, A `a`, B 0.9 s/m at 30 velocities, with noise of 0.01 from a linear
/// congruential generator: sums of twelve numbers of a uniform distribution less their mean.
fn measured(a: f64) -> String {
    let mut state = 7u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut text = "v [m/s],mu\n".to_owned();
    for k in 1..=30 {
        let v = 0.12 * f64::from(k);
        let noise = 0.01 * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0);
        let mu = 0.5 * ((1.0 - a) * (-0.9 * v).exp() + a) + noise;
        text += &format!("{v},{mu}\n");
    }
    text
}

const MU_0: &str =
    r#"(name: "mu_0", key: "interfaces.dry.parameters.contact.mu_0", low: 0.1, high: 1.0)"#;
const A: &str = r#"(name: "a", key: "interfaces.dry.parameters.contact.a", low: 0.05, high: 0.95)"#;
const B: &str =
    r#"(name: "b", key: "interfaces.dry.parameters.contact.b", low: 0.1, high: 10.0, scale: Log)"#;

fn parameter<'a>(found: &'a Value, name: &str) -> &'a Value {
    let all = found["parameters"].as_array().unwrap();
    all.iter().find(|p| p["name"] == name).unwrap()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no {key} in {value}"))
}

/// The simultaneous intervals contain the planted values and are narrower than the ranges; the sum
/// of squares is that of 30 values with 3 parameters (27 +- 2.6 x 7.3); a second call makes no run
/// and finds equal results.
#[test]
fn planted_parameters_are_found_within_their_intervals() {
    let folder = Folder::new("planted");
    let all = [MU_0, A, B].join(", ");
    let found = folder.found(&all, "", "");
    for (name, truth) in [("mu_0", 0.5), ("a", 0.3), ("b", 0.9)] {
        let p = parameter(&found, name);
        let (low, high) = (
            number(p, "simultaneous_low"),
            number(p, "simultaneous_high"),
        );
        assert!(low <= truth && truth <= high, "{name}: {low} to {high}");
        assert!(high - low < 0.6 * truth, "{name}: {low} to {high}");
        assert_eq!(p["determined"], true);
    }
    let squares = number(&found, "chi_squared");
    assert!((8.0..46.0).contains(&squares), "{squares}");
    assert_eq!(found["describes"], true);
    let runs = || {
        std::fs::read_dir(folder.0.join("out/runs"))
            .unwrap()
            .count()
    };
    let before = runs();
    assert!(before > 60);
    assert_eq!(folder.found(&all, "", ""), found);
    assert_eq!(runs(), before);
    for file in [
        "fit.html",
        "fit.png",
        "fit.json",
        "curves.csv",
        "evaluations.csv",
    ] {
        assert!(folder.0.join("out").join(file).is_file(), "{file}");
    }
}

/// Only the product of two factors has an effect: their ratio is not determined, and each may have
/// any value.
#[test]
fn what_measurements_do_not_tell_is_said() {
    let folder = Folder::new("flat");
    let two = r#"(name: "p", low: 0.1, high: 10.0, scale: Log), (name: "q", low: 0.01, high: 1.0, scale: Log)"#;
    let set = r#""interfaces.dry.parameters.contact.mu_0=${p * q}""#;
    let found = folder.found(two, "search: (points: 16, generations: 8)", set);
    let directions = found["directions"].as_array().unwrap();
    let flat: Vec<&Value> = directions
        .iter()
        .filter(|d| d["determined"] == false)
        .collect();
    assert_eq!(flat.len(), 1, "{directions:?}");
    let words = flat[0]["words"].as_str().unwrap();
    assert!(["p up, q down", "q up, p down"].contains(&words), "{words}");
    assert_eq!(parameter(&found, "p")["determined"], false);
    let product = number(parameter(&found, "p"), "value") * number(parameter(&found, "q"), "value");
    assert!((product - 0.5).abs() < 0.05, "{product}");
}

/// The true value is beyond the range: the parameter is at its end, and the model does not describe
/// the measurement.
#[test]
fn a_range_without_the_truth_is_told() {
    let folder = Folder::new("end");
    let low =
        r#"(name: "mu_0", key: "interfaces.dry.parameters.contact.mu_0", low: 0.1, high: 0.4)"#;
    let found = folder.found(low, "search: (points: 8, generations: 8)", "");
    assert_eq!(parameter(&found, "mu_0")["at"], "highest");
    assert_eq!(found["describes"], false);
    assert!(number(&found, "widened") > 2.0);
}

/// Half of the region gives no curve, since the slider does not reach the measured velocities:
/// these points are stored with their reason, and the rest is searched.
#[test]
fn failed_runs_are_data() {
    let folder = Folder::new("failed");
    let both = [MU_0, r#"(name: "top", low: 2.0, high: 6.0)"#].join(", ");
    let set =
        r#""bodies.slider.dofs.x=Velocity(Ramp(from: 0.0, to: ${top}, start: 0.0, end: 0.4))""#;
    let found = folder.found(&both, "search: (points: 12, generations: 8)", set);
    assert!(number(&found, "failed") >= 3.0, "{found}");
    let mu = number(parameter(&found, "mu_0"), "value");
    assert!((mu - 0.5).abs() < 0.03, "{mu}");
    let table = std::fs::read_to_string(folder.0.join("out/evaluations.csv")).unwrap();
    assert!(table.contains("run it farther"), "{table}");
}

/// A row has velocity and friction at the end of its step. As a function of the velocity at its
/// beginning the curve is shifted by 10 m/s^2 times the step. The error of the estimate is
/// proportional to the step, so the change with half the step is half of the error; the sum of
/// squares does not show it.
#[test]
fn a_step_that_moves_a_parameter_is_told() {
    let folder = Folder::new("step");
    let coarse = r#""time.step=8e-3", "output.every=1""#;
    let fit = |velocity: &str, set: &str| {
        let output = folder.fit_against(velocity, MU_0, "search: (points: 6)", set);
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        let page = std::fs::read_to_string(folder.0.join("out/fit.html")).unwrap();
        let mu = parameter(&found, "mu_0").clone();
        let half_width = 0.5 * (number(&mu, "high") - number(&mu, "low"));
        let reported = page.contains("STEP NOT SMALL");
        let flagged = found["step_not_small"].as_array().unwrap().len() == 1;
        assert_eq!(flagged, reported);
        let half = number(&mu["half_step"], "value");
        (number(&mu, "value"), half, half_width, reported)
    };
    let (value, half, width, reported) = fit("slider_vx - 10 * time_step", coarse);
    assert!(
        reported && (value - 0.5).abs() > width,
        "{value} +- {width}"
    );
    assert!((2.0 * half - value - 0.5).abs() < width, "{value} {half}");
    // Without the shift there is no error.
    let (value, half, width, reported) = fit("slider_vx", coarse);
    assert!(
        !reported && (value - 0.5).abs() < width,
        "{value} +- {width}"
    );
    assert!((half - value).abs() < 0.1 * width, "{value} {half}");
}

#[test]
fn wrong_input_is_refused_with_what_to_change() {
    let folder = Folder::new("wrong");
    let said = folder.refused(r#"(name: "x", low: 0.0, high: 1.0)"#, "", "");
    assert!(said.contains("no test uses this parameter"), "{said}");
    // A key that contains the letters of the parameter's name does not use it.
    let said = folder.refused(
        r#"(name: "mu", low: 0.0, high: 1.0)"#,
        "",
        r#""interfaces.dry.parameters.contact.mu_0=0.5""#,
    );
    assert!(said.contains("no test uses this parameter"), "{said}");
    for (more, words) in [
        ("threads: 0", "one thread or more"),
        ("unconverged: 2.0", "a number from 0 to 1"),
        ("search: (points: 0)", "one point or more"),
    ] {
        let said = folder.refused(MU_0, more, "");
        assert!(said.contains(words), "{said}");
    }
    let said = folder.refused(&MU_0.replace(")", ", scale: Integer)"), "", "");
    assert!(said.contains("vary continuously"), "{said}");
    let said = folder.refused(&MU_0.replace("mu_0\",", "mu\","), "", "");
    assert!(
        said.contains("did you mean") || said.contains("mu_0"),
        "{said}"
    );
    let said = folder.refused(&[MU_0, A].join(", "), r#"order: [("a", "c")]"#, "");
    assert!(said.contains("`c` is no parameter"), "{said}");
    let said = folder.refused(&MU_0.replace("high: 1.0", "high: 0.05"), "", "");
    assert!(
        said.contains("smaller first") && said.contains("fit.ron"),
        "{said}"
    );
    folder.put("measured.csv", "v,friction\n1.0,0.4\n");
    let said = folder.refused(MU_0, "", "");
    assert!(
        said.contains("no column `mu`; there are v, friction"),
        "{said}"
    );
}
