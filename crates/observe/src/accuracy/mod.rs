//! Accuracy as an input: the run chooses its step and tolerance by repeating some of its steps with
//! finer ones.
//!
//! The steps of the case, `time.step`, are kept: each is made in 2^k equal parts, or one step spans
//! several where nothing moves. From time to time the next parts are repeated with a quarter of
//! their length and with a hundredth of the tolerance, as for the [error
//! estimate](crate::error_estimate); finer or coarser settings follow from the change of the
//! requested result. Half of the permitted share is for the step, half for the tolerance. All
//! decisions depend on the state only, and costs are counted in iterations: the bits are the same
//! on every machine, and after a resume.

mod forces;
mod growth;
mod report;
mod setting;

pub use report::{AccuracyReport, ChosenSettings, SettingChange, report as report_accuracy};

use crate::error_estimate::{Increments, RatioPair, RepeatedStretch, StretchRepeats, cost};
use fretwork_core::bodies::Dof;
use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::step::{RepeatError, StepError, StepReport};
use fretwork_core::view::{RunControl, RunView};
use fretwork_scene::case::{AccuracySpec, AccurateResult, Case};
use fretwork_scene::processes::FrictionTest;
use growth::{Before, Growth};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use setting::{Decision, Setting};

/// Number of parts of a step that are repeated at a time; the second half of them is compared.
const LENGTH: u32 = 8;
/// Number of steps of the case after which a reduction of the step requested by a law is undone.
const CALM: u32 = 20;
/// Number of steps until the next stretch after one that failed.
const AFTER_FAILURE: u64 = 50;
/// Number of stretches at the start that may cost as much as the run.
const FIRST: u64 = 6;
/// Cost of repeating a step for its forces, in steps.
const FORCES_COST: f64 = 8.0;
/// Largest number of steps between stretches.
const LONGEST_PAUSE: f64 = 1e6;
/// Added to the seed of the case, so that pauses are independent of the random numbers of its
/// grains.
const STREAM: u64 = 0x6163_6375_7261_6379;
/// Factor between two levels of the tolerance.
const TOLERANCE_FACTOR: f64 = 4.0;
/// Extrapolation from a quarter of the step to none, at the first order.
const STEP_LIMIT: f64 = 4.0 / 3.0;

/// Chooses step and tolerance of a run; a checkpoint contains all of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AccuracyControl {
    share: f64,
    of: AccuracyTarget,
    effort: f64,
    seed: u64,
    /// Step (s), tolerance and position correction of the case.
    coarsest: [f64; 3],
    step: Setting,
    tolerance: Setting,
    growth: Growth,
    body: Option<SlidingBody>,
    /// Step of the case before which the next stretch is repeated.
    next: u64,
    /// Number of stretches repeated, and number of those that failed.
    stretches: [u64; 2],
    /// Cost of the run, and of repeated stretches.
    cost: [f64; 2],
    /// Halvings requested by laws, steps of the case since the last request, and number of
    /// requests.
    asked: u32,
    calm: u32,
    requests: u64,
    /// Number of parts made, and largest number in a step of the case.
    parts: u64,
    most_parts: u64,
    smallest_tolerance: f64,
    changes: Vec<SettingChange>,
}

/// The result, as stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum AccuracyTarget {
    Friction,
    FrictionEnergy,
    Damage,
    Wear,
    Forces,
}

impl AccuracyTarget {
    /// Returns the result that a case requests.
    fn asked(of: AccurateResult, case: &Case, run: &dyn RunView) -> Self {
        match of {
            AccurateResult::Friction if FrictionTest::of(case, run).is_some() => Self::Friction,
            AccurateResult::Friction if !driven(case, run) => Self::Forces,
            AccurateResult::Friction | AccurateResult::FrictionEnergy => Self::FrictionEnergy,
            AccurateResult::Damage => Self::Damage,
            AccurateResult::Wear => Self::Wear,
            AccurateResult::Forces => Self::Forces,
        }
    }

    /// Returns numerator and denominator of the result over a stretch.
    fn of(self, grown: &Increments) -> [f64; 2] {
        match self {
            Self::Friction => [grown.work, grown.load_path],
            Self::FrictionEnergy => [grown.friction_energy, 1.0],
            Self::Damage => [grown.damage, 1.0],
            Self::Wear => [grown.wear, 1.0],
            // Forces have no increments, see [`forces`].
            Self::Forces => [0.0; 2],
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Friction => "energetic coefficient",
            Self::FrictionEnergy => "energy of friction",
            Self::Damage => "damage",
            Self::Wear => "wear of first bodies",
            Self::Forces => "forces of contacts",
        }
    }
}

