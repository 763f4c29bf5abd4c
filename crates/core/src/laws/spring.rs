//! Compliant contacts: unilateral springs, integrated implicitly in the standard local form.
//!
//! A law gives the normal force F and its slope k at an overlap d, the tangential force T_0 at the
//! displacement at the start of the step with its slope k_t, and dampings. Detection takes place at
//! the middle of the step, q_m; the spring acts at the overlap that the next q_m will have, -(g + h
//! u_n), over the whole step (implicit Euler: with theta = 1/2 in its place the amplification
//! factor of a stiff spring tends to -1, and layers of grains with little inertia blow up):
//!
//! ```text
//! 0 <= p_n  _|_  u_n + s_n + c_n p_n >= 0
//!     c_n = 1/(h (k h + d_n)),  s_n = (k (g + d) - F + d_n max(g, 0)/h)/(k h + d_n)
//! u_t + s_t + c_t p_t against p_t, |p_t| <= mu p_n
//!     c_t = 1/(h (k_t h + d_t)),  s_t = T_0/(k_t h + d_t)
//! ```

use crate::contact::Spring;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution};

/// A compliant contact, linearised by its law at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct SpringForm<S: Space> {
    /// Gap g of the spring at detection (m), negative where the bodies overlap.
    pub gap: f64,
    /// Overlap d at which the law was evaluated (m).
    pub overlap: f64,
    /// Normal force at that overlap (N).
    pub force_n: f64,
    /// Slope k of the normal force (N/m).
    pub stiffness_n: f64,
    /// Normal damping d_n (N s/m).
    pub damping_n: f64,
    /// Tangential force T_0 at the start of the step, along the displacement of the candidate (N).
    pub force_t: S::Tangent,
    /// Slope k_t of the tangential force (N/m); 0 for a rigid tangential contact.
    pub stiffness_t: f64,
    /// Slope of the tangential force when it unloads (N/m): displacement beyond it is slip.
    pub unloading_t: f64,
    /// Energy stored by the tangential force at the start of the step (J); 0 where it is T_0^2/(2
    /// unloading_t).
    pub energy_t: f64,
    /// Tangential damping d_t (N s/m).
    pub damping_t: f64,
}

/// Result of a compliant contact over a step.
#[derive(Clone, Copy, Debug)]
pub struct SpringStep<S: Space> {
    /// The spring at the end of the step.
    pub spring: Spring<S>,
    /// Slip (m): the part of the tangential displacement that the spring does not store.
    pub slip: S::Tangent,
    /// Energy dissipated by slip (J).
    pub friction: f64,
    /// Energy dissipated by damping (J).
    pub viscous: f64,
    /// Work against an attraction that has no opening (J).
    pub adhesion: f64,
    /// Tangential force of the spring at the end of the previous step (N).
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
        // A spring that is found compressed begins with the impulse of its static force: sweeps
        // over stiff springs of small mass build it up slowly.
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

