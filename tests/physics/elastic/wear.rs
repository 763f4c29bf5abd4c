//! Wear of deformable bodies: the removed volume is that of Archard's law, and the pressure
//! decreases as the scar widens.

use super::*;
use crate::scene;

/// k of Archard's law and mu in the case (1/Pa, 1).
const K: f64 = 2e-11;
const MU: f64 = 0.3;
/// Period (s).
const PERIOD: f64 = 0.05;

/// A repository's case with changes.
pub fn case<S: Space>(name: &str, sets: &[&str]) -> Simulation<S> {
    scene::case(name, sets)
}

/// Normal force and slip of each contact in the last step (N, m; N/m in 2D). The slip is that of
/// the touching points over the step.
pub fn rubbed<S: Space>(s: &Simulation<S>, h: f64) -> Vec<[f64; 2]> {
    let contacts = s.state.network.contacts.iter();
    contacts
        .map(|c| {
            let of = |k: usize| {
                let carrier = s.state.bodies.carrier(c.bodies[k] as usize).unwrap();
                let nodes = s.state.systems.contact_nodes(carrier, &c.arms[k]);
                s.state.systems.velocity_at(carrier.system as usize, &nodes)
            };
            let along = S::tangential(&c.normal, &(of(0) - of(1)));
            [c.impulse.dot(&c.normal) / h, h * along.norm()]
        })
        .collect()
}

/// Results of a run.
struct Found {
    /// k times the sum of force times slip of each contact and step (m^2).
    expected: f64,
    /// The wear that steps reported (m^2).
    booked: f64,
    /// Largest traction (Pa) and number of loaded contacts, at the end of the first step under the
    /// load and of the last step.
    pressure: [f64; 2],
    loaded: [usize; 2],
}

/// Steps to `end`; the load is constant from `start` on, and points have a given size (m).
fn wear(s: &mut Simulation<Dim2>, start: f64, end: f64, size: f64) -> Found {
    let h = s.options.scheme.h;
    let mut found = Found {
        expected: 0.0,
        booked: 0.0,
        pressure: [0.0; 2],
        loaded: [0; 2],
    };
    for k in 0..(end / h).round() as usize {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.solver.converged);
        found.booked += report.totals.worn_first;
        let rubbed = rubbed(s, h);
        found.expected += K * rubbed.iter().map(|[f, s]| f.max(0.0) * s).sum::<f64>();
        let of = if (k as f64 + 0.5) * h < start { 0 } else { 1 };
        found.pressure[of] = rubbed.iter().fold(0.0, |most, [f, _]| most.max(f / size));
        found.loaded[of] = rubbed.iter().filter(|[f, _]| *f > 0.0).count();
    }
    found
}

/// Area between the surface of the scar and the surface that its system would have without wear
/// (m^2).
fn gone(s: &Simulation<Dim2>) -> f64 {
    let scar = &s.state.scars[0];
    let carried = &s.shapes.surfaces[scar.surface];
    let carrier = s.state.bodies.carrier(carried.body as usize).unwrap();
    let system = s.state.systems.get(carrier.system as usize).unwrap();
    let contactor = system.contactors().into_iter().next().unwrap();
    let under = |chain: &[nalgebra::Vector2<f64>]| -> f64 {
        let trapezium = |w: &[nalgebra::Vector2<f64>]| 0.5 * (w[1].x - w[0].x) * (w[0].y + w[1].y);
        chain.windows(2).map(trapezium).sum()
    };
    under(&system.surface_vertices(&contactor)) - under(&carried.shape.outline()[0])
}

pub fn agree(what: &str, expected: f64, obtained: f64, tolerance: f64) {
    let off = obtained / expected - 1.0;
    println!("{what}: {obtained:e} of {expected:e}, {off:e} off");
    near(expected, obtained, tolerance);
}

/// One cycle of gross slip with points of a size (m), after which the cylinder is lifted.
fn a_cycle(mut s: Simulation<Dim2>, size: f64) {
    let found = wear(&mut s, 0.01, 0.01 + PERIOD, size);
    agree("booked", found.expected, found.booked, 1e-6);
    // If all contacts slip, the heat of friction is mu F s.
    agree("heat", K * s.state.energy.friction / MU, found.booked, 1e-6);
    let volume = |s: &Simulation<Dim2>, booked: f64| {
        let scar = &s.state.scars[0];
        agree("scar", booked, scar.volume(), 1e-12);
        let depths: f64 = scar.vertices().map(|(v, d)| v.tributary * d).sum();
        agree("depths", booked, depths, 1e-12);
    };
    volume(&s, found.booked);
    // Under load the surface is strained.
    agree("surface", found.booked, gone(&s), 1e-3);
    let ([before, after], [few, many]) = (found.pressure, found.loaded);
    println!("pressure {before:e}, then {after:e} Pa; {few}, then {many} points");
    assert!(after < 0.96 * before && many > few);
    closes(&s, 1e-9);
    let lifted = found.booked + wear(&mut s, 0.0, 0.02, size).booked;
    assert_eq!(s.state.network.contact_count(false), 0);
    volume(&s, lifted);
    agree("surface without load", lifted, gone(&s), 1e-9);
    closes(&s, 1e-9);
}

/// The load of the case until a cycle is over, and then a pull.
const PRESSED_AND_LIFTED: &str = "Force(Table([(0.0, 0.0), (8e-3, -178.9e3), (0.06, -178.9e3), (0.0625, 100.0), (0.08, 100.0)]))";

#[test]
fn archards_volume_is_gone_from_a_half_space() {
    let load = format!("half_spaces.1.dofs.y={PRESSED_AND_LIFTED}");
    a_cycle(case("fretting_wear_elastic", &[&load]), 5e-5);
}

/// A flat of finite elements, which touches by its surface, wears by the volume of Archard's law.
#[test]
fn archards_volume_is_gone_from_a_body_of_finite_elements() {
    let flat = "elastic=[(
        name: \"flat\", material: \"steel\",
        mesh: Block(
            x: (from: -0.02, to: 0.02, size: 1e-4, fine: (-1.5e-3, 1.5e-3), growth: 1.3),
            y: (from: -0.02, to: 0.0, size: 1e-4, fine: (-5e-4, 0.0), growth: 1.3),
        ),
        supports: [(part: \"bottom\", x: Fixed, y: Fixed)],
        touches: Surface(\"top\"), wears: (thickness: 1e-4),
    )]";
    let cylinder = format!(
        "half_spaces=[(
            name: \"cylinder\", material: \"steel\", side: Above, x: (from: -1.5e-3, to: 1.5e-3, size: 1e-4), depth: 0.02,
            profile: Summit(x: 0.5), mass: 10.0, touches: Points,
            dofs: (x: Displacement(Sine(amplitude: 2e-5, frequency: 20.0, start: 0.01)), y: {PRESSED_AND_LIFTED}),
        )]"
    );
    a_cycle(case("fretting_wear_elastic", &[flat, &cylinder]), 1e-4);
}
