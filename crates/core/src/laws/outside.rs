//! A call into the code of a law: it is timed by the watchdog, the state of thread and process is
//! restored after it, and nothing unwinds out of it.

use super::float_control::FloatControl;
use super::watch::{self, Label};
use std::sync::atomic::{AtomicBool, Ordering};

/// Records of what laws changed in the state of their callers, which was restored.
#[derive(Debug, Default)]
pub(super) struct DisturbedState {
    /// The floating-point control changed while the library was loaded.
    pub loading: AtomicBool,
    /// The floating-point control changed in a call.
    pub calling: AtomicBool,
}

/// Calls a law's function, by its index in [`watch`]. `f` calls it as a function that may unwind:
/// an exception, or the end of its thread (`pthread_exit`), ends the program here, before it passes
/// through frames of Rust.
#[inline]
pub(super) fn call<R>(
    label: Label,
    number: usize,
    disturbed: &AtomicBool,
    f: impl FnOnce() -> R,
) -> R {
    let control = FloatControl::now();
    let inside = watch::enter(label, number);
    let answer = f();
    inside.leave();
    if control.restore() {
        disturbed.store(true, Ordering::Relaxed);
    }
    answer
}

/// Runs a function that loads code, and restores the current folder of the process, to which paths
/// are relative.
pub(super) fn keep_folder<R>(f: impl FnOnce() -> R) -> R {
    let before = std::env::current_dir();
    let answer = f();
    if let Ok(before) = before
        && std::env::current_dir().ok().as_ref() != Some(&before)
    {
        let _ = std::env::set_current_dir(before);
    }
    answer
}
