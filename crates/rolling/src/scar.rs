//! Cycles of fretting over which surfaces wear, debris gathers between them and friction changes.
//!
//! Bodies that fret by less than the size of their patch wear in the same cells in each cycle. A
//! jump of N cycles is implicit: pressures, debris and the state of the law at its end are those of
//! the rates at its end,
//!
//! ```text
//! e = h + depth + N k s p + u_z(p) - delta        d depth/dN = w, the wear of the law
//! d rho/dN = w - rho s/l                          s: path of slip in a cycle
//! ```
//!
//! with rho the debris between the bodies, volume over area, and l the path of slip over which it
//! leaves: source and outflow of a third body (N. Fillot, I. Iordanoff, Y. Berthier, Wear 262,
//! 2007), with an outflow in proportion to the debris. Volume closes by construction.

use crate::fields::Vector;
use crate::fretting::{Amplitude, Fretting, Loop};
use crate::friction::Friction;
use crate::normal::{Pressure, normal, wearing_in_place};
use crate::strokes::StrokeError;
use crate::surfaces::Surfaces;
use serde::Serialize;

/// What stays the same over the cycles.
#[derive(Clone, Copy)]
pub struct Cycles<'a> {
    /// Both surfaces.
    pub surfaces: &'a Surfaces,
    /// Distance of the new bodies (m).
    pub distance: &'a [f64],
    /// Load (N).
    pub load: f64,
    /// Law of friction and wear.
    pub law: &'a dyn Friction,
    /// Direction of the motion, of length 1.
    pub along: Vector,
    /// Half of the range of a cycle.
    pub amplitude: Amplitude,
    /// Steps of a quarter of a cycle.
    pub quarter: usize,
    /// Time of a step (s).
    pub step: f64,
    /// Way of slip over which debris leaves the patch (m); none leaves without it.
    pub ejection: Option<f64>,
}

/// The contact after some cycles.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scar {
    /// Cycles so far.
    pub cycles: f64,
    /// Depth worn off both bodies in each cell (m).
    #[serde(skip)]
    pub depth: Vec<f64>,
    /// Debris in each cell, volume over area (m).
    #[serde(skip)]
    pub debris: Vec<f64>,
    /// Pressure of each cell (Pa).
    #[serde(skip)]
    pub pressure: Vec<f64>,
    /// Volume worn off both bodies (m³).
    pub volume: f64,
    /// Volume of debris between the bodies (m³).
    pub between: f64,
    /// Volume of debris that has left (m³).
    pub ejected: f64,
    /// Largest depth (m).
    pub deepest: f64,
    /// Largest pressure (Pa).
    pub peak: f64,
    /// Area under pressure (m²).
    pub area: f64,
    /// Amplitude of the displacement (m) and of the force (N) of the cycle.
    pub amplitude: [f64; 2],
    /// Energy of slip of the cycle (J).
    pub energy: f64,
    /// Share of the area that sticks throughout the cycle.
    pub stuck: f64,
    /// Number of jumps so far.
    pub jumps: usize,
    /// Sum of the errors of the jumps: of the largest depth (m), and of the force (N).
    pub error: [f64; 2],
}

/// Pressures and a cycle of a scar.
#[derive(Clone, Debug)]
struct State {
    pressure: Pressure,
    cycle: Loop,
    /// What stays with the material before a cycle, and its change in it.
    carried: Vec<Vec<f64>>,
    change: Vec<Vec<f64>>,
}

/// Largest number of times that the rates of a jump follow its end, and the change of the depth
/// over what the jump wears at which they have.
const ROUNDS: (usize, f64) = (6, 2e-3);
/// Cycles of the first jump.
const FIRST: f64 = 1.0;
/// Smallest jump, at which the error is taken as it is.
const SMALLEST: f64 = 1.0;

impl Scar {
    /// Returns what is missing in the ledger of volume, over the volume worn.
    pub fn unaccounted(&self) -> f64 {
        match self.volume > 0.0 {
            true => (self.volume - self.between - self.ejected).abs() / self.volume,
            false => 0.0,
        }
    }
}

