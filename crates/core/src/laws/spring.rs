//! Compliant contacts: unilateral springs, integrated implicitly in the standard local form.
//!
//! A law gives the normal force F and its slope k at an overlap d, the tangential force T_0 at the displacement at the start
//! of the step with its slope k_t, and dampings. Detection takes place at the middle of the step, q_m; the spring acts at the overlap
//! that the next q_m will have, -(g + h u_n), over the whole step (implicit Euler: with theta = 1/2 in its place the amplification factor of a stiff
//! spring tends to -1, and layers of grains with little inertia blow up):
//!
//! ```text
//! 0 <= p_n  _|_  u_n + s_n + c_n p_n >= 0        c_n = 1/(h (k h + d_n)),  s_n = (k (g + d) - F + d_n max(g, 0)/h)/(k h + d_n)
//! u_t + s_t + c_t p_t against p_t, |p_t| <= mu p_n     c_t = 1/(h (k_t h + d_t)),  s_t = T_0/(k_t h + d_t)
//! ```

use crate::contact::Spring;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution};

/// A compliant contact, linearised by its law at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct SpringForm<S: Space> {
    /// Gap g of the spring at detection (m), negative where the bodies overlap.
    pub gap: f64,
    /// Overlap d at which the law was asked (m).
    pub overlap: f64,
    /// Normal force there (N).
    pub force_n: f64,
    /// Its slope k (N/m).
    pub stiffness_n: f64,
    /// Normal damping d_n (N s/m).
    pub damping_n: f64,
    /// Tangential force T_0 at the start of the step, along the displacement of the candidate (N).
    pub force_t: S::Tangent,
    /// Its slope k_t (N/m); 0 for a rigid tangential contact.
    pub stiffness_t: f64,
    /// Slope of the tangential force when it unloads (N/m): displacement beyond it is slip.
    pub unloading_t: f64,
    /// Energy that the tangential force holds at the start of the step (J); 0 where that is T_0^2/(2 unloading_t).
    pub energy_t: f64,
    /// Tangential damping d_t (N s/m).
    pub damping_t: f64,
}

/// What a compliant contact did in a step.
#[derive(Clone, Copy, Debug)]
pub struct SpringStep<S: Space> {
    /// The spring at the end of the step.
    pub spring: Spring<S>,
    /// Slip (m): what of the tangential displacement the spring did not take up.
    pub slip: S::Tangent,
    /// Dissipated by slip (J).
    pub friction: f64,
    /// Dissipated by damping (J).
    pub viscous: f64,
    /// Work against an attraction that has no opening (J).
    pub adhesion: f64,
    /// Tangential force of the spring at the end of the step before (N).
    pub force_before: S::Tangent,
}

impl<S: Space> SpringForm<S> {
    /// Writes compliance and shifts into a form; a law without stiffness leaves the contact open.
    pub fn apply(&self, h: f64, form: &mut ContactForm<S>) {
        let slope = self.stiffness_n * h + self.damping_n;
        if slope <= 0.0 {
            form.shift_n = f64::INFINITY;
            return;
        }
        let before_touch = self.damping_n * self.gap.max(0.0) / h;
        form.shift_n =
            (self.stiffness_n * (self.gap + self.overlap) - self.force_n + before_touch) / slope;
        form.compliance[0] = 1.0 / (h * slope);
        // A spring that is found compressed begins with the impulse that it has at rest: sweeps over stiff springs of little mass are long in
        // building it up.
        if self.gap < 0.0 && form.impulse == S::Vector::zero() {
            let at_rest = (-form.shift_n / form.compliance[0]).max(0.0);
            form.impulse = form.normal * at_rest;
        }
        let slope = self.stiffness_t * h + self.damping_t;
        if slope > 0.0 {
            form.shift_t = self.force_t * (1.0 / slope);
            form.compliance[1] = 1.0 / (h * slope);
        }
    }

    /// Reduces the tangential force to one that holds no more energy than is there: what the spring held, and what friction of the contact has
    /// taken so far (J). A law that raises the force, or keeps it while the spring grows softer, would make energy by friction.
    pub fn limit_to(&mut self, energy: f64) {
        /// Share of the energy that rounding may add, where the force turned with its pair.
        const ROUNDING: f64 = 1e-9;
        let held = self.held();
        if held > energy * (1.0 + ROUNDING) {
            self.force_t = self.force_t * (energy / held).sqrt();
            self.energy_t *= energy / held;
        }
    }

