//! Cycles of stress below a fretting contact, averaged over a block of material: cracks grow from
//! grains, not from points (J. A. Araújo, D. Nowell, International Journal of Fatigue 24, 2002).

use crate::below::{Below, add};
use crate::fields::{Field, Vector};
use crate::stress::Stress;

/// A block over which stresses are averaged: as wide as it is deep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Length of its sides (m).
    pub side: f64,
    /// Number of depths at which it is sampled.
    pub layers: usize,
}

impl Block {
    /// Returns the depths of the middles of its layers (m), for [`Below`].
    pub fn depths(&self) -> Vec<f64> {
        let layers = self.layers.max(1);
        let at = |k: usize| (k as f64 + 0.5) * self.side / layers as f64;
        (0..layers).map(at).collect()
    }
}

/// Returns the cycle of stress of each cell (Pa), averaged over the depths of `below` and over the
/// cells within half of the side of a block, of the first body; for the second one give opposite
/// tractions. `traction` has the tractions at the places of the cycle, and `bulk` the stress of the
/// body without the contact at each of them, or is empty.
pub fn histories(
    below: &Below,
    block: &Block,
    pressure: &[f64],
    traction: &[Field],
    bulk: &[Stress],
) -> Vec<Vec<Stress>> {
    let constant = below.by_pressure(pressure);
    let mut out = vec![Vec::with_capacity(traction.len()); pressure.len()];
    for (place, traction) in traction.iter().enumerate() {
        let mut stresses = constant.clone();
        add(&mut stresses, 1.0, &below.by_traction(traction));
        let far = bulk.get(place).copied().unwrap_or_default();
        let levels = stresses.len() as f64;
        let mean: Vec<Stress> = (0..pressure.len())
            .map(|cell| {
                let sum = |k: usize| stresses.iter().map(|level| level[cell][k]).sum::<f64>();
                std::array::from_fn(|k| sum(k) / levels + far[k])
            })
            .collect();
        for (out, stress) in out.iter_mut().zip(across(below, block, &mean)) {
            out.push(stress);
        }
    }
    out
}

/// Averages over the cells within half of the side of a block.
fn across(below: &Below, block: &Block, stress: &[Stress]) -> Vec<Stress> {
    let grid = &below.grid;
    let reach = [0, 1].map(|k| (0.5 * block.side / grid.size[k]).floor() as usize);
    if reach == [0, 0] {
        return stress.to_vec();
    }
    (0..grid.len())
        .map(|cell| {
            let [i, j] = grid.place(cell);
            let range = |at: usize, k: usize| {
                at.saturating_sub(reach[k])..=(at + reach[k]).min(grid.cells[k] - 1)
            };
            let (mut sum, mut count) = ([0.0; 6], 0.0);
            for v in range(j, 1) {
                for u in range(i, 0) {
                    let part = stress[grid.cell([u, v])];
                    (0..6).for_each(|k| sum[k] += part[k]);
                    count += 1.0;
                }
            }
            sum.map(|s| s / count)
        })
        .collect()
}

/// Returns the opposite of tractions: those on the second body.
pub fn opposite(traction: &[Vector]) -> Field {
    traction.iter().map(|[x, y]| [-x, -y]).collect()
}
