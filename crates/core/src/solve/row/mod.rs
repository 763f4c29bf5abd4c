//! Contacts in rows, over which the solver iterates, and the exact solution of one contact.
//!
//! A row has a [`State`] (normal and impulse), a [`Law`] and the [`Motion`] of its two bodies; a
//! [`Kind`] is the pair of the last two. Each is written once, over lanes: the same source is
//! compiled for one contact and for several at a time. A contact of two balls has W_nt = 0, W_nn =
//! 1/m_i + 1/m_j and an isotropic W_tt, so that its law is solved in closed form, part by part;
//! with lever arms it has a full block of W.

mod block;
mod cone;
mod full;
mod law;
mod moment;
mod motion;
mod plain;
mod rigid_bodies;
mod solver_bodies;
mod state;
mod system;
#[cfg(test)]
mod tests;
mod visit;

pub(super) use block::{Bonded, Unbonded};
pub(super) use cone::HELD;
pub(super) use full::Full;
pub use moment::{MomentForm, MomentSolution};
pub(super) use moment::{MomentRow, turning};
pub(super) use plain::Plain;
pub(super) use rigid_bodies::RigidBodies;
pub(super) use solver_bodies::SolverBodies;
pub(super) use state::{Moving, Parts};
pub(super) use system::{SystemRow, Term};
pub(super) use visit::{Free, Load, Measure, Update, Visit, noise, visit};

use super::error::Residual;
use super::form::{ContactForm, ContactSolution, Mobility};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::lanes::{Batch, BatchMut, Lane, LaneVector, part, part_mut};
use law::Law;
use motion::Motion;
use state::State;

/// Velocity record of a body in the solver: 64 bytes in both dimensions.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct SolverBody<S: Space> {
    /// Velocity of the centre (m/s).
    pub v: S::Vector,
    /// Angular velocity times the body's length (m/s).
    pub s: S::Spin,
    /// Inverse mass, the largest of all axes (1/kg).
    pub im: f64,
    /// Inverse inertia times the length squared, the largest about any axis (1/kg).
    pub is: f64,
}

/// A kind of contacts between two rigid bodies: a law that is solved in closed form, and how the
/// bodies move.
pub(super) trait Kind<S: Space>: Law<S> {
    type Motion: Motion<S>;
    /// Whether in space eight contacts at a time are quicker than four, because registers suffice.
    const EIGHT: bool = false;
    /// Whether bonds may act on its contacts.
    const BONDS: bool;

    /// Whether a contact can be of this kind.
    fn serves(contact: &ContactForm<S>) -> bool;
    /// The law and the motion of a contact. The bodies are looked up.
    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, Self::Motion);
    /// Whether a contact may have a tangential impulse.
    fn grips(&self) -> bool {
        true
    }
    /// Where none of the contacts has friction, and their bodies do not turn: solves them for the
    /// difference of the velocities of the centres; gives the change of the impulses in world axes.
    #[inline(always)]
    fn without_friction<L: Lane>(
        _law: Batch<Self, L>,
        _state: &mut State<S, L>,
        _difference: &S::V<L>,
        _relaxation: L,
    ) -> Option<S::V<L>> {
        None
    }
}

/// A contact in the solver. What an update reads stands together.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct Row<S: Space, K: Kind<S>> {
    state: State<S>,
    motion: K::Motion,
    law: K,
}

impl<S: Space, K: Kind<S>> Row<S, K> {
    #[inline]
    pub fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> Self {
        let (law, motion) = K::new(contact, bodies);
        let mut row = Self {
            state: State::new(&contact.normal, &contact.impulse),
            law,
            motion,
        };
        row.set(&contact.impulse);
        row
    }

    /// A contact that contributes nothing, and one of its bodies.
    fn between_immovable_bodies() -> (Self, SolverBody<S>) {
        let body = SolverBody {
            v: S::Vector::zero(),
            s: S::Spin::zero(),
            im: 0.0,
            is: 0.0,
        };
        let mobility = Mobility {
            mass: S::Vector::zero(),
            inertia: S::Tensor::uniform(0.0),
        };
        let bodies = RigidBodies {
            solver_bodies: &[body; 2],
            masses: &[mobility; 2],
            lengths: &[1.0; 2],
        };
        (Self::new(&ContactForm::idle(), &bodies), body)
    }

    /// The normal and the tangential impulse.
    #[inline(always)]
    pub fn local_impulse(&self) -> Parts<S> {
        self.state.p
    }

    /// Sets them; the caller updates the velocities.
    #[inline(always)]
    pub fn set_local_impulse(&mut self, parts: Parts<S>) {
        self.state.p = parts;
    }

    /// Sets an impulse given in world axes; the caller updates the velocities.
    pub fn set(&mut self, impulse: &S::Vector) {
        self.state.set(impulse);
        if !self.law.grips() {
            self.state.p.t = Parts::<S>::zero().t;
        }
    }

    /// rho of the natural map; 0 for a contact that moves nothing, whose impulse follows from given
    /// velocities.
    pub fn rho(&self) -> f64 {
        K::limits(Batch::one(&self.law)).rho
    }

    /// Sets the impulse to what these velocities ask for, which it does not change.
    pub fn solve_at(&mut self, a: &SolverBody<S>, b: &SolverBody<S>) {
        let (mut a, mut b) = (Moving::of(a), Moving::of(b));
        Self::update(BatchMut::one(self), &mut a, &mut b, 1.0);
    }

