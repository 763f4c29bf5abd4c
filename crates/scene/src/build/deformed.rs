//! Deformable grains in two runs: their deformation in a state of another run, and their records.

use super::Builder;
use super::elastic_grains::Shapes;
use crate::recorded::{Deformed, Motion, ShapedBall, ShapedBody, ShapedGrain, ShapedPiece};
use crate::source::InputError;
use fretwork_core::assembly::SceneParts;
use fretwork_core::bodies::{Bodies, von_mises};
use fretwork_core::geometry::convex::Core;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use fretwork_elastic::grain::shape::stresses;
use fretwork_elastic::{Elasticity, GrainShape};

/// Largest difference of the position of a mesh point from the other run, relative to the size of
/// the grain.
const SAME_PLACE: f64 = 1e-6;
/// Largest difference of a stress from the other run, as a share of the largest stress of the
/// grain.
const SAME_STRESS: f64 = 1e-6;

impl Builder<'_> {
    /// Returns the displacements of the points of a grain in its frame (m) and their rates (m/s),
    /// if a state of another run has them; empty otherwise.
    pub(super) fn taken_over<S: Space>(
        &self,
        parts: &SceneParts<S>,
        body: u32,
        here: &str,
        material: &str,
        (shape, size, elasticity): (&GrainShape<S>, f64, &Elasticity),
    ) -> Result<[Vec<S::Vector>; 2], InputError> {
        let Some((id, deformed)) = self.deformed.get(&body) else {
            return Ok([Vec::new(), Vec::new()]);
        };
        let way_out = "or begin from a run in which these grains are rigid";
        let mesh = shape.mesh();
        let (points, cells) = (mesh.points().len(), mesh.elements().len());
        let Deformed {
            places,
            deformation,
            velocity,
            von_mises: recorded,
        } = deformed;
        if places.len() != points || recorded.len() != cells {
            let message = format!(
                "grain {id} of the other run has a mesh of {} points and {} elements, and of {points} and {cells} here: give `elements` as that run has it, {way_out}",
                places.len(),
                recorded.len()
            );
            return Err(self.fail(format!("{here}.elements"), message));
        }
        let numbers = [places, deformation, velocity].into_iter().flatten();
        if !numbers.flatten().chain(recorded).all(|x| x.is_finite()) {
            let message = format!(
                "grain {id} of the other run has values that are not finite: its file is damaged"
            );
            return Err(self.fail(here, message));
        }
        let b = body as usize;
        let (at, rotation) = (parts.bodies.position[b], parts.bodies.rotation[b]);
        let (moves, spin) = (parts.bodies.velocity[b], parts.bodies.spin[b]);
        let of = |numbers: &[f64; 3]| S::Vector::from_slice(numbers);
        let own = |v: S::Vector| S::unrotate(&rotation, &v);
        let displacement: Vec<S::Vector> = deformation.iter().map(|u| own(of(u))).collect();
        let without_load = places.iter().zip(&displacement).zip(mesh.points());
        let off = without_load.map(|((x, u), rest)| {
            let arm = parts.shapes.periodic.shortest(of(x) - at);
            (own(arm) - *u - *rest * size).norm()
        });
        let off = off.fold(0.0, f64::max);
        let length = parts.bodies.length[b];
        if off > SAME_PLACE * length {
            let message = format!(
                "grain {id} of the other run has another mesh than here, whose points lie elsewhere by up to {off:e} m: take the same version and shape, {way_out}"
            );
            return Err(self.fail(here, message));
        }
        let small: Vec<S::Vector> = displacement.iter().map(|u| *u * (1.0 / size)).collect();
        let stress = stresses(mesh, elasticity, &small);
        let most = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, f64::max);
        let largest = most(&mut recorded.iter().copied());
        let ours = stress.iter().map(von_mises);
        let off = most(&mut ours.clone().zip(recorded).map(|(a, b)| (a - b).abs()));
        // Rounding errors of an unloaded grain do not count as stress.
        if off > SAME_STRESS * largest.max(1e-6 * elasticity.young) {
            let message = format!(
                "grain {id} of the other run has a von Mises stress of up to {largest:e} Pa, where its deformation gives up to {:e} Pa here: give `{material}` \
                 the `young` and `poisson` of that run, {way_out}",
                most(&mut ours.clone())
            );
            return Err(self.fail(format!("{here}.material"), message));
        }
        let rates = places.iter().zip(velocity).map(|(x, v)| {
            let arm = parts.shapes.periodic.shortest(of(x) - at);
            own(of(v) - moves - S::spin_velocity(&spin, &arm))
        });
        Ok([displacement, rates.collect()])
    }

    /// Returns the record of a deformable grain without load, as if it were rigid.
    pub(super) fn unloaded<S: Space>(
        &self,
        bodies: &Bodies<S>,
        b: usize,
        own: &Shapes<'_, S>,
        material: u16,
    ) -> ShapedGrain {
        let uniform = S::Tensor::uniform(bodies.inertia[b]);
        let inertia = bodies.tensors.get(b).and_then(Option::as_ref);
        let inertia = inertia.map_or(uniform, |t| *t.own());
        let n = S::Spin::N;
        let entry = |k: usize| match (k / 3 < n, k % 3 < n) {
            (true, true) => inertia.entry(k / 3, k % 3),
            _ => 0.0,
        };
        let density = self.densities.values().find(|(k, _)| *k == material);
        let ball = |ball: &&fretwork_core::geometry::shape::Ball<S>| ShapedBall {
            body: 0,
            radius: ball.radius,
            offset: ball.offset.padded(),
        };
        let piece = |piece: &&fretwork_core::geometry::convex::ConvexCollider<S>| {
            let boundary = piece.core.boundary();
            ShapedPiece {
                body: 0,
                rounding: piece.rounding,
                size: piece.size,
                offset: piece.offset.padded(),
                corners: boundary.corners.iter().map(VectorLike::padded).collect(),
                faces: boundary.faces,
            }
        };
        ShapedGrain {
            // Identities are assigned once the scene is complete.
            body: ShapedBody {
                id: 0,
                mass: bodies.mass[b],
                density: density.map_or(1.0, |(_, density)| *density),
                length: bodies.length[b],
                inertia: std::array::from_fn(entry),
            },
            balls: own.balls.iter().map(ball).collect(),
            pieces: own.pieces.iter().map(piece).collect(),
            motion: Motion::default(),
            deformed: None,
        }
    }
}
