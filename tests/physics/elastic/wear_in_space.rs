//! Wear of deformable bodies in 3D: the removed volume is that of the law, and the load moves to
//! where less is removed.

use super::wear::{agree, case, rubbed};
use super::*;

/// k of Archard's law, alpha of the law of dissipated energy (1/Pa), and mu.
const K: f64 = 2e-10;
const ALPHA: f64 = 5e-10;
const MU: f64 = 0.6;
/// Period (s).
const PERIOD: f64 = 0.05;

/// A sphere in gross slip on a flat until a cycle is over, and then a pull.
const SLIDES_AND_LIFTS: [&str; 2] = [
    "half_spaces.1.dofs.x=Displacement(Sine(amplitude: 5e-6, frequency: 20.0, start: 0.01))",
    "half_spaces.1.dofs.z=Force(Table([(0.0, 0.0), (8e-3, -99.52), (0.06, -99.52), (0.0625, 1.0), (0.08, 1.0)]))",
];

/// A case of a sphere on a flat with a wear law and other changes.
fn sphere(law: &str, sets: &[&str]) -> Simulation<Dim3> {
    let cells = "(from: -4.8e-4, to: 4.8e-4, size: 8e-5)";
    let mut all = vec![format!(
        "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", {law})]"
    )];
    for (k, axis) in [(0, "x"), (0, "y"), (1, "x"), (1, "y")] {
        all.push(format!("half_spaces.{k}.{axis}={cells}"));
    }
    let all = all.iter().map(String::as_str).chain(sets.iter().copied());
    case("sphere_on_flat_fretting", &all.collect::<Vec<_>>())
}

fn archard() -> String {
    format!("wear: \"archard\", parameters: (contact: {{\"mu\": {MU}}}, wear: {{\"k\": {K:e}}})")
}

fn dissipated_energy() -> String {
    format!(
        "wear: \"dissipated-energy\", parameters: (contact: {{\"mu\": {MU}}}, wear: {{\"alpha\": {ALPHA:e}}})"
    )
}

/// Volume between the surface of the scar and the surface that its system would have without wear
/// (m^3).
fn gone(s: &Simulation<Dim3>) -> f64 {
    let scar = &s.state.scars[0];
    let carried = &s.shapes.surfaces[scar.surface];
    let carrier = s.state.bodies.carrier(carried.body as usize).unwrap();
    let system = s.state.systems.get(carrier.system as usize).unwrap();
    let contactor = system.contactors().into_iter().next().unwrap();
    let mut unworn = system.surface(&contactor).unwrap();
    unworn.move_vertices(&system.surface_vertices(&contactor));
    let under = |surface: &dyn fretwork::geometry::shape::Surface<Dim3>| -> f64 {
        let prism = |t: &Vec<nalgebra::Vector3<f64>>| {
            let area = 0.5 * (t[1] - t[0]).cross(&(t[2] - t[0])).z;
            area * (t[0].z + t[1].z + t[2].z) / 3.0
        };
        surface.outline().iter().map(prism).sum()
    };
    under(unworn.as_ref()) - under(carried.shape.as_ref())
}

/// Returns the wear that steps reported, and k times the sum of force times slip (m^3).
fn wear(s: &mut Simulation<Dim3>, end: f64) -> [f64; 2] {
    let h = s.options.scheme.h;
    let [mut booked, mut expected] = [0.0; 2];
    for _ in 0..(end / h).round() as usize {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.solver.converged);
        booked += report.totals.worn_first;
        let work = rubbed(s, h)
            .iter()
            .map(|[f, s]| f.max(0.0) * s)
            .sum::<f64>();
        expected += K * work;
    }
    [booked, expected]
}

/// Compares the volume of the scar with that of its depths, and with that missing under the
/// surface.
fn holds(s: &Simulation<Dim3>, booked: f64, strained: f64) {
    let scar = &s.state.scars[0];
    agree("scar", booked, scar.volume(), 1e-12);
    let depths: f64 = scar.vertices().map(|(v, d)| v.tributary * d).sum();
    agree("depths", booked, depths, 1e-12);
    agree("surface", booked, gone(s), strained);
    closes(s, 1e-9);
}

/// A cycle of gross slip by Archard's law, and the sphere lifted then.
fn a_cycle(mut s: Simulation<Dim3>) {
    let [booked, expected] = wear(&mut s, 0.01 + PERIOD);
    // The contact points are those at the end of the step here, and those at its middle in the law.
    agree("archard", expected, booked, 2e-5);
    // If all contacts slip, the heat of friction is mu F s.
    agree("heat", K * s.state.energy.friction / MU, booked, 1e-5);
    // Under load the surface is strained.
    holds(&s, booked, 1e-2);
    let lifted = booked + wear(&mut s, 0.02)[0];
    assert_eq!(s.state.network.contact_count(false), 0);
    holds(&s, lifted, 1e-8);
}

