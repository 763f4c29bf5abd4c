//! Effect of finer settings on the forces of contacts: the next step is made again in quarters, and
//! with a hundredth of the tolerance.

use crate::error_estimate::{FINER, cost, shorten, tighten};
use fretwork_core::step::{ContactForces, RepeatError};
use fretwork_core::view::RunControl;

/// Largest number of iterations with the tight tolerance: a factor on the number in the run, and a
/// minimum.
const MAX_ITERATIONS: (f64, f64) = (4.0, 100.0);

/// Relative change of the forces by finer settings.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForceChanges {
    /// Change with a quarter of the step.
    pub finer: f64,
    /// Change with a hundredth of the tolerance.
    pub tighter: f64,
    /// Whether the tight tolerance was reached.
    pub tight: bool,
}

/// Result of one way to make the next step.
struct Made {
    forces: ContactForces,
    cost: f64,
    iterations: u32,
    converged: bool,
}

/// Makes the next step in a number of parts; `None` where it fails.
fn made(run: &mut dyn RunControl, parts: u32) -> Option<Made> {
    let (mut spent, mut iterations, mut converged) = (0.0, 0, true);
    for _ in 0..parts {
        let report = run.step().ok()?;
        spent += cost(run, &report);
        iterations = iterations.max(report.solver.iterations);
        converged &= report.solver.converged;
    }
    Some(Made {
        forces: run.contact_forces(),
        cost: spent,
        iterations,
        converged,
    })
}

/// Repeats the next step with its length; `None` where a step failed. Also returns the cost of all
/// repetitions, and that of the step with the present settings.
///
/// # Errors
/// A process could not be put back: the run cannot go on.
pub(super) fn repeat_step(
    run: &mut dyn RunControl,
) -> Result<(Option<ForceChanges>, [f64; 2]), RepeatError> {
    let Some(base) = run.repeated(|run| made(run, 1))? else {
        return Ok((None, [0.0; 2]));
    };
    let finer = run.repeated(|run| {
        let grown = run.options().grown + 1;
        shorten(run);
        run.options_mut().grown = (grown / FINER).max(1) - 1;
        made(run, FINER)
    })?;
    let most = MAX_ITERATIONS
        .1
        .max(MAX_ITERATIONS.0 * f64::from(base.iterations));
    let tighter = run.repeated(|run| {
        tighten(run, most);
        made(run, 1)
    })?;
    let (Some(finer), Some(tighter)) = (finer, tighter) else {
        return Ok((None, [base.cost; 2]));
    };
    let changes = ForceChanges {
        finer: base.forces.change(&finer.forces),
        tighter: base.forces.change(&tighter.forces),
        tight: tighter.converged,
    };
    Ok((
        Some(changes),
        [base.cost + finer.cost + tighter.cost, base.cost],
    ))
}
