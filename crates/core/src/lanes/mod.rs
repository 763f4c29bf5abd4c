//! Numbers of several contacts at once: a formula is written once over a [`Lane`] and computed for
//! one contact (`f64`), or for four or eight with vector instructions.
//!
//! All widths give the same bits: every operation follows IEEE 754, none is fused or reordered, and
//! comparisons, [`Lane::greatest`] and [`Lane::least`] treat NaN and signed zeros in the same way.
//!
//! Functions of several numbers are inlined into functions that are compiled for the instructions
//! of a machine ([`dispatch`]).

mod dispatch;
#[cfg(target_arch = "aarch64")]
mod neon;
mod one;
mod record;
#[cfg(test)]
mod tests;
mod vector;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[allow(
    clippy::needless_range_loop,
    reason = "an index counts registers of several arrays"
)]
mod wide;
#[cfg(target_arch = "x86_64")]
mod x86;

pub(crate) use dispatch::{InstructionSet, Wide, prefetch};
pub use record::Record;
pub(crate) use record::{Batch, BatchMut, part, part_mut, record};
pub use vector::{LaneArray, LaneMatrix, LaneVector, Square};

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A condition on each lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns whether the condition holds in any lane.
    fn any(self) -> bool;
    /// Returns whether the condition holds in all lanes.
    fn all(self) -> bool;
}

/// Number of separate partial sums over contacts, to which lanes add in turn; it does not depend on
/// the width.
pub const SUMS: usize = 4;

/// A number for each of [`Self::WIDTH`] contacts.
pub trait Lane:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Number of contacts.
    const WIDTH: usize;
    /// A condition on each lane.
    type Mask: Mask;
    /// A value of any type for each lane.
    type Each<T: Copy>: Copy;

    /// Returns a lane with the number `x` in all places.
    fn all(x: f64) -> Self;
    /// Returns the greater of two numbers; `other` where they are equal or one is NaN.
    fn greatest(self, other: Self) -> Self;
    /// Returns the lesser of two numbers; `other` where they are equal or one is NaN.
    fn least(self, other: Self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The magnitude of `self` with the sign of `sign`.
    fn with_sign_of(self, sign: Self) -> Self;
    /// Returns whether `self > other`; like all comparisons, it does not hold for NaN.
    fn above(self, other: Self) -> Self::Mask;
    /// Returns whether `self < other`.
    fn below(self, other: Self) -> Self::Mask;
    /// Returns whether `self >= other`.
    fn at_least(self, other: Self) -> Self::Mask;
    /// Returns whether `self <= other`.
    fn at_most(self, other: Self) -> Self::Mask;
    /// Returns `yes` in the lanes of a mask, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Returns a value for each lane, by its number.
    fn each<T: Copy>(of: impl Fn(usize) -> T) -> Self::Each<T>;
    /// Maps the value of each lane.
    fn map<T: Copy, U: Copy>(each: Self::Each<T>, of: impl Fn(T) -> U) -> Self::Each<U>;

    /// Reads a record for each lane.
    ///
    /// # Safety
    /// The records are valid.
    unsafe fn gather<T: Record>(from: Self::Each<*mut T>) -> T::With<Self>;
    /// Writes a record for each lane.
    ///
    /// # Safety
    /// The records must be valid, and nobody else may access them.
    unsafe fn scatter<T: Record>(to: Self::Each<*mut T>, value: &T::With<Self>);
    /// Writes the records of the lanes of a mask.
    ///
    /// # Safety
    /// The records must be valid, and nobody else may access them.
    unsafe fn scatter_where<T: Record>(
        mask: Self::Mask,
        to: Self::Each<*mut T>,
        value: &T::With<Self>,
    );

    /// Adds each number to the partial sum of its contact; the first lane belongs to contact `at`,
    /// a multiple of the width.
    fn add_to(self, sums: &mut [f64; SUMS], at: usize);
    /// Raises partial maxima to these numbers, and sets the contact number of those that rise; `at`
    /// as for [`Self::add_to`].
    fn raise(self, most: &mut [f64; SUMS], most_at: &mut [f64; SUMS], at: usize);
}
