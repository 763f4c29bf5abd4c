//! Termination of the process: by the program itself, by a law through `exit`, `abort`, a fault or
//! an exception, or because the system has no more memory.

use crate::laws::child::NO_MEMORY;

/// Guard during whose lifetime an unexpected termination is reported and gets exit code 1. Has no
/// effect on systems without POSIX signals.
#[derive(Debug)]
pub struct Armed(());

/// Installs the handlers; see [`Armed`].
pub fn arm() -> Armed {
    #[cfg(unix)]
    posix::arm();
    #[cfg(not(unix))]
    crate::out_of_memory::on_allocation_failure(|bytes| {
        super::output::report(&format!("error: {}", no_memory(bytes)));
        std::process::exit(FAILED.into())
    });
    Armed(())
}

impl Drop for Armed {
    fn drop(&mut self) {
        #[cfg(unix)]
        posix::disarm();
    }
}

/// Terminates the process immediately, without running the exit handlers of libraries. A law that
/// hangs while it is loaded holds locks that these handlers need.
pub fn now(code: u8) -> ! {
    use std::io::Write;
    let _ = std::io::stdout().flush();
    #[cfg(unix)]
    // SAFETY: `_exit` does not return and runs no code of the process.
    unsafe {
        libc::_exit(code.into())
    }
    #[cfg(not(unix))]
    std::process::exit(code.into())
}

/// Exit code of a failed run.
pub const FAILED: u8 = 1;

/// Returns the message for an allocation of this size that the system refuses.
fn no_memory(bytes: usize) -> String {
    format!(
        "{NO_MEMORY}: the system refused {bytes} bytes; allow more (ulimit -v, the limit of the job), or take fewer bodies"
    )
}

#[cfg(unix)]
mod posix {
    use super::FAILED;
    use crate::laws::watch::{self, RESCUED_WITHIN, RescueOutcome};
    use crate::out_of_memory;
    use libc::c_int;
    use std::cell::Cell;
    use std::io::Read;
    use std::mem::MaybeUninit;
    use std::os::fd::IntoRawFd;
    use std::sync::atomic::{AtomicBool, AtomicI32, AtomicPtr, AtomicUsize, Ordering};
    use std::sync::{Once, OnceLock};

    /// Fault signals and their descriptions.
    const FAULTS: [(c_int, &str); 7] = [
        (libc::SIGSEGV, "SIGSEGV, an invalid memory address"),
        (libc::SIGBUS, "SIGBUS, an invalid memory access"),
        (libc::SIGFPE, "SIGFPE, an integer division by zero"),
        (libc::SIGILL, "SIGILL, an invalid instruction"),
        (libc::SIGABRT, "SIGABRT, it called abort"),
        (libc::SIGTRAP, "SIGTRAP, a trap"),
        (libc::SIGSYS, "SIGSYS, an invalid system call"),
    ];

    static ARMED: AtomicBool = AtomicBool::new(false);
    /// Whether a fault is being reported.
    static FAULT: AtomicBool = AtomicBool::new(false);
    /// File descriptor that wakes the rescue thread.
    static WAKE: AtomicI32 = AtomicI32::new(-1);
    /// Reason why the program ends, for the rescue thread.
    static WHY: AtomicPtr<Why> = AtomicPtr::new(std::ptr::null_mut());
    /// Memory that is freed when the system has no more, since saving needs some.
    static RESERVE: AtomicPtr<Vec<u8>> = AtomicPtr::new(std::ptr::null_mut());
    /// Size of the reserved memory (bytes).
    const RESERVED: usize = 8 << 20;
    /// Result of the rescue; 0 while it is running.
    static SAVED: AtomicUsize = AtomicUsize::new(0);
    const SAVED_AS: [RescueOutcome; 3] = [
        RescueOutcome::All,
        RescueOutcome::Some,
        RescueOutcome::Nothing,
    ];

    thread_local! {
        /// Whether this thread is saving what was recorded.
        static RESCUES: Cell<bool> = const { Cell::new(false) };
    }

    /// Reason why the program ends.
    enum Why {
        /// Name of a law, of its function, and how it ended there.
        Law(&'static str, &'static str, &'static str),
        /// Memory ran out, described in a sentence.
        Memory(String),
    }

