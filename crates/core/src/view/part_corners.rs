//! Corners of the parts of grains and first bodies, for figures of their shapes in other programs.

use crate::contact::detect::{centre, piece_centre};
use crate::geometry::convex::Core;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use crate::step::fields::GrainPart;
use std::f64::consts::TAU;

/// Corners of the polygon that stands for a disk: its area is 2.6 % less.
const OF_A_DISK: usize = 16;

/// Returns the corners (m) of the parts that [`GrainPart::all`] lists, in its order: in the plane a
/// polygon, anticlockwise; in space the corners of a convex part, and the centre of anything else.
/// Their numbers do not change during a run.
pub fn of<S: Space>(s: &Simulation<S>) -> Vec<Vec<[f64; 3]>> {
    let bodies = &s.state.bodies;
    // As that of the part: in the periodic cell, and the corners about it.
    let placed = |body: u32, centre: S::Vector, arms: &[S::Vector]| {
        let rotation = &bodies.rotation[body as usize];
        let centre = s.shapes.periodic.wrapped(centre);
        let arms = arms.iter();
        arms.map(|arm| (centre + S::rotate(rotation, arm)).padded())
            .collect::<Vec<_>>()
    };
    let deforms = |body: u32| bodies.carrier(body as usize).is_some_and(|c| c.grain);
    let balls = s.shapes.balls.iter().filter(|b| !deforms(b.body));
    let mut out: Vec<_> = balls
        .map(|ball| placed(ball.body, centre(ball, bodies), &disk::<S>(ball.radius)))
        .collect();
    out.extend(s.shapes.pieces.iter().map(|piece| {
        // The rounding is divided in the axes of the body, so that its corners are as many at any
        // orientation.
        let mut arms: Vec<S::Vector> = Vec::new();
        for corner in piece.core.outline(piece.rounding).into_iter().flatten() {
            if S::D == 2 || !arms.contains(&corner) {
                arms.push(corner);
            }
        }
        placed(piece.body, piece_centre(piece, bodies), &arms)
    }));
    out.extend(GrainPart::all(s).skip(out.len()).map(|grain| {
        let surfaces = s.shapes.surfaces.iter();
        let mut own = surfaces.filter(|f| S::D == 2 && f.body == grain.body);
        let lines = own.next().map(|f| (f.offset, f.shape.outline()));
        let arms: Vec<S::Vector> = match lines {
            Some((offset, lines)) => lines.iter().flatten().map(|p| offset + *p).collect(),
            None => vec![S::Vector::zero()],
        };
        placed(grain.body, grain.centre, &arms)
    }));
    out
}

/// Returns the corners of a disk about its centre; in space, and of a point, only the centre.
fn disk<S: Space>(radius: f64) -> Vec<S::Vector> {
    if S::D == 3 || radius == 0.0 {
        return vec![S::Vector::zero()];
    }
    let turn = |k: usize| (TAU * k as f64 / OF_A_DISK as f64).sin_cos();
    let corner = |(sin, cos): (f64, f64)| S::Vector::from_slice(&[cos * radius, sin * radius, 0.0]);
    (0..OF_A_DISK).map(|k| corner(turn(k))).collect()
}
