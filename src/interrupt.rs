//! Handling of signals that ask for an end: on the first one the current step is finished and results are written; a second SIGINT
//! or SIGTERM ends the program at once.
//!
//! Those are SIGINT (Ctrl-C) and SIGTERM, SIGHUP of a terminal that closes, and SIGXCPU and SIGXFSZ of limits on the time of the
//! processor and on the size of files, which the system sends again and again. On Windows Ctrl-C arrives as SIGINT; the others are
//! never sent there.

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

/// Signals of somebody, and their names.
const OF_SOMEBODY: [(i32, &str); 2] = [(SIGINT, "SIGINT (Ctrl-C)"), (SIGTERM, "SIGTERM")];

/// Signals of a terminal and of limits.
#[cfg(unix)]
const OF_SYSTEM: [(i32, &str); 3] = [
    (libc::SIGHUP, "SIGHUP, the terminal was closed"),
    (
        libc::SIGXCPU,
        "SIGXCPU, the limit on the time of the processor (ulimit -t)",
    ),
    (
        libc::SIGXFSZ,
        "SIGXFSZ, the limit on the size of a file (ulimit -f)",
    ),
];
#[cfg(not(unix))]
const OF_SYSTEM: [(i32, &str); 0] = [];

/// Installs the handlers: the first signal sets the returned flag, a second one ends the program. If the
/// system allows no handler, signals keep their default action; one that is ignored (`nohup`) stays ignored.
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
    });
    &ASKED
}

/// Notes a signal when it comes.
fn take(signal: i32) {
    let _ = flag::register_usize(signal, &SIGNAL, signal as usize);
    let _ = flag::register(signal, &ASKED);
}

/// Whether whoever started the program had a signal ignored.
#[cfg(unix)]
fn ignored(signal: i32) -> bool {
    // SAFETY: an all-zero action is a valid place for the answer, and nothing is changed.
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

/// Name of the signal received; `None` if there was none.
pub fn asked() -> Option<&'static str> {
    if !ASKED.load(Ordering::SeqCst) {
        return None;
    }
    let signal = SIGNAL.load(Ordering::SeqCst);
    let mut all = OF_SOMEBODY.into_iter().chain(OF_SYSTEM);
    let named = all.find(|(number, _)| *number as usize == signal);
    Some(named.map_or("a signal", |(_, name)| name))
}
