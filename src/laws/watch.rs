//! A watch over plugins: native code that does not come back cannot be stopped, but it can be named.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

/// What a thread is at.
struct Slot {
    /// Counts the begins and the ends of its calls: odd while one goes on.
    turns: AtomicU64,
    /// What it calls: the place of its label, and the call.
    who: AtomicU64,
}

/// Threads beyond so many share the last slot, and are not watched.
const MOST: usize = 256;
static SLOTS: [Slot; MOST] = [const {
    Slot {
        turns: AtomicU64::new(0),
        who: AtomicU64::new(0),
    }
}; MOST];
static THREADS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static MINE: &'static Slot =
        &SLOTS[THREADS.fetch_add(1, Ordering::Relaxed).min(MOST - 1)];
}

static LABELS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Names of the calls, in the order of their numbers.
const CALLS: [&str; 6] = [
    "initialise",
    "prepare",
    "commit",
    "energy",
    "validate",
    "loading",
];

/// What a call is told by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label(u64);

/// A call that goes on until this is dropped.
pub(super) struct Inside;

impl Drop for Inside {
    fn drop(&mut self) {
        MINE.with(|slot| slot.turns.fetch_add(1, Ordering::Relaxed));
    }
}

/// A label by which calls are told.
pub(super) fn label(text: String) -> Label {
    let mut labels = LABELS.lock().unwrap_or_else(|e| e.into_inner());
    labels.push(text);
    Label(labels.len() as u64 - 1)
}

/// Begins a call, by its number among the names above.
pub(super) fn enter(label: Label, call: usize) -> Inside {
    let who = label.0 * CALLS.len() as u64 + call as u64;
    MINE.with(|slot| {
        slot.who.store(who, Ordering::Relaxed);
        slot.turns.fetch_add(1, Ordering::Relaxed);
    });
    Inside
}

/// Watches from a thread of its own, for the rest of the program: `stuck` is told, once, who did not come back from a call
/// within the limit.
pub fn watch(limit: Duration, stuck: impl FnOnce(&str) + Send + 'static) {
    let looks = 20u32;
    std::thread::spawn(move || {
        let mut seen = vec![(0, 0); MOST];
        let who = loop {
            std::thread::sleep(limit / looks);
            // The last slot is of all threads that found no other.
            let slots = SLOTS[..MOST - 1].iter().zip(&mut seen);
            let mut late = slots.filter_map(|(slot, (turns, since))| {
                let now = slot.turns.load(Ordering::Relaxed);
                *since = if now == *turns && now % 2 == 1 {
                    *since + 1
                } else {
                    0
                };
                *turns = now;
                (*since >= looks).then(|| slot.who.load(Ordering::Relaxed))
            });
            if let Some(who) = late.next() {
                break who;
            }
        };
        let (label, call) = (who / CALLS.len() as u64, who % CALLS.len() as u64);
        let labels = LABELS.lock().unwrap_or_else(|e| e.into_inner());
        let label = labels.get(label as usize).map_or("a law", String::as_str);
        stuck(&format!(
            "{label} has not come back from {} for {:.1} s",
            CALLS[call as usize],
            limit.as_secs_f64()
        ));
    });
}
