//! A rough surface in 3D: heights on a regular grid, solid below.

use super::facets::{self, Facet};
use super::recede::{Recede, Vertex, VertexShares};
use super::shape::{ClosestPoint, Fan, Surface};
use super::space::Dim3;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Heights z on a regular grid of `nx` by `ny` points, with two triangles per cell. With `periodic`
/// the grid repeats: point nx is then the image of point 0 and is not stored.
#[derive(Debug, Clone)]
pub struct HeightField {
    nx: usize,
    ny: usize,
    spacing: [f64; 2],
    heights: Vec<f64>,
    periodic: [bool; 2],
    lowest: f64,
    highest: f64,
    /// Heights before any wear; empty without wear.
    first: Vec<f64>,
}

/// Reason why heights do not form a surface.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum HeightFieldError {
    /// Too few points.
    #[error(
        "a height field needs at least 2 by 2 points (3 along a periodic axis), got {0} by {1}"
    )]
    TooFew(usize, usize),
    /// The number of heights does not match.
    #[error("a height field of {0} by {1} points needs {2} heights, got {3}")]
    Count(usize, usize, usize, usize),
    /// A spacing or height is invalid.
    #[error("spacings of a height field must be positive and all heights finite")]
    NotFinite,
}

impl HeightField {
    /// Builds the surface; `heights[j * nx + i]` (m) is at (i dx, j dy).
    ///
    /// # Errors
    /// Wrong counts, and spacings or heights that are not finite.
    pub fn new(
        nx: usize,
        ny: usize,
        spacing: [f64; 2],
        heights: Vec<f64>,
        periodic: [bool; 2],
    ) -> Result<Self, HeightFieldError> {
        let least = |p: bool| if p { 3 } else { 2 };
        if nx < least(periodic[0]) || ny < least(periodic[1]) {
            return Err(HeightFieldError::TooFew(nx, ny));
        }
        if heights.len() != nx * ny {
            return Err(HeightFieldError::Count(nx, ny, nx * ny, heights.len()));
        }
        let usable = heights.iter().all(|z| z.is_finite())
            && spacing.iter().all(|s| s.is_finite() && *s > 0.0);
        if !usable {
            return Err(HeightFieldError::NotFinite);
        }
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Ok(Self {
            nx,
            ny,
            spacing,
            heights,
            periodic,
            lowest,
            highest,
            first: Vec::new(),
        })
    }

    fn cells(&self, axis: usize) -> i64 {
        let n = if axis == 0 { self.nx } else { self.ny } as i64;
        if self.periodic[axis] { n } else { n - 1 }
    }

    /// Returns the index of a grid point, with periodic images mapped to the stored one.
    fn vertex(&self, i: i64, j: i64) -> usize {
        let i = i.rem_euclid(self.nx as i64) as usize;
        let j = j.rem_euclid(self.ny as i64) as usize;
        j * self.nx + i
    }

    fn point(&self, i: i64, j: i64) -> V {
        let z = self.heights[self.vertex(i, j)];
        V::new(i as f64 * self.spacing[0], j as f64 * self.spacing[1], z)
    }
}

/// Returns a number that distinguishes the periodic images of a row.
fn image(i: i64) -> u64 {
    (i + (1 << 30)) as u64
}

fn triangles(i: i64, j: i64) -> [[(i64, i64); 3]; 2] {
    [
        [(i, j), (i + 1, j), (i + 1, j + 1)],
        [(i, j), (i + 1, j + 1), (i, j + 1)],
    ]
}

impl Surface<Dim3> for HeightField {
    fn closest_points(&self, centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
        let (extent, mut near) = (V::repeat(reach), Vec::new());
        self.facets(&(centre - extent), &(centre + extent), &mut near);
        facets::closest_points(&near, centre, reach, out);
    }

