//! The interface layer, which converts the host's columns to the values of one contact and back.
//! All `unsafe` code of a law is here.

use crate::{CohesionLaw, ContactLaw, DamageLaw, Intact, Law, Site, Table, TransportLaw, WearLaw};
use core::cell::{Cell, OnceCell};
use core::ffi::c_char;
use core::mem::{MaybeUninit, offset_of};
use fretwork_abi::{
    FLAG_COMPLIANT, FLAG_TEMPERATURE, FwBatch, FwMessage, STATUS_BAD_PARAMETER, STATUS_ERROR,
    STATUS_OK, STATUS_PANIC,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Maximum number of internal variables of a law.
pub const MAX_VARIABLES: usize = 16;

/// Writes an error message and the index of the contact that caused it into the host's buffer.
fn write_message(message: *mut FwMessage, contact: i64, text: &str) {
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
        let mut n = text.len().min(capacity - 1);
        while !text.is_char_boundary(n) {
            n -= 1;
        }
        core::ptr::copy_nonoverlapping(text.as_ptr().cast::<c_char>(), to, n);
        *to.add(n) = 0;
    }
}

/// Runs `body`, which stores the index of the current contact in the cell; panics are caught here.
fn guarded(message: *mut FwMessage, body: impl FnOnce(&Cell<i64>) -> i32) -> i32 {
    let contact = Cell::new(-1);
    catch_unwind(AssertUnwindSafe(|| body(&contact))).unwrap_or_else(|cause| {
        let said = cause
            .downcast_ref::<&str>()
            .map(|s| (*s).to_owned())
            .or_else(|| cause.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        write_message(message, contact.get(), &format!("the law panicked: {said}"));
        STATUS_PANIC
    })
}

/// Copies the host's batch up to its size. Fields that an older host does not have are zero, so
/// that a column beyond its end is null; additional fields of a newer host are ignored.
///
/// # Safety
/// `raw` is null or valid for the number of bytes in its first field.
unsafe fn known(raw: *const FwBatch) -> Option<FwBatch> {
    if raw.is_null() {
        return None;
    }
    // SAFETY: not null, and every version begins with its size.
    let size = unsafe { (&raw const (*raw).size).read() };
    if size < offset_of!(FwBatch, gap) {
        return None;
    }
    // A truncated pointer at the end must not be used.
    let size = size.min(size_of::<FwBatch>()) & !(align_of::<FwBatch>() - 1);
    let mut batch = MaybeUninit::<FwBatch>::zeroed();
    // SAFETY: both sides have `size` bytes; zeros are valid numbers and null pointers.
    unsafe {
        core::ptr::copy_nonoverlapping(raw.cast::<u8>(), batch.as_mut_ptr().cast::<u8>(), size);
        Some(batch.assume_init())
    }
}

/// # Safety
/// The column is null or has more than `k` values.
#[inline(always)]
unsafe fn at(column: *const f64, k: usize) -> f64 {
    if column.is_null() {
        0.0
    } else {
        // SAFETY: the caller guarantees that the column is null or has more than k values.
        unsafe { *column.add(k) }
    }
}

/// # Safety
/// The column must be null or have more than `k` values, and nobody else may use it during the
/// call.
#[inline(always)]
unsafe fn put(column: *mut f64, k: usize, value: f64) {
    if !column.is_null() {
        // SAFETY: the caller guarantees that the column has more than k values, and that nobody
        // else uses it.
        unsafe { *column.add(k) = value }
    }
}

/// # Safety
/// The batch must be the host's, and `k` below its `n`.
#[inline(always)]
unsafe fn site(b: &FwBatch, k: usize) -> Site {
    // SAFETY: a column is null or has n > k values.
    unsafe {
        Site {
            gap: at(b.gap, k),
            area: at(b.area, k),
            radius: at(b.radius, k),
            age: at(b.age, k),
            compression_time: at(b.pressed, k),
            rotation: [
                at(b.rotation_n, k),
                at(b.rotation_t1, k),
                at(b.rotation_t2, k),
            ],
            opening: [at(b.opening_n, k), at(b.opening_t1, k), at(b.opening_t2, k)],
            velocity: [
                at(b.velocity_n, k),
                at(b.velocity_t1, k),
                at(b.velocity_t2, k),
            ],
            impulse: [at(b.impulse_n, k), at(b.impulse_t1, k), at(b.impulse_t2, k)],
            damage: at(b.damage, k),
            overlap: at(b.overlap, k),
            effective_mass: at(b.effective_mass, k),
            spring_t: [at(b.spring_t1, k), at(b.spring_t2, k)],
            spring_before_t: [at(b.spring_before_t1, k), at(b.spring_before_t2, k)],
            temperature: at(b.temperature, k),
            temperatures: [
                at(b.temperature_candidate, k),
                at(b.temperature_antagonist, k),
            ],
            conductivity: at(b.conductivity, k),
            resistivity: at(b.resistivity, k),
            slip: at(b.slip, k),
            friction_work: at(b.friction_work, k),
            h: b.h,
            theta: b.theta,
            time: b.time,
            dimension: b.dimension,
            table: match b.table.is_null() {
                true => Table::default(),
                // The numbers are valid as long as the program runs.
                false => Table::new(core::slice::from_raw_parts(b.table, b.table_length)),
            },
        }
    }
}

/// # Safety
/// The batch must be the host's, and `k` below its `n`.
#[inline(always)]
unsafe fn intact(b: &FwBatch, k: usize) -> Intact {
    // SAFETY: a column is null or has n > k values.
    unsafe {
        Intact {
            energy: at(b.energy_intact, k),
            traction: [at(b.intact_n, k), at(b.intact_t1, k), at(b.intact_t2, k)],
            moment: [
                at(b.intact_moment_n, k),
                at(b.intact_moment_t1, k),
                at(b.intact_moment_t2, k),
            ],
            degradation: b.degradation,
        }
    }
}

/// The parameters as a slice.
///
/// # Safety
/// `values` is null or has one value per parameter of the schema.
unsafe fn parameters<'a, L: Law>(values: *const f64) -> Option<&'a [f64]> {
    match L::FIELDS.len() {
        0 => Some(&[]),
        _ if values.is_null() => None,
        // SAFETY: the caller guarantees one value per parameter of the schema.
        count => Some(unsafe { core::slice::from_raw_parts(values, count) }),
    }
}

/// Describes which value of which contact is not finite.
#[cold]
fn not_finite(message: *mut FwMessage, b: &FwBatch, k: usize, what: &str) -> i32 {
    // SAFETY: this function is called only with a contact of the batch.
    let site = unsafe { site(b, k) };
    write_message(
        message,
        k as i64,
        &format!("the law gave a value of `{what}` that is not finite, at {site:?}"),
    );
    STATUS_ERROR
}

/// Calls `each` for the contacts of a batch, with the law and the internal variables. `each` may
/// change the variables in a `COMMIT`, in which alone they are stored. It returns the name of an
/// output that is not finite.
fn over<L: Law, const COMMIT: bool>(
    raw: *const FwBatch,
    message: *mut FwMessage,
    each: impl Fn(&L, &FwBatch, usize, &Site, &mut [f64]) -> Option<&'static str>,
) -> i32 {
    const { assert!(L::VARIABLES.len() <= MAX_VARIABLES) };
    guarded(message, |contact| {
        // SAFETY: the host passes a valid batch.
        let Some(batch) = (unsafe { known(raw) }) else {
            write_message(message, -1, "the batch is null or shorter than version 1.0");
            return STATUS_ERROR;
        };
        // SAFETY: the batch has the parameters of this plugin's schema.
        let Some(values) = (unsafe { parameters::<L>(batch.parameters) }) else {
            write_message(message, -1, "the batch has no parameters");
            return STATUS_ERROR;
        };
        if L::FLAGS & FLAG_TEMPERATURE != 0 && batch.n > 0 && batch.temperature.is_null() {
            write_message(
                message,
                -1,
                "this law reads temperatures, which this program does not give: compute heat in the case, with a program of version \
                 1.1 of the plugin interface or later",
            );
            return STATUS_ERROR;
        }
        let law = L::read(values);
        let mut state = [0.0; MAX_VARIABLES];
        let state = &mut state[..L::VARIABLES.len()];
        for k in 0..batch.n {
            contact.set(k as i64);
            for (v, value) in state.iter_mut().enumerate() {
                // SAFETY: there is one column per variable of the schema, or none.
                *value = unsafe {
                    match batch.state.is_null() {
                        true => 0.0,
                        false => at(*batch.state.add(v), k),
                    }
                };
            }
            // SAFETY: k < n.
            let here = unsafe { site(&batch, k) };
            if let Some(what) = each(&law, &batch, k, &here, state) {
                return not_finite(message, &batch, k, what);
            }
            if COMMIT {
                for (v, value) in state.iter().enumerate() {
                    if !value.is_finite() {
                        let name = L::VARIABLES[v].name.to_str().unwrap_or("state_next");
                        return not_finite(message, &batch, k, name);
                    }
                    // SAFETY: there is one column per variable, k < n, and the `state_next` columns
                    // belong to this call.
                    unsafe {
                        if !batch.state_next.is_null() {
                            put(*batch.state_next.add(v), k, *value);
                        }
                    }
                }
            }
        }
        STATUS_OK
    })
}

/// Writes outputs of contact `k`; returns the name of the first that is not finite.
macro_rules! give {
    ($batch:ident, $k:ident, $($field:ident = $value:expr),* $(,)?) => {{
        let values: [f64; _] = [$($value),*];
        let mut next = values.iter();
        $(
            if let Some(value) = next.next() {
                // SAFETY: k < n; output columns belong to this call.
                unsafe { put($batch.$field, $k, *value) };
            }
        )*
        if values.iter().all(|v| v.is_finite()) {
            None
        } else {
            const NAMES: &[&str] = &[$(stringify!($field)),*];
            let first = values.iter().position(|v| !v.is_finite());
            first.map(|v| NAMES[v])
        }
    }};
}

/// The function `validate` of any law.
///
/// # Safety
/// `values` must have one value per parameter, and `message` must be valid or null, as the ABI
/// requires.
pub unsafe extern "C" fn validate<L: Law>(values: *const f64, message: *mut FwMessage) -> i32 {
    guarded(message, |_| {
        // SAFETY: one value per parameter of the schema.
        let Some(values) = (unsafe { parameters::<L>(values) }) else {
            write_message(message, -1, "no parameters were given");
            return STATUS_ERROR;
        };
        match L::read(values).validate() {
            Ok(()) => STATUS_OK,
            Err(reason) => {
                write_message(message, -1, &reason);
                STATUS_BAD_PARAMETER
            }
        }
    })
}

/// The function `fracture_energy` of any law. It returns NaN if none is declared or the law panics.
///
/// # Safety
/// `values` must have one value per parameter, as the ABI requires.
pub unsafe extern "C" fn fracture_energy<L: Law>(values: *const f64, angle: f64) -> f64 {
    let asked = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: one value per parameter of the schema.
        let values = unsafe { parameters::<L>(values) }?;
        L::read(values).fracture_energy(angle)
    }));
    asked.ok().flatten().unwrap_or(f64::NAN)
}

