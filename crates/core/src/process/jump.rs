//! Cycle jumps in a run: how many cycles each computed cycle represents, and the error control of
//! each jump.

use super::cycle::CycleClock;
pub use super::jump_summary::{Jump, JumpPoint, JumpSummary};
use super::sliding::SlidingBody;
use super::{Process, ProcessError};
use crate::contact::Bond;
use crate::contact::events::BondEnergies;
use crate::encoding::{EncodingError, decode, encode};
use crate::geometry::recede::Vertex;
use crate::geometry::space::Space;
use crate::step::{Simulation, StepReport};
use crate::wear::jump::{
    Amounts, error, error_growth, growth, misplaced, next_length, parabola_weights, remaining,
};
use serde::{Deserialize, Serialize};

/// Jumps over the cycles of a friction test: a computed cycle can represent many cycles, see
/// [`crate::wear::jump`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct JumpSpec {
    /// Number of cycles computed one by one before the first jump.
    pub after: u32,
    /// Maximum number of cycles that one computed cycle represents.
    pub at_most: u32,
    /// Target error of a jump, from which the length of the next jump follows: relative to the
    /// increment by the jump, and for misplaced volume relative to the scar after `cycles` (without
    /// `cycles`, to the current scar).
    pub tolerance: f64,
    /// Number of cycles computed one by one after each jump, to check it.
    pub control: u32,
    /// Largest increase of the damage of a bond in a jump.
    pub growth: f64,
    /// Number of cycles after which the run ends, including skipped ones; by default it ends at
    /// `time.end`.
    pub cycles: Option<u32>,
}

impl Default for JumpSpec {
    fn default() -> Self {
        Self {
            after: 3,
            at_most: 50,
            tolerance: 0.02,
            control: 1,
            growth: 0.1,
            cycles: None,
        }
    }
}

/// Fraction of the remaining run that a jump may take.
const TAPER: f64 = 1.0 / 3.0;

/// Safety factor on the sum of the estimated errors: the parabola underestimates the error of
/// growth that accelerates within a jump. For the fatigue bond the error of whole runs was up to
/// 1.47 times the sum (docs/wear/jumps.md).
const SAFETY: f64 = 1.5;

/// A jump that waits for its control cycles.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Pending {
    cycles: u32,
    before: Amounts,
    added: Amounts,
    /// Sum over the control cycles so far.
    control: Amounts,
    computed: u32,
    /// Work of the cycle before the jump, and sum over its control cycles (J; J/m).
    work: [f64; 2],
}

/// Cycle jumps of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Jumps {
    spec: JumpSpec,
    clock: CycleClock,
    test: SlidingBody,
    /// Volume worn off first bodies and off grains (m^3; m^3/m).
    worn: (f64, f64),
    /// Number of the cycle whose work is summed, and the work of the rubbed body in it so far (J;
    /// J/m).
    current: (u32, f64),
    /// Tangential force in the last step (N; N/m).
    force: f64,
    /// Number of steps of a cycle, and of the whole run.
    steps: [u64; 2],
    /// Work of the last cycle that represents only itself (J; J/m).
    work: f64,
    /// Number of the current computed cycle, 0 before the first.
    number: u32,
    /// Number of cycles that the current one represents.
    cycle_multiplier: u32,
    /// Number of completed cycles: computed ones, and including skipped ones.
    computed: u32,
    represented: u32,
    /// Accumulated quantities at the start of the run and of the current cycle.
    first: Amounts,
    opened: Amounts,
    /// Growth over the last cycle that represents only itself.
    rate: Amounts,
    /// Length of the next jump, before rounding and limits.
    length: f64,
    pending: Option<Pending>,
    /// Growth over a cycle before the last jump, and its distance in cycles from the next jump.
    earlier: Option<(Amounts, f64)>,
    /// Distance in cycles of the growth `rate` from the next jump; 0 for the cycle just before it.
    centre: f64,
    /// Sum of the errors of the jumps, by accumulated quantity.
    errors: Vec<f64>,
    /// Misplaced volume on each scar.
    misplaced_volume: Vec<f64>,
    /// Amounts added by the last checked jump.
    last: Option<Amounts>,
    summary: JumpSummary,
}

