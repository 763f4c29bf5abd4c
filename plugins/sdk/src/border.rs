//! The border: from the host's columns to one contact and back. All `unsafe` of a law is here.

use crate::traits::{CohesionLaw, ContactLaw, DamageLaw, Intact, Law, Site, WearLaw};
use core::ffi::c_char;
use fretwork_abi::{
    FwBatch, FwMessage, STATUS_BAD_PARAMETER, STATUS_ERROR, STATUS_OK, STATUS_PANIC,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Internal variables a law may have.
pub const MOST_VARIABLES: usize = 16;

/// Writes a sentence and the contact at fault into the host's buffer.
fn tell(message: *mut FwMessage, contact: i64, text: &str) {
    if message.is_null() {
        return;
    }
    // SAFETY: the host gives a valid message with `capacity` bytes at `text`.
    unsafe {
        (*message).contact = contact;
        let (to, capacity) = ((*message).text, (*message).capacity);
        if to.is_null() || capacity == 0 {
            return;
        }
        let n = text.len().min(capacity - 1);
        core::ptr::copy_nonoverlapping(text.as_ptr().cast::<c_char>(), to, n);
        *to.add(n) = 0;
    }
}

fn guarded(message: *mut FwMessage, body: impl FnOnce() -> i32) -> i32 {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|cause| {
        let said = cause
            .downcast_ref::<&str>()
            .map(|s| (*s).to_owned())
            .or_else(|| cause.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        tell(message, -1, &format!("the law panicked: {said}"));
        STATUS_PANIC
    })
}

/// The host's batch, read no further than its size says.
struct Batch<'a> {
    raw: &'a FwBatch,
    size: usize,
}

macro_rules! column {
    ($batch:expr, $field:ident) => {
        if core::mem::offset_of!(FwBatch, $field) < $batch.size {
            $batch.raw.$field
        } else {
            core::ptr::null_mut() as _
        }
    };
}

#[inline(always)]
unsafe fn at(column: *const f64, k: usize) -> f64 {
    // SAFETY: a column is null or has n > k values.
    if column.is_null() {
        0.0
    } else {
        unsafe { *column.add(k) }
    }
}

#[inline(always)]
unsafe fn put(column: *mut f64, k: usize, value: f64) {
    if !column.is_null() {
        // SAFETY: as above; output columns belong to this call alone.
        unsafe { *column.add(k) = value }
    }
}

impl Batch<'_> {
    #[inline(always)]
    fn site(&self, k: usize) -> Site {
        let b = self;
        // SAFETY: k < n.
        unsafe {
            Site {
                gap: at(column!(b, gap), k),
                area: at(column!(b, area), k),
                radius: at(column!(b, radius), k),
                age: at(column!(b, age), k),
                opening: [
                    at(column!(b, opening_n), k),
                    at(column!(b, opening_t1), k),
                    at(column!(b, opening_t2), k),
                ],
                velocity: [
                    at(column!(b, velocity_n), k),
                    at(column!(b, velocity_t1), k),
                    at(column!(b, velocity_t2), k),
                ],
                impulse: [
                    at(column!(b, impulse_n), k),
                    at(column!(b, impulse_t1), k),
                    at(column!(b, impulse_t2), k),
                ],
                damage: at(column!(b, damage), k),
                h: b.raw.h,
                time: b.raw.time,
                dimension: b.raw.dimension,
            }
        }
    }
}

/// Runs `each` over the contacts of a batch, with the law and the internal variables.
fn over<L: Law>(
    raw: *const FwBatch,
    message: *mut FwMessage,
    mut each: impl FnMut(&L, &Batch, usize, &Site, &[f64], &mut [f64]) -> bool,
) -> i32 {
    guarded(message, || {
        let variables = L::VARIABLES.len();
        if raw.is_null() || variables > MOST_VARIABLES {
            tell(
                message,
                -1,
                "the batch is null, or the law has too many internal variables",
            );
            return STATUS_ERROR;
        }
        // SAFETY: the host passes a valid batch; `size` is its first field.
        let raw = unsafe { &*raw };
        let batch = Batch {
            raw,
            size: raw.size,
        };
        let count = L::FIELDS.len();
        let values: &[f64] = if count == 0 {
            &[]
        } else {
            // SAFETY: one value a parameter of the schema.
            unsafe { core::slice::from_raw_parts(raw.parameters, count) }
        };
        let law = L::read(values);
        let (mut state, mut next) = ([0.0; MOST_VARIABLES], [0.0; MOST_VARIABLES]);
        for k in 0..raw.n {
            for v in 0..variables {
                // SAFETY: one column a variable of the schema, or null.
                state[v] = unsafe {
                    if raw.state.is_null() {
                        0.0
                    } else {
                        at(*raw.state.add(v), k)
                    }
                };
                next[v] = state[v];
            }
            let site = batch.site(k);
            let fine = each(
                &law,
                &batch,
                k,
                &site,
                &state[..variables],
                &mut next[..variables],
            );
            if !fine || next[..variables].iter().any(|x| !x.is_finite()) {
                tell(
                    message,
                    k as i64,
                    &format!("the law gave a value that is not finite, at {site:?}"),
                );
                return STATUS_ERROR;
            }
            for (v, value) in next.iter().enumerate().take(variables) {
                // SAFETY: as above; `state_next` columns belong to this call.
                unsafe {
                    if !raw.state_next.is_null() {
                        put(*raw.state_next.add(v), k, *value);
                    }
                }
            }
        }
        STATUS_OK
    })
}

