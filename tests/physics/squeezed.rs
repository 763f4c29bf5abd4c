//! Imposed motions that no forces can enforce: no finite impulses are a solution, and a run reports
//! this with the names of the bodies.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::{ImpossibleMotions, Simulation};

/// A lid over a floor with grains between them; the arguments are the solver's settings and the
/// contact law.
fn pressed<S: Space>(lid: &str, grains: &str, solver: &str, law: &str) -> Simulation<S> {
    let (up, down, over, axis) = if S::D == 2 {
        ("[0.0, 1.0]", "[0.0, -1.0]", "[0.0, 0.02]", "y")
    } else {
        (
            "[0.0, 0.0, 1.0]",
            "[0.0, 0.0, -1.0]",
            "[0.0, 0.0, 0.02]",
            "z",
        )
    };
    let text = format!(
        r#"(
    name: "pressed", dimension: {}, time: (step: 1e-4, end: 1.0), solver: ({solver}),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), {law})],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: {up})]),
        (name: "lid", material: "grain", mass: 1.0, position: {over}, shapes: [HalfSpace(normal: {down})], dofs: ({axis}: {lid})),
    ],
    grains: [List(material: "grain", grains: [{grains}])],
    output: (frames: 0, views: 0, figures: false),
)"#,
        S::D
    );
    scene::text::<S>(&text)
}

const DRIVEN: &str = "Displacement(Ramp(from: 0, to: -5e-3, start: 0, end: 0.05))";
const RIGID: &str = r#"contact: "coulomb", parameters: (contact: {"mu": 0.3})"#;
const SPRINGS: &str = r#"contact: "linear-contact", parameters: (contact: {"stiffness": 1e6, "restitution": 0.5, "mu": 0.3})"#;

/// Scenes of one grain, two side by side, a column of two, and columns of twelve.
fn grains(dimension: usize) -> Vec<String> {
    let columns = |count: i32, rows: i32| {
        let radius = 0.01 / f64::from(rows);
        let at = |k: i32| {
            let place = |k: i32| (2.0 * f64::from(k) + 1.0) * radius;
            let (x, z) = (place(k / rows), place(k % rows));
            let middle = if dimension == 2 { "" } else { "0.0, " };
            format!("(at: [{x:e}, {middle}{z:e}], radius: {radius:e})")
        };
        (0..count * rows).map(at).collect::<Vec<_>>().join(", ")
    };
    vec![columns(1, 1), columns(2, 1), columns(1, 2), columns(6, 12)]
}

/// Report of a run of some steps on its imposed motions, the largest force on the lid (N), and the
/// number of converged steps.
fn reported<S: Space>(s: &mut Simulation<S>, steps: usize) -> (ImpossibleMotions, f64, usize) {
    let (mut reported, mut force, mut converged) = (ImpossibleMotions::default(), 0.0f64, 0);
    for _ in 0..steps {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        reported.add(s.state.time, |body| s.state.bodies.name(body), &report);
        converged += usize::from(report.solver.converged);
        let received = s.state.received.iter().map(|r| r.0[S::D - 1].abs());
        force = received.fold(force, f64::max);
    }
    (reported, force / s.options.scheme.h, converged)
}