impl Jumps {
    /// Creates jumps from the current state, with the cycles of the test, the rubbed body, and the
    /// numbers of steps of a cycle and of the whole run.
    pub fn new<S: Space>(
        spec: JumpSpec,
        clock: CycleClock,
        test: SlidingBody,
        steps: [u64; 2],
        s: &Simulation<S>,
    ) -> Self {
        let first = amounts(s, 0.0);
        Self {
            clock,
            test,
            worn: (0.0, 0.0),
            current: (0, 0.0),
            force: 0.0,
            steps,
            work: 0.0,
            number: clock.number(s.state.time + s.options.scheme.h),
            cycle_multiplier: 1,
            computed: 0,
            represented: 0,
            opened: first.clone(),
            rate: Vec::new(),
            length: f64::from(spec.after),
            pending: None,
            earlier: None,
            centre: 0.0,
            errors: vec![0.0; first.len()],
            misplaced_volume: vec![0.0; first.len()],
            last: None,
            summary: JumpSummary {
                asked_cycles: spec.cycles,
                tolerance: spec.tolerance,
                not_jumped: variables(s),
                ..JumpSummary::default()
            },
            first,
            spec,
        }
    }

    /// Returns the number of cycles so far, including skipped ones, when a share of the current
    /// cycle is done.
    fn cycles(&self, share: f64) -> f64 {
        f64::from(self.represented) + share * f64::from(self.cycle_multiplier)
    }

    /// Returns the number of skipped cycles, when a share of the current cycle is done.
    fn jumped(&self, share: f64) -> f64 {
        f64::from(self.represented - self.computed) + share * f64::from(self.cycle_multiplier - 1)
    }

    /// Returns the number of cycles so far, including skipped ones and the part of the current
    /// cycle, at a time (s).
    pub fn cycles_at(&self, time: f64) -> f64 {
        self.cycles(self.open_share(time))
    }

    /// Returns the number of cycles skipped by a time (s).
    pub fn jumped_at(&self, time: f64) -> f64 {
        self.jumped(self.open_share(time))
    }

    /// Returns the length of a cycle (s).
    pub fn period(&self) -> f64 {
        self.clock.period.unwrap_or(0.0)
    }

    /// Returns the completed share of the current cycle. A cycle that was closed with the last step
    /// is among those represented.
    fn open_share(&self, time: f64) -> f64 {
        let share = self.clock.share(time);
        if share < 1.0 { share } else { 0.0 }
    }

    /// Adds the work of the last step to that of its cycle.
    fn add_work<S: Space>(&mut self, s: &Simulation<S>) {
        let cycle = self.clock.number(s.state.time);
        if self.current.0 != cycle {
            self.current = (cycle, 0.0);
        }
        let drive = self.test.drive(s);
        self.current.1 += drive.work(self.force);
        self.force = drive.force;
    }

    /// Ends a cycle, and chooses how many cycles the next one represents.
    fn close<S: Space>(&mut self, s: &Simulation<S>, work: f64) {
        let now = amounts(s, self.worn.1);
        let grown = growth(&now, &self.opened);
        self.computed += 1;
        self.represented = self.represented.saturating_add(self.cycle_multiplier);
        self.summary.points.push(JumpPoint {
            cycles: self.represented,
            cycle_multiplier: self.cycle_multiplier,
            wear_volume: self.worn.0,
            mean_damage: s.state.network.mean_damage(),
        });
        if self.cycle_multiplier > 1 {
            self.pending = Some(Pending {
                cycles: self.cycle_multiplier,
                before: std::mem::take(&mut self.rate),
                added: grown,
                control: Vec::new(),
                computed: 0,
                work: [self.work, 0.0],
            });
            self.cycle_multiplier = 1;
            return;
        }
        if let Some(pending) = &mut self.pending {
            pending.computed += 1;
            pending.work[1] += work;
            add(&mut pending.control, &grown);
            if pending.computed < self.spec.control {
                return;
            }
        }
        match self.pending.take() {
            Some(pending) => {
                let share = 1.0 / f64::from(pending.computed);
                let scaled = |list: &Vec<f64>| list.iter().map(|x| share * x).collect();
                self.rate = pending.control.iter().map(scaled).collect();
                self.check_jump(s, &now, &pending);
            }
            None => {
                self.rate = grown;
                self.centre = 0.0;
                if let Some((_, back)) = &mut self.earlier {
                    *back += 1.0;
                }
            }
        }
        self.work = work;
        if self.computed >= self.spec.after {
            self.cycle_multiplier = self.next(s);
        }
    }

