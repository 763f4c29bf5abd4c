//! Four plain contacts at once, with the operations of [`PlainRow::update`] in their order, so with its
//! bits.

use super::{Line, Lines, PlainRow, Row};
use crate::geometry::space::{Plane, Solid, Space};
use std::any::TypeId;
use std::arch::x86_64::*;

/// Updates contacts of which none shares a movable body with another.
pub(super) fn run<S: Space>(rows: &mut [PlainRow<S>], lines: &Lines<S>, relaxation: f64) {
    let mut done = 0;
    if rows.len() >= 4 && is_x86_feature_detected!("avx2") {
        done = rows.len() & !3;
        let [rows, lines] = [rows.as_mut_ptr().cast::<u8>(), lines.at(0).cast::<u8>()];
        // SAFETY: the machine has AVX2, the types are those asked for, and bodies are as `Lines` says.
        unsafe {
            if TypeId::of::<S>() == TypeId::of::<Plane>() {
                plane(rows.cast(), done, lines.cast(), relaxation);
            } else if TypeId::of::<S>() == TypeId::of::<Solid>() {
                solid(rows.cast(), done, lines.cast(), relaxation);
            } else {
                done = 0;
            }
        }
    }
    for row in &mut rows[done..] {
        let bodies = row.bodies;
        lines.with(bodies, |a, b| row.update(a, b, relaxation));
    }
}

type V = __m256d;

/// Rows to columns.
#[inline]
#[target_feature(enable = "avx2")]
fn transpose([a, b, c, d]: [V; 4]) -> [V; 4] {
    let (ab, ba) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (cd, dc) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        _mm256_permute2f128_pd::<0x20>(ab, cd),
        _mm256_permute2f128_pd::<0x20>(ba, dc),
        _mm256_permute2f128_pd::<0x31>(ab, cd),
        _mm256_permute2f128_pd::<0x31>(ba, dc),
    ]
}

#[inline]
#[target_feature(enable = "avx2")]
fn add(a: V, b: V) -> V {
    _mm256_add_pd(a, b)
}

#[inline]
#[target_feature(enable = "avx2")]
fn sub(a: V, b: V) -> V {
    _mm256_sub_pd(a, b)
}

#[inline]
#[target_feature(enable = "avx2")]
fn mul(a: V, b: V) -> V {
    _mm256_mul_pd(a, b)
}

/// a x b.
#[inline]
#[target_feature(enable = "avx2")]
fn cross(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [
        sub(mul(a[1], b[2]), mul(a[2], b[1])),
        sub(mul(a[2], b[0]), mul(a[0], b[2])),
        sub(mul(a[0], b[1]), mul(a[1], b[0])),
    ]
}

#[inline]
#[target_feature(enable = "avx2")]
fn dot(a: [V; 3], b: [V; 3]) -> V {
    add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]))
}

/// Four numbers of each of four records, as columns.
///
/// # Safety
/// There are four numbers there.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn load(at: [*const f64; 4]) -> [V; 4] {
    // SAFETY: as above.
    transpose(at.map(|p| unsafe { _mm256_loadu_pd(p) }))
}

/// Which lanes hold a movable body.
#[inline]
#[target_feature(enable = "avx2")]
fn movable(im: V, is: V) -> i32 {
    let zero = _mm256_setzero_pd();
    let moves = |x| _mm256_cmp_pd::<_CMP_GT_OQ>(x, zero);
    _mm256_movemask_pd(_mm256_or_pd(moves(im), moves(is)))
}

/// How many contacts ahead the lines are called for.
const AHEAD: usize = 12;