/// Position within a step of a case, in the smallest permitted parts.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepParts {
    done: u64,
}

impl AccuracyControl {
    /// Creates the control of a run; `None` if the case asks for no accuracy.
    pub fn new(case: &Case, run: &dyn RunView) -> Option<Self> {
        let spec = case.accuracy.as_ref()?;
        let test = FrictionTest::of(case, run);
        let start = test.map_or(0.0, |t| t.clock.start / case.time.step);
        let coarsest = [
            run.options().scheme.h,
            run.options().solver.tolerance,
            run.options().correction,
        ];
        let of = AccuracyTarget::asked(spec.of, case, run);
        let [mut step, mut tolerance] = finest_levels(spec, &coarsest);
        if of == AccuracyTarget::Forces {
            // The steps only grow, and forces of rigid packings scatter at any tolerance: the
            // tolerance is reduced only if the case gives a limit.
            step = 0;
            tolerance = if spec.finest_tolerance.is_some() {
                tolerance
            } else {
                0
            };
        }
        Some(Self {
            share: spec.share,
            of,
            effort: spec.effort,
            seed: case.seed ^ STREAM,
            coarsest,
            step: Setting::new(step),
            tolerance: Setting::new(tolerance),
            growth: Growth::new(spec, case, run),
            body: test.map(|t| t.body),
            next: start.round().max(0.0) as u64,
            stretches: [0; 2],
            cost: [0.0; 2],
            asked: 0,
            calm: 0,
            requests: 0,
            parts: 0,
            most_parts: 1,
            smallest_tolerance: coarsest[1],
            changes: Vec::new(),
        })
    }

    /// Prepares a step of the case, given the number of completed steps and the total number:
    /// repeats a stretch if one is due, and chooses the settings. A step that spans several steps
    /// of the case may span `most`.
    ///
    /// # Errors
    /// Steps cannot be repeated, or a process could not be restored.
    pub fn begin_step(
        &mut self,
        run: &mut dyn RunControl,
        [done, total]: [u64; 2],
        most: u64,
    ) -> Result<StepParts, RepeatError> {
        if self.asked > 0 {
            self.calm += 1;
            if self.calm > CALM {
                (self.asked, self.calm) = (self.asked - 1, 0);
            }
        }
        // The stretch must not extend beyond the end, where drives and tables have ended.
        let steps = u64::from(LENGTH.div_ceil(1 << self.level()));
        if self.of == AccuracyTarget::Forces {
            let count = self.count(run, [done, total], most);
            self.set(run, count);
            if self.repeats_for_forces(run) {
                self.measure_forces(run)?;
                let count = self.count(run, [done, total], most);
                self.set(run, count);
            }
            return Ok(StepParts::default());
        }
        if done >= self.next && done + steps <= total {
            self.set(run, 1);
            self.measure(run, done)?;
        }
        let count = self.count(run, [done, total], most);
        self.set(run, count);
        Ok(StepParts::default())
    }

    /// Returns the number of steps of the case that the next step spans.
    fn count(&mut self, run: &dyn RunView, [done, total]: [u64; 2], most: u64) -> u32 {
        match self.level() {
            0 => (self.growth).next(run, self.coarsest[0], most.min(total - done)),
            _ => 1,
        }
    }

    /// Makes one part of a step of the case. Returns `None` where a law requested a smaller step:
    /// the state is then unchanged, and the next part is shorter.
    ///
    /// # Errors
    /// Returns the error of the step, including that of a law that requests less than the smallest
    /// step; or steps cannot be repeated.
    pub fn part(
        &mut self,
        run: &mut dyn RunControl,
        parts: &mut StepParts,
    ) -> Result<Option<StepReport>, PartError> {
        let level = self.level();
        let count = run.options().grown + 1;
        let watched = level == 0 && self.growth.watches(run, count);
        let before = watched.then(|| Before::of(run));
        let mut growth = self.growth.clone();
        let made = run.attempted(|run| {
            let report = run.step()?;
            if growth.holds(run, before.as_ref(), &report, count) {
                Ok(report)
            } else {
                Err(Refused::Moves)
            }
        })?;
        match made {
            Ok(report) => {
                self.growth = growth;
                parts.done += 1 << (self.step.finest - level);
                self.parts += 1;
                self.most_parts = self.most_parts.max(1 << level);
                self.cost[0] += cost(run, &report);
                Ok(Some(report))
            }
            // A failure in a step that has grown may be due to its length.
            Err(_) if count > 1 => {
                self.growth.repeated += 1;
                self.growth.shrink(count);
                self.set(run, self.growth.chosen());
                Ok(None)
            }
            Err(Refused::Step(e)) if e.asks_for_smaller_step() && level < self.step.finest => {
                (self.asked, self.calm) = (level + 1 - self.step.level, 0);
                self.requests += 1;
                self.set(run, 1);
                Ok(None)
            }
            Err(Refused::Step(e)) => Err(e.into()),
            // A step that has not grown is kept.
            Err(Refused::Moves) => Ok(None),
        }
    }