    /// Compares a jump with the adjacent cycles, and computes the length of the next.
    fn check_jump<S: Space>(&mut self, s: &Simulation<S>, now: &Amounts, pending: &Pending) {
        let n = f64::from(pending.cycles);
        // Cycles are counted from the one before the jump; the mean of those after it represents
        // their midpoint.
        let control = f64::from(pending.computed);
        let middle = 0.5 * (control - 1.0);
        let after = n + 1.0 + middle;
        // Before the first jump the two cycles are the same, and a straight line is used instead.
        let (earlier, parts) = match self.earlier.take() {
            Some((rate, back)) => (
                rate,
                parabola_weights(pending.cycles, [-back, -self.centre, after]),
            ),
            None => {
                let share = 0.5 * n * (n + 1.0) / after;
                (pending.before.clone(), [0.0, n - share, share])
            }
        };
        self.earlier = Some((pending.before.clone(), after + middle + self.centre));
        self.centre = middle;
        let grown = growth(now, &self.first);
        // The misplaced volume is a smaller fraction of the final scar than of the current one.
        let to_come = self
            .spec
            .cycles
            .map_or(1.0, |n| f64::from(n) / f64::from(self.represented));
        let mut worst = 0.0f64;
        for (q, added) in pending.added.iter().enumerate() {
            let rates = [&earlier[q], &pending.before[q], &self.rate[q]];
            let sum = |list: &[f64]| list.iter().sum::<f64>();
            let (all, total) = (sum(added), sum(&grown[q]));
            if all <= 0.0 {
                continue;
            }
            let off = if q < s.state.scars.len() {
                let form = misplaced(added, self.last.as_ref().map_or(rates[1], |l| &l[q]));
                self.misplaced_volume[q] = form.max(remaining(self.misplaced_volume[q], all));
                worst = worst.max(form / (total * to_come));
                error(all, rates.map(|r| sum(r)), &parts)
            } else {
                let at = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
                let bond = |(k, x): (usize, &f64)| error(*x, rates.map(|r| at(r, k)), &parts);
                added.iter().enumerate().map(bond).sum()
            };
            self.errors[q] = off + self.errors[q] * error_growth(sum(rates[1]), sum(rates[2]));
            worst = worst.max(off / all);
        }
        self.last = Some(pending.added.clone());
        self.summary.jumps.push(Jump {
            after: self.represented - self.spec.control - pending.cycles,
            cycles: pending.cycles,
            error: worst,
            work_change: if pending.work[0] > 0.0 {
                (pending.work[1] / control / pending.work[0] - 1.0).abs()
            } else {
                0.0
            },
        });
        self.length = next_length(n, worst, self.spec.tolerance);
    }

    /// Returns the number of cycles that the next cycle represents, limited by the error, the
    /// growth of damage, and the remaining run.
    fn next<S: Space>(&mut self, s: &Simulation<S>) -> u32 {
        // A jump and its control cycles must fit before the end.
        let [cycle, run] = self.steps;
        if run.saturating_sub(s.state.steps) < cycle * (1 + u64::from(self.spec.control)) {
            return 1;
        }
        // The length is at least two, so that it can grow again; `at_most` may be one.
        self.length = self.length.max(2.0).min(f64::from(self.spec.at_most));
        let damage = self.rate.iter().skip(s.state.scars.len() + 1).flatten();
        let fastest = damage.fold(0.0, |m: f64, x| m.max(*x));
        let by_damage = if fastest > 0.0 {
            self.spec.growth / fastest
        } else {
            f64::INFINITY
        };
        let mut most = self.length.min(by_damage);
        if let Some(cycles) = self.spec.cycles {
            // The last jumps become shorter and shorter, since each corrects the volume misplaced
            // by the one before it.
            let still = cycles.saturating_sub(self.represented + self.spec.control);
            most = most.min(f64::from(still) * TAPER);
        }
        (most.floor() as u32).max(1)
    }

