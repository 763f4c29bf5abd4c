//! What finer settings change in the forces of contacts: the next step is made again in quarters,
//! and with a hundredth of the tolerance.

use crate::error_estimate::{FINER, cost, shorten, tighten};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::{ContactForces, RepeatError, Simulation};

/// Most iterations with the tight tolerance: this many times those of the run, and this many in any
/// case.
const MOST_ITERATIONS: (f64, f64) = (4.0, 100.0);

/// Change of the forces by finer settings, as a share of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForceChanges {
    /// With a quarter of the step.
    pub finer: f64,
    /// With a hundredth of the tolerance.
    pub tighter: f64,
    /// Whether that was reached.
    pub tight: bool,
}

/// One way of making the next step.
struct Made<S: Space> {
    forces: ContactForces<S>,
    cost: f64,
    iterations: u32,
    converged: bool,
}

/// Makes the next step in so many parts; `None` where it fails.
fn made<S: Space>(s: &mut Simulation<S>, parts: u32) -> Option<Made<S>> {
    let (mut spent, mut iterations, mut converged) = (0.0, 0, true);
    for _ in 0..parts {
        let report = s.step().ok()?;
        spent += cost(s, &report);
        iterations = iterations.max(report.solver.iterations);
        converged &= report.solver.converged;
    }
    Some(Made {
        forces: s.contact_forces(),
        cost: spent,
        iterations,
        converged,
    })
}

/// Repeats the next step, as long as it is; `None` where a step failed. Gives the cost of all of it
/// too, and that of the step as it is.
///
/// # Errors
/// A process could not be put back: the run cannot go on.
pub(super) fn repeat_step<S: Space>(
    s: &mut Simulation<S>,
) -> Result<(Option<ForceChanges>, [f64; 2]), RepeatError> {
    let Some(base) = s.repeat(|s| made(s, 1))? else {
        return Ok((None, [0.0; 2]));
    };
    let finer = s.repeat(|s| {
        let grown = s.options.grown + 1;
        shorten(s);
        s.options.grown = (grown / FINER).max(1) - 1;
        made(s, FINER)
    })?;
    let most = MOST_ITERATIONS
        .1
        .max(MOST_ITERATIONS.0 * f64::from(base.iterations));
    let tighter = s.repeat(|s| {
        tighten(s, most);
        made(s, 1)
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