impl Cycles<'_> {
    /// Follows a number of cycles, in jumps whose error in depth, debris and force is at most a
    /// share of what they change; `follow` gets the contact after each of them.
    ///
    /// # Errors
    /// The load is not held, a cycle has no solution, or friction no longer holds the force.
    pub fn follow(
        &self,
        cycles: f64,
        share: f64,
        follow: &mut dyn FnMut(&Scar),
    ) -> Result<Scar, StrokeError> {
        let n = self.distance.len();
        let mut scar = Scar {
            depth: vec![0.0; n],
            debris: vec![0.0; n],
            ..Scar::default()
        };
        self.law.renew(n);
        let mut state = self.state(&scar, None, &self.law.carried())?;
        self.record(&state, &mut scar);
        follow(&scar);
        let mut jump = FIRST.min(cycles);
        while scar.cycles < cycles * (1.0 - 1e-12) {
            jump = jump.min(cycles - scar.cycles);
            let whole = self.jump(&scar, &state, jump)?;
            let half = self.jump(&scar, &state, 0.5 * jump)?;
            let fine = self.jump(&half.0, &half.1, 0.5 * jump)?;
            let ([depth, debris, force], error) = errors(&scar, &whole, &fine);
            let off = depth.max(debris).max(force);
            if off <= share || jump <= SMALLEST {
                let before = (scar.jumps, scar.error);
                (scar, state) = fine;
                scar.jumps = before.0 + 1;
                scar.error = [before.1[0] + error[0], before.1[1] + error[1]];
                self.record(&state, &mut scar);
                follow(&scar);
            }
            let factor = match off > 0.0 {
                true => (0.8 * share / off).clamp(0.3, 2.0),
                false => 2.0,
            };
            jump = (jump * factor).max(SMALLEST);
        }
        Ok(scar)
    }

    /// Jumps over some cycles, implicitly.
    fn jump(&self, from: &Scar, state: &State, cycles: f64) -> Result<(Scar, State), StrokeError> {
        let area = self.surfaces.grid.area(3);
        let mut end = state.clone();
        let mut scar = from.clone();
        for _ in 0..ROUNDS.0 {
            let last = scar.depth.clone();
            let compliance = end.compliance(cycles);
            let distance = self.worn(&from.depth);
            let start = Some(&end.pressure.pressure[..]);
            let pressed =
                wearing_in_place(self.surfaces, &distance, self.load, &compliance, start)?;
            scar = Scar {
                cycles: from.cycles + cycles,
                ..from.clone()
            };
            for (cell, (p, c)) in pressed.pressure.iter().zip(&compliance).enumerate() {
                let worn = c * p;
                let leaves = self
                    .ejection
                    .map_or(0.0, |l| cycles * end.slip_path(cell) / l);
                let before = scar.debris[cell] + worn;
                let after = before / (1.0 + leaves);
                scar.depth[cell] += worn;
                scar.debris[cell] = after;
                scar.volume += worn * area;
                scar.ejected += (before - after) * area;
            }
            let carried = ahead(&state.carried, &end.change, cycles);
            end = self.state(&scar, Some(&pressed), &carried)?;
            let taken = most(&scar.depth, &from.depth);
            if most(&scar.depth, &last) <= ROUNDS.1 * taken {
                break;
            }
        }
        Ok((scar, end))
    }

    /// Returns the distance of worn bodies.
    fn worn(&self, depth: &[f64]) -> Vec<f64> {
        let cells = self.distance.iter().zip(depth);
        cells.map(|(h, d)| h + d).collect()
    }

    /// Returns pressures and a cycle of a scar.
    fn state(
        &self,
        scar: &Scar,
        start: Option<&Pressure>,
        carried: &[Vec<f64>],
    ) -> Result<State, StrokeError> {
        let distance = self.worn(&scar.depth);
        let start = start.map(|p| &p.pressure[..]);
        let pressure = normal(self.surfaces, &distance, self.load, start)?;
        let frets = Fretting {
            surfaces: self.surfaces,
            pressure: &pressure.pressure,
            law: self.law,
            along: self.along,
            step: self.step,
        };
        if self.law.constant() {
            // The step of a quarter of the cycle.
            let quarter = Fretting {
                step: self.step * self.quarter as f64,
                ..frets
            };
            return Ok(State {
                cycle: quarter.ruled(self.amplitude, 1)?,
                pressure,
                carried: Vec::new(),
                change: Vec::new(),
            });
        }
        let at_rest = vec![[0.0; 2]; self.distance.len()];
        let begin = || {
            self.law.carry(carried);
            // Contacts form where there are none yet.
            self.law.passed(frets.cells(), &at_rest);
            self.law.cover(&scar.debris);
        };
        begin();
        let (place, _) = frets.first(self.amplitude, self.quarter)?;
        // The loading only takes the contact to the end of a cycle.
        begin();
        let before = self.law.carried();
        let (_, cycle) = frets.cycle(&place, self.amplitude, self.quarter)?;
        let after = self.law.carried();
        Ok(State {
            pressure,
            cycle,
            change: difference(&before, &after),
            carried: before,
        })
    }

    fn record(&self, state: &State, scar: &mut Scar) {
        let area = self.surfaces.grid.area(3);
        scar.pressure.clone_from(&state.pressure.pressure);
        scar.peak = state.pressure.largest();
        scar.area = scar.pressure.iter().filter(|p| **p > 0.0).count() as f64 * area;
        scar.deepest = scar.depth.iter().copied().fold(0.0, f64::max);
        scar.between = scar.debris.iter().sum::<f64>() * area;
        scar.amplitude = state.cycle.amplitude;
        scar.energy = state.cycle.energy;
        scar.stuck = state.cycle.stuck;
    }
}

