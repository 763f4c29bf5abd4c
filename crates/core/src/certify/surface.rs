//! Checks of laws without opening: contact, attraction, wear.

use super::rig::{PRESSURE, Rig};
use super::{Check, CheckResult, transport};
use crate::laws::LawError;
use crate::laws::bench::{BenchMotion, BenchOutputs};
use crate::laws::kind::CheckSet;

/// Returns the checks of a set, with their names.
pub fn checks(set: CheckSet) -> &'static [(&'static str, Check)] {
    const ALL: [(&str, Check); 3] = [
        ("dissipation", signs),
        ("objectivity", objectivity),
        ("convergence", convergence),
    ];
    match set {
        CheckSet::Removal => &ALL,
        CheckSet::Transport => &transport::CHECKS,
        CheckSet::Contact | CheckSet::Bond => &ALL[..2],
    }
}

/// Checks that friction, strengths, rolling friction and wear are not negative and that
/// restitution is between 0 and 1 along the normal and between -1 and 1 along the tangent, so that
/// no step creates energy or mass.
fn signs(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut worst = 0.0f64;
    for seed in 0..24 {
        let motions = rig.random_walk(seed, 200, 0.3);
        let answers = rig.drive(&motions, 1e-3)?;
        for a in answers {
            let [normal, tangential] = a.restitution;
            let least = [a.mu, a.worn, normal, 1.0 + tangential];
            let least = least.into_iter().chain(a.strength).chain(a.rolling);
            let least = least.fold(f64::INFINITY, f64::min);
            worst = worst.max(-least).max(normal - 1.0).max(tangential - 1.0);
        }
    }
    Ok(CheckResult::below(
        "dissipation",
        worst,
        0.0,
        "largest negative friction, strength, wear, or restitution above one",
    ))
}

/// Checks that rotating the tangential axes changes nothing.
pub fn objectivity(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let motions = rig.random_walk(7, 200, 0.1);
    let turned = motions.iter().map(|m| BenchMotion {
        opening: rig.in_rotated_axes(m.opening),
        ..*m
    });
    let turned: Vec<BenchMotion> = turned.collect();
    let plain = rig.drive(&motions, 1e-3)?;
    let other = rig.drive(&turned, 1e-3)?;
    let off = |x: f64, y: f64| (x - y).abs() / x.abs().max(y.abs()).max(f64::MIN_POSITIVE);
    let numbers = |a: &BenchOutputs| {
        let single = [a.mu, a.worn];
        single
            .into_iter()
            .chain(a.strength)
            .chain(a.restitution)
            .chain(a.rolling)
            .chain(a.conductance)
            .collect::<Vec<f64>>()
    };
    let worst = plain
        .iter()
        .zip(&other)
        .flat_map(|(a, b)| numbers(a).into_iter().zip(numbers(b)))
        .map(|(x, y)| off(x, y))
        .fold(0.0, f64::max);
    Ok(CheckResult::below(
        "objectivity",
        worst,
        1e-6,
        "largest relative change of the result when the tangential axes are rotated",
    ))
}

/// Checks that the wear volume of a slide does not depend on the number of steps.
fn convergence(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut volumes = Vec::new();
    for n in [10u32, 100, 1000] {
        let motions: Vec<BenchMotion> = (1..=n)
            .map(|k| BenchMotion {
                opening: [0.0, 1e-3 * f64::from(k) / f64::from(n), 0.0],
                pressure: PRESSURE,
                ..BenchMotion::default()
            })
            .collect();
        let answers = rig.drive(&motions, 1e-2 / f64::from(n))?;
        volumes.push(answers.iter().map(|a| a.worn).sum::<f64>());
    }
    let scale = volumes[2].abs().max(f64::MIN_POSITIVE);
    let worst = (volumes[0] - volumes[2]).abs() / scale;
    Ok(CheckResult::below(
        "convergence",
        worst,
        1e-6,
        format!(
            "volume of a slide of 1 mm, {:e} m^3, in 10 steps and in 1000: relative difference",
            volumes[2]
        ),
    ))
}