    /// Returns the number of steps of the case that the last step spanned: 1 unless it had grown.
    pub fn spanned(&self) -> u64 {
        u64::from(self.growth.last())
    }

    /// Returns the largest number of steps of the case that a step may span.
    pub fn longest(&self) -> u64 {
        u64::from(self.growth.most())
    }

    /// Whether the step of the case is complete.
    pub fn complete(&self, parts: &StepParts) -> bool {
        parts.done >= 1 << self.step.finest
    }

    /// The level of the step now in force.
    fn level(&self) -> u32 {
        (self.step.level + self.asked).min(self.step.finest)
    }

    /// The tolerance now in force.
    fn chosen_tolerance(&self) -> f64 {
        self.coarsest[1] / TOLERANCE_FACTOR.powi(self.tolerance.level as i32)
    }

    /// Continues in a simulation that was restored with its state: impulses are those of the
    /// current step length.
    pub fn resume(&mut self, run: &mut dyn RunControl) {
        let last = self.growth.last();
        let parts = f64::from(1u32 << self.level());
        run.options_mut().scheme.h = self.coarsest[0] / parts * f64::from(last);
        run.options_mut().grown = last - 1;
        self.set(run, last);
    }

    /// Sets tolerance, correction and the step, which spans `count` steps of the case or is a part
    /// of one.
    fn set(&mut self, run: &mut dyn RunControl, count: u32) {
        let [h, _, correction] = self.coarsest;
        let parts = f64::from(1u32 << self.level());
        run.span_steps(h / parts, count);
        let parts = parts / f64::from(count);
        // The share of an overlap that is corrected in a given time does not depend on the step.
        run.options_mut().correction = if parts == 1.0 {
            correction
        } else {
            1.0 - (1.0 - correction).powf(1.0 / parts)
        };
        let tolerance = self.chosen_tolerance();
        run.options_mut().solver.tolerance = tolerance;
        self.smallest_tolerance = self.smallest_tolerance.min(tolerance);
    }

    /// Repeats a stretch, and chooses the settings.
    fn measure(&mut self, run: &mut dyn RunControl, done: u64) -> Result<(), RepeatError> {
        let stretch = RepeatedStretch {
            length: LENGTH,
            body: self.body,
            couples: false,
        };
        let (place, [cost, each]) = stretch.at(run)?;
        self.cost[1] += cost;
        // At the start, before any result is known, steps are measured more often.
        let first = self.stretches[0] < FIRST;
        let effort = if first {
            self.effort.max(1.0)
        } else {
            self.effort
        };
        let step = each * f64::from(1u32 << self.level());
        let pause = (cost / (effort * step)).clamp(1.0, LONGEST_PAUSE);
        let pause = if pause.is_nan() { 1.0 } else { pause };
        // The interval is random, so that it is not synchronous with cycles.
        let number = self.stretches[0] + self.stretches[1];
        let mut random = Pcg64::seed_from_u64(self.seed.wrapping_add(number));
        let pause = pause * (0.5 + random.random::<f64>());
        self.next = done + (pause.ceil() as u64).max(1);
        let Some(place) = place else {
            self.stretches[1] += 1;
            self.next = done + AFTER_FAILURE;
            return Ok(());
        };
        self.stretches[0] += 1;
        self.decide(&place, run);
        Ok(())
    }

    /// Returns whether a step is repeated for its forces: as often as the permitted cost allows,
    /// since all steps are equally informative, except the first ones, which are solved from zero
    /// impulses.
    fn repeats_for_forces(&self, run: &dyn RunView) -> bool {
        let [of_run, repeats] = self.cost;
        let each = of_run / self.parts.max(1) as f64;
        run.steps() > 3 && repeats + FORCES_COST * each <= self.effort * of_run
    }

