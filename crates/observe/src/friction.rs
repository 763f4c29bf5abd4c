//! Friction test: Q-delta loops, and the friction coefficients of each cycle from forces and from
//! dissipation.

use super::cycle::{Cycle, SLIDING_STIFFNESS, SlipRegime};
use super::layer::Balance;
use super::loops::Loop;
use super::onset::Onset;
use super::scatter::{self, Scatter};
use super::steady::BLOCKS;
use fretwork_core::process::cycle::CycleClock;
use fretwork_core::process::sliding::ACROSS;
use serde::{Deserialize, Serialize};

/// E_d/(4 Q* delta*) above which a cycle has more than one loop; that of a rectangle is 1.
const LARGEST_RATIO: f64 = 1.05;
/// Path over the size of a body below which it is due to rounding.
const STILL: f64 = 1e-9;

/// Measurements of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Time at the end of the step (s).
    pub time: f64,
    /// Tangential force that moves the body, averaged over the step (N; N/m in 2D).
    pub q: f64,
    /// Normal force, positive in compression (N; N/m in 2D).
    pub p: f64,
    /// Signed sliding distance in the step (m).
    pub slide: f64,
    /// Distance in the step over which the contacts slide, in any direction (m).
    pub travel: f64,
    /// Distance in the step that the body moves, or what it rubs against if that is more (m).
    pub moved: f64,
    /// Work of sliding over the step (J).
    pub work: f64,
}

/// Observer of the cycles of a friction test.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cycles {
    clock: CycleClock,
    end: f64,
    /// Cycles so far, the current one last.
    pub list: Vec<Cycle>,
    pressure_time: f64,
    time: f64,
    position: f64,
    lowest: f64,
    highest: f64,
    before: Option<FrictionTotals>,
    shape: Loop,
    place: f64,
    /// Times between which the contact slides, of strokes (s).
    sliding: Vec<[f64; 2]>,
    /// Integrals of Q d delta and P |d delta| over blocks of equal time, for tests without a
    /// period.
    blocks: Vec<(f64, f64)>,
    /// Rise of Q/P from the start on, for these tests.
    onset: Onset,
    /// |Q|/P at the start of the cycle.
    start_ratio: f64,
    /// Integrals of P |ds| over all cycles: along the axis, and in the plane of the contacts (J).
    load_paths: [f64; 2],
    /// Path below which a contact sticks (m).
    still: f64,
    /// Whether a cycle was not a period of the motion.
    other_period: bool,
    /// Elastic energy stored at the start of the first cycle (J).
    stored_before: f64,
}

/// Cumulative quantities of a run at the end of a step.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct FrictionTotals {
    /// Energy balance.
    pub balance: Balance,
    /// Bonds broken.
    pub broken: u64,
    /// Volume worn off first bodies (m^3; m^3/m in 2D).
    pub worn: f64,
}

impl Cycles {
    /// Returns the time from which friction is measured (s).
    pub fn start(&self) -> f64 {
        match self.clock.period {
            Some(_) => self.clock.start,
            // The clock counts the second half alone.
            None => 2.0 * self.clock.start - self.end,
        }
    }

    /// Creates cycles of length `period` from `start` on; without a period the second half of the
    /// time from `start` to `end` is one cycle.
    pub fn new(start: f64, period: Option<f64>, end: f64) -> Self {
        Self::of(CycleClock::new(start, period, end), end)
    }

    /// Creates cycles from a clock, for a run until `end` (s).
    pub fn of(clock: CycleClock, end: f64) -> Self {
        Self {
            clock,
            end,
            list: Vec::new(),
            pressure_time: 0.0,
            time: 0.0,
            position: 0.0,
            lowest: 0.0,
            highest: 0.0,
            before: None,
            shape: Loop::default(),
            place: 0.0,
            sliding: Vec::new(),
            blocks: vec![(0.0, 0.0); if clock.period.is_some() { 0 } else { BLOCKS }],
            onset: Onset::default(),
            start_ratio: 0.0,
            load_paths: [0.0; 2],
            still: 0.0,
            other_period: false,
            stored_before: 0.0,
        }
    }

    /// Counts a path that is far below this length (m), the size of the smallest body, as that of a
    /// contact that sticks: it is due to rounding.
    pub fn with_length(mut self, length: f64) -> Self {
        self.still = STILL * length;
        self
    }

    /// Returns whether cycles are not periods of the motion.
    pub fn of_other_period(&self) -> bool {
        self.oscillates() && self.other_period
    }

    /// Returns whether the contact stuck over the last cycle.
    pub fn sticks(&self) -> bool {
        self.last().is_some_and(|c| c.path < self.still)
    }

