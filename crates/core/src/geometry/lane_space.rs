//! The geometry of contacts, evaluated for several contacts at once.

use super::algebra::{MatrixLike, VectorLike};
use super::space::{Dim2, Dim3};
use crate::lanes::{Lane, LaneArray, LaneMatrix, LaneVector, Square};
use std::fmt::Debug;

/// A dimension of space, see [`Space`](super::space::Space), with vectors in which each component
/// holds the values of several contacts.
pub trait LaneSpace: Copy + Debug + 'static {
    /// A velocity or an impulse.
    type V<L: Lane>: LaneVector<L>;
    /// A tangential part, a spin or a moment.
    type T<L: Lane>: LaneVector<L>;
    /// A contact block.
    type M<L: Lane>: LaneMatrix<L, V = Self::V<L>>;
    /// An inertia tensor.
    type I<L: Lane>: LaneMatrix<L, V = Self::T<L>>;

    /// Returns the tangential part of a vector, given with its normal component.
    fn across<L: Lane>(n: &Self::V<L>, v: &Self::V<L>, normal: L) -> Self::T<L>;
    /// The vector of a normal and a tangential part.
    fn joined<L: Lane>(n: &Self::V<L>, normal: L, t: &Self::T<L>) -> Self::V<L>;
    /// Returns omega x n as a tangential part.
    fn rolled<L: Lane>(spin: &Self::T<L>, n: &Self::V<L>) -> Self::T<L>;
    /// Returns n x p_t as a spin.
    fn twisted<L: Lane>(n: &Self::V<L>, t: &Self::T<L>) -> Self::T<L>;
    /// Returns omega x arm.
    fn turning_velocity<L: Lane>(spin: &Self::T<L>, arm: &Self::V<L>) -> Self::V<L>;
    /// Returns arm x force.
    fn moment_of<L: Lane>(arm: &Self::V<L>, force: &Self::V<L>) -> Self::T<L>;
    /// Returns two tangents that form a right-handed frame with `n`; in 2D one, the second is not
    /// used.
    fn frame<L: Lane>(n: &Self::V<L>) -> [Self::V<L>; 2];
    /// The components of a tangential part along [`Self::frame`].
    fn frame_components<L: Lane>(tangents: &[Self::V<L>; 2], t: &Self::T<L>) -> [L; 2];
    /// Returns a tangential part from its components.
    fn from_frame<L: Lane>(tangents: &[Self::V<L>; 2], t: [L; 2]) -> Self::T<L>;
}

impl LaneSpace for Dim2 {
    type V<L: Lane> = LaneArray<L, 2>;
    type T<L: Lane> = LaneArray<L, 1>;
    type M<L: Lane> = Square<L, 2>;
    type I<L: Lane> = Square<L, 1>;

    #[inline(always)]
    fn across<L: Lane>(n: &Self::V<L>, v: &Self::V<L>, _: L) -> Self::T<L> {
        LaneArray([n[0] * v[1] - n[1] * v[0]])
    }
    #[inline(always)]
    fn joined<L: Lane>(n: &Self::V<L>, normal: L, t: &Self::T<L>) -> Self::V<L> {
        LaneArray([n[0] * normal - n[1] * t[0], n[1] * normal + n[0] * t[0]])
    }
    #[inline(always)]
    fn rolled<L: Lane>(spin: &Self::T<L>, _: &Self::V<L>) -> Self::T<L> {
        *spin
    }
    #[inline(always)]
    fn twisted<L: Lane>(_: &Self::V<L>, t: &Self::T<L>) -> Self::T<L> {
        *t
    }
    #[inline(always)]
    fn turning_velocity<L: Lane>(spin: &Self::T<L>, arm: &Self::V<L>) -> Self::V<L> {
        LaneArray([(-spin[0]) * arm[1], spin[0] * arm[0]])
    }
    #[inline(always)]
    fn moment_of<L: Lane>(arm: &Self::V<L>, force: &Self::V<L>) -> Self::T<L> {
        LaneArray([arm[0] * force[1] - arm[1] * force[0]])
    }
    #[inline(always)]
    fn frame<L: Lane>(n: &Self::V<L>) -> [Self::V<L>; 2] {
        [*n; 2]
    }
    #[inline(always)]
    fn frame_components<L: Lane>(_: &[Self::V<L>; 2], t: &Self::T<L>) -> [L; 2] {
        [t[0]; 2]
    }
    #[inline(always)]
    fn from_frame<L: Lane>(_: &[Self::V<L>; 2], t: [L; 2]) -> Self::T<L> {
        LaneArray([t[0]])
    }
}

