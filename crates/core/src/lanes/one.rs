//! The lane of one contact is a number.

use super::{Lane, Mask, Record, SUMS};
use std::hint::select_unpredictable;

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
}

impl Lane for f64 {
    const WIDTH: usize = 1;
    type Mask = bool;
    type Each<T: Copy> = T;

    #[inline(always)]
    fn all(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn greatest(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn with_sign_of(self, sign: Self) -> Self {
        self.copysign(sign)
    }
    #[inline(always)]
    fn above(self, other: Self) -> bool {
        self > other
    }
    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn at_least(self, other: Self) -> bool {
        self >= other
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }
    /// Both values are computed, because branches of contacts would be mispredicted too often.
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        select_unpredictable(mask, yes, no)
    }

    #[inline(always)]
    fn each<T: Copy>(of: impl Fn(usize) -> T) -> T {
        of(0)
    }
    #[inline(always)]
    fn map<T: Copy, U: Copy>(each: T, of: impl Fn(T) -> U) -> U {
        of(each)
    }

    #[inline(always)]
    unsafe fn gather<T: Record>(from: *mut T) -> T::With<f64> {
        // SAFETY: the caller guarantees validity; with single numbers `With` is the record itself.
        unsafe { from.cast::<T::With<f64>>().read() }
    }
    #[inline(always)]
    unsafe fn scatter<T: Record>(to: *mut T, value: &T::With<f64>) {
        // SAFETY: the caller guarantees validity; with single numbers `With` is the record itself.
        unsafe { to.cast::<T::With<f64>>().write(*value) }
    }
    #[inline(always)]
    unsafe fn scatter_where<T: Record>(mask: bool, to: *mut T, value: &T::With<f64>) {
        if mask {
            // SAFETY: guaranteed by the caller.
            unsafe { Self::scatter(to, value) }
        }
    }

    #[inline(always)]
    fn add_to(self, sums: &mut [f64; SUMS], at: usize) {
        sums[at % SUMS] += self;
    }
    #[inline(always)]
    fn raise(self, most: &mut [f64; SUMS], most_at: &mut [f64; SUMS], at: usize) {
        let k = at % SUMS;
        if self > most[k] {
            (most[k], most_at[k]) = (self, at as f64);
        }
    }
}
