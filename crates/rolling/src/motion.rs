//! Rigid slip: how the bodies would slip over each other if they did not deform.

use crate::fields::{Field, Vector};
use crate::surfaces::Passage;
use fretwork_elastic::half_space::CellGrid;
use serde::{Deserialize, Serialize};

/// Creepages: relative velocities over the speed of rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Creepage {
    /// Along the rolling, xi.
    pub along: f64,
    /// Across it, eta.
    pub across: f64,
    /// Spin phi: the relative angular velocity about the normal over the speed of rolling (1/m).
    #[serde(default)]
    pub spin: f64,
}

/// A motion over one step.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Steady rolling with creepages: a step is a passage by one cell.
    Steady(Creepage),
    /// Rolling with creepages by one cell, from the tractions (Pa) at its start.
    Transient {
        /// The creepages.
        creepage: Creepage,
        /// Tractions before.
        from: Field,
    },
    /// A shift of the first body, as in fretting, from the tractions (Pa) at its start.
    Shift {
        /// Displacement along x and y (m).
        by: Vector,
        /// Tractions before.
        from: Field,
    },
}

impl Motion {
    /// Returns what passes from step to step.
    pub fn passage(&self) -> Passage {
        match self {
            Self::Steady(_) => Passage::Steady,
            Self::Transient { .. } | Self::Shift { .. } => Passage::Shift,
        }
    }
}

/// Part of a cell by which the place of the spin is ahead of the middle of a cell: the passage ends
/// at the middle, and the sum of the slips of a row is right to second order (the value of the
/// program CONTACT, E. A. H. Vollebregt, which agrees with ours on all grids).
const AHEAD: f64 = 1.0 / 6.0;

/// Returns the rigid slip of each cell in a passage by one cell (m): (xi - phi y) dx along the
/// rolling and (eta + phi x) dx across it.
pub fn rigid_slip(grid: &CellGrid, creepage: &Creepage) -> Field {
    let step = grid.size[0];
    (0..grid.len())
        .map(|cell| {
            let [x, y] = grid.middle(cell);
            [
                (creepage.along - creepage.spin * y) * step,
                (creepage.across + creepage.spin * (x + AHEAD * step)) * step,
            ]
        })
        .collect()
}
