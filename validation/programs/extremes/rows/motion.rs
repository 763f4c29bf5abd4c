//! Speeds up to 100 km/s.

use super::super::bench::Cause::Passed;
use super::super::bench::{Expected, Group, HELD, Row, Sketch, go, place, refused, reported};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use std::f64::consts::{FRAC_PI_4, SQRT_2};

pub const SPEED: Group = Group {
    name: "speed",
    criterion: "a ball thrown at a post stays in front of it, and the energy does not increase",
    runs: &[(2, speeds::<Dim2>), (3, speeds::<Dim3>)],
    quick: true,
};

pub const CORNERS: Group = Group {
    name: "corners at speed",
    criterion: "a box thrown at a profile or a height field stays in front of it, and the energy does not increase",
    runs: &[(2, corners::<Dim2>), (3, corners::<Dim3>)],
    quick: true,
};

/// Alert distance of the other rows (m).
const NEAR: f64 = 1e-3;

fn speeds<S: Space>() -> Vec<Row> {
    let thrown = |(v, alert, expected): (f64, f64, Expected)| {
        let (start, post) = (place::<S>(0.0, 0.0, 0.0), place::<S>(1.0, 0.0, 0.0));
        let sketch = Sketch {
            gravity: 0.0,
            detection: [alert, 1e-2],
            bodies: format!(
                r#"(name: "post", material: "m0", position: {post}, shapes: [Balls([({start}, 0.1)])]),"#
            ),
            grains: format!(
                r#"List(material: "m0", grains: [(at: {start}, radius: 0.1, velocity: {})])"#,
                place::<S>(v, 0.0, 0.0)
            ),
            ..Sketch::default()
        };
        let wide = if alert > NEAR {
            ", alert of 2 radii"
        } else {
            ""
        };
        let value = format!(
            "{v:.0e} m/s, {:.0e} radii a step{wide}",
            v * sketch.step / 0.1
        );
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, expected, &e),
        };
        let start = s.state.energy.kinetic;
        let steps = (2.0 / (v * s.options.scheme.h)).ceil().max(10.0) as u64;
        let ran = go(&mut s, steps);
        let x = s
            .state
            .bodies
            .grains()
            .next()
            .map_or(f64::NAN, |b| s.state.bodies.position[b][0]);
        let gained = s.state.energy.kinetic / start - 1.0;
        let found = format!("at x = {x:.3} m, the post's side at 0.8; energy {gained:.1e}");
        let met = x < 0.8 + 1e-6 && gained <= 1e-12;
        ran.row(&s, (value, found), met, expected)
    };
    [
        (1.0, NEAR, HELD),
        (1e2, NEAR, HELD),
        // The pair is detected at the start of the step.
        (1e2, 0.2, HELD),
        (1e3, NEAR, HELD),
        // The ball is beyond the post within the half step before the first detection.
        (1e4, NEAR, reported(&[Passed])),
        (1e5, NEAR, reported(&[Passed])),
    ]
    .map(thrown)
    .into()
}

/// A box of 0.1 m at a speed given in box sides per step, starting slightly more than the alert
/// distance above the surface at the end of a step: with a side down on a flat surface, or an edge
/// down above a valley.
fn corners<S: Space>() -> Vec<Row> {
    let thrown = |(sides, valley, expected): (f64, bool, Expected)| {
        let v = sides * 0.1 / Sketch::default().step;
        let (half, turn, rise) = if valley {
            (0.05 * SQRT_2, FRAC_PI_4, 0.1)
        } else {
            (0.05, 0.0, 0.0)
        };
        let at = place::<S>(1.0, 1.0, half + 1.01 * NEAR + 1.5 * sides * 0.1);
        let velocity = place::<S>(0.0, 0.0, -v);
        let (surface, kind, shape) = if S::D == 2 {
            let points = "points: [(-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)]";
            (
                format!("Profile(side: Below, points: [(0.0, {rise}), (1.0, 0.0), (2.0, {rise})])"),
                "Polygons",
                format!("{points}, angle: {turn:?}"),
            )
        } else {
            let row = format!("{rise}, 0.0, {rise}");
            (
                format!(
                    "HeightField(points: (3, 3), spacing: (1.0, 1.0), heights: [{row}, {row}, {row}])"
                ),
                "Polyhedra",
                format!("size: (0.1, 0.1, 0.1), turned: [0.0, {turn:?}, 0.0]"),
            )
        };
        let sketch = Sketch {
            gravity: 0.0,
            bodies: format!(r#"(name: "rail", material: "m0", shapes: [{surface}]),"#),
            grains: format!(
                "{kind}(material: \"m0\", grains: [(at: {at}, {shape}, velocity: {velocity})])"
            ),
            ..Sketch::default()
        };
        let lying = if valley {
            ", edge down on a valley"
        } else {
            ""
        };
        let value = format!("{sides} of its side a step{lying}");
        let mut s = match sketch.build::<S>() {
            Ok(s) => s,
            Err(e) => return refused(value, expected, &e),
        };
        let start = s.state.energy.kinetic;
        let ran = go(&mut s, 10);
        let b = s.state.bodies.grains().next();
        let up = b.map_or(f64::NAN, |b| s.state.bodies.position[b][S::D - 1]);
        let gained = s.state.energy.kinetic / start - 1.0;
        let found = format!("at height {up:.3} m, {half:.3} at rest; energy {gained:.1e}");
        let met = up > 0.0 && gained <= 1e-12;
        ran.row(&s, (value, found), met, expected)
    };
    [
        (0.01, false, HELD),
        (0.1, false, HELD),
        (0.17, false, HELD),
        (0.01, true, HELD),
        (0.1, true, HELD),
        (0.17, true, HELD),
        (0.3, false, HELD),
        (5.0, false, HELD),
    ]
    .map(thrown)
    .into()
}
