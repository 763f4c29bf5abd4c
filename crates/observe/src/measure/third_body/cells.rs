//! Sums over the bins of a layer, and their history in a limited number of time blocks.

use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Stress components of a cell: across, along, shear, lateral (3D).
pub(super) const STRESSES: usize = 4;
/// Mechanisms of dissipation.
pub(super) const MECHANISMS: [&str; 5] =
    ["friction", "impact", "fracture", "viscous", "correction"];

/// Sums over the grains, contacts and steps of a bin.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Cell {
    /// Volume of the bin (m^3; m^2 in 2D).
    pub space: f64,
    /// Volume of grains in it.
    pub volume: f64,
    /// Mass of these grains (kg; kg/m).
    pub mass: f64,
    /// Mass times depth over the thickness.
    pub height: f64,
    /// Mass times v, the velocity along the sliding relative to the first body.
    pub momentum: f64,
    /// Mass times v V, where V is the velocity of the second body.
    pub drive: f64,
    /// Mass times V^2.
    pub square: f64,
    /// Mass times spin; its norm in 3D.
    pub spin: f64,
    /// Mass times granular temperature.
    pub granular: f64,
    /// Mass times temperature (kg K; kg K/m); 0 where no heat is computed.
    pub warmth: f64,
    /// Number of grains, by their volume fractions in the bin.
    pub grains: f64,
    /// Number of contacts of these grains that carry force.
    pub contacts: f64,
    /// Number of their intact bonds.
    pub bonds: f64,
    /// Number of their broken bonds.
    pub broken: f64,
    /// Sums f l (N m; N), see [`STRESSES`]. In time averages the shear is multiplied by the sign of
    /// the sliding.
    pub moment: [f64; STRESSES],
    /// Dissipated energy by mechanism (J; J/m).
    pub energy: [f64; MECHANISMS.len()],
}

impl AddAssign<&Cell> for Cell {
    fn add_assign(&mut self, o: &Cell) {
        self.space += o.space;
        self.volume += o.volume;
        self.mass += o.mass;
        self.height += o.height;
        self.momentum += o.momentum;
        self.drive += o.drive;
        self.square += o.square;
        self.spin += o.spin;
        self.granular += o.granular;
        self.warmth += o.warmth;
        self.grains += o.grains;
        self.contacts += o.contacts;
        self.bonds += o.bonds;
        self.broken += o.broken;
        let add = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        add(&mut self.moment, &o.moment);
        add(&mut self.energy, &o.energy);
    }
}

impl Cell {
    /// Returns the solid fraction.
    pub fn solid(&self) -> f64 {
        self.volume / self.space
    }

    /// Returns the mass-weighted mean depth over the thickness.
    pub fn depth(&self) -> f64 {
        self.height / self.mass
    }

    /// Returns the mean velocity relative to the first body (m/s).
    pub fn velocity(&self) -> f64 {
        self.momentum / self.mass
    }

    /// Returns the mass-weighted mean granular temperature (m^2/s^2).
    pub fn granular_temperature(&self) -> f64 {
        self.granular / self.mass
    }

    /// Returns the mass-weighted mean temperature (K), where heat is computed.
    pub fn temperature(&self) -> f64 {
        self.warmth / self.mass
    }

    /// Returns the ratio of the velocity to that of the second body, weighted by the square of the
    /// latter: <v V>/<V^2>, which is also defined for reciprocating sliding.
    pub fn carried(&self) -> f64 {
        self.drive / self.square
    }

    /// Returns the mean stress (Pa).
    pub fn stress(&self) -> [f64; STRESSES] {
        self.moment.map(|m| m / self.space)
    }

    /// Returns broken bonds over bonds made, of the grains in the bin.
    pub fn damage(&self) -> f64 {
        self.broken / (self.broken + self.bonds)
    }
}

/// Sums over a time interval.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Block {
    /// Start and end (s).
    pub time: [f64; 2],
    /// Number of samples.
    pub samples: u64,
    /// Sum of thicknesses (m).
    pub thickness: f64,
    /// Sum of the mean cluster sizes.
    pub cluster: f64,
    /// The bins, with one cell before the first and one after the last for material beyond the
    /// faces.
    pub cells: Vec<Cell>,
}

