//! Wear of a passage of bodies that roll, with the error of its grid.

use crate::patch::answer::Wear;
use crate::patch::law::{Passage, PatchLaw};
use crate::patch::setup::Setup;
use fretwork_core::laws::Kind;
use fretwork_rolling::{Estimate, Refined, Rolling};

/// Depths that a passage takes off the rows of a grid.
#[derive(Clone, Debug, Default)]
pub(in crate::patch) struct Rows {
    /// Depth of each row (m).
    pub depth: Vec<f64>,
    /// Width of a row (m).
    pub width: f64,
}

impl Rows {
    /// Returns the rows of a grid from the depth that each cell takes (m).
    pub fn of(rolling: &Rolling, worn: &[f64]) -> Self {
        let rows = worn.chunks(rolling.grid.cells[0]);
        Self {
            depth: rows.map(|row| row.iter().sum()).collect(),
            width: rolling.grid.size[1],
        }
    }

    /// Returns the volume per length along the rolling (m²).
    pub fn volume(&self) -> f64 {
        self.depth.iter().sum::<f64>() * self.width
    }

    /// Returns the largest depth (m).
    pub fn deepest(&self) -> f64 {
        self.depth.iter().copied().fold(0.0, f64::max)
    }
}

/// Wear on a fine grid and two coarse ones.
pub(in crate::patch) struct Grids {
    pub fine: Rows,
    pub coarse: [Rows; 2],
}

impl Grids {
    /// Returns the wear of a body that loses a part of these depths. Volume and largest depth are
    /// extrapolated as forces are, since the energy of slip errs to the first order of the cells.
    pub fn wear(&self, body: String, law: &str, part: f64) -> Wear {
        let of = |number: fn(&Rows) -> f64| {
            let (fine, coarse) = (number(&self.fine), self.coarse.each_ref().map(number));
            let found = Estimate::of_sum(fine, coarse);
            // Nothing grows by wear: below that the extrapolation says nothing.
            let value = if found.value > 0.0 { found.value } else { fine };
            (part * value, part * found.error)
        };
        let ((volume, volume_error), (depth, depth_error)) = (of(Rows::volume), of(Rows::deepest));
        Wear {
            body,
            law: law.to_owned(),
            volume,
            volume_error,
            depth,
            depth_error,
            profile: self.fine.depth.iter().map(|d| part * d).collect(),
            half_width: None,
        }
    }
}

/// Returns the wear of a passage, of each body where it follows from their hardness; the passages
/// are those of the fine grid and the coarse ones.
pub(super) fn of_passage(
    setup: &Setup,
    law: &PatchLaw,
    refined: &Refined,
    (fine, coarse): (&Passage, &[Passage; 2]),
) -> Vec<Wear> {
    let Some(wear) = law.interface().law(Kind::WEAR) else {
        return Vec::new();
    };
    let grids = Grids {
        fine: Rows::of(&refined.fine, &fine.worn),
        coarse: [0, 1].map(|k| Rows::of(&refined.coarse[k], &coarse[k].worn)),
    };
    let bodies = super::bodies_that_wear(setup).into_iter();
    let bodies = bodies.map(|(body, part)| grids.wear(body, &wear.plugin.name, part));
    bodies.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A volume that falls to first order with the cells is found, and one that the cells do not
    /// determine has an error as large as itself.
    #[test]
    fn wear_is_extrapolated_to_cells_of_no_size() {
        let of = |[fine, one, other]: [f64; 3]| {
            let rows = |depth: f64| Rows {
                depth: vec![0.0, depth, 0.5 * depth],
                width: 2.0,
            };
            let grids = Grids {
                fine: rows(fine),
                coarse: [rows(one), rows(other)],
            };
            grids.wear("rail".into(), "archard", 0.5)
        };
        let found = of([0.9, 0.8, 0.8]);
        assert!((found.volume - 1.5).abs() < 1e-12 && (found.depth - 0.5).abs() < 1e-12);
        assert!((found.volume_error - 0.15).abs() < 1e-12, "{found:?}");
        assert!(found.is_known());
        let lost = of([0.1, 0.5, 0.2]);
        assert!(!lost.is_known(), "{lost:?}");
        assert!((lost.volume - 0.15).abs() < 1e-12, "{lost:?}");
    }
}
