//! Numbers that are valid individually but together exceed the range of the computation: they are
//! rejected at their position, or the run ends with a message; no value that is not finite reaches
//! a file of a run that reports success.

use super::trial::{PLANE, SOLID, Trial, refused, with};

const GRAIN: &str = "(at: [0.15, 0.15, 0.02], radius: 0.01)";

fn solid(old: &str, new: &str) -> String {
    with(SOLID, old, new)
}

#[test]
fn a_spin_whose_square_overflows() {
    refused(
        &solid(
            GRAIN,
            "‸(at: [0.15, 0.15, 0.02], radius: 0.01, spin: [1e160, 1e160, 0.0])",
        ),
        &["its kinetic energy at the start is inf J", "spin"],
    );
}

#[test]
fn masses_that_vanish_or_overflow() {
    for radius in ["1e-108", "1e-130", "1e105"] {
        let grain = format!("‸(at: [0.15, 0.15, 2e106], radius: {radius})");
        refused(
            &solid(GRAIN, &grain),
            &["outside the range of the computation"],
        );
    }
}

#[test]
fn gravity_whose_work_overflows() {
    refused(
        &solid("gravity: [0.0, 0.0, -9.81]", "gravity: ‸[0.0, 0.0, -1e160]"),
        &["a fall over the run ends with an energy of inf J"],
    );
}

#[test]
fn a_body_so_far_away_that_it_would_never_move() {
    let case = with(PLANE, "step: 1e-3, end: 0.002", "step: 1e-7, end: 1e-4");
    let case = with(&case, "periodic: (x: 0.4),\n", "");
    refused(
        &with(
            &case,
            "(at: [0.05, 0.011], radius: 0.01)",
            "‸(at: [5e6, 0.011], radius: 0.01, velocity: [1e-3, 0.0])",
        ),
        &["numbers are 9.3e-10 m apart", "it would never move"],
    );
}

/// The drive takes the lid out of the range of numbers while the run goes on.
#[test]
fn what_overflows_later_ends_the_run() {
    let trial = Trial::new();
    let drive = "x: Velocity(Table([(0.0, 0.0), (0.0015, 0.0), (0.002, 1e300)]))";
    let case = with(
        PLANE,
        "x: Displacement(Sine(amplitude: 1e-4, frequency: 20.0))",
        drive,
    );
    trial.write("case.ron", case);
    let output = trial.call(&["run", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("body `lid`") && said.contains("inf"),
        "{said}"
    );
    let rows = std::fs::read_to_string(trial.path("results/case/statistics.csv")).unwrap();
    assert!(!rows.contains("inf") && !rows.contains("NaN"), "{rows}");
}

/// A floor that is far from the origin moves by less than the spacing of numbers there.
#[test]
fn motion_that_is_lost_later_is_reported() {
    let trial = Trial::new();
    let drive = "x: Velocity(Table([(0.0, 1e13), (0.0005, 1e13), (0.00051, 1e-3), (0.002, 1e-3)]))";
    let case = with(
        PLANE,
        "x: Displacement(Sine(amplitude: 1e-4, frequency: 20.0))",
        drive,
    );
    trial.write(
        "case.ron",
        with(&case, "step: 1e-3, end: 0.002", "step: 1e-4, end: 0.002"),
    );
    let output = trial.call(&["run", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let summary = std::fs::read_to_string(trial.path("results/case/summary.json")).unwrap();
    assert!(
        summary.contains("MOTION LOST") && summary.contains("body `lid`"),
        "{summary}"
    );
}

#[test]
fn steps_whose_square_vanishes_or_overflows() {
    for (step, end) in [
        ("1e-320", "1e-319"),
        ("1e-160", "1e-159"),
        ("1e155", "1e156"),
    ] {
        let time = format!("step: ‸{step}, end: {end}");
        refused(
            &solid("step: 1e-3, end: 0.002", &time),
            &[
                "the square of a step",
                "outside the range of the computation",
            ],
        );
    }
}
