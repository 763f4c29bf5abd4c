//! A watch over plugins: native code that does not come back cannot be stopped, but it can be named.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, mpsc};
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

/// What is to be done before the program ends; it gives whether it saved something.
type Rescue = Box<dyn FnOnce(&str) -> bool + Send>;

static RESCUES: Mutex<Vec<(u64, Rescue)>> = Mutex::new(Vec::new());

/// A rescue that stands ready until this is dropped.
#[derive(Debug)]
pub struct Ready(u64);

impl Drop for Ready {
    fn drop(&mut self) {
        let mut rescues = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
        rescues.retain(|(number, _)| *number != self.0);
    }
}

/// Makes ready what saves a run when a law does not come back. It runs on a thread of its own, beside the one that is stuck,
/// is given who is stuck where, and says whether it saved something.
pub fn rescue(save: impl FnOnce(&str) -> bool + Send + 'static) -> Ready {
    static NUMBERS: AtomicU64 = AtomicU64::new(0);
    let number = NUMBERS.fetch_add(1, Ordering::Relaxed);
    let mut rescues = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
    rescues.push((number, Box::new(save)));
    Ready(number)
}

/// Watches from a thread of its own, for the rest of the program: once, who did not come back from a call within the limit
/// is told, and whether all rescues saved something.
///
/// # Errors
/// The system gives no more threads.
pub fn watch(
    limit: Duration,
    stuck: impl FnOnce(&str, bool) + Send + 'static,
) -> std::io::Result<()> {
    /// A thread that is stuck may hold what a rescue needs, such as the lock of the allocator: it is not waited for longer.
    const RESCUED_WITHIN: Duration = Duration::from_secs(10);
    let (call, calls) = mpsc::sync_channel::<String>(1);
    let (done, saved) = mpsc::sync_channel(1);
    let rescuer = move || {
        if let Ok(who) = calls.recv() {
            let rescues = {
                let mut all = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
                std::mem::take(&mut *all)
            };
            let count = rescues.len();
            let saved = rescues
                .into_iter()
                .filter_map(|(_, save)| save(&who).then_some(()));
            let _ = done.send(count > 0 && saved.count() == count);
        }
    };
    std::thread::Builder::new().spawn(rescuer)?;
    let looks = 20u32;
    let watcher = move || {
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
        let (label, at) = (who / CALLS.len() as u64, who % CALLS.len() as u64);
        let label = {
            let labels = LABELS.lock().unwrap_or_else(|e| e.into_inner());
            labels.get(label as usize).cloned()
        };
        let who = format!(
            "{} has not come back from {} for {:.1} s",
            label.as_deref().unwrap_or("a law"),
            CALLS[at as usize],
            limit.as_secs_f64()
        );
        let saved = call
            .send(who.clone())
            .is_ok_and(|()| saved.recv_timeout(RESCUED_WITHIN).unwrap_or(false));
        stuck(&who, saved);
    };
    std::thread::Builder::new().spawn(watcher).map(drop)
}