/// # Safety
/// `rows` holds `count` rows, a multiple of four, of bodies of `lines`.
#[target_feature(enable = "avx2")]
unsafe fn plane(
    rows: *mut PlainRow<Plane>,
    count: usize,
    lines: *mut Line<Plane>,
    relaxation: f64,
) {
    let relaxation = _mm256_set1_pd(relaxation);
    let zero = _mm256_setzero_pd();
    let sign = _mm256_set1_pd(-0.0);
    for first in (0..count).step_by(4) {
        // SAFETY: as above; bodies of four contacts differ where they are written.
        unsafe {
            let row = [0, 1, 2, 3].map(|k| rows.add(first + k));
            if first + AHEAD + 4 <= count {
                for k in 0..4 {
                    for body in (*rows.add(first + AHEAD + k)).bodies {
                        _mm_prefetch::<_MM_HINT_T0>(lines.add(body as usize).cast());
                    }
                }
            }
            let a = row.map(|r| lines.add((*r).bodies[0] as usize));
            let b = row.map(|r| lines.add((*r).bodies[1] as usize));
            let [n0, n1, pn, pt] = load(row.map(|r| r.cast::<f64>().cast_const()));
            let [shift, iwn, iwt, mu] = load(row.map(|r| (&raw const (*r).shift)));
            let [av0, av1, a_s, aim] = load(a.map(|l| l.cast::<f64>().cast_const()));
            let [bv0, bv1, b_s, bim] = load(b.map(|l| l.cast::<f64>().cast_const()));
            let ais = _mm256_setr_pd((*a[0]).is, (*a[1]).is, (*a[2]).is, (*a[3]).is);
            let bis = _mm256_setr_pd((*b[0]).is, (*b[1]).is, (*b[2]).is, (*b[3]).is);
            let (d0, d1) = (sub(av0, bv0), sub(av1, bv1));
            let un = add(mul(n0, d0), mul(n1, d1));
            let ut = sub(sub(mul(n0, d1), mul(n1, d0)), add(a_s, b_s));
            let to_n = sub(pn, mul(add(un, shift), mul(iwn, relaxation)));
            let to_n = _mm256_max_pd(to_n, zero);
            let bound = mul(mu, to_n);
            let to_t = sub(pt, mul(ut, mul(iwt, relaxation)));
            let to_t = _mm256_max_pd(to_t, _mm256_xor_pd(bound, sign));
            let to_t = _mm256_min_pd(to_t, bound);
            let (dn, dt) = (sub(to_n, pn), sub(to_t, pt));
            let i0 = sub(mul(n0, dn), mul(n1, dt));
            let i1 = add(mul(n1, dn), mul(n0, dt));
            let (lo, hi) = (_mm256_unpacklo_pd(to_n, to_t), _mm256_unpackhi_pd(to_n, to_t));
            let parts = [
                _mm256_castpd256_pd128(lo),
                _mm256_castpd256_pd128(hi),
                _mm256_extractf128_pd::<1>(lo),
                _mm256_extractf128_pd::<1>(hi),
            ];
            for k in 0..4 {
                _mm_storeu_pd((&raw mut (*row[k]).pn), parts[k]);
            }
            let a_to = transpose([
                add(av0, mul(i0, aim)),
                add(av1, mul(i1, aim)),
                sub(a_s, mul(dt, ais)),
                aim,
            ]);
            let b_to = transpose([
                sub(bv0, mul(i0, bim)),
                sub(bv1, mul(i1, bim)),
                sub(b_s, mul(dt, bis)),
                bim,
            ]);
            let (a_moves, b_moves) = (movable(aim, ais), movable(bim, bis));
            if a_moves & b_moves == 15 {
                for k in 0..4 {
                    _mm256_store_pd(a[k].cast(), a_to[k]);
                    _mm256_store_pd(b[k].cast(), b_to[k]);
                }
            } else {
                for k in 0..4 {
                    if a_moves >> k & 1 == 1 {
                        _mm256_store_pd(a[k].cast(), a_to[k]);
                    }
                    if b_moves >> k & 1 == 1 {
                        _mm256_store_pd(b[k].cast(), b_to[k]);
                    }
                }
            }
        }
    }
}