    /// Returns the scatter of the friction coefficient over the later cycles; without a period over
    /// the finished blocks.
    pub fn scatter(&self) -> Option<Scatter> {
        if self.oscillates() {
            return scatter::over_cycles(&self.list, |c| c.friction_coefficient);
        }
        let width = (self.end - self.clock.start) / BLOCKS as f64;
        let done = (self.time / width + 1e-6).floor() as usize;
        scatter::over_blocks(&self.blocks[..done.min(self.blocks.len())])
    }

    /// Returns the times between which the contact slides (s); `None` without reciprocating motion,
    /// where all of it does.
    pub fn sliding(&self) -> Option<&[[f64; 2]]> {
        self.oscillates().then_some(&self.sliding)
    }

    /// Returns whether the contact slides at the last sample, after the elastic part of the stroke.
    pub fn slides(&self) -> bool {
        self.shape.slides()
    }

    /// Number of the cycle at a time (s), from 1; 0 before the start.
    pub fn number(&self, time: f64) -> u32 {
        self.clock.number(time)
    }

    /// Returns start and end of a cycle (s); `None` without cycles.
    pub fn span(&self, number: u32) -> Option<[f64; 2]> {
        self.clock.span(number)
    }

    /// Whether the motion is reciprocating.
    pub fn oscillates(&self) -> bool {
        self.clock.period.is_some()
    }

    /// Extends the test to a later end (s).
    pub fn lengthen(&mut self, end: f64) {
        self.end = end;
    }

    /// Number of cycles of the whole run.
    pub fn total(&self) -> u32 {
        self.number(self.end)
    }

    /// Adds a step: cumulative quantities at its start and at its end, and the damage ratio.
    pub fn add(
        &mut self,
        sample: &Sample,
        h: f64,
        before: FrictionTotals,
        after: FrictionTotals,
        damage: f64,
    ) {
        if !self.oscillates() && sample.time > self.start() {
            self.onset.add(sample.slide.abs(), sample.q, sample.p);
        }
        let number = self.number(sample.time);
        if number == 0 {
            self.start_ratio = if sample.p > 0.0 {
                sample.q.abs() / sample.p
            } else {
                0.0
            };
            return;
        }
        if self.list.last().is_none_or(|c| c.cycle != number) {
            if let Some(last) = self.list.last_mut() {
                last.complete = true;
            }
            self.list.push(Cycle {
                cycle: number,
                ..Cycle::default()
            });
            (self.pressure_time, self.time) = (0.0, 0.0);
            (self.position, self.lowest, self.highest) = (0.0, 0.0, 0.0);
            self.before = Some(before);
            if self.list.len() > 1 {
                self.start_ratio = self.shape.ratio();
            }
            self.shape.next_cycle();
        }
        let (Some(cycle), Some(start)) = (self.list.last_mut(), self.before) else {
            return;
        };
        self.pressure_time += sample.p * h;
        if self.clock.period.is_none() {
            // The step belongs to the block that contains its middle.
            let share = (self.time + 0.5 * h) / (self.end - self.clock.start);
            let block = (share * BLOCKS as f64) as usize;
            if let Some(block) = self.blocks.get_mut(block) {
                block.0 += sample.work;
                block.1 += sample.p * sample.slide.abs();
            }
        }
        self.time += h;
        self.position += sample.slide;
        self.lowest = self.lowest.min(self.position);
        self.highest = self.highest.max(self.position);
        cycle.path += sample.slide.abs();
        cycle.moved += sample.moved;
        self.load_paths[0] += sample.p * sample.slide.abs();
        self.load_paths[1] += sample.p * sample.travel;
        cycle.load_path += sample.p * sample.slide.abs();
        cycle.work += sample.work;
        cycle.tangential_amplitude = cycle.tangential_amplitude.max(sample.q.abs());
        cycle.normal_force = self.pressure_time / self.time;
        self.place += sample.slide;
        self.shape.add(self.place, sample.q, sample.p);
        if self.shape.slides() {
            let start = sample.time - h;
            match self.sliding.last_mut().filter(|s| start < s[1] + 0.5 * h) {
                Some(span) => span[1] = sample.time,
                None => self.sliding.push([start, sample.time]),
            }
        }
        let (now, then) = (&after.balance, &start.balance);
        let heat = (now.taken - then.taken) - (now.other - then.other);
        let over = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        cycle.energetic_coefficient = over(cycle.work, cycle.load_path);
        cycle.friction_from_dissipation = over(heat, cycle.load_path);
        cycle.broken = after.broken - start.broken;
        cycle.wear_volume = after.worn - start.worn;
        cycle.damage_ratio = damage;
        self.judge(sample.time, h);
    }

