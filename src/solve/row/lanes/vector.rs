//! Arithmetic of four numbers a vector, and of records read by columns.

use std::arch::x86_64::*;

/// Numbers of four contacts by vector.
pub type V<const U: usize> = [__m256d; U];

/// Columns to rows.
#[inline]
#[target_feature(enable = "avx2")]
pub fn transpose(a: __m256d, b: __m256d, c: __m256d, d: __m256d) -> [__m256d; 4] {
    let (ab, ba) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (cd, dc) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        _mm256_permute2f128_pd::<0x20>(ab, cd),
        _mm256_permute2f128_pd::<0x20>(ba, dc),
        _mm256_permute2f128_pd::<0x31>(ab, cd),
        _mm256_permute2f128_pd::<0x31>(ba, dc),
    ]
}

macro_rules! by_lane {
    ($name:ident, $of:path) => {
        #[inline]
        #[target_feature(enable = "avx2")]
        pub fn $name<const U: usize>(mut a: V<U>, b: V<U>) -> V<U> {
            for u in 0..U {
                a[u] = $of(a[u], b[u]);
            }
            a
        }
    };
}
by_lane!(add, _mm256_add_pd);
by_lane!(sub, _mm256_sub_pd);
by_lane!(mul, _mm256_mul_pd);
by_lane!(div, _mm256_div_pd);
by_lane!(max, _mm256_max_pd);
by_lane!(min, _mm256_min_pd);
by_lane!(xor, _mm256_xor_pd);
by_lane!(not_above, _mm256_cmp_pd::<_CMP_LE_OQ>);

#[inline]
#[target_feature(enable = "avx2")]
pub fn all<const U: usize>(x: f64) -> V<U> {
    [_mm256_set1_pd(x); U]
}

#[inline]
#[target_feature(enable = "avx2")]
pub fn root<const U: usize>(mut a: V<U>) -> V<U> {
    for x in &mut a {
        *x = _mm256_sqrt_pd(*x);
    }
    a
}

/// `yes` where `which`, `no` elsewhere.
#[inline]
#[target_feature(enable = "avx2")]
pub fn choose<const U: usize>(which: V<U>, yes: V<U>, mut no: V<U>) -> V<U> {
    for u in 0..U {
        no[u] = _mm256_blendv_pd(no[u], yes[u], which[u]);
    }
    no
}

pub type V3<const U: usize> = [V<U>; 3];

/// a x b.
#[inline]
#[target_feature(enable = "avx2")]
pub fn cross<const U: usize>(a: V3<U>, b: V3<U>) -> V3<U> {
    [
        sub(mul(a[1], b[2]), mul(a[2], b[1])),
        sub(mul(a[2], b[0]), mul(a[0], b[2])),
        sub(mul(a[0], b[1]), mul(a[1], b[0])),
    ]
}

#[inline]
#[target_feature(enable = "avx2")]
pub fn dot<const U: usize>(a: V3<U>, b: V3<U>) -> V<U> {
    add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]))
}

/// Four numbers of each record, from the `skip`-th, as columns.
///
/// # Safety
/// There are four numbers there.
#[inline]
#[target_feature(enable = "avx2")]
pub unsafe fn load<const U: usize, T>(from: &[[*mut T; 4]; U], skip: usize) -> [V<U>; 4] {
    let mut out = [all::<U>(0.0); 4];
    for u in 0..U {
        // By halves, which takes fewer moves between lanes.
        // SAFETY: as above.
        unsafe {
            let half = |k: usize, h: usize| _mm_loadu_pd(from[u][k].cast::<f64>().add(skip + h));
            let two = |k: usize, h: usize| {
                _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(half(k, h)), half(k + 2, h))
            };
            let (ac, bd, ca, db) = (two(0, 0), two(1, 0), two(0, 2), two(1, 2));
            out[0][u] = _mm256_unpacklo_pd(ac, bd);
            out[1][u] = _mm256_unpackhi_pd(ac, bd);
            out[2][u] = _mm256_unpacklo_pd(ca, db);
            out[3][u] = _mm256_unpackhi_pd(ca, db);
        }
    }
    out
}

/// Writes what [`load`] read, for the records of a mask of four bits a vector.
///
/// # Safety
/// There are four numbers there.
#[inline]
#[target_feature(enable = "avx2")]
pub unsafe fn store<const U: usize, T>(
    to: &[[*mut T; 4]; U],
    skip: usize,
    mask: [i32; U],
    columns: [V<U>; 4],
) {
    let [a, b, c, d] = columns;
    for u in 0..U {
        let rows = transpose(a[u], b[u], c[u], d[u]);
        // SAFETY: as above.
        unsafe {
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

/// Which lanes hold a movable body.
#[inline]
#[target_feature(enable = "avx2")]
pub fn movable<const U: usize>(im: V<U>, is: V<U>) -> [i32; U] {
    let zero = _mm256_setzero_pd();
    let mut out = [0; U];
    for u in 0..U {
        let im = _mm256_cmp_pd::<_CMP_GT_OQ>(im[u], zero);
        let is = _mm256_cmp_pd::<_CMP_GT_OQ>(is[u], zero);
        out[u] = _mm256_movemask_pd(_mm256_or_pd(im, is));
    }
    out
}
