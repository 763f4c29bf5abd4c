//! Vectors that hold one number of several contacts, and column-wise access to records.
//!
//! The functions are inlined into functions compiled for AVX2 or AVX-512 (`all_avx2` and `all_avx512` in `mod.rs`), which alone may call them.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// One number of four contacts per vector register.
#[derive(Clone, Copy)]
pub struct Lanes<const U: usize>(pub [__m256d; U]);

/// Mask of lanes.
#[derive(Clone, Copy)]
pub struct Mask<const U: usize>([__m256d; U]);

macro_rules! by_lane {
    ($name:ident, $with:path) => {
        #[inline(always)]
        pub fn $name(mut self, with: Self) -> Self {
            for u in 0..U {
                // SAFETY: see the module.
                self.0[u] = unsafe { $with(self.0[u], with.0[u]) };
            }
            self
        }
    };
}

macro_rules! compare {
    ($name:ident, $how:expr) => {
        #[inline(always)]
        pub fn $name(self, with: Self) -> Mask<U> {
            let mut out = self.0;
            for u in 0..U {
                // SAFETY: see the module.
                out[u] = unsafe { _mm256_cmp_pd::<{ $how }>(self.0[u], with.0[u]) };
            }
            Mask(out)
        }
    };
}

impl<const U: usize> Lanes<U> {
    #[inline(always)]
    pub fn all(x: f64) -> Self {
        // SAFETY: see the module.
        Self([unsafe { _mm256_set1_pd(x) }; U])
    }

    by_lane!(plus, _mm256_add_pd);
    by_lane!(less, _mm256_sub_pd);
    by_lane!(times, _mm256_mul_pd);
    by_lane!(over, _mm256_div_pd);
    // For equal values, or if the first is NaN, returns the second, as `greatest` and `least` do.
    by_lane!(max, _mm256_max_pd);
    by_lane!(min, _mm256_min_pd);
    by_lane!(and, _mm256_and_pd);
    by_lane!(and_not, _mm256_andnot_pd);
    by_lane!(or, _mm256_or_pd);
    by_lane!(xor, _mm256_xor_pd);
    compare!(above, _CMP_GT_OQ);
    compare!(not_above, _CMP_LE_OQ);
    compare!(not_below, _CMP_GE_OQ);

    #[inline(always)]
    pub fn root(mut self) -> Self {
        for x in &mut self.0 {
            // SAFETY: see the module.
            *x = unsafe { _mm256_sqrt_pd(*x) };
        }
        self
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::all(-0.0).and_not(self)
    }

    /// Returns the magnitude of `self` with the sign of `of`.
    #[inline(always)]
    pub fn signed_as(self, of: Self) -> Self {
        self.abs().or(Self::all(-0.0).and(of))
    }

    /// Adds each number to the sum of its lane.
    #[inline(always)]
    pub fn add_to(self, sums: &mut [f64; 4]) {
        // SAFETY: four numbers; see the module.
        unsafe {
            let mut out = _mm256_loadu_pd(sums.as_ptr());
            for x in self.0 {
                out = _mm256_add_pd(out, x);
            }
            _mm256_storeu_pd(sums.as_mut_ptr(), out);
        }
    }

    /// Updates the maximum of each lane and the index of the contact at which it first occurred; `at` is the
    /// contact of the first lane.
    #[inline(always)]
    pub fn raise(self, worst: &mut [f64; 4], worst_at: &mut [f64; 4], at: usize) {
        // SAFETY: four numbers; see the module.
        unsafe {
            let mut most = _mm256_loadu_pd(worst.as_ptr());
            let mut place = _mm256_loadu_pd(worst_at.as_ptr());
            let lanes = _mm256_setr_pd(0.0, 1.0, 2.0, 3.0);
            for (u, x) in self.0.into_iter().enumerate() {
                let here = _mm256_add_pd(_mm256_set1_pd((at + 4 * u) as f64), lanes);
                let more = _mm256_cmp_pd::<_CMP_GT_OQ>(x, most);
                most = _mm256_blendv_pd(most, x, more);
                place = _mm256_blendv_pd(place, here, more);
            }
            _mm256_storeu_pd(worst.as_mut_ptr(), most);
            _mm256_storeu_pd(worst_at.as_mut_ptr(), place);
        }
    }
}

impl<const U: usize> Mask<U> {
    /// Selects `yes` in these lanes and `no` elsewhere.
    #[inline(always)]
    pub fn choose(self, yes: Lanes<U>, mut no: Lanes<U>) -> Lanes<U> {
        for u in 0..U {
            // SAFETY: see the module.
            no.0[u] = unsafe { _mm256_blendv_pd(no.0[u], yes.0[u], self.0[u]) };
        }
        no
    }

    #[inline(always)]
    pub fn and(self, with: Self) -> Self {
        Self(Lanes(self.0).and(Lanes(with.0)).0)
    }

    #[inline(always)]
    pub fn or(self, with: Self) -> Self {
        Self(Lanes(self.0).or(Lanes(with.0)).0)
    }

    /// Returns one bit per lane.
    #[inline(always)]
    pub fn bits(self) -> [i32; U] {
        // SAFETY: see the module.
        self.0.map(|m| unsafe { _mm256_movemask_pd(m) })
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident, $by:ident) => {
        impl<const U: usize> $trait for Lanes<U> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, with: Self) -> Self {
                self.$by(with)
            }
        }
    };
}
operator!(Add, add, plus);
operator!(Sub, sub, less);
operator!(Mul, mul, times);
operator!(Div, div, over);

impl<const U: usize> Neg for Lanes<U> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.xor(Self::all(-0.0))
    }
}