impl State {
    /// Returns the path of slip of a cell in a cycle (m).
    fn slip_path(&self, cell: usize) -> f64 {
        match self.pressure.pressure[cell] {
            p if p > 0.0 => self.cycle.rubbed[cell] / p,
            _ => 0.0,
        }
    }

    /// Returns the depth that goes in some cycles by one pascal in each cell (m/Pa). Cells that do
    /// not touch yet wear as the fastest one once they do.
    fn compliance(&self, cycles: f64) -> Vec<f64> {
        let worn = &self.cycle.worn;
        let of = |(cell, p): (usize, &f64)| match *p > 0.0 {
            true => cycles * worn.get(cell).copied().unwrap_or(0.0) / p,
            false => 0.0,
        };
        let pressures = self.pressure.pressure.iter().enumerate();
        let mut list: Vec<f64> = pressures.clone().map(of).collect();
        let fastest = list.iter().copied().fold(0.0, f64::max);
        for (cell, _) in pressures.filter(|(_, p)| **p <= 0.0) {
            list[cell] = fastest;
        }
        list
    }
}

/// Returns errors of depth, debris and force over what a jump changes of them, or, of the
/// force, over its size; and those of depth (m) and force (N).
fn errors(from: &Scar, whole: &(Scar, State), fine: &(Scar, State)) -> ([f64; 3], [f64; 2]) {
    let over = |error: f64, change: f64| if change > 0.0 { error / change } else { 0.0 };
    let (w, f) = (&whole.0, &fine.0);
    let depth = most(&w.depth, &f.depth);
    let debris = most(&w.debris, &f.debris);
    let largest = f.debris.iter().copied().fold(0.0, f64::max);
    let forces = [whole, fine].map(|s| s.1.cycle.amplitude[1]);
    let force = (forces[0] - forces[1]).abs();
    (
        [
            over(depth, most(&f.depth, &from.depth)),
            over(debris, largest),
            over(force, forces[1]),
        ],
        [depth, force],
    )
}

/// Returns the largest difference.
fn most(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Returns what stays with the material some cycles later; contacts that form or end in between
/// have nothing.
fn ahead(from: &[Vec<f64>], change: &[Vec<f64>], cycles: f64) -> Vec<Vec<f64>> {
    let of = |(from, change): (&Vec<f64>, &Vec<f64>)| {
        let pairs = from.iter().zip(change);
        pairs.map(|(x, d)| x + cycles * d).collect()
    };
    from.iter().zip(change).map(of).collect()
}

/// Returns what a cycle changes of what stays with the material, cell by cell.
fn difference(before: &[Vec<f64>], after: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of = |(before, after): (&Vec<f64>, &Vec<f64>)| {
        let pairs = before.iter().zip(after);
        pairs.map(|(b, a)| a - b).collect()
    };
    before.iter().zip(after).map(of).collect()
}
