//! Memory of large arrays in huge pages: the arrays of a step are larger than the memory that the
//! processor's translation buffer covers with pages of 4 KiB.

use crate::out_of_memory::report_allocation_failure;
use std::alloc::{GlobalAlloc, Layout, System};

/// Size from which allocations request huge pages (bytes): any block of this size contains a whole
/// page of the usual 2 MiB.
const MIN_HUGE_BYTES: usize = 4 << 20;

/// The system's allocator, which on Linux requests transparent huge pages (`madvise`,
/// `MADV_HUGEPAGE`) for large allocations. Where the kernel does not provide them, it is the plain
/// allocator of the system.
///
/// A program selects it by
/// ```
/// #[global_allocator]
/// static ALLOCATOR: fretwork_core::huge_pages::HugePages = fretwork_core::huge_pages::HugePages;
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct HugePages;

/// Requests huge pages for an allocation if it is large. A refused allocation is
/// [reported](crate::out_of_memory).
///
/// The advice remains where the system reuses the memory for small blocks; the memory that the
/// process holds can then be somewhat larger.
#[cfg(target_os = "linux")]
fn advise(start: *mut u8, size: usize) {
    if start.is_null() {
        report_allocation_failure(size);
    }
    /// A multiple of the page size of any usual machine, which `madvise` asks for.
    const PAGE: usize = 64 << 10;
    if start.is_null() || size < MIN_HUGE_BYTES {
        return;
    }
    let skipped = start.align_offset(PAGE);
    if skipped >= size {
        return;
    }
    // SAFETY: the range is inside the allocation, and the advice changes no contents. A kernel
    // without huge pages refuses, which must not appear in `errno` of a caller.
    unsafe {
        let error = *libc::__errno_location();
        libc::madvise(
            start.add(skipped).cast(),
            (size - skipped) & !(PAGE - 1),
            libc::MADV_HUGEPAGE,
        );
        *libc::__errno_location() = error;
    }
}

#[cfg(not(target_os = "linux"))]
fn advise(start: *mut u8, size: usize) {
    if start.is_null() {
        report_allocation_failure(size);
    }
}

// SAFETY: every call is passed to the system's allocator.
unsafe impl GlobalAlloc for HugePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        let start = unsafe { System.alloc(layout) };
        advise(start, layout.size());
        start
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        let start = unsafe { System.alloc_zeroed(layout) };
        advise(start, layout.size());
        start
    }

    unsafe fn dealloc(&self, start: *mut u8, layout: Layout) {
        // SAFETY: guaranteed by the caller.
        unsafe { System.dealloc(start, layout) }
    }

    unsafe fn realloc(&self, start: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        let start = unsafe { System.realloc(start, layout, size) };
        advise(start, size);
        start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contents survive growth and shrinkage across the size from which huge pages are requested.
    #[test]
    fn contents_survive() {
        let layout = |size| Layout::from_size_align(size, 64).expect("a layout");
        let sizes = [
            MIN_HUGE_BYTES / 2,
            3 * MIN_HUGE_BYTES + 12345,
            9 * MIN_HUGE_BYTES,
            MIN_HUGE_BYTES + 1,
            MIN_HUGE_BYTES / 3,
        ];
        // SAFETY: each block is used within its size, and with its layout.
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
            let zeros = HugePages.alloc_zeroed(layout(5 * MIN_HUGE_BYTES));
            assert!(
                (0..5 * MIN_HUGE_BYTES)
                    .step_by(1000)
                    .all(|k| zeros.add(k).read() == 0)
            );
            HugePages.dealloc(zeros, layout(5 * MIN_HUGE_BYTES));
        }
    }

    /// Returns the flags of the memory at an address, from the system's list.
    #[cfg(target_os = "linux")]
    fn flags(address: usize) -> String {
        let list = std::fs::read_to_string("/proc/self/smaps").expect("the list");
        let mut inside = false;
        for line in list.lines() {
            let range = line.split(' ').next().and_then(|r| r.split_once('-'));
            let ends = range.map(|(a, b)| [a, b].map(|x| usize::from_str_radix(x, 16)));
            if let Some([Ok(low), Ok(high)]) = ends {
                inside = (low..high).contains(&address);
            } else if let Some(flags) = line.strip_prefix("VmFlags:").filter(|_| inside) {
                return flags.to_owned();
            }
        }
        String::new()
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn large_blocks_ask_for_huge_pages() {
        if !std::path::Path::new("/sys/kernel/mm/transparent_hugepage").exists() {
            return;
        }
        // This is above the size up to which the system takes blocks from its heap.
        let layout = Layout::from_size_align(80 << 20, 64).expect("a layout");
        // SAFETY: each block has its layout.
        unsafe {
            for (asks, allocator) in [(true, &HugePages as &dyn GlobalAlloc), (false, &System)] {
                let block = allocator.alloc(layout);
                let flags = flags(block as usize + layout.size() / 2);
                assert_eq!(flags.split(' ').any(|f| f == "hg"), asks, "{flags}");
                allocator.dealloc(block, layout);
            }
        }
    }
}
