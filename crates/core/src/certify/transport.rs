//! Checks of transport laws: conductances are not negative, the same from either side, and
//! continuous.

use super::rig::{PRESSURE, RADIUS, Rig};
use super::{Check, CheckResult, surface};
use crate::laws::LawError;
use crate::laws::bench::{BenchMotion, ROOM_TEMPERATURE};

/// The checks.
pub const CHECKS: [(&str, Check); 4] = [
    ("sign", sign),
    ("symmetry", symmetry),
    ("continuity", continuity),
    ("objectivity", surface::objectivity),
];

/// Walks of gap, slip and load with temperatures from 1 K to 3000 K.
fn walks(rig: &Rig, seed: u64) -> Vec<BenchMotion> {
    let mut walk = rig.random_walk(seed, 200, 0.3);
    for (k, motion) in walk.iter_mut().enumerate() {
        let share = |n: u32| f64::from((k as u32 * n + seed as u32) % 97) / 96.0;
        motion.temperatures = [1.0 + 2999.0 * share(37), 1.0 + 2999.0 * share(59)];
        motion.pressure *= 10f64.powf(6.0 * share(11) - 3.0);
    }
    walk
}

/// Checks that heat and current do not flow uphill.
fn sign(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut worst = 0.0f64;
    for seed in 0..24 {
        let answers = rig.drive(&walks(rig, seed), 1e-3)?;
        let least = answers.iter().flat_map(|a| a.conductance);
        worst = least.fold(worst, |w, g| w.max(-g));
    }
    Ok(CheckResult::below(
        "sign",
        worst,
        0.0,
        "largest negative conductance",
    ))
}

/// Checks that exchanging the bodies changes nothing, so that what leaves one arrives in the other.
fn symmetry(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut worst = 0.0f64;
    for seed in 0..24 {
        let motions = walks(rig, seed);
        let turned: Vec<BenchMotion> = motions
            .iter()
            .map(|m| BenchMotion {
                temperatures: [m.temperatures[1], m.temperatures[0]],
                ..*m
            })
            .collect();
        let one = rig.drive(&motions, 1e-3)?;
        let other = rig.drive(&turned, 1e-3)?;
        for (a, b) in one.iter().zip(&other) {
            for (x, y) in a.conductance.into_iter().zip(b.conductance) {
                worst = worst.max((x - y).abs() / x.abs().max(y.abs()).max(f64::MIN_POSITIVE));
            }
        }
    }
    Ok(CheckResult::below(
        "symmetry",
        worst,
        1e-12,
        "largest relative change of a conductance when candidate and antagonist are exchanged",
    ))
}

/// Largest pressure (Pa) and temperature (K).
const MAX_PRESSURE_AND_TEMPERATURE: [f64; 2] = [1e9, 3000.0];

/// Names of the quantities along which conductances must be continuous.
const PATHS: [&str; 5] = ["load", "gap", "damage", "temperature", "slip"];

/// Returns the motion and the damage of a contact at the fraction `x` of a path.
fn on_path(path: &str, x: f64) -> (BenchMotion, f64) {
    let mut motion = BenchMotion {
        pressure: PRESSURE,
        ..BenchMotion::default()
    };
    let mut damage = 1.0;
    match path {
        "load" => motion.pressure = MAX_PRESSURE_AND_TEMPERATURE[0] * x,
        "gap" => {
            motion.gap = 0.1 * RADIUS * (x - 0.5);
            motion.pressure = PRESSURE * (1.0 - 2.0 * x).max(0.0);
        }
        "damage" => damage = x,
        "temperature" => {
            motion.temperatures = [1.0 + MAX_PRESSURE_AND_TEMPERATURE[1] * x, ROOM_TEMPERATURE]
        }
        _ => motion.opening[1] = 1e-3 * x,
    }
    (motion, damage)
}

/// Checks that conductances have no jumps: a solver that follows a contact as it closes would not
/// settle.
fn continuity(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const POINTS: u32 = 200;
    const HALVINGS: u32 = 40;
    let (mut worst, mut place) = (0.0f64, "load");
    for path in PATHS {
        let mut at = |x: f64| -> Result<[f64; 2], LawError> {
            let (motion, damage) = on_path(path, x);
            let mut state = rig.bench.fresh();
            state.damage = damage;
            Ok(rig.bench.step_one(&mut state, &motion, 1e-3)?.conductance)
        };
        for which in 0..2 {
            let mut points = Vec::new();
            for k in 0..=POINTS {
                let x = f64::from(k) / f64::from(POINTS);
                points.push((x, at(x)?[which]));
            }
            let scale = points.iter().fold(0.0f64, |m, p| m.max(p.1.abs()));
            let jump = |w: &[(f64, f64)]| (w[1].1 - w[0].1).abs();
            let pairs = points.windows(2).map(|pair| [pair[0], pair[1]]);
            let largest = pairs.max_by(|a, b| jump(a).total_cmp(&jump(b)));
            let Some(mut pair) = largest.filter(|_| scale > 0.0) else {
                continue;
            };
            for _ in 0..HALVINGS {
                let x = 0.5 * (pair[0].0 + pair[1].0);
                let middle = (x, at(x)?[which]);
                let [low, high] = [[pair[0], middle], [middle, pair[1]]];
                pair = if jump(&low) >= jump(&high) { low } else { high };
            }
            if jump(&pair) / scale > worst {
                (worst, place) = (jump(&pair) / scale, path);
            }
        }
    }
    Ok(CheckResult::below(
        "continuity",
        worst,
        1e-3,
        format!("largest jump of a conductance, over its largest value, along the {place}"),
    ))
}
