//! Samples of blocks that fit each other: Voronoi cells, and walls in running bond.

use super::polygons::Block;
use super::{Builder, Dimensional};
use crate::geometry::space::VectorLike;
use crate::scene::sample::deposit::Corners;
use crate::scene::sample::spec::{BlockWallSpec, VoronoiSpec};
use crate::scene::sample::voronoi::{SHORTEST, inset, tiling};
use crate::scene::source::{Fault, InputError};
use nalgebra::Vector2;

/// More blocks than memory holds are a slip of the keyboard.
const MOST_BLOCKS: usize = 1_000_000;
/// Lloyd's rounds change nothing that is seen after some hundred.
const MOST_ROUNDS: usize = 1_000;

impl<S: Dimensional> Builder<'_, S> {
    /// Voronoi cells of a box.
    pub(super) fn voronoi(
        &mut self,
        k: usize,
        spec: &VoronoiSpec,
    ) -> Result<Vec<Block<S>>, InputError> {
        let here = format!("grains.{k}");
        if S::D != 2 {
            let message = "Voronoi cells need two dimensions; use a Deposit of balls in three";
            return Err(self.fail(here, message));
        }
        let low = self.corner(&format!("{here}.low"), &spec.low)?;
        let high = self.corner(&format!("{here}.high"), &spec.high)?;
        if (0..2).any(|k| high[k] <= low[k]) {
            let message = "each number must be greater than that of `low`: the region has no area";
            return Err(self.fail(format!("{here}.high"), message));
        }
        let corners = Corners {
            low: Vector2::new(low[0], low[1]),
            high: Vector2::new(high[0], high[1]),
        };
        let size = self.length(&format!("{here}.size"), spec.size)?;
        let cells = corners.volume() / (size * size);
        if cells > MOST_BLOCKS as f64 {
            let message = format!("the region would hold {cells:.3e} cells of this size");
            let fault = Fault::new(format!("{here}.size"), message);
            let advice = format!("larger cells, at most {MOST_BLOCKS}");
            return Err(self.source.locate(fault.expected(advice)));
        }
        if spec.rounds > MOST_ROUNDS {
            let message = format!("at most {MOST_ROUNDS} rounds, got {}", spec.rounds);
            return Err(self.fail(format!("{here}.rounds"), message));
        }
        let gap = self.not_negative(&format!("{here}.gap"), spec.gap)?;
        let rounding = self.not_negative(&format!("{here}.rounding"), spec.rounding)?;
        if let Some(period) = self.shapes.periodic.period[0] {
            let wide = corners.high.x - corners.low.x;
            if wide > period * (1.0 + 1e-9) {
                let message =
                    format!("the region is wider than the period `periodic.x` ({period:e} m)");
                return Err(self.fail(format!("{here}.high"), message));
            }
        }
        let seed = self.case.seed.wrapping_add(k as u64);
        let made = tiling(&corners, &self.shapes.periodic, size, spec.rounds, seed);
        let Some(made) = made else {
            let message = format!(
                "cells of {size:e} m find no room: the region must be wider and higher than half of that"
            );
            return Err(self.fail(format!("{here}.size"), message));
        };
        let mut out = Vec::with_capacity(made.cells.len());
        for cell in &made.cells {
            let band = 0.5 * gap + rounding;
            let inner = if band > 0.0 {
                inset(cell, band, SHORTEST * size)
            } else {
                Some(cell.clone())
            };
            let Some(inner) = inner else {
                let message = format!(
                    "half the gap and the rounding take {band:e} m off each side, which leaves nothing of the thinnest cell; make them smaller, or the cells more alike with more `rounds`"
                );
                let field = if rounding > 0.0 { "rounding" } else { "gap" };
                return Err(self.fail(format!("{here}.{field}"), message));
            };
            let corners: Vec<(f64, f64)> = inner.iter().map(|p| (p.x, p.y)).collect();
            // A side that was taken out can turn its neighbours by too much.
            let part = self.polygon(&here, &corners, rounding).map_err(|_| {
                let message = "a cell with several very short sides lost its shape; take another `seed`, or some `rounds`";
                self.fail(here.clone(), message)
            })?;
            out.push(Block::of(part));
        }
        let short = match made.merged {
            0 => String::new(),
            n => format!(
                "; {} sides shorter than {:e} m were taken out",
                n.div_ceil(2),
                SHORTEST * size
            ),
        };
        self.samples
            .push(format!("{here}: {} Voronoi cells{short}", out.len()));
        Ok(out)
    }

    /// A wall in running bond, course by course from the ground, from left to right.
    pub(super) fn block_wall(
        &self,
        here: &str,
        spec: &BlockWallSpec,
    ) -> Result<Vec<Block<S>>, InputError> {
        let at = self.vector(&format!("{here}.at"), &spec.at)?;
        let wide = self.length(&format!("{here}.block.0"), spec.block.0)?;
        let high = self.length(&format!("{here}.block.1"), spec.block.1)?;
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
        if blocks > MOST_BLOCKS {
            let message = format!("{blocks} blocks are too many");
            let fault = Fault::new(format!("{here}.rows"), message);
            return Err(self
                .source
                .locate(fault.expected(format!("at most {MOST_BLOCKS}"))));
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
                let (x, y) = (0.5 * width, 0.5 * high);
                let part = self.polygon(here, &[(-x, -y), (x, -y), (x, y), (-x, y)], 0.0)?;
                let mut block = Block::of(part);
                block.at = at + S::Vector::from_slice(&[left + x, low + y]);
                out.push(block);
                left += width + gap;
            }
        }
        Ok(out)
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
