//! Removal of overlaps by moving bodies: displacements, supplied energy, and quantities that do not
//! change.

use crate::scene;
use fretwork::contact::Network;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;
use nalgebra::{Vector2, Vector3};

const G: f64 = 9.81;
/// Depth of the overlaps (m), below what a case may begin with.
const DEPTH: f64 = 4e-4;

/// Builds a case of grains of a radius of about 0.1 m and 1000 kg/m^3, with `head` for fields that
/// differ.
fn built<S: Space>(head: &str) -> Simulation<S> {
    let text = format!(
        r#"(
    name: "overlaps",
    time: (step: 1e-3, end: 1.0),
    solver: (tolerance: 1e-12, norm: Velocity, max_iterations: 100000, projection: 1e-4),
    detection: (alert: 5e-3, skin: 0.02),
    materials: {{"grain": "verification_grain", "bead": "verification_grain"}},
    output: (frames: 0, views: 0),
    {head}
)"#
    );
    scene::text::<S>(&text)
}

const SMOOTH: &str =
    r#"interfaces: [(name: "all", between: ("grain", "grain"), contact: "frictionless")],"#;

fn close(got: f64, wanted: f64, off: f64) {
    assert!((got - wanted).abs() <= off, "{got:e} is not {wanted:e}");
}

/// Of two disks with masses 4 : 1 the light one moves four times as far, also through a periodic
/// boundary.
#[test]
fn two_disks_come_apart_by_their_masses_and_stay_at_rest() {
    for (period, shift) in [("", 0.0), ("periodic: (x: 1.0),", 0.95)] {
        let way = Vector2::new(0.8, 0.6) * (0.15 - DEPTH);
        let [x, y] = [shift + way.x - if shift > 0.0 { 1.0 } else { 0.0 }, way.y];
        let mut s: Simulation<Dim2> = built(&format!(
            r#"dimension: 2, {period} {SMOOTH}
            grains: [List(material: "grain", grains: [
                (at: [{shift:?}, 0.0], radius: 0.1), (at: [{x:?}, {y:?}], radius: 0.05)])],"#
        ));
        let from = s.state.bodies.position.clone();
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        let projected = report.projected.expect("the overlap is beyond the bound");
        close(projected.before, DEPTH / 0.05, 1e-9);
        close(projected.after, 0.0, 1e-12);
        let moved: Vec<_> = (0..2)
            .map(|b| s.state.bodies.position[b] - from[b])
            .collect();
        let normal = Vector2::new(0.8, 0.6);
        // Grains are sorted in space.
        let light = usize::from(s.state.bodies.mass[1] < s.state.bodies.mass[0]);
        for (moved, wanted) in [(moved[1 - light], -0.2), (moved[light], 0.8)] {
            close(moved.dot(&normal), wanted * DEPTH, 1e-15);
            close(moved.perp(&normal), 0.0, 1e-15);
        }
        assert!(s.state.bodies.velocity.iter().all(|v| v.norm() == 0.0));
        let e = &s.state.energy;
        assert_eq!([e.kinetic, e.potential, e.correction, e.residual], [0.0; 4]);
        // A second projection has nothing to do.
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.projected.is_none());
    }
}

/// An overlap within the bound is left alone, to the last bit.
#[test]
fn what_is_within_the_bound_stays() {
    let mut s: Simulation<Dim2> = built(&format!(
        r#"dimension: 2, {SMOOTH}
        grains: [List(material: "grain", grains: [
            (at: [0.0, 0.0], radius: 0.1), (at: [0.19961, 0.0], radius: 0.1)])],"#
    ));
    s.options.projection = 4e-3;
    let from = s.state.bodies.position.clone();
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.projected.is_none() && s.state.bodies.position == from);
    s.options.projection = 3.8e-3;
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.projected.is_some());
}

/// Two disks that overlap each other and the floor by d rise by d and 2 d, which takes 3 m g d.
#[test]
fn a_column_is_lifted_and_its_weight_is_booked() {
    let [low, high] = [0.1 - DEPTH, 0.3 - 2.0 * DEPTH];
    let mut s: Simulation<Dim2> = built(&format!(
        r#"dimension: 2, gravity: [0.0, -{G}], {SMOOTH}
        bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])],
        grains: [List(material: "grain", grains: [
            (at: [0.0, {low:?}], radius: 0.1), (at: [0.0, {high:?}], radius: 0.1)])],"#
    ));
    let grains: Vec<usize> = s.state.bodies.grains().collect();
    let floor = (0..3).find(|b| !grains.contains(b)).expect("a floor");
    let weight = G * s.state.bodies.mass[grains[0]];
    let given = 3.0 * weight * DEPTH;
    let (ground, heights) = (s.state.bodies.position[floor], [low, high]);
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.projected.is_some());
    // Positions are exact to the tolerance of the displacements.
    for (k, b) in grains.iter().enumerate() {
        let risen = s.state.bodies.position[*b].y - heights[k];
        close(risen, (k as f64 + 1.0) * DEPTH, 2e-3 * DEPTH);
    }
    assert_eq!(s.state.bodies.position[floor], ground);
    close(-s.state.energy.correction, given, 2e-3 * given);
    let first = s.state.energy.correction;
    for _ in 0..200 {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.projected.is_none());
    }
    let e = &s.state.energy;
    assert_eq!(e.correction, first);
    close(e.potential, given, 2e-3 * given);
    assert!(e.kinetic < 1e-9 * given);
    assert!(e.residual.abs() < 1e-13 * given, "{:e}", e.residual);
}

