//! Checks of laws with an opening: cohesion and damage.

use super::rig::{Rig, pull};
use super::{Check, CheckResult};
use crate::laws::bench::{BenchMotion, BenchOutputs};
use crate::laws::{Kind, LawError};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

pub const CHECKS: [(&str, Check); 9] = [
    ("fracture energy", fracture_energy),
    ("stored energy", stored_energy),
    ("dissipation", dissipation),
    ("damage grows", damage_grows),
    ("objectivity", objectivity),
    ("convergence", convergence),
    ("tangent", tangent),
    ("secant", secant),
    ("degradation", degradation),
];

/// Checks that the stored energy declared for the undamaged bond is the work done on it.
fn stored_energy(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "stored energy";
    /// Number of intervals of Simpson's rule.
    const N: usize = 400;
    if rig.kind != Kind::COHESION {
        return Ok(CheckResult::skip(NAME, "the energy is the cohesion's"));
    }
    // The onset is known to a tenth of a decade only.
    let reach = if rig.damages() { 0.5 } else { 1.0 } * rig.onset;
    let (mut worst, mut tested) = (0.0f64, 0);
    for angle in [0.0, FRAC_PI_4, FRAC_PI_2] {
        let motions: Vec<BenchMotion> = (0..=N)
            .map(|k| pull(reach * k as f64 / N as f64, angle))
            .collect();
        let answers = rig.drive(&motions, 1.0)?;
        if answers.iter().any(|a| a.damage > 0.0) {
            continue;
        }
        let along = |a: &BenchOutputs| a.traction[0] * angle.cos() + a.traction[1] * angle.sin();
        let weighted = answers.iter().enumerate().map(|(k, a)| {
            let weight = match k {
                0 | N => 1.0,
                k if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * along(a)
        });
        let work = weighted.sum::<f64>() * reach / (3.0 * N as f64);
        let stored = answers[N].stored - answers[0].stored;
        let scale = work.abs().max(stored.abs()).max(f64::MIN_POSITIVE);
        worst = worst.max((work - stored).abs() / scale);
        tested += 1;
    }
    if tested == 0 {
        return Ok(CheckResult::skip(
            NAME,
            "the bond has damage at any opening",
        ));
    }
    // The error of Simpson's rule is of the order of (1/400)^4 for a smooth law.
    Ok(CheckResult::below(
        NAME,
        worst,
        1e-6,
        "work on the undamaged bond in three directions and its declared stored energy: relative difference",
    ))
}

/// Checks that the declared fracture energy is the area under one slow pull to failure, in modes I,
/// mixed and II.
fn fracture_energy(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "fracture energy";
    let tested = rig.tested();
    let declared = |angle: f64| tested.plugin.fracture_energy(&tested.parameters, angle);
    let modes: Vec<(f64, f64)> = [0.0, FRAC_PI_4, FRAC_PI_2]
        .into_iter()
        .filter_map(|angle| declared(angle).map(|e| (angle, e)))
        .collect();
    if modes.is_empty() {
        return Ok(CheckResult::skip(
            NAME,
            "the law declares no fracture energy",
        ));
    }
    // An unbounded tail is cut where it is negligible.
    let end = rig.end.unwrap_or(1e3 * rig.onset);
    let (mut worst, mut areas) = (0.0f64, String::new());
    for (angle, declared) in modes {
        // Fine steps up to three times the onset, then geometric ones until well past the end.
        let near = (1..=20_000).map(|k| 3.0 * rig.onset * f64::from(k) / 20_000.0);
        let decades = (30.0 * end / (3.0 * rig.onset)).max(1.0).ln();
        let far = (1..=20_000).map(|k| 3.0 * rig.onset * (decades * f64::from(k) / 20_000.0).exp());
        let motions: Vec<BenchMotion> = near.chain(far).map(|u| pull(u, angle)).collect();
        let answers = rig.drive(&motions, 1.0)?;
        let area = increments(&motions, &answers).sum::<f64>();
        worst = worst.max((area / declared - 1.0).abs());
        areas += &format!(
            " {area:.6e} for {declared:.6e} at {:.0} deg,",
            angle.to_degrees()
        );
    }
    // A law may cut its tail at a thousandth of the energy; the error of the trapezoidal rule is
    // 2e-4 for an abrupt failure, 1e-6 otherwise.
    Ok(CheckResult::below(
        NAME,
        worst,
        2e-3,
        format!("area under a pull{areas} worst relative error"),
    ))
}

/// Returns the work per area done on a new bond in each step, by the trapezoidal rule (J/m^2).
fn increments(motions: &[BenchMotion], answers: &[BenchOutputs]) -> impl Iterator<Item = f64> {
    let mut last = (BenchMotion::default(), BenchOutputs::default());
    motions.iter().zip(answers).map(move |(to, b)| {
        let (from, a) = std::mem::replace(&mut last, (*to, *b));
        let mut sum = 0.0;
        for k in 0..3 {
            sum += 0.5 * (a.traction[k] + b.traction[k]) * (to.opening[k] - from.opening[k]);
            sum += 0.5 * (a.moment[k] + b.moment[k]) * (to.rotation[k] - from.rotation[k]);
        }
        sum
    })
}

/// Checks on random walks that dissipation, work minus stored energy, never decreases.
fn dissipation(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut worst = 0.0f64;
    let walks = (0..24).map(|seed| rig.random_walk(seed, 800, 0.02));
    let paths: Vec<Vec<BenchMotion>> = walks.chain(loops(rig)).collect();
    for motions in paths {
        let answers = rig.drive(&motions, 1e-3)?;
        let (mut work, mut most, mut scale, mut fall) = (0.0, 0.0f64, 0.0f64, 0.0f64);
        for (increment, answer) in increments(&motions, &answers).zip(&answers) {
            work += increment;
            let dissipated = work - answer.stored;
            scale = scale.max(answer.stored.abs());
            fall = fall.max(most - dissipated);
            most = most.max(dissipated);
        }
        worst = worst.max(fall / scale.max(f64::MIN_POSITIVE));
    }
    // The error of the trapezoidal rule is quadratic in the step of the walk: 2e-3 where damage
    // starts within a step.
    Ok(CheckResult::below(
        "dissipation",
        worst,
        5e-3,
        "largest decrease of work minus stored energy on random walks and in unloading and reloading, relative to the energy scale",
    ))
}

/// Returns paths of loading, unloading, reloading and unloading to several levels beyond the onset,
/// in three directions.
fn loops(rig: &Rig) -> Vec<Vec<BenchMotion>> {
    let mut out = Vec::new();
    for level in [1.2, 1.5, 2.0, 3.0] {
        let top = level * rig.onset;
        for angle in [0.0, FRAC_PI_4, FRAC_PI_2] {
            let rise = |k: u32| match k / 400 % 2 {
                0 => f64::from(k % 400 + 1) / 400.0,
                _ => 1.0 - f64::from(k % 400 + 1) / 400.0,
            };
            out.push((0..1600).map(|k| pull(top * rise(k), angle)).collect());
        }
    }
    out
}

/// Checks that the traction at D is (1 - D)^m times that of the undamaged bond.
fn degradation(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "degradation";
    if rig.kind != Kind::COHESION {
        return Ok(CheckResult::skip(NAME, "the traction is the cohesion's"));
    }
    let m = rig.tested().plugin.degradation;
    if m <= 0.0 {
        return Ok(CheckResult::skip(NAME, "the law has no damage"));
    }
    let mut worst = 0.0f64;
    for angle in [0.0, FRAC_PI_4, FRAC_PI_2] {
        let at = pull(0.5 * rig.onset, angle);
        let fresh = rig.bench.fresh();
        let intact = rig.bench.step_one(&mut fresh.clone(), &at, 1e-9)?.traction;
        let scale = intact.iter().fold(f64::MIN_POSITIVE, |s, t| s.max(t.abs()));
        for damage in [0.3, 0.7, 1.0] {
            let mut state = fresh.clone();
            state.damage = damage;
            let damaged = rig.bench.step_one(&mut state, &at, 1e-9)?.traction;
            let remaining = (1.0f64 - damage).powf(m);
            for (t, t0) in damaged.iter().zip(intact) {
                worst = worst.max((t - remaining * t0).abs() / scale);
            }
        }
    }
    Ok(CheckResult::below(
        NAME,
        worst,
        // Not zero: a law without an onset has a little damage at any opening.
        1e-5,
        format!(
            "largest distance of the traction at D = 0.3, 0.7 and 1 from (1 - D)^{m} of the undamaged one"
        ),
    ))
}

/// Checks that D never decreases, stays in [0, 1], and that broken bonds stay broken.
fn damage_grows(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "damage grows";
    if !rig.damages() {
        return Ok(CheckResult::skip(NAME, "no damage"));
    }
    let (mut worst, mut highest, mut raw) = (0.0f64, 0.0f64, 0.0f64);
    for seed in 0..24 {
        let motions = rig.random_walk(100 + seed, 400, 0.3);
        let mut state = rig.bench.fresh();
        for motion in &motions {
            let before = state.damage;
            let answer = rig.bench.step_one(&mut state, motion, 1e-3)?;
            // The host enforces that D does not decrease: the law's own value is checked.
            raw = raw.max(before - rig.bench.declared_damage()[0]);
            worst = worst.max(before - answer.damage);
            highest = highest.max(answer.damage);
        }
    }
    // The check is not meaningful for a law that caused no damage on the path.
    let kept = worst <= 0.0 && raw <= 1e-12 && highest <= 1.0 && highest > 0.0;
    let text = format!("largest decrease of D on random walks, which reached D = {highest:.3}");
    Ok(CheckResult::judged(NAME, kept, raw.max(worst), text))
}

/// Checks that rotating the tangential axes rotates the result and changes nothing else.
fn objectivity(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let motions = rig.random_walk(7, 300, 0.1);
    let turned = motions.iter().map(|m| BenchMotion {
        opening: rig.in_rotated_axes(m.opening),
        rotation: rig.in_rotated_axes(m.rotation),
        ..*m
    });
    let turned: Vec<BenchMotion> = turned.collect();
    let plain = rig.drive(&motions, 1e-3)?;
    let other = rig.drive(&turned, 1e-3)?;
    let pairs = || plain.iter().zip(&other);
    // Largest difference of a vector, relative to its largest component.
    let difference = |of: fn(&BenchOutputs) -> [f64; 3]| {
        let largest = plain.iter().flat_map(of);
        let largest = largest.fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        let vectors = pairs().flat_map(|(a, b)| rig.in_rotated_axes(of(a)).into_iter().zip(of(b)));
        vectors.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / largest
    };
    let damage = pairs().fold(0.0, |m: f64, (a, b)| m.max((a.damage - b.damage).abs()));
    let worst = damage.max(difference(|a| a.traction));
    Ok(CheckResult::below(
        "objectivity",
        worst.max(difference(|a| a.moment)),
        1e-8,
        "largest change of D, traction and moment when the tangential axes are rotated",
    ))
}

/// Measures the order at which the energy of a pull of fixed duration converges with the step.
fn convergence(rig: &mut Rig) -> Result<CheckResult, LawError> {
    /// Steps of the coarsest pull.
    const COARSEST: u32 = 50;
    /// Number of times that the steps are halved.
    const HALVINGS: u32 = 4;
    /// Number of pulls of slightly different reach.
    const REACHES: u32 = 16;
    /// Fractional part of the golden ratio, whose multiples spread evenly over the places of the
    /// onset within a step.
    const SPREAD: f64 = 0.618_033_988_749_894_9;
    let reach = before_failure(rig, 2.0);
    // The error of a pull depends on where within a step the onset falls, so that the order found
    // from one pull is a matter of chance: the root mean square over several reaches is used.
    let mut squares = [0.0f64; HALVINGS as usize];
    let mut scale = f64::MIN_POSITIVE;
    for pull_number in 0..REACHES {
        let place = (f64::from(pull_number) * SPREAD).fract();
        // The onset moves over one of the coarsest steps.
        let reach = reach * (1.0 + place * reach / (rig.onset * f64::from(COARSEST)));
        let mut energies = Vec::new();
        for halving in 0..=HALVINGS {
            let n = COARSEST << halving;
            let motions: Vec<BenchMotion> = (1..=n)
                .map(|k| pull(reach * f64::from(k) / f64::from(n), 0.3))
                .collect();
            let answers = rig.drive(&motions, 1e-2 / f64::from(n))?;
            energies.push(increments(&motions, &answers).sum::<f64>());
        }
        for (sum, pair) in squares.iter_mut().zip(energies.windows(2)) {
            *sum += (pair[1] - pair[0]).powi(2) / f64::from(REACHES);
        }
        scale = energies.iter().fold(scale, |s, e| s.max(e.abs()));
    }
    let changes = squares.map(|sum| sum.sqrt() / scale);
    let (first, last) = (changes[0], changes[HALVINGS as usize - 1]);
    if last <= 1e-9 {
        return Ok(CheckResult::judged(
            "convergence",
            true,
            last,
            "the energy of a pull does not depend on the step",
        ));
    }
    let order = (first / last).log2() / f64::from(HALVINGS - 1);
    let text = format!(
        "order in the step of the energy of a pull, from the root mean square of {REACHES} pulls, last relative change {last:.1e}; at least 0.7"
    );
    Ok(CheckResult::judged(
        "convergence",
        order >= 0.7,
        order,
        text,
    ))
}

/// Checks that the stiffness is the tangent or the secant of the traction, at frozen damage and
/// variables.
fn tangent(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "tangent";
    if rig.kind != Kind::COHESION {
        return Ok(CheckResult::skip(NAME, "the traction is the cohesion's"));
    }
    let mut worst = 0.0f64;
    for (u, angle) in [(0.3, 0.0), (0.6, 0.7), (0.9, 1.4), (0.5, FRAC_PI_2)] {
        let u = u * rig.onset;
        let mut state = rig.bench.fresh();
        let at = pull(u, angle);
        let base = rig.bench.step_one(&mut state, &at, 1e-3)?;
        for (k, stiffness) in base.stiffness.into_iter().enumerate().take(2) {
            if at.opening[k] <= 1e-9 * u {
                continue;
            }
            let e = 1e-5 * u;
            let mut traction = |change: f64| -> Result<f64, LawError> {
                let mut to = at;
                to.opening[k] += change;
                let answer = rig.bench.step_one(&mut state.clone(), &to, 1e-9)?;
                Ok(answer.traction[k])
            };
            let slope = (traction(e)? - traction(-e)?) / (2.0 * e);
            let secant = base.traction[k] / at.opening[k];
            let scale = slope.abs().max(secant.abs()).max(f64::MIN_POSITIVE);
            // A softening traction has no positive tangent: zero or the secant are accepted.
            let off = [slope.max(0.0), secant]
                .into_iter()
                .map(|right| (stiffness - right).abs() / scale)
                .fold(f64::INFINITY, f64::min);
            worst = worst.max(off);
        }
    }
    Ok(CheckResult::below(
        NAME,
        worst,
        1e-3,
        "largest difference between the stiffness and the tangent or secant of the traction",
    ))
}

/// Checks that unloading half way and completely follows the path of the undamaged bond, scaled by
/// the remaining stiffness, to the origin, and that reloading returns along it.
fn secant(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const NAME: &str = "secant";
    let mut worst = 0.0f64;
    for angle in [0.0, FRAC_PI_4, FRAC_PI_2] {
        let top = before_failure(rig, 1.5);
        let mut state = rig.bench.fresh();
        for k in 1..=50 {
            let motion = pull(top * f64::from(k) / 50.0, angle);
            rig.bench.step_one(&mut state, &motion, 1e-6)?;
        }
        let mut go = |u: f64| rig.bench.step_one(&mut state, &pull(u, angle), 1e-12);
        let up = go(top)?;
        let half = go(0.5 * top)?;
        let none = go(0.0)?;
        let again = go(0.5 * top)?;
        let scale = length(&up).max(f64::MIN_POSITIVE);
        let share = undamaged(rig, angle, 0.5 * top)? / undamaged(rig, angle, top)?;
        if up.damage >= 1.0 {
            continue;
        }
        // A fatigue law causes damage on the way: tractions are divided by the remaining stiffness.
        let remaining = |a: &BenchOutputs| (1.0 - a.damage).max(f64::MIN_POSITIVE);
        let same =
            |a: &BenchOutputs, b: &BenchOutputs| (remaining(a) / remaining(b) - 1.0).abs() < 1e-12;
        worst = worst.max(length(&none) / scale);
        if same(&half, &again) {
            worst = worst.max((length(&half) - length(&again)).abs() / scale);
        }
        if rig.damages() && same(&up, &half) {
            worst = worst.max((share * length(&up) - length(&half)).abs() / scale);
        }
    }
    Ok(CheckResult::below(
        NAME,
        worst,
        1e-6,
        "largest distance from the path of the undamaged bond to the origin, a line where it is linear, on unloading and reloading",
    ))
}

/// Returns this multiple of the onset (m), or the middle between onset and failure if that is less.
fn before_failure(rig: &Rig, multiple: f64) -> f64 {
    let reach = multiple * rig.onset;
    rig.end
        .map_or(reach, |end| reach.min(0.5 * (rig.onset + end)))
}

/// Returns the magnitude of the traction (Pa).
fn length(a: &BenchOutputs) -> f64 {
    a.traction.iter().map(|t| t * t).sum::<f64>().sqrt()
}

/// Returns the traction of the undamaged bond at an opening `u` (m) at an angle from the normal
/// (rad), up to a constant factor. The bond is linear where the law under test is not a cohesion.
fn undamaged(rig: &mut Rig, angle: f64, u: f64) -> Result<f64, LawError> {
    let m = rig.tested().plugin.degradation;
    if rig.kind != Kind::COHESION || m <= 0.0 {
        return Ok(u);
    }
    let mut state = rig.bench.fresh();
    let answer = rig.bench.step_one(&mut state, &pull(u, angle), 1e-12)?;
    let remaining = (1.0f64 - answer.damage).powf(m);
    Ok(if remaining > 0.0 {
        length(&answer) / remaining
    } else {
        u
    })
}