/// # Safety
/// `rows` holds `count` rows, a multiple of four, of bodies of `lines`.
#[target_feature(enable = "avx2")]
unsafe fn solid(
    rows: *mut PlainRow<Solid>,
    count: usize,
    lines: *mut Line<Solid>,
    relaxation: f64,
) {
    let relaxation = _mm256_set1_pd(relaxation);
    let zero = _mm256_setzero_pd();
    for first in (0..count).step_by(4) {
        // SAFETY: as above; bodies of four contacts differ where they are written.
        unsafe {
            let row = [0, 1, 2, 3].map(|k| rows.add(first + k));
            if first + AHEAD + 4 <= count {
                for k in 0..4 {
                    for body in (*rows.add(first + AHEAD + k)).bodies {
                        _mm_prefetch::<_MM_HINT_T0>(lines.add(body as usize).cast());
                    }
                }
            }
            let a = row.map(|r| lines.add((*r).bodies[0] as usize));
            let b = row.map(|r| lines.add((*r).bodies[1] as usize));
            let [n0, n1, n2, pn] = load(row.map(|r| r.cast::<f64>().cast_const()));
            let n = [n0, n1, n2];
            let [t0, t1, t2, shift] = load(row.map(|r| (&raw const (*r).pt).cast()));
            let [iwn, iwt, mu, _] = load(row.map(|r| (&raw const (*r).iwn)));
            let [av0, av1, av2, as0] = load(a.map(|l| l.cast::<f64>().cast_const()));
            let [as1, as2, aim, ais] = load(a.map(|l| l.cast::<f64>().add(4).cast_const()));
            let [bv0, bv1, bv2, bs0] = load(b.map(|l| l.cast::<f64>().cast_const()));
            let [bs1, bs2, bim, bis] = load(b.map(|l| l.cast::<f64>().add(4).cast_const()));
            let d = [sub(av0, bv0), sub(av1, bv1), sub(av2, bv2)];
            let s = [add(as0, bs0), add(as1, bs1), add(as2, bs2)];
            let un = dot(n, d);
            let roll = cross(s, n);
            let ut = |k: usize| sub(sub(d[k], mul(n[k], un)), roll[k]);
            let to_n = sub(pn, mul(add(un, shift), mul(iwn, relaxation)));
            let to_n = _mm256_max_pd(to_n, zero);
            let bound = mul(mu, to_n);
            let go = mul(iwt, relaxation);
            let t = [
                sub(t0, mul(ut(0), go)),
                sub(t1, mul(ut(1), go)),
                sub(t2, mul(ut(2), go)),
            ];
            let squared = dot(t, t);
            let sticks = _mm256_cmp_pd::<_CMP_LE_OQ>(squared, mul(bound, bound));
            let less = _mm256_div_pd(bound, _mm256_sqrt_pd(squared));
            let t = t.map(|x| _mm256_blendv_pd(mul(x, less), x, sticks));
            let dn = sub(to_n, pn);
            let dt = [sub(t[0], t0), sub(t[1], t1), sub(t[2], t2)];
            let i = [
                add(mul(n0, dn), dt[0]),
                add(mul(n1, dn), dt[1]),
                add(mul(n2, dn), dt[2]),
            ];
            let w = cross(n, dt);
            let p = transpose([to_n, t[0], t[1], t[2]]);
            for k in 0..4 {
                _mm256_storeu_pd((&raw mut (*row[k]).pn), p[k]);
            }
            let a_v = transpose([
                add(av0, mul(i[0], aim)),
                add(av1, mul(i[1], aim)),
                add(av2, mul(i[2], aim)),
                sub(as0, mul(w[0], ais)),
            ]);
            let a_s = transpose([sub(as1, mul(w[1], ais)), sub(as2, mul(w[2], ais)), aim, ais]);
            let b_v = transpose([
                sub(bv0, mul(i[0], bim)),
                sub(bv1, mul(i[1], bim)),
                sub(bv2, mul(i[2], bim)),
                sub(bs0, mul(w[0], bis)),
            ]);
            let b_s = transpose([sub(bs1, mul(w[1], bis)), sub(bs2, mul(w[2], bis)), bim, bis]);
            let (a_moves, b_moves) = (movable(aim, ais), movable(bim, bis));
            for k in 0..4 {
                if a_moves >> k & 1 == 1 {
                    _mm256_store_pd(a[k].cast(), a_v[k]);
                    _mm256_store_pd(a[k].cast::<f64>().add(4), a_s[k]);
                }
                if b_moves >> k & 1 == 1 {
                    _mm256_store_pd(b[k].cast(), b_v[k]);
                    _mm256_store_pd(b[k].cast::<f64>().add(4), b_s[k]);
                }
            }
        }
    }
}
