//! Impulses of one contact as functions of its relative velocity, and their slopes.

use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, Elastic};

/// How an impulse changes with the relative velocity: p = p_0 - K u, where K has these values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope<S: Space> {
    /// Along the normal (kg).
    pub normal: f64,
    /// The direction of slip, a unit vector; zero where there is none.
    pub slip: S::Tangent,
    /// In the tangential plane along the slip (kg).
    pub along: f64,
    /// In the tangential plane across the slip, and in all directions without a slip (kg).
    pub across: f64,
    /// Change of friction along the slip by the normal velocity (kg): the part of K that is not
    /// symmetric.
    pub coupled: f64,
}

impl<S: Space> Slope<S> {
    /// No change.
    pub fn zero() -> Self {
        Self {
            normal: 0.0,
            slip: S::Tangent::zero(),
            along: 0.0,
            across: 0.0,
            coupled: 0.0,
        }
    }

    /// Adds the slope of a bond.
    pub fn add_bond(&mut self, normal: f64, tangential: f64) {
        self.normal += normal;
        self.along += tangential;
        self.across += tangential;
    }

    /// Whether the impulse changes with velocity.
    pub fn acts(&self) -> bool {
        self.normal != 0.0 || self.across != 0.0 || self.along != 0.0
    }

    /// Returns the tangential part of K times a tangential velocity.
    #[inline]
    pub fn apply_tangential(&self, u_t: &S::Tangent) -> S::Tangent {
        let along = self.slip.dot(u_t);
        (*u_t - self.slip * along) * self.across + self.slip * (self.along * along)
    }

    /// Returns the symmetric part of K times u, and the other part.
    #[inline]
    pub fn apply(&self, n: &S::Vector, u: &S::Vector) -> (S::Vector, S::Vector) {
        let (u_n, u_t) = (n.dot(u), S::tangential(n, u));
        let tangential = self.apply_tangential(&u_t);
        let symmetric = *n * (self.normal * u_n) + S::tangent_vector(n, &tangential);
        let coupled = S::tangent_vector(n, &(self.slip * (self.coupled * u_n)));
        (symmetric, coupled)
    }
}

/// Impulses of a bond at a relative velocity, normal and tangential, and the slope along the
/// normal.
pub(super) fn bond<S: Space>(e: &Elastic<S>, u_n: f64, u_t: &S::Tangent) -> (f64, S::Tangent, f64) {
    let (pull, tangential) = (-(e.a_n + e.b_n * u_n), -(e.a_t + *u_t * e.b_t));
    if e.tension_only && pull > 0.0 {
        (0.0, tangential, 0.0)
    } else {
        (pull, tangential, e.b_n)
    }
}

/// Impulse of a compliant contact at a relative velocity `u`, in world axes, and its slope.
pub(super) fn impulse<S: Space>(form: &ContactForm<S>, u: &S::Vector) -> (S::Vector, Slope<S>) {
    let n = &form.normal;
    let (u_n, u_t) = (n.dot(u), S::tangential(n, u));
    let mut slope = Slope::zero();
    let [c_n, c_t] = form.compliance;
    let closes = form.shift_n < f64::INFINITY && c_n > 0.0;
    let pressed = if closes {
        (form.tension - (u_n + form.shift_n) / c_n).max(0.0)
    } else {
        0.0
    };
    if pressed > 0.0 {
        slope.normal = 1.0 / c_n;
    }
    let (mut p_n, mut p_t) = (pressed - form.tension, S::Tangent::zero());
    let bound = form.friction * pressed + form.cohesion;
    if bound > 0.0 {
        let z = (u_t + form.shift_t) * (-1.0 / c_t);
        let length = z.norm();
        if length <= bound {
            p_t = z;
            (slope.along, slope.across) = (1.0 / c_t, 1.0 / c_t);
        } else {
            slope.slip = z * (1.0 / length);
            p_t = slope.slip * bound;
            slope.across = bound / (length * c_t);
            slope.coupled = form.friction * slope.normal;
        }
    }
    if let Some(e) = &form.elastic {
        let (pull, tangential, stiffness) = bond(e, u_n, &u_t);
        p_n += pull;
        p_t += tangential;
        slope.add_bond(stiffness, e.b_t);
    }
    (*n * p_n + S::tangent_vector(n, &p_t), slope)
}
