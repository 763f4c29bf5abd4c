//! The static table of a plugin, copied and checked.

use fretwork_abi as abi;
use std::ffi::{CStr, c_char};
use std::mem::{MaybeUninit, offset_of};
use std::ptr;

/// A parameter or an internal variable.
#[derive(Clone, Debug, PartialEq)]
pub struct LawField {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One-line description.
    pub doc: String,
    /// Default or initial value.
    pub default: f64,
    /// Smallest accepted value.
    pub minimum: f64,
    /// Largest accepted value.
    pub maximum: f64,
    /// Whether a variable is written to the results.
    pub output: bool,
    /// Whether a parameter is a friction coefficient.
    pub friction: bool,
}

/// Copies the fields of the table known to both versions of the ABI.
///
/// # Safety
/// The table must be static and begin with its size and version.
pub(super) unsafe fn read_table(table: *const abi::FwPlugin) -> Result<abi::FwPlugin, String> {
    // SAFETY: size and version come first in every version of the table.
    let (size, major) = unsafe {
        (
            ptr::addr_of!((*table).size).read(),
            ptr::addr_of!((*table).abi_major).read(),
        )
    };
    if major != abi::ABI_MAJOR {
        return Err(format!(
            "it was built for version {major} of the plugin interface and this program speaks version {}; rebuild it with the header of this release",
            abi::ABI_MAJOR
        ));
    }
    // Size of the table of version 1.0; later versions only append fields.
    let least = offset_of!(abi::FwPlugin, energy) + size_of::<abi::FwCall>();
    if size < least {
        return Err(format!(
            "its table has {size} bytes, at least {least} are needed; rebuild it with fretwork.h"
        ));
    }
    let known = size.min(size_of::<abi::FwPlugin>());
    let mut copy = MaybeUninit::<abi::FwPlugin>::zeroed();
    // SAFETY: the plugin declares this size, capped at that of our struct; all-zero bytes are valid
    // for every field (null pointers, absent functions).
    unsafe {
        ptr::copy_nonoverlapping(table.cast::<u8>(), copy.as_mut_ptr().cast(), known);
        Ok(copy.assume_init())
    }
}

/// Copies a text of the table.
///
/// # Safety
/// The pointer must be null, or point to static NUL-terminated text.
pub(super) unsafe fn text(pointer: *const c_char) -> Result<String, String> {
    if pointer.is_null() {
        return Err("is null".into());
    }
    // SAFETY: not null, and NUL-terminated by the ABI.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str()
        .map(str::to_owned)
        .map_err(|_| "is not valid UTF-8".into())
}

/// Copies and checks a list of parameters or variables.
///
/// # Safety
/// The pointer must be null, or point to a static array of `n` fields.
pub(super) unsafe fn fields(
    first: *const abi::FwField,
    n: usize,
    what: &str,
) -> Result<Vec<LawField>, String> {
    const MAX_FIELDS: usize = 256;
    if n > MAX_FIELDS {
        return Err(format!(
            "it declares {n} {what}s; at most {MAX_FIELDS} are accepted"
        ));
    }
    if n > 0 && first.is_null() {
        return Err(format!("it declares {n} {what}s but their table is null"));
    }
    (0..n)
        .map(|k| {
            // SAFETY: the plugin declares `n` fields.
            let f = unsafe { &*first.add(k) };
            // SAFETY: NUL-terminated by the ABI.
            let read =
                |p| unsafe { text(p) }.map_err(|e| format!("the text of its {what} {k} {e}"));
            let name = read(f.name)?;
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(plain) {
                return Err(format!(
                    "the name `{name}` of its {what} {k} must be made of a-z, 0-9 and _ and begin with a letter"
                ));
            }
            if !f.default.is_finite() || f.minimum.is_nan() || f.maximum.is_nan() {
                return Err(format!("its {what} `{name}` has a default that is not finite or a range that is not a number"));
            }
            Ok(LawField {
                unit: read(f.unit)?,
                doc: read(f.doc)?,
                name,
                default: f.default,
                minimum: f.minimum,
                maximum: f.maximum,
                output: f.flags & abi::FIELD_OUTPUT != 0,
                friction: f.flags & abi::FIELD_FRICTION != 0,
            })
        })
        .collect()
}
