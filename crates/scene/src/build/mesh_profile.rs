//! Sides of blocks that are waves, rough, or measured profiles.

use super::Builder;
use super::surface::Roughness;
use crate::case::{MeshProfileSpec, ProfileShape};
use crate::profile_file;
use crate::source::InputError;
use fretwork_elastic::AnyMesh;
use fretwork_elastic::generate::BlockGrid;
use std::f64::consts::TAU;

/// Fraction of the height of a block by which a side may rise or fall.
const DEEPEST: f64 = 0.5;
/// Largest number of points of a rough profile per shortest wave.
const POINTS_A_WAVE: f64 = 16.0;

/// Heights (m) over a flat side.
enum Heights {
    /// Amplitude, and lengths along x and y; an infinite length is a factor of 1.
    Wave(f64, [f64; 2]),
    /// Linear interpolation in a table, whose last height repeats the first if it has a period (m).
    Table(Vec<(f64, f64)>),
}

impl Heights {
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Wave(amplitude, [along, across]) => {
                amplitude * (TAU * x / along).cos() * (TAU * y / across).cos()
            }
            Self::Table(points) => {
                let k = points.partition_point(|p| p.0 <= x);
                let (before, after) = (k.max(1) - 1, k.min(points.len() - 1));
                let (a, b) = (points[before], points[after]);
                if before == after || x <= a.0 {
                    return a.1;
                }
                a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)
            }
        }
    }
}

impl Builder<'_> {
    /// Returns a block with a profile on one side; the displacement of points behind it decreases
    /// with depth.
    pub(super) fn profiled(
        &self,
        here: &str,
        grid: &BlockGrid,
        spec: &MeshProfileSpec,
    ) -> Result<AnyMesh, InputError> {
        let (up, lines) = (self.dimension() - 1, grid.lines());
        let ends = |k: usize| [lines[k][0], lines[k][lines[k].len() - 1]];
        let [bottom, top] = ends(up);
        let height = top - bottom;
        let outward = match spec.side.as_str() {
            "top" => 1.0,
            "bottom" => -1.0,
            other => {
                let message = format!("only `top` and `bottom` can have a profile, got `{other}`");
                return Err(self.fail(format!("{here}.side"), message));
            }
        };
        let shape = format!("{here}.shape");
        let heights = self.heights(&shape, &spec.shape, ends(0))?;
        let space = self.dimension() == 3;
        let over = |p: [f64; 3]| heights.at([p[0], if space { p[1] } else { 0.0 }]);
        let mut most = 0.0f64;
        for x in &lines[0] {
            for y in if space { &lines[1][..] } else { &[0.0][..] } {
                most = most.max(over([*x, *y, 0.0]).abs());
            }
        }
        if most >= DEEPEST * height || most.is_nan() {
            let message = format!(
                "the profile rises or falls by {most:.3e} m, more than half of the height of the block, {height:.3e} m; make it smaller or the block higher"
            );
            return Err(self.fail(shape, message));
        }
        let map = |p: [f64; 3]| {
            let from = if outward > 0.0 {
                p[up] - bottom
            } else {
                top - p[up]
            };
            let mut out = p;
            out[up] += outward * over(p) * from / height;
            out
        };
        self.mapped(here, grid, &map)
    }

    fn heights(
        &self,
        here: &str,
        shape: &ProfileShape,
        [from, to]: [f64; 2],
    ) -> Result<Heights, InputError> {
        let plane = |what: &str| {
            let message = format!("{what} is for blocks in two dimensions; give a `Wave` in three");
            self.fail(here, message)
        };
        match shape {
            ProfileShape::Wave { amplitude, x, y } => {
                if !(amplitude.is_finite() && *x > 0.0 && *y > 0.0) {
                    let message = "a wave has a finite amplitude and positive lengths";
                    return Err(self.fail(here, message));
                }
                Ok(Heights::Wave(*amplitude, [*x, *y]))
            }
            ProfileShape::Rough { .. } if self.dimension() == 3 => Err(plane("a rough profile")),
            ProfileShape::Rough {
                rms,
                hurst,
                longest,
                shortest,
            } => {
                let period = to - from;
                let points = (POINTS_A_WAVE * period / shortest).min(1e6);
                let roughness = Roughness {
                    points: points as usize,
                    rms: *rms,
                    hurst: *hurst,
                    longest: *longest,
                    shortest: *shortest,
                };
                let heights = self.rough_heights(here, &roughness, period)?;
                let step = period / heights.len() as f64;
                let around = heights.iter().chain(heights.first()).enumerate();
                let table = around.map(|(k, z)| (from + step * k as f64, *z));
                Ok(Heights::Table(table.collect()))
            }
            ProfileShape::Table { .. } if self.dimension() == 3 => {
                Err(plane("a profile of a table"))
            }
            ProfileShape::Table { file } => {
                let read = profile_file::read(&self.folder.join(file));
                let points = read.map_err(|e| self.source.named_at(&format!("{here}.file"), e))?;
                if points.is_empty() || points.windows(2).any(|w| w[1].0 <= w[0].0) {
                    let message = format!("the places x in {file} must rise from line to line");
                    return Err(self.fail(format!("{here}.file"), message));
                }
                Ok(Heights::Table(points))
            }
        }
    }
}
