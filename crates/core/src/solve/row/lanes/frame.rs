//! Relative velocities and impulses of several contacts at once, as `relative` and `push` for one.

use super::vector::*;
use crate::geometry::space::{Dim2, Dim3, Space};
use crate::solve::row::SolverBody;
use std::ops::{Add, Mul, Neg, Sub};

/// Operations on [`Columns`] of any size.
pub trait Tuple<const U: usize>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Lanes<U>, Output = Self> + Neg<Output = Self>
{
    fn zero() -> Self;
    fn dot(self, with: Self) -> Lanes<U>;
    fn norm(self) -> Lanes<U>;
    fn limited(self, bound: Lanes<U>) -> Self;
    fn chosen(which: Mask<U>, yes: Self, no: Self) -> Self;
    /// How many numbers.
    const SIZE: usize;
    fn number(&self, k: usize) -> Lanes<U>;
    /// # Panics
    /// Where there are fewer.
    fn from_numbers(numbers: &[Lanes<U>]) -> Self;
}

impl<const U: usize, const R: usize> Tuple<U> for Columns<U, R> {
    #[inline(always)]
    fn zero() -> Self {
        Columns::zero()
    }
    #[inline(always)]
    fn dot(self, with: Self) -> Lanes<U> {
        Columns::dot(self, with)
    }
    #[inline(always)]
    fn norm(self) -> Lanes<U> {
        Columns::norm(self)
    }
    #[inline(always)]
    fn limited(self, bound: Lanes<U>) -> Self {
        Columns::limited(self, bound)
    }
    #[inline(always)]
    fn chosen(which: Mask<U>, yes: Self, no: Self) -> Self {
        which.choose_columns(yes, no)
    }
    const SIZE: usize = R;
    #[inline(always)]
    fn number(&self, k: usize) -> Lanes<U> {
        self.0[k]
    }
    #[inline(always)]
    fn from_numbers(numbers: &[Lanes<U>]) -> Self {
        Self(std::array::from_fn(|k| numbers[k]))
    }
}

/// The records of the first or second bodies.
#[derive(Clone, Copy)]
pub struct Moving<F: Frame, const U: usize> {
    pub v: F::V<U>,
    pub s: F::T<U>,
    pub im: Lanes<U>,
    pub is: Lanes<U>,
}

impl<F: Frame, const U: usize> Moving<F, U> {
    /// # Safety
    /// The records are valid.
    #[inline(always)]
    pub unsafe fn load(from: &Records<SolverBody<F>, U>) -> Self {
        // SAFETY: as asked for.
        unsafe { F::load(from) }
    }

    /// Writes back the records of movable bodies.
    ///
    /// # Safety
    /// The records are valid.
    #[inline(always)]
    pub unsafe fn store(&self, to: &Records<SolverBody<F>, U>) {
        let zero = Lanes::all(0.0);
        let moves = self.im.above(zero).or(self.is.above(zero)).bits();
        // SAFETY: as asked for.
        unsafe { F::store(to, self, moves) }
    }
}

/// A space with column-wise vectors.
pub trait Frame: Space {
    /// A vector.
    type V<const U: usize>: Tuple<U>;
    /// A tangent or a spin.
    type T<const U: usize>: Tuple<U>;

    /// # Safety
    /// The records are valid.
    unsafe fn load<const U: usize>(from: &Records<SolverBody<Self>, U>) -> Moving<Self, U>;
    /// Writes back the records selected by a mask.
    ///
    /// # Safety
    /// The records are valid.
    unsafe fn store<const U: usize>(
        to: &Records<SolverBody<Self>, U>,
        body: &Moving<Self, U>,
        mask: [i32; U],
    );
    /// Returns the tangential part of a velocity.
    fn across<const U: usize>(n: &Self::V<U>, d: &Self::V<U>, un: Lanes<U>) -> Self::T<U>;
    /// Returns the tangential velocity due to a spin.
    fn rolling<const U: usize>(spin: &Self::T<U>, n: &Self::V<U>) -> Self::T<U>;
    /// Returns the impulse in world axes.
    fn impulse<const U: usize>(n: &Self::V<U>, dn: Lanes<U>, dt: &Self::T<U>) -> Self::V<U>;
    /// Returns the moment of a tangential impulse divided by the length of its body.
    fn turning<const U: usize>(n: &Self::V<U>, dt: &Self::T<U>) -> Self::T<U>;
}

/// Returns u_n and u_t.
#[inline(always)]
pub fn relative<F: Frame, const U: usize>(
    n: &F::V<U>,
    a: &Moving<F, U>,
    b: &Moving<F, U>,
) -> (Lanes<U>, F::T<U>) {
    let d = a.v - b.v;
    let un = n.dot(d);
    (un, F::across(n, &d, un) - F::rolling(&(a.s + b.s), n))
}

/// Applies an impulse to the velocities.
#[inline(always)]
pub fn push<F: Frame, const U: usize>(
    n: &F::V<U>,
    dn: Lanes<U>,
    dt: F::T<U>,
    a: &mut Moving<F, U>,
    b: &mut Moving<F, U>,
) {
    let impulse = F::impulse(n, dn, &dt);
    let twist = F::turning(n, &dt);
    a.v = a.v + impulse * a.im;
    b.v = b.v - impulse * b.im;
    a.s = a.s - twist * a.is;
    b.s = b.s - twist * b.is;
}

