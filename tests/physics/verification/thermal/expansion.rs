//! Thermal expansion of rigid bodies.

use super::{Table, heat, plane, solid, until};
use fretwork::geometry::space::Dim2;
use fretwork::record::encoding::{decode, encode};
use fretwork::step::Simulation;
use std::f64::consts::PI;

/// Coefficient of linear expansion (1/K), rise of temperature (K) and height of the columns (m).
pub(super) const ALPHA: f64 = 1.2e-5;
pub(super) const RISE: f64 = 100.0;
const HEIGHT: f64 = 6e-3;

pub fn all(table: &mut Table) {
    lifted(table);
    several_steps(table);
    settings(table);
    solids(table);
    held(table);
    bonded(table);
    polygon(table);
    first_body(table);
}

pub(super) fn height(s: &Simulation<Dim2>, body: &str) -> f64 {
    s.state.bodies.position[s.body_named(body).expect("a body")].y
}

fn lifted(table: &mut Table) {
    let case = "thermal/expanding_column";
    let mut s = plane(case, &[]);
    until(&mut s, 4.0, |_| ());
    // The part that is not yet warm follows from the temperature of the grains before the last
    // step.
    let rise = height(&s, "load") - HEIGHT;
    table.compare(
        case,
        "rise alpha dT L (m)",
        ALPHA * RISE * HEIGHT,
        rise,
        1e-5,
    );
    let work = 1e3 * rise;
    let energy = s.energies();
    table.compare(
        case,
        "work of the load (J/m)",
        -work,
        energy.external_work,
        1e-9,
    );
    table.compare(
        case,
        "work of the expansion (J/m)",
        work,
        energy.expansion,
        1e-5,
    );
    table.closes(case, "energy closes", energy.relative_residual(), 1e-10);
    let ledger = heat(&s).ledger;
    table.compare(
        case,
        "heat gone into work (J/m)",
        energy.expansion,
        ledger.expansion,
        1e-12,
    );
    table.closes(case, "heat closes", ledger.relative_residual(), 1e-10);
    let stored = ledger.surroundings + ledger.dissipated - energy.expansion;
    table.compare(
        case,
        "heat of the surroundings less work",
        stored,
        ledger.stored,
        1e-10,
    );

    // A run continued from saved bytes is bit-identical.
    let mut s = plane(case, &[]);
    until(&mut s, 0.2, |_| ());
    let bytes = encode(&s.state).expect("bytes");
    let mut again = plane(case, &[]);
    assert!(again.restore(decode(&bytes).expect("a state")));
    assert_eq!(s.shapes.balls[0].radius, again.shapes.balls[0].radius);
    assert!(s.shapes.balls[0].radius > 1e-3);
    until(&mut s, 0.3, |_| ());
    until(&mut again, 0.3, |_| ());
    assert_eq!(
        encode(&s.state).expect("bytes"),
        encode(&again.state).expect("bytes"),
        "{case}: continued"
    );
}

/// If one thermal step spans several steps of the mechanics, the growth is spread over them, and
/// for another step the rise is equal.
fn several_steps(table: &mut Table) {
    let case = "thermal/expanding_column";
    for sets in [&["heat.every=10"][..], &["time.step=4e-3"]] {
        let mut s = plane(case, sets);
        let (mut last, mut fastest) = (height(&s, "load"), 0.0f64);
        until(&mut s, 4.0, |s| {
            let now = height(s, "load");
            fastest = fastest.max((now - last) / s.options.scheme.h);
            last = now;
        });
        let rise = last - HEIGHT;
        let quantity = format!("{}: rise (m)", sets[0]);
        table.compare(case, &quantity, ALPHA * RISE * HEIGHT, rise, 5e-5);
        // The rate at the start is alpha dT L/(0.1766 s); in a single step it is ten times as
        // large.
        let rate = ALPHA * RISE * HEIGHT / (7850.0 * 450.0 * 1e-3 / 2e4);
        assert!(fastest < 1.1 * rate, "{}: {fastest} of {rate}", sets[0]);
        let closes = s.energies().relative_residual();
        table.closes(case, &format!("{}: energy closes", sets[0]), closes, 1e-10);
    }
}

