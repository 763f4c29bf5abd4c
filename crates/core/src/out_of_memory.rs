//! What happens when the system refuses memory: whoever runs a program says so in a sentence and
//! ends it, where the standard library would abort.

use std::sync::OnceLock;

static HANDLER: OnceLock<fn(usize)> = OnceLock::new();

/// Sets what is called with the size (bytes) of an allocation that the system refused, on the
/// thread that asked for it. It may not count on memory. Where it returns, the allocation fails as
/// it would without it. The first one set stays.
///
/// It is called where the program has [`HugePages`](crate::huge_pages::HugePages) as its allocator.
pub fn on_refusal(handler: fn(usize)) {
    let _ = HANDLER.set(handler);
}

/// The system refused so many bytes.
#[cold]
pub(crate) fn refused(size: usize) {
    if let Some(handler) = HANDLER.get() {
        handler(size);
    }
}
