//! The end of the program: its own, or one that a law makes by `exit`, `abort` or a fault.

/// From here on an end of the program that is not its own is told and has exit code 1, until this is dropped. Where the system
/// has no signals of POSIX nothing is watched.
#[derive(Debug)]
pub struct Armed(());

/// See [`Armed`].
pub fn arm() -> Armed {
    #[cfg(unix)]
    posix::arm();
    Armed(())
}

impl Drop for Armed {
    fn drop(&mut self) {
        #[cfg(unix)]
        posix::disarm();
    }
}

/// Ends the program here and now. Nothing that libraries have registered for the end is run: a law that is stuck while it is
/// loaded holds what those need.
pub fn now(code: u8) -> ! {
    use std::io::Write;
    let _ = std::io::stdout().flush();
    #[cfg(unix)]
    // SAFETY: it does not return, and runs nothing of the process.
    unsafe {
        libc::_exit(code.into())
    }
    #[cfg(not(unix))]
    std::process::exit(code.into())
}

/// The exit code of a run that failed.
pub const FAILED: u8 = 1;

#[cfg(unix)]
mod posix {
    use super::FAILED;
    use crate::laws::watch::{self, RESCUED_WITHIN, Saved};
    use libc::c_int;
    use std::io::Read;
    use std::mem::MaybeUninit;
    use std::os::fd::IntoRawFd;
    use std::sync::atomic::{AtomicBool, AtomicI32, AtomicPtr, AtomicUsize, Ordering};
    use std::sync::{Once, OnceLock};

    /// Signals of a fault, by name.
    const FAULTS: [(c_int, &str); 7] = [
        (libc::SIGSEGV, "SIGSEGV, an address that is not there"),
        (libc::SIGBUS, "SIGBUS, memory that is not there"),
        (libc::SIGFPE, "SIGFPE, a division of integers by zero"),
        (libc::SIGILL, "SIGILL, an instruction that is none"),
        (libc::SIGABRT, "SIGABRT, it called abort"),
        (libc::SIGTRAP, "SIGTRAP, a trap"),
        (libc::SIGSYS, "SIGSYS, a call of the system that is none"),
    ];

    static ARMED: AtomicBool = AtomicBool::new(false);
    /// A fault is being told.
    static FAULT: AtomicBool = AtomicBool::new(false);
    /// Where the thread that rescues is woken.
    static WAKE: AtomicI32 = AtomicI32::new(-1);
    /// Who was called where, for that thread.
    static WHO: AtomicPtr<(&str, &str)> = AtomicPtr::new(std::ptr::null_mut());
    static SIGNAL: AtomicI32 = AtomicI32::new(0);
    /// What it saved: 0 while it is at it.
    static SAVED: AtomicUsize = AtomicUsize::new(0);
    const SAVED_AS: [Saved; 3] = [Saved::All, Saved::Some, Saved::Nothing];
    /// What was done on each signal before.
    static BEFORE: OnceLock<[libc::sigaction; FAULTS.len()]> = OnceLock::new();

