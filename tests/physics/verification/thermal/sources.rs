//! Heat sources: partition, flash temperatures, start and end of the heat, extremes.

use super::super::{Table, plane, solid, until};
use super::{effusivity, heat, temperature};
use std::f64::consts::PI;

pub fn all(table: &mut Table) {
    extremes(table);
    partition(table);
    flash(table);
    start(table);
}

/// Conductances over 18 decades, steps far above and far below the thermal time, absolute zero, and
/// grains without contacts.
fn extremes(table: &mut Table) {
    let case = "thermal/cubic";
    for conductance in ["1e-9", "1e-3", "1e3", "1e9"] {
        for clock in ["1e-9", "1e15"] {
            let sets = [
                "interfaces.0.transport=\"constant-conductance\"".to_owned(),
                format!("interfaces.0.parameters.transport={{\"thermal\": {conductance}}}"),
                format!("heat.clock={clock}"),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let mut s = solid(case, &sets);
            until(&mut s, 5e-3, |s| {
                // The heat of friction and damping is below a microkelvin.
                let all = heat(s).nodes.iter().map(|n| n.temperature);
                assert!(
                    all.clone()
                        .all(|t| (300.0 - 1e-6..=400.0 + 1e-6).contains(&t)),
                    "{sets:?}"
                );
            });
            let name = format!("{conductance} W/K, clock {clock}: account");
            let off = heat(&s).ledger.relative_residual();
            table.closes(case, &name, off, 1e-10);
        }
    }
    let case = "thermal/network";
    let mut s = plane(case, &["heat.initial=0.0", "heat.circuit=None"]);
    until(&mut s, 5e-3, |_| ());
    let coldest = heat(&s)
        .nodes
        .iter()
        .map(|n| n.temperature)
        .fold(f64::INFINITY, f64::min);
    table.compare(
        case,
        "from absolute zero: coldest (K)",
        0.0,
        coldest.min(0.0),
        0.0,
    );
    // One grain in vacuum keeps its temperature to the last bit.
    let case = "thermal/slide_to_stop";
    let mut s = plane(
        case,
        &[
            "bodies.block.position=[0.0, 5.0]",
            "gravity=[0.0, 0.0]",
            "heat.initial=777.7",
        ],
    );
    until(&mut s, 0.1, |_| ());
    table.compare(
        case,
        "a body in vacuum (K)",
        777.7,
        temperature(&s, "block"),
        0.0,
    );
    // Heat without effect on laws changes no bit of the mechanics.
    let (mut with, mut without) = (
        plane("thermal/energy", &[]),
        plane("thermal/energy", &["heat=None"]),
    );
    until(&mut with, 0.05, |_| ());
    until(&mut without, 0.05, |_| ());
    assert_eq!(with.positions(), without.positions());
    assert_eq!(
        with.energies().residual.to_bits(),
        without.energies().residual.to_bits()
    );
}

/// Steel slides on a poor conductor, and contacts do not conduct.
const RUBBED: [&str; 5] = [
    "interfaces.0.contact=\"coulomb\"",
    "interfaces.0.parameters.contact={\"mu\": 0.5}",
    "interfaces.0.parameters.transport={\"thermal\": 0.0, \"reach\": 1e-6}",
    "bodies.1.dofs.x=Velocity(Constant(0.1))",
    "heat.initial=300.0",
];

/// The heat of friction is split in proportion to the effusivities, or in halves, and goes to one
/// side if the other is insulated.
fn partition(table: &mut Table) {
    let case = "thermal/two_half_spaces";
    let (steel, oxide) = (effusivity(), (4.0f64 * 650.0 * 5000.0).sqrt());
    let floor = |more: &str| {
        let mut s = plane(case, &[&RUBBED[..], &[more]].concat());
        until(&mut s, 1e-3, |_| ());
        let all = &heat(&s).received;
        assert!(s.energies().friction > 0.0);
        [all[0], all[1]].map(|q| q / s.energies().friction)
    };
    let [floor_by_e, block_by_e] = floor("heat.partition=Effusivity");
    table.compare(
        case,
        "floor by effusivity",
        oxide / (oxide + steel),
        floor_by_e,
        1e-9,
    );
    table.compare(
        case,
        "block by effusivity",
        steel / (oxide + steel),
        block_by_e,
        1e-9,
    );
    table.compare(
        case,
        "floor by halves",
        0.5,
        floor("heat.partition=Half")[0],
        1e-9,
    );
    let insulated = floor("heat.bodies.block=(store: Insulated)");
    table.compare(
        case,
        "floor under an insulated block",
        1.0,
        insulated[0],
        1e-9,
    );
    let share = floor("heat.shares.friction=0.25");
    table.compare(case, "a quarter of it", 0.25, share[0] + share[1], 1e-9);
}

/// Each contact has Jaeger's band: its width is the force over the hardness, it moves at half of
/// the speed over each body, and the rises in the two bodies add up in parallel. With the clock it
/// is slower by the factor of the clock.
fn flash(table: &mut Table) {
    let case = "thermal/two_half_spaces";
    let (steel, oxide) = (effusivity(), (4.0f64 * 650.0 * 5000.0).sqrt());
    for clock in [1.0, 10.0] {
        let clocked = format!("heat.clock={clock}");
        let sets = [&RUBBED[..], &["heat.flash=1e9", &clocked]].concat();
        let mut s = plane(case, &sets);
        until(&mut s, 5e-4, |_| ());
        let contacts: Vec<f64> = s.contacts().map(|c| c.normal_force).collect();
        let before: Vec<f64> = ["floor", "block"].map(|b| temperature(&s, b)).to_vec();
        s.step().expect("a step");
        let seen = &s
            .state
            .network
            .thermal
            .as_ref()
            .expect("temperatures")
            .temperatures;
        let mean = (oxide * before[0] + steel * before[1]) / (oxide + steel);
        for (force, seen) in contacts.iter().zip(seen) {
            let (v, width) = (0.1 / clock, force / 1e9);
            let flux = 0.5 * force * v / width;
            let rise = |e: f64| 2.0 * flux * (width / (0.5 * v)).sqrt() / (e * PI.sqrt());
            let exact = 1.0 / (1.0 / rise(steel) + 1.0 / rise(oxide));
            let name = format!("flash temperature, clock {clock} (K)");
            table.compare(case, &name, exact, seen.temperature[0] - mean, 1e-6);
        }
    }
    for (quantity, sets) in [
        ("no flash without sliding (K)", vec!["heat.flash=1e9"]),
        (
            "no flash before the start of the heat (K)",
            [&RUBBED[..], &["heat.flash=1e9", "heat.start=1.0"]].concat(),
        ),
    ] {
        let mut cold = plane(case, &sets);
        until(&mut cold, 5e-4, |_| ());
        let thermal = cold.state.network.thermal.as_ref().expect("temperatures");
        let off = thermal
            .temperatures
            .iter()
            .map(|seen| seen.temperature)
            .map(|[t, a, b]| (t - a.max(b)).max(0.0));
        table.compare(case, quantity, 0.0, off.sum(), 1e-12);
    }
}

/// Before the heat starts nothing is supplied and nothing flows.
fn start(table: &mut Table) {
    let case = "thermal/two_half_spaces";
    let mut s = plane(case, &[&RUBBED[..], &["heat.start=5e-4"]].concat());
    until(&mut s, 5e-4, |_| ());
    let before = (s.energies().friction, heat(&s).ledger.dissipated);
    assert!(before.0 > 0.0 && before.1 == 0.0);
    until(&mut s, 1e-3, |_| ());
    let since = s.energies().friction - before.0;
    table.compare(
        case,
        "heat since its start (J/m)",
        since,
        heat(&s).ledger.dissipated,
        1e-12,
    );
    // Convection of a body ends with the body.
    let case = "thermal/runaway";
    let mut s = plane(case, &["bodies.block.vanishes=1.0"]);
    until(&mut s, 1.0, |_| ());
    let then = heat(&s).ledger.surroundings;
    assert!(then < 0.0);
    until(&mut s, 2.0, |_| ());
    let off = heat(&s).ledger.surroundings - then;
    table.compare(
        case,
        "a body that is gone is not cooled (J/m)",
        0.0,
        off,
        1e-2 * then.abs(),
    );
}
