//! Newton's method for a body in large strain or rotation, around the contact problem of a step.
//!
//! At velocities v_k the step has the internal forces f_k and the matrix A_k = M + h theta C + h^2
//! theta^2 K_t, and its contacts are solved with
//!
//! ```text
//! v_free = v_k - A_k^-1 (M (v_k - v) - h (F - C v_theta - f_k)),   v_k+1 = v_free + A_k^-1 P^T p
//! ```
//!
//! until M (v_k+1 - v) = h (F - C v_theta - f_k+1) + P^T p. Contacts obey their laws in each
//! iteration, with the compliance of that iteration.
//!
//! An iterate in which an element would be inverted is moved back towards the previous one. Where
//! A_k is not positive definite, the negative part of the tangent of each element is left out; this
//! slows the iterations, but does not change their limit.
//!
//! Source: P. Wriggers, "Computational Contact Mechanics", 2nd edition (2006), chapters 2 and 10.

use crate::body::ElasticBody;
use crate::large_strain::{Forces, LargeStrain, Stretch};
use crate::matrix::{Factor, Pattern, Sparse};
use fretwork_core::bodies::SystemStep;
use fretwork_core::geometry::space::Space;
use std::sync::Arc;

/// Imbalance at which the iterations end, relative to the balanced forces.
const TOLERANCE: f64 = 1e-10;
/// Rounding error of forces, relative to stiffness times displacement.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Largest number of iterations of a step.
const MAX_ITERATIONS: u32 = 50;
/// Largest number of times that an iterate is moved back by half.
const MAX_HALVINGS: u32 = 40;

/// The iterations of a step.
#[derive(Clone, Debug, Default)]
pub struct Iterate {
    /// Velocities at which the step is linearised, its internal forces there, and h^2 theta^2 K_t.
    velocity: Vec<f64>,
    forces: Forces,
    tangent: Sparse,
    /// Internal forces at the current velocities of the body, if computed.
    reached: Option<Forces>,
    /// Number of linearisations in the step.
    count: u32,
    /// Imbalance of the previous iterate, and the last element because of which an iterate was
    /// moved back.
    imbalance: f64,
    inverted: Option<String>,
}

impl Iterate {
    /// Discards the forces, since the body has other velocities.
    pub fn moved(&mut self) {
        self.reached = None;
    }

    /// Returns the number of linearisations in the step.
    pub fn count(&self) -> u32 {
        self.count
    }
}

impl<S: Space> ElasticBody<S> {
    /// Returns the coordinates at the end of a step with given final velocities.
    fn end_of(&self, step: &SystemStep<S>, velocity: &[f64]) -> Vec<f64> {
        let [q, v] = &self.start;
        let SystemStep { h, theta, .. } = *step;
        let both = v.iter().zip(velocity);
        let average = both.map(|(v, w)| (1.0 - theta) * v + theta * w);
        q.iter().zip(average).map(|(q, v)| q + h * v).collect()
    }

    /// Returns the internal forces of a step with given final velocities.
    fn forces_at(&self, large: &LargeStrain<S>, step: &SystemStep<S>, velocity: &[f64]) -> Forces {
        let end = self.end_of(step, velocity);
        large.forces(&Stretch {
            start: &self.start[0],
            end: &end,
            h: step.h,
            theta: step.theta,
            free_strain: &self.free_strain.of_elements,
        })
    }

    /// Returns the internal forces of a step at the current velocities, with the mean velocities:
    /// of elasticity, and of damping.
    pub(crate) fn internal_of_step(
        &self,
        large: &LargeStrain<S>,
        step: &SystemStep<S>,
        average: &[f64],
    ) -> [Vec<f64>; 2] {
        let mut forces = match &self.iterate.reached {
            Some(forces) => forces.clone(),
            None => self.forces_at(large, step, &self.velocity),
        };
        self.model.add_mass_damping(average, &mut forces.viscous);
        [forces.elastic, forces.viscous]
    }

    /// Returns the element that final velocities would invert.
    fn inverts(&self, step: &SystemStep<S>, velocity: &[f64]) -> Option<String> {
        let large = self.model.large.as_ref()?;
        large.inverted(&self.model.mesh, &self.end_of(step, velocity))
    }

