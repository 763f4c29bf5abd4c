//! A batch of contacts: its columns, the calls of laws with these columns, and checks of the
//! returned values.

use super::bond_step::BondStep;
use super::columns::BatchColumns;
use super::error::LawError;
use super::function::Call;
use super::guarded::{self, Guarded};
use super::interface::{Interface, LoadedLaw};
use super::library::Plugin;
use super::range::{ColumnRange, Largest, settle};
use super::step_info::StepInfo;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::threads::map_tasks;
use std::sync::{Mutex, PoisonError};

/// Number of contacts in a batch, small enough that its columns stay in a cache. The number does
/// not depend on the number of threads.
pub(super) const BATCH: usize = 512;

/// Number of batches per thread that are evaluated before their results are stored.
const TASKS_PER_THREAD: usize = 4;

/// Working memory of a batch; nothing in it outlasts the batch.
#[derive(Debug, Default)]
pub(super) struct LawBatch {
    pub columns: BatchColumns,
    /// Gaps less the part that an intact bond fills, as contacts and springs see them (m).
    pub open_gap: Vec<f64>,
    pub spring_gap: Vec<f64>,
    /// Slots of the contacts in the memory of the interface.
    pub slots: Vec<u32>,
    pub bond_step: BondStep,
    /// The reference for rounding errors of outputs.
    pub largest: Largest,
    /// Checks made on law calls.
    pub checks: CallChecks,
}

/// Checks made on the outputs of law calls.
#[derive(Debug, Default)]
pub(super) enum CallChecks {
    /// Values that are not finite or out of range, and writes just beyond a column, are errors.
    #[default]
    Run,
    /// The checks of `Run` without that of ranges, which certification makes itself.
    Lenient,
    /// The checks of `Run`; every call is made twice in guarded memory.
    Guarded(Box<Guarded>),
    /// The checks of `Lenient`; every call is repeated.
    Repeated,
}

