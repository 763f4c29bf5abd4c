//! Steps that grow beyond that of the case where nothing moves, and shrink again before something does.
//!
//! A step of the run spans a number of steps of the case. It follows from what a step changes: the largest displacement of a body over
//! its size, and the change of forces over the accuracy asked for. A step that spanned several is repeated with half the number if in it something
//! moved, broke or changed by more. Events end steps, see [`Ahead`].
//!
//! [`Ahead`]: fretwork_core::step::control::Ahead

use fretwork_core::geometry::space::Space;
use fretwork_core::step::{ContactForces, Simulation, StepReport};
use fretwork_scene::case::{AccuracySpec, Case};
use serde::{Deserialize, Serialize};

/// Largest displacement that steps aim at, as a share of the smallest half size of a body that moves, and the change of forces, of what is
/// allowed.
const AIM: [f64; 2] = [0.1, 0.4];
/// A step that has grown is kept up to this many times of that.
const KEPT: f64 = 2.5;
/// Most by which a step is longer or shorter than the one before it: forces of a step are those of the next where the two are similar.
const RATIO: f64 = 2.0;
/// Steps are not changed by less than this.
const LITTLE: f64 = 0.2;
/// Largest change of forces that is allowed in a step, whatever accuracy is asked for.
const MOST_CHANGE: f64 = 0.1;
/// Largest step over that of the case, if nothing is said.
const LARGEST: f64 = 100.0;
/// How many steps of the case a step spans.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Growth {
    /// Most; 1 where steps do not grow.
    most: u32,
    /// Change of forces over a step that is allowed, as a share of the forces.
    allowed: f64,
    /// As chosen; events and records may end a step before.
    chosen: u32,
    /// Of the last step.
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
pub(super) struct Before<S: Space> {
    pub forces: ContactForces<S>,
    damage: f64,
}

impl<S: Space> Before<S> {
    pub fn of(s: &Simulation<S>) -> Self {
        Self {
            forces: s.contact_forces(),
            damage: damage(s),
        }
    }
}

/// Sum of the damage of all bonds.
fn damage<S: Space>(s: &Simulation<S>) -> f64 {
    let made = s.state.network.bonds_made();
    if made == 0 {
        return 0.0;
    }
    s.state.network.mean_damage() * made as f64
}

impl Growth {
    pub fn new<S: Space>(spec: &AccuracySpec, case: &Case, s: &Simulation<S>) -> Self {
        let most = spec
            .largest_step
            .map_or(LARGEST, |largest| largest / case.time.step);
        // A largest step that is a multiple up to rounding is reached. The waves of deformable bodies are not seen by what is looked at here.
        let most = (most * (1.0 + 1e-9)).clamp(1.0, 1e9) as u32;
        Self {
            most: if s.state.systems.is_empty() { most } else { 1 },
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

    /// How many steps of the case, of `h` (s), the next step spans, if it may not span more than `most`.
    pub fn next<S: Space>(&mut self, s: &Simulation<S>, h: f64, most: u64) -> u32 {
        self.event = false;
        if self.most == 1 {
            return 1;
        }
        if s.phase_begins() {
            self.chosen = 1;
        }
        let (ahead, event) = s.ahead().steps(s.state.time, h);
        let count = u64::from(self.chosen).min(ahead).min(most).max(1);
        self.event = event && count == ahead;
        count as u32
    }

    /// Whether the next step, of `count` steps of the case, is worth comparing: it has grown, or may grow after it.
    pub fn watches<S: Space>(&self, s: &Simulation<S>, count: u32) -> bool {
        count > 1 || (self.most > 1 && s.largest_displacement() <= AIM[0])
    }

    /// Takes in a step of `count` steps of the case; false where it is to be repeated with fewer.
    pub fn holds<S: Space>(
        &mut self,
        s: &Simulation<S>,
        before: Option<&Before<S>>,
        report: &StepReport,
        count: u32,
    ) -> bool {
        let network = &s.state.network;
        let quiet = report.solver.converged
            && report.solves <= 1
            && report.projected.is_none()
            && network.bond_breaks.is_empty()
            && network.bonds_formed.is_empty();
        // What has changed most, over what is aimed at.
        let over = before.filter(|_| quiet).map_or(f64::INFINITY, |before| {
            let change = s.change_since(&before.forces);
            let damage = (damage(s) - before.damage).abs() / before.damage.max(1.0);
            let forces = change.forces.max(damage) / self.allowed;
            (change.displacement / AIM[0]).max(forces / AIM[1])
        });
        if let Some(b) = before {
            let c = s.change_since(&b.forces);
            eprintln!(
                "n {count} quiet {quiet} solves {} its {} disp {:.3} forces {:.4} over {:?}",
                report.solves, report.solver.iterations, c.displacement, c.forces, over
            );
        }
        if count > 1 && over > KEPT {
            return false;
        }
        self.keep(count, over);
        true
    }

    /// A step of `count` steps of the case is made, in which changes were `over` times what is aimed at.
    fn keep(&mut self, count: u32, over: f64) {
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
        let ratio = (1.0 / over).clamp(1.0 / RATIO, RATIO);
        if (ratio - 1.0).abs() > LITTLE {
            let next = (f64::from(count) * ratio) as u32;
            // A step that a record has ended before says nothing against longer ones.
            let chosen = if ratio > 1.0 {
                next.max(self.chosen)
            } else {
                next
            };
            self.chosen = chosen.clamp(1, self.most);
        }
    }

    /// A step of `count` steps of the case did not hold: the next ones span fewer.
    pub fn shrink(&mut self, count: u32) {
        self.chosen = (f64::from(count) / RATIO) as u32;
        self.event = false;
    }
}
