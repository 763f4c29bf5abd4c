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
//! iteration, with its compliance.
//!
//! An iterate in which an element would turn inside out is drawn back towards the one before. Where
//! A_k is not positive definite, what is negative of the tangent of each element is left out; that
//! slows the iterations, and changes nothing of what they lead to.
//!
//! Source: P. Wriggers, "Computational Contact Mechanics", 2nd edition (2006), chapters 2 and 10.

use crate::body::ElasticBody;
use crate::large_strain::{Forces, LargeStrain, Stretch};
use crate::matrix::{Factor, Pattern, Sparse};
use fretwork_core::bodies::SystemStep;
use fretwork_core::geometry::space::Space;
use std::sync::Arc;

/// Imbalance at which the iterations end, as a share of the forces that balance.
const TOLERANCE: f64 = 1e-10;
/// What rounding leaves of forces, as a share of stiffness times displacement.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Most iterations of a step.
const MAX_ITERATIONS: u32 = 50;
/// Most times that an iterate is drawn back by half.
const MAX_HALVINGS: u32 = 40;

/// The iterations of a step.
#[derive(Clone, Debug, Default)]
pub struct Iterate {
    /// Velocities that the step is linearised at, its internal forces there, and h^2 theta^2 K_t.
    velocity: Vec<f64>,
    forces: Forces,
    tangent: Sparse,
    /// Internal forces at the velocities that the body has now, where they are known.
    reached: Option<Forces>,
    /// Linearisations in the step.
    count: u32,
    /// Imbalance of the iterate before, and the element that last had iterates drawn back.
    imbalance: f64,
    inverted: Option<String>,
}

impl Iterate {
    /// The body has other velocities.
    pub fn moved(&mut self) {
        self.reached = None;
    }

    /// Linearisations in the step.
    pub fn count(&self) -> u32 {
        self.count
    }
}

impl<S: Space> ElasticBody<S> {
    /// Coordinates at the end of a step at final velocities.
    fn end_of(&self, step: &SystemStep<S>, velocity: &[f64]) -> Vec<f64> {
        let [q, v] = &self.start;
        let SystemStep { h, theta, .. } = *step;
        let both = v.iter().zip(velocity);
        let average = both.map(|(v, w)| (1.0 - theta) * v + theta * w);
        q.iter().zip(average).map(|(q, v)| q + h * v).collect()
    }

    /// Internal forces of a step at final velocities.
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

    /// Internal forces of a step at the velocities that the body has, with their mean: of
    /// elasticity, and of damping.
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

    /// The element that final velocities would turn inside out.
    fn inverts(&self, step: &SystemStep<S>, velocity: &[f64]) -> Option<String> {
        let large = self.model.large.as_ref()?;
        large.inverted(&self.model.mesh, &self.end_of(step, velocity))
    }

    /// Linearises a step for the first time: at the velocities of its start, or as near to them as
    /// no element is inverted.
    pub(crate) fn begin_iterations(&mut self, step: &SystemStep<S>) {
        self.iterate.count = 0;
        self.iterate.imbalance = f64::INFINITY;
        self.iterate.inverted = None;
        // Velocities at which nothing moves over the step.
        let back = (1.0 - step.theta) / step.theta;
        let still: Vec<f64> = self.start[1].iter().map(|v| -back * v).collect();
        let wanted = self.start[1].clone();
        let velocity = self.drawn_back(step, &still, wanted).unwrap_or(still);
        self.linearise_at(step, velocity, None);
    }

    /// The wanted velocities, or others between them and those of `from` at which no element is
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

    /// Linearises a step at final velocities, with its internal forces there where they are known.
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
        let mut tangent = large.tangent(&stretch, &model.stiffness, false);
        let mut formed = factor(&tangent);
        if formed.is_none() {
            tangent = large.tangent(&stretch, &model.stiffness, true);
            formed = factor(&tangent);
        }
        self.formed = Some(Arc::new(model.formed([h, theta], formed)));
        self.iterate.forces = forces.unwrap_or_else(|| large.forces(&stretch));
        self.iterate.tangent = tangent;
        self.iterate.velocity = velocity;
        self.iterate.count += 1;
    }

    /// What velocities lack of balance without contacts (N s; N s/m in 2D), on coordinates that
    /// move freely: M (v_k - v) - h (F - C v_theta - f).
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

    /// v_free of the current linearisation.
    pub(crate) fn free_velocity_at_iterate(&self, step: &SystemStep<S>) -> Vec<f64> {
        let model = &self.model;
        let at = &self.iterate;
        let SystemStep { time, h, theta, .. } = *step;
        let mut impulse = self.imbalance(step, &at.velocity, &at.forces);
        let mut end = at.velocity.clone();
        // Imposed coordinates go to their final velocity, and the tangent says what that does to
        // the others.
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

    /// Compares the forces of the step with the velocities that were reached, and linearises at
    /// these where they do not balance; false where they do.
    ///
    /// # Errors
    /// They come to no balance, or an element turns inside out.
    pub(crate) fn iterate(&mut self, step: &SystemStep<S>) -> Result<bool, String> {
        let model = Arc::clone(&self.model);
        let Some(large) = &model.large else {
            return Ok(false);
        };
        if !self.velocity.iter().all(|v| v.is_finite()) {
            // The caller looks at this itself.
            return Ok(false);
        }
        let forces = self.forces_at(large, step, &self.velocity);
        let mut lacks = self.imbalance(step, &self.velocity, &forces);
        for (lacks, p) in lacks.iter_mut().zip(&self.contact) {
            *lacks -= p;
        }
        let off = lacks.iter().map(|r| r * r).sum::<f64>().sqrt();
        let [balanced, rounding] = self.scales(step, &forces);
        // What rounding leaves is a bound: iterations go on while they gain.
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

    /// The size of what balances, and what rounding leaves of it (N s; N s/m in 2D).
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
