//! Evaluation of the laws in a step: batches of contacts, calls of the plugins, and checks of what they return.

use super::bonds::BondStep;
use super::columns::{Columns, StepInfo, not_finite};
use super::error::LawError;
use super::guarded::{self, Guarded};
use super::history::LawHistory;
use super::interface::{Interface, Loaded};
use super::library::{Call, Plugin};
use super::range::settle;
use crate::contact::{Contact, Network};
use crate::geometry::space::Space;

/// Evaluates the laws; owns the working memory of prepare and commit, and nothing that outlasts a step.
#[derive(Debug, Default)]
pub struct LawEvaluator {
    pub(super) columns: Columns,
    pub(super) members: Vec<usize>,
    pub(super) bond_step: BondStep,
    /// Interface, slot and damage of the bonds in the last trial of an implicit coupling.
    pub(super) trials: Vec<(usize, usize, f64)>,
    /// Contacts of the last solve that close within the step and were kept from closing although their law
    /// has restitution.
    pub(crate) held_back: Vec<usize>,
    /// Place of the moments of each contact in the step, while bonds that resist rotation are committed.
    pub(super) moment_places: Vec<u32>,
    /// Which checks are made on law calls.
    pub(super) checks: CallChecks,
    /// Whether passes over contacts may be divided among threads.
    pub parallel: bool,
}

/// Contacts of a batch: few enough that its columns stay in a cache.
const BATCH: usize = 512;

/// Checks made on the outputs of law calls.
#[derive(Debug, Default)]
pub(super) enum CallChecks {
    /// Errors for values that are not finite or out of range, and for writes just beyond a column.
    #[default]
    Run,
    /// As `Run`, but without the range check, which certification makes itself.
    Lenient,
    /// As `Run`; in addition every call is made twice in guarded memory.
    Guarded(Box<Guarded>),
    /// As `Lenient`; in addition every call is repeated.
    Repeated,
}

impl LawEvaluator {
    /// Makes the contacts that a test accepts the members of the batch.
    pub(super) fn select<S: Space>(
        &mut self,
        network: &Network<S>,
        keep: impl Fn(&Contact<S>) -> bool,
    ) {
        self.members.clear();
        self.select_more(network, keep);
    }

    /// Adds the contacts that a test accepts to the members.
    pub(super) fn select_more<S: Space>(
        &mut self,
        network: &Network<S>,
        keep: impl Fn(&Contact<S>) -> bool,
    ) {
        let contacts = network.contacts.iter().enumerate();
        self.members
            .extend(contacts.filter(|(_, c)| keep(c)).map(|(k, _)| k));
    }

    /// Does something for the members in batches, one after the other; those of a batch are the members meanwhile.
    pub(super) fn in_batches(
        &mut self,
        mut each: impl FnMut(&mut Self) -> Result<(), LawError>,
    ) -> Result<(), LawError> {
        if self.members.len() <= BATCH {
            return if self.members.is_empty() {
                Ok(())
            } else {
                each(self)
            };
        }
        let all = std::mem::take(&mut self.members);
        let mut done = Ok(());
        for batch in all.chunks(BATCH) {
            self.members.clear();
            self.members.extend_from_slice(batch);
            done = each(self);
            if done.is_err() {
                break;
            }
        }
        self.members = all;
        done
    }

    /// Calls a function of a law with the columns, and checks what it wrote.
    pub(super) fn run(
        &mut self,
        loaded: &Loaded,
        history: &mut LawHistory,
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
                // SAFETY: as below, and copies of the columns are as long as they.
                let (called, what) =
                    unsafe { guarded.call(batch, parameters, variables, |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            CallChecks::Repeated => {
                // SAFETY: as below.
                let (called, what) =
                    unsafe { guarded::repeat(batch, loaded.variables(), |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            // SAFETY: columns of the batch have `n` values or are null, and live in `self`.
            _ => unsafe { plugin.call(call, batch) },
        });
        if let Some(what) = wrong {
            return Err(LawError::Trespass {
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
        self.check_outputs(plugin, history, call)
    }

    /// Checks that all that a call wrote is finite and in its range.
    fn check_outputs(
        &mut self,
        plugin: &Plugin,
        history: &mut LawHistory,
        call: Call,
    ) -> Result<(), LawError> {
        let state = match call {
            Call::Commit | Call::Initialise => self.columns.state_not_finite(),
            _ => None,
        };
        let mut outputs = (plugin.kind.spec().outputs)(&mut self.columns.out, call);
        if let Some(contact) = not_finite(&outputs).or(state) {
            return Err(LawError::NotFinite {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: Some(contact),
            });
        }
        if matches!(self.checks, CallChecks::Lenient | CallChecks::Repeated) {
            return Ok(());
        }
        match settle(&mut outputs, plugin.kind, &mut history.largest) {
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

    /// Adds the interface and the contact, one of the members, to an error of a law.
    pub(super) fn locate<S: Space>(
        &self,
        law: &Interface,
        network: &Network<S>,
        source: LawError,
    ) -> LawError {
        // A single result for all contacts belongs to no particular contact.
        let single = self.columns.n == self.members.len();
        let member = source.contact().filter(|_| single);
        let contact = member.and_then(|k| network.contacts.get(*self.members.get(k)?));
        LawError::At {
            interface: law.name.clone(),
            bodies: contact.map(|c| c.bodies),
            source: Box::new(source),
        }
    }
}