    fn facets(&self, low: &V, high: &V, out: &mut Vec<Facet<V>>) {
        if low.z > self.highest || high.z < self.lowest {
            return;
        }
        // One cell more, to include all triangles that meet at a point of the box.
        let range = |axis: usize| {
            let (low, high) = (
                (low[axis] / self.spacing[axis]).floor() as i64 - 1,
                (high[axis] / self.spacing[axis]).floor() as i64 + 1,
            );
            if self.periodic[axis] {
                (low, high)
            } else {
                (low.max(0), high.min(self.cells(axis) - 1))
            }
        };
        let ((i0, i1), (j0, j1)) = (range(0), range(1));
        for i in i0..=i1 {
            for j in j0..=j1 {
                let cell = self.vertex(i, j) as u32;
                for (k, corners) in triangles(i, j).into_iter().enumerate() {
                    out.push(Facet {
                        corners: corners.map(|(i, j)| self.point(i, j)),
                        names: corners.map(|(i, j)| image(i) << 32 | image(j)),
                        name: 2 * cell + k as u32,
                    });
                }
            }
        }
    }

    fn fan(&self, at: &V, within: f64, out: &mut Fan<V>) {
        let (extent, mut about) = (V::repeat(within), Vec::new());
        self.facets(&(at - extent), &(at + extent), &mut about);
        facets::fan(&about, at, within, out);
    }

    fn near(&self, centre: &V, reach: f64) -> bool {
        let within = |axis: usize| {
            let length = self.cells(axis) as f64 * self.spacing[axis];
            self.periodic[axis] || (-reach..length + reach).contains(&centre[axis])
        };
        centre.z - reach <= self.highest
            && centre.z + reach >= self.lowest
            && within(0)
            && within(1)
    }

    fn bounded(&self) -> bool {
        true
    }

    fn receding(&self) -> Option<&dyn Recede<Dim3>> {
        Some(self)
    }

    fn receding_mut(&mut self) -> Option<&mut dyn Recede<Dim3>> {
        Some(self)
    }

    fn outline(&self) -> Vec<Vec<V>> {
        let mut out = Vec::new();
        for i in 0..self.cells(0) {
            for j in 0..self.cells(1) {
                for corners in triangles(i, j) {
                    out.push(corners.iter().map(|(i, j)| self.point(*i, *j)).collect());
                }
            }
        }
        out
    }
}

impl Recede<Dim3> for HeightField {
    fn vertices(&self) -> Vec<Vertex<V>> {
        let third = self.spacing[0] * self.spacing[1] / 6.0;
        let mut tributary = vec![0.0; self.heights.len()];
        for i in 0..self.cells(0) {
            for j in 0..self.cells(1) {
                for (i, j) in triangles(i, j).into_iter().flatten() {
                    tributary[self.vertex(i, j)] += third;
                }
            }
        }
        let first = if self.first.is_empty() {
            &self.heights
        } else {
            &self.first
        };
        let vertex = |(k, tributary): (usize, f64)| {
            let mut at = self.point((k % self.nx) as i64, (k / self.nx) as i64);
            at.z = first[k];
            Vertex { at, tributary }
        };
        tributary.into_iter().enumerate().map(vertex).collect()
    }

    fn shares(&self, closest_point: &V) -> VertexShares {
        // The cell, and the position in it.
        let place = |axis: usize| {
            let x = closest_point[axis] / self.spacing[axis];
            let cell = x.floor() as i64;
            let cell = if self.periodic[axis] {
                cell
            } else {
                cell.clamp(0, self.cells(axis) - 1)
            };
            (cell, (x - cell as f64).clamp(0.0, 1.0))
        };
        let ((i, u), (j, v)) = (place(0), place(1));
        let ([lower, upper], at) = (triangles(i, j), |(i, j)| self.vertex(i, j));
        if u >= v {
            let [a, b, c] = lower.map(at);
            [(a, 1.0 - u), (b, u - v), (c, v)]
        } else {
            let [a, b, c] = upper.map(at);
            [(a, 1.0 - v), (b, u), (c, v - u)]
        }
    }

    fn recede(&mut self, depth: &[f64], named: &[usize]) -> f64 {
        if self.first.is_empty() {
            self.first.clone_from(&self.heights);
        }
        let mut step = 0.0f64;
        for k in named.iter().copied() {
            let next = self.first[k] - depth[k];
            step = step.max((self.heights[k] - next).abs());
            self.heights[k] = next;
            self.lowest = self.lowest.min(next);
        }
        step
    }