    /// Reduces the tangential force to one that holds no more energy (J) than the spring held, plus
    /// what friction of the contact has dissipated so far. A law that raises the force, or keeps it
    /// while the spring softens, would otherwise create energy by friction.
    pub fn limit_to(&mut self, energy: f64) {
        /// Relative energy that rounding may add, where the force was rotated with its pair.
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

    /// Returns the slope of the tangential force at unloading (N/m).
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

    /// Returns the energy of the overlap at detection (J), for a spring that existed before the
    /// first step.
    pub fn initial_energy(&self) -> f64 {
        let overlap = (-self.gap).max(0.0);
        let force = self.force_n + self.stiffness_n * (overlap - self.overlap);
        self.energy(overlap, force.max(0.0))
    }

    /// Returns the energy at an overlap (J) under a force (N) that grows with a power of the
    /// overlap, as for a linear spring and Hertz' spring: F d/(1 + k d/F).
    fn energy(&self, overlap: f64, force: f64) -> f64 {
        if force > 0.0 {
            force * overlap / (1.0 + self.stiffness_n * overlap / force)
        } else {
            0.0
        }
    }

    /// Completes the step of the contact from its solution: relative velocities at the end of the
    /// step and averaged over it (m/s), and the spring before the step.
    pub fn complete(
        &self,
        form: &ContactForm<S>,
        solution: &ContactSolution<S>,
        [end, average]: [&S::Vector; 2],
        before: &Spring<S>,
        h: f64,
    ) -> SpringStep<S> {
        let mut spring = Spring::default();
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
        // The slip is zero up to the residual where the contact sticks.
        let slip = ut + form.shift_t + p * form.compliance[1];
        let stretch = ut - slip;
        let force = p * (-1.0 / h) - stretch * self.damping_t;
        let unloading = self.unloading();
        spring.force_t = force;
        let held = self.held();
        // A law whose slope differs from that of unloading slips within the contact area: the work
        // of this slip shows in the energy that the law gives for the next step.
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
        // The law changed force or stiffness of the spring between two steps.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use nalgebra::{Vector1, Vector2};

    /// A spring with a normal force of 4 N at an overlap of 0.2 m, a slope of 20 N/m, and a
    /// tangential force of 3 N.
    fn form() -> SpringForm<Dim2> {
        SpringForm {
            gap: -0.2,
            overlap: 0.2,
            force_n: 4.0,
            stiffness_n: 20.0,
            damping_n: 0.0,
            force_t: Vector1::new(3.0),
            stiffness_t: 2.0,
            unloading_t: 0.0,
            energy_t: 0.0,
            damping_t: 0.0,
        }
    }

    /// F d/(1 + k d/F) is F d/2 for a linear spring and F d/2.5 for Hertz' spring (F proportional
    /// to d^1.5). Beyond the overlap at which the law was evaluated the force follows its slope.
    #[test]
    fn a_spring_that_is_found_compressed_has_energy() {
        assert!((form().initial_energy() - 0.4).abs() < 1e-15);
        let hertz = SpringForm {
            stiffness_n: 1.5 * 4.0 / 0.2,
            ..form()
        };
        assert!((hertz.initial_energy() - 0.32).abs() < 1e-15);
        let deeper = SpringForm {
            gap: -0.3,
            ..form()
        };
        assert!((deeper.initial_energy() - 0.9).abs() < 1e-15);
        let apart = SpringForm { gap: 0.1, ..form() };
        assert_eq!(apart.initial_energy(), 0.0);
    }

    /// A force of 3 N stores 9/4 J at 2 N/m, 1/2 J at 9 N/m (the slope of unloading), and no energy
    /// at no stiffness.
    #[test]
    fn a_tangential_force_holds_its_square_over_twice_the_slope() {
        let held = |stiffness_t, unloading_t| {
            let form = SpringForm {
                stiffness_t,
                unloading_t,
                ..form()
            };
            form.tangential_energy(&form.force_t)
        };
        assert_eq!(
            (held(2.0, 0.0), held(2.0, 9.0), held(0.0, 0.0)),
            (2.25, 0.5, 0.0)
        );
    }

    /// Half the force has a quarter of the energy. A force that exceeds the limit by rounding is
    /// kept.
    #[test]
    fn a_force_that_holds_too_much_is_reduced() {
        for energy_t in [0.0, 8.0] {
            let mut form = SpringForm { energy_t, ..form() };
            let held = form.held();
            assert_eq!(held, if energy_t > 0.0 { 8.0 } else { 2.25 });
            form.limit_to(held * (1.0 - 5e-10));
            assert_eq!((form.force_t.x, form.energy_t), (3.0, energy_t));
            form.limit_to(0.25 * held);
            assert_eq!((form.force_t.x, form.energy_t), (1.5, 0.25 * energy_t));
        }
    }

    /// A gap of 0.1 m closes by 0.15 m in a step of 0.5 s. The damper of 3 N s/m acts over the
    /// overlap of 0.05 m alone and dissipates h d (0.05/h)^2; for a spring that was in contact
    /// before it acts over the whole displacement. The stored energy is that of the overlap.
    #[test]
    fn a_damper_acts_on_the_overlap() {
        let h = 0.5;
        for (gap, overlap) in [(0.1, 0.05), (-0.1, 0.25)] {
            let spring = SpringForm {
                gap,
                overlap: 0.0,
                force_n: 0.0,
                damping_n: 3.0,
                ..form()
            };
            let form = ContactForm {
                normal: Vector2::new(0.0, 1.0),
                arms: [Vector2::zeros(); 2],
                compliance: [1.0, 0.0],
                ..ContactForm::default()
            };
            let solution = ContactSolution {
                impulse: Vector2::new(0.0, 1.0),
                unilateral_n: 1.0,
                unilateral_t: Vector1::new(0.0),
            };
            let velocity = Vector2::new(0.0, -0.15 / h);
            let before = Spring::default();
            let step = spring.complete(&form, &solution, [&velocity; 2], &before, h);
            let damped = if gap > 0.0 { overlap / h } else { 0.15 / h };
            assert!((step.spring.overlap - overlap).abs() < 1e-15);
            assert!((step.viscous - h * 3.0 * damped * damped).abs() < 1e-15);
            assert!((step.spring.force_n - 20.0 * overlap).abs() < 1e-14);
            assert!((step.spring.energy[0] - 10.0 * overlap * overlap).abs() < 1e-14);
        }
    }
}
