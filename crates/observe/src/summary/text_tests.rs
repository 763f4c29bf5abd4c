use super::*;
use crate::fretting::{self, Regime};
use crate::scatter;
use crate::summary::Uncertainty;

/// Fifty cycles of a fretting test with damage and wear, partial slip at first and gross slip at the end.
fn fretting() -> Summary {
    let cycle = |k: u32| Cycle {
        cycle: k,
        complete: true,
        friction_coefficient: if k < 10 {
            0.3
        } else {
            0.4 + 1e-3 * f64::from(k * 7 % 5)
        },
        friction_from_dissipation: 0.41,
        normal_force: 1e3,
        tangential_amplitude: 550.0,
        work: 2e-3,
        energy_ratio: if k < 10 { 0.1 } else { 0.8 },
        regime: if k < 10 {
            Regime::Partial
        } else {
            Regime::Gross
        },
        wear_volume: 1e-15,
        ..Cycle::default()
    };
    let cycles: Vec<Cycle> = (1..=50).map(cycle).collect();
    let last = cycles[49].clone();
    let mut summary = Summary {
        case: "wheel on rail".to_owned(),
        trustworthy: true,
        dimension: 3,
        steps: 6000,
        time: 0.02,
        bonds: 40,
        broken: 12,
        damage_ratio: 0.3,
        friction_coefficient: Some(last.friction_coefficient),
        friction_from_dissipation: Some(0.41),
        peak_friction: last.peak_ratio(),
        fretting: fretting::Outcome::new(&cycles),
        ..Summary::default()
    };
    summary.energy.friction = 0.1;
    summary.energy.external_work = 0.11;
    summary.wear.volume_first_bodies = 5e-14;
    let body = |name: &str, volume: f64| BodyWear {
        body: name.to_owned(),
        volume,
        depth_mean: Some(1e-7),
        depth_max: Some(3e-7),
        specific_rate: Some(volume / 10.0),
    };
    summary.wear.bodies = vec![body("rail", 3e-14), body("wheel", 2e-14)];
    summary.measures = (0..31).map(|k| (format!("layer_{k:02}"), 1.0)).collect();
    let friction = scatter::over_cycles(&cycles, |c| c.friction_coefficient);
    summary.cycles = cycles;
    summary.uncertainty = Uncertainty::new(&summary, friction.as_ref());
    summary
}

fn place(text: &str, what: &str) -> usize {
    text.find(what)
        .unwrap_or_else(|| panic!("no `{what}` in:\n{text}"))
}

#[test]
fn warnings_come_first_then_friction_damage_wear_energies() {
    let mut summary = fretting();
    summary.trustworthy = false;
    summary.warnings = vec!["NOT CONVERGED: 12 of 6000 steps".to_owned()];
    let text = summary.text(false);
    assert!(
        text.starts_with("NOT TRUSTWORTHY\n  NOT CONVERGED: "),
        "{text}"
    );
    let order = [
        "NOT CONVERGED",
        "wheel on rail",
        "friction coefficient",
        "energetic coefficient",
        "peak Q/P",
        "damage",
        "wear of rail",
        "wear of wheel",
        "\n  dissipated",
        "external work",
    ];
    let places: Vec<usize> = order.iter().map(|w| place(&text, w)).collect();
    assert!(places.is_sorted(), "{places:?}\n{text}");
}

#[test]
fn results_have_units_and_intervals_and_no_lists() {
    let text = fretting().text(false);
    assert!(!text.contains("NOT TRUSTWORTHY"));
    // k in 26..=50: each of 0.400 to 0.404 five times, mean 0.402, deviation 1e-3 sqrt(2 * 25/24), t(24, 0.975) = 2.0639:
    // 0.000596.
    place(&text, "0.4020 +- 0.00060 (95 %, Student, cycles 26 to 50");
    place(
        &text,
        "0.5500 in cycle 50, the last complete one: largest |Q| over mean P",
    );
    place(&text, "50 complete; 0.3000 in the first");
    place(&text, "gross slip in cycle 50; mixed over all cycles");
    place(
        &text,
        "3.000e-5 mm3, 100.0 nm deep on average where worn, 300.0 nm at most; k = V/(P s) = 3.000e-6 mm3/(N m)",
    );
    place(&text, "measures               31 values: --verbose");
    place(&text, "friction 100.0 mJ");
    assert!(
        !text.contains("layer_") && text.lines().count() < 25,
        "{text}"
    );
}

#[test]
fn all_there_is_comes_on_request() {
    let text = fretting().text(true);
    for what in ["layer_30", "cycle 1 ", "cycle 50", "solver", "made with"] {
        place(&text, what);
    }
    assert!(!text.contains("cycle 25"), "{text}");
}

#[test]
fn energies_are_named_as_in_the_ledger_and_balance() {
    let mut summary = fretting();
    // A fall: 12 J of work and 80 J of gravity, of which 5 J are kinetic and 3 J in bonds.
    let e = &mut summary.energy;
    *e = Default::default();
    (e.external_work, e.potential, e.initial_kinetic) = (12.0, -80.0, 1.0);
    (e.kinetic, e.elastic, e.friction, e.adhesion) = (5.0, 3.0, 60.0, 25.0);
    (e.viscous, e.scheme) = (1e-3, 1e-3);
    let text = summary.text(false);
    place(&text, "friction 60.00 J, adhesion 25.00 J\n");
    place(
        &text,
        "kinetic energy 5.000 J, 1.000 J at the start; elastic energy 3.000 J\n",
    );
    place(&text, "12.00 J; gravity gave 80.00 J; the ledger");
    assert!(!text.contains("damping") && !text.contains("time integration"));
    // Damping and time integration are separate entries; a rise takes energy.
    let e = &mut summary.energy;
    (e.viscous, e.scheme, e.potential) = (2.0, 4.0, 7.0);
    let text = summary.text(false);
    place(
        &text,
        "damping 2.000 J, adhesion 25.00 J, time integration 4.000 J\n",
    );
    place(&text, "gravity took 7.000 J");
}