impl LawBatch {
    /// Calls a function of a law with the columns, and checks what it wrote.
    pub fn run(
        &mut self,
        loaded: &LoadedLaw,
        info: &StepInfo,
        degradation: f64,
        call: Call,
    ) -> Result<(), LawError> {
        let plugin = &loaded.plugin;
        let (columns, checks) = (&mut self.columns, &mut self.checks);
        let mut wrong = None;
        let called = columns.with_batch(loaded, info, degradation, |batch| match checks {
            CallChecks::Guarded(guarded) => {
                let (parameters, variables) = (loaded.parameters.len(), loaded.variables());
                // SAFETY: columns of the batch have `n` values or are null and live in `self`, and
                // so do their copies.
                let (called, what) =
                    unsafe { guarded.call(batch, parameters, variables, |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            CallChecks::Repeated => {
                // SAFETY: columns of the batch have `n` values or are null, and live in `self`.
                let (called, what) =
                    unsafe { guarded::repeat(batch, loaded.variables(), |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            // SAFETY: columns of the batch have `n` values or are null, and live in `self`.
            _ => unsafe { plugin.call(call, batch) },
        });
        if let Some(what) = wrong {
            return Err(LawError::ContractViolation {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                what,
            });
        }
        if self.columns.overrun {
            let name = plugin.name.clone();
            return Err(LawError::Overrun {
                kind: plugin.kind,
                name,
                call,
            });
        }
        called?;
        self.check_outputs(loaded, plugin, call)
    }

    /// Sets the outputs to zero, then calls a function of a law as [`Self::run`] does.
    pub fn run_afresh(
        &mut self,
        loaded: &LoadedLaw,
        info: &StepInfo,
        degradation: f64,
        call: Call,
    ) -> Result<(), LawError> {
        self.columns.fit_outputs();
        self.columns.clear_outputs(loaded.plugin.kind, call);
        self.run(loaded, info, degradation, call)
    }

    /// Checks that all values that a call wrote are finite and in their range.
    fn check_outputs(
        &mut self,
        loaded: &LoadedLaw,
        plugin: &Plugin,
        call: Call,
    ) -> Result<(), LawError> {
        let mut outputs = (plugin.kind.spec().outputs)(&mut self.columns.out, call);
        let ranges: Vec<ColumnRange> = outputs.iter().map(|o| ColumnRange::of(o.values)).collect();
        let moved = matches!(call, Call::Commit | Call::Initialise);
        let states = self.columns.state_next.iter();
        let states =
            states
                .skip(loaded.first_variable)
                .take(if moved { loaded.variables() } else { 0 });
        let first = |column: &[f64]| column.iter().position(|x| !x.is_finite());
        if !ranges.iter().all(|s| s.finite) || !states.clone().all(|c| ColumnRange::of(c).finite) {
            let in_outputs = outputs.iter().filter_map(|o| first(o.values)).min();
            return Err(LawError::NotFinite {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: in_outputs.or(states.filter_map(|c| first(c)).min()),
            });
        }
        if matches!(self.checks, CallChecks::Lenient | CallChecks::Repeated) {
            return Ok(());
        }
        match settle(&mut outputs, &ranges, plugin.kind, &mut self.largest) {
            None => Ok(()),
            Some(outside) => Err(LawError::OutOfRange {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: Some(outside.contact),
                column: outside.column,
                value: outside.value,
                range: outside.range,
            }),
        }
    }
}

/// Adds the interface, and the contact if there is one, to an error of a law; `members` gives the
/// contacts of the batch.
pub(super) fn locate<S: Space>(
    law: &Interface,
    network: &Network<S>,
    members: &[usize],
    source: LawError,
) -> LawError {
    let member = source.contact().and_then(|k| members.get(k));
    let contact = member.and_then(|at| network.contacts.get(*at));
    LawError::At {
        interface: law.name.clone(),
        bodies: contact.map(|c| c.bodies),
        source: Box::new(source),
    }
}

/// Working memory for batches that are evaluated at the same time.
#[derive(Debug, Default)]
pub(super) struct BatchPool(Mutex<Vec<LawBatch>>);

impl BatchPool {
    /// Lends the memory of a batch to a function.
    pub fn with<R>(&self, of: impl FnOnce(&mut LawBatch) -> R) -> R {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let free = lock().pop();
        let mut batch = free.unwrap_or_default();
        let result = of(&mut batch);
        lock().push(batch);
        result
    }

    /// Evaluates batches, on several threads if `divide`; the plugin interface allows calls on any
    /// thread and in any order. `of` evaluates a batch, and reads shared data only. `take` stores
    /// the results in the order of the batches, a few batches at a time while they are in a cache.
    /// The result of a batch does not depend on what is stored for others.
    ///
    /// Rounding errors are compared with the largest values of all batches: a batch with a value
    /// out of range by the values known so far is evaluated again when all are known.
    ///
    /// # Errors
    /// Returns the error of the first batch that has one.
    pub fn evaluate<X: Sync, T: Send, R: Send>(
        &self,
        divide: bool,
        largest: &mut Largest,
        shared: &mut X,
        mut tasks: Vec<T>,
        of: impl Fn(&X, &mut LawBatch, &mut T) -> Result<R, LawError> + Send + Sync,
        mut take: impl FnMut(&mut X, &T, R),
    ) -> Result<(), LawError> {
        let one = |shared: &X, task: &mut T, mut largest: Largest| {
            self.with(|batch| {
                std::mem::swap(&mut batch.largest, &mut largest);
                let result = of(shared, batch, task);
                (result, std::mem::take(&mut batch.largest))
            })
        };
        let at_once = if divide {
            TASKS_PER_THREAD * rayon::current_num_threads()
        } else {
            1
        };
        let mut tasks = &mut tasks[..];
        while !tasks.is_empty() {
            let (now, later) = tasks.split_at_mut(at_once.min(tasks.len()));
            let known = std::mem::take(largest);
            let mut results = if let [task] = &mut *now {
                vec![one(shared, task, known)]
            } else {
                map_tasks(true, now.iter_mut().collect(), |task| {
                    one(shared, task, known.clone())
                })
            };
            for (_, found) in &mut results {
                largest.raise(found);
            }
            for ((mut result, _), task) in results.into_iter().zip(now) {
                if result.as_ref().is_err_and(LawError::out_of_range) {
                    for task in &mut *later {
                        let (_, found) = one(shared, task, largest.clone());
                        largest.raise(&found);
                    }
                    (result, _) = one(shared, task, largest.clone());
                }
                take(shared, task, result?);
            }
            tasks = later;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::kind::{Kind, Output};
    use crate::laws::outputs::Range;

    /// A value is below zero by round-off of the largest value, which is in another batch. The
    /// result does not depend on the number of threads.
    #[test]
    fn round_off_is_judged_by_the_largest_value_of_all_batches() {
        let check = |(): &(), batch: &mut LawBatch, column: &mut Vec<f64>| {
            let ranges = [ColumnRange::of(column)];
            let mut outputs = [Output::ranged(("strength", column, Range::NotNegative))];
            match settle(&mut outputs, &ranges, Kind::CONTACT, &mut batch.largest) {
                None => Ok(column[0]),
                Some(outside) => Err(LawError::OutOfRange {
                    kind: Kind::CONTACT,
                    name: "law".into(),
                    call: Call::Prepare,
                    contact: Some(outside.contact),
                    column: outside.column,
                    value: outside.value,
                    range: outside.range,
                }),
            }
        };
        for divide in [false, true] {
            for order in [[0, 1], [1, 0]] {
                let columns = [vec![-1e-7], vec![1e6]];
                let tasks = order.map(|k| columns[k].clone()).to_vec();
                let (pool, mut largest) = (BatchPool::default(), Largest::default());
                let mut given = Vec::new();
                let mut take = |(): &mut (), _: &Vec<f64>, x| given.push(x);
                let checked = pool.evaluate(divide, &mut largest, &mut (), tasks, check, &mut take);
                checked.unwrap();
                assert_eq!(order.map(|k| [0.0, 1e6][k]).to_vec(), given);
                let tasks = vec![vec![-1e-7], vec![-1e-3]];
                let wrong =
                    pool.evaluate(divide, &mut largest, &mut (), tasks, check, |(), _, _| ());
                assert!(wrong.unwrap_err().out_of_range());
            }
        }
    }
}