macro_rules! write {
    ($batch:ident, $k:ident, $($field:ident = $value:expr),* $(,)?) => {{
        let mut fine = true;
        $(
            let value: f64 = $value;
            fine &= value.is_finite();
            // SAFETY: k < n; output columns belong to this call.
            unsafe { put(column!($batch, $field), $k, value) };
        )*
        fine
    }};
}

/// `validate` of any law.
///
/// # Safety
/// As the ABI says: `values` has one value a parameter, `message` is valid or null.
pub unsafe extern "C" fn validate<L: Law>(values: *const f64, message: *mut FwMessage) -> i32 {
    guarded(message, || {
        let count = L::FIELDS.len();
        // SAFETY: one value a parameter of the schema.
        let values = if count == 0 {
            &[]
        } else {
            unsafe { core::slice::from_raw_parts(values, count) }
        };
        match L::read(values).validate() {
            Ok(()) => STATUS_OK,
            Err(reason) => {
                tell(message, -1, &reason);
                STATUS_BAD_PARAMETER
            }
        }
    })
}

/// `prepare` of a contact law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn contact_prepare<L: ContactLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, b, k, site, state, _| {
        let f = law.friction(site, state);
        write!(
            b,
            k,
            out_friction = f.mu,
            out_restitution_n = f.restitution_n,
            out_restitution_t = f.restitution_t,
            out_tension_strength = f.tension_strength,
            out_shear_cohesion = f.shear_cohesion,
            out_rolling = f.rolling,
            out_spinning = f.spinning,
        )
    })
}

/// `commit` of a contact law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn contact_commit<L: ContactLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, _, _, site, state, next| {
        law.commit(site, state, next);
        true
    })
}

/// `prepare` of a cohesion law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn cohesion_prepare<L: CohesionLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, b, k, site, state, _| {
        let t = law.traction(site, state);
        write!(
            b,
            k,
            out_traction_n = t.traction[0],
            out_traction_t1 = t.traction[1],
            out_traction_t2 = t.traction[2],
            out_stiffness_n = t.stiffness_n,
            out_stiffness_t = t.stiffness_t,
            out_damping_n = t.damping_n,
            out_damping_t = t.damping_t,
            out_tension_strength = t.tension_strength,
            out_shear_cohesion = t.shear_cohesion,
        )
    })
}

/// `energy` of a cohesion law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn cohesion_energy<L: CohesionLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, b, k, site, state, _| {
        write!(b, k, out_energy = law.energy(site, state))
    })
}

/// `commit` of a cohesion law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn cohesion_commit<L: CohesionLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, _, _, site, state, next| {
        law.commit(site, state, next);
        true
    })
}

/// `commit` of a damage law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn damage_commit<L: DamageLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, b, k, site, state, next| {
        // SAFETY: k < n.
        let intact = unsafe {
            Intact {
                energy: at(column!(b, energy_intact), k),
                traction: [
                    at(column!(b, intact_n), k),
                    at(column!(b, intact_t1), k),
                    at(column!(b, intact_t2), k),
                ],
                degradation: b.raw.degradation,
            }
        };
        write!(b, k, out_damage = law.grow(site, &intact, state, next))
    })
}

/// `commit` of a wear law.
///
/// # Safety
/// As the ABI says: a valid batch and message.
pub unsafe extern "C" fn wear_commit<L: WearLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    over::<L>(batch, message, |law, b, k, site, state, next| {
        // SAFETY: k < n.
        let (slip, work) = unsafe { (at(column!(b, slip), k), at(column!(b, friction_work), k)) };
        write!(b, k, out_volume = law.volume(site, slip, work, state, next))
    })
}
