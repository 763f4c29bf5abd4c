//! Grains taken from a state of another run: positions, orientations, velocities, spins and shapes
//! as recorded there.

use super::grains::NewBall;
use super::{Builder, Origin};
use crate::recorded::{Motion, ShapedBody, ShapedGrain, StateError};
use crate::sample::spec::{FrameSpec, StateSpec};
use crate::source::InputError;
use fretwork_core::assembly::{InitialState, MaterialDensity, RecordedPiece, turned};
use nalgebra::Vector3;

/// Grains other than single balls, from one entry of `grains`.
pub(super) struct ShapedEntry {
    /// Index of the entry in the list.
    k: usize,
    /// Material index, and its density (kg/m^3).
    of: MaterialDensity,
    /// The grains.
    grains: Vec<ShapedGrain>,
}

impl Builder<'_> {
    /// Reads the grains of a state of another run: the balls, and the grains of other shapes.
    pub(super) fn grains_of_run(
        &mut self,
        k: usize,
        spec: &StateSpec,
    ) -> Result<(Vec<NewBall>, ShapedEntry), InputError> {
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
        let read = reader(&path, frame, self.dimension()).map_err(|e| {
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
            seeds.push(NewBall {
                radius: grain.radius,
                of,
                start: self.start(k, motion)?,
                origin: Origin::Grain(k, None),
            });
        }
        let grains = read.shaped;
        Ok((seeds, ShapedEntry { k, of, grains }))
    }

    /// Returns position and motion of a recorded grain.
    fn start(&self, k: usize, motion: &Motion) -> Result<InitialState, InputError> {
        // The orientation of a ball has no effect.
        let known = |numbers: &[f64; 4]| turned(self.dimension(), numbers, [0.0; 3]).is_some();
        if let Some(numbers) = motion.rotation.as_ref().filter(|r| !known(r)) {
            let message = format!(
                "the orientation {numbers:?} of a grain is not a rotation: the file is damaged"
            );
            return Err(self.fail(format!("grains.{k}.results"), message));
        }
        Ok(InitialState {
            position: motion.at,
            rotation: motion.rotation,
            velocity: motion.velocity,
            spin: self.about_axes(motion.spin),
        })
    }

    /// Adds the grains other than single balls.
    pub(super) fn shaped_grains(&mut self, others: ShapedEntry) -> Result<(), InputError> {
        let (k, of) = (others.k, others.of);
        for grain in others.grains {
            let start = self.start(k, &grain.motion)?;
            let id = grain.body.id;
            self.shaped_grain(grain, start, of).map_err(|what| {
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
        mut start: InitialState,
        (material, density): MaterialDensity,
    ) -> Result<(), String> {
        let first = match (grain.balls.first(), grain.pieces.first()) {
            (Some(ball), _) => ball.offset,
            (None, Some(piece)) => piece.offset,
            (None, None) => [0.0; 3],
        };
        let arm = match &start.rotation {
            Some(rotation) => turned(self.dimension(), rotation, first).unwrap_or(first),
            None => first,
        };
        start.position = (Vector3::from(start.position) - Vector3::from(arm)).into();
        let body = self.weighing(&grain.body, &start, density)?;
        if let Some(deformed) = grain.deformed {
            self.deformed.insert(body, (grain.body.id, deformed));
        }
        for ball in grain.balls {
            self.assembly
                .carry_ball(body, ball.offset, ball.radius, material)?;
        }
        for piece in grain.pieces {
            let piece = RecordedPiece {
                rounding: piece.rounding,
                size: piece.size,
                offset: piece.offset,
                corners: piece.corners,
                faces: piece.faces,
            };
            self.assembly.carry_piece(body, piece, material)?;
        }
        Ok(())
    }

    /// Adds a body with its recorded mass and inertia, scaled if the density differs.
    fn weighing(
        &mut self,
        of: &ShapedBody,
        start: &InitialState,
        density: f64,
    ) -> Result<u32, String> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let numbers = [of.mass, of.density, of.length];
        let axes = if self.dimension() == 2 { 1 } else { 3 };
        let diagonal = (0..axes).map(|i| of.inertia[4 * i]);
        if !numbers.into_iter().chain(diagonal).all(positive)
            || !of.inertia.iter().all(|x| x.is_finite())
        {
            return Err("its position, mass or inertia is not a valid number".to_owned());
        }
        // The ratio is exactly one if the material is the same.
        let ratio = density / of.density;
        self.assembly
            .add_weighed(of.mass * ratio, &of.inertia, ratio, of.length, start)
    }
}
