//! Numbers of the case, and its bodies.

use super::trial::{PLANE, refused, with};

#[test]
fn a_step_that_is_none() {
    for bad in ["0.0", "-1e-3", "NaN"] {
        refused(
            &with(PLANE, "step: 1e-3", &format!("step: ‸{bad}")),
            &["must be positive, got"],
        );
    }
}

#[test]
fn theta_out_of_range() {
    for bad in ["0.4", "1.5", "NaN"] {
        refused(
            &with(PLANE, "theta: 0.5", &format!("theta: ‸{bad}")),
            &["expected a number between 0.5 and 1"],
        );
    }
}

#[test]
fn a_fourth_dimension() {
    refused(
        &with(PLANE, "dimension: 2", "dimension: ‸4"),
        &["expected 2 or 3"],
    );
}

#[test]
fn a_table_whose_times_do_not_rise() {
    refused(
        &with(
            PLANE,
            "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))",
            "y: ‸Force(Table([(0.0, -1.0), (0.0, -2.0)]))",
        ),
        &["the times of a table must rise"],
    );
}

#[test]
fn a_free_body_without_mass() {
    refused(
        &with(
            &with(PLANE, "mass: 1.0,", ""),
            "(\n            name: \"lid\"",
            "‸(\n            name: \"lid\"",
        ),
        &["the body `lid` moves under forces, so it needs a `mass`"],
    );
}

#[test]
fn two_bodies_of_one_name() {
    refused(
        &with(PLANE, r#"name: "lid""#, r#"name: ‸"floor""#),
        &["two bodies are named `floor`"],
    );
}

#[test]
fn a_friction_test_of_an_unknown_body() {
    refused(
        &with(
            PLANE,
            r#"friction: (body: "lid""#,
            r#"friction: (body: ‸"lit""#,
        ),
        &[
            "there is no body `lit`",
            "expected one of floor, lid",
            "did you mean `lid`?",
        ],
    );
}

#[test]
fn a_motion_that_the_plane_does_not_have() {
    refused(
        &with(PLANE, "dofs: (x:", "dofs: (z: ‸Velocity(Constant(1.0)), x:"),
        &["there is no z in two dimensions", "expected x, y or rz"],
    );
}

#[test]
fn a_frame_too_wide_to_draw() {
    refused(
        &with(PLANE, "frames: 0", "frames: 1, width: ‸100000"),
        &["expected 200 to 16384 pixels"],
    );
}

#[test]
fn a_bound_for_overlaps_that_is_none() {
    for (bad, said) in [
        ("-1e-4", "-0.0001"),
        ("NaN", "NaN"),
        ("1.0", "1"),
        ("inf", "inf"),
    ] {
        refused(
            &with(
                PLANE,
                "materials:",
                &format!("solver: (projection: ‸{bad}),\n    materials:"),
            ),
            &[
                &format!("got {said}"),
                "expected 0 (never) or the fraction of a radius above which an overlap is removed, below 1",
            ],
        );
    }
}

#[test]
fn a_step_longer_than_the_run() {
    refused(
        &with(PLANE, "step: 1e-3", "step: ‸1e3"),
        &["is longer than the run"],
    );
}

#[test]
fn an_alert_distance_that_makes_all_contacts() {
    refused(
        &with(
            PLANE,
            "    grains: [",
            "    detection: (alert: ‸1e30),\n    grains: [",
        ),
        &["more than ten times the largest radius"],
    );
}

#[test]
fn an_attraction_beyond_the_alert_distance() {
    let cohesive = with(PLANE, "\"coulomb\"", "\"mohr-coulomb\"");
    let range = |value: &str| {
        with(
            &cohesive,
            "\"mu\": 0.3",
            &format!("\"mu\": 0.3, \"range\": {value}"),
        )
    };
    refused(
        &with(
            &range("‸1e-3"),
            "    grains: [",
            "    detection: (alert: 1e-4),\n    grains: [",
        ),
        &[
            "acts up to a gap of 1e-3 m, and contacts are known up to 1e-4 m",
            "detection.alert",
        ],
    );
}

#[test]
fn checkpoints_that_come_at_no_time() {
    for (rule, said) in [
        (
            "Steps(0)",
            "steps between two checkpoints; use Never for none",
        ),
        (
            "Seconds(-1.0)",
            "seconds between two checkpoints must not be negative",
        ),
        ("Hourly", "unknown variant `Hourly`"),
    ] {
        let to = format!("output: (checkpoint: ‸{rule}, frames: 0");
        refused(&with(PLANE, "output: (frames: 0", &to), &[said]);
    }
}

#[test]
fn statistics_that_are_never_written() {
    refused(
        &with(PLANE, "output: (frames: 0", "output: (every: ‸0, frames: 0"),
        &["steps between two rows"],
    );
}

#[test]
fn a_measure_that_begins_at_no_time() {
    for (kind, more) in [
        ("Slope", "from: 0.1, to: 0.2"),
        ("Mass", "axis: 1, above: 0.0"),
        ("Shear", "low: 0.0, high: 0.1"),
    ] {
        let list = format!("    measures: [{kind}(name: \"m\", {more}, start: ‸NaN)],\n");
        let case = with(PLANE, "    friction: (", &format!("{list}    friction: ("));
        refused(&case, &["must be finite, got NaN"]);
    }
}

#[test]
fn a_half_space_across_a_period() {
    for normal in ["[1.0, 0.0]", "[1e-3, 1.0]"] {
        let case = with(
            PLANE,
            "HalfSpace(normal: [0.0, 1.0])",
            &format!("HalfSpace(normal: ‸{normal})"),
        );
        refused(&case, &["this one cuts across x"]);
    }
}
