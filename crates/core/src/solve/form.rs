//! One contact in the standard local form, its solution, and the response of a body to impulses.

use crate::geometry::space::{MatrixLike, Space, VectorLike};

/// One contact in the standard local form. Impulses are in N s, velocities in m/s.
#[derive(Clone, Debug)]
pub struct ContactForm<S: Space> {
    /// The candidate and the antagonist (indices of bodies).
    pub bodies: [u32; 2],
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Vectors from each body's centre to the contact point (m).
    pub arms: [S::Vector; 2],
    /// Whether both arms lie along the normal and both inverse masses are isotropic.
    pub central: bool,
    /// For a central contact, whether its arms differ from the lengths of its bodies: the contact
    /// point lies in the gap between two balls, or in their overlap.
    pub apart: bool,
    /// s_n: max(g, 0)/h or e_n u_n^- (m/s).
    pub shift_n: f64,
    /// s_t: e_t u_t^- (m/s).
    pub shift_t: S::Tangent,
    /// Friction coefficient mu.
    pub friction: f64,
    /// Tensile strength impulse h c_n (N s).
    pub tension: f64,
    /// Shear cohesion impulse h c_t (N s).
    pub cohesion: f64,
    /// The single-valued (bond) part, if any.
    pub elastic: Option<Elastic<S>>,
    /// Compliance c of the unilateral part over the step, normal and tangential (1/kg): its law is
    /// in u + s + c p; zero for a rigid contact.
    pub compliance: [f64; 2],
    /// Initial impulse, in world axes (N s).
    pub impulse: S::Vector,
}

impl<S: Space> Default for ContactForm<S> {
    /// A central contact of the first two bodies on which nothing acts.
    fn default() -> Self {
        Self {
            bodies: [0, 1],
            normal: S::Vector::zero(),
            arms: [S::Vector::zero(); 2],
            central: true,
            apart: false,
            shift_n: 0.0,
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: 0.0,
            cohesion: 0.0,
            elastic: None,
            compliance: [0.0; 2],
            impulse: S::Vector::zero(),
        }
    }
}

/// Bond impulse p_el = -(a + B u); with `tension_only` the normal part vanishes where it would
/// push.
#[derive(Clone, Copy, Debug)]
pub struct Elastic<S: Space> {
    /// Normal impulse of the bond at u = 0, positive in tension (N s).
    pub a_n: f64,
    /// Tangential impulse of the bond at u = 0 (N s).
    pub a_t: S::Tangent,
    /// Normal stiffness and damping over the step (kg).
    pub b_n: f64,
    /// Tangential stiffness and damping over the step (kg).
    pub b_t: f64,
    /// Whether the normal part acts in tension only.
    pub tension_only: bool,
    /// Whether the normal part has damping.
    pub damped: bool,
    /// Whether the traction of the law is not linear in the opening, so that this form is its
    /// tangent.
    pub curved: bool,
    /// Normal dissipation of damping and time scheme over the step: loss_n u_n,th^2 + loss_t
    /// |u_t,th|^2 (kg).
    pub loss_n: f64,
    /// Tangential dissipation; see `loss_n` (kg).
    pub loss_t: f64,
}

impl<S: Space> Elastic<S> {
    /// Returns a bond without effect.
    pub fn none() -> Self {
        Self {
            a_n: 0.0,
            a_t: S::Tangent::zero(),
            b_n: 0.0,
            b_t: 0.0,
            tension_only: false,
            damped: false,
            curved: false,
            loss_n: 0.0,
            loss_t: 0.0,
        }
    }

