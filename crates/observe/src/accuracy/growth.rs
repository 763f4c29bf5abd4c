//! Steps that grow beyond that of the case where nothing moves, and shrink again before something
//! does.
//!
//! A step of the run spans a number of steps of the case. It follows from what a step changes: the
//! largest displacement of a body over the half size of the smallest grain, which is to stay at the
//! accuracy asked for, and the change of forces and damage, above which steps do not grow. A step
//! in which something moves too far, a bond forms or breaks, or the solver does not converge is
//! made again with a quarter of the number. Events end steps, see [`StepBounds`].
//!
//! [`StepBounds`]: fretwork_core::step::control::StepBounds

use fretwork_core::step::{ContactForces, StepReport};
use fretwork_core::view::RunView;
use fretwork_scene::case::{AccuracySpec, Case};
use serde::{Deserialize, Serialize};

/// A step that has grown is made again as a shorter one above this many times of the displacement
/// that is aimed at.
const KEPT: f64 = 2.5;
/// Change of forces above which steps do not grow, of what is allowed.
const CHANGE: f64 = 0.4;
/// Least and most by which a step is longer than the one before it. It shrinks slowly where it may:
/// rigid contacts with gaps of up to g h^2 carry over a step h, and a much shorter step finds them
/// open.
const RATIO: [f64; 2] = [0.8, 2.0];
/// A step that is not kept is made again with its number over this.
const SHRINKS: u32 = 4;
/// Displacements are not told apart more closely than this.
const LITTLE: f64 = 0.1;
/// Largest displacement of a step, over the half size of the smallest grain, and change of forces,
/// whatever accuracy is asked for.
const MOST_CHANGE: f64 = 0.2;
/// How many steps of the case a step spans.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Growth {
    /// Most; 1 where steps do not grow.
    most: u32,
    /// Displacement over a step that is aimed at, over the half size of the smallest grain, and
    /// change of forces that is allowed, over these.
    allowed: f64,
    /// Steps of the case that were chosen; events and records may end a step earlier.
    chosen: u32,
    /// Steps of the case that the last step spanned.
    last: u32,
    /// Whether an event ends the next step.
    event: bool,
    /// The most that a step has spanned.
    pub longest: u32,
    /// Steps of the case that were spanned by steps that had grown.
    pub spanned: u64,
    /// Steps repeated with fewer.
    pub repeated: u64,
}

/// What a step is compared with.
#[derive(Debug)]
pub(super) struct Before {
    pub forces: ContactForces,
    damage: f64,
}

impl Before {
    pub fn of(run: &dyn RunView) -> Self {
        Self {
            forces: run.contact_forces(),
            damage: damage(run),
        }
    }
}

/// Sum of the damage of all bonds.
fn damage(run: &dyn RunView) -> f64 {
    let made = run.bonds_made();
    if made == 0 {
        return 0.0;
    }
    run.mean_damage() * made as f64
}

impl Growth {
    pub fn new(spec: &AccuracySpec, case: &Case, run: &dyn RunView) -> Self {
        let most = spec.largest(case.time.step) / case.time.step;
        // A largest step that is a multiple up to rounding is reached. The waves of deformable
        // bodies are not seen by what is looked at here.
        let most = (most * (1.0 + 1e-9)).clamp(1.0, 1e9) as u32;
        Self {
            most: if run.system_count() == 0 { most } else { 1 },
            allowed: spec.share.min(MOST_CHANGE),
            chosen: 1,
            last: 1,
            event: false,
            longest: 1,
            spanned: 0,
            repeated: 0,
        }
    }

    /// Steps of the case that the last step spanned.
    pub fn last(&self) -> u32 {
        self.last
    }

    /// Steps of the case that steps span where nothing ends them.
    pub fn chosen(&self) -> u32 {
        self.chosen
    }

    /// How many steps of the case, of `h` (s), the next step spans, if it may not span more than
    /// `most`.
    pub fn next(&mut self, run: &dyn RunView, h: f64, most: u64) -> u32 {
        self.event = false;
        if self.most == 1 {
            return 1;
        }
        if run.phase_begins() {
            self.chosen = 1;
        }
        let [event, resolved] = run.step_bounds().steps(run.time(), h);
        let wanted = u64::from(self.chosen).min(resolved).max(1);
        // Equal steps up to the next event or record, so that none is much shorter than the one
        // before it.
        let rest = event.min(most).max(1);
        let count = rest.div_ceil(rest.div_ceil(wanted));
        self.event = count == event;
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    /// Whether the next step, of `count` steps of the case, is worth comparing: it has grown, or
    /// may grow after it.
    pub fn watches(&self, run: &dyn RunView, count: u32) -> bool {
        count > 1 || (self.most > 1 && run.largest_displacement() <= self.allowed)
    }

    /// Takes in a step of `count` steps of the case; false where it is to be repeated with fewer.
    pub fn holds(
        &mut self,
        run: &dyn RunView,
        before: Option<&Before>,
        report: &StepReport,
        count: u32,
    ) -> bool {
        let whole = report.solver.converged
            && report.projected.is_none()
            && run.bond_breaks().is_empty()
            && run.bonds_formed().is_empty();
        // Displacement, and change of forces and damage, over what steps aim at.
        let [moved, changed] = before
            .filter(|_| whole)
            .map_or([f64::INFINITY; 2], |before| {
                let forces = before.forces.change(&run.contact_forces());
                let damage = (damage(run) - before.damage).abs() / before.damage.max(1.0);
                let changed = forces.max(damage) / (CHANGE * self.allowed);
                [run.largest_displacement() / self.allowed, changed]
            });
        if count > 1 && moved > KEPT {
            return false;
        }
        self.keep(count, moved, changed);
        true
    }

    /// A step of `count` steps of the case is made, in which displacement and forces changed by
    /// these, over what is aimed at.
    fn keep(&mut self, count: u32, moved: f64, changed: f64) {
        self.last = count;
        self.longest = self.longest.max(count);
        if count > 1 {
            self.spanned += u64::from(count);
        }
        if self.event {
            // Something may begin here.
            self.chosen = 1;
            return;
        }
        let ratio = (1.0 / moved).clamp(RATIO[0], RATIO[1]);
        if ratio < 1.0 - LITTLE {
            self.chosen = ((f64::from(count) * ratio) as u32).max(1);
        } else if ratio > 1.0 + LITTLE && changed <= 1.0 {
            // A step that a record has ended before says nothing against longer ones.
            let next = (f64::from(count) * ratio) as u32;
            self.chosen = next.max(self.chosen).min(self.most);
        }
    }

    /// Finer steps were found to change the result by more than is allowed: the next ones are
    /// somewhat shorter.
    pub fn shorten(&mut self) {
        self.chosen = ((f64::from(self.chosen) * RATIO[0]) as u32).max(1);
    }

    /// A step of `count` steps of the case did not hold: the next ones span fewer.
    pub fn shrink(&mut self, count: u32) {
        self.chosen = (count / SHRINKS).max(1);
        self.event = false;
    }
}
