//! Position of a third body between the faces of two first bodies, and the bins across it.
//!
//! The face of a first body is at the mean height of its parts that face the layer, weighted by
//! their projection: the mean line of rough profiles and surfaces, the mean of the caps of balls
//! (pi/4 of the radius for disks, 2/3 for spheres), and the highest corner of convex parts.

use crate::measure::Grain;
use fretwork_core::view::RunView;
use fretwork_scene::measures::Extent;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The layer at an instant. Depths are measured from the first body's face to the second's.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Gap {
    /// Axis across it.
    pub across: usize,
    /// Coordinate along `across` at which the depth is zero (m).
    pub closest_point: f64,
    /// 1 if depth increases with the coordinate, -1 if it decreases.
    pub side: f64,
    /// Thickness of the layer (m).
    pub thickness: f64,
    /// Area of a section (m^2; m in 2D).
    pub section: f64,
    /// Number of bins.
    pub bins: usize,
}

impl Gap {
    /// Returns the depth of a point (m).
    pub fn depth(&self, at: &[f64; 3]) -> f64 {
        self.side * (at[self.across] - self.closest_point)
    }

    /// Returns the volume of a bin (m^3; m^2 in 2D).
    pub fn bin_volume(&self) -> f64 {
        self.section * self.thickness / self.bins as f64
    }

    /// Returns the cell of a depth: 0 before the first face, 1 to `bins`, one more beyond the
    /// second.
    pub fn cell(&self, depth: f64) -> usize {
        let place = (depth / self.thickness * self.bins as f64).floor();
        // NaN is mapped to the first cell.
        (place.max(-1.0) + 1.0).min(self.bins as f64 + 1.0) as usize
    }

    /// Returns the bin of a depth, from 1; depths beyond a face count in the bin at that face.
    pub fn bin(&self, depth: f64) -> usize {
        self.cell(depth).clamp(1, self.bins)
    }

    /// Returns the depth of the end of a cell (m).
    pub fn end(&self, cell: usize) -> f64 {
        self.thickness * cell as f64 / self.bins as f64
    }

    /// Distributes an object over the cells between two depths; `below` gives its fraction below a
    /// depth.
    pub fn share(
        &self,
        low: f64,
        high: f64,
        below: impl Fn(f64) -> f64,
        mut take: impl FnMut(usize, f64),
    ) {
        let (first, last) = (self.cell(low), self.cell(high));
        let mut so_far = 0.0;
        for cell in first..last {
            let now = below(self.end(cell));
            take(cell, now - so_far);
            so_far = now;
        }
        take(last, 1.0 - so_far);
    }
}

/// Tracker of the gap from step to step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Faces {
    /// Indices of the two first bodies among the driven ones.
    pub places: [usize; 2],
    /// Distance of the faces from the origins of their bodies, along `across` (m).
    offsets: [f64; 2],
    /// Lowest and highest coordinate of the grains at the last update, if they bound the layer (m).
    grains: Option<[f64; 2]>,
    gap: Gap,
}

impl Faces {
    /// Creates the tracker from the current state; `None` if a body is missing.
    pub fn new(run: &dyn RunView, names: [&str; 2], across: usize, bins: usize) -> Option<Self> {
        let driven = run.bodies().driven;
        let place = |name: &str| driven.iter().position(|d| d.name == name);
        let places = [place(names[0])?, place(names[1])?];
        let middle = places.map(|p| face(run, driven[p].body, across, 0.0));
        let side = if middle[1] < middle[0] { -1.0 } else { 1.0 };
        Some(Self {
            places,
            offsets: [0.0; 2],
            grains: None,
            gap: Gap {
                across,
                side,
                bins,
                ..Gap::default()
            },
        })
    }

    /// Returns the index of one of the two bodies.
    pub fn body(&self, run: &dyn RunView, k: usize) -> usize {
        run.bodies().driven[self.places[k]].body as usize
    }

    /// Updates the faces from the surfaces of the bodies, or from the grains if these bound the
    /// layer.
    pub fn look(&mut self, run: &dyn RunView, extent: Extent, all: &[Grain]) {
        let gap = &mut self.gap;
        let across = gap.across;
        for (k, towards) in [(0, gap.side), (1, -gap.side)] {
            let body = run.bodies().driven[self.places[k]].body;
            let here = run.bodies().position.at(body as usize)[across];
            self.offsets[k] = face(run, body, across, towards) - here;
        }
        self.grains = (extent == Extent::Grains).then(|| ends(all, across));
        gap.section = section(run, across, all);
    }