/// A disk between a floor and a lid with an imposed force: the lid is lifted against its load, the
/// floor does not move.
#[test]
fn walls_that_are_fixed_stay_and_a_load_is_lifted() {
    const LOAD: f64 = 50.0;
    let [disk, lid] = [0.1 - DEPTH, 0.2 - 2.0 * DEPTH];
    let mut s: Simulation<Dim2> = built(&format!(
        r#"dimension: 2, {SMOOTH}
        bodies: [
            (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
            (name: "lid", material: "grain", shapes: [HalfSpace(normal: [0.0, -1.0])], position: [0.0, {lid:?}],
             mass: 7.0, dofs: (x: Velocity(Constant(0.25)), y: Force(Constant(-{LOAD:?})))),
        ],
        grains: [List(material: "grain", grains: [(at: [0.0, {disk:?}], radius: 0.1)])],"#
    ));
    let place = |s: &Simulation<Dim2>, name: &str| {
        let driven = s.state.bodies.driven.iter().find(|d| d.name == name);
        driven.expect("the body").body as usize
    };
    let [floor, lid] = [place(&s, "floor"), place(&s, "lid")];
    let from = s.state.bodies.position.clone();
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    let projected = report.projected.expect("overlaps are beyond the bound");
    let moved = s.state.bodies.position[lid] - from[lid];
    close(moved.y, 2.0 * DEPTH, 4e-3 * DEPTH);
    // The imposed motion is unchanged, 0.25 h.
    close(moved.x, 0.25e-3, 1e-15);
    assert_eq!(s.state.bodies.position[floor], from[floor]);
    let given = 2.0 * LOAD * DEPTH;
    close(projected.against_loads, given, 2e-3 * given);
    let e = &s.state.energy;
    assert_eq!(e.correction, -projected.against_loads);
    assert!(e.residual.abs() < 1e-12 * e.scale, "{:e}", e.residual);
}

/// Two bonded disks, whose cement fills an overlap, are hit by a third: they keep their distance
/// and their energy, and move as one body.
#[test]
fn a_bond_that_holds_is_not_pulled_apart() {
    let second = 0.2 - DEPTH;
    let third = second + 0.2;
    let mut s: Simulation<Dim2> = built(&format!(
        r#"dimension: 2,
        interfaces: [
            (name: "bonded", between: ("grain", "grain"), contact: "frictionless", cohesion: "elastic-bond",
             parameters: (cohesion: {{"k_n": 1e9, "k_t": 1e9}})),
            (name: "loose", between: ("grain", "bead"), contact: "frictionless"),
        ],
        grains: [
            List(material: "grain", grains: [(at: [0.0, 0.0], radius: 0.1), (at: [{second:?}, 0.0], radius: 0.1)]),
            List(material: "bead", grains: [(at: [{third:?}, 0.0], radius: 0.1)]),
        ],"#
    ));
    // Bonds are made in the first step, over the overlap.
    let bound = std::mem::replace(&mut s.options.projection, 0.0);
    s.step().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(s.state.network.bonds_made(), 1);
    s.options.projection = bound;
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(
        report.projected.is_none(),
        "what a bond fills is no overlap"
    );

    s.state.bodies.position[2].x -= DEPTH;
    let elastic = |n: &Network<Dim2>| n.bond_energy() + n.spring_energy();
    let (from, before) = (s.state.bodies.position.clone(), elastic(&s.state.network));
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(report.projected.is_some());
    let moved: Vec<f64> = (0..3)
        .map(|b| (s.state.bodies.position[b] - from[b]).x)
        .collect();
    let [pair, bead] = [2.0 * s.state.bodies.mass[0], s.state.bodies.mass[2]];
    let share = bead / (pair + bead);
    close(moved[1], -share * DEPTH, 2e-3 * DEPTH);
    close(moved[2], (1.0 - share) * DEPTH, 2e-3 * DEPTH);
    close(moved[0], moved[1], 2e-3 * DEPTH);
    close(elastic(&s.state.network), before, 0.0);
    close(s.state.energy.kinetic, 0.0, 0.0);
}

/// A cuboid that spins about no principal axis leaves a wall in which its corner is: it turns,
/// without supplying energy.
#[test]
fn a_body_whose_inertia_differs_by_axis_keeps_its_energy_as_it_is_turned() {
    let corner = Vector3::new(0.3f64, 0.2, 0.1) * 0.5;
    let turned = nalgebra::Rotation3::new(Vector3::new(0.4, -0.7, 0.2));
    let lowest = (0..8)
        .map(|k| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let own = Vector3::new(sign(0) * corner.x, sign(1) * corner.y, sign(2) * corner.z);
            (turned * own).z
        })
        .fold(f64::INFINITY, f64::min);
    let height = -lowest - DEPTH;
    let mut s: Simulation<Dim3> = built(&format!(
        r#"dimension: 3, {SMOOTH}
        bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])])],
        grains: [Polyhedra(material: "grain", grains: [(at: [0.0, 0.0, {height:?}], size: (0.3, 0.2, 0.1),
            turned: [0.4, -0.7, 0.2], velocity: [0.0, 0.0, 3.0], spin: [1.0, 2.0, -1.5])])],"#
    ));
    s.options.scheme.h = 1e-9;
    let grain = s.state.bodies.grains().next().expect("a grain");
    let (before, kinetic) = (
        s.state.bodies.rotation[grain],
        s.state.bodies.kinetic_energy(),
    );
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    let projected = report.projected.expect("the overlap is beyond the bound");
    assert!(projected.after < 1e-2 * projected.before, "{projected:?}");
    let angle = before.angle_to(&s.state.bodies.rotation[grain]);
    assert!(angle > 0.1 * DEPTH, "it turned by {angle:e}");
    close(s.state.bodies.kinetic_energy(), kinetic, 1e-12 * kinetic);
    assert!(s.state.energy.residual.abs() < 1e-12 * kinetic);
}