    /// Linearises a step for the first time: at the velocities of its start, or as near to them as
    /// possible without an inverted element.
    pub(crate) fn begin_iterations(&mut self, step: &SystemStep<S>) {
        self.iterate.count = 0;
        self.iterate.imbalance = f64::INFINITY;
        self.iterate.inverted = None;
        // With these velocities nothing moves over the step.
        let back = (1.0 - step.theta) / step.theta;
        let still: Vec<f64> = self.start[1].iter().map(|v| -back * v).collect();
        let wanted = self.start[1].clone();
        let velocity = self.drawn_back(step, &still, wanted).unwrap_or(still);
        self.linearise_at(step, velocity, None);
    }

    /// Returns the wanted velocities, or velocities between them and `from` at which no element is
    /// inverted.
    fn drawn_back(
        &self,
        step: &SystemStep<S>,
        from: &[f64],
        mut wanted: Vec<f64>,
    ) -> Result<Vec<f64>, String> {
        let mut why = String::new();
        for _ in 0..MAX_HALVINGS {
            match self.inverts(step, &wanted) {
                None => return Ok(wanted),
                Some(place) => why = place,
            }
            for (wanted, from) in wanted.iter_mut().zip(from) {
                *wanted = 0.5 * (*wanted + from);
            }
        }
        Err(why)
    }

    /// Linearises a step at final velocities, with its internal forces there if known.
    fn linearise_at(&mut self, step: &SystemStep<S>, velocity: Vec<f64>, forces: Option<Forces>) {
        let model = Arc::clone(&self.model);
        let Some(large) = &model.large else { return };
        let SystemStep { h, theta, .. } = *step;
        let end = self.end_of(step, &velocity);
        let stretch = Stretch {
            start: &self.start[0],
            end: &end,
            h,
            theta,
            free_strain: &self.free_strain.of_elements,
        };
        let inertia = 1.0 + h * theta * model.damping.mass;
        let free = model.freedoms.free;
        let diagonal: Vec<f64> = model.mass[..free].iter().map(|m| m * inertia).collect();
        let factor = |tangent: &Sparse| -> Option<Factor> {
            let a = tangent.leading(free, (h * theta).powi(2), &diagonal);
            let pattern = large.pattern.get_or_init(|| Pattern::of(&a));
            pattern.as_ref()?.factor(&a)
        };
        let mut tangent = large.tangent(&stretch, &model.stiffness);
        let mut formed = factor(&tangent);
        if formed.is_none() {
            tangent = large.positive_tangent(&stretch, &model.stiffness);
            formed = factor(&tangent);
        }
        self.formed = Some(Arc::new(model.formed([h, theta], formed)));
        self.iterate.forces = forces.unwrap_or_else(|| large.forces(&stretch));
        self.iterate.tangent = tangent;
        self.iterate.velocity = velocity;
        self.iterate.count += 1;
    }

    /// Returns the imbalance without contacts at given velocities (N s; N s/m in 2D), on
    /// coordinates that move freely: M (v_k - v) - h (F - C v_theta - f).
    fn imbalance(&self, step: &SystemStep<S>, velocity: &[f64], forces: &Forces) -> Vec<f64> {
        let model = &self.model;
        let SystemStep { h, theta, .. } = *step;
        let mut out: Vec<f64> = (0..model.freedoms.free)
            .map(|c| {
                let (before, after) = (self.start[1][c], velocity[c]);
                let average = (1.0 - theta) * before + theta * after;
                let gravity = step.gravity[usize::from(model.freedoms.axis[c])];
                let inertia = after - before + h * (model.damping.mass * average - gravity);
                model.mass[c] * inertia + h * (forces.elastic[c] + forces.viscous[c])
            })
            .collect();
        for (c, drive) in model.freedoms.forces(&self.drives) {
            out[c] -= h * Self::force(drive, step);
        }
        out
    }

