//! Thermal expansion of rigid bodies, which have one temperature, and of bodies of finite elements.

use crate::geometry::convex::Core;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use std::ops::Range;

/// Returns alpha (T - T_0) from the coefficient (1/K) and the difference of temperature (K),
/// limited so that no body shrinks to less than a tenth.
pub fn free_strain(coefficient: f64, difference: f64) -> f64 {
    (coefficient * difference).max(-0.9)
}

/// A ball or a piece with the size of the case.
#[derive(Clone, Debug)]
struct ShapeAtRest<C, V> {
    core: C,
    offset: V,
    /// Radius of a ball; or rounding, bounding radius and size of a piece (m).
    lengths: [f64; 3],
    /// Whether the shape is its whole body, whose length is then its radius.
    whole: bool,
}

/// A body of finite elements that expands: its points have the free strain alpha (T - T_0).
#[derive(Clone, Debug, PartialEq)]
pub struct ExpandingSystem {
    /// Index among the dynamical systems.
    pub system: usize,
    /// Nodes of heat: one, or one for each point of its mesh.
    pub nodes: Range<usize>,
    /// Coefficient of linear expansion alpha (1/K).
    pub coefficient: f64,
    /// Temperature T_0 at which the body has no free strain (K).
    pub reference: f64,
}

/// Bodies that keep their shape and change their size with their temperature: all lengths from the
/// centre of the body are
///
/// ```text
/// lambda = 1 + alpha (T - T_0)
/// ```
///
/// those of the case times this stretch, with the coefficient of linear expansion alpha and the
/// temperature at the start T_0. Mass and inertia do not change.
#[derive(Clone, Debug)]
pub struct Expansion<S: Space> {
    /// Coefficient of linear expansion alpha of each body (1/K); 0 for a body that does not expand.
    pub coefficient: Vec<f64>,
    /// Temperature T_0 at which each body has the size of the case (K).
    pub reference: Vec<f64>,
    /// Bodies of finite elements that expand.
    pub systems: Vec<ExpandingSystem>,
    balls: Vec<ShapeAtRest<(), S::Vector>>,
    pieces: Vec<ShapeAtRest<S::Core, S::Vector>>,
}

impl<S: Space> Expansion<S> {
    /// Creates the expansion of rigid bodies with these coefficients (1/K) and lengths (m), whose
    /// current shapes are those at the temperatures `reference` (K), and of systems.
    pub fn new(
        coefficient: Vec<f64>,
        reference: Vec<f64>,
        systems: Vec<ExpandingSystem>,
        shapes: &Shapes<S>,
        lengths: &[f64],
    ) -> Self {
        let ball = shapes.balls.iter().map(|b| ShapeAtRest {
            core: (),
            offset: b.offset,
            lengths: [b.radius, 0.0, 0.0],
            whole: b.offset == S::Vector::zero() && lengths[b.body as usize] == b.radius,
        });
        let piece = shapes.pieces.iter().map(|p| ShapeAtRest {
            core: p.core.clone(),
            offset: p.offset,
            lengths: [p.rounding, p.bound, p.size],
            whole: false,
        });
        Self {
            balls: ball.collect(),
            pieces: piece.collect(),
            coefficient,
            reference,
            systems,
        }
    }

    /// Returns lambda of a body at a temperature (K).
    pub fn stretch(&self, body: usize, temperature: f64) -> f64 {
        1.0 + free_strain(self.coefficient[body], temperature - self.reference[body])
    }

    /// Scales all shapes by the stretches of their bodies, and sets the length of bodies that are a
    /// single ball to its radius; returns the largest change of a distance from a centre (m).
    pub fn apply(&self, stretch: &[f64], shapes: &mut Shapes<S>, lengths: &mut [f64]) -> f64 {
        let mut most = 0.0f64;
        for (ball, rest) in shapes.balls.iter_mut().zip(&self.balls) {
            let (body, before) = (ball.body as usize, ball.radius);
            if self.coefficient[body] == 0.0 {
                continue;
            }
            ball.radius = rest.lengths[0] * stretch[body];
            if rest.whole {
                lengths[body] = ball.radius;
            }
            let moved = rest.offset * stretch[body] - ball.offset;
            ball.offset += moved;
            most = most.max((ball.radius - before).abs() + moved.norm());
        }
        for (piece, rest) in shapes.pieces.iter_mut().zip(&self.pieces) {
            let body = piece.body as usize;
            if self.coefficient[body] == 0.0 {
                continue;
            }
            let (by, before) = (stretch[body], piece.bound);
            rest.core.scale_into(by, &mut piece.core);
            let moved = rest.offset * by - piece.offset;
            piece.offset += moved;
            [piece.rounding, piece.bound, piece.size] = rest.lengths.map(|x| x * by);
            most = most.max((piece.bound - before).abs() + moved.norm());
        }
        most
    }
}
