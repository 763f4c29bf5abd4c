//! Thickness and extent of the collision shapes, which decide whether a motion is fast.

use super::CollisionScene;
use crate::bodies::Bodies;
use crate::geometry::convex::Core;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{fill, worth_dividing};

/// Fraction of the half thickness of the thinnest body from which the relative motion in a step
/// counts as fast.
const FAST: f64 = 0.01;
/// Approximate time to compute the displacement of a body (ns).
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
    pub(super) fn new<S: Space>(scene: &CollisionScene<S>) -> Self {
        let CollisionScene { shapes, bodies, .. } = *scene;
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
        let pieces = half_thicknesses(shapes).collect();
        Self { pieces, levers }
    }

    /// Returns the distance of the farthest point of a body that moves when the body rotates (m).
    pub(crate) fn lever(&self, body: usize) -> f64 {
        self.levers.get(body).copied().unwrap_or(0.0)
    }

    /// Recomputes both lists if the number of bodies or pieces has changed.
    pub(super) fn update<S: Space>(&mut self, scene: &CollisionScene<S>) {
        let counts = [scene.bodies.len(), scene.shapes.pieces.len()];
        if [self.levers.len(), self.pieces.len()] != counts {
            *self = Self::new(scene);
        }
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
        let (mut travels, divide) = (Vec::new(), worth_dividing(parallel, bodies.len(), TRAVEL));
        fill(divide, &mut travels, bodies.len(), of);
        travels
    }
}

/// Returns the relative motion in a step (m) from which a pair is followed through the step: a
/// fraction of the smallest half thickness, at most the alert distance `alert` (m).
pub fn fast_motion<S: Space>(shapes: &Shapes<S>, alert: f64) -> f64 {
    // Balls of radius zero are points of a body: the thickness behind them is that of the body.
    let balls = shapes.balls.iter().map(|b| b.radius).filter(|r| *r > 0.0);
    let thinnest = balls.chain(half_thicknesses(shapes));
    alert.min(FAST * thinnest.fold(f64::INFINITY, f64::min))
}

/// Smallest half thickness of each convex piece, rounding radius included (m).
fn half_thicknesses<S: Space>(shapes: &Shapes<S>) -> impl Iterator<Item = f64> + '_ {
    let pieces = shapes.pieces.iter();
    pieces.map(|p| p.core.half_thickness() + p.rounding)
}
