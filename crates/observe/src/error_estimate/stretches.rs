//! A stretch of steps, repeated with other settings.

use super::increments::Stretch;
use super::{FINER, StretchRepeats};
use fretwork_core::laws::Interface;
use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::step::{Coupling, RepeatError};
use fretwork_core::view::RunControl;

/// Ratio of the tolerance to the tight tolerance.
const TIGHTER: f64 = 100.0;
/// Tolerance below which rounding limits the error, not the solver.
const ROUNDING: f64 = 1e-12;
/// Largest number of iterations with the tight tolerance: a factor on the number in the run, and a
/// minimum.
const MAX_ITERATIONS: (f64, f64) = (4.0, 100.0);

/// Sets the options of a repeated stretch.
type SetOptions<'a> = dyn Fn(&mut dyn RunControl) + 'a;

/// Repeated stretch: number of steps, and the rubbed body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RepeatedStretch {
    pub length: u32,
    pub body: Option<SlidingBody>,
    /// Whether explicit coupling of damage is compared with implicit coupling.
    pub couples: bool,
}

impl RepeatedStretch {
    /// Repeats the next steps in all ways; `None` where a step failed. Steps with the present
    /// settings are repeated too, so that all are measured in the same way. Also returns the cost
    /// of all repetitions, and that of a step with the present settings.
    ///
    /// # Errors
    /// A process could not be put back: the run cannot go on.
    pub fn at(
        &self,
        run: &mut dyn RunControl,
    ) -> Result<(Option<StretchRepeats>, [f64; 2]), RepeatError> {
        let (length, mut cost) = (self.length, 0.0);
        let mut stretch = |run: &mut dyn RunControl, parts, options: &SetOptions<'_>| {
            let made = run.repeated(|run| {
                // Longer steps would end after the known events.
                run.span_steps(run.options().event_step(), 1);
                options(run);
                Stretch::of(run, [length, parts], self.body.as_ref()).ok()
            })?;
            cost += made.as_ref().map_or(0.0, |m| m.cost);
            Ok::<_, RepeatError>(made)
        };
        let Some(base) = stretch(run, 1, &|_| ())? else {
            return Ok((None, [cost, cost]));
        };
        let [from, to] = [length / 2, length]
            .map(|steps| run.time() + f64::from(steps) * run.options().scheme.h);
        let each = base.cost / f64::from(length);
        let finer = stretch(run, FINER, &shorten)?;
        let most = MAX_ITERATIONS
            .1
            .max(MAX_ITERATIONS.0 * f64::from(base.iterations));
        let tighter = stretch(run, 1, &|run| tighten(run, most))?;
        let damages = run.laws().iter().any(Interface::damages);
        let mut coupled = None;
        if self.couples && damages && run.options().coupling == Coupling::Explicit {
            coupled = stretch(run, 1, &|run| {
                run.options_mut().coupling = Coupling::Implicit {
                    tolerance: 1e-3,
                    max_iterations: 5,
                };
            })?;
        }
        let (Some(finer), Some(tighter)) = (finer, tighter) else {
            return Ok((None, [cost, each]));
        };
        let place = StretchRepeats {
            step: run.steps(),
            span: [from, to],
            base: base.increments,
            finer: finer.increments,
            tighter: tighter.increments,
            tight: tighter.converged,
            coupled: coupled.map(|c| c.increments),
        };
        Ok((Some(place), [cost, each]))
    }
}

/// Sets a shorter step, with the same correction of an overlap in a given time.
pub(crate) fn shorten(run: &mut dyn RunControl) {
    let parts = f64::from(FINER);
    run.change_step(run.options().scheme.h / parts);
    let left = 1.0 - run.options().correction;
    run.options_mut().correction = 1.0 - left.powf(1.0 / parts);
}

/// Sets a tight tolerance, also where a phase has set its own.
pub(crate) fn tighten(run: &mut dyn RunControl, most_iterations: f64) {
    let tight = |tolerance: f64| (tolerance / TIGHTER).max(ROUNDING.min(tolerance));
    let solver = &mut run.options_mut().solver;
    solver.tolerance = tight(solver.tolerance);
    solver.max_iterations = (f64::from(solver.max_iterations)).min(most_iterations) as u32;
    let of_phase = run.phase_tolerance().map(tight);
    run.set_phase_tolerance(of_phase);
}
