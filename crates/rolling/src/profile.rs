//! Depth worn of both bodies across the rolling, over rows of cells that grow with the patch.

use fretwork_elastic::half_space::CellGrid;
use serde::Serialize;

/// Depth worn of both bodies, row by row.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Profile {
    /// Where the first row begins (m).
    pub from: f64,
    /// Width of a row (m).
    pub width: f64,
    /// Depth of each body (m).
    pub depth: [Vec<f64>; 2],
}

impl Profile {
    /// Returns new bodies over the rows of a grid.
    pub fn new(grid: &CellGrid) -> Self {
        Self {
            from: grid.from[1],
            width: grid.size[1],
            depth: [0, 1].map(|_| vec![0.0; grid.cells[1]]),
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.depth[0].len()
    }

    /// Middle of a row (m).
    pub fn middle(&self, row: usize) -> f64 {
        self.from + (row as f64 + 0.5) * self.width
    }

    /// Depth of both bodies in a row (m).
    pub fn both(&self, row: usize) -> f64 {
        self.depth[0][row] + self.depth[1][row]
    }

    /// Volume worn of each body per length along the rolling (m²).
    pub fn volume(&self) -> [f64; 2] {
        self.depth
            .each_ref()
            .map(|d| d.iter().sum::<f64>() * self.width)
    }

    /// Largest depth of each body (m).
    pub fn deepest(&self) -> [f64; 2] {
        self.depth
            .each_ref()
            .map(|d| d.iter().copied().fold(0.0, f64::max))
    }

    /// Adds rows without wear below and above.
    pub fn widen(&mut self, [below, above]: [usize; 2]) {
        self.from -= below as f64 * self.width;
        for depth in &mut self.depth {
            depth.resize(depth.len() + below + above, 0.0);
            depth.rotate_right(below);
        }
    }

    /// Joins neighbouring rows, each pair to one of their mean depth.
    pub fn join(&mut self) {
        if !self.rows().is_multiple_of(2) {
            self.widen([0, 1]);
        }
        self.width *= 2.0;
        for depth in &mut self.depth {
            *depth = depth.chunks(2).map(|p| 0.5 * (p[0] + p[1])).collect();
        }
    }

    /// Returns values of the rows of this profile over the rows of another one, each the mean over
    /// the width of its row, 0 beyond this profile.
    pub fn over(&self, values: &[f64], other: &Profile) -> Vec<f64> {
        let mean = |row: usize| {
            let low = other.from + row as f64 * other.width;
            let high = low + other.width;
            let shared = |k: usize| {
                let begin = self.from + k as f64 * self.width;
                (high.min(begin + self.width) - low.max(begin)).max(0.0)
            };
            let parts = values.iter().enumerate().map(|(k, v)| v * shared(k));
            parts.sum::<f64>() / other.width
        };
        (0..other.rows()).map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile() -> Profile {
        Profile {
            from: -3e-3,
            width: 1e-3,
            depth: [
                vec![0.0, 1e-6, 4e-6, 2e-6, 0.0],
                vec![0.0, 2e-6, 3e-6, 2e-6, 1e-6],
            ],
        }
    }

    /// Rows are added and joined without a change of the volume.
    #[test]
    fn volumes_stay() {
        let before = profile();
        let mut after = before.clone();
        after.widen([2, 3]);
        assert_eq!(after.volume(), before.volume());
        assert!((after.middle(4) - before.middle(2)).abs() < 1e-18);
        after.join();
        after.join();
        for (a, b) in after.volume().iter().zip(before.volume()) {
            assert!((a / b - 1.0).abs() < 1e-15, "{a} {b}");
        }
        let shown = before.over(&before.depth[0], &after);
        let pairs = shown.iter().zip(&after.depth[0]);
        assert!(
            pairs.clone().all(|(a, b)| (a - b).abs() < 1e-20),
            "{shown:?} {after:?}"
        );
    }
}