    /// Returns the summary at the end of the run.
    pub fn outcome<S: Space>(&self, s: &Simulation<S>) -> JumpSummary {
        let grown = growth(&amounts(s, self.worn.1), &self.first);
        let share = |((off, form), grown): ((&f64, &f64), &Vec<f64>)| {
            let (off, all) = (off + form, grown.iter().sum::<f64>());
            match (off > 0.0, all > 0.0) {
                (false, _) => Some(0.0),
                (true, true) => Some(SAFETY * off / all),
                (true, false) => None,
            }
        };
        let off = self.errors.iter().zip(&self.misplaced_volume);
        let shares: Option<Vec<f64>> = off.zip(&grown).map(share).collect();
        let waiting = self.pending.as_ref().map_or(0, |p| p.cycles);
        let at_hand = if self.cycle_multiplier > 1 {
            self.cycle_multiplier
        } else {
            0
        };
        JumpSummary {
            computed_cycles: self.computed,
            represented_cycles: self.represented,
            error_estimate: shares.map(|list| list.into_iter().fold(0.0, f64::max)),
            unchecked_cycles: waiting + at_hand,
            wear_volume: self.worn.0,
            ..self.summary.clone()
        }
    }
}

impl<S: Space> Process<S> for Jumps {
    fn name(&self) -> &str {
        "cycle jumps"
    }

    fn repeats(&self) -> bool {
        true
    }

    fn after_move(
        &mut self,
        _: &mut Simulation<S>,
        report: &StepReport,
    ) -> Result<(), ProcessError> {
        self.worn.0 += report.totals.worn_first;
        self.worn.1 += report.totals.worn_third;
        Ok(())
    }

    /// Closes the cycle that the step ended, and begins the next one.
    fn between_steps(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        self.add_work(s);
        let next = self.clock.number(s.state.time + s.options.scheme.h);
        if next == self.number {
            return Ok(());
        }
        if self.number > 0 {
            let (cycle, work) = self.current;
            self.close(s, if cycle == self.number { work } else { 0.0 });
        }
        self.number = next;
        self.opened = amounts(s, self.worn.1);
        s.state.network.cycle_multiplier = f64::from(self.cycle_multiplier);
        Ok(())
    }

    /// Returns whether the requested cycles are complete.
    fn finished(&self) -> bool {
        self.spec.cycles.is_some_and(|n| self.represented >= n)
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(self)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        *self = decode(from)?;
        Ok(())
    }
}

/// Returns the accumulated quantities: volumes worn at the places of each scar, volume
/// worn off grains, and the damage of the bonds, interface by interface.
fn amounts<S: Space>(s: &Simulation<S>, worn_third: f64) -> Amounts {
    let mut all: Amounts = Vec::new();
    for scar in &s.state.scars {
        let volume = |(v, depth): (&Vertex<S::Vector>, f64)| v.tributary * depth;
        all.push(scar.vertices().map(volume).collect());
    }
    all.push(vec![worn_third]);
    // Broken bonds count as damage 1; a slot without a bond has no damage.
    let held = |b: &Bond<S>| match b.damage < 1.0 || b.energies != BondEnergies::default() {
        true => b.damage,
        false => 0.0,
    };
    let memory = s.state.network.memory.iter();
    all.extend(memory.map(|m| m.bonds.iter().map(held).collect()));
    all
}

/// Lists the internal variables of the laws in use, as `law: variable`.
fn variables<S: Space>(s: &Simulation<S>) -> Vec<String> {
    let laws = s.laws.iter().flat_map(|law| law.loaded());
    let names = laws.flat_map(|l| {
        let (law, variables) = (&l.plugin.name, l.plugin.variables.iter());
        variables.map(move |v| format!("{} of {law}", v.name))
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names.dedup();
    names
}

/// Adds value by value.
fn add(sum: &mut Amounts, more: &Amounts) {
    if sum.is_empty() {
        sum.clone_from(more);
        return;
    }
    for (sum, more) in sum.iter_mut().zip(more) {
        sum.resize(more.len(), 0.0);
        for (x, y) in sum.iter_mut().zip(more) {
            *x += y;
        }
    }
}

#[cfg(test)]
mod tests;