    /// The layer at the current positions, with the faces of the last update.
    pub fn gap(&self, run: &dyn RunView) -> Gap {
        let position = run.bodies().position;
        let at = |k: usize| position.at(self.body(run, k))[self.gap.across] + self.offsets[k];
        let ends = match self.grains {
            Some([low, high]) if self.gap.side > 0.0 => [low, high],
            Some([low, high]) => [high, low],
            None => [at(0), at(1)],
        };
        Gap {
            closest_point: ends[0],
            // A layer of zero thickness has no profile, but its bins must stay in order.
            thickness: (self.gap.side * (ends[1] - ends[0])).max(f64::MIN_POSITIVE),
            ..self.gap
        }
    }

    /// Returns the velocity of the first body's face, and that of the second's relative to it.
    pub fn sliding(&self, run: &dyn RunView) -> (Vector3<f64>, Vector3<f64>) {
        self.sliding_at(|k| {
            let (bodies, b) = (run.bodies(), self.body(run, k));
            [bodies.velocity.at(b), bodies.spin.at(b)]
        })
    }

    /// Returns the sliding velocity of [`Self::sliding`] at v_theta of the last step.
    pub fn sliding_over_step(&self, run: &dyn RunView) -> Vector3<f64> {
        let theta = run.options().scheme.theta;
        let started = run.started();
        let (_, before) = self.sliding_at(|k| started[self.places[k]]);
        before * (1.0 - theta) + self.sliding(run).1 * theta
    }

    fn sliding_at(&self, motion: impl Fn(usize) -> [[f64; 3]; 2]) -> (Vector3<f64>, Vector3<f64>) {
        let of = |k: usize| {
            let [velocity, spin] = motion(k).map(Vector3::from);
            let mut arm = Vector3::zeros();
            arm[self.gap.across] = self.offsets[k];
            velocity + spin.cross(&arm)
        };
        (of(0), of(1) - of(0))
    }
}

/// Returns the mean coordinate of the parts of a body that face one side along an axis, or of the
/// whole body if `towards` is 0 (m).
fn face(run: &dyn RunView, body: u32, across: usize, towards: f64) -> f64 {
    let flat = run.dimension() == 2;
    let (mut sum, mut weight) = (0.0, 0.0);
    let mut add = |w: f64, height: f64| {
        sum += w * height;
        weight += w;
    };
    let (bodies, b) = (run.bodies(), body as usize);
    let surfaces = run.surfaces().into_iter().enumerate();
    for (k, carried) in surfaces.filter(|(_, c)| c.body == body) {
        let (centre, offset) = (bodies.position.at(b), Vector3::from(carried.offset));
        let world = |p: &[f64; 3]| {
            let arm = run.turned(b, (offset + Vector3::from(*p)).into());
            Vector3::from(centre) + Vector3::from(arm)
        };
        let mut parts = Vec::new();
        for chain in run.surface_lines(k) {
            let points: Vec<Vector3<f64>> = chain.iter().map(world).collect();
            if flat {
                parts.extend(points.windows(2).map(|p| projection(p, across, flat)));
            } else {
                parts.push(projection(&points, across, flat));
            }
        }
        // The triangles of a sheet may be oriented either way.
        let looks = |sign: f64| parts.iter().any(|p| sign * towards * p.0 > 0.0);
        let sign = if looks(1.0) { 1.0 } else { -1.0 };
        for (area, height) in parts {
            let seen = if towards == 0.0 {
                area.abs()
            } else {
                (sign * towards * area).max(0.0)
            };
            add(seen, height);
        }
    }
    for ball in run.balls().into_iter().filter(|b| b.body == body) {
        let centre = ball.centre[across];
        let (area, cap) = if flat {
            (2.0 * ball.radius, PI / 4.0)
        } else {
            (PI * ball.radius * ball.radius, 2.0 / 3.0)
        };
        add(area, centre + towards * cap * ball.radius);
    }
    let pieces = run.pieces().into_iter().enumerate();
    for (k, piece) in pieces.filter(|(_, p)| p.body == body) {
        let centre = piece.centre[across];
        let corners = run.piece_outline(k).concat();
        let reach = corners.iter().map(|c| towards * c[across]);
        let reach = reach.fold(0.0, f64::max);
        add(2.0 * piece.size, centre + towards * reach);
    }
    if weight > 0.0 {
        sum / weight
    } else {
        run.bodies().position.at(body as usize)[across]
    }
}