    impl Why {
        fn text(&self) -> String {
            match self {
                Self::Law(law, call, how) => format!("{law} crashed in {call} ({how})"),
                Self::Memory(text) => text.clone(),
            }
        }
    }

    /// Signal actions that were installed before.
    static BEFORE: OnceLock<[libc::sigaction; FAULTS.len()]> = OnceLock::new();

    pub fn arm() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // SAFETY: `at_exit` exists as long as the program.
            unsafe { libc::atexit(at_exit) };
            wait_for_faults();
            catch_faults();
            let mut reserve = Vec::new();
            if reserve.try_reserve_exact(RESERVED).is_ok() {
                RESERVE.store(Box::into_raw(Box::new(reserve)), Ordering::SeqCst);
            }
            out_of_memory::on_allocation_failure(on_refused_memory);
        });
        ARMED.store(true, Ordering::SeqCst);
    }

    pub fn disarm() {
        ARMED.store(false, Ordering::SeqCst);
    }

    /// Exit handler for calls of `exit` by anything other than the program, which disarms it first.
    extern "C" fn at_exit() {
        if !ARMED.swap(false, Ordering::SeqCst) {
            return;
        }
        let who = match watch::inside() {
            Some((law, call)) => format!("{law} ended the program in {call} (it called exit)"),
            None => "something that a law loaded ended the program (it called exit)".to_owned(),
        };
        // A library that ends the program while it is being loaded holds a lock of the dynamic
        // linker, for which a new thread would wait.
        if watch::nothing_to_save() {
            put(&[&format!(
                "error: {who}; {}\n",
                RescueOutcome::Nothing.words()
            )]);
            super::now(FAILED);
        }
        // The thread-local variables of the calling thread are already destroyed, so another thread
        // saves the results.
        let (done, saved) = std::sync::mpsc::sync_channel(1);
        let thread = who.clone();
        let rescue = std::thread::Builder::new().spawn(move || done.send(watch::save(&thread)));
        let saved = rescue.map_or(RescueOutcome::Some, |_| {
            saved
                .recv_timeout(RESCUED_WITHIN)
                .unwrap_or(RescueOutcome::Some)
        });
        let text = format!("error: {who}; {}\n", saved.words());
        put(&[&text]);
        super::now(FAILED);
    }

    /// Starts a thread that saves the results when a fault stops another thread.
    fn wait_for_faults() {
        let Ok((mut reader, writer)) = std::io::pipe() else {
            return;
        };
        let waits = std::thread::Builder::new().spawn(move || {
            let mut byte = [0];
            if !matches!(reader.read(&mut byte), Ok(1)) {
                return;
            }
            RESCUES.with(|rescues| rescues.set(true));
            // SAFETY: the pointer is null or refers to a value that remains valid while the handler
            // waits.
            let why = unsafe { WHY.load(Ordering::SeqCst).as_ref() };
            let saved = watch::save(&why.map_or("the program ended".to_owned(), Why::text));
            let place = SAVED_AS.iter().position(|s| *s == saved).unwrap_or(1);
            SAVED.store(place + 1, Ordering::SeqCst);
        });
        if waits.is_ok() {
            WAKE.store(writer.into_raw_fd(), Ordering::SeqCst);
        }
    }

    fn catch_faults() {
        let before = FAULTS.map(|(signal, _)| {
            let mut old = MaybeUninit::<libc::sigaction>::zeroed();
            // SAFETY: the handler calls only async-signal-safe functions, on the alternate stack of
            // the standard library; an all-zero action is valid.
            unsafe {
                let mut new = MaybeUninit::<libc::sigaction>::zeroed().assume_init();
                let handler: extern "C" fn(c_int, *mut libc::siginfo_t, *mut libc::c_void) =
                    on_fault;
                new.sa_sigaction = handler as usize;
                new.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK;
                libc::sigemptyset(&mut new.sa_mask);
                libc::sigaction(signal, &new, old.as_mut_ptr());
                old.assume_init()
            }
        });
        let _ = BEFORE.set(before);
    }

    /// Reports a fault within a law and ends the program with exit code 1; any other fault goes to
    /// the previous handler.
    extern "C" fn on_fault(signal: c_int, _: *mut libc::siginfo_t, _: *mut libc::c_void) {
        let called = watch::inside().filter(|_| ARMED.load(Ordering::SeqCst));
        let Some(who) = called.filter(|_| !FAULT.swap(true, Ordering::SeqCst)) else {
            return as_before(signal);
        };
        let way = if watch::was_unwound() {
            "it threw an exception, or ended its thread"
        } else {
            name(signal)
        };
        put(&["error: ", who.0, " crashed in ", who.1, " (", way, "); "]);
        let saved = rescued(&Why::Law(who.0, who.1, way));
        put(&[saved.words(), "\n"]);
        // SAFETY: `_exit` is async-signal-safe.
        unsafe { libc::_exit(FAILED.into()) }
    }

    /// Asks the other thread to save what was recorded, and waits for it, without taking a lock or
    /// allocating memory.
    fn rescued(why: &Why) -> RescueOutcome {
        WHY.store(std::ptr::from_ref(why).cast_mut(), Ordering::SeqCst);
        let wake = WAKE.load(Ordering::SeqCst);
        // SAFETY: `write` is async-signal-safe.
        let woken = wake >= 0 && unsafe { libc::write(wake, [1u8].as_ptr().cast(), 1) } == 1;
        let mut waits = RESCUED_WITHIN.as_millis() / 5;
        while woken && waits > 0 && SAVED.load(Ordering::SeqCst) == 0 {
            pause();
            waits -= 1;
        }
        let saved = SAVED.load(Ordering::SeqCst).checked_sub(1);
        saved.map_or(RescueOutcome::Some, |k| SAVED_AS[k.min(2)])
    }

    fn pause() {
        let pause = libc::timespec {
            tv_sec: 0,
            tv_nsec: 5_000_000,
        };
        // SAFETY: `nanosleep` is async-signal-safe in practice.
        unsafe { libc::nanosleep(&pause, std::ptr::null_mut()) };
    }

    /// Reports that memory ran out, has what was recorded saved, and ends the program with exit
    /// code 1.
    fn on_refused_memory(bytes: usize) {
        if !ARMED.load(Ordering::SeqCst) {
            return;
        }
        if RESCUES.try_with(Cell::get).unwrap_or(false) {
            // Saving needs more memory than there is, so the thread that waits for it ends the
            // program.
            SAVED.store(2, Ordering::SeqCst);
        }
        if FAULT.swap(true, Ordering::SeqCst) {
            loop {
                pause();
            }
        }
        let reserve = RESERVE.swap(std::ptr::null_mut(), Ordering::SeqCst);
        if !reserve.is_null() {
            // SAFETY: the pointer was made by `Box::into_raw`, and the swap takes it only once.
            drop(unsafe { Box::from_raw(reserve) });
        }
        let text = super::no_memory(bytes);
        put(&["error: ", &text, "; "]);
        let saved = rescued(&Why::Memory(text));
        put(&[saved.words(), "\n"]);
        super::now(FAILED);
    }

    /// Restores the previous handler and lets the fault happen again.
    fn as_before(signal: c_int) {
        let place = FAULTS.iter().position(|(s, _)| *s == signal);
        let before = BEFORE.get().zip(place).map(|(all, k)| &all[k]);
        // SAFETY: these calls are async-signal-safe and restore the previous or the default action.
        unsafe {
            match before {
                Some(action) => libc::sigaction(signal, action, std::ptr::null_mut()),
                None => {
                    libc::signal(signal, libc::SIG_DFL);
                    0
                }
            };
            // A fault recurs by itself when the handler returns; a signal that was sent must be
            // raised again.
            if matches!(signal, libc::SIGABRT | libc::SIGTRAP | libc::SIGSYS) {
                libc::raise(signal);
            }
        }
    }

    fn name(signal: c_int) -> &'static str {
        let found = FAULTS.iter().find(|(s, _)| *s == signal);
        found.map_or("a signal", |(_, name)| name)
    }

    /// Writes to standard error without locks or allocation.
    fn put(parts: &[&str]) {
        for part in parts {
            // SAFETY: pointer and length belong to a string slice.
            unsafe { libc::write(2, part.as_ptr().cast(), part.len()) };
        }
    }
}