    /// Evaluates the current cycle at a time (s): ratios of its loop, regime, and coefficient.
    fn judge(&mut self, time: f64, h: f64) {
        let number = self.number(time);
        let Some(cycle) = self.list.last_mut() else {
            return;
        };
        let over = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        let amplitude = 0.5 * (self.highest - self.lowest);
        cycle.energy_ratio = over(cycle.work, 4.0 * cycle.tangential_amplitude * amplitude);
        cycle.amplitude = amplitude;
        cycle.sliding = self.shape.aperture();
        cycle.slip_ratio = over(cycle.sliding, amplitude).min(1.0);
        cycle.reversal_ratio = self.shape.reversal();
        let clock = &self.clock;
        let reciprocates = clock.period.is_some();
        let stiffness = match reciprocates {
            true => self.shape.end_stiffness(),
            false => stiffness(&self.blocks, &self.onset, cycle.normal_force),
        };
        cycle.stored = match reciprocates {
            true => {
                let before = self.shape.stored(self.start_ratio);
                if cycle.cycle == 1 {
                    self.stored_before = before;
                }
                self.shape.stored(self.shape.ratio()) - before
            }
            false => 0.0,
        };
        let end = clock
            .period
            .map_or(self.end, |p| clock.start + f64::from(number) * p);
        cycle.complete = time >= end - 1e-6 * h;
        cycle.regime = match stiffness {
            _ if cycle.path < self.still => SlipRegime::Partial,
            _ if reciprocates && cycle.moves_together() => SlipRegime::Partial,
            _ if reciprocates => SlipRegime::of(cycle.energy_ratio, cycle.slip_ratio, stiffness),
            Some(k) if k >= SLIDING_STIFFNESS => SlipRegime::Partial,
            _ => SlipRegime::Gross,
        };
        let slides = cycle.regime == SlipRegime::Gross;
        self.other_period |= self.shape.strokes() > 2 || cycle.energy_ratio > LARGEST_RATIO;
        cycle.friction_coefficient = match reciprocates {
            // Parts of strokes of several lengths cannot be told.
            true if self.other_period => None,
            // A motion that doesn't turn back slides all the time.
            true if slides && cycle.complete && !cycle.reverses() => {
                Some(cycle.energetic_coefficient)
            }
            true if slides => self.shape.plateau(),
            true => None,
            // Without a period elastic travel after reversals cannot be told from sliding.
            false if cycle.reverses() || across(self.load_paths) => None,
            false => (cycle.load_path > 0.0 && slides).then_some(cycle.energetic_coefficient),
        };
    }

    /// Returns whether the contacts slide across the axis of the test alone.
    pub fn across(&self) -> bool {
        across(self.load_paths)
    }

    /// Returns normal force times path over all cycles, those jumped over included (J; J/m in 2D).
    pub fn load_path(&self) -> f64 {
        let of = |c: &Cycle| c.load_path * f64::from(1 + c.jumped);
        self.list.iter().map(of).sum()
    }

    /// Returns normal force times the path of slip over all cycles, those jumped over included (J;
    /// J/m in 2D), in the plane of the contacts; `None` where no cycle has a coefficient of
    /// sliding. A cycle without one has that of the one before, or of the first that has one.
    pub fn slip_load_path(&self) -> Option<f64> {
        let jumps = |c: &Cycle| f64::from(1 + c.jumped);
        let [along, whole] = self.load_paths;
        if !self.oscillates() {
            let cycle = self.list.last()?;
            // Nothing that may be elastic, or no path.
            if self.across() || cycle.load_path <= 0.0 {
                return Some(whole);
            }
            let elastic = self.onset.elastic_path(cycle.friction_coefficient?);
            return Some(whole - cycle.normal_force * elastic);
        }
        let known = |c: &Cycle| c.friction_coefficient.filter(|mu| c.complete && *mu > 0.0);
        self.last().and_then(known)?;
        let mut coefficient = self.list.iter().find_map(known)?;
        let of = |c: &Cycle| {
            coefficient = known(c).unwrap_or(coefficient);
            c.slip_load_path(coefficient) * jumps(c)
        };
        Some(self.list.iter().map(of).sum::<f64>() * whole / along)
    }

    /// Returns normal force times the path of slip before the first cycle (J; J/m in 2D), by the
    /// load path and the work of the tangential force until then (J; J/m): of a reciprocating
    /// motion the work without what is elastically stored then, over the coefficient of sliding;
    /// all of the path in other motions, and where slip is not known.
    pub fn slip_before(&self, load_path: f64, work: f64) -> f64 {
        let [along, whole] = self.load_paths;
        let known = self.last().and_then(|c| c.friction_coefficient);
        match known.filter(|mu| self.oscillates() && *mu > 0.0) {
            Some(mu) => (work - self.stored_before).max(0.0) / mu * whole / along,
            None => load_path,
        }
    }

