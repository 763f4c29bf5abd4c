//! Counts what is allocated, to the byte, and refuses what no test may ask for.
#![allow(dead_code, reason = "each who counts takes the part that it needs")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Bytes held at a time beyond which an allocation fails: the test then ends in an abort, with the
/// input kept, and the machine stays usable.
const MAX_ALLOCATION: usize = 6 << 30;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, with a count.
pub struct Counting;

fn took(bytes: usize) {
    let held = HELD.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(held, Relaxed);
}

fn allowed(bytes: usize) -> bool {
    HELD.load(Relaxed).saturating_add(bytes) <= MAX_ALLOCATION
}

// SAFETY: every call goes to the system's allocator with the caller's own arguments, or returns
// null, which stands for an allocation that failed; the counters do not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !allowed(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's own layout.
        let at = unsafe { System.alloc(layout) };
        if !at.is_null() {
            took(layout.size());
        }
        at
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !allowed(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's own layout.
        let at = unsafe { System.alloc_zeroed(layout) };
        if !at.is_null() {
            took(layout.size());
        }
        at
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: every block comes from the system's allocator, and layouts are passed on as they
        // are.
        unsafe { System.dealloc(at, layout) };
        HELD.fetch_sub(layout.size(), Relaxed);
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !allowed(size) {
            return std::ptr::null_mut();
        }
        // SAFETY: as for `dealloc`; the size is the caller's own.
        let new = unsafe { System.realloc(at, layout, size) };
        if !new.is_null() {
            took(size);
            HELD.fetch_sub(layout.size(), Relaxed);
        }
        new
    }
}

/// Bytes held now, by all threads.
pub fn held() -> usize {
    HELD.load(Relaxed)
}

/// The most bytes held at a time beyond those held at the start, while `work` ran, on all threads.
pub fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.load(Relaxed);
    PEAK.store(before, Relaxed);
    let value = work();
    (value, PEAK.load(Relaxed).saturating_sub(before))
}
