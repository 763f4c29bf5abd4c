//! Handling of refused allocations: a program can report them and end, where the standard library
//! would abort.

use std::sync::OnceLock;

static HANDLER: OnceLock<fn(usize)> = OnceLock::new();

/// Sets the function that is called with the size (bytes) of an allocation that the system refused,
/// on the thread that asked for it. It must not allocate. If it returns, the allocation fails as
/// without it. Only the first call has an effect.
///
/// The function is called only if the allocator of the program is
/// [`HugePages`](crate::huge_pages::HugePages).
pub fn on_allocation_failure(handler: fn(usize)) {
    let _ = HANDLER.set(handler);
}

/// Reports that the system refused an allocation of `size` bytes.
#[cold]
pub(crate) fn report_allocation_failure(size: usize) {
    if let Some(handler) = HANDLER.get() {
        handler(size);
    }
}
