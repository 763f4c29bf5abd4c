//! Control of floating point: how a thread rounds, and what it makes of subnormal numbers. It
//! belongs to the caller of a law, and by the conventions of the C ABI comes back as it was; a law
//! that does not keep to them would change every later number of a run.

/// Control of floating point of this thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FloatControl(registers::Control);

impl FloatControl {
    /// The control in force now.
    #[inline]
    pub fn now() -> Self {
        Self(registers::read())
    }

    /// Makes it as it was; returns whether it had changed.
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

    /// MXCSR without its flags of what has happened, and the control word of the x87, which long
    /// double of C uses.
    pub type Control = (u32, u16);

    /// Bits of MXCSR that say what has happened.
    const FLAGS: u32 = 0x3f;

    #[inline]
    pub fn read() -> Control {
        let (mut mxcsr, mut x87) = (0u32, 0u16);
        // SAFETY: both store to places of their size, and change no register.
        unsafe {
            asm!(
                "stmxcsr [{}]", "fnstcw [{}]", in(reg) &raw mut mxcsr, in(reg) &raw mut x87,
                options(nostack, preserves_flags)
            );
        }
        (mxcsr & !FLAGS, x87)
    }

    #[cold]
    pub fn write((mxcsr, x87): Control) {
        // SAFETY: they load what was stored: valid control words, that the code around was compiled
        // for.
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

    /// FPCR; what has happened is in another register.
    pub type Control = u64;

    #[inline]
    pub fn read() -> Control {
        let control: u64;
        // SAFETY: it reads a register that every thread may read.
        unsafe { asm!("mrs {}, fpcr", out(reg) control, options(nomem, nostack, preserves_flags)) };
        control
    }

    #[cold]
    pub fn write(control: Control) {
        // SAFETY: the value was read from the register, and the code around was compiled for it.
        unsafe { asm!("msr fpcr, {}", in(reg) control, options(nostack, preserves_flags)) };
    }
}

/// On other processors the control register is not known.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod registers {
    pub type Control = ();

    pub fn read() -> Control {}

    pub fn write((): Control) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::arch::asm;
    use std::hint::black_box;

    /// Rounds upward, flushes subnormals, and has the x87 compute in single precision.
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