    /// Solves contacts for the current velocities, applies `relaxation` times the change of the
    /// impulses, and updates the velocities.
    #[inline(always)]
    pub fn update<L: Lane>(
        mut rows: BatchMut<Self, L>,
        a: &mut Moving<S, L>,
        b: &mut Moving<S, L>,
        relaxation: L,
    ) {
        let (mut state, motion) = (part!(rows, state).read(), part!(rows, motion).read());
        let (law, difference) = (part!(rows, law), a.v - b.v);
        if let Some(p) = K::without_friction(law, &mut state, &difference, relaxation) {
            a.v = a.v + p * a.im;
            b.v = b.v - p * b.im;
        } else {
            let u = K::Motion::relative(&motion, &state.n, a, b);
            let change = K::solve(part_mut!(rows, law), &mut state, u, relaxation);
            K::Motion::push(&motion, &state.n, &change, a, b);
        }
        part_mut!(rows, state.p).write(&state.p);
    }

    /// Applies the stored impulses to the velocities.
    #[inline(always)]
    pub fn load<L: Lane>(rows: Batch<Self, L>, a: &mut Moving<S, L>, b: &mut Moving<S, L>) {
        let (state, motion) = (part!(rows, state).read(), part!(rows, motion).read());
        K::Motion::push(&motion, &state.n, &state.p, a, b);
    }

    /// The relative velocities.
    #[inline(always)]
    fn relative<L: Lane>(rows: Batch<Self, L>, a: &Moving<S, L>, b: &Moving<S, L>) -> Parts<S, L> {
        let (state, motion) = (part!(rows, state).read(), part!(rows, motion).read());
        K::Motion::relative(&motion, &state.n, a, b)
    }

    /// The contributions to the convergence test.
    #[inline(always)]
    pub fn residual<L: Lane>(
        rows: Batch<Self, L>,
        a: &Moving<S, L>,
        b: &Moving<S, L>,
    ) -> Residual<L> {
        let u = Self::relative(rows, a, b);
        <K as Law<S>>::residual(part!(rows, law), &part!(rows, state).read(), &u)
    }

    /// |u|^2, rho of the natural map and friction.
    #[inline(always)]
    pub fn speed<L: Lane>(rows: Batch<Self, L>, a: &Moving<S, L>, b: &Moving<S, L>) -> [L; 3] {
        let u = Self::relative(rows, a, b);
        let limits = K::limits(part!(rows, law));
        [u.dot(&u), limits.rho, limits.mu]
    }

    /// The work on the compliance of the unilateral part, c |p|^2 (J).
    pub fn work_on_compliance(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let u = Self::relative(Batch::one(self), &Moving::of(a), &Moving::of(b));
        self.law.work_on_compliance(&self.state, &u)
    }

    /// The solution at the current velocities.
    pub fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S> {
        let u = Self::relative(Batch::one(self), &Moving::of(a), &Moving::of(b));
        self.law.solution(&self.state, &u)
    }
}

/// Appends the components of an impulse.
pub(super) fn store<S: Space>(p: Parts<S>, out: &mut Vec<f64>) {
    out.push(p.n);
    out.extend((0..<S::T<f64>>::N).map(|k| p.t[k]));
}

/// Takes them from the front of `from`.
pub(super) fn restore<S: Space>(from: &mut &[f64]) -> Parts<S> {
    let (parts, rest) = from.split_at(1 + <S::T<f64>>::N);
    *from = rest;
    Parts {
        n: parts[0],
        t: LaneVector::from_fn(|k| parts[1 + k]),
    }
}

/// Returns 1/w; zero where nothing moves.
#[inline(always)]
fn inverse<L: Lane>(w: L) -> L {
    let zero = L::all(0.0);
    L::select(w.above(zero), L::all(1.0) / w, zero)
}

/// Returns 1/w_t. Where bodies can move only along the normal the slip is given, and friction takes
/// its bound at once.
#[inline(always)]
fn inverse_along<L: Lane>(w_t: L, w_n: L) -> L {
    const MIN_RATIO: f64 = 1e-12;
    inverse(w_t.greatest(L::all(MIN_RATIO) * w_n))
}

/// As [`inverse_along`]; where nothing moves at all, a shear cohesion (N s) takes its bound from a
/// slip of 1e-12 m/s on.
#[inline(always)]
fn answer_to_slip<L: Lane>(w_t: L, w_n: L, cohesion: L) -> L {
    const LEAST_SLIP: f64 = 1e-12;
    let zero = L::all(0.0);
    let moves = w_t.above(zero) | w_n.above(zero);
    L::select(
        moves,
        inverse_along(w_t, w_n),
        cohesion / L::all(LEAST_SLIP),
    )
}

/// The shift along the normal of a contact with this W_nn. Where both bodies are held along the
/// normal, the velocity is given, and the impulse of a rigid contact is not determined: it is open,
/// and its bond, cohesion or damping alone acts. A compliance determines it.
fn shift_along<S: Space>(contact: &ContactForm<S>, w_n: f64) -> f64 {
    if w_n + contact.compliance[0] > 0.0 {
        contact.shift_n
    } else {
        f64::INFINITY
    }
}
