//! How the impulse of a contact moves its two bodies.

use super::state::{Moving, Parts};
use crate::geometry::lane_space::{lanes_of, matrix_lanes_of};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::lanes::{Lane, LaneMatrix, LaneVector, Record, record};
use crate::solve::form::{ContactForm, Mobility};
use std::fmt::Debug;

/// Motion of the two bodies of a contact at the contact, over lanes.
pub(in crate::solve) trait RowMotion<S: Space>:
    Record + Debug + Send + Sync + 'static
{
    /// The relative velocity at contacts.
    fn relative<L: Lane>(
        motion: &Self::With<L>,
        n: &S::V<L>,
        a: &Moving<S, L>,
        b: &Moving<S, L>,
    ) -> Parts<S, L>;
    /// Applies impulses to the velocities.
    fn push<L: Lane>(
        motion: &Self::With<L>,
        n: &S::V<L>,
        p: &Parts<S, L>,
        a: &mut Moving<S, L>,
        b: &mut Moving<S, L>,
    );
}

/// The contact acts on the surfaces of two balls, whose radii are their lengths.
#[derive(Clone, Copy, Debug)]
pub(in crate::solve) struct BallSurfaces;

// SAFETY: the struct has no data.
unsafe impl Record for BallSurfaces {
    type With<L: Lane> = Self;
}

impl<S: Space> RowMotion<S> for BallSurfaces {
    #[inline(always)]
    fn relative<L: Lane>(_: &Self, n: &S::V<L>, a: &Moving<S, L>, b: &Moving<S, L>) -> Parts<S, L> {
        let mut u = Parts::of(n, &(a.v - b.v));
        u.t = u.t - S::rolled(&(a.s + b.s), n);
        u
    }

    #[inline(always)]
    fn push<L: Lane>(
        _: &Self,
        n: &S::V<L>,
        p: &Parts<S, L>,
        a: &mut Moving<S, L>,
        b: &mut Moving<S, L>,
    ) {
        let (impulse, twist) = (p.joined(n), S::twisted(n, &p.t));
        a.v = a.v + impulse * a.im;
        b.v = b.v - impulse * b.im;
        a.s = a.s - twist * a.is;
        b.s = b.s - twist * b.is;
    }
}

/// The contact acts on the line through the centres of two balls, at these distances divided by
/// their lengths.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(in crate::solve) struct BallLevers<L = f64>(pub [L; 2]);

// SAFETY: the struct is an array of numbers.
unsafe impl Record for BallLevers {
    type With<L: Lane> = BallLevers<L>;
}

impl<S: Space> RowMotion<S> for BallLevers {
    #[inline(always)]
    fn relative<L: Lane>(
        BallLevers([i, j]): &BallLevers<L>,
        n: &S::V<L>,
        a: &Moving<S, L>,
        b: &Moving<S, L>,
    ) -> Parts<S, L> {
        let mut u = Parts::of(n, &(a.v - b.v));
        u.t = u.t - S::rolled(&(a.s * *i + b.s * *j), n);
        u
    }

    #[inline(always)]
    fn push<L: Lane>(
        BallLevers([i, j]): &BallLevers<L>,
        n: &S::V<L>,
        p: &Parts<S, L>,
        a: &mut Moving<S, L>,
        b: &mut Moving<S, L>,
    ) {
        let (impulse, twist) = (p.joined(n), S::twisted(n, &p.t));
        a.v = a.v + impulse * a.im;
        b.v = b.v - impulse * b.im;
        a.s = a.s - twist * (a.is * *i);
        b.s = b.s - twist * (b.is * *j);
    }
}

/// The contact acts at lever arms, or on a body that is free along some axes only.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(in crate::solve) struct Levers<S: Space, L: Lane = f64> {
    /// Arms over the lengths of the bodies.
    arms: [S::V<L>; 2],
    inverse_masses: [S::V<L>; 2],
    /// Inverse inertia times the lengths squared (1/kg).
    inverse_spins: [S::I<L>; 2],
}
record!(Levers);

impl<S: Space> Levers<S> {
    /// Returns the levers of a contact of two bodies with these lengths, and W_cc in world axes.
    pub fn new(contact: &ContactForm<S>, bodies: [(&Mobility<S>, f64); 2]) -> (Self, S::Matrix) {
        let mut block = S::Matrix::diagonal(&S::Vector::zero());
        for ((mobility, _), arm) in bodies.iter().zip(&contact.arms) {
            let turning = S::rotation_block(arm, &mobility.inertia);
            block = block + S::Matrix::diagonal(&mobility.mass) + turning;
        }
        let arm = |k: usize| lanes_of(&(contact.arms[k] * (1.0 / bodies[k].1)));
        let levers = Self {
            arms: [arm(0), arm(1)],
            inverse_masses: bodies.map(|(mobility, _)| lanes_of(&mobility.mass)),
            inverse_spins: bodies
                .map(|(m, length)| matrix_lanes_of(&m.inertia.scaled(length).scaled(length))),
        };
        (levers, block)
    }
}

impl<S: Space> RowMotion<S> for Levers<S> {
    #[inline(always)]
    fn relative<L: Lane>(
        levers: &Levers<S, L>,
        n: &S::V<L>,
        a: &Moving<S, L>,
        b: &Moving<S, L>,
    ) -> Parts<S, L> {
        let [i, j] = &levers.arms;
        let u = a.v + S::turning_velocity(&a.s, i) - b.v - S::turning_velocity(&b.s, j);
        Parts::of(n, &u)
    }

    #[inline(always)]
    fn push<L: Lane>(
        levers: &Levers<S, L>,
        n: &S::V<L>,
        p: &Parts<S, L>,
        a: &mut Moving<S, L>,
        b: &mut Moving<S, L>,
    ) {
        let p = p.joined(n);
        let [i, j] = &levers.arms;
        a.v = a.v + p.scaled_by(&levers.inverse_masses[0]);
        b.v = b.v - p.scaled_by(&levers.inverse_masses[1]);
        a.s = a.s + levers.inverse_spins[0].times(&S::moment_of(i, &p));
        b.s = b.s - levers.inverse_spins[1].times(&S::moment_of(j, &p));
    }
}
