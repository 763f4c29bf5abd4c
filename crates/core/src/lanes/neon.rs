//! Four numbers in two registers of NEON, which every machine of this architecture has.

use super::wide::Four;
use std::arch::aarch64::*;

/// Two pairs of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Pairs([float64x2_t; 2]);

#[inline(always)]
fn bits_of(x: float64x2_t) -> uint64x2_t {
    // SAFETY: the architecture has NEON.
    unsafe { vreinterpretq_u64_f64(x) }
}

#[inline(always)]
fn of_bits(x: uint64x2_t) -> float64x2_t {
    // SAFETY: the architecture has NEON.
    unsafe { vreinterpretq_f64_u64(x) }
}

/// Returns `yes` where a comparison holds, `no` elsewhere.
#[inline(always)]
fn select(mask: uint64x2_t, yes: float64x2_t, no: float64x2_t) -> float64x2_t {
    // SAFETY: the architecture has NEON.
    unsafe { vbslq_f64(mask, yes, no) }
}

macro_rules! by_two {
    ($($name:ident: |$a:ident, $b:ident| $of:expr;)+) => {$(
        #[inline(always)]
        fn $name(self, with: Self) -> Self {
            // SAFETY: the architecture has NEON.
            let of = |$a: float64x2_t, $b: float64x2_t| unsafe { $of };
            Self([of(self.0[0], with.0[0]), of(self.0[1], with.0[1])])
        }
    )+};
}

impl Four for Pairs {
    by_two! {
        add: |a, b| vaddq_f64(a, b);
        sub: |a, b| vsubq_f64(a, b);
        mul: |a, b| vmulq_f64(a, b);
        div: |a, b| vdivq_f64(a, b);
        // `vmaxq_f64` and `vminq_f64` are not used, since they treat NaN and signed zeros
        // differently.
        greatest: |a, b| select(vcgtq_f64(a, b), a, b);
        least: |a, b| select(vcgtq_f64(b, a), a, b);
        above: |a, b| of_bits(vcgtq_f64(a, b));
        at_least: |a, b| of_bits(vcgeq_f64(a, b));
        and: |a, b| of_bits(vandq_u64(bits_of(a), bits_of(b)));
        or: |a, b| of_bits(vorrq_u64(bits_of(a), bits_of(b)));
        xor: |a, b| of_bits(veorq_u64(bits_of(a), bits_of(b)));
    }
    #[inline(always)]
    fn all(x: f64) -> Self {
        // SAFETY: the architecture has NEON.
        Self([unsafe { vdupq_n_f64(x) }; 2])
    }
    #[inline(always)]
    fn new(x: [f64; 4]) -> Self {
        Self::load(&x)
    }
    #[inline(always)]
    fn load(from: &[f64; 4]) -> Self {
        // SAFETY: the array has four numbers.
        unsafe { Self([vld1q_f64(from.as_ptr()), vld1q_f64(from.as_ptr().add(2))]) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        // SAFETY: the array has four numbers.
        unsafe {
            vst1q_f64(to.as_mut_ptr(), self.0[0]);
            vst1q_f64(to.as_mut_ptr().add(2), self.0[1]);
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the architecture has NEON.
        Self(self.0.map(|x| unsafe { vsqrtq_f64(x) }))
    }
    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        Self([0, 1].map(|k| select(bits_of(mask.0[k]), yes.0[k], no.0[k])))
    }
    #[inline(always)]
    fn bits(self) -> i32 {
        // SAFETY: the architecture has NEON.
        let [a, b] = self.0.map(|x| unsafe {
            let ones = vshrq_n_u64::<63>(bits_of(x));
            vgetq_lane_u64::<0>(ones) | vgetq_lane_u64::<1>(ones) << 1
        });
        (a | b << 2) as i32
    }
    #[inline(always)]
    unsafe fn load_columns(from: [*mut f64; 4]) -> [Self; 4] {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let [a, b] = Self::load_pairs(from);
            let [c, d] = Self::load_pairs(from.map(|p| p.add(2)));
            [a, b, c, d]
        }
    }
    #[inline(always)]
    unsafe fn load_pairs(from: [*mut f64; 4]) -> [Self; 2] {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let [a, b, c, d] = from.map(|p| vld1q_f64(p));
            [
                Self([vzip1q_f64(a, b), vzip1q_f64(c, d)]),
                Self([vzip2q_f64(a, b), vzip2q_f64(c, d)]),
            ]
        }
    }
    #[inline(always)]
    fn rows([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        // SAFETY: the architecture has NEON.
        unsafe {
            let low = |k: usize| [vzip1q_f64(a.0[k], b.0[k]), vzip1q_f64(c.0[k], d.0[k])];
            let high = |k: usize| [vzip2q_f64(a.0[k], b.0[k]), vzip2q_f64(c.0[k], d.0[k])];
            [Self(low(0)), Self(high(0)), Self(low(1)), Self(high(1))]
        }
    }
    #[inline(always)]
    unsafe fn store_pairs(to: [*mut f64; 4], [a, b]: [Self; 2]) {
        // SAFETY: guaranteed by the caller.
        unsafe {
            for k in 0..2 {
                vst1q_f64(to[2 * k], vzip1q_f64(a.0[k], b.0[k]));
                vst1q_f64(to[2 * k + 1], vzip2q_f64(a.0[k], b.0[k]));
            }
        }
    }
}
