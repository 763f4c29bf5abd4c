//! Profiles that wear as bodies roll over each other many times.
//!
//! Every point of a row passes through the whole row of the patch, so that a passage takes the same
//! depth everywhere along the rolling, k sum p |S| over the row, and the profile changes across it.
//! A jump of N passages is implicit: the pressures at its end are those of the bodies that they
//! have worn,
//!
//! ```text
//! e = h + N k S_row sum_x p + u_z(p) - delta
//! ```
//!
//! with S_row the mean slip of the row, weighted by pressure. Explicit jumps oscillate where a jump
//! wears more than the elastic approach of a row.

use crate::fields::{Field, length};
use crate::friction::Friction;
use crate::motion::{Creepage, Motion};
use crate::normal::{Pressure, wearing};
use crate::patch::PatchError;
use crate::surfaces::Surfaces;
use crate::tangential::tangential;
use serde::Serialize;

/// How two bodies wear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wear {
    /// Wear coefficients of both bodies (1/Pa, m^3/J): depth over pressure and slip.
    pub coefficients: [f64; 2],
    /// Passages of each body's points for one passage of the patch: 1 for a rail, and for a wheel
    /// that runs over other rail each time, the share of its passages that are counted.
    pub passages: [f64; 2],
}

/// A profile over the passages.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Worn {
    /// Passages so far.
    pub passages: f64,
    /// Depth worn of each body, row by row (m).
    pub depth: [Vec<f64>; 2],
    /// Volume worn of each body per length along the rolling (m^2).
    pub volume: [f64; 2],
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Force over load along the rolling and across it.
    pub adhesion: [f64; 2],
    /// Number of jumps so far.
    pub jumps: usize,
    /// Sum of the errors of the jumps in depth (m), each by halving.
    pub error: f64,
}

/// What stays the same as profiles wear.
pub struct Rolls<'a> {
    /// Both surfaces.
    pub surfaces: &'a Surfaces,
    /// Distance of the new bodies (m).
    pub distance: &'a [f64],
    /// Load (N).
    pub load: f64,
    /// Creepages.
    pub creepage: Creepage,
    /// Friction.
    pub law: &'a dyn Friction,
    /// Speed of rolling (m/s).
    pub speed: f64,
    /// Wear.
    pub wear: Wear,
}

/// Pressures, tractions and mean slips of rows.
#[derive(Clone, Debug)]
struct State {
    pressure: Pressure,
    traction: Field,
    /// Mean slip of each row in a passage by a cell (m).
    slip: Vec<f64>,
}

/// Residual of the tangential problem over the largest bound.
const TOLERANCE: f64 = 1e-5;
/// Number of times that the slips of a jump follow its pressures.
const ROUNDS: usize = 3;
/// Number of passages of the first jump.
const FIRST: f64 = 10.0;
/// Smallest jump, at which the error is taken as it is.
const SMALLEST: f64 = 1.0;

