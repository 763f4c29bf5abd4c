//! A watchdog for plugin calls: native code that hangs cannot be stopped, but can be reported.

use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, mpsc};
use std::time::Duration;

/// The current call of a thread.
struct Slot {
    /// Counter of the starts and ends of calls; it is odd during a call.
    turns: AtomicU64,
    /// The law being called; never freed.
    who: AtomicPtr<String>,
    /// Index of the called function in `CALLS`.
    call: AtomicUsize,
}

/// Threads beyond this number share the last slot and are not watched.
const MAX_SLOTS: usize = 256;
static SLOTS: [Slot; MAX_SLOTS] = [const {
    Slot {
        turns: AtomicU64::new(0),
        who: AtomicPtr::new(std::ptr::null_mut()),
        call: AtomicUsize::new(0),
    }
}; MAX_SLOTS];
static THREADS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static MINE: &'static Slot =
        &SLOTS[THREADS.fetch_add(1, Ordering::Relaxed).min(MAX_SLOTS - 1)];
}

/// Names of the calls, by index.
const CALLS: [&str; 7] = [
    "initialise",
    "prepare",
    "commit",
    "energy",
    "validate",
    "loading",
    "fracture_energy",
];

/// Label of a law in reports.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label(&'static String);

/// Guard for a call in progress. If it is dropped without [`CallGuard::leave`], something unwinds
/// out of the call, and the program ends.
#[must_use]
pub(super) struct CallGuard;

impl CallGuard {
    /// The call came back.
    #[inline]
    pub fn leave(self) {
        MINE.with(|slot| slot.turns.fetch_add(1, Ordering::Relaxed));
        std::mem::forget(self);
    }
}

impl Drop for CallGuard {
    fn drop(&mut self) {
        UNWOUND.store(true, Ordering::SeqCst);
        std::process::abort();
    }
}

/// Whether the program ends because something unwound out of a law.
static UNWOUND: AtomicBool = AtomicBool::new(false);

/// Returns whether an exception or the end of its thread was about to pass from a law to its
/// caller.
pub fn was_unwound() -> bool {
    UNWOUND.load(Ordering::SeqCst)
}

/// Creates a label. It is leaked on purpose, so that it can be read whenever a call ends.
pub(super) fn label(text: String) -> Label {
    Label(Box::leak(Box::new(text)))
}

// Indices of the calls that are not in `Call`, after those that are.

/// Index of the call that validates parameters.
pub(super) const VALIDATE: usize = 4;
/// Index of the call that loads a library.
pub(super) const LOADING: usize = 5;
/// Index of the call that returns the fracture energy.
pub(super) const FRACTURE_ENERGY: usize = 6;

/// Marks the start of a call, by its index in `CALLS`.
pub(super) fn enter(label: Label, call: usize) -> CallGuard {
    MINE.with(|slot| {
        let text = std::ptr::from_ref(label.0).cast_mut();
        slot.who.store(text, Ordering::Relaxed);
        slot.call.store(call, Ordering::Relaxed);
        slot.turns.fetch_add(1, Ordering::Relaxed);
    });
    CallGuard
}

impl Slot {
    /// Returns the called law and function.
    fn named(&self) -> (&'static str, &'static str) {
        let who = self.who.load(Ordering::Relaxed);
        // SAFETY: null, or a label, which is never freed nor modified.
        let who = unsafe { who.as_ref() }.map_or("a law", String::as_str);
        let call = CALLS.get(self.call.load(Ordering::Relaxed));
        (who, call.copied().unwrap_or("a call"))
    }
}

/// Returns the law and the function that this thread is calling, if any. It takes no lock and
/// allocates no memory.
pub fn inside() -> Option<(&'static str, &'static str)> {
    let mine = MINE.try_with(|slot| *slot).ok()?;
    let called = mine.turns.load(Ordering::Relaxed) % 2 == 1;
    called.then(|| mine.named())
}

/// Action before the program ends; returns whether it saved something.
type Rescue = Box<dyn FnOnce(&str) -> bool + Send>;

static RESCUES: Mutex<Vec<(u64, Rescue)>> = Mutex::new(Vec::new());

/// Guard that keeps a rescue action registered.
#[derive(Debug)]
pub struct RescueGuard(u64);

impl Drop for RescueGuard {
    fn drop(&mut self) {
        let mut rescues = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
        rescues.retain(|(number, _)| *number != self.0);
    }
}

