//! Voussoirs (blocks) of an arch.

use super::Builder;
use crate::case::{Edges, GrainSpec};
use crate::source::InputError;
use fretwork_core::assembly::{ConvexBody, InitialState};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Limit on the number of blocks: a larger number is taken for a typing error.
const MAX_BLOCKS: usize = 10_000;

impl Builder<'_> {
    /// Returns the blocks of an arch between its radial joints, from right to left; an empty list
    /// for other kinds of grains.
    pub(super) fn arch(&self, here: &str, spec: &GrainSpec) -> Result<Vec<ConvexBody>, InputError> {
        let GrainSpec::Arch {
            blocks,
            radius,
            thickness,
            centre,
            span,
            edges,
            ..
        } = spec
        else {
            return Ok(Vec::new());
        };
        let centre = self.vector(&format!("{here}.centre"), centre)?;
        self.radius(&format!("{here}.radius"), *radius)?;
        if !(*thickness > 0.0 && *thickness < 2.0 * radius) {
            let message = format!(
                "must be positive and below twice the radius ({:e} m), got {thickness}",
                2.0 * radius
            );
            return Err(self.fail(format!("{here}.thickness"), message));
        }
        if !(2..=MAX_BLOCKS).contains(blocks) {
            let message = format!("an arch has 2 to {MAX_BLOCKS} blocks, got {blocks}");
            return Err(self.fail(format!("{here}.blocks"), message));
        }
        if !(*span > 0.0 && *span <= PI) {
            let message = format!("must be positive and at most pi (half a circle), got {span}");
            return Err(self.fail(format!("{here}.span"), message));
        }
        let (inner, outer) = (radius - 0.5 * thickness, radius + 0.5 * thickness);
        let step = span / *blocks as f64;
        let mut out = Vec::with_capacity(*blocks);
        for k in 0..*blocks {
            let joint = |k: usize| FRAC_PI_2 - 0.5 * span + step * k as f64;
            let (from, to) = (joint(k), joint(k + 1));
            let corner = |r: f64, angle: f64| (r * angle.cos(), r * angle.sin());
            let corners = [
                corner(inner, from),
                corner(outer, from),
                corner(outer, to),
                corner(inner, to),
            ];
            let part = self.polygon(here, &corners, 0.0)?;
            let block = ConvexBody::of(part);
            let (at, volume, inertia) = match edges {
                Edges::Straight => (Vector3::from(block.start.position), block.volume, None),
                Edges::Curved => {
                    let ([x, y], volume, inertia) = ring_piece(inner, outer, from, to);
                    (Vector3::new(x, y, 0.0), volume, Some(inertia))
                }
            };
            out.push(ConvexBody {
                volume,
                inertia,
                offset: (Vector3::from(block.start.position) - at).into(),
                start: InitialState {
                    position: (centre + at).into(),
                    ..InitialState::default()
                },
                part: block.part,
            });
        }
        Ok(out)
    }
}

/// Returns centroid, area and polar moment of area about the centroid of a ring sector between two
/// angles.
fn ring_piece(inner: f64, outer: f64, from: f64, to: f64) -> ([f64; 2], f64, f64) {
    let (angle, middle) = (to - from, 0.5 * (from + to));
    let area = 0.5 * angle * (outer * outer - inner * inner);
    let half = 0.5 * angle;
    let first = 2.0 / 3.0 * (outer.powi(3) - inner.powi(3)) * half.sin();
    let r = first / area;
    let polar = 0.25 * angle * (outer.powi(4) - inner.powi(4)) - area * r * r;
    ([r * middle.cos(), r * middle.sin()], area, polar)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_half_rings_make_a_ring() {
        let (centre, area, polar) = ring_piece(1.0, 2.0, 0.0, PI);
        assert!((area - 1.5 * PI).abs() < 1e-14);
        // Centroid of a half ring: 4 (R^3 - r^3)/(3 pi (R^2 - r^2)) above the diameter.
        assert!((centre[1] - 28.0 / (9.0 * PI)).abs() < 1e-14 && centre[0].abs() < 1e-15);
        let about = polar + area * centre[1] * centre[1];
        assert!((2.0 * about - 0.5 * PI * 15.0).abs() < 1e-13);
    }
}
