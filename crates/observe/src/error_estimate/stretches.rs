//! A stretch of steps, repeated with other settings.

use super::increments::Stretch;
use super::{FINER, Place};
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::Interface;
use fretwork_core::process::cycle::SlidingBody;
use fretwork_core::step::Coupling;
use fretwork_core::step::{RepeatError, Simulation};

/// The tight tolerance is the tolerance over this number.
const TIGHTER: f64 = 100.0;
/// Below this tolerance rounding decides, not the solver.
const ROUNDING: f64 = 1e-12;
/// Most iterations with the tight tolerance: this many times those of the run, and this many in any
/// case.
const MOST_ITERATIONS: (f64, f64) = (4.0, 100.0);

/// What is repeated: so many steps, and the body under test.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RepeatedStretch {
    pub length: u32,
    pub body: Option<SlidingBody>,
    /// Whether explicit coupling of damage is compared with implicit coupling.
    pub couples: bool,
}

impl RepeatedStretch {
    /// Repeats the next steps in all ways; `None` where a step failed. Steps of the stretch itself
    /// are repeated too, so that all are measured in the same way. Gives the cost of all of it too,
    /// and that of a step as it is.
    ///
    /// # Errors
    /// A process could not be put back: the run cannot go on.
    pub fn at<S: Space>(
        &self,
        s: &mut Simulation<S>,
    ) -> Result<(Option<Place>, [f64; 2]), RepeatError> {
        let (length, mut cost) = (self.length, 0.0);
        let mut stretch = |s: &mut Simulation<S>, parts, options: &dyn Fn(&mut Simulation<S>)| {
            let made = s.repeat(|s| {
                // Steps that have grown would end beyond what lies ahead.
                s.span_steps(s.options.event_step(), 1);
                options(s);
                Stretch::of(s, [length, parts], self.body.as_ref()).ok()
            })?;
            cost += made.as_ref().map_or(0.0, |m| m.cost);
            Ok::<_, RepeatError>(made)
        };
        let Some(base) = stretch(s, 1, &|_| ())? else {
            return Ok((None, [cost, cost]));
        };
        let each = base.cost / f64::from(length);
        let finer = stretch(s, FINER, &shorten)?;
        let most = MOST_ITERATIONS
            .1
            .max(MOST_ITERATIONS.0 * f64::from(base.iterations));
        let tighter = stretch(s, 1, &|s| tighten(s, most))?;
        let damages = s.laws.iter().any(Interface::damages);
        let mut coupled = None;
        if self.couples && damages && s.options.coupling == Coupling::Explicit {
            coupled = stretch(s, 1, &|s| {
                s.options.coupling = Coupling::Implicit {
                    tolerance: 1e-3,
                    max_iterations: 5,
                };
            })?;
        }
        let (Some(finer), Some(tighter)) = (finer, tighter) else {
            return Ok((None, [cost, each]));
        };
        let place = Place {
            step: s.state.steps,
            base: base.increments,
            finer: finer.increments,
            tighter: tighter.increments,
            tight: tighter.converged,
            coupled: coupled.map(|c| c.increments),
        };
        Ok((Some(place), [cost, each]))
    }
}

/// Sets a shorter step, in which as much of an overlap is taken out in a given time.
pub(crate) fn shorten<S: Space>(s: &mut Simulation<S>) {
    let parts = f64::from(FINER);
    s.change_step(s.options.scheme.h / parts);
    let left = 1.0 - s.options.correction;
    s.options.correction = 1.0 - left.powf(1.0 / parts);
}

/// Sets a tight tolerance, also where a phase has set its own.
pub(crate) fn tighten<S: Space>(s: &mut Simulation<S>, most_iterations: f64) {
    let tight = |tolerance: f64| (tolerance / TIGHTER).max(ROUNDING.min(tolerance));
    let solver = &mut s.options.solver;
    solver.tolerance = tight(solver.tolerance);
    solver.max_iterations = (f64::from(solver.max_iterations)).min(most_iterations) as u32;
    s.state.control.tolerance = s.state.control.tolerance.map(tight);
}
