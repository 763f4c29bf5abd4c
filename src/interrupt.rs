//! SIGINT (Ctrl-C) and SIGTERM: what is at hand is finished and written; a second one ends the program at once.
//!
//! On Windows Ctrl-C arrives as SIGINT; SIGTERM is never sent there.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static SIGNAL: AtomicUsize = AtomicUsize::new(0);
static WATCH: Once = Once::new();

/// Exit code of a second signal: what was asked did not finish.
const ENDED: i32 = 1;

/// From now on a first signal asks for an end and a second one ends the program. Where the system allows no handler, a signal
/// ends the program as it does without one.
pub fn watch() -> &'static AtomicBool {
    WATCH.call_once(|| {
        for signal in [SIGINT, SIGTERM] {
            // In this order: the first signal finds the flag not yet set.
            let _ = flag::register_conditional_shutdown(signal, ENDED, &ASKED);
            let _ = flag::register_usize(signal, &SIGNAL, signal as usize);
            let _ = flag::register(signal, &ASKED);
        }
    });
    &ASKED
}

/// Name of the signal that asked for an end; none where none did.
pub fn asked() -> Option<&'static str> {
    if !ASKED.load(Ordering::SeqCst) {
        return None;
    }
    let term = SIGNAL.load(Ordering::SeqCst) == SIGTERM as usize;
    Some(if term { "SIGTERM" } else { "SIGINT (Ctrl-C)" })
}