impl Block {
    /// Merges the following block.
    pub fn join(&mut self, next: &Block) {
        if self.samples == 0 {
            self.clone_from(next);
            return;
        }
        self.time[1] = next.time[1];
        self.samples += next.samples;
        self.thickness += next.thickness;
        self.cluster += next.cluster;
        self.cells
            .iter_mut()
            .zip(&next.cells)
            .for_each(|(a, b)| *a += b);
    }

    /// The bins between the faces.
    pub fn bins(&self) -> &[Cell] {
        self.cells
            .get(1..self.cells.len().max(2) - 1)
            .unwrap_or_default()
    }

    /// Returns the mean thickness (m).
    pub fn mean_thickness(&self) -> f64 {
        self.thickness / self.samples.max(1) as f64
    }

    /// Returns the duration (s).
    pub fn duration(&self) -> f64 {
        self.time[1] - self.time[0]
    }

    /// Returns pairs (depth over thickness, velocity over that of the second body) of bins with
    /// mass, if there is sliding.
    pub fn profile(&self) -> Vec<(f64, f64)> {
        let full = self
            .bins()
            .iter()
            .filter(|c| c.mass > 0.0 && c.square > 0.0);
        full.map(|c| (c.depth(), c.carried())).collect()
    }
}

/// History of blocks with equal numbers of samples; adjacent blocks are merged when there are too
/// many.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct History {
    /// The blocks so far.
    pub blocks: Vec<Block>,
    each: u64,
}

impl History {
    /// Limit on the number of blocks.
    const MAX_BLOCKS: usize = 128;

    pub fn new() -> Self {
        Self {
            blocks: Vec::new(),
            each: 1,
        }
    }

    /// Adds a sample.
    pub fn add(&mut self, sample: Block) {
        if let Some(last) = self.blocks.last_mut().filter(|b| b.samples < self.each) {
            last.join(&sample);
            return;
        }
        if self.blocks.len() == Self::MAX_BLOCKS {
            let pairs = self.blocks.chunks(2).map(whole);
            self.blocks = pairs.collect();
            self.each *= 2;
        }
        self.blocks.push(sample);
    }

    /// Returns the whole history as one block.
    pub fn whole(&self) -> Block {
        whole(&self.blocks)
    }

    /// Returns the blocks that lie mostly after a time, merged; at least the last block.
    pub fn since(&self, time: f64) -> Block {
        let middle = |b: &Block| 0.5 * (b.time[0] + b.time[1]);
        let first = self.blocks.partition_point(|b| middle(b) < time);
        whole(&self.blocks[first.min(self.blocks.len().saturating_sub(1))..])
    }

    /// The history merged into `count` slices of about equal duration.
    pub fn slices(&self, count: usize) -> Vec<Block> {
        let n = self.blocks.len();
        let ends = (0..count).map(|k| (n * k / count, n * (k + 1) / count));
        let parts = ends.filter(|(a, b)| a < b);
        parts.map(|(a, b)| whole(&self.blocks[a..b])).collect()
    }
}

fn whole(blocks: &[Block]) -> Block {
    let mut all = Block::default();
    blocks.iter().for_each(|b| all.join(b));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_history_keeps_its_sums_in_few_blocks() {
        let mut history = History::new();
        for k in 0..1000 {
            let cell = Cell {
                mass: 1.0,
                height: f64::from(k),
                ..Cell::default()
            };
            history.add(Block {
                time: [f64::from(k), f64::from(k + 1)],
                samples: 1,
                cells: vec![cell; 3],
                ..Block::default()
            });
        }
        assert!(
            history.blocks.len() <= History::MAX_BLOCKS
                && history.blocks.len() > History::MAX_BLOCKS / 3
        );
        let all = history.whole();
        assert_eq!((all.samples, all.time), (1000, [0.0, 1000.0]));
        assert_eq!((all.bins()[0].mass, all.bins()[0].depth()), (1000.0, 499.5));
        let slices = history.slices(4);
        assert_eq!(slices.len(), 4);
        assert!(slices.windows(2).all(|w| w[0].time[1] == w[1].time[0]));
        assert!(slices.iter().all(|s| (s.samples as i64 - 250).abs() < 20));
    }
}