    /// Returns v_free of the current linearisation.
    pub(crate) fn free_velocity_at_iterate(&self, step: &SystemStep<S>) -> Vec<f64> {
        let model = &self.model;
        let at = &self.iterate;
        let SystemStep { time, h, theta, .. } = *step;
        let mut impulse = self.imbalance(step, &at.velocity, &at.forces);
        let mut end = at.velocity.clone();
        // Imposed coordinates get their final velocity, whose effect on the others follows from the
        // tangent.
        let mut change = vec![0.0; end.len()];
        for (c, drive) in model.freedoms.imposed(&self.drives) {
            let drive = drive.over(time, h);
            if let Some(speeds) = drive.speeds(time, h, theta) {
                change[c] = speeds.end - end[c];
                end[c] = speeds.end;
            }
        }
        let pulled = at.tangent.times(&change);
        for (lacks, pulled) in impulse.iter_mut().zip(&pulled) {
            *lacks = -*lacks - (h * theta).powi(2) * pulled;
        }
        match &self.formed {
            Some(formed) => formed.solve(&mut impulse),
            None => impulse.fill(f64::NAN),
        }
        for (v, dv) in end.iter_mut().zip(&impulse) {
            *v += dv;
        }
        end
    }

    /// Compares the forces of the step with those at the reached velocities, and linearises at
    /// these where they do not balance; returns false where they do.
    ///
    /// # Errors
    /// The iterations do not converge, or an element is inverted.
    pub(crate) fn iterate(&mut self, step: &SystemStep<S>) -> Result<bool, String> {
        let model = Arc::clone(&self.model);
        let Some(large) = &model.large else {
            return Ok(false);
        };
        if !self.velocity.iter().all(|v| v.is_finite()) {
            // The caller handles this case.
            return Ok(false);
        }
        let forces = self.forces_at(large, step, &self.velocity);
        let mut lacks = self.imbalance(step, &self.velocity, &forces);
        for (lacks, p) in lacks.iter_mut().zip(&self.contact) {
            *lacks -= p;
        }
        let off = lacks.iter().map(|r| r * r).sum::<f64>().sqrt();
        let [balanced, rounding] = self.scales(step, &forces);
        // Rounding is a limit: iterations continue as long as they reduce the imbalance.
        let gains = off < 0.5 * self.iterate.imbalance;
        self.iterate.imbalance = off;
        if off <= TOLERANCE * balanced || (off <= rounding && !gains) {
            if let Some(place) = self.inverts(step, &self.velocity) {
                return Err(inside_out(&place));
            }
            self.iterate.reached = Some(forces);
            return Ok(false);
        }
        self.iterate.inverted = self.inverts(step, &self.velocity);
        if self.iterate.inverted.is_none() {
            self.linearise_at(step, self.velocity.clone(), Some(forces));
        } else {
            let next = self.drawn_back(step, &self.iterate.velocity, self.velocity.clone());
            self.linearise_at(step, next.map_err(|place| inside_out(&place))?, None);
        }
        let definite = self.formed.as_ref().is_some_and(|f| f.factor.is_some());
        if self.iterate.count <= MAX_ITERATIONS && definite {
            return Ok(true);
        }
        Err(match &self.iterate.inverted {
            Some(place) => inside_out(place),
            None => format!(
                "forces and motion are out of balance by {:.1e} of the forces after {} iterations of Newton's method; \
                 take a shorter time.step, or load it more slowly",
                off / balanced,
                self.iterate.count - 1
            ),
        })
    }

    /// Returns the magnitude of the balanced forces, and its rounding error (N s; N s/m in 2D).
    fn scales(&self, step: &SystemStep<S>, forces: &Forces) -> [f64; 2] {
        let model = &self.model;
        let h = step.h;
        let largest = |q: &[f64]| q.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
        let moved = largest(&self.start[0]).max(largest(&self.end_of(step, &self.velocity)));
        let (mut balanced, mut rounded) = (0.0, 0.0);
        for c in 0..model.freedoms.free {
            let (before, after) = (self.start[1][c], self.velocity[c]);
            let momentum = model.mass[c] * (after - before);
            let stiff = model
                .stiffness
                .slot(c, c)
                .map_or(0.0, |k| model.stiffness.values()[k]);
            balanced += (h * forces.size[c]).powi(2) + momentum.powi(2) + self.contact[c].powi(2);
            rounded += (h * stiff * moved).powi(2)
                + (model.mass[c] * (before.abs() + after.abs())).powi(2);
        }
        for (_, drive) in model.freedoms.forces(&self.drives) {
            balanced += (h * Self::force(drive, step)).powi(2);
        }
        [f64::sqrt(balanced), ROUNDING * f64::sqrt(rounded)]
    }
}

fn inside_out(place: &str) -> String {
    format!(
        "the element that is at {place} m without load would turn inside out; take a shorter time.step, load it more slowly, or make \
         its elements larger"
    )
}