/// The rise does not depend on the distance at which contacts are detected. It depends on the
/// tolerance by no more than the permitted error of velocities, which is relative to the velocity
/// that the load would reach in a step without contacts.
fn settings(table: &mut Table) {
    let case = "thermal/expanding_column";
    let free_velocity = 1e3 * 1e-3 / 0.1;
    let drift = 1e-9 * free_velocity * 4.0 / (ALPHA * RISE * HEIGHT);
    for (set, tolerance) in [
        ("detection.alert=1e-4", 1e-5),
        ("detection.alert=1e-7", 1e-5),
        ("solver.tolerance=1e-9", drift),
    ] {
        let mut s = plane(case, &[set]);
        until(&mut s, 4.0, |_| ());
        let rise = height(&s, "load") - HEIGHT;
        let quantity = format!("{set}: rise (m)");
        table.compare(case, &quantity, ALPHA * RISE * HEIGHT, rise, tolerance);
    }
}

/// In 3D a cube, and a cluster of eight balls of equal height, lift the load as the column of disks
/// does.
fn solids(table: &mut Table) {
    let case = "thermal/expanding_column";
    let balls: Vec<String> = (0..8)
        .map(|k| {
            let [x, y, z] = [1, 2, 4].map(|bit| if k & bit == 0 { -5e-4 } else { 5e-4 });
            format!("([{x}, {y}, {z}], 5e-4)")
        })
        .collect();
    let scenes = [
        ("a cube", "Polyhedra", "size: (2e-3, 2e-3, 2e-3)".to_owned()),
        (
            "eight balls",
            "Clusters",
            format!("shapes: [Balls([{}])]", balls.join(", ")),
        ),
    ];
    for (what, kind, shape) in scenes {
        let grains = format!(
            "grains=[{kind}(material: \"steel\", grains: [(at: [0.0, 0.0, 1e-3], {shape})])]"
        );
        let sets = [
            "dimension=3",
            "bodies.floor.shapes=[HalfSpace(normal: [0.0, 0.0, 1.0])]",
            "bodies.load.shapes=[HalfSpace(normal: [0.0, 0.0, -1.0])]",
            "bodies.load.position=[0.0, 0.0, 2e-3]",
            "bodies.load.dofs=(z: Force(Constant(-1e3)))",
            &grains,
        ];
        let mut s = solid(case, &sets);
        let load = s.body_named("load").expect("a load");
        until(&mut s, 4.0, |_| ());
        let rise = s.state.bodies.position[load].z - 2e-3;
        let name = format!("{what}: rise alpha dT a (m)");
        table.compare(case, &name, ALPHA * RISE * 2e-3, rise, 2e-5);
        let energy = s.energies();
        let name = format!("{what}: work of the expansion (J)");
        table.compare(case, &name, 1e3 * rise, energy.expansion, 1e-5);
        let name = format!("{what}: energy closes");
        table.closes(case, &name, energy.relative_residual(), 1e-10);
        let closes = heat(&s).ledger.relative_residual();
        table.closes(case, &format!("{what}: heat closes"), closes, 1e-10);
    }
}

fn held(table: &mut Table) {
    let case = "thermal/held_column";
    let mut s = plane(case, &[]);
    // This is before it comes to rest, where velocities are round-off.
    until(&mut s, 0.8, |_| ());
    let rise = s.temperature(1).expect("a temperature") - 300.0;
    assert!(rise > 98.0, "{rise}");
    let force = 1e6 * ALPHA * rise * HEIGHT / 4.0;
    for contact in s.contacts() {
        let name = "force k alpha dT L/4 (N/m)";
        table.compare(case, name, force, contact.normal_force, 1e-4);
    }
    let energy = s.energies();
    // The stored energy is that of four springs.
    let stored = 4.0 * 0.5 * force * force / 1e6;
    table.compare(
        case,
        "energy in the springs (J/m)",
        stored,
        energy.elastic,
        1e-4,
    );
    table.compare(
        case,
        "work of the expansion: stored and damped (J/m)",
        energy.elastic + energy.viscous,
        energy.expansion,
        1e-3,
    );
    table.closes(case, "energy closes", energy.relative_residual(), 1e-10);
}

fn bonded(table: &mut Table) {
    let case = "thermal/expanding_bond";
    for coupling in ["Midpoint", "Implicit(tolerance: 1e-6)"] {
        let mut s = plane(case, &[&format!("coupling={coupling}")]);
        let mut most = 0.0f64;
        until(&mut s, 2.0, |s| most = most.max(s.energies().elastic));
        let [a, b] = [s.state.bodies.position[0], s.state.bodies.position[1]];
        let apart = (b - a).norm() - 2e-3;
        let name = format!("{coupling}: centres apart by alpha dT d (m)");
        table.compare(case, &name, ALPHA * RISE * 2e-3, apart, 1e-4);
        // The bond has 1e11 Pa/m over 2 mm: stretched by the expansion it would store 5.8e-4 J/m.
        let name = format!("{coupling}: energy of the bond (J/m)");
        table.compare(case, &name, 0.0, most, 1e-9);
    }
}

