//! Steps that grow beyond that of the case where nothing moves, and shrink again before something
//! does.
//!
//! A step of the run spans a number of steps of the case. The number follows from the changes in a
//! step: the largest displacement of a body over the half size of the smallest grain, which is kept
//! at the requested accuracy, and the change of forces and damage, above which steps do not grow. A
//! step in which something moves too far, a bond forms or breaks, or the solver does not converge
//! is made again with a quarter of the number. Events end steps, see [`StepBounds`].
//!
//! [`StepBounds`]: fretwork_core::step::control::StepBounds

use fretwork_core::step::{ContactForces, StepReport};
use fretwork_core::view::RunView;
use fretwork_scene::case::{AccuracySpec, Case};
use serde::{Deserialize, Serialize};

/// Factor on the target displacement above which a step that has grown is made again with a smaller
/// number.
const KEPT: f64 = 2.5;
/// Fraction of the permitted change of forces above which steps do not grow.
const CHANGE: f64 = 0.4;
/// Smallest and largest ratio of the length of a step to that of the one before. Where possible it
/// shrinks slowly: rigid contacts with gaps of up to g h^2 transmit forces over a step h, and in a
/// much shorter step they are open.
const RATIO: [f64; 2] = [0.8, 2.0];
/// Divisor of the number when a step is made again.
const SHRINKS: u32 = 4;
/// Resolution of displacements.
const LITTLE: f64 = 0.1;
/// Upper limits, for any requested accuracy: displacement of a step over the half size of the
/// smallest grain, and change of forces.
const MAX_CHANGE: f64 = 0.2;
/// Number of steps of the case that a step spans.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Growth {
    /// Largest number; 1 where steps do not grow.
    most: u32,
    /// Target displacement of a step and permitted change of forces, relative to their upper
    /// limits.
    allowed: f64,
    /// Chosen number of steps of the case; events and records may end a step earlier.
    chosen: u32,
    /// Number of steps of the case that the last step spanned.
    last: u32,
    /// Whether an event ends the next step.
    event: bool,
    /// Largest number that a step has spanned.
    pub longest: u32,
    /// Number of steps of the case that were part of longer steps.
    pub spanned: u64,
    /// Number of steps repeated with a smaller number.
    pub repeated: u64,
}

/// State before a step, with which the state after it is compared.
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

/// Returns the sum of the damage of all bonds.
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
        // A limit that is a whole multiple up to rounding is reached. The waves of deformable
        // bodies are not detected here.
        let most = (most * (1.0 + 1e-9)).clamp(1.0, 1e9) as u32;
        Self {
            most: if run.system_count() == 0 { most } else { 1 },
            allowed: spec.share.min(MAX_CHANGE),
            chosen: 1,
            last: 1,
            event: false,
            longest: 1,
            spanned: 0,
            repeated: 0,
        }
    }

    /// Returns the largest number of steps of the case that a step may span.
    pub fn most(&self) -> u32 {
        self.most
    }

    /// Returns the number of steps of the case that the last step spanned.
    pub fn last(&self) -> u32 {
        self.last
    }

    /// Returns the number of steps of the case that steps span unless an event ends them.
    pub fn chosen(&self) -> u32 {
        self.chosen
    }

    /// Returns the number of steps of the case, of `h` (s), that the next step spans, at most
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
        // Steps up to the next event or record have equal lengths, so that none is much shorter
        // than the one before.
        let rest = event.min(most).max(1);
        let count = rest.div_ceil(rest.div_ceil(wanted));
        self.event = count == event;
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    /// Returns whether to compare the state after the next step, of `count` steps of the case: it
    /// has grown, or steps may grow after it.
    pub fn watches(&self, run: &dyn RunView, count: u32) -> bool {
        count > 1 || (self.most > 1 && run.largest_displacement() <= self.allowed)
    }

    /// Evaluates a step of `count` steps of the case; returns false where it must be repeated with
    /// a smaller number.
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
        // Displacement, and change of forces and damage, relative to their targets.
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

    /// Chooses the next number after a step of `count` steps of the case, from the displacement and
    /// the change of forces relative to their targets.
    fn keep(&mut self, count: u32, moved: f64, changed: f64) {
        self.last = count;
        self.longest = self.longest.max(count);
        if count > 1 {
            self.spanned += u64::from(count);
        }
        if self.event {
            // An event may begin here.
            self.chosen = 1;
            return;
        }
        let ratio = (1.0 / moved).clamp(RATIO[0], RATIO[1]);
        if ratio < 1.0 - LITTLE {
            self.chosen = ((f64::from(count) * ratio) as u32).max(1);
        } else if ratio > 1.0 + LITTLE && changed <= 1.0 {
            // A step that a record has ended early does not limit the next ones.
            let next = (f64::from(count) * ratio) as u32;
            self.chosen = next.max(self.chosen).min(self.most);
        }
    }

    /// Shortens the next steps slightly, since finer steps change the result by more than
    /// permitted.
    pub fn shorten(&mut self) {
        self.chosen = ((f64::from(self.chosen) * RATIO[0]) as u32).max(1);
    }

    /// Reduces the number after a step of `count` steps of the case that had to be repeated.
    pub fn shrink(&mut self, count: u32) {
        self.chosen = (count / SHRINKS).max(1);
        self.event = false;
    }
}