/// A vector, tangent or spin of each contact.
#[derive(Clone, Copy)]
pub struct Columns<const U: usize, const R: usize>(pub [Lanes<U>; R]);

impl<const U: usize, const R: usize> Columns<U, R> {
    #[inline(always)]
    pub fn zero() -> Self {
        Self([Lanes::all(0.0); R])
    }

    #[inline(always)]
    pub fn dot(self, with: Self) -> Lanes<U> {
        let mut sum = self.0[0] * with.0[0];
        for k in 1..R {
            sum = sum + self.0[k] * with.0[k];
        }
        sum
    }

    #[inline(always)]
    pub fn norm(self) -> Lanes<U> {
        if R == 1 {
            self.0[0].abs()
        } else {
            self.dot(self).root()
        }
    }

    /// Limits the length to `bound`.
    #[inline(always)]
    pub fn limited(self, bound: Lanes<U>) -> Self {
        if R == 1 {
            return Self([self.0[0].max(-bound).min(bound); R]);
        }
        let squared = self.dot(self);
        let inside = squared.not_above(bound * bound);
        let shorter = self * (bound / squared.root());
        inside.choose_columns(self, shorter)
    }
}

impl<const U: usize> Mask<U> {
    #[inline(always)]
    pub fn choose_columns<const R: usize>(
        self,
        yes: Columns<U, R>,
        mut no: Columns<U, R>,
    ) -> Columns<U, R> {
        for k in 0..R {
            no.0[k] = self.choose(yes.0[k], no.0[k]);
        }
        no
    }
}

impl<const U: usize, const R: usize> Add for Columns<U, R> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, with: Self) -> Self {
        for k in 0..R {
            self.0[k] = self.0[k] + with.0[k];
        }
        self
    }
}

impl<const U: usize, const R: usize> Sub for Columns<U, R> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, with: Self) -> Self {
        for k in 0..R {
            self.0[k] = self.0[k] - with.0[k];
        }
        self
    }
}

impl<const U: usize, const R: usize> Mul<Lanes<U>> for Columns<U, R> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, by: Lanes<U>) -> Self {
        for x in &mut self.0 {
            *x = *x * by;
        }
        self
    }
}

impl<const U: usize, const R: usize> Neg for Columns<U, R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<const U: usize> Columns<U, 3> {
    #[inline(always)]
    pub fn cross(self, with: Self) -> Self {
        let (a, b) = (self.0, with.0);
        Self([
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ])
    }
}

/// Pointers to the records of four contacts per vector register.
pub type Records<T, const U: usize> = [[*mut T; 4]; U];

/// Loads four numbers of each record, from the `skip`-th, as columns.
///
/// # Safety
/// The records have that many numbers.
#[inline(always)]
pub unsafe fn load<T, const U: usize>(from: &Records<T, U>, skip: usize) -> [Lanes<U>; 4] {
    let mut out = [Lanes::all(0.0); 4];
    for (u, from) in from.iter().enumerate() {
        // By halves, which needs fewer moves between lanes. SAFETY: as above.
        unsafe {
            let half = |k: usize, h: usize| _mm_loadu_pd(from[k].cast::<f64>().add(skip + h));
            let two = |k: usize, h: usize| {
                _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(half(k, h)), half(k + 2, h))
            };
            let (ac, bd, ca, db) = (two(0, 0), two(1, 0), two(0, 2), two(1, 2));
            out[0].0[u] = _mm256_unpacklo_pd(ac, bd);
            out[1].0[u] = _mm256_unpackhi_pd(ac, bd);
            out[2].0[u] = _mm256_unpacklo_pd(ca, db);
            out[3].0[u] = _mm256_unpackhi_pd(ca, db);
        }
    }
    out
}

/// Loads one number of each record.
///
/// # Safety
/// The records have that many numbers.
#[inline(always)]
pub unsafe fn load_one<T, const U: usize>(from: &Records<T, U>, at: usize) -> Lanes<U> {
    let mut out = Lanes::all(0.0);
    for (u, from) in from.iter().enumerate() {
        // SAFETY: as above.
        unsafe {
            let x = |k: usize| *from[k].cast::<f64>().add(at);
            out.0[u] = _mm256_setr_pd(x(0), x(1), x(2), x(3));
        }
    }
    out
}

/// Stores values loaded by [`load`], for the records selected by a mask of four bits per register.
///
/// # Safety
/// The records have that many numbers.
#[inline(always)]
pub unsafe fn store<T, const U: usize>(
    to: &Records<T, U>,
    skip: usize,
    mask: [i32; U],
    [a, b, c, d]: [Lanes<U>; 4],
) {
    for u in 0..U {
        // SAFETY: as above.
        unsafe {
            let rows = transpose(a.0[u], b.0[u], c.0[u], d.0[u]);
            if mask[u] == 15 {
                for k in 0..4 {
                    _mm256_storeu_pd(to[u][k].cast::<f64>().add(skip), rows[k]);
                }
            } else {
                for k in 0..4 {
                    if mask[u] >> k & 1 == 1 {
                        _mm256_storeu_pd(to[u][k].cast::<f64>().add(skip), rows[k]);
                    }
                }
            }
        }
    }
}

/// Transposes columns to rows.
#[inline(always)]
unsafe fn transpose(a: __m256d, b: __m256d, c: __m256d, d: __m256d) -> [__m256d; 4] {
    // SAFETY: see the module.
    unsafe {
        let (ab, ba) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd, dc) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab, cd),
            _mm256_permute2f128_pd::<0x20>(ba, dc),
            _mm256_permute2f128_pd::<0x31>(ab, cd),
            _mm256_permute2f128_pd::<0x31>(ba, dc),
        ]
    }
}
