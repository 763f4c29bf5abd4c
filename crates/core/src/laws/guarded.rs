//! Calls laws on a copy of the batch in guarded memory: guard values between the columns, and a
//! comparison of the inputs afterwards, detect every invalid write. This is too slow for a run, and
//! is used for certification.

use fretwork_abi::FwBatch;
use std::time::{Duration, Instant};

/// Guard values between columns (4 kB).
const GAP: usize = 512;
/// Guard values before the first and after the last column (256 kB).
const END: usize = 1 << 15;
/// Guard value: a NaN with a payload that no law computes.
const MARK: u64 = 0x7ff4_6a2d_0c39_9e17;

/// The memory in which a law works; reused between calls.
#[derive(Debug, Default)]
pub(super) struct Guarded {
    words: Vec<u64>,
    before: Vec<u64>,
    columns: Vec<Column>,
}

#[derive(Clone, Debug)]
struct Column {
    name: String,
    start: usize,
    len: usize,
    /// Address of the host's column; null for inputs.
    home: *mut f64,
}

// SAFETY: the addresses are used only during one call, made by the owner of the columns.
unsafe impl Send for Guarded {}

impl Column {
    fn holds(&self, word: usize) -> bool {
        (self.start..self.start + self.len).contains(&word)
    }
}

impl Guarded {
    /// Makes the call twice on a copy of the batch; returns the outputs and a description of any
    /// violation.
    ///
    /// # Safety
    /// The batch must satisfy the ABI, for a law with these numbers of parameters and variables.
    pub unsafe fn call<R>(
        &mut self,
        batch: &FwBatch,
        parameters: usize,
        variables: usize,
        mut call: impl FnMut(&FwBatch) -> R,
    ) -> (R, Option<String>) {
        let mut inside = *batch;
        // SAFETY: the caller keeps the contract of this function.
        let (state, next) = unsafe { self.lay_out(&mut inside, parameters, variables) };
        let (tables, whole) = ((state.clone(), next.clone()), bytes(&inside));
        let answer = call(&inside);
        let mut wrong = self.trespass();
        if (&state, &next) != (&tables.0, &tables.1) || bytes(&inside) != whole {
            wrong = Some("wrote to the batch itself or its lists of columns".to_owned());
        }
        let first = self.words.clone();
        for column in self.columns.iter().filter(|c| !c.home.is_null()) {
            // SAFETY: this is an output column of the host, with the length of its copy.
            unsafe {
                let from = self.words.as_ptr().add(column.start).cast::<f64>();
                std::ptr::copy_nonoverlapping(from, column.home, column.len);
            }
        }
        if wrong.is_none() {
            self.words.copy_from_slice(&self.before);
            call(&inside);
            if self.words != first {
                wrong = Some(
                    "gave two answers to the same call: it keeps data between calls".to_owned(),
                );
            }
        }
        (answer, wrong)
    }

    /// Copies all columns in, and points the batch and its lists of internal variables to the
    /// copies.
    unsafe fn lay_out(
        &mut self,
        batch: &mut FwBatch,
        parameters: usize,
        variables: usize,
    ) -> (Vec<*const f64>, Vec<*mut f64>) {
        let n = batch.n;
        self.columns.clear();
        self.words.clear();
        self.words.resize(END, MARK);
        // Position of the copy of each column, in this order; `None` for null.
        let (mut of_batch, mut of_state, mut of_next) = (Vec::new(), Vec::new(), Vec::new());
        // SAFETY: columns of the host have `n` values or are null.
        unsafe {
            of_batch.push(self.put("parameters", batch.parameters, parameters, false));
            for (name, column) in inputs(batch) {
                of_batch.push(self.put(name, *column, n, false));
            }
            for (name, column) in outputs(batch) {
                of_batch.push(self.put(name, *column, n, true));
            }
            for v in 0..variables {
                if !batch.state.is_null() {
                    let column = *batch.state.add(v);
                    of_state.push(self.put(&format!("state[{v}]"), column, n, false));
                }
                if !batch.state_next.is_null() {
                    let column = *batch.state_next.add(v);
                    of_next.push(self.put(&format!("state_next[{v}]"), column, n, true));
                }
            }
        }
        self.words.resize(self.words.len() + END, MARK);
        self.before.clone_from(&self.words);
        // The memory is not reallocated any more. All addresses derive from one pointer, through
        // which the law may also write to the guard values: such writes are to be detected.
        let words: *mut f64 = self.words.as_mut_ptr().cast();
        let address = |start: Option<usize>| match start {
            // SAFETY: the position is within the words.
            Some(start) => unsafe { words.add(start) },
            None => std::ptr::null_mut(),
        };
        let mut places = of_batch.into_iter().map(address);
        let mut next_place = || places.next().unwrap_or(std::ptr::null_mut());
        batch.parameters = next_place().cast_const();
        for (_, column) in inputs(batch) {
            *column = next_place().cast_const();
        }
        for (_, column) in outputs(batch) {
            *column = next_place();
        }
        let state: Vec<*const f64> = of_state
            .into_iter()
            .map(|s| address(s).cast_const())
            .collect();
        let next: Vec<*mut f64> = of_next.into_iter().map(address).collect();
        if !state.is_empty() {
            batch.state = state.as_ptr();
        }
        if !next.is_empty() {
            batch.state_next = next.as_ptr();
        }
        (state, next)
    }

