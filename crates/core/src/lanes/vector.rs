//! Small vectors and matrices of lanes.

use super::{Lane, Mask};
use std::fmt::Debug;
use std::ops::{Add, Index, IndexMut, Mul, Neg, Sub};

/// A vector in which each component holds the values of several contacts.
pub trait LaneVector<L: Lane>:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<L, Output = Self>
    + Index<usize, Output = L>
    + IndexMut<usize>
{
    /// Number of components.
    const N: usize;
    /// Returns the vector with these components.
    fn from_fn(component: impl FnMut(usize) -> L) -> Self;
    /// The zero vector.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_fn(|_| L::all(0.0))
    }
    /// The scalar product.
    #[inline(always)]
    fn dot(&self, other: &Self) -> L {
        let mut sum = self[0] * other[0];
        for k in 1..Self::N {
            sum = sum + self[k] * other[k];
        }
        sum
    }
    /// The Euclidean norm.
    #[inline(always)]
    fn norm(&self) -> L {
        if Self::N == 1 {
            self[0].abs()
        } else {
            self.dot(self).sqrt()
        }
    }
    /// The nearest vector not longer than `bound` (not negative).
    #[inline(always)]
    fn limited(self, bound: L) -> Self {
        if Self::N == 1 {
            return Self::from_fn(|k| self[k].greatest(-bound).least(bound));
        }
        let squared = self.dot(&self);
        let inside = squared.at_most(bound * bound);
        // For one contact a branch saves a division and a root.
        if L::WIDTH == 1 && inside.all() {
            return self;
        }
        Self::select(inside, self, self * (bound / squared.sqrt()))
    }
    /// Returns the product by components.
    #[inline(always)]
    fn scaled_by(&self, other: &Self) -> Self {
        Self::from_fn(|k| self[k] * other[k])
    }
    /// Returns `yes` in the lanes of a mask, `no` elsewhere.
    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::from_fn(|k| L::select(mask, yes[k], no[k]))
    }
}

/// A square matrix of lanes.
pub trait LaneMatrix<L: Lane>: Copy + Debug + Send + Sync + 'static {
    /// Type of the vectors that the matrix multiplies.
    type V: LaneVector<L>;
    /// Returns the matrix with these entries, by row and column.
    fn from_fn(entry: impl FnMut(usize, usize) -> L) -> Self;
    /// The matrix of zeros.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_fn(|_, _| L::all(0.0))
    }
    /// The entry in row `i`, column `j`.
    fn entry(&self, i: usize, j: usize) -> L;
    /// The product with a vector, summed row by row.
    #[inline(always)]
    fn times(&self, x: &Self::V) -> Self::V {
        Self::V::from_fn(|i| {
            let mut sum = self.entry(i, 0) * x[0];
            for j in 1..Self::V::N {
                sum = sum + self.entry(i, j) * x[j];
            }
            sum
        })
    }
}

/// Components of a vector, each in a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct LaneArray<L, const N: usize>(pub [L; N]);

impl<L: Lane, const N: usize> LaneVector<L> for LaneArray<L, N> {
    const N: usize = N;
    #[inline(always)]
    fn from_fn(mut component: impl FnMut(usize) -> L) -> Self {
        let mut out = [component(0); N];
        for (k, x) in out.iter_mut().enumerate().skip(1) {
            *x = component(k);
        }
        Self(out)
    }
}

impl<L: Lane> LaneArray<L, 3> {
    /// The vector product.
    #[inline(always)]
    pub fn cross(&self, other: &Self) -> Self {
        let (a, b) = (&self.0, &other.0);
        Self([
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ])
    }
}

impl<L, const N: usize> Index<usize> for LaneArray<L, N> {
    type Output = L;
    #[inline(always)]
    fn index(&self, k: usize) -> &L {
        &self.0[k]
    }
}

impl<L, const N: usize> IndexMut<usize> for LaneArray<L, N> {
    #[inline(always)]
    fn index_mut(&mut self, k: usize) -> &mut L {
        &mut self.0[k]
    }
}

macro_rules! componentwise {
    ($trait:ident, $name:ident) => {
        impl<L: Lane, const N: usize> $trait for LaneArray<L, N> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self::from_fn(|k| self[k].$name(other[k]))
            }
        }
    };
}
componentwise!(Add, add);
componentwise!(Sub, sub);

impl<L: Lane, const N: usize> Neg for LaneArray<L, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_fn(|k| -self[k])
    }
}

impl<L: Lane, const N: usize> Mul<L> for LaneArray<L, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: L) -> Self {
        Self::from_fn(|k| self[k] * by)
    }
}

/// Entries of a square matrix by rows, each in a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Square<L, const N: usize>(pub [[L; N]; N]);

impl<L: Lane, const N: usize> LaneMatrix<L> for Square<L, N> {
    type V = LaneArray<L, N>;
    #[inline(always)]
    fn from_fn(mut entry: impl FnMut(usize, usize) -> L) -> Self {
        let mut out = [[L::all(0.0); N]; N];
        for (i, row) in out.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = entry(i, j);
            }
        }
        Self(out)
    }
    #[inline(always)]
    fn entry(&self, i: usize, j: usize) -> L {
        self.0[i][j]
    }
}
