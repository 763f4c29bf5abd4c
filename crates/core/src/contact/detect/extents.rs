//! Thickness and extent of the collision shapes, which decide whether a motion is fast.

use crate::bodies::Bodies;
use crate::geometry::convex::Core;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{fill, pays};

/// Fraction of the half thickness of the thinnest body from which the relative motion in a step
/// counts as fast.
const FAST: f64 = 0.01;
/// About what the displacement of a body takes (ns).
const TRAVEL: f64 = 5.0;

/// Half thicknesses of the convex pieces, and the distance of each body's farthest point from its
/// centre.
#[derive(Clone, Debug, Default)]
pub struct Extents {
    /// Smallest half thickness of each piece, rounding radius included (m).
    pub(super) pieces: Vec<f64>,
    /// Farthest point of each body that moves when the body rotates (m); zero for centred balls.
    /// Surfaces are not included.
    pub(super) levers: Vec<f64>,
}

impl Extents {
    pub(super) fn new<S: Space>(shapes: &Shapes<S>, bodies: &Bodies<S>) -> Self {
        let mut levers = vec![0.0f64; bodies.len()];
        for ball in &shapes.balls {
            let lever = &mut levers[ball.body as usize];
            if ball.offset != S::Vector::zero() {
                *lever = lever.max(ball.offset.norm() + ball.radius);
            }
        }
        for piece in &shapes.pieces {
            let lever = &mut levers[piece.body as usize];
            *lever = lever.max(piece.offset.norm() + piece.bound);
        }
        let thickness = shapes.pieces.iter();
        Self {
            pieces: thickness
                .map(|p| p.core.half_thickness() + p.rounding)
                .collect(),
            levers,
        }
    }

    /// Returns the distance of the farthest point of a body that moves when the body rotates (m).
    pub(crate) fn lever(&self, body: usize) -> f64 {
        self.levers.get(body).copied().unwrap_or(0.0)
    }

    pub(super) fn fits<S: Space>(&self, shapes: &Shapes<S>, bodies: &Bodies<S>) -> bool {
        self.levers.len() == bodies.len() && self.pieces.len() == shapes.pieces.len()
    }

    /// Returns the largest displacement of any point of each body in `h` seconds (m), excluding
    /// surfaces that move by rotation.
    pub(super) fn travels<S: Space>(
        &self,
        bodies: &Bodies<S>,
        velocities: &[(S::Vector, S::Spin)],
        h: f64,
        parallel: bool,
    ) -> Vec<f64> {
        let of = |b: usize| {
            let ((v, w), lever) = (&velocities[b], self.levers[b]);
            let turn = if lever > 0.0 { w.norm() * lever } else { 0.0 };
            if bodies.removed[b] {
                0.0
            } else {
                h * (v.norm() + turn)
            }
        };
        let (mut travels, divide) = (Vec::new(), pays(parallel, bodies.len(), TRAVEL));
        fill(divide, &mut travels, bodies.len(), of);
        travels
    }
}

/// Returns the relative motion in a step (m) from which a pair is followed through the step: a
/// fraction of the smallest half thickness, at most the range of the alert distance.
pub fn fast_motion<S: Space>(shapes: &Shapes<S>, alert: f64) -> f64 {
    let pieces = shapes.pieces.iter();
    let pieces = pieces.map(|p| p.core.half_thickness() + p.rounding);
    let thinnest = shapes
        .balls
        .iter()
        .map(|b| b.radius)
        // A point of a surface is not thin: what is behind it belongs to its body.
        .filter(|r| *r > 0.0)
        .chain(pieces)
        .fold(f64::INFINITY, f64::min);
    alert.min(FAST * thinnest)
}
