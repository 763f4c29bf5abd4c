//! Samples of blocks that fit together: Voronoi cells, and walls in running bond.

use super::Builder;
use crate::sample::deposit::Corners;
use crate::sample::spec::{BlockWallSpec, VoronoiSpec};
use crate::sample::voronoi::{self, SHORTEST};
use crate::sample::voronoi_space::{self, Failure};
use crate::source::{InputError, ValidationError};
use fretwork_core::assembly::ConvexBody;
use fretwork_core::geometry::any_shape::AnyPart;
use fretwork_core::geometry::convex::polyhedron::Polyhedron;
use nalgebra::Vector3;

/// Limit on the number of blocks: a larger number is taken for a typing error.
const MAX_BLOCKS: usize = 100_000;
/// Limit on Lloyd iterations; after a few hundred the cells no longer change visibly.
const MAX_ROUNDS: usize = 1_000;
/// Limit on cells times Lloyd iterations in 2D and 3D, which take some seconds. Building the cells
/// counts as one iteration.
const MAX_WORK: [f64; 2] = [1e6, 5e4];

impl Builder<'_> {
    /// Makes the Voronoi cells of a box.
    pub(super) fn voronoi(
        &mut self,
        k: usize,
        spec: &VoronoiSpec,
    ) -> Result<Vec<ConvexBody>, InputError> {
        let here = format!("grains.{k}");
        let low = self.corner(&format!("{here}.low"), &spec.low)?;
        let high = self.corner(&format!("{here}.high"), &spec.high)?;
        if (0..self.dimension()).any(|k| high[k] <= low[k]) {
            let message = format!(
                "each number must be greater than that of `low`: the region has no {}",
                if self.dimension() == 2 {
                    "area"
                } else {
                    "volume"
                }
            );
            return Err(self.fail(format!("{here}.high"), message));
        }
        let corners = [low, high];
        let size = self.length(&format!("{here}.size"), spec.size)?;
        let volume: f64 = (0..self.dimension()).map(|k| high[k] - low[k]).product();
        let cells = volume / size.powi(self.dimension() as i32);
        if cells > MAX_BLOCKS as f64 {
            let message = format!("the region would hold {cells:.3e} cells of this size");
            let fault = ValidationError::new(format!("{here}.size"), message);
            let advice = format!("larger cells, at most {MAX_BLOCKS}");
            return Err(self.source.locate(fault.expected(advice)));
        }
        if spec.rounds > MAX_ROUNDS {
            let message = format!("at most {MAX_ROUNDS} rounds, got {}", spec.rounds);
            return Err(self.fail(format!("{here}.rounds"), message));
        }
        let most = MAX_WORK[self.dimension() - 2];
        if cells * (spec.rounds + 1) as f64 > most {
            let message = format!(
                "{} rounds over {cells:.3e} cells take too long: cells times (rounds + 1) may be {most:e} at \
                 most in {} dimensions",
                spec.rounds,
                self.dimension()
            );
            return Err(self.fail(format!("{here}.rounds"), message));
        }
        self.not_negative(&format!("{here}.gap"), spec.gap)?;
        self.not_negative(&format!("{here}.rounding"), spec.rounding)?;
        for (axis, name) in ["x", "y", "z"].iter().enumerate().take(self.dimension()) {
            if let Some(period) = self.assembly.periodic().period[axis]
                && high[axis] - low[axis] > period * (1.0 + 1e-9)
            {
                let message =
                    format!("the region is wider than the period `periodic.{name}` ({period:e} m)");
                return Err(self.fail(format!("{here}.high"), message));
            }
        }
        let seed = self.case.seed.wrapping_add(k as u64);
        let (out, note) = if self.dimension() == 2 {
            self.cells_in_the_plane(&here, spec, corners, seed)?
        } else {
            self.cells_in_space(&here, spec, corners, seed)?
        };
        self.samples
            .push(format!("{here}: {} Voronoi cells{note}", out.len()));
        Ok(out)
    }

    /// Makes the cells of a rectangle; also returns a note on what was changed in them.
    fn cells_in_the_plane(
        &self,
        here: &str,
        spec: &VoronoiSpec,
        [low, high]: [Vector3<f64>; 2],
        seed: u64,
    ) -> Result<(Vec<ConvexBody>, String), InputError> {
        let corners = Corners {
            low: low.xy(),
            high: high.xy(),
        };
        let (size, periodic) = (spec.size, self.assembly.periodic());
        let tiling = voronoi::tiling(&corners, periodic, size, spec.rounds, seed);
        let tiling = tiling.ok_or_else(|| self.no_room(here, size))?;
        let mut out = Vec::with_capacity(tiling.cells.len());
        let band = 0.5 * spec.gap + spec.rounding;
        for cell in &tiling.cells {
            let inner = if band > 0.0 {
                voronoi::inset(cell, band, SHORTEST * size)
            } else {
                Some(cell.clone())
            };
            let inner = inner.ok_or_else(|| self.nothing_left(here, spec))?;
            let corners: Vec<(f64, f64)> = inner.iter().map(|p| (p.x, p.y)).collect();
            // Removing a short side can turn its neighbours too far.
            let part = self.polygon(here, &corners, spec.rounding).map_err(|_| {
                let message = "a cell with several very short sides lost its shape; take another `seed`, or some `rounds`";
                self.fail(here, message)
            })?;
            out.push(ConvexBody::of(part));
        }
        let note = match tiling.merged {
            0 => String::new(),
            n => format!(
                "; {} sides shorter than {:e} m were removed",
                n.div_ceil(2),
                SHORTEST * size
            ),
        };
        Ok((out, note))
    }

    /// Creates the cells of a box; also returns a note on changes of the cells.
    fn cells_in_space(
        &self,
        here: &str,
        spec: &VoronoiSpec,
        [low, high]: [Vector3<f64>; 2],
        seed: u64,
    ) -> Result<(Vec<ConvexBody>, String), InputError> {
        let (size, periodic) = (spec.size, self.assembly.periodic());
        let corners = Corners { low, high };
        let tiling = voronoi_space::tiling(&corners, periodic, size, spec.rounds, seed);
        let short = || {
            let message = "cells keep edges shorter than a thousandth of their size; take another `seed`, or other `rounds`";
            self.fail(here, message)
        };
        let tiling = tiling.map_err(|e| match e {
            Failure::Thin => self.no_room(here, size),
            Failure::Short => short(),
        })?;
        let mut out = Vec::with_capacity(tiling.cells.len());
        let band = 0.5 * spec.gap + spec.rounding;
        for cell in tiling.cells {
            let (points, faces) = if band > 0.0 {
                voronoi_space::inset(&cell, band).ok_or_else(|| self.nothing_left(here, spec))?
            } else {
                (cell.points, cell.faces)
            };
            let core = Polyhedron::from_faces(points, faces).map_err(|_| short())?;
            out.push(ConvexBody::of(self.polyhedron(
                here,
                &core,
                spec.rounding,
            )?));
        }
        let note = match tiling.moved {
            0 => String::new(),
            n => format!(
                "; sites were moved {n} times, away from edges shorter than {:e} m",
                SHORTEST * size
            ),
        };
        Ok((out, note))
    }

    fn no_room(&self, here: &str, size: f64) -> InputError {
        let message = format!(
            "cells of {size:e} m do not fit: the region must be wider and higher{} than half of that",
            if self.dimension() == 2 {
                ""
            } else {
                " and deeper"
            }
        );
        self.fail(format!("{here}.size"), message)
    }

    fn nothing_left(&self, here: &str, spec: &VoronoiSpec) -> InputError {
        let (band, side) = (
            0.5 * spec.gap + spec.rounding,
            if self.dimension() == 2 {
                "side"
            } else {
                "face"
            },
        );
        let message = format!(
            "half the gap and the rounding take {band:e} m off each {side}, which leaves nothing of the thinnest cell; make them smaller, or make the cells more uniform with more `rounds`"
        );
        let field = if spec.rounding > 0.0 {
            "rounding"
        } else {
            "gap"
        };
        self.fail(format!("{here}.{field}"), message)
    }

    /// Creates a wall in running bond, course by course from the ground up and from left to right.
    pub(super) fn block_wall(
        &self,
        here: &str,
        spec: &BlockWallSpec,
    ) -> Result<Vec<ConvexBody>, InputError> {
        let at = self.vector(&format!("{here}.at"), &spec.at)?;
        let wide = self.length(&format!("{here}.block.0"), spec.block.0)?;
        let high = self.length(&format!("{here}.block.1"), spec.block.1)?;
        if spec.thickness.is_some() != (self.dimension() == 3) {
            let message = "the wall has a `thickness` in three dimensions, and in three alone";
            return Err(self.fail(here, message));
        }
        let thick = spec.thickness.unwrap_or(1.0);
        let thick = self.length(&format!("{here}.thickness"), thick)?;
        let gap = self.not_negative(&format!("{here}.gap"), spec.gap)?;
        if gap >= wide {
            let message = format!("must be smaller than a block ({wide:e} m), got {gap:e}");
            return Err(self.fail(format!("{here}.gap"), message));
        }
        for (name, count) in [("rows", spec.rows), ("columns", spec.columns)] {
            if count == 0 {
                return Err(self.fail(format!("{here}.{name}"), "a wall has at least one"));
            }
        }
        let blocks = spec.rows.saturating_mul(spec.columns.saturating_add(1));
        if blocks > MAX_BLOCKS {
            let message = format!("{blocks} blocks are too many");
            let fault = ValidationError::new(format!("{here}.rows"), message);
            return Err(self
                .source
                .locate(fault.expected(format!("at most {MAX_BLOCKS}"))));
        }
        let half = 0.5 * (wide - gap);
        let mut out = Vec::with_capacity(blocks);
        for row in 0..spec.rows {
            let low = row as f64 * (high + gap);
            let widths: Vec<f64> = if row % 2 == 0 {
                vec![wide; spec.columns]
            } else {
                let inner = vec![wide; spec.columns - 1];
                [vec![half], inner, vec![half]].concat()
            };
            let mut left = 0.0;
            for width in widths {
                let mut block = ConvexBody::of(self.brick(here, width, thick, high)?);
                let middle = [left + 0.5 * width, 0.5 * thick, low + 0.5 * high];
                let middle = match self.dimension() {
                    2 => Vector3::new(middle[0], middle[2], 0.0),
                    _ => Vector3::from(middle),
                };
                block.start.position = (at + middle).into();
                out.push(block);
                left += width + gap;
            }
        }
        Ok(out)
    }

    /// Makes a block of a wall, centred at the origin.
    fn brick(&self, here: &str, width: f64, thick: f64, high: f64) -> Result<AnyPart, InputError> {
        if self.dimension() == 3 {
            return self.polyhedron(here, &Polyhedron::cuboid([width, thick, high]), 0.0);
        }
        let (x, y) = (0.5 * width, 0.5 * high);
        self.polygon(here, &[(-x, -y), (x, -y), (x, y), (-x, y)], 0.0)
    }

    fn length(&self, path: &str, length: f64) -> Result<f64, InputError> {
        if length.is_finite() && length > 0.0 {
            return Ok(length);
        }
        let message = format!("a length must be positive, got {length}");
        Err(self.fail(path, message))
    }

    fn not_negative(&self, path: &str, length: f64) -> Result<f64, InputError> {
        if length.is_finite() && length >= 0.0 {
            return Ok(length);
        }
        Err(self.fail(path, format!("must not be negative, got {length}")))
    }
}