#[test]
fn archards_volume_is_gone_from_a_half_space() {
    let [slides, lifts] = SLIDES_AND_LIFTS;
    a_cycle(sphere(
        &archard(),
        &[slides, lifts, "half_spaces.0.wears=(thickness: 1e-4)"],
    ));
}

/// A half-space above wears upwards, by the work of friction.
#[test]
fn the_volume_of_the_dissipated_energy_is_gone_from_a_half_space_above() {
    let sets = [
        "half_spaces.0.side=Above",
        "half_spaces.0.wears=(thickness: 1e-4)",
        "half_spaces.1.side=Below",
        "half_spaces.1.dofs.x=Displacement(Sine(amplitude: 5e-6, frequency: 20.0, start: 0.01))",
        "half_spaces.1.dofs.z=Force(Ramp(from: 0.0, to: 99.52, start: 0.0, end: 8e-3))",
    ];
    let mut s = sphere(&dissipated_energy(), &sets);
    let [booked, _] = wear(&mut s, 0.03);
    agree("heat", ALPHA * s.state.energy.friction, booked, 1e-8);
    holds(&s, booked, 1e-2);
    let scar = &s.state.scars[0];
    let shape = s.shapes.surfaces[scar.surface].shape.receding().unwrap();
    assert!(shape.sign() < 0.0 && scar.deepest() > 0.0);
    // The sphere is at the middle of the cells.
    let at = scar.deepest_at();
    assert!(at.norm() < 2e-4, "{at}");
}

/// A block of finite elements that touches as a surface.
const BLOCK: &str = "elastic=[(
    name: \"flat\", material: \"steel\",
    mesh: Block(
        x: (from: -2e-3, to: 2e-3, size: 1.5e-4, fine: (-4.5e-4, 4.5e-4), growth: 1.6),
        y: (from: -2e-3, to: 2e-3, size: 1.5e-4, fine: (-4.5e-4, 4.5e-4), growth: 1.6),
        z: (from: -2e-3, to: 0.0, size: 1.5e-4, fine: (-3e-4, 0.0), growth: 1.6),
    ),
    supports: [(part: \"bottom\", x: Fixed, y: Fixed, z: Fixed)],
    touches: Surface(\"top\"), wears: (thickness: 1e-4),
)]";

/// The sphere above, whose cells touch by points.
fn above() -> String {
    let [x, z] = SLIDES_AND_LIFTS.map(|set| set.split_once('=').unwrap().1);
    format!(
        "half_spaces=[(
            name: \"sphere\", material: \"steel\", side: Above,
            x: (from: -4.8e-4, to: 4.8e-4, size: 8e-5), y: (from: -4.8e-4, to: 4.8e-4, size: 8e-5),
            profile: Summit(x: 0.05, y: 0.05), mass: 0.01, touches: Points, dofs: (x: {x}, z: {z}),
        )]"
    )
}

#[test]
fn archards_volume_is_gone_from_a_body_of_finite_elements() {
    let law = format!(
        "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", {})]",
        archard()
    );
    a_cycle(case(
        "sphere_on_flat_fretting",
        &[&law, BLOCK, &above(), "friction.body=sphere"],
    ));
}

/// The round lower side of a block wears on the points of a half-space.
#[test]
fn a_round_side_wears_by_the_dissipated_energy() {
    let law = format!(
        "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", {})]",
        dissipated_energy()
    );
    let block = "elastic=[(
        name: \"pin\", material: \"steel\",
        mesh: Block(
            x: (from: -8e-4, to: 8e-4, size: 1e-4), y: (from: -8e-4, to: 8e-4, size: 1e-4), z: (from: 0.0, to: 8e-4, size: 2e-4),
            round: (side: \"bottom\", radius: 0.02),
        ),
        supports: [(
            part: \"top\", y: Fixed, x: Displacement(Sine(amplitude: 5e-6, frequency: 20.0, start: 0.01)),
            z: Displacement(Ramp(from: 0.0, to: -1.5e-6, start: 0.0, end: 8e-3)),
        )],
        touches: Surface(\"bottom\"), wears: (thickness: 1e-4),
    )]";
    let flat = "half_spaces=[(
        name: \"flat\", material: \"steel\", touches: Points,
        x: (from: -4.8e-4, to: 4.8e-4, size: 8e-5), y: (from: -4.8e-4, to: 4.8e-4, size: 8e-5),
    )]";
    let sets = [law.as_str(), block, flat, "friction.body=pin"];
    let mut s = case::<Dim3>("sphere_on_flat_fretting", &sets);
    let [booked, _] = wear(&mut s, 0.04);
    agree("heat", ALPHA * s.state.energy.friction, booked, 1e-8);
    holds(&s, booked, 1e-2);
    let scar = &s.state.scars[0];
    assert!(scar.deepest() > 1e-8 && scar.deepest_at().xy().norm() < 3e-4);
}

