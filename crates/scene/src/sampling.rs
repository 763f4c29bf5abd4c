//! Check for functions of time that change faster than the time step resolves.
//!
//! Imposed motion is on its path at the end of every step, but linear in between, and forces are
//! evaluated once per step.

use super::case::{BodySpec, Case};
use super::phases::{drives_of, drives_of_holder, holder_name};
use fretwork_core::bodies::{Dof, STEPS_A_PERIOD, TimeFunction};
use fretwork_core::step::control::GravityDrive;

/// Steps per period below which a sine aliases to another frequency (Nyquist).
const ALIAS: f64 = 2.0;
/// Smallest recommended number of steps of a ramp or a table.
const SHORT: f64 = 5.0;

/// A function of time that the time step of a case does not resolve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnresolvedDrive {
    /// Message: what is driven, what is wrong and what to change.
    pub text: String,
    /// Whether the function aliases to another frequency.
    pub aliased: bool,
}

/// Returns the functions that the time step does not resolve: of rigid and deformable bodies, then
/// of phases, then of gravity.
pub fn unresolved(case: &Case) -> Vec<UnresolvedDrive> {
    let dimension = case.dimension as usize;
    let h = case.time.step;
    let mut found: Vec<UnresolvedDrive> = Vec::new();
    let mut add = |of: String, function: &TimeFunction, moves: bool| {
        if let Some(what) = fault(function, h, moves) {
            let drive = UnresolvedDrive {
                text: format!("{of}: {what}"),
                aliased: aliased(function, h),
            };
            if !found.contains(&drive) {
                found.push(drive);
            }
        }
    };
    for body in &case.bodies {
        let names = BodySpec::names(dimension);
        for (k, dof) in drives_of(case, body) {
            for drive in dof.drives() {
                if let Some(function) = drive.function() {
                    let moves = matches!(drive, Dof::Displacement(_));
                    add(
                        format!("`{}` along {}", body.name, names[k]),
                        function,
                        moves,
                    );
                }
            }
        }
    }
    let supports = case.elastic.iter().flat_map(|body| {
        let supports = body.supports.iter();
        supports.map(move |s| {
            let name = format!("`{}` {}", body.name, s.part);
            (name, holder_name(&body.name, &s.part), [&s.x, &s.y, &s.z])
        })
    });
    let half_spaces = case.half_spaces.iter().map(|body| {
        let dofs = &body.dofs;
        let name = format!("`{}`", body.name);
        (name, body.name.clone(), [&dofs.x, &dofs.y, &dofs.z])
    });
    for (name, holder, dofs) in supports.chain(half_spaces) {
        for (k, (axis, dof)) in ["x", "y", "z"].iter().zip(dofs).enumerate() {
            for drive in drives_of_holder(case, &holder, k, dof).flat_map(Dof::drives) {
                if let Some(function) = drive.function() {
                    let moves = matches!(drive, Dof::Displacement(_));
                    add(format!("{name} along {axis}"), function, moves);
                }
            }
        }
    }
    for body in &case.half_spaces {
        if let Some(function) = &body.rolling {
            add(format!("`{}` rolling", body.name), function, false);
        }
    }
    let phases = case.phases.iter().filter_map(|p| p.gravity_drive.as_ref());
    for gravity in case.gravity_drive.iter().chain(phases) {
        let functions: &[TimeFunction] = match gravity {
            GravityDrive::Turned { angle, .. } => std::slice::from_ref(angle),
            GravityDrive::Scaled(f) => std::slice::from_ref(f),
            GravityDrive::Axes(list) => list,
        };
        for function in functions {
            add("gravity".to_owned(), function, false);
        }
    }
    found
}

/// Whether a function aliases when sampled with step `h` (s).
fn aliased(function: &TimeFunction, h: f64) -> bool {
    match function {
        TimeFunction::Sine {
            amplitude,
            frequency,
            ..
        } => *amplitude != 0.0 && 1.0 / (frequency * h) <= ALIAS,
        _ => false,
    }
}

