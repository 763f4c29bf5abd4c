//! Shapes of a simulation's grains for `results.h5`.

use super::results::shapes::{Shaped, ShapedBall, ShapedBody, ShapedPiece};
use fretwork_core::view::RunView;
use fretwork_scene::recorded::ShapedGrain;

/// Returns the grains other than single balls, with the densities of the materials (kg/m^3), and
/// the deformable grains without load, in the order of their systems.
pub fn of(run: &dyn RunView, densities: &[f64], deforming: &[ShapedGrain]) -> Shaped {
    let (grains, bodies) = (shaped(run), run.bodies());
    let mut out = Shaped::default();
    let mut material = vec![None; bodies.len()];
    for ball in run.balls().iter().filter(|b| grains[b.body as usize]) {
        material[ball.body as usize] = Some(ball.material);
        out.balls.push(ShapedBall {
            body: bodies.id[ball.body as usize],
            radius: ball.radius,
            offset: ball.offset,
        });
    }
    let pieces = run.pieces().into_iter().enumerate();
    for (k, piece) in pieces.filter(|(_, p)| grains[p.body as usize]) {
        material[piece.body as usize] = Some(piece.material);
        let (corners, faces) = run.piece_core(k);
        out.pieces.push(ShapedPiece {
            body: bodies.id[piece.body as usize],
            rounding: piece.rounding,
            size: piece.size,
            offset: piece.offset,
            corners,
            faces,
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
            inertia: run.inertia_tensor(b),
        });
    }
    for (grain, id) in deforming.iter().zip(ids_of_grains(run)) {
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

/// Returns the identities of the deformable grains, in the order of their systems.
fn ids_of_grains(run: &dyn RunView) -> impl Iterator<Item = u64> {
    let grains =
        (0..run.system_count()).filter(move |k| run.system(*k).is_some_and(|g| g.is_grain()));
    grains.filter_map(move |k| Some(run.bodies().id[*run.bodies_of_system(k).first()? as usize]))
}

/// Whether there are grains that are deformable or other than single balls. States then have
/// orientations.
pub fn needed(run: &dyn RunView) -> bool {
    shaped(run).contains(&true) || ids_of_grains(run).next().is_some()
}

/// Returns for each body whether it is a grain other than a single ball.
fn shaped(run: &dyn RunView) -> Vec<bool> {
    let bodies = run.bodies();
    let mut parts = vec![0u32; bodies.len()];
    for ball in run.balls() {
        // A single convex part counts as two parts, and so does a ball with an offset.
        parts[ball.body as usize] += 1 + u32::from(ball.offset != [0.0; 3]);
    }
    for piece in run.pieces() {
        parts[piece.body as usize] += 2;
    }
    for driven in bodies.driven {
        parts[driven.body as usize] = 0;
    }
    for (parts, carrier) in parts.iter_mut().zip(bodies.carriers) {
        *parts = if carrier.is_some() { 0 } else { *parts };
    }
    parts.into_iter().map(|n| n > 1).collect()
}