    /// The energy of the tangential force at the start of the step (J).
    fn held(&self) -> f64 {
        if self.energy_t > 0.0 {
            self.energy_t
        } else {
            self.tangential_energy(&self.force_t)
        }
    }

    /// The slope of the tangential force when it unloads (N/m).
    fn unloading(&self) -> f64 {
        if self.unloading_t > 0.0 {
            self.unloading_t
        } else {
            self.stiffness_t
        }
    }

    /// The energy of a tangential force (J).
    fn tangential_energy(&self, force: &S::Tangent) -> f64 {
        let slope = self.unloading();
        if slope > 0.0 {
            0.5 * force.dot(force) / slope
        } else {
            0.0
        }
    }

    /// Returns the energy of the overlap at detection (J), for a spring that was there before the first step.
    pub fn initial_energy(&self) -> f64 {
        let overlap = (-self.gap).max(0.0);
        let force = self.force_n + self.stiffness_n * (overlap - self.overlap);
        self.energy(overlap, force.max(0.0))
    }

    /// The energy at an overlap (J) under a force (N) that grows with a power of the overlap, as a linear spring and Hertz' do: F d/(1 + k d/F).
    fn energy(&self, overlap: f64, force: f64) -> f64 {
        if force > 0.0 {
            force * overlap / (1.0 + self.stiffness_n * overlap / force)
        } else {
            0.0
        }
    }

    /// Completes the step of the contact from its solution: relative velocities at the end of the step and averaged over it
    /// (m/s), and the spring before.
    pub fn complete(
        &self,
        form: &ContactForm<S>,
        solution: &ContactSolution<S>,
        [end, average]: [&S::Vector; 2],
        before: &Spring<S>,
        h: f64,
    ) -> SpringStep<S> {
        let mut spring = Spring::relaxed();
        let n = &form.normal;
        let un = n.dot(end);
        let pressed = solution.unilateral_n + form.tension > 0.0;
        let adhesion = form.tension * n.dot(average);
        let force_before = before.force_t;
        spring.overlap = (-(self.gap + h * un)).max(0.0);
        if spring.overlap > 0.0 {
            let change = self.stiffness_n * (spring.overlap - self.overlap);
            spring.force_n = (self.force_n + change).max(0.0);
            // The trapezium is exact for a linear spring.
            let work = 0.5 * (before.force_n + spring.force_n) * (spring.overlap - before.overlap);
            spring.energy[0] = if before.overlap > 0.0 {
                (before.energy[0] + work).max(0.0)
            } else {
                self.energy(spring.overlap, spring.force_n)
            };
        }
        let damped = if self.gap > 0.0 {
            spring.overlap / h
        } else {
            un
        };
        let mut viscous = if pressed {
            h * self.damping_n * damped * damped
        } else {
            // The bodies part faster than the spring relaxes.
            before.energy[0] - spring.energy[0]
        };
        if !pressed {
            return SpringStep {
                spring,
                slip: S::Tangent::zero(),
                friction: before.energy[1],
                viscous,
                adhesion,
                force_before,
            };
        }
        let p = solution.unilateral_t;
        if form.compliance[1] == 0.0 {
            let slip = S::tangential(n, average);
            return SpringStep {
                spring,
                slip: slip * h,
                friction: before.energy[1] - p.dot(&slip),
                viscous,
                adhesion,
                force_before,
            };
        }
        let ut = S::tangential(n, end);
        // Zero up to the residual where the contact sticks.
        let slip = ut + form.shift_t + p * form.compliance[1];
        let stretch = ut - slip;
        let force = p * (-1.0 / h) - stretch * self.damping_t;
        let unloading = self.unloading();
        spring.force_t = force;
        let held = self.held();
        // A law of another slope than that of unloading slips within the contact area: what that takes of the work shows in the energy which
        // the law gives for the next step.
        spring.energy[1] = if self.stiffness_t == unloading && self.energy_t == 0.0 {
            self.tangential_energy(&force)
        } else {
            (held + 0.5 * h * (self.force_t + force).dot(&stretch)).max(0.0)
        };
        let micro = if self.stiffness_t < unloading {
            stretch * h - (force - self.force_t) * (1.0 / unloading)
        } else {
            S::Tangent::zero()
        };
        // Where the law changed force or stiffness of the spring between two steps.
        let changed = before.energy[1] - held;
        viscous += h * self.damping_t * stretch.dot(&stretch);
        SpringStep {
            spring,
            slip: slip * h + micro,
            friction: changed - p.dot(&slip),
            viscous,
            adhesion,
            force_before,
        }
    }
}