/// A flat punch at rest on a half-space from which an even layer, and more at one place, has been
/// removed.
fn pressed(layer: f64, more: f64) -> (f64, Vec<[f64; 3]>) {
    let sets = [
        "half_spaces.0.wears=(thickness: 1e-4)",
        "half_spaces.1.profile=Flat",
        "half_spaces.1.x=(from: -2.4e-4, to: 2.4e-4, size: 8e-5)",
        "half_spaces.1.y=(from: -2.4e-4, to: 2.4e-4, size: 8e-5)",
        "half_spaces.1.dofs.x=Fixed",
        "solver.tolerance=1e-12",
        "half_spaces.1.dofs.z=Force(Ramp(from: 0.0, to: -50.0, start: 0.0, end: 8e-3))",
    ];
    let mut s = sphere(&archard(), &sets);
    // The middle of the punch's second cell along both axes is a cell of the surface.
    let place = |v: &nalgebra::Vector3<f64>, middle: f64| {
        (v.x - middle).abs() < 1e-9 && (v.y - middle).abs() < 1e-9
    };
    let scar = &mut s.state.scars[0];
    let carried = &s.shapes.surfaces[scar.surface];
    let frame = s.state.bodies.position[carried.body as usize];
    let vertices: Vec<_> = scar.vertices().map(|(v, _)| *v).collect();
    for v in vertices {
        let extra = if place(&v.at, -1.2e-4) { more } else { 0.0 };
        let volume = v.tributary * (layer + extra);
        scar.wear_at(&s.shapes, &(v.at - frame), volume).unwrap();
    }
    scar.apply_depth(&mut s.shapes, 1.0);
    go(&mut s, 40);
    let h = s.options.scheme.h;
    // A cell may touch a face and vertices: its load is their sum.
    let mut loads: Vec<[f64; 3]> = Vec::new();
    for c in &s.state.network.contacts {
        let force = c.impulse.z.abs() / h;
        let at = s.state.bodies.position[c.bodies[0] as usize];
        match loads.iter_mut().find(|l| l[0] == at.x && l[1] == at.y) {
            Some(load) => load[2] += force,
            None => loads.push([at.x, at.y, force]),
        }
    }
    loads.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let sunk = holder(&s, 1, "holder", 2).displacement;
    (sunk, loads)
}

#[test]
fn a_punch_follows_an_even_layer_with_the_same_pressure() {
    let (new, worn) = (pressed(0.0, 0.0), pressed(1.5e-6, 0.0));
    agree("sunk", 1.5e-6, new.0 - worn.0, 1e-8);
    assert_eq!((new.1.len(), worn.1.len()), (36, 36));
    for (a, b) in new.1.iter().zip(&worn.1) {
        near(a[2], b[2], 1e-5);
    }
}

#[test]
fn a_punch_leaves_its_load_beside_a_pit() {
    let (even, shallow, deep) = (pressed(0.0, 0.0), pressed(0.0, 5e-8), pressed(0.0, 1e-5));
    let at = |loads: &[[f64; 3]], x: f64| {
        let near = |l: &&[f64; 3]| (l[0] - x).abs() < 2e-5 && (l[1] - x).abs() < 2e-5;
        loads.iter().find(near).map_or(0.0, |l| l[2])
    };
    let total = |loads: &[[f64; 3]]| loads.iter().map(|l| l[2]).sum::<f64>();
    let [one, two, none] = [&even.1, &shallow.1, &deep.1].map(|l| at(l, -1.2e-4));
    println!("{one:.4} N, then {two:.4}, then {none:.4}");
    assert!(two < 0.9 * one && two > 0.0 && none == 0.0);
    // Beside the deep cell the load is higher, and the total is unchanged.
    let [before, after] = [&even.1, &deep.1].map(|l| at(l, -4e-5));
    assert!(after > 1.01 * before, "{before}, then {after} N");
    for (_, loads) in [&even, &shallow, &deep] {
        agree("load", 50.0, total(loads), 1e-10);
    }
}
