//! Grains taken from a state of another run: positions, orientations, velocities, spins and shapes
//! as recorded there.

use super::grains::Seed;
use super::{Builder, Origin};
use crate::recorded::{Motion, ShapedBody, ShapedGrain, ShapedPiece, StateError};
use crate::sample::spec::{FrameSpec, StateSpec};
use crate::source::InputError;
use fretwork_core::geometry::convex::{Boundary, ConvexCollider, Core};
use fretwork_core::geometry::shape::Ball;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};

/// Grains other than single balls, from one entry of `grains`.
pub(super) struct Others {
    /// Index of the entry in the list.
    k: usize,
    /// Material index, and its density (kg/m^3).
    of: (u16, f64),
    /// The grains.
    grains: Vec<ShapedGrain>,
}

impl<S: Space> Builder<'_, S> {
    /// Reads the grains of a state of another run: the balls, and the grains of other shapes.
    pub(super) fn grains_of_run(
        &mut self,
        k: usize,
        spec: &StateSpec,
    ) -> Result<(Vec<Seed<S>>, Others), InputError> {
        let of = self.material(&format!("grains.{k}.material"), &spec.material)?;
        let mut path = self.folder.join(&spec.results);
        if path.is_dir() {
            path.push("results.h5");
        }
        let frame = match spec.frame {
            FrameSpec::Last => None,
            FrameSpec::Number(n) => Some(n),
        };
        let Some(reader) = self.records else {
            let message =
                "this program reads no results of other runs; hand the case a reader of them";
            return Err(self.fail(format!("grains.{k}.results"), message.to_owned()));
        };
        let read = reader(&path, frame, S::D).map_err(|e| {
            let place = match e {
                StateError::NoFrame { .. } => "frame",
                StateError::Unreadable { .. } => "results",
            };
            self.fail(format!("grains.{k}.{place}"), e.to_string())
        })?;
        let (balls, others) = (read.grains.len(), read.shaped.len());
        let which = match others {
            0 => String::new(),
            n => format!(" ({balls} balls, {n} of other shapes or that deform)"),
        };
        let deformed = read.shaped.iter().filter(|g| g.deformed.is_some()).count();
        let deform = self.case.elastic_grains.iter();
        let deform = deform.map(|e| &e.material).any(|m| *m == spec.material);
        let strain = match (deformed, deform) {
            (0, _) => String::new(),
            (n, true) => format!(", {n} with their deformation"),
            (n, false) => format!(
                ", without the deformation of {n}, which are rigid here: their strain energy and vibration are left out"
            ),
        };
        self.samples.push(format!(
            "grains.{k}: {} grains{which} of state {} of {}, {:e} s{strain}",
            balls + others,
            read.frame,
            path.display(),
            read.time
        ));
        let mut seeds = Vec::with_capacity(balls);
        for grain in &read.grains {
            let motion = &grain.motion;
            let at = S::Vector::from_slice(&motion.at);
            seeds.push(Seed {
                rotation: self.rotation(k, motion)?,
                velocity: S::Vector::from_slice(&motion.velocity),
                spin: S::Spin::from_slice(&motion.spin),
                ..Seed::still(at, grain.radius, of, Origin::Grain(k, None))
            });
        }
        let grains = read.shaped;
        Ok((seeds, Others { k, of, grains }))
    }

    fn rotation(&self, k: usize, motion: &Motion) -> Result<S::Rotation, InputError> {
        let Some(numbers) = &motion.rotation else {
            // The orientation of a ball has no effect.
            return Ok(S::identity());
        };
        S::rotation_from(numbers).ok_or_else(|| {
            let message = format!(
                "the orientation {numbers:?} of a grain is not a rotation: the file is damaged"
            );
            self.fail(format!("grains.{k}.results"), message)
        })
    }

    /// Adds the grains other than single balls.
    pub(super) fn shaped_grains(&mut self, others: Others) -> Result<(), InputError> {
        let (k, of) = (others.k, others.of);
        for grain in others.grains {
            let rotation = self.rotation(k, &grain.motion)?;
            let id = grain.body.id;
            self.shaped_grain(grain, rotation, of).map_err(|what| {
                let message = format!(
                    "the shape of grain {id} cannot be used: {what}; the file is damaged, run its case again"
                );
                self.fail(format!("grains.{k}.results"), message)
            })?;
            self.origins.push(Origin::Grain(k, None));
        }
        Ok(())
    }

    fn shaped_grain(
        &mut self,
        grain: ShapedGrain,
        rotation: S::Rotation,
        (material, density): (u16, f64),
    ) -> Result<(), String> {
        let motion = &grain.motion;
        let first = match (grain.balls.first(), grain.pieces.first()) {
            (Some(ball), _) => ball.offset,
            (None, Some(piece)) => piece.offset,
            (None, None) => [0.0; 3],
        };
        let first = S::Vector::from_slice(&first);
        let at = S::Vector::from_slice(&motion.at) - S::rotate(&rotation, &first);
        let body = self.weighing(&grain.body, at, density)?;
        if let Some(deformed) = grain.deformed {
            self.deformed.insert(body, (grain.body.id, deformed));
        }
        let b = body as usize;
        self.bodies.rotation[b] = rotation;
        self.bodies.velocity[b] = S::Vector::from_slice(&motion.velocity);
        self.bodies.spin[b] = S::Spin::from_slice(&motion.spin);
        for ball in grain.balls {
            let offset = S::Vector::from_slice(&ball.offset);
            if !(ball.radius.is_finite() && ball.radius > 0.0 && offset.is_finite()) {
                return Err(format!("a ball of it has the radius {}", ball.radius));
            }
            self.shapes.balls.push(Ball {
                body,
                radius: ball.radius,
                offset,
                material,
                area: S::Vector::zero(),
            });
        }
        for piece in grain.pieces {
            self.shapes.pieces.push(recorded(piece, body, material)?);
        }
        Ok(())
    }

    /// Adds a body with its recorded mass and inertia, scaled if the density differs.
    fn weighing(&mut self, of: &ShapedBody, at: S::Vector, density: f64) -> Result<u32, String> {
        let n = S::Spin::N;
        let entry = |i: usize, j: usize| of.inertia[3 * i + j];
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let numbers = [of.mass, of.density, of.length];
        let diagonal = (0..n).map(|i| entry(i, i));
        if !numbers.into_iter().chain(diagonal).all(positive)
            || !of.inertia.iter().all(|x| x.is_finite())
            || !at.is_finite()
        {
            return Err("its position, mass or inertia is not a valid number".to_owned());
        }
        // Exactly one if the material is the same.
        let ratio = density / of.density;
        let (mass, length) = (of.mass * ratio, of.length);
        let mut axes = [S::Spin::zero(); 3];
        for (i, axis) in axes.iter_mut().enumerate().take(n) {
            axis[i] = 1.0;
        }
        let alike =
            (0..n).all(|i| (0..n).all(|j| entry(i, j) == if i == j { entry(0, 0) } else { 0.0 }));
        Ok(if alike {
            self.bodies.add(at, mass, entry(0, 0) * ratio, length)
        } else {
            let mut inertia = S::Tensor::uniform(0.0);
            for i in 0..n {
                for j in 0..n {
                    inertia = inertia + S::Tensor::dyad(&axes[i], &axes[j]).scaled(entry(i, j));
                }
            }
            self.bodies
                .add_shaped(at, mass, &inertia.scaled(ratio), length)
        })
    }
}

/// Rebuilds a convex part of a body from the record.
fn recorded<S: Space>(
    piece: ShapedPiece,
    body: u32,
    material: u16,
) -> Result<ConvexCollider<S>, String> {
    let corners = piece.corners.iter();
    let corners: Vec<S::Vector> = corners.map(|c| S::Vector::from_slice(c)).collect();
    let farthest = corners.iter().map(VectorLike::norm).fold(0.0, f64::max);
    let core = S::Core::bounded_by(Boundary {
        corners,
        faces: piece.faces,
    })?;
    let offset = S::Vector::from_slice(&piece.offset);
    let size = piece.size;
    let known = piece.rounding.is_finite() && piece.rounding >= 0.0 && offset.is_finite();
    if !(known && size.is_finite() && size > 0.0 && farthest.is_finite()) {
        return Err("a piece of it has no size".to_owned());
    }
    Ok(ConvexCollider {
        body,
        core,
        offset,
        rounding: piece.rounding,
        bound: farthest + piece.rounding,
        size,
        material,
    })
}
