//! Estimate of the error of a run: at times drawn from the seed the run repeats a few steps with a
//! quarter of the step, with a hundredth of the tolerance, and, where damage is coupled explicitly,
//! with implicit coupling, and compares the growth of friction, damage and wear. In a reciprocating
//! friction test it waits for the contact to slide, as long as half the time between two places.
//!
//! The state is restored after each repetition, so that the run has the same bits as without.
//! Observers do not see repeated steps.

mod change;
mod increments;
mod places;
mod report;
mod stretches;
mod warnings;

pub use change::Change;
pub use report::{Effects, Repeats, Shares};

pub(crate) use change::RatioPair;
use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::step::{RepeatError, StepReport};
use fretwork_core::view::{RunControl, RunView};
use fretwork_scene::case::Case;
use fretwork_scene::processes::FrictionTest;
pub(crate) use increments::Increments;
pub(crate) use increments::cost;
use serde::{Deserialize, Serialize};
pub(crate) use stretches::{RepeatedStretch, shorten, tighten};

/// Number of parts of a step in the repetition with shorter steps.
pub(crate) const FINER: u32 = 4;
/// Share of the cost of the run above which no further repetitions are made.
const MAX_COST: f64 = 0.05;

/// A stretch of the run with its repetitions.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct StretchRepeats {
    /// Number of steps done before it.
    step: u64,
    /// Time before and after the steps of the run that are compared (s).
    span: [f64; 2],
    /// Growth with the step and tolerance of the run.
    pub(crate) base: Increments,
    /// Growth with a quarter of the step.
    pub(crate) finer: Increments,
    /// Growth with a hundredth of the tolerance.
    pub(crate) tighter: Increments,
    /// Whether that tolerance was reached.
    pub(crate) tight: bool,
    /// Growth with implicit coupling, where the run has explicit coupling of damage.
    coupled: Option<Increments>,
}

/// Estimates the error of a run; a checkpoint contains all of it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// Number of steps of a stretch.
    length: u32,
    /// Numbers of steps after which the remaining stretches are repeated.
    to_come: std::collections::VecDeque<u64>,
    /// Number of steps of the run, as known at its start.
    total: u64,
    /// Number of steps for which a place waits for the contact to slide.
    patience: u64,
    body: Option<SlidingBody>,
    /// Whether repetitions are skipped once they cost too much: where the case does not give their
    /// number.
    limited: bool,
    /// Reason why there is no estimate.
    reason: Option<String>,
    places: Vec<StretchRepeats>,
    /// Number of places at which a repeated step failed.
    failed: u32,
    /// Number of places skipped since repetitions cost too much.
    left_out: u32,
    /// Cost of the steps of the run, and of the repetitions.
    cost: [f64; 2],
    /// External work and potential energy at the end of the last step (J).
    last: [f64; 2],
    /// Sum of the changes of these energies in all steps, and in those that missed the tolerance
    /// (J).
    supplied: [f64; 2],
}

impl ErrorEstimate {
    /// Draws the places of a run with this number of steps.
    pub fn new(case: &Case, run: &dyn RunView, total: u64) -> Self {
        let test = FrictionTest::of(case, run);
        let mut estimate = Self {
            total,
            body: test.map(|t| t.body),
            limited: case.uncertainty.repeats.is_none(),
            ..Self::default()
        };
        let from = test.map_or(0.0, |t| t.clock.start / case.time.step);
        let from = (from.round().max(0.0) as u64).min(total);
        let plan = places::plan(&case.uncertainty, total);
        let permitted = run.repeatable().map_err(|e| e.to_string());
        match plan.and_then(|plan| permitted.map(|()| plan)) {
            Ok(plan) => {
                estimate.length = plan.length;
                estimate.patience = (total - from) / (2 * plan.count.max(1) as u64);
                estimate.to_come = plan.draw(case.seed, from, total).into();
            }
            Err(reason) => estimate.reason = Some(reason),
        }
        estimate
    }

    /// Repeats the next steps, where one of the places is reached: `step` steps of the case are
    /// done. `slides` says whether the contact of a reciprocating friction test slides.
    ///
    /// # Errors
    /// A process could not be put back: the run cannot go on.
    pub fn before_step(
        &mut self,
        run: &mut dyn RunControl,
        step: u64,
        slides: Option<bool>,
    ) -> Result<(), RepeatError> {
        let last = self.total.saturating_sub(u64::from(self.length));
        let waits = |at: &u64| step < (at + self.patience).min(last);
        if slides == Some(false) && self.to_come.front().is_none_or(waits) {
            return Ok(());
        }
        let mut due = false;
        while self.to_come.front().is_some_and(|at| *at <= step) {
            // A step that spans several steps of the case may pass several places.
            due |= self.to_come.pop_front().is_some();
        }
        if !due || self.reason.is_some() {
            return Ok(());
        }
        if let Err(other) = run.repeatable() {
            // A process was added since the start.
            self.reason = Some(other.to_string());
            return Ok(());
        }
        if self.costs_too_much(step) {
            self.left_out += 1;
            return Ok(());
        }
        let repeats = RepeatedStretch {
            length: self.length,
            body: self.body,
            couples: true,
        };
        let (place, [cost, _]) = repeats.at(run)?;
        self.cost[1] += cost;
        match place {
            Some(place) => self.places.push(StretchRepeats { step, ..place }),
            None => self.failed += 1,
        }
        Ok(())
    }

    /// Returns whether one more place, at the mean cost of those so far, would exceed the permitted
    /// share of the run.
    fn costs_too_much(&self, step: u64) -> bool {
        let done = self.places.len() + self.failed as usize;
        if !self.limited || done < change::FEWEST || step == 0 {
            return false;
        }
        let each = self.cost[1] / done as f64;
        let run = self.cost[0] / step as f64 * self.total as f64;
        self.cost[1] + each > MAX_COST * run
    }

    /// Adds a step of the run.
    pub fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        self.cost[0] += cost(run, report);
        let e = run.energies();
        let now = [e.external_work, e.potential];
        let supplied = (now[0] - self.last[0]).abs() + (now[1] - self.last[1]).abs();
        self.last = now;
        self.supplied[0] += supplied;
        if !report.solver.converged {
            self.supplied[1] += supplied;
        }
    }
}