/// Declares functions of the table by their effect on a contact of a batch.
macro_rules! calls {
    ($($(#[$doc:meta])* $name:ident<$law:ident>, $commit:literal: $each:expr;)*) => { $(
        $(#[$doc])*
        ///
        /// # Safety
        /// Batch and message must be valid, as the ABI requires.
        pub unsafe extern "C" fn $name<L: $law>(
            batch: *const FwBatch,
            message: *mut FwMessage,
        ) -> i32 {
            over::<L, $commit>(batch, message, $each)
        }
    )* };
}

/// The function `prepare` of a contact law.
///
/// # Safety
/// Batch and message must be valid, as the ABI requires.
pub unsafe extern "C" fn contact_prepare<L: ContactLaw>(
    batch: *const FwBatch,
    message: *mut FwMessage,
) -> i32 {
    // SAFETY: the host passes a valid batch.
    let old = unsafe { known(batch) }.is_some_and(|b| b.n > 0 && b.out_contact_force_n.is_null());
    if L::FLAGS & FLAG_COMPLIANT != 0 && old {
        write_message(
            message,
            -1,
            "this law is a spring, which needs a program of version 1.1 of the plugin interface or later",
        );
        return STATUS_ERROR;
    }
    let damping = OnceCell::new();
    over::<L, false>(batch, message, |law, b, k, site, state| {
        let f = law.friction(site, state);
        let friction = give!(
            b,
            k,
            out_friction = f.mu,
            out_restitution_n = f.restitution_n,
            out_restitution_t = f.restitution_t,
            out_tension_strength = f.tension_strength,
            out_shear_cohesion = f.shear_cohesion,
            out_rolling = f.rolling,
            out_spinning = f.spinning,
        );
        if friction.is_some() || L::FLAGS & FLAG_COMPLIANT == 0 {
            return friction;
        }
        let s = law.spring(site, state, *damping.get_or_init(|| law.damping()));
        give!(
            b,
            k,
            out_contact_force_n = s.force_n,
            out_contact_force_t1 = s.force_t[0],
            out_contact_force_t2 = s.force_t[1],
            out_contact_stiffness_n = s.stiffness_n,
            out_contact_stiffness_t = s.stiffness_t,
            out_contact_unloading_t = s.unloading_t,
            out_energy = s.energy_t,
            out_contact_damping_n = s.damping_n,
            out_contact_damping_t = s.damping_t,
        )
    })
}

calls! {
    /// The function `commit` of a contact law.
    contact_commit<ContactLaw>, true: |law: &L, _, _, site, state| {
        law.commit(site, state);
        None
    };

    /// The function `prepare` of a cohesion law.
    cohesion_prepare<CohesionLaw>, false: |law: &L, b, k, site, state| {
        let t = law.traction(site, state);
        give!(
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
            out_moment_n = t.moment[0],
            out_moment_t1 = t.moment[1],
            out_moment_t2 = t.moment[2],
            out_stiffness_twist = t.stiffness_twist,
            out_stiffness_bend = t.stiffness_bend,
        )
    };

    /// The function `energy` of a cohesion law.
    cohesion_energy<CohesionLaw>, false: |law: &L, b, k, site, state| {
        give!(b, k, out_energy = law.energy(site, state))
    };

    /// The function `commit` of a cohesion law.
    cohesion_commit<CohesionLaw>, true: |law: &L, b, k, site, state| {
        give!(b, k, out_damage = law.commit(site, state))
    };

    /// The function `commit` of a damage law.
    damage_commit<DamageLaw>, true: |law: &L, b, k, site, state| {
        // SAFETY: k < n.
        let intact = unsafe { intact(b, k) };
        give!(b, k, out_damage = law.grow(site, &intact, state))
    };

    /// The function `commit` of a wear law.
    wear_commit<WearLaw>, true: |law: &L, b, k, site, state| {
        give!(b, k, out_volume = law.volume(site, state))
    };

    /// The function `commit` of a transport law.
    transport_commit<TransportLaw>, true: |law: &L, b, k, site, state| {
        let conductance = law.conductance(site, state);
        give!(
            b,
            k,
            out_conductance = conductance.thermal,
            out_electric_conductance = conductance.electric,
        )
    };
}