/// Returns the signed projected area of a part of an outline along an axis, positive if it faces
/// the positive side, and its mean coordinate (m). In 2D the part is a segment with the solid on
/// its right, in 3D a polygon about its outward normal.
fn projection(points: &[Vector3<f64>], across: usize, flat: bool) -> (f64, f64) {
    let mean = points.iter().map(|p| p[across]).sum::<f64>() / points.len().max(1) as f64;
    let (i, j) = match (flat, across) {
        (true, 0) => (1, 0),
        (true, _) => (0, 1),
        (_, k) => ((k + 1) % 3, (k + 2) % 3),
    };
    if flat {
        let along = points[points.len() - 1][i] - points[0][i];
        return (if across == 0 { -along } else { along }, mean);
    }
    let next = points.iter().cycle().skip(1);
    let cross = points
        .iter()
        .zip(next)
        .map(|(a, b)| a[i] * b[j] - b[i] * a[j]);
    (0.5 * cross.sum::<f64>(), mean)
}

/// Returns the heights below and above which 1 % of the grains' mass lies (m).
fn ends(all: &[Grain], across: usize) -> [f64; 2] {
    let total: f64 = all.iter().map(|g| g.mass).sum();
    let end = |sign: f64| {
        let reach = |g: &Grain| (sign * g.at[across] - g.radius, g.mass);
        let mut sorted: Vec<(f64, f64)> = all.iter().map(reach).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut mass = 0.0;
        let found = sorted.iter().find(|g| {
            mass += g.1;
            mass > 0.01 * total
        });
        sign * found.map_or(0.0, |g| g.0)
    };
    [end(1.0), end(-1.0)]
}

/// Returns the area of a section across the layer: the period along periodic axes, otherwise the
/// extent of the grains (m^2; m in 2D).
fn section(run: &dyn RunView, across: usize, all: &[Grain]) -> f64 {
    let axes = (0..run.dimension()).filter(|k| *k != across);
    let length = |k: usize| {
        run.periodic().period[k].unwrap_or_else(|| {
            let low = all.iter().map(|g| g.at[k] - g.radius);
            let high = all.iter().map(|g| g.at[k] + g.radius);
            let length = high.fold(f64::NEG_INFINITY, f64::max) - low.fold(f64::INFINITY, f64::min);
            if length.is_finite() { length } else { 1.0 }
        })
    };
    axes.map(length).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(bins: usize) -> Gap {
        Gap {
            across: 1,
            closest_point: 0.5,
            side: 1.0,
            thickness: 2.0,
            section: 3.0,
            bins,
        }
    }

    #[test]
    fn what_is_shared_out_adds_up() {
        let gap = gap(4);
        let line = |low: f64, high: f64| move |d: f64| (d - low) / (high - low);
        let mut parts = vec![0.0; 6];
        gap.share(-0.25, 2.25, line(-0.25, 2.25), |k, share| parts[k] += share);
        for (part, exact) in parts.iter().zip([0.1, 0.2, 0.2, 0.2, 0.2, 0.1]) {
            assert!((part - exact).abs() < 1e-15, "{parts:?}");
        }
        let mut one = Vec::new();
        gap.share(0.6, 0.9, line(0.6, 0.9), |k, share| one.push((k, share)));
        assert_eq!(one, [(2, 1.0)]);
        assert_eq!(
            (gap.cell(-1.0), gap.cell(9.0), gap.bin(-1.0), gap.bin(9.0)),
            (0, 5, 1, 4)
        );
    }

    #[test]
    fn a_segment_with_the_solid_below_looks_up() {
        let (a, b) = (Vector3::new(0.0, 1.0, 0.0), Vector3::new(3.0, 2.0, 0.0));
        assert_eq!(projection(&[a, b], 1, true), (3.0, 1.5));
        assert_eq!(projection(&[b, a], 1, true), (-3.0, 1.5));
        // Going down, the right side faces smaller x.
        assert_eq!(projection(&[b, a], 0, true).0, 1.0);
        let v = |x: f64, y: f64| Vector3::new(x, y, 5.0);
        let square = [v(0.0, 0.0), v(2.0, 0.0), v(2.0, 2.0), v(0.0, 2.0)];
        assert_eq!(projection(&square, 2, false), (4.0, 5.0));
    }
}