    /// Returns the energy dissipated by damping and the time scheme in a step (J), given the
    /// opening at its start (m) and the relative velocity, its average over the step and its value
    /// at the end (m/s). `None` for a bond whose force is not linear over the step: its law is not
    /// linear, or it acts in tension only and opens, closes, or would push by its damping. The loss
    /// then follows from the stored energy.
    pub fn lost(
        &self,
        solution: &ContactSolution<S>,
        normal: &S::Vector,
        opening: f64,
        [average, after]: [&S::Vector; 2],
        h: f64,
    ) -> Option<f64> {
        let (un, ut) = (normal.dot(average), S::tangential(normal, average));
        let pulls = !self.tension_only || self.a_n + self.b_n * normal.dot(after) > 0.0;
        let opens = [opening > 0.0, opening + h * un > 0.0];
        let normal_part = if self.curved || self.tension_only && opens[0] != opens[1] {
            return None;
        } else if self.tension_only && self.damped && !opens[0] {
            // The bond stores nothing in compression, so that all the work of its damping is
            // dissipated.
            (solution.unilateral_n - normal.dot(&solution.impulse)) * un
        } else if pulls {
            self.loss_n * un * un
        } else if self.damped {
            return None;
        } else {
            0.0
        };
        Some(normal_part + self.loss_t * ut.dot(&ut))
    }
}

/// Solution of one contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactSolution<S: Space> {
    /// Total impulse p in world axes (N s).
    pub impulse: S::Vector,
    /// Normal part of p_sc (N s).
    pub unilateral_n: f64,
    /// Tangential part of p_sc (N s).
    pub unilateral_t: S::Tangent,
}

/// Response of a body to impulses.
#[derive(Clone, Copy, Debug)]
pub struct Mobility<S: Space> {
    /// Inverse mass along each axis (1/kg).
    pub mass: S::Vector,
    /// Inverse inertia tensor (1/(kg m^2)).
    pub inertia: S::Tensor,
}

impl<S: Space> Mobility<S> {
    /// Returns the velocity and angular velocity caused by an impulse and a moment.
    #[inline]
    pub fn apply(&self, p: &S::Vector, moment: &S::Spin) -> (S::Vector, S::Spin) {
        (p.scaled_by(&self.mass), self.inertia.apply(moment))
    }

    /// Returns the inverse mass or inertia of a degree of freedom, zero where it is imposed.
    pub fn along(&self, k: usize) -> f64 {
        if k < S::D {
            self.mass[k]
        } else {
            self.inertia.entry(k - S::D, k - S::D)
        }
    }

    /// Returns whether moments can rotate the body.
    pub fn turns(&self) -> bool {
        self.inertia.entry(0, 0) > 0.0
    }

    /// Returns whether the body can move.
    pub fn moves(&self) -> bool {
        self.freedoms(true) > 0
    }

    /// Returns the number of axes along which the body moves, and with `turns` also the number
    /// about which it rotates.
    pub fn freedoms(&self, turns: bool) -> usize {
        let about = if turns && self.turns() { S::Spin::N } else { 0 };
        (0..S::D).filter(|k| self.mass[*k] > 0.0).count() + about
    }

    /// Returns the largest inverse inertia about any axis, or an upper bound; exact for isotropic
    /// inertia (1/(kg m^2)).
    pub fn largest_inverse_inertia(&self) -> f64 {
        let n = S::Spin::N;
        let row = |i: usize| (0..n).map(|j| self.inertia.entry(i, j).abs()).sum::<f64>();
        (0..n).map(row).fold(0.0, f64::max)
    }

    /// Returns twice the kinetic energy of a velocity change, without imposed degrees of freedom
    /// (J).
    #[inline]
    pub fn energy(&self, dv: &S::Vector, dw: &S::Spin) -> f64 {
        let masses = (0..S::D).filter(|k| self.mass[*k] > 0.0);
        let shift: f64 = masses.map(|k| dv[k] * dv[k] / self.mass[k]).sum();
        if !self.turns() {
            return shift;
        }
        let about = self.inertia.entry(0, 0);
        if self.inertia == S::Tensor::uniform(about) {
            return shift + dw.dot(dw) / about;
        }
        shift + self.energy_of_turning(dw)
    }

    /// Returns twice the energy of a change of rotation for an anisotropic inertia (J).
    #[inline(never)]
    fn energy_of_turning(&self, dw: &S::Spin) -> f64 {
        let inertia = self.inertia.inverse();
        inertia.map_or(0.0, |i| dw.dot(&i.apply(dw)))
    }
}

/// Location of a contact's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowPlace {
    /// Place in the rows of a kind ([`super::kinds`]).
    Row {
        kind: u8,
        row: u32,
    },
    System(u32),
}