impl Rolls<'_> {
    /// Wears both bodies over a number of passages, in jumps whose error in depth is at most a
    /// share of what they wear; `follow` gets the profile after each of them.
    ///
    /// # Errors
    /// The patch has no solution.
    pub fn wear(
        &self,
        passages: f64,
        share: f64,
        follow: &mut dyn FnMut(&Worn),
    ) -> Result<Worn, PatchError> {
        let rows = self.surfaces.grid.cells[1];
        let mut worn = Worn {
            depth: [vec![0.0; rows], vec![0.0; rows]],
            ..Worn::default()
        };
        let mut state = self.state(&worn, None, None)?;
        self.record(&state, &mut worn);
        follow(&worn);
        let mut jump = FIRST.min(passages);
        while worn.passages < passages * (1.0 - 1e-12) {
            jump = jump.min(passages - worn.passages);
            let (whole, _) = self.jump(&worn, &state, jump)?;
            let (half, middle) = self.jump(&worn, &state, 0.5 * jump)?;
            let (fine, end) = self.jump(&half, &middle, 0.5 * jump)?;
            let over = |a: &Worn, b: &Worn| {
                let pairs = (0..2).flat_map(|k| a.depth[k].iter().zip(&b.depth[k]));
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let (error, taken) = (over(&whole, &fine), over(&fine, &worn));
            let allowed = share * taken;
            if error <= allowed || jump <= SMALLEST {
                worn = Worn {
                    jumps: worn.jumps + 1,
                    error: worn.error + error,
                    ..fine
                };
                state = end;
                self.record(&state, &mut worn);
                follow(&worn);
            }
            // The error of a jump relative to its depth is of first order.
            let factor = match error > 0.0 {
                true => (0.8 * allowed / error).clamp(0.3, 2.0),
                false => 2.0,
            };
            jump = (jump * factor).max(SMALLEST);
        }
        Ok(worn)
    }

    /// Wears by some passages, implicitly.
    fn jump(&self, from: &Worn, state: &State, passages: f64) -> Result<(Worn, State), PatchError> {
        let mut end = state.clone();
        let mut worn = from.clone();
        for _ in 0..ROUNDS {
            let rates =
                [0, 1].map(|k| passages * self.wear.passages[k] * self.wear.coefficients[k]);
            let compliance: Vec<f64> = end.slip.iter().map(|s| (rates[0] + rates[1]) * s).collect();
            let slip = end.slip.clone();
            end = self.state(from, Some(&compliance), Some(&end))?;
            worn = from.clone();
            worn.passages += passages;
            let columns = self.surfaces.grid.cells[0];
            let rows = end.pressure.pressure.chunks(columns).zip(&slip);
            for (row, (pressures, slip)) in rows.enumerate() {
                let sum = pressures.iter().sum::<f64>() * slip;
                let bodies = worn.depth.iter_mut().zip(&mut worn.volume);
                for ((depth, volume), rate) in bodies.zip(rates) {
                    depth[row] += rate * sum;
                    *volume += rate * sum * self.surfaces.grid.size[1];
                }
            }
        }
        Ok((worn, end))
    }

    /// Returns the state of worn bodies, or of bodies that wear by it.
    fn state(
        &self,
        worn: &Worn,
        compliance: Option<&[f64]>,
        start: Option<&State>,
    ) -> Result<State, PatchError> {
        let (grid, columns) = (&self.surfaces.grid, self.surfaces.grid.cells[0]);
        let depth = |cell: usize| worn.depth[0][cell / columns] + worn.depth[1][cell / columns];
        let distance: Vec<f64> = (0..grid.len())
            .map(|cell| self.distance[cell] + depth(cell))
            .collect();
        let begin = start.map(|s| &s.pressure.pressure[..]);
        let pressure = wearing(self.surfaces, &distance, self.load, compliance, begin)?;
        let motion = Motion::Steady(self.creepage);
        let begin = start.map(|s| &s.traction[..]);
        let law = (self.law, self.speed);
        let p = &pressure.pressure;
        let found = tangential(self.surfaces, p, &motion, law, begin, TOLERANCE)?;
        let rows = p.chunks(columns).zip(found.slip.chunks(columns));
        let slip = rows.map(|(p, s)| {
            let sum: f64 = p.iter().sum();
            let weighted: f64 = p.iter().zip(s).map(|(p, s)| p * length(*s)).sum();
            if sum > 0.0 { weighted / sum } else { 0.0 }
        });
        Ok(State {
            slip: slip.collect(),
            traction: found.traction,
            pressure,
        })
    }

    fn record(&self, state: &State, worn: &mut Worn) {
        worn.pressure = state.pressure.largest();
        let area = self.surfaces.grid.area(3);
        worn.adhesion =
            [0, 1].map(|k| -state.traction.iter().map(|p| p[k]).sum::<f64>() * area / self.load);
    }
}
