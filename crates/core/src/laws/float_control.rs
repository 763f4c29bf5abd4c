//! Floating-point control: rounding mode and treatment of subnormal numbers of a thread. The C ABI
//! requires a function to restore it before it returns; a law that does not do so would change
//! every later number of a run.

/// Floating-point control of this thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FloatControl(registers::ControlWords);

impl FloatControl {
    /// The control in force now.
    #[inline]
    pub fn now() -> Self {
        Self(registers::read())
    }

    /// Restores the control; returns whether it had changed.
    #[inline]
    pub fn restore(self) -> bool {
        let changed = registers::read() != self.0;
        if changed {
            registers::write(self.0);
        }
        changed
    }
}

#[cfg(target_arch = "x86_64")]
mod registers {
    use std::arch::asm;

    /// MXCSR without its exception flags, and the control word of the x87 unit, which `long double`
    /// in C uses.
    pub type ControlWords = (u32, u16);

    /// Exception flags of MXCSR.
    const FLAGS: u32 = 0x3f;

    #[inline]
    pub fn read() -> ControlWords {
        let (mut mxcsr, mut x87) = (0u32, 0u16);
        // SAFETY: both instructions store to places of their size, and change no register.
        unsafe {
            asm!(
                "stmxcsr [{}]", "fnstcw [{}]", in(reg) &raw mut mxcsr, in(reg) &raw mut x87,
                options(nostack, preserves_flags)
            );
        }
        (mxcsr & !FLAGS, x87)
    }

    #[cold]
    pub fn write((mxcsr, x87): ControlWords) {
        // SAFETY: the loaded values are valid control words, for which the surrounding code was
        // compiled.
        unsafe {
            asm!(
                "fnclex", "ldmxcsr [{}]", "fldcw [{}]", in(reg) &raw const mxcsr, in(reg) &raw const x87,
                options(nostack, preserves_flags)
            );
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod registers {
    use std::arch::asm;

    /// FPCR; exception flags are in another register.
    pub type ControlWords = u64;

    #[inline]
    pub fn read() -> ControlWords {
        let control: u64;
        // SAFETY: the instruction reads a register that every thread may read.
        unsafe { asm!("mrs {}, fpcr", out(reg) control, options(nomem, nostack, preserves_flags)) };
        control
    }

    #[cold]
    pub fn write(control: ControlWords) {
        // SAFETY: the value was read from the register, and the surrounding code was compiled for
        // it.
        unsafe { asm!("msr fpcr, {}", in(reg) control, options(nostack, preserves_flags)) };
    }
}

/// On other processors the control register is not known.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod registers {
    pub type ControlWords = ();

    pub fn read() -> ControlWords {}

    pub fn write((): ControlWords) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::arch::asm;
    use std::hint::black_box;

    /// Rounds upward, flushes subnormals to zero, and sets the x87 unit to single precision.
    fn disturb() {
        let (mxcsr, x87) = (0x1f80_u32 | 0x4000 | 0x8040, 0x007f_u16);
        // SAFETY: valid control words; the test restores them.
        unsafe {
            asm!("ldmxcsr [{}]", "fldcw [{}]", in(reg) &raw const mxcsr, in(reg) &raw const x87);
        }
    }

    #[test]
    fn rounding_and_subnormals_come_back() {
        let third = || black_box(1.0_f64) / black_box(3.0);
        let small = || black_box(f64::MIN_POSITIVE) / black_box(4.0);
        let before = FloatControl::now();
        assert!(!before.restore());
        let (rounded, subnormal) = (third(), small());
        disturb();
        let wrong = (third(), small());
        assert!(before.restore());
        assert_ne!(wrong.0, rounded);
        assert_eq!(wrong.1, 0.0);
        assert_eq!((third(), small()), (rounded, subnormal));
        assert_eq!(FloatControl::now(), before);
    }
}
