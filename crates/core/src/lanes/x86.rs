//! Four numbers in a register of AVX.
//!
//! All functions are inlined into functions that are compiled for AVX2 or AVX-512 (`dispatch`); no
//! other code uses these lanes.

use super::wide::Four;
use std::arch::x86_64::*;

macro_rules! by_two {
    ($($name:ident: $with:expr;)+) => {$(
        #[inline(always)]
        fn $name(self, with: Self) -> Self {
            // SAFETY: callers are compiled for AVX, as the module states.
            unsafe { $with(self, with) }
        }
    )+};
}

impl Four for __m256d {
    by_two! {
        add: _mm256_add_pd;
        sub: _mm256_sub_pd;
        mul: _mm256_mul_pd;
        div: _mm256_div_pd;
        // Maximum and minimum give the second number where the numbers are equal or one is NaN.
        greatest: _mm256_max_pd;
        least: _mm256_min_pd;
        above: _mm256_cmp_pd::<_CMP_GT_OQ>;
        at_least: _mm256_cmp_pd::<_CMP_GE_OQ>;
        and: _mm256_and_pd;
        or: _mm256_or_pd;
        xor: _mm256_xor_pd;
    }
    #[inline(always)]
    fn all(x: f64) -> Self {
        // SAFETY: callers are compiled for AVX, as the module states.
        unsafe { _mm256_set1_pd(x) }
    }
    #[inline(always)]
    fn new(x: [f64; 4]) -> Self {
        // SAFETY: callers are compiled for AVX, as the module states.
        unsafe { _mm256_setr_pd(x[0], x[1], x[2], x[3]) }
    }
    #[inline(always)]
    fn load(from: &[f64; 4]) -> Self {
        // SAFETY: the array has four numbers; callers are compiled for AVX.
        unsafe { _mm256_loadu_pd(from.as_ptr()) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        // SAFETY: the array has four numbers; callers are compiled for AVX.
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: callers are compiled for AVX, as the module states.
        unsafe { _mm256_sqrt_pd(self) }
    }
    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        // SAFETY: callers are compiled for AVX, as the module states.
        unsafe { _mm256_blendv_pd(no, yes, mask) }
    }
    #[inline(always)]
    fn bits(self) -> i32 {
        // SAFETY: callers are compiled for AVX, as the module states.
        unsafe { _mm256_movemask_pd(self) }
    }
    #[inline(always)]
    unsafe fn load_columns(from: [*mut f64; 4]) -> [Self; 4] {
        // Loading by halves needs fewer moves between the halves of a register. SAFETY: guaranteed
        // by the caller.
        unsafe {
            let [p, q, r, s] = from;
            let [a, b] = Self::load_pairs(from);
            let [c, d] = Self::load_pairs([p.add(2), q.add(2), r.add(2), s.add(2)]);
            [a, b, c, d]
        }
    }
    #[inline(always)]
    unsafe fn load_pairs(from: [*mut f64; 4]) -> [Self; 2] {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let two = |k: usize| {
                let low = _mm256_castpd128_pd256(_mm_loadu_pd(from[k]));
                _mm256_insertf128_pd::<1>(low, _mm_loadu_pd(from[k + 2]))
            };
            let (ac, bd) = (two(0), two(1));
            [_mm256_unpacklo_pd(ac, bd), _mm256_unpackhi_pd(ac, bd)]
        }
    }
    #[inline(always)]
    fn rows([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        // SAFETY: callers are compiled for AVX, as the module states.
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
    #[inline(always)]
    unsafe fn store_pairs(to: [*mut f64; 4], [a, b]: [Self; 2]) {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let (ac, bd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            _mm_storeu_pd(to[0], _mm256_castpd256_pd128(ac));
            _mm_storeu_pd(to[1], _mm256_castpd256_pd128(bd));
            _mm_storeu_pd(to[2], _mm256_extractf128_pd::<1>(ac));
            _mm_storeu_pd(to[3], _mm256_extractf128_pd::<1>(bd));
        }
    }
}
