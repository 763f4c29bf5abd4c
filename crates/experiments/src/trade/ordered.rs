//! Levels of a step or a tolerance, from the finest up, with their further changes.

use super::varied::{ParameterEffect, Varied};
use crate::factor::Level;
use fretwork_scene::case::Case;

/// Formats a number so that RON can read it.
fn digits(x: f64) -> String {
    // Products of a decimal number with powers of two have rounding errors at the end, which 12
    // digits remove.
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    if rounded != 0.0 && !(1e-2..1e4).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

pub(super) fn number(key: &str, x: f64) -> Level {
    let label = digits(x);
    Level {
        sets: vec![format!("{key}={label}")],
        label,
        number: Some(x),
    }
}

/// Returns positive values including the case's own, from the finest up, each with the arguments of
/// its level.
fn ordered(
    name: &str,
    effect: ParameterEffect,
    own: f64,
    mut values: Vec<f64>,
    level: impl Fn(f64) -> Level,
) -> Varied {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b.abs();
    values.retain(|v| !same(*v, own));
    values.push(own);
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| same(*a, *b));
    let own = values.iter().position(|v| *v == own).unwrap_or(0);
    let levels = values.into_iter().map(level).collect();
    Varied::new(name, effect, levels, Some(own))
}

pub(super) fn steps(case: &Case, values: Vec<f64>) -> Varied {
    let every = case.output.every as f64 * case.time.step;
    ordered("step", ParameterEffect::Step, case.time.step, values, |h| {
        let mut level = number("time.step", h);
        // The interval in time between rows of the statistics is that of the case.
        let rows = (every / h).round().max(1.0);
        if rows != case.output.every as f64 {
            level.sets.push(format!("output.every={rows}"));
        }
        level
    })
}

pub(super) fn tolerances(case: &Case, own: f64, values: Vec<f64>) -> Varied {
    ordered("tolerance", ParameterEffect::Tolerance, own, values, |t| {
        let mut level = number("solver.tolerance", t);
        if t < own {
            // In the worst case methods of first order need proportionally more iterations.
            let most = f64::from(case.solver.max_iterations) * own / t;
            let most = most.min(f64::from(u32::MAX)).round();
            level.sets.push(format!("solver.max_iterations={most}"));
        }
        level
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well_and_back() {
        for x in [
            2e-8 / 4.0,
            1e-4 * 2.0,
            0.05,
            20.0,
            0.0,
            1e-4 * 10f64.powi(2),
        ] {
            let text = digits(x);
            assert!(text.len() < 9, "{text}");
            let back: f64 = text.parse().unwrap();
            assert!((back - x).abs() <= 1e-11 * x.abs());
        }
    }
}