/// A square on springs is held by friction between a floor and a load. Its corners move outwards by
/// alpha dT a against the tangential stiffness of the contacts, 0.8 of the normal one.
fn polygon(table: &mut Table) {
    let case = "thermal/expanding_column";
    let sets = [
        "grains=[Polygons(material: \"steel\", grains: [(at: [0.0, 1e-3], points: [(-1e-3, -1e-3), (1e-3, -1e-3), (1e-3, 1e-3), (-1e-3, 1e-3)])])]",
        "interfaces.0.contact=linear-contact",
        "interfaces.0.parameters=(contact: {\"stiffness\": 1e8, \"ratio\": 0.8, \"restitution\": 0.1, \"mu\": 0.3})",
        "solver=(norm: Balance, tolerance: 1e-8, max_iterations: 100000)",
        "time.step=1e-4",
        "bodies.load.position=[0.0, 2e-3]",
    ];
    let mut s = plane(case, &sets);
    until(&mut s, 0.6, |_| ());
    let rise = s.temperature(0).expect("a temperature") - 300.0;
    assert!(rise > 90.0, "{rise}");
    let shear = 0.8e8 * ALPHA * rise * 1e-3;
    let contacts = &s.state.network.contacts;
    assert_eq!(contacts.len(), 4);
    for contact in contacts {
        let force = contact.impulse / s.options.scheme.h;
        let name = "a square: force at a corner across the load (N/m)";
        table.compare(case, name, 500.0, force.y.abs(), 1e-3);
        let name = "a square: along it, k_t alpha dT a (N/m)";
        // Overlaps are 0.5 % of a.
        table.compare(case, name, shear, force.x.abs(), 1e-2);
    }
    let energy = s.energies();
    table.closes(
        case,
        "a square: energy closes",
        energy.relative_residual(),
        1e-10,
    );
    let ledger = heat(&s).ledger;
    table.closes(
        case,
        "a square: heat closes",
        ledger.relative_residual(),
        1e-10,
    );
}

/// First bodies of balls expand about their position, so that bodies on them rise: one disk, and
/// two disks of one body with a grain between them, on which nothing slides.
fn first_body(table: &mut Table) {
    let case = "thermal/expanding_column";
    let pin = |balls: &str| {
        format!(
            "bodies.floor=(name: \"pin\", material: \"steel\", shapes: [Balls([{balls}])], position: [0.0, 1e-3])"
        )
    };
    let grain = |y: f64| {
        format!("grains=[List(material: \"steel\", grains: [(at: [0.0, {y}], radius: 1e-3)])]")
    };
    // The body warms as fast as the grain.
    let heat = |disks: usize| {
        let area = disks as f64 * 2.0 * PI * 1e-3;
        format!(
            "heat.bodies={{\"pin\": (store: Lumped(), convection: (coefficient: 1e4, area: {area}, ambient: 400.0)), \"load\": (store: Insulated)}}"
        )
    };
    // These are heights above the centre of the pin.
    let between = 3f64.sqrt() * 1e-3;
    let scenes = [
        ("([0.0, 0.0], 1e-3)", 2e-3),
        ("([-1e-3, 0.0], 1e-3), ([1e-3, 0.0], 1e-3)", between),
    ];
    for (k, (balls, height_of_grain)) in scenes.into_iter().enumerate() {
        let top = 2e-3 + height_of_grain;
        let sets = [
            pin(balls),
            grain(1e-3 + height_of_grain),
            heat(k + 1),
            format!("bodies.load.position=[0.0, {top}]"),
            "interfaces.0.contact=coulomb".to_owned(),
            "interfaces.0.parameters=(contact: {\"mu\": 0.3})".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let mut s = plane(case, &sets);
        until(&mut s, 4.0, |_| ());
        let rise = height(&s, "load") - top;
        let name = format!("on a first body of {} disks: rise (m)", k + 1);
        let expected = ALPHA * RISE * (height_of_grain + 1e-3);
        table.compare(case, &name, expected, rise, 2e-5);
        let energy = s.energies();
        let name = format!("on a first body of {} disks: work (J/m)", k + 1);
        table.compare(case, &name, 1e3 * rise, energy.expansion, 1e-5);
        let closes = energy.relative_residual();
        table.closes(case, "a first body: energy closes", closes, 1e-10);
        // Sticking contacts do not slide.
        assert!(energy.friction < 1e-4 * energy.expansion, "{energy:?}");
        let ledger = super::heat(&s).ledger;
        let closes = ledger.relative_residual();
        table.closes(case, "a first body: heat closes", closes, 1e-10);
    }
}