    /// Returns the last complete cycle, or the last one if none is complete.
    pub fn last(&self) -> Option<&Cycle> {
        self.list
            .iter()
            .rev()
            .find(|c| c.complete)
            .or(self.list.last())
    }
}

/// Returns whether the contacts slide across an axis alone, by P |ds| along it and as a whole (J).
fn across([along, whole]: [f64; 2]) -> bool {
    along < ACROSS * whole
}

/// Returns how fast Q/P still rises over the evaluated path, relative to its rise from the first
/// motion to half of its last value: 0 where the contact slides, 1 of a spring that doesn't. Over a
/// ramp of a sphere in partial slip it is 0.55 or more, and 0.04 if it moves half as far again as
/// to gross slip, where the mean over the second half is 0.99 of the coefficient (K. L. Johnson,
/// Contact Mechanics, 1985, 7.4). `None` before there are two blocks.
fn stiffness(blocks: &[(f64, f64)], onset: &Onset, normal_force: f64) -> Option<f64> {
    let loaded: Vec<_> = blocks.iter().filter(|b| b.1 > 0.0).copied().collect();
    let (first, last) = loaded.split_at(loaded.len() / 2);
    let sum = |blocks: &[(f64, f64)]| {
        let sum = |of: fn(&(f64, f64)) -> f64| blocks.iter().map(of).sum::<f64>();
        [sum(|b| b.0), sum(|b| b.1)]
    };
    let ([work, load], [last_work, last_load]) = (sum(first), sum(last));
    let [before, after] = [work / load, last_work / last_load];
    let distance = 0.5 * (load + last_load) / normal_force;
    let half = onset.path_to(0.5 * after)?;
    let relative = (after - before) / distance * half / (0.5 * after);
    relative.is_finite().then_some(relative)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns two cycles of a sine at friction `mu`, with the lid rising and falling with the
    /// stroke; `measured` is the ratio of the measured to the true force.
    fn loops(mu: f64, lift: f64, measured: f64) -> Cycles {
        let (p, a, f, h) = (1e3, 5e-5, 10.0, 1e-5);
        let omega = std::f64::consts::TAU * f;
        let mut cycles = Cycles::new(0.0, Some(1.0 / f), 0.2);
        let (mut balance, mut t) = (Balance::default(), 0.0);
        while t < 0.2 - 0.5 * h {
            let v = a * omega * (omega * (t + 0.5 * h)).cos();
            // On slopes of `lift`, the tangential force increases by what the normal force
            // decreases.
            let q = mu * p * v.signum() + lift * p;
            let before = balance;
            balance.taken += mu * p * v.abs() * h;
            balance.other -= p * lift * v * h;
            t += h;
            let sample = Sample {
                time: t,
                q: measured * q,
                p,
                slide: v * h,
                travel: v.abs() * h,
                moved: v.abs() * h,
                work: measured * q * v * h,
            };
            let [before, after] = [before, balance].map(|balance| FrictionTotals {
                balance,
                ..FrictionTotals::default()
            });
            cycles.add(&sample, h, before, after, 0.0);
        }
        assert_eq!(cycles.list.len(), 2);
        cycles
    }

    #[test]
    fn a_coulomb_loop_has_the_friction_put_in() {
        let mu = 0.4;
        for c in &loops(mu, 0.0, 1.0).list {
            assert!((c.friction_coefficient.unwrap() / mu - 1.0).abs() < 1e-9 && c.complete);
            assert!((c.energetic_coefficient / mu - 1.0).abs() < 1e-9);
            assert!((c.friction_from_dissipation / mu - 1.0).abs() < 1e-9);
            // A rectangular loop: E_d = 4 mu P delta.
            assert!((c.work / (4.0 * mu * 1e3 * 5e-5) - 1.0).abs() < 1e-6);
            assert!((c.energy_ratio - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_lid_that_climbs_and_falls_has_the_same_friction() {
        for c in &loops(0.4, 0.2, 1.0).list {
            assert!((c.energetic_coefficient / 0.4 - 1.0).abs() < 1e-6);
            assert!((c.friction_from_dissipation / 0.4 - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_wrong_force_does_not_reach_the_friction_from_heat() {
        for c in &loops(0.4, 0.0, 2.0).list {
            assert!((c.energetic_coefficient / 0.8 - 1.0).abs() < 1e-9);
            assert!((c.friction_from_dissipation / 0.4 - 1.0).abs() < 1e-9);
        }
    }
}