/// Returns u_n and u_t of contacts that act at a reach of their bodies' lengths.
#[inline(always)]
pub fn relative_at<F: Frame, const U: usize>(
    n: &F::V<U>,
    reach: &[Lanes<U>; 2],
    a: &Moving<F, U>,
    b: &Moving<F, U>,
) -> (Lanes<U>, F::T<U>) {
    let d = a.v - b.v;
    let un = n.dot(d);
    let turning = F::rolling(&(a.s * reach[0] + b.s * reach[1]), n);
    (un, F::across(n, &d, un) - turning)
}

/// Applies an impulse of such contacts to the velocities.
#[inline(always)]
pub fn push_at<F: Frame, const U: usize>(
    n: &F::V<U>,
    reach: &[Lanes<U>; 2],
    dn: Lanes<U>,
    dt: F::T<U>,
    a: &mut Moving<F, U>,
    b: &mut Moving<F, U>,
) {
    let impulse = F::impulse(n, dn, &dt);
    let twist = F::turning(n, &dt);
    a.v = a.v + impulse * a.im;
    b.v = b.v - impulse * b.im;
    a.s = a.s - twist * (a.is * reach[0]);
    b.s = b.s - twist * (b.is * reach[1]);
}

impl Frame for Dim2 {
    type V<const U: usize> = Columns<U, 2>;
    type T<const U: usize> = Columns<U, 1>;

    #[inline(always)]
    unsafe fn load<const U: usize>(from: &Records<SolverBody<Self>, U>) -> Moving<Self, U> {
        // SAFETY: as asked for; the record is v, s, im, is.
        unsafe {
            let [v0, v1, s, im] = load(from, 0);
            Moving {
                v: Columns([v0, v1]),
                s: Columns([s]),
                im,
                is: load_one(from, 4),
            }
        }
    }

    #[inline(always)]
    unsafe fn store<const U: usize>(
        to: &Records<SolverBody<Self>, U>,
        body: &Moving<Self, U>,
        mask: [i32; U],
    ) {
        let Moving { v, s, im, .. } = body;
        // SAFETY: as asked for.
        unsafe { store(to, 0, mask, [v.0[0], v.0[1], s.0[0], *im]) }
    }

    #[inline(always)]
    fn across<const U: usize>(n: &Self::V<U>, d: &Self::V<U>, _: Lanes<U>) -> Self::T<U> {
        Columns([n.0[0] * d.0[1] - n.0[1] * d.0[0]])
    }

    #[inline(always)]
    fn rolling<const U: usize>(spin: &Self::T<U>, _: &Self::V<U>) -> Self::T<U> {
        *spin
    }

    #[inline(always)]
    fn impulse<const U: usize>(n: &Self::V<U>, dn: Lanes<U>, dt: &Self::T<U>) -> Self::V<U> {
        let dt = dt.0[0];
        Columns([n.0[0] * dn - n.0[1] * dt, n.0[1] * dn + n.0[0] * dt])
    }

    #[inline(always)]
    fn turning<const U: usize>(_: &Self::V<U>, dt: &Self::T<U>) -> Self::T<U> {
        *dt
    }
}

impl Frame for Dim3 {
    type V<const U: usize> = Columns<U, 3>;
    type T<const U: usize> = Columns<U, 3>;

    #[inline(always)]
    unsafe fn load<const U: usize>(from: &Records<SolverBody<Self>, U>) -> Moving<Self, U> {
        // SAFETY: as asked for; the record is v, s, im, is.
        unsafe {
            let [v0, v1, v2, s0] = load(from, 0);
            let [s1, s2, im, is] = load(from, 4);
            Moving {
                v: Columns([v0, v1, v2]),
                s: Columns([s0, s1, s2]),
                im,
                is,
            }
        }
    }

    #[inline(always)]
    unsafe fn store<const U: usize>(
        to: &Records<SolverBody<Self>, U>,
        body: &Moving<Self, U>,
        mask: [i32; U],
    ) {
        let Moving { v, s, im, is } = body;
        // SAFETY: as asked for.
        unsafe {
            store(to, 0, mask, [v.0[0], v.0[1], v.0[2], s.0[0]]);
            store(to, 4, mask, [s.0[1], s.0[2], *im, *is]);
        }
    }

    #[inline(always)]
    fn across<const U: usize>(n: &Self::V<U>, d: &Self::V<U>, un: Lanes<U>) -> Self::T<U> {
        *d - *n * un
    }

    #[inline(always)]
    fn rolling<const U: usize>(spin: &Self::T<U>, n: &Self::V<U>) -> Self::T<U> {
        spin.cross(*n)
    }

    #[inline(always)]
    fn impulse<const U: usize>(n: &Self::V<U>, dn: Lanes<U>, dt: &Self::T<U>) -> Self::V<U> {
        *n * dn + *dt
    }

    #[inline(always)]
    fn turning<const U: usize>(n: &Self::V<U>, dt: &Self::T<U>) -> Self::T<U> {
        n.cross(*dt)
    }
}