fn cannot_be_obeyed<S: Space>() {
    for list in grains(S::D) {
        for method in ["Auto", "Anderson", "Newton", "Interior", "Nlgs"] {
            let solver = format!("method: {method}, max_iterations: 2000");
            let mut s: Simulation<S> = pressed(DRIVEN, &list, &solver, RIGID);
            let (reported, force, converged) = reported(&mut s, 3);
            let name = format!("{}D, {method}, {list}: {reported:?}, {force:e} N", S::D);
            assert_eq!(converged, 0, "{name}");
            // The interior point method may end without any impulses, which shows only that the
            // steps did not converge.
            if method == "Interior" && force == 0.0 {
                continue;
            }
            assert!(reported.squeezed_steps == 3, "{name}");
            assert_eq!(reported.squeezing, ["body `lid`", "body `floor`"], "{name}");
            let text = reported.warning().unwrap();
            assert!(
                text.contains("`lid` and body `floor` squeezed") && text.contains("by Force"),
                "{text}"
            );
            assert!(!text.contains("time.step"), "{text}");
            // The magnitude of the forces has no meaning, as the run reports. A sweep stops all
            // grains at the speed of the lid and sets them in motion again: it adds m v at most,
            // twice that with over-relaxation, and each step starts from the last.
            let bodies = &s.state.bodies;
            let mass: f64 = bodies.grains().map(|b| bodies.mass[b]).sum();
            let sweep = 2.0 * mass * 0.1 / s.options.scheme.h;
            assert!(force < 3.0 * 2000.0 * sweep, "{name}");
            // All other methods detect early that there is no solution.
            assert!(method == "Nlgs" || force < 1e5, "{name}");
        }
    }
}

#[test]
fn grains_between_driven_plates_cannot_yield() {
    cannot_be_obeyed::<Dim2>();
    cannot_be_obeyed::<Dim3>();
}

/// With a force instead of the motion, or springs instead of rigid contacts, there is a solution.
fn can_be_obeyed<S: Space>() {
    for (lid, law) in [("Force(-10.0)", RIGID), (DRIVEN, SPRINGS)] {
        for list in grains(S::D) {
            let mut s: Simulation<S> = pressed(lid, &list, "", law);
            let (reported, ..) = reported(&mut s, 20);
            assert!(reported.is_empty(), "{lid}, {list}: {reported:?}");
        }
    }
}

#[test]
fn forces_and_springs_can() {
    can_be_obeyed::<Dim2>();
    can_be_obeyed::<Dim3>();
}

/// Two driven bodies that move into each other are reported by name; with springs between them, or
/// if they separate or slide, they are not.
#[test]
fn driven_bodies_that_overlap_are_named() {
    let scene = |motion: &str, law: &str| -> Simulation<Dim3> {
        let text = format!(
            r#"(
    name: "blocks", dimension: 3, time: (step: 1e-3, end: 1.0),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), {law})],
    bodies: [
        (name: "lower", material: "grain", shapes: [Box(size: (0.02, 0.02, 0.02))]),
        (name: "upper", material: "grain", position: [0.0, 0.0, 0.02], shapes: [Box(size: (0.02, 0.02, 0.02))], dofs: ({motion})),
    ],
    output: (frames: 0, views: 0, figures: false),
)"#
        );
        scene::text::<Dim3>(&text)
    };
    let down = "z: Velocity(-0.1)";
    let (reported_of, ..) = reported(&mut scene(down, RIGID), 10);
    // The overlap is 1e-3 m after ten steps.
    assert!(
        (reported_of.overlap / 1e-3 - 1.0).abs() < 0.01,
        "{reported_of:?}"
    );
    let text = reported_of.warning().unwrap();
    assert!(
        text.contains("`lower`") && text.contains("`upper`") && text.contains("both imposed"),
        "{text}"
    );
    // Even 1e-5 of their size is reported. The overlap counts as one of rigid bodies.
    let mut slow = scene("z: Velocity(-2e-5)", RIGID);
    let (reported_of, ..) = reported(&mut slow, 10);
    assert!(
        (reported_of.overlap / 2e-7 - 1.0).abs() < 0.01,
        "{reported_of:?}"
    );
    let report = slow.step().unwrap();
    assert!(report.overlap > 1e-6, "{}", report.overlap);
    for (motion, law) in [
        (down, SPRINGS),
        ("z: Velocity(0.1)", RIGID),
        ("x: Velocity(0.1)", RIGID),
    ] {
        let (reported_of, ..) = reported(&mut scene(motion, law), 10);
        assert!(reported_of.is_empty(), "{motion}, {law}: {reported_of:?}");
    }
}
