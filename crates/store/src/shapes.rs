//! Shapes of a simulation's grains for `results.h5`.

use super::results::shapes::{Shaped, ShapedBall, ShapedBody, ShapedPiece};
use fretwork_core::bodies::Bodies;
use fretwork_core::geometry::convex::Core;
use fretwork_core::geometry::shape::Ball;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_scene::recorded::ShapedGrain;

/// The grains other than single balls, with the densities of the materials (kg/m^3), and those that
/// deform as they are without load, in the order of their systems.
pub fn of<S: Space>(s: &Simulation<S>, densities: &[f64], deforming: &[ShapedGrain]) -> Shaped {
    let grains = shaped(s);
    let (bodies, shapes) = (&s.state.bodies, &s.shapes);
    let mut out = Shaped::default();
    let mut material = vec![None; bodies.len()];
    for ball in shapes.balls.iter().filter(|b| grains[b.body as usize]) {
        material[ball.body as usize] = Some(ball.material);
        out.balls.push(ShapedBall {
            body: bodies.id[ball.body as usize],
            radius: ball.radius,
            offset: ball.offset.padded(),
        });
    }
    for piece in shapes.pieces.iter().filter(|p| grains[p.body as usize]) {
        material[piece.body as usize] = Some(piece.material);
        let boundary = piece.core.boundary();
        out.pieces.push(ShapedPiece {
            body: bodies.id[piece.body as usize],
            rounding: piece.rounding,
            size: piece.size,
            offset: piece.offset.padded(),
            corners: boundary.corners.iter().map(VectorLike::padded).collect(),
            faces: boundary.faces,
        });
    }
    for (b, material) in material.into_iter().enumerate() {
        let Some(density) = material.and_then(|m| densities.get(usize::from(m))) else {
            continue;
        };
        out.bodies.push(ShapedBody {
            id: bodies.id[b],
            mass: bodies.mass[b],
            density: *density,
            length: bodies.length[b],
            inertia: inertia(bodies, b),
        });
    }
    for (grain, id) in deforming.iter().zip(ids_of_grains(s)) {
        out.bodies.push(ShapedBody { id, ..grain.body });
        let balls = grain.balls.iter().cloned();
        out.balls
            .extend(balls.map(|b| ShapedBall { body: id, ..b }));
        let pieces = grain.pieces.iter().cloned();
        out.pieces
            .extend(pieces.map(|p| ShapedPiece { body: id, ..p }));
    }
    out
}

/// Identities of the grains that deform, in the order of their systems.
fn ids_of_grains<S: Space>(s: &Simulation<S>) -> impl Iterator<Item = u64> {
    let systems = &s.state.systems;
    let grains = (0..systems.len()).filter(|k| systems.get(*k).is_some_and(|g| g.is_grain()));
    grains.filter_map(|k| Some(s.state.bodies.id[*systems.bodies(k).first()? as usize]))
}

/// Whether there are grains other than single balls, or that deform; states then have orientations.
pub fn needed<S: Space>(s: &Simulation<S>) -> bool {
    shaped(s).contains(&true) || ids_of_grains(s).next().is_some()
}

/// Which bodies are grains other than single balls.
fn shaped<S: Space>(s: &Simulation<S>) -> Vec<bool> {
    let mut parts = vec![0u32; s.state.bodies.len()];
    // A single convex part counts as two parts, and so does a ball with an offset.
    let aside = |b: &Ball<S>| 1 + u32::from(b.offset != S::Vector::zero());
    for ball in &s.shapes.balls {
        parts[ball.body as usize] += aside(ball);
    }
    for piece in &s.shapes.pieces {
        parts[piece.body as usize] += 2;
    }
    for driven in &s.state.bodies.driven {
        parts[driven.body as usize] = 0;
    }
    for (parts, carrier) in parts.iter_mut().zip(&s.state.bodies.carriers) {
        *parts = if carrier.is_some() { 0 } else { *parts };
    }
    parts.into_iter().map(|n| n > 1).collect()
}

/// Moments of inertia in the body frame (kg m^2), row by row.
fn inertia<S: Space>(bodies: &Bodies<S>, body: usize) -> [f64; 9] {
    let uniform = S::Tensor::uniform(bodies.inertia[body]);
    let own = bodies.tensors.get(body).and_then(Option::as_ref);
    let own = own.map_or(uniform, |t| *t.own());
    let n = S::Spin::N;
    std::array::from_fn(|k| {
        let (i, j) = (k / 3, k % 3);
        if i < n && j < n { own.entry(i, j) } else { 0.0 }
    })
}
