//! The static memory of a law's library (`.data` and `.bss`). A law that stores values there
//! between calls has data races.

use super::library::Plugin;

/// Reason why the static memory of a law cannot be inspected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UninspectableMemory {
    /// The law is part of the program, whose memory changes continually.
    BuiltIn,
    /// The static memory has this many bytes, more than are compared.
    TooLarge(usize),
    /// The operating system does not support the inspection.
    System,
}

/// Maximum number of bytes compared (256 MB); several copies are kept.
#[cfg(target_os = "linux")]
const MAX_BYTES: usize = 1 << 28;

/// The writable segments of the library that contains a law's functions, and of no other library.
#[derive(Debug)]
pub struct StaticMemory {
    #[cfg(target_os = "linux")]
    memory: std::fs::File,
    /// Address and length in bytes.
    #[cfg(target_os = "linux")]
    segments: Vec<(u64, usize)>,
}

#[cfg(target_os = "linux")]
impl StaticMemory {
    /// Locates the static memory of a law.
    ///
    /// # Errors
    /// It cannot be inspected.
    pub fn of(plugin: &Plugin) -> Result<Self, UninspectableMemory> {
        if plugin.built_in {
            return Err(UninspectableMemory::BuiltIn);
        }
        let memory =
            std::fs::File::open("/proc/self/mem").map_err(|_| UninspectableMemory::System)?;
        let segments = elf::writable_segments(&functions(plugin));
        if segments.is_empty() {
            return Err(UninspectableMemory::System);
        }
        let bytes: usize = segments.iter().map(|s| s.1).sum();
        if bytes > MAX_BYTES {
            return Err(UninspectableMemory::TooLarge(bytes));
        }
        Ok(Self { memory, segments })
    }

    /// Reads the current contents; `None` where the system does not allow it.
    pub fn read(&self) -> Option<Vec<u8>> {
        use std::os::unix::fs::FileExt;
        let mut bytes = Vec::new();
        for (address, length) in &self.segments {
            let start = bytes.len();
            bytes.resize(start + length, 0);
            // Read through the operating system: a direct read of memory that native code may write
            // concurrently is undefined behaviour.
            self.memory
                .read_exact_at(&mut bytes[start..], *address)
                .ok()?;
        }
        Some(bytes)
    }
}

#[cfg(not(target_os = "linux"))]
impl StaticMemory {
    /// Locates the static memory of a law.
    ///
    /// # Errors
    /// It always fails on this system.
    pub fn of(plugin: &Plugin) -> Result<Self, UninspectableMemory> {
        Err(match plugin.built_in {
            true => UninspectableMemory::BuiltIn,
            false => UninspectableMemory::System,
        })
    }

    /// Returns `None` on this system.
    pub fn read(&self) -> Option<Vec<u8>> {
        None
    }
}

/// Returns the addresses of the functions of a law.
#[cfg(target_os = "linux")]
fn functions(plugin: &Plugin) -> Vec<usize> {
    let table = &plugin.table;
    let calls = [table.prepare, table.commit, table.energy, table.initialise];
    calls.into_iter().flatten().map(|f| f as usize).collect()
}

/// Queries the dynamic linker for the loaded libraries.
#[cfg(target_os = "linux")]
mod elf {
    use std::ffi::{c_int, c_void};

    struct SegmentSearch<'a> {
        functions: &'a [usize],
        found: Vec<(u64, usize)>,
    }

    /// Returns address and length of the writable segments of the libraries that contain one of
    /// these functions.
    pub fn writable_segments(functions: &[usize]) -> Vec<(u64, usize)> {
        let mut search = SegmentSearch {
            functions,
            found: Vec::new(),
        };
        // SAFETY: the callback receives this search object only, for the duration of the call.
        unsafe { libc::dl_iterate_phdr(Some(visit), (&raw mut search).cast()) };
        search.found
    }

    unsafe extern "C" fn visit(
        info: *mut libc::dl_phdr_info,
        _size: usize,
        search: *mut c_void,
    ) -> c_int {
        // SAFETY: the linker passes a valid record and the pointer given to it.
        let (info, search) = unsafe { (&*info, &mut *search.cast::<SegmentSearch<'_>>()) };
        if info.dlpi_phdr.is_null() {
            return 0;
        }
        // SAFETY: the record declares this number of headers.
        let headers =
            unsafe { std::slice::from_raw_parts(info.dlpi_phdr, info.dlpi_phnum as usize) };
        let loaded: Vec<(usize, usize, bool)> = headers
            .iter()
            .filter(|h| h.p_type == libc::PT_LOAD)
            .map(|h| {
                let address = (info.dlpi_addr as usize).wrapping_add(h.p_vaddr as usize);
                (address, h.p_memsz as usize, h.p_flags & libc::PF_W != 0)
            })
            .collect();
        let holds = |f: &usize| loaded.iter().any(|s| (s.0..s.0 + s.1).contains(f));
        if search.functions.iter().any(holds) {
            let writable = loaded.iter().filter(|s| s.2 && s.1 > 0);
            search.found.extend(writable.map(|s| (s.0 as u64, s.1)));
        }
        0
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use crate::laws::sample_laws::bond;
    use std::sync::atomic::{AtomicU64, Ordering};

    static KEPT: AtomicU64 = AtomicU64::new(0);

    /// A change of a static variable in a law's library is detected; here the library is the test
    /// program.
    #[test]
    fn what_is_stored_in_a_static_variable_is_seen() {
        let mut plugin = (*bond().plugin).clone();
        assert_eq!(
            StaticMemory::of(&plugin).err(),
            Some(UninspectableMemory::BuiltIn)
        );
        plugin.built_in = false;
        let memory = StaticMemory::of(&plugin).unwrap();
        let holds = |value: u64| {
            // Nothing else reads the variable, so that the compiler might remove it.
            std::hint::black_box(&KEPT).store(value, Ordering::Relaxed);
            let bytes = memory.read().unwrap();
            bytes.windows(8).any(|word| *word == value.to_ne_bytes())
        };
        assert!(holds(0x1234_5678_9abc_def1) && holds(0x0fed_cba9_8765_4321));
    }
}