    pub fn arm() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // SAFETY: the function outlives the program.
            unsafe { libc::atexit(at_exit) };
            wait_for_faults();
            catch_faults();
        });
        ARMED.store(true, Ordering::SeqCst);
    }

    pub fn disarm() {
        ARMED.store(false, Ordering::SeqCst);
    }

    /// Whoever called `exit`: not the program, which disarms first.
    extern "C" fn at_exit() {
        if !ARMED.swap(false, Ordering::SeqCst) {
            return;
        }
        let who = match watch::inside() {
            Some((law, call)) => format!("{law} ended the program in {call} (it called exit)"),
            None => "something that a law loaded ended the program (it called exit)".to_owned(),
        };
        // The thread that called has given up its own variables by now: another one saves.
        let (done, saved) = std::sync::mpsc::sync_channel(1);
        let told = who.clone();
        let rescue = std::thread::Builder::new().spawn(move || done.send(watch::save(&told)));
        let saved = rescue.map_or(Saved::Some, |_| {
            saved.recv_timeout(RESCUED_WITHIN).unwrap_or(Saved::Some)
        });
        let text = format!("error: {who}; {}\n", saved.words());
        put(&[&text]);
        super::now(FAILED);
    }

    /// A thread that saves what it can when a fault stops another one.
    fn wait_for_faults() {
        let Ok((mut reader, writer)) = std::io::pipe() else {
            return;
        };
        let waits = std::thread::Builder::new().spawn(move || {
            let mut byte = [0];
            if !matches!(reader.read(&mut byte), Ok(1)) {
                return;
            }
            // SAFETY: null, or what the handler points to while it waits.
            let who = unsafe { WHO.load(Ordering::SeqCst).as_ref() };
            let (law, call) = who.copied().unwrap_or(("a law", "a call"));
            let signal = name(SIGNAL.load(Ordering::SeqCst));
            let saved = watch::save(&format!("{law} crashed in {call} ({signal})"));
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
            // SAFETY: a handler that calls only what may be called in one, on the stack that the standard library keeps for
            // handlers; zeros are a valid action.
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

    /// A fault within a law is told and ends the program with exit code 1; any other goes where it went before.
    extern "C" fn on_fault(signal: c_int, _: *mut libc::siginfo_t, _: *mut libc::c_void) {
        let called = watch::inside().filter(|_| ARMED.load(Ordering::SeqCst));
        let Some(who) = called.filter(|_| !FAULT.swap(true, Ordering::SeqCst)) else {
            return as_before(signal);
        };
        put(&[
            "error: ",
            who.0,
            " crashed in ",
            who.1,
            " (",
            name(signal),
            "); ",
        ]);
        WHO.store(std::ptr::from_ref(&who).cast_mut(), Ordering::SeqCst);
        SIGNAL.store(signal, Ordering::SeqCst);
        let wake = WAKE.load(Ordering::SeqCst);
        // SAFETY: writing to a pipe may be done in a handler.
        let woken = wake >= 0 && unsafe { libc::write(wake, [1u8].as_ptr().cast(), 1) } == 1;
        let mut waits = RESCUED_WITHIN.as_millis() / 5;
        while woken && waits > 0 && SAVED.load(Ordering::SeqCst) == 0 {
            let pause = libc::timespec {
                tv_sec: 0,
                tv_nsec: 5_000_000,
            };
            // SAFETY: sleeping may be done in a handler.
            unsafe { libc::nanosleep(&pause, std::ptr::null_mut()) };
            waits -= 1;
        }
        let saved = SAVED.load(Ordering::SeqCst).checked_sub(1);
        let saved = saved.map_or(Saved::Some, |k| SAVED_AS[k.min(2)]);
        put(&[saved.words(), "\n"]);
        // SAFETY: it may be called in a handler.
        unsafe { libc::_exit(FAILED.into()) }
    }

    /// Lets the fault happen again as if nothing had been caught.
    fn as_before(signal: c_int) {
        let place = FAULTS.iter().position(|(s, _)| *s == signal);
        let before = BEFORE.get().zip(place).map(|(all, k)| &all[k]);
        // SAFETY: what stood there before, or the system's own way; both may be set in a handler.
        unsafe {
            match before {
                Some(action) => libc::sigaction(signal, action, std::ptr::null_mut()),
                None => {
                    libc::signal(signal, libc::SIG_DFL);
                    0
                }
            };
            // A fault comes again by itself, what was sent does not.
            if matches!(signal, libc::SIGABRT | libc::SIGTRAP | libc::SIGSYS) {
                libc::raise(signal);
            }
        }
    }

    fn name(signal: c_int) -> &'static str {
        let found = FAULTS.iter().find(|(s, _)| *s == signal);
        found.map_or("a signal", |(_, name)| name)
    }

    /// Writes to standard error, without locks or memory.
    fn put(parts: &[&str]) {
        for part in parts {
            // SAFETY: the bytes of a text.
            unsafe { libc::write(2, part.as_ptr().cast(), part.len()) };
        }
    }
}
