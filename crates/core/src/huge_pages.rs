//! Memory of large arrays in huge pages: a step passes over arrays that are larger than what the processor's table of pages of 4 KiB covers.

use std::alloc::{GlobalAlloc, Layout, System};

/// Allocations from this size on are in huge pages (bytes): two pages of the usual size of 2 MiB.
const LARGE: usize = 4 << 20;

/// The system's allocator, which on Linux asks for transparent huge pages (`madvise`, `MADV_HUGEPAGE`) for large allocations. Where the kernel has none or
/// may not give them, it is the system's allocator.
///
/// A program chooses it by
/// ```
/// #[global_allocator]
/// static ALLOCATOR: fretwork_core::huge_pages::HugePages = fretwork_core::huge_pages::HugePages;
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct HugePages;

/// Asks for huge pages for an allocation.
#[cfg(target_os = "linux")]
fn advise(start: *mut u8, size: usize) {
    /// Smallest alignment that `madvise` takes on every Linux.
    const PAGE: usize = 64 << 10;
    let skipped = start.align_offset(PAGE);
    if !start.is_null() && size >= LARGE.max(skipped) {
        // SAFETY: the range is inside the allocation; the advice changes no contents, and failure has no effect.
        unsafe {
            libc::madvise(
                start.add(skipped).cast(),
                (size - skipped) & !(PAGE - 1),
                libc::MADV_HUGEPAGE,
            );
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn advise(_: *mut u8, _: usize) {}

// SAFETY: every call is the system allocator's.
unsafe impl GlobalAlloc for HugePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as asked for.
        let start = unsafe { System.alloc(layout) };
        if layout.size() >= LARGE {
            advise(start, layout.size());
        }
        start
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as asked for.
        let start = unsafe { System.alloc_zeroed(layout) };
        if layout.size() >= LARGE {
            advise(start, layout.size());
        }
        start
    }

    unsafe fn dealloc(&self, start: *mut u8, layout: Layout) {
        // SAFETY: as asked for.
        unsafe { System.dealloc(start, layout) }
    }

    unsafe fn realloc(&self, start: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as asked for.
        let start = unsafe { System.realloc(start, layout, size) };
        if size >= LARGE {
            advise(start, size);
        }
        start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contents survive growth and shrinkage across the size from which huge pages are asked for.
    #[test]
    fn contents_survive() {
        let layout = |size| Layout::from_size_align(size, 64).expect("a layout");
        let sizes = [
            LARGE / 2,
            3 * LARGE + 12345,
            9 * LARGE,
            LARGE + 1,
            LARGE / 3,
        ];
        // SAFETY: each block is used within its size, and with the layout that it has.
        unsafe {
            let mut block = HugePages.alloc_zeroed(layout(sizes[0]));
            block.write(7);
            for two in sizes.windows(2) {
                block = HugePages.realloc(block, layout(two[0]), two[1]);
                assert!(!block.is_null());
                let least = two[0].min(two[1]);
                assert_eq!((block.read(), block.add(least - 1).read()), (7, 0));
                block.add(two[1] - 1).write(0);
            }
            HugePages.dealloc(block, layout(sizes[sizes.len() - 1]));
            let zeros = HugePages.alloc_zeroed(layout(5 * LARGE));
            assert!(
                (0..5 * LARGE)
                    .step_by(1000)
                    .all(|k| zeros.add(k).read() == 0)
            );
            HugePages.dealloc(zeros, layout(5 * LARGE));
        }
    }
}
