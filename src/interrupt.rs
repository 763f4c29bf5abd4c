//! Handling of SIGINT (Ctrl-C) and SIGTERM: on the first signal the current step is finished and results are
//! written; a second one ends the program at once.
//!
//! On Windows Ctrl-C arrives as SIGINT; SIGTERM is never sent there.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static SIGNAL: AtomicUsize = AtomicUsize::new(0);
static WATCH: Once = Once::new();

/// Exit code after a second signal: the command did not finish.
const ENDED: i32 = 1;

/// Installs the handlers: the first signal sets the returned flag, a second one ends the program. If the
/// system allows no handler, signals keep their default action.
pub fn watch() -> &'static AtomicBool {
    WATCH.call_once(|| {
        for signal in [SIGINT, SIGTERM] {
            // The order matters: at the first signal the flag must not be set yet.
            let _ = flag::register_conditional_shutdown(signal, ENDED, &ASKED);
            let _ = flag::register_usize(signal, &SIGNAL, signal as usize);
            let _ = flag::register(signal, &ASKED);
        }
    });
    &ASKED
}

/// Name of the signal received; `None` if there was none.
pub fn asked() -> Option<&'static str> {
    if !ASKED.load(Ordering::SeqCst) {
        return None;
    }
    let term = SIGNAL.load(Ordering::SeqCst) == SIGTERM as usize;
    Some(if term { "SIGTERM" } else { "SIGINT (Ctrl-C)" })
}
