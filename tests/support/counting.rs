//! Counts allocated memory to the byte, and rejects allocations that no test may make.
#![allow(dead_code, reason = "each who counts takes the part that it needs")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Limit on the bytes held at one time, above which an allocation fails: the test then aborts, with
/// the input kept, and the machine remains usable.
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

// SAFETY: every call is passed to the system's allocator with the caller's own arguments, or
// returns null, which means a failed allocation; the counters do not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !allowed(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the layout is the caller's.
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
        // SAFETY: the layout is the caller's.
        let at = unsafe { System.alloc_zeroed(layout) };
        if !at.is_null() {
            took(layout.size());
        }
        at
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: every block comes from the system's allocator, and layouts are passed on
        // unchanged.
        unsafe { System.dealloc(at, layout) };
        HELD.fetch_sub(layout.size(), Relaxed);
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !allowed(size) {
            return std::ptr::null_mut();
        }
        // SAFETY: the block comes from the system's allocator; layout and size are the caller's.
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

/// Returns the largest number of bytes held on all threads while `work` ran, beyond those held at
/// the start.
pub fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.load(Relaxed);
    PEAK.store(before, Relaxed);
    let value = work();
    (value, PEAK.load(Relaxed).saturating_sub(before))
}
