//! Data that change in a sweep: the impulses of contacts and the velocities of bodies.

use super::solver_bodies::SolverBody;
use crate::geometry::lane_space::{lanes_of, vector_of};
use crate::geometry::space::Space;
use crate::lanes::{Batch, BatchMut, Lane, LaneVector, record};
use std::ops::{Add, Mul, Sub};

/// Normal and tangential part of an impulse or a velocity.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::solve) struct Parts<S: Space, L: Lane = f64> {
    pub n: L,
    pub t: S::T<L>,
}
record!(Parts);

impl<S: Space, L: Lane> Parts<S, L> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self {
            n: L::all(0.0),
            t: <S::T<L>>::zero(),
        }
    }

    #[inline(always)]
    pub fn dot(&self, other: &Self) -> L {
        self.n * other.n + self.t.dot(&other.t)
    }

    /// Splits a vector at a contact of unit normal `n`.
    #[inline(always)]
    pub fn of(n: &S::V<L>, v: &S::V<L>) -> Self {
        let along = n.dot(v);
        Self {
            n: along,
            t: S::across(n, v, along),
        }
    }

    /// The vector.
    #[inline(always)]
    pub fn joined(&self, n: &S::V<L>) -> S::V<L> {
        S::joined(n, self.n, &self.t)
    }
}

impl<S: Space, L: Lane> Add for Parts<S, L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            n: self.n + other.n,
            t: self.t + other.t,
        }
    }
}

impl<S: Space, L: Lane> Sub for Parts<S, L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            n: self.n - other.n,
            t: self.t - other.t,
        }
    }
}

impl<S: Space, L: Lane> Mul<L> for Parts<S, L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: L) -> Self {
        Self {
            n: self.n * by,
            t: self.t * by,
        }
    }
}

/// Appends the components of an impulse.
pub(in crate::solve) fn store<S: Space>(p: Parts<S>, out: &mut Vec<f64>) {
    out.push(p.n);
    out.extend((0..<S::T<f64>>::N).map(|k| p.t[k]));
}

/// Reads the components of an impulse from the front of `from`.
pub(in crate::solve) fn restore<S: Space>(from: &mut &[f64]) -> Parts<S> {
    let (parts, rest) = from.split_at(1 + <S::T<f64>>::N);
    *from = rest;
    Parts {
        n: parts[0],
        t: LaneVector::from_fn(|k| parts[1 + k]),
    }
}

/// Normal and impulse of a contact.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::solve) struct RowState<S: Space, L: Lane = f64> {
    pub n: S::V<L>,
    pub p: Parts<S, L>,
}
record!(RowState);

impl<S: Space> RowState<S> {
    /// Creates the state from an impulse in world axes.
    pub fn new(normal: &S::Vector, impulse: &S::Vector) -> Self {
        let mut state = Self {
            n: lanes_of(normal),
            p: Parts::zero(),
        };
        state.set(impulse);
        state
    }

    /// The impulse in world axes (N s).
    pub fn impulse(&self) -> S::Vector {
        vector_of(&self.p.joined(&self.n))
    }

    /// Sets an impulse given in world axes.
    pub fn set(&mut self, impulse: &S::Vector) {
        self.p = Parts::of(&self.n, &lanes_of(impulse));
    }
}

/// Velocities of bodies, see [`SolverBody`].
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::solve) struct Moving<S: Space, L: Lane = f64> {
    pub v: S::V<L>,
    pub s: S::T<L>,
    pub im: L,
    pub is: L,
}
record!(Moving);

/// First numbers of a body record: in the plane four, which are written at once.
#[derive(Clone, Copy)]
#[repr(C)]
struct LeadingNumbers<S: Space, L: Lane> {
    v: S::V<L>,
    s: S::T<L>,
    im: L,
}
record!(LeadingNumbers);

impl<S: Space> Moving<S> {
    pub fn of(body: &SolverBody<S>) -> Self {
        Self {
            v: lanes_of(&body.v),
            s: lanes_of(&body.s),
            im: body.im,
            is: body.is,
        }
    }
}

impl<S: Space, L: Lane> Moving<S, L> {
    #[inline(always)]
    pub fn load(from: &Batch<SolverBody<S>, L>) -> Self {
        // SAFETY: the record of a body begins with these numbers, in this order.
        unsafe { from.part(|body| body.cast::<Moving<S>>()) }.read()
    }

    /// Writes the velocities of movable bodies back: records of immovable ones may be shared.
    #[inline(always)]
    pub fn store(&self, to: &mut BatchMut<SolverBody<S>, L>) {
        let zero = L::all(0.0);
        let moves = self.im.above(zero) | self.is.above(zero);
        if S::D == 2 {
            let front = LeadingNumbers {
                v: self.v,
                s: self.s,
                im: self.im,
            };
            // SAFETY: as for `load`.
            let mut to = unsafe { to.part_mut(|body| body.cast::<LeadingNumbers<S, f64>>()) };
            to.write_where(moves, &front);
        } else {
            // SAFETY: as for `load`.
            let mut to = unsafe { to.part_mut(|body| body.cast::<Moving<S>>()) };
            to.write_where(moves, self);
        }
    }
}
