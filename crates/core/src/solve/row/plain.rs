//! Contact of two balls without a bond, solved in closed form: first the normal part, then the
//! tangential part within the cone.

use super::kind::RowKind;
use super::law::{LawLimits, RowLaw};
use super::motion::BallSurfaces;
use super::response::{inverse, inverse_along, shift_along};
use super::rigid_bodies::RigidBodies;
use super::state::{Parts, RowState};
use crate::geometry::space::{Space, VectorLike};
use crate::lanes::{Batch, BatchMut, Lane, LaneVector, Mask, Record};
use crate::solve::form::ContactForm;

/// Frictional contact without bond.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(in crate::solve) struct Plain<L = f64> {
    shift: L,
    iwn: L,
    iwt: L,
    mu: L,
}

// SAFETY: the struct has numbers only.
unsafe impl Record for Plain {
    type With<L: Lane> = Plain<L>;
}

impl<S: Space> RowLaw<S> for Plain {
    #[inline(always)]
    fn solve<L: Lane>(
        law: BatchMut<Self, L>,
        state: &mut RowState<S, L>,
        u: Parts<S, L>,
        relaxation: L,
    ) -> Parts<S, L> {
        let law = law.read();
        let n = law.normal(state.p.n, u.n, relaxation);
        let t = (state.p.t - u.t * (law.iwt * relaxation)).limited(law.mu * n);
        let before = std::mem::replace(&mut state.p, Parts { n, t });
        state.p - before
    }

    #[inline(always)]
    fn limits<L: Lane>(law: Batch<Self, L>) -> LawLimits<S, L> {
        let (law, zero) = (law.read(), L::all(0.0));
        LawLimits {
            mu: law.mu,
            tension: zero,
            cohesion: zero,
            rho: law.iwn.least(law.iwt),
            shift: Parts {
                n: law.shift,
                t: <S::T<L>>::zero(),
            },
            compliance: [zero; 2],
        }
    }
}

impl<L: Lane> Plain<L> {
    /// Returns the normal impulse for a normal velocity.
    #[inline(always)]
    fn normal(&self, pn: L, un: L, relaxation: L) -> L {
        let pn = pn - (un + self.shift) * (self.iwn * relaxation);
        pn.greatest(L::all(0.0))
    }
}

impl<S: Space> RowKind<S> for Plain {
    type Motion = BallSurfaces;
    const EIGHT: bool = true;
    const BONDS: bool = false;

    fn serves(contact: &ContactForm<S>) -> bool {
        contact.central
            && !contact.apart
            && contact.elastic.is_none()
            && contact.tension == 0.0
            && contact.cohesion == 0.0
            && contact.compliance == [0.0; 2]
            && contact.shift_t == S::Tangent::zero()
    }

    #[inline]
    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, BallSurfaces) {
        let [w_n, w_t] = bodies.of_balls(contact, [1.0; 2]);
        let law = Self {
            shift: shift_along(contact, w_n),
            // Any value opens a contact of bodies that are held along the normal.
            iwn: [w_n, w_t]
                .into_iter()
                .find(|w| *w > 0.0)
                .map_or(1.0, inverse),
            iwt: inverse_along(w_t, w_n),
            mu: contact.friction,
        };
        (law, BallSurfaces)
    }

    /// A frictionless contact never has a tangential impulse.
    #[inline(always)]
    fn grips(&self) -> bool {
        self.mu != 0.0
    }

    #[inline(always)]
    fn without_friction<L: Lane>(
        law: Batch<Self, L>,
        state: &mut RowState<S, L>,
        difference: &S::V<L>,
        relaxation: L,
    ) -> Option<S::V<L>> {
        let law = law.read();
        if law.mu.above(L::all(0.0)).any() {
            return None;
        }
        let pn = law.normal(state.p.n, state.n.dot(difference), relaxation);
        let before = std::mem::replace(&mut state.p.n, pn);
        Some(state.n * (pn - before))
    }
}