/// Registers an action that saves a run when a law hangs. It runs on a thread of its own while the
/// law is stuck, receives a description of the stuck call, and returns whether it saved something.
pub fn rescue(save: impl FnOnce(&str) -> bool + Send + 'static) -> RescueGuard {
    static NUMBERS: AtomicU64 = AtomicU64::new(0);
    let number = NUMBERS.fetch_add(1, Ordering::Relaxed);
    let mut rescues = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
    rescues.push((number, Box::new(save)));
    RescueGuard(number)
}

/// Result of saving when the program ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RescueOutcome {
    /// All rows and a summary are on disk.
    All,
    /// Some rows, or the summary, could not be written.
    Some,
    /// There was nothing to save.
    Nothing,
}

impl RescueOutcome {
    /// Describes the result in a sentence fragment.
    pub fn words(self) -> &'static str {
        match self {
            Self::All => "all rows up to this step and a summary.json that says so are on disk",
            Self::Some => "what was recorded up to the last flush is on disk",
            Self::Nothing => "nothing was being recorded",
        }
    }
}

/// Time limit for the rescue actions: a stuck thread may hold a lock that they need, such as that
/// of the allocator.
pub const RESCUED_WITHIN: Duration = Duration::from_secs(10);

/// Runs all rescue actions, while another thread is stuck or was stopped.
pub fn save(who: &str) -> RescueOutcome {
    let rescues = {
        let mut all = RESCUES.lock().unwrap_or_else(|e| e.into_inner());
        std::mem::take(&mut *all)
    };
    let count = rescues.len();
    let saved = rescues
        .into_iter()
        .filter_map(|(_, save)| save(who).then_some(()));
    match (count, saved.count()) {
        (0, _) => RescueOutcome::Nothing,
        (count, saved) if saved == count => RescueOutcome::All,
        _ => RescueOutcome::Some,
    }
}

/// Returns whether no rescue is registered. It does not wait, since a stopped thread may hold the
/// list.
pub fn nothing_to_save() -> bool {
    RESCUES.try_lock().is_ok_and(|rescues| rescues.is_empty())
}

/// Starts the watchdog thread, for the lifetime of the program. It reports, once, a call that
/// exceeds the limit, with the result of the rescue actions.
///
/// # Errors
/// The system cannot create a thread.
pub fn watch(
    limit: Duration,
    stuck: impl FnOnce(&str, RescueOutcome) + Send + 'static,
) -> std::io::Result<()> {
    let (call, calls) = mpsc::sync_channel::<String>(1);
    let (done, saved) = mpsc::sync_channel(1);
    let (begins, begun) = mpsc::channel();
    let begins_too = begins.clone();
    let rescuer = move || {
        let _ = begins_too.send(());
        drop(begins_too);
        if let Ok(who) = calls.recv() {
            let _ = done.send(save(&who));
        }
    };
    std::thread::Builder::new().spawn(rescuer)?;
    let looks = 20u32;
    let watcher = move || {
        // Initialises this thread's thread-local data now: a library that hangs while loading holds
        // the dynamic linker's lock, which that initialisation needs.
        let _ = saved.recv_timeout(Duration::from_millis(20));
        let _ = std::io::Write::flush(&mut std::io::stderr().lock());
        let mut seen = vec![(0, 0); MAX_SLOTS];
        let _ = begins.send(());
        drop(begins);
        let (label, at) = loop {
            std::thread::sleep(limit / looks);
            // The last slot is shared by all remaining threads.
            let slots = SLOTS[..MAX_SLOTS - 1].iter().zip(&mut seen);
            let mut late = slots.filter_map(|(slot, (turns, since))| {
                let now = slot.turns.load(Ordering::Relaxed);
                *since = if now == *turns && now % 2 == 1 {
                    *since + 1
                } else {
                    0
                };
                *turns = now;
                (*since >= looks).then(|| slot.named())
            });
            if let Some(who) = late.next() {
                break who;
            }
        };
        let who = format!(
            "{label} has not come back from {at} for {:.1} s",
            limit.as_secs_f64()
        );
        let saved = call.send(who.clone()).map_or(RescueOutcome::Some, |()| {
            saved
                .recv_timeout(RESCUED_WITHIN)
                .unwrap_or(RescueOutcome::Some)
        });
        stuck(&who, saved);
    };
    std::thread::Builder::new().spawn(watcher)?;
    // On a busy machine a library could be loaded, and hang, before these threads are fully
    // started.
    begun.iter().for_each(drop);
    Ok(())
}
