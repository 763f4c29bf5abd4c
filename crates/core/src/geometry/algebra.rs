//! Arithmetic of vectors and small square matrices, of one to three components.

use nalgebra::{Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// Returns the greater of two numbers; `b` if they are equal or `a` is NaN, as vector instructions
/// do.
#[inline(always)]
pub fn greatest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the lesser of two numbers; `b` if they are equal or `a` is NaN.
#[inline(always)]
pub fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// A column of vectors of either dimension, read as three components.
#[derive(Clone, Copy, Debug)]
pub enum Vectors<'a> {
    /// Vectors along the third axis: angular velocities and moments in the plane.
    Depth(&'a [Vector1<f64>]),
    /// Vectors in the plane of the first two axes.
    Plane(&'a [Vector2<f64>]),
    /// Vectors in space.
    Space(&'a [Vector3<f64>]),
}

impl Vectors<'_> {
    /// Number of vectors.
    pub fn len(&self) -> usize {
        match self {
            Self::Depth(all) => all.len(),
            Self::Plane(all) => all.len(),
            Self::Space(all) => all.len(),
        }
    }

    /// Returns whether the column is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the vector at an index; panics beyond the end.
    #[inline]
    pub fn at(&self, place: usize) -> [f64; 3] {
        match self {
            Self::Depth(all) => [0.0, 0.0, all[place].x],
            Self::Plane(all) => [all[place].x, all[place].y, 0.0],
            Self::Space(all) => all[place].into(),
        }
    }

    /// Iterates over all vectors, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + Clone + '_ {
        (0..self.len()).map(|place| self.at(place))
    }
}

/// Arithmetic shared by positions, velocities and spins of either dimension.
pub trait VectorLike:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + AddAssign
    + SubAssign
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Index<usize, Output = f64>
    + IndexMut<usize>
    + Serialize
    + DeserializeOwned
    + 'static
{
    /// Number of components.
    const N: usize;
    /// Returns the zero vector.
    fn zero() -> Self;
    /// Returns the scalar product.
    fn dot(&self, other: &Self) -> f64;
    /// Returns the Euclidean norm.
    fn norm(&self) -> f64;
    /// Returns the nearest vector not longer than `bound` (not negative).
    fn limited(self, bound: f64) -> Self;
    /// Creates a vector from a slice; missing components are zero.
    fn from_slice(values: &[f64]) -> Self {
        let mut v = Self::zero();
        for (k, x) in values.iter().take(Self::N).enumerate() {
            v[k] = *x;
        }
        v
    }
    /// Returns the component-wise product.
    fn scaled_by(&self, other: &Self) -> Self {
        let mut v = *self;
        for k in 0..Self::N {
            v[k] *= other[k];
        }
        v
    }
    /// Returns the components, padded with zeros to three.
    fn padded(&self) -> [f64; 3] {
        let mut out = [0.0; 3];
        for (k, slot) in out.iter_mut().enumerate().take(Self::N) {
            *slot = self[k];
        }
        out
    }
    /// Returns vectors as a column.
    fn column(all: &[Self]) -> Vectors<'_>;
    /// Returns whether every component is finite.
    fn is_finite(&self) -> bool {
        (0..Self::N).all(|k| self[k].is_finite())
    }
}

macro_rules! vector_like {
    ($type:ty, $n:literal, $column:ident) => {
        impl VectorLike for $type {
            const N: usize = $n;
            fn column(all: &[Self]) -> Vectors<'_> {
                Vectors::$column(all)
            }
            #[inline(always)]
            fn zero() -> Self {
                Self::zeros()
            }
            #[inline(always)]
            fn dot(&self, other: &Self) -> f64 {
                let products = self.iter().zip(other.iter()).map(|(a, b)| a * b);
                products.reduce(|sum, x| sum + x).unwrap_or(0.0)
            }
            #[inline(always)]
            fn norm(&self) -> f64 {
                if $n == 1 {
                    self[0].abs()
                } else {
                    VectorLike::dot(self, self).sqrt()
                }
            }
            #[inline(always)]
            fn limited(mut self, bound: f64) -> Self {
                if $n == 1 {
                    // A single component needs neither a root nor a branch.
                    self[0] = least(greatest(self[0], -bound), bound);
                    return self;
                }
                let squared = VectorLike::dot(&self, &self);
                if squared <= bound * bound {
                    self
                } else {
                    self * (bound / squared.sqrt())
                }
            }
        }
    };
}
vector_like!(Vector1<f64>, 1, Depth);
vector_like!(Vector2<f64>, 2, Plane);
vector_like!(Vector3<f64>, 3, Space);

/// Arithmetic of the small square matrices of contact blocks.
pub trait MatrixLike:
    Copy + Debug + Send + Sync + PartialEq + Add<Output = Self> + Sub<Output = Self> + 'static
{
    /// Type of the vectors that a matrix multiplies.
    type V: VectorLike;
    /// Returns a diagonal matrix.
    fn diagonal(d: &Self::V) -> Self;
    /// Returns a multiple of the identity.
    fn uniform(x: f64) -> Self {
        let mut d = Self::V::zero();
        for k in 0..Self::V::N {
            d[k] = x;
        }
        Self::diagonal(&d)
    }
    /// Returns the matrix-vector product.
    fn apply(&self, v: &Self::V) -> Self::V;
    /// Returns the matrix product.
    fn times(&self, other: &Self) -> Self;
    /// Returns the dyadic product a b^T.
    fn dyad(a: &Self::V, b: &Self::V) -> Self;
    /// Returns the inverse, or `None` for a singular matrix.
    fn inverse(&self) -> Option<Self>;
    /// Returns the transpose.
    fn transposed(&self) -> Self;
    /// Returns the matrix times a number.
    fn scaled(&self, s: f64) -> Self;
    /// Returns the entry in row `i`, column `j`.
    fn entry(&self, i: usize, j: usize) -> f64;
    /// Returns the matrix with the entry in row `i`, column `j` given by `entry(i, j)`.
    fn from_entries(entry: impl Fn(usize, usize) -> f64) -> Self;
}

macro_rules! matrix_like {
    ($type:ty, $vector:ty) => {
        impl MatrixLike for $type {
            type V = $vector;
            #[inline(always)]
            fn diagonal(d: &Self::V) -> Self {
                Self::from_diagonal(d)
            }
            #[inline(always)]
            fn apply(&self, v: &Self::V) -> Self::V {
                self * v
            }
            #[inline(always)]
            fn times(&self, other: &Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn dyad(a: &Self::V, b: &Self::V) -> Self {
                a * b.transpose()
            }
            #[inline(always)]
            fn inverse(&self) -> Option<Self> {
                self.try_inverse()
            }
            #[inline(always)]
            fn transposed(&self) -> Self {
                self.transpose()
            }
            #[inline(always)]
            fn scaled(&self, s: f64) -> Self {
                self * s
            }
            #[inline(always)]
            fn entry(&self, i: usize, j: usize) -> f64 {
                self[(i, j)]
            }
            #[inline(always)]
            fn from_entries(entry: impl Fn(usize, usize) -> f64) -> Self {
                Self::from_fn(entry)
            }
        }
    };
}
matrix_like!(Matrix1<f64>, Vector1<f64>);
matrix_like!(Matrix2<f64>, Vector2<f64>);
matrix_like!(Matrix3<f64>, Vector3<f64>);
