//! Choice of vector instructions at run time, and functions that are compiled for each set.

use super::Lane;

/// Code that is compiled for vector instructions. It is called with lanes of four and of eight
/// contacts.
pub(crate) trait Wide {
    /// Runs the code. Implementations are inlined.
    fn run<L4: Lane, L8: Lane>(self);
}

/// Vector instructions of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InstructionSet {
    /// AVX2, 256 bits.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512VL, 256 bits, with twice as many registers. Separate multiplications and additions
    /// are not fused.
    #[cfg(target_arch = "x86_64")]
    Avx512,
    /// NEON, 128 bits.
    #[cfg(target_arch = "aarch64")]
    Neon,
}

#[cfg(target_arch = "x86_64")]
mod compiled {
    use super::{InstructionSet, Wide};
    use crate::lanes::wide::Lanes;
    use std::arch::x86_64::__m256d;

    impl InstructionSet {
        /// Returns the instructions that this machine has, the best last.
        pub fn of_this_machine() -> impl DoubleEndedIterator<Item = Self> {
            let avx2 = is_x86_feature_detected!("avx2");
            // `avx512` implies these features.
            let avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("fma")
                && is_x86_feature_detected!("f16c");
            let all = [(Self::Avx2, avx2), (Self::Avx512, avx2 && avx512)];
            all.into_iter()
                .filter_map(|(with, has)| has.then_some(with))
        }

        /// Runs the code compiled for these instructions.
        ///
        /// # Safety
        /// The machine must have these instructions.
        #[inline(always)]
        pub unsafe fn run(self, what: impl Wide) {
            // SAFETY: guaranteed by the caller.
            unsafe {
                match self {
                    Self::Avx2 => avx2(what),
                    Self::Avx512 => avx512(what),
                }
            }
        }
    }

    #[target_feature(enable = "avx2")]
    fn avx2(what: impl Wide) {
        what.run::<Lanes<__m256d, 1>, Lanes<__m256d, 2>>();
    }

    #[target_feature(enable = "avx2,avx512f,avx512vl,avx512dq")]
    fn avx512(what: impl Wide) {
        what.run::<Lanes<__m256d, 1>, Lanes<__m256d, 2>>();
    }
}

#[cfg(target_arch = "aarch64")]
mod compiled {
    use super::{InstructionSet, Wide};
    use crate::lanes::{neon::Pairs, wide::Lanes};

    impl InstructionSet {
        /// Returns the instructions that this machine has.
        pub fn of_this_machine() -> impl DoubleEndedIterator<Item = Self> {
            std::iter::once(Self::Neon)
        }

        /// Runs the code compiled for these instructions.
        ///
        /// # Safety
        /// The machine must have these instructions.
        #[inline(always)]
        pub unsafe fn run(self, what: impl Wide) {
            what.run::<Lanes<Pairs, 1>, Lanes<Pairs, 2>>();
        }
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod compiled {
    use super::{InstructionSet, Wide};

    impl InstructionSet {
        /// Returns no instructions, since none are known here.
        pub fn of_this_machine() -> impl DoubleEndedIterator<Item = Self> {
            std::iter::empty()
        }

        /// # Safety
        /// There are no such instructions.
        pub unsafe fn run(self, _: impl Wide) {
            match self {}
        }
    }
}

/// Prefetches a memory location that will be read soon.
#[inline(always)]
pub(crate) fn prefetch<T>(what: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: the instruction is a hint, which reads nothing.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(what.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = what;
}