    fn sign(&self) -> f64 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn closest_points(field: &HeightField, at: [f64; 3], reach: f64) -> Vec<ClosestPoint<V>> {
        let mut out = Vec::new();
        field.closest_points(&V::from(at), reach, &mut out);
        out
    }

    #[test]
    fn a_flat_field_has_no_ghosts() {
        let flat = HeightField::new(4, 4, [1.0, 1.0], vec![0.0; 16], [true, true]).unwrap();
        for (x, y) in [
            (0.3, 0.1),
            (0.31, 0.62),
            (3.9, 3.97),
            (-5.3, 7.2),
            (1.5, 0.2),
        ] {
            let t = closest_points(&flat, [x, y, 0.8], 1.0);
            assert_eq!(t.len(), 1, "{x} {y}: {t:?}");
            assert!((t[0].normal - V::z()).norm() < 1e-15 && (t[0].distance - 0.8).abs() < 1e-15);
        }
    }

    #[test]
    fn a_summit_is_one_contact() {
        let mut z = vec![0.0; 25];
        z[12] = 1.0;
        let peak = HeightField::new(5, 5, [1.0, 1.0], z, [false, false]).unwrap();
        let t = closest_points(&peak, [2.0, 2.0, 1.5], 0.6);
        assert_eq!(t.len(), 1);
        assert!((t[0].distance - 0.5).abs() < 1e-15 && (t[0].normal - V::z()).norm() < 1e-15);
    }

    #[test]
    fn a_valley_is_touched_on_both_sides() {
        let z = (0..15).map(|k| ((k % 5) as f64 - 2.0).abs()).collect();
        let valley = HeightField::new(5, 3, [1.0, 1.0], z, [false, false]).unwrap();
        let t = closest_points(&valley, [2.0, 0.9, 0.7], 0.6);
        assert_eq!(t.len(), 2, "{t:?}");
        assert!((t[0].distance - 0.7 / 2f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn bad_fields_are_refused() {
        assert!(HeightField::new(1, 4, [1.0, 1.0], vec![0.0; 4], [false; 2]).is_err());
        assert!(HeightField::new(2, 2, [1.0, 1.0], vec![0.0; 3], [false; 2]).is_err());
        assert!(HeightField::new(2, 2, [0.0, 1.0], vec![0.0; 4], [false; 2]).is_err());
    }

    /// Volume under the triangles, each a prism.
    fn volume(field: &HeightField) -> f64 {
        let prism = |t: &Vec<V>| {
            let area = 0.5 * ((t[1] - t[0]).cross(&(t[2] - t[0]))).z;
            area * (t[0].z + t[1].z + t[2].z) / 3.0
        };
        field.outline().iter().map(prism).sum()
    }

    #[test]
    fn the_removed_volume_is_the_sum_of_the_worn_volumes() {
        for periodic in [[false, false], [true, true], [true, false]] {
            let z = (0..20).map(|k| 0.1 * f64::from(k * k % 7)).collect();
            let mut field = HeightField::new(5, 4, [0.3, 0.7], z, periodic).unwrap();
            let (before, vertices) = (volume(&field), field.vertices());
            let mut depth = vec![0.0; vertices.len()];
            let mut worn = 0.0;
            for k in 0..50 {
                let t = f64::from(k);
                let closest_point = V::new(
                    1.2 * (0.5 + 0.5 * t.sin()),
                    2.1 * (0.5 + 0.5 * (1.7 * t).cos()),
                    0.0,
                );
                for (vertex, part) in field.shares(&closest_point) {
                    assert!((0.0..=1.0).contains(&part));
                    depth[vertex] += 1e-3 * part / vertices[vertex].tributary;
                }
                worn += 1e-3;
            }
            let all: Vec<usize> = (0..depth.len()).collect();
            field.recede(&depth, &all);
            let removed = before - volume(&field);
            assert!((removed / worn - 1.0).abs() < 1e-12, "{removed} {worn}");
        }
    }
}