    /// Copies a column, followed by guard values; returns its position among the words, `None` for
    /// null.
    unsafe fn put(
        &mut self,
        name: &str,
        column: *const f64,
        len: usize,
        output: bool,
    ) -> Option<usize> {
        if column.is_null() {
            return None;
        }
        let start = self.words.len();
        // SAFETY: the caller keeps the contract of this function.
        let values = unsafe { std::slice::from_raw_parts(column, len) };
        self.words.extend(values.iter().map(|x| x.to_bits()));
        self.words.resize(start + len + GAP, MARK);
        self.columns.push(Column {
            name: name.to_owned(),
            start,
            len,
            home: if output {
                column.cast_mut()
            } else {
                std::ptr::null_mut()
            },
        });
        Some(start)
    }

    /// Returns a description of any write outside the outputs.
    fn trespass(&self) -> Option<String> {
        let mut changed = (0..self.words.len()).filter(|k| self.words[*k] != self.before[*k]);
        let wrong = changed.find(|k| {
            let inside = self.columns.iter().find(|c| c.holds(*k));
            inside.is_none_or(|c| c.home.is_null())
        })?;
        if let Some(input) = self.columns.iter().find(|c| c.holds(wrong)) {
            return Some(format!(
                "wrote to the input `{}` (element {} of it)",
                input.name,
                wrong - input.start
            ));
        }
        let distance = |c: &Column| match wrong < c.start {
            true => c.start - wrong,
            false => wrong + 1 - (c.start + c.len),
        };
        let near = self.columns.iter().min_by_key(|c| distance(c))?;
        let side = if wrong < near.start {
            "before the begin"
        } else {
            "behind the end"
        };
        Some(format!(
            "wrote {} values {side} of the column `{}`",
            distance(near),
            near.name
        ))
    }
}

/// Repeats a call for a while, each time with the original outputs; returns the first result, and
/// whether any later one differs.
///
/// # Safety
/// The batch must satisfy the ABI, for a law with this number of variables.
pub(super) unsafe fn repeat<R>(
    batch: &FwBatch,
    variables: usize,
    mut call: impl FnMut(&FwBatch) -> R,
) -> (R, Option<String>) {
    /// Duration of the repetitions: several time slices of the scheduler on a busy processor.
    const WHILE: Duration = Duration::from_millis(25);
    const TIMES: u32 = 2000;
    let mut copy = *batch;
    let mut columns: Vec<*mut f64> = outputs(&mut copy).into_iter().map(|o| *o.1).collect();
    if !batch.state_next.is_null() {
        // SAFETY: there is one column per variable.
        columns.extend((0..variables).map(|v| unsafe { *batch.state_next.add(v) }));
    }
    columns.retain(|c| !c.is_null());
    let bits = |columns: &[*mut f64]| -> Vec<u64> {
        let all = columns.iter().flat_map(|c| {
            // SAFETY: an output column has `n` values.
            unsafe { std::slice::from_raw_parts(*c, batch.n) }
        });
        all.map(|x| x.to_bits()).collect()
    };
    let before = bits(&columns);
    let answer = call(batch);
    let first = bits(&columns);
    let start = Instant::now();
    let mut times = 0;
    while times < TIMES && start.elapsed() < WHILE {
        times += 1;
        for (column, values) in columns.iter().zip(before.chunks(batch.n.max(1))) {
            for (k, value) in values.iter().enumerate() {
                // SAFETY: an output column has `n` values.
                unsafe { *column.add(k) = f64::from_bits(*value) };
            }
        }
        call(batch);
        if bits(&columns) != first {
            let what = "gave two answers to the same call while other threads called it";
            return (answer, Some(what.to_owned()));
        }
    }
    (answer, None)
}

/// Returns the bytes of the batch, for comparison.
fn bytes(batch: &FwBatch) -> Vec<u8> {
    let start = std::ptr::from_ref(batch).cast::<u8>();
    // SAFETY: the struct has numbers and addresses without padding.
    unsafe { std::slice::from_raw_parts(start, size_of::<FwBatch>()) }.to_vec()
}

macro_rules! slots {
    ($batch:ident: $($name:ident)*) => { vec![$((stringify!($name), &mut $batch.$name)),*] };
}

fn inputs(batch: &mut FwBatch) -> Vec<(&'static str, &mut *const f64)> {
    slots!(batch: gap area radius age opening_n opening_t1 opening_t2 velocity_n velocity_t1 velocity_t2
        impulse_n impulse_t1 impulse_t2 damage energy_intact intact_n intact_t1 intact_t2 slip friction_work pressed
        rotation_n rotation_t1 rotation_t2 intact_moment_n intact_moment_t1 intact_moment_t2
        overlap effective_mass spring_t1 spring_t2
        spring_before_t1 spring_before_t2 temperature temperature_candidate temperature_antagonist conductivity resistivity)
}

fn outputs(batch: &mut FwBatch) -> Vec<(&'static str, &mut *mut f64)> {
    slots!(batch: out_friction out_restitution_n out_restitution_t out_tension_strength out_shear_cohesion out_rolling
        out_spinning out_traction_n out_traction_t1 out_traction_t2 out_stiffness_n out_stiffness_t out_damping_n
        out_damping_t out_energy out_damage out_volume out_moment_n out_moment_t1 out_moment_t2 out_stiffness_twist
        out_stiffness_bend out_contact_force_n out_contact_force_t1 out_contact_force_t2 out_contact_stiffness_n
        out_contact_stiffness_t out_contact_unloading_t out_contact_damping_n out_contact_damping_t
        out_conductance out_electric_conductance)
}
