//! A contact between two rigid bodies in the solver: a law and a motion, over lanes.

use super::law::RowLaw;
use super::motion::RowMotion;
use super::rigid_bodies::RigidBodies;
use super::solver_bodies::SolverBody;
use super::state::{Moving, Parts, RowState};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::lanes::{Batch, BatchMut, Lane, part, part_mut};
use crate::solve::error::Residual;
use crate::solve::form::{ContactForm, ContactSolution, Mobility};

/// A kind of contacts between two rigid bodies: a law with a closed-form solution, and the motion
/// of the bodies.
pub(in crate::solve) trait RowKind<S: Space>: RowLaw<S> {
    type Motion: RowMotion<S>;
    /// Whether, in space, processing eight contacts at a time is faster than four, because the
    /// registers suffice.
    const EIGHT: bool = false;
    /// Whether bonds may act on its contacts.
    const BONDS: bool;

    /// Whether a contact can be of this kind.
    fn serves(contact: &ContactForm<S>) -> bool;
    /// Creates law and motion of a contact, with the data of its bodies.
    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, Self::Motion);
    /// Whether a contact may have a tangential impulse.
    fn grips(&self) -> bool {
        true
    }
    /// Solves contacts without friction between bodies that do not rotate, for the difference of
    /// the velocities of the centres; returns the change of the impulses in world axes.
    #[inline(always)]
    fn without_friction<L: Lane>(
        _law: Batch<Self, L>,
        _state: &mut RowState<S, L>,
        _difference: &S::V<L>,
        _relaxation: L,
    ) -> Option<S::V<L>> {
        None
    }
}

/// A contact in the solver. The data of an update are adjacent.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Row<S: Space, K: RowKind<S>> {
    pub(super) state: RowState<S>,
    motion: K::Motion,
    law: K,
}

impl<S: Space, K: RowKind<S>> Row<S, K> {
    #[inline]
    pub fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> Self {
        let (law, motion) = K::new(contact, bodies);
        let mut row = Self {
            state: RowState::new(&contact.normal, &contact.impulse),
            law,
            motion,
        };
        row.set(&contact.impulse);
        row
    }

    /// Returns a contact that contributes nothing, and one of its bodies.
    pub(super) fn between_immovable_bodies() -> (Self, SolverBody<S>) {
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
        (Self::new(&ContactForm::default(), &bodies), body)
    }

    /// The normal and the tangential impulse.
    #[inline(always)]
    pub fn local_impulse(&self) -> Parts<S> {
        self.state.p
    }

    /// Sets the impulse; the caller updates the velocities.
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

    /// Returns rho of the natural map; 0 for a contact that moves nothing, whose impulse follows
    /// from given velocities.
    pub fn rho(&self) -> f64 {
        K::limits(Batch::one(&self.law)).rho
    }

    /// Sets the impulse to the solution for these velocities, which it does not change.
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
        <K as RowLaw<S>>::residual(part!(rows, law), &part!(rows, state).read(), &u)
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