    /// Repeats a step for its forces, and chooses the settings.
    fn measure_forces(&mut self, run: &mut dyn RunControl) -> Result<(), RepeatError> {
        let (changes, [cost, _]) = forces::repeat_step(run)?;
        self.cost[1] += cost;
        let Some(changes) = changes else {
            self.stretches[1] += 1;
            return Ok(());
        };
        self.stretches[0] += 1;
        let allowed = 0.5 * self.share;
        let pair = |change: f64| RatioPair {
            coarse: [1.0; 2],
            fine: [1.0 + change, 1.0],
        };
        self.step
            .decide(pair(changes.finer), STEP_LIMIT, 2.0, allowed);
        if STEP_LIMIT * changes.finer > allowed {
            self.growth.shorten();
        }
        if run.phase_tolerance().is_some() || !changes.tight {
            return Ok(());
        }
        let decision =
            (self.tolerance).decide(pair(changes.tighter), 1.0, TOLERANCE_FACTOR, allowed);
        let effects = [self.step.effect, self.tolerance.effect];
        if self.tolerance.adopt(decision, TOLERANCE_FACTOR) {
            self.changes.push(SettingChange {
                time: run.time(),
                step: run.options().scheme.h,
                tolerance: self.chosen_tolerance(),
                step_effect: effects[0],
                tolerance_effect: effects[1],
            });
        }
        Ok(())
    }

    fn decide(&mut self, place: &StretchRepeats, run: &dyn RunView) {
        let allowed = 0.5 * self.share;
        let pair = |fine: &Increments| RatioPair {
            coarse: self.of.of(&place.base),
            fine: self.of.of(fine),
        };
        let (finer, tighter) = (pair(&place.finer), pair(&place.tighter));
        let step = self.step.decide(finer, STEP_LIMIT, 2.0, allowed);
        // A phase may have its own tolerance; a stretch that did not reach the tighter tolerance is
        // not conclusive.
        let tolerance = if run.phase_tolerance().is_none() && place.tight {
            self.tolerance
                .decide(tighter, 1.0, TOLERANCE_FACTOR, allowed)
        } else {
            Decision::Keep
        };
        let effects = [self.step.effect, self.tolerance.effect];
        let changed = [
            self.step.adopt(step, 2.0),
            self.tolerance.adopt(tolerance, TOLERANCE_FACTOR),
        ];
        if changed.contains(&true) {
            self.changes.push(SettingChange {
                time: run.time(),
                step: self.coarsest[0] / f64::from(1u32 << self.step.level),
                tolerance: self.chosen_tolerance(),
                step_effect: effects[0],
                tolerance_effect: effects[1],
            });
        }
    }
}

/// Reason why a step is not kept.
enum Refused {
    Step(StepError),
    /// The step had grown, and something moved in it.
    Moves,
}

impl From<StepError> for Refused {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

/// Reason why a part of a step failed.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// The step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Steps cannot be repeated.
    #[error(transparent)]
    Repeat(#[from] RepeatError),
}

/// Returns whether anything in a case moves or applies loads, apart from constant gravity.
fn driven(case: &Case, run: &dyn RunView) -> bool {
    let dofs = run.bodies().driven.iter().flat_map(|d| &d.dofs);
    case.gravity_drive.is_some()
        || !case.phases.is_empty()
        || run.system_count() > 0
        || dofs.flat_map(Dof::drives).any(|d| d.function().is_some())
}

/// Returns the finest levels of step and tolerance.
fn finest_levels(spec: &AccuracySpec, [h, tolerance, _]: &[f64; 3]) -> [u32; 2] {
    // A limit that equals a level up to rounding is reached.
    let levels = |ratio: f64, factor: f64| (ratio.ln() / factor.ln() + 1e-9).max(0.0) as u32;
    let step = spec.finest_step.map_or(6, |least| levels(h / least, 2.0));
    let tolerance = match spec.finest_tolerance {
        Some(least) => levels(tolerance / least, TOLERANCE_FACTOR),
        None => 4,
    };
    [step.min(20), tolerance.min(20)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_levels() {
        let spec = |step, tolerance| AccuracySpec {
            share: 0.03,
            of: AccurateResult::Friction,
            finest_step: step,
            largest_step: None,
            finest_tolerance: tolerance,
            effort: 0.2,
        };
        let coarsest = [8e-5, 0.5, 0.0];
        assert_eq!(finest_levels(&spec(None, None), &coarsest), [6, 4]);
        assert_eq!(
            finest_levels(&spec(Some(1e-5), Some(0.03)), &coarsest),
            [3, 2]
        );
        assert_eq!(
            finest_levels(&spec(Some(8e-5), Some(1.0)), &coarsest),
            [0, 0]
        );
    }
}