impl LaneSpace for Dim3 {
    type V<L: Lane> = LaneArray<L, 3>;
    type T<L: Lane> = LaneArray<L, 3>;
    type M<L: Lane> = Square<L, 3>;
    type I<L: Lane> = Square<L, 3>;

    #[inline(always)]
    fn across<L: Lane>(n: &Self::V<L>, v: &Self::V<L>, normal: L) -> Self::T<L> {
        *v - *n * normal
    }
    #[inline(always)]
    fn joined<L: Lane>(n: &Self::V<L>, normal: L, t: &Self::T<L>) -> Self::V<L> {
        *n * normal + *t
    }
    #[inline(always)]
    fn rolled<L: Lane>(spin: &Self::T<L>, n: &Self::V<L>) -> Self::T<L> {
        spin.cross(n)
    }
    #[inline(always)]
    fn twisted<L: Lane>(n: &Self::V<L>, t: &Self::T<L>) -> Self::T<L> {
        n.cross(t)
    }
    #[inline(always)]
    fn turning_velocity<L: Lane>(spin: &Self::T<L>, arm: &Self::V<L>) -> Self::V<L> {
        spin.cross(arm)
    }
    #[inline(always)]
    fn moment_of<L: Lane>(arm: &Self::V<L>, force: &Self::V<L>) -> Self::T<L> {
        arm.cross(force)
    }
    #[inline(always)]
    fn frame<L: Lane>(n: &Self::V<L>) -> [Self::V<L>; 2] {
        // Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
        let one = L::all(1.0);
        let sign = one.with_sign_of(n[2]);
        let a = -one / (sign + n[2]);
        let b = n[0] * n[1] * a;
        [
            LaneArray([one + sign * n[0] * n[0] * a, sign * b, -sign * n[0]]),
            LaneArray([b, sign + n[1] * n[1] * a, -n[1]]),
        ]
    }
    #[inline(always)]
    fn frame_components<L: Lane>(tangents: &[Self::V<L>; 2], t: &Self::T<L>) -> [L; 2] {
        [tangents[0].dot(t), tangents[1].dot(t)]
    }
    #[inline(always)]
    fn from_frame<L: Lane>(tangents: &[Self::V<L>; 2], t: [L; 2]) -> Self::T<L> {
        tangents[0] * t[0] + tangents[1] * t[1]
    }
}

/// Returns a vector with equal components in all lanes.
#[inline(always)]
pub(crate) fn lanes_of<L: Lane, V: LaneVector<L>>(v: &impl VectorLike) -> V {
    V::from_fn(|k| L::all(v[k]))
}

/// Returns a matrix with equal entries in all lanes.
#[inline(always)]
pub(crate) fn matrix_lanes_of<L: Lane, M: LaneMatrix<L>>(m: &impl MatrixLike) -> M {
    M::from_fn(|i, j| L::all(m.entry(i, j)))
}

/// Returns the vector of one contact.
#[inline(always)]
pub(crate) fn vector_of<V: VectorLike>(lanes: &impl LaneVector<f64>) -> V {
    let mut out = V::zero();
    for k in 0..V::N {
        out[k] = lanes[k];
    }
    out
}
