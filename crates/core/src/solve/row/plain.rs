//! Contact of two balls without a bond, solved in closed form.

use super::{
    LocalImpulse, Residual, Row, SolverBody, inverse, inverse_along, natural_map, push, relative,
    shift_along,
};
use crate::geometry::space::{Space, VectorLike, greatest, least};
use crate::solve::form::{ContactForm, ContactSolution};

/// Frictional contact without bond. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct PlainRow<S: Space> {
    n: S::Vector,
    pn: f64,
    pt: S::Tangent,
    shift: f64,
    iwn: f64,
    iwt: f64,
    mu: f64,
    bodies: [u32; 2],
}

impl<S: Space> PlainRow<S> {
    pub fn new(contact: &ContactForm<S>, w_n: f64, w_t: f64) -> Self {
        let n = contact.normal;
        Self {
            bodies: contact.bodies,
            n,
            pn: n.dot(&contact.impulse),
            // A frictionless contact never has a tangential impulse.
            pt: grip::<S>(&n, &contact.impulse, contact.friction),
            shift: shift_along(contact, w_n),
            // Any answer opens a contact of bodies that are held along the normal.
            iwn: [w_n, w_t]
                .into_iter()
                .find(|w| *w > 0.0)
                .map_or(1.0, inverse),
            iwt: inverse_along(w_t, w_n),
            mu: contact.friction,
        }
    }

    /// Returns a row of a contact between immovable bodies.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn idle() -> Self {
        Self::new(&ContactForm::idle(), 0.0, 0.0)
    }
}

/// Returns the tangential part of an initial impulse; zero without friction.
fn grip<S: Space>(n: &S::Vector, impulse: &S::Vector, mu: f64) -> S::Tangent {
    if mu == 0.0 {
        S::Tangent::zero()
    } else {
        S::tangential(n, impulse)
    }
}

impl<S: Space> Row<S> for PlainRow<S> {
    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    #[inline(always)]
    fn update(&mut self, a: &mut SolverBody<S>, b: &mut SolverBody<S>, relaxation: f64) {
        if self.mu == 0.0 {
            let un = self.n.dot(&(a.v - b.v));
            let pn = greatest(self.pn - (un + self.shift) * (self.iwn * relaxation), 0.0);
            let impulse = self.n * (pn - self.pn);
            a.v += impulse * a.im;
            b.v -= impulse * b.im;
            self.pn = pn;
            return;
        }
        let (un, ut) = relative(&self.n, a, b);
        let pn = greatest(self.pn - (un + self.shift) * (self.iwn * relaxation), 0.0);
        let pt = (self.pt - ut * (self.iwt * relaxation)).limited(self.mu * pn);
        push(&self.n, pn - self.pn, pt - self.pt, a, b);
        self.pn = pn;
        self.pt = pt;
    }

    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        push(&self.n, self.pn, self.pt, a, b);
    }

    #[inline(always)]
    fn local_impulse(&self) -> LocalImpulse<S> {
        (self.pn, self.pt)
    }

    #[inline(always)]
    fn set_local_impulse(&mut self, parts: LocalImpulse<S>) {
        (self.pn, self.pt) = parts;
    }

    fn set(&mut self, impulse: &S::Vector) {
        self.pn = self.n.dot(impulse);
        self.pt = grip::<S>(&self.n, impulse, self.mu);
    }

    fn speed(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let (un, ut) = relative(&self.n, a, b);
        un * un + ut.dot(&ut)
    }

    fn friction(&self) -> f64 {
        self.mu
    }

    #[inline(always)]
    fn rho(&self) -> f64 {
        least(self.iwn, self.iwt)
    }

    #[inline(always)]
    fn residual(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> Residual {
        let (un, ut) = relative(&self.n, a, b);
        let rho = self.rho();
        if rho > 0.0 {
            natural_map(
                (self.pn, self.pt),
                (un, ut),
                (self.shift, S::Tangent::zero()),
                rho,
                self.mu,
                0.0,
            )
        } else {
            Residual::default()
        }
    }

    fn solution(&self, _: &SolverBody<S>, _: &SolverBody<S>) -> ContactSolution<S> {
        ContactSolution {
            impulse: self.n * self.pn + S::tangent_vector(&self.n, &self.pt),
            unilateral_n: self.pn,
            unilateral_t: self.pt,
        }
    }
}
