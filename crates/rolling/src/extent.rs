//! The grid around a patch that grows as its bodies wear.

use crate::profile::Profile;
use fretwork_elastic::half_space::CellGrid;

/// Fewest rows without pressure on either side of the patch.
const MARGIN: usize = 2;
/// Rows at the start over those that are added to a side.
const ADDED: usize = 8;
/// Growth of the number of rows over that at the start at which pairs of them are joined.
const MANY: f64 = 1.5;
/// Half of the side along the rolling over that of the patch, and where the grid is laid anew.
const AROUND: [f64; 2] = [1.1, 1.25];

/// The grid along the rolling.
pub(crate) struct Extent {
    columns: usize,
    half: f64,
    /// Number of rows at the start.
    rows: usize,
}

impl Extent {
    /// Returns the extent of a grid.
    pub fn new(grid: &CellGrid) -> Self {
        Self {
            columns: grid.cells[0],
            half: 0.5 * grid.extent()[0],
            rows: grid.cells[1],
        }
    }

    /// Returns the grid over the rows of a profile.
    pub fn grid(&self, profile: &Profile) -> CellGrid {
        CellGrid {
            from: [-self.half, profile.from],
            size: [2.0 * self.half / self.columns as f64, profile.width],
            cells: [self.columns, profile.rows()],
        }
    }

    /// Makes the grid larger on all sides.
    pub fn widen(&mut self, profile: &mut Profile) {
        self.half *= AROUND[0];
        profile.widen([self.added(); 2]);
        self.join(profile);
    }

    fn added(&self) -> usize {
        (self.rows / ADDED).max(MARGIN)
    }

    fn join(&self, profile: &mut Profile) {
        if profile.rows() as f64 > MANY * self.rows as f64 {
            profile.join();
        }
    }

    /// Whether the patch has some room on its grid, and does not miss much of it along the rolling;
    /// otherwise the grid is changed.
    pub fn fits(&mut self, profile: &mut Profile, grid: &CellGrid, pressure: &[f64]) -> bool {
        let touching = (0..grid.len()).filter(|c| pressure[*c] > 0.0);
        let (mut long, mut low, mut high) = (0.0f64, usize::MAX, 0);
        for cell in touching {
            let row = cell / grid.cells[0];
            (low, high) = (low.min(row), high.max(row));
            long = long.max(grid.middle(cell)[0].abs() + 0.5 * grid.size[0]);
        }
        let room = [low, grid.cells[1] - 1 - high];
        if room.iter().any(|r| *r < MARGIN) {
            let added = self.added();
            profile.widen(room.map(|r| if r < added { added } else { 0 }));
            self.join(profile);
            return false;
        }
        if self.half > AROUND[1] * long {
            self.half = AROUND[0] * long;
            return false;
        }
        true
    }
}