/// Returns the fault of a function sampled with step `h` (s), if it has one; `moves` if the
/// function is a displacement.
fn fault(function: &TimeFunction, h: f64, moves: bool) -> Option<String> {
    match function {
        TimeFunction::Constant(_) => None,
        TimeFunction::Sine {
            amplitude,
            frequency,
            ..
        } => {
            let steps = 1.0 / (frequency * h);
            let most = 1.0 / (STEPS_A_PERIOD * frequency);
            if *amplitude == 0.0 || steps.is_nan() || steps >= STEPS_A_PERIOD * (1.0 - 1e-9) {
                None
            } else if steps <= ALIAS {
                Some(format!(
                    "the sine of {frequency} Hz has {steps:.3} steps a period and ALIASES: the steps sample another \
                     motion, or none at all; take time.step = {most:.2e} s or less, or a lower frequency"
                ))
            } else {
                Some(format!(
                    "the sine of {frequency} Hz has only {steps:.1} steps a period; take time.step = {most:.2e} s or \
                     less ({STEPS_A_PERIOD} steps a period), or a lower frequency"
                ))
            }
        }
        TimeFunction::Ramp {
            from,
            to,
            start,
            end,
        } => {
            let steps = (end - start) / h;
            (from != to && steps < SHORT * (1.0 - 1e-9)).then(|| {
                format!(
                    "the ramp from {start:e} to {end:e} s lasts only {steps:.3} steps; take a smaller time.step, or a \
                     ramp of {:.2e} s or more",
                    SHORT * h
                )
            })
        }
        TimeFunction::Table(points) => table(points, h, moves),
    }
}

fn table(points: &[(f64, f64)], h: f64, moves: bool) -> Option<String> {
    let changes = |w: &&[(f64, f64)]| w[0].1 != w[1].1;
    let short = |w: &[(f64, f64)]| w[1].0 - w[0].0 < h * (1.0 - 1e-9);
    let pieces: Vec<&[(f64, f64)]> = points.windows(2).collect();
    // A short piece followed by another short piece is lost detail; a single one is a deliberate
    // jump in a table. A displacement that jumps is always an error: its velocity would depend on
    // the time step.
    let lost = |k: usize| {
        let beside = k > 0 && short(pieces[k - 1]) && changes(&pieces[k - 1]);
        short(pieces[k]) && changes(&pieces[k]) && (moves || beside)
    };
    if let Some(k) = (0..pieces.len()).find(|k| lost(*k)) {
        let (from, to) = (pieces[k][0].0, pieces[k][1].0);
        let steps = (to - from) / h;
        return Some(format!(
            "its table changes from {from:e} to {to:e} s, within {steps:.3} of a step; take a smaller time.step, or \
             points that are steps apart"
        ));
    }
    let steps = (points.last()?.0 - points.first()?.0) / h;
    let brief = (1.0..SHORT * (1.0 - 1e-9)).contains(&steps) && pieces.iter().any(changes);
    brief.then(|| {
        format!("its table lasts only {steps:.3} steps; take a smaller time.step, or points further apart")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64) -> TimeFunction {
        TimeFunction::Sine {
            amplitude: 1e-3,
            frequency,
            phase: 0.0,
            offset: 0.0,
            start: 0.0,
        }
    }

    #[test]
    fn sines_are_judged_by_their_steps_a_period() {
        let message = |f: f64| fault(&sine(f), 1e-3, true);
        assert_eq!((message(50.0), message(0.0)), (None, None));
        for (frequency, word) in [
            (60.0, "only 16.7 steps a period"),
            (499.0, "only 2.0 steps a period"),
            (500.0, "ALIASES"),
            (1000.0, "1.000 steps a period and ALIASES"),
        ] {
            let text = message(frequency).unwrap_or_default();
            assert!(
                text.contains(word) && text.contains("time.step = "),
                "{text}"
            );
        }
    }

    #[test]
    fn ramps_and_tables_are_judged_by_their_steps() {
        let ramp = |end| TimeFunction::Ramp {
            from: 0.0,
            to: 1.0,
            start: 1.0,
            end,
        };
        assert_eq!(fault(&ramp(1.005), 1e-3, true), None);
        assert!(fault(&ramp(1.004), 1e-3, true).is_some());
        // These are a jump of a force or a velocity, a jump of a displacement, and a pulse within a
        // step.
        let jump = TimeFunction::Table(vec![(0.0, 0.0), (0.5, 0.0), (0.500_01, 1.0)]);
        assert_eq!(fault(&jump, 1e-3, false), None);
        assert!(fault(&jump, 1e-3, true).is_some());
        let pulse = TimeFunction::Table(vec![(0.5, 0.0), (0.500_01, 1.0), (0.500_02, 0.0)]);
        assert!(fault(&pulse, 1e-3, false).is_some());
    }
}
