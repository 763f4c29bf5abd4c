//! Handling of signals that request an end. On the first one the current step is finished and the
//! results are written; a second SIGINT or SIGTERM ends the program at once.
//!
//! These signals are SIGINT (Ctrl-C) and SIGTERM, SIGHUP of a terminal that closes, and SIGXCPU and
//! SIGXFSZ of limits on processor time and file size, which the system sends repeatedly. On Windows
//! Ctrl-C arrives as SIGINT; the others are never sent there.
//!
//! A limit on processor time that ends a process at once, such as that of `ulimit -t`, is preceded
//! by its signal: the soft limit is set several seconds lower.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether somebody asked, and not a limit or a terminal.
static TOLD: AtomicBool = AtomicBool::new(false);
static SIGNAL: AtomicUsize = AtomicUsize::new(0);
static WATCH: Once = Once::new();

/// Exit code after a second signal: the command did not finish.
const ENDED: i32 = 1;

/// Signals sent by a user, and their names.
const OF_SOMEBODY: [(i32, &str); 2] = [(SIGINT, "SIGINT (Ctrl-C)"), (SIGTERM, "SIGTERM")];

/// Signals sent by a terminal or by limits.
#[cfg(unix)]
const OF_SYSTEM: [(i32, &str); 3] = [
    (libc::SIGHUP, "SIGHUP (as when a terminal closes)"),
    (
        libc::SIGXCPU,
        "SIGXCPU (the limit on the time of the processor, ulimit -t)",
    ),
    (
        libc::SIGXFSZ,
        "SIGXFSZ (the limit on the size of a file, ulimit -f)",
    ),
];
#[cfg(not(unix))]
const OF_SYSTEM: [(i32, &str); 0] = [];

/// Installs the handlers: the first signal sets the returned flag, a second one ends the program.
/// If the system allows no handler, signals keep their default action; one that is ignored
/// (`nohup`) stays ignored.
pub fn watch() -> &'static AtomicBool {
    WATCH.call_once(|| {
        for (signal, _) in OF_SOMEBODY {
            // The order matters: at the first signal the flag must not be set yet.
            let _ = flag::register_conditional_shutdown(signal, ENDED, &TOLD);
            let _ = flag::register(signal, &TOLD);
            take(signal);
        }
        for (signal, _) in OF_SYSTEM {
            if !ignored(signal) {
                take(signal);
            }
        }
        #[cfg(unix)]
        if !ignored(libc::SIGXCPU) {
            ask_before_the_end();
        }
    });
    &ASKED
}

/// Lowers the soft limit of processor time so that SIGXCPU comes before the end: if both limits are
/// equal, the process ends without a signal that it can handle.
#[cfg(unix)]
fn ask_before_the_end() {
    let mut limit = libc::rlimit {
        rlim_cur: 0,
        rlim_max: 0,
    };
    // SAFETY: the call only writes to the record.
    let known = unsafe { libc::getrlimit(libc::RLIMIT_CPU, &raw mut limit) } == 0;
    if known && let Some(earlier) = earlier_soft_limit(limit.rlim_cur, limit.rlim_max) {
        limit.rlim_cur = earlier;
        // SAFETY: the call only reads the record. If it fails, the limit is unchanged.
        unsafe { libc::setrlimit(libc::RLIMIT_CPU, &raw const limit) };
    }
}

/// Returns a new soft limit of processor time (s) for the present limits: earlier than the hard one
/// by a tenth of it, by at least one second and at most ten. `None` where there is no hard limit,
/// it is below 2 s, or the soft limit is already lower.
#[cfg(unix)]
fn earlier_soft_limit(soft: libc::rlim_t, hard: libc::rlim_t) -> Option<libc::rlim_t> {
    let limited = hard != libc::RLIM_INFINITY && soft == hard && hard >= 2;
    limited.then(|| hard - (hard / 10).clamp(1, 10))
}

/// Records a signal; called by the signal handler.
fn take(signal: i32) {
    let _ = flag::register_usize(signal, &SIGNAL, signal as usize);
    let _ = flag::register(signal, &ASKED);
}

/// Whether whoever started the program had a signal ignored.
#[cfg(unix)]
fn ignored(signal: i32) -> bool {
    // SAFETY: an all-zero action is valid memory for the answer, and nothing is changed.
    unsafe {
        let mut now: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &mut now) == 0
            && now.sa_sigaction == libc::SIG_IGN
    }
}

#[cfg(not(unix))]
fn ignored(_: i32) -> bool {
    false
}

/// Returns the name of the signal received; `None` if there was none.
pub fn asked() -> Option<&'static str> {
    if !ASKED.load(Ordering::SeqCst) {
        return None;
    }
    let signal = SIGNAL.load(Ordering::SeqCst);
    let mut all = OF_SOMEBODY.into_iter().chain(OF_SYSTEM);
    let named = all.find(|(number, _)| *number as usize == signal);
    Some(named.map_or("a signal", |(_, name)| name))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_signal_comes_before_the_end() {
        for (ends, asks) in [(2, 1), (10, 9), (60, 54), (100, 90), (3600, 3590)] {
            assert_eq!(earlier_soft_limit(ends, ends), Some(asks));
            // A lower soft limit that was set earlier is kept.
            assert_eq!(earlier_soft_limit(ends - 1, ends), None);
        }
        assert_eq!(earlier_soft_limit(1, 1), None);
        assert_eq!(
            earlier_soft_limit(libc::RLIM_INFINITY, libc::RLIM_INFINITY),
            None
        );
    }
}
