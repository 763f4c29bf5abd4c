//! Commit: the laws' update at the end of a solved step.

use super::columns::Columns;
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::history::LawHistory;
use super::interface::{Interface, Loaded};
use super::kind::Domain;
use super::library::Call;
use super::spring::SpringStep;
use super::step_result::{ContactStep, MomentStep, SolvedStep, Totals};
use crate::contact::{Contact, ContactDissipation, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{map_chunks_mut, map_chunks_of_two, pays};

/// Contacts of a task; sums are formed per chunk and added in order.
const CHUNK: usize = 1024;
/// About what it takes to store the impulse of a contact (ns).
const COMMIT: f64 = 15.0;

impl LawEvaluator {
    /// Completes the step.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn commit<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
    ) -> Result<Totals, LawError> {
        let mut totals = Totals::default();
        if let Some(losses) = &mut network.losses {
            losses.clear();
        }
        commit_contacts(network, step, self.parallel, &mut totals);
        commit_moments(network, step.moments, &mut totals);
        for (index, law) in laws.iter().enumerate() {
            if law.opens() {
                self.select(network, |c| {
                    c.law as usize == index && network.bond(c).is_some_and(|b| b.intact())
                });
                self.place_moments(index, network, step);
                self.in_batches(|batch| {
                    batch.commit_bonds(index, law, history, network, step, &mut totals)
                })?;
            }
            for loaded in law.loaded().filter(|l| !law.acts_on_bonds(l)) {
                let spec = loaded.plugin.kind.spec();
                let Some(commit) = spec.commit.of::<S>() else {
                    continue;
                };
                let all = spec.domain == Domain::All;
                self.select(network, |c| c.law as usize == index && (all || !c.beyond));
                self.in_batches(|batch| {
                    commit(&mut SlotCommit {
                        interface: law,
                        law: loaded,
                        network,
                        step,
                        totals: &mut totals,
                        evaluator: batch,
                        history,
                        index,
                    })
                })?;
            }
        }
        totals.fracture += std::mem::take(&mut network.torn_energy);
        Ok(totals)
    }

    /// Stores the new internal variables of the members.
    pub(super) fn store_variables<S: Space>(&self, index: usize, network: &mut Network<S>) {
        for (k, at) in self.members.iter().enumerate() {
            let Some(slot) = network.contacts[*at].memory() else {
                continue;
            };
            let columns = &mut network.memory[index].variables;
            for (column, next) in columns.iter_mut().zip(&self.columns.state_next) {
                column[slot] = next[k];
            }
        }
    }
}

/// Stores the impulses of the contacts, and books what they dissipated.
fn commit_contacts<S: Space>(
    network: &mut Network<S>,
    step: &SolvedStep<'_, S>,
    parallel: bool,
    totals: &mut Totals,
) {
    let Network {
        contacts,
        dissipation,
        ..
    } = network;
    let divide = pays(parallel, contacts.len(), COMMIT);
    let parts = match dissipation {
        None => map_chunks_mut(divide, contacts, CHUNK, |first, contacts| {
            let mut totals = Totals::default();
            for (contact, k) in contacts.iter_mut().zip(first..) {
                book_contact(contact, k, step, &mut totals);
            }
            totals
        }),
        Some(dissipation) => {
            dissipation.clear();
            dissipation.resize(contacts.len(), ContactDissipation::default());
            map_chunks_of_two(
                divide,
                CHUNK,
                (contacts, dissipation),
                |first, contacts, dissipation| {
                    let mut totals = Totals::default();
                    let both = contacts.iter_mut().zip(dissipation);
                    for ((contact, dissipated), k) in both.zip(first..) {
                        *dissipated = book_contact(contact, k, step, &mut totals);
                    }
                    totals
                },
            )
        }
    };
    parts.iter().for_each(|part| totals.add(part));
}

/// Stores the impulse of a contact, adds its energies to the totals, and returns what it dissipated.
fn book_contact<S: Space>(
    contact: &mut Contact<S>,
    k: usize,
    step: &SolvedStep<'_, S>,
    totals: &mut Totals,
) -> ContactDissipation {
    let contact_step = &step.contacts[k];
    let dissipated = match step.spring(k) {
        None => commit_contact(contact, contact_step, step.info.h),
        Some(spring) => {
            let (dissipated, stored) = commit_spring(contact, contact_step, spring, step.info.h);
            totals.springs += stored;
            totals.viscous += dissipated.viscous;
            dissipated
        }
    };
    totals.friction += dissipated.friction;
    totals.correction += dissipated.correction;
    totals.adhesion += dissipated.adhesion;
    totals.impact += dissipated.impact;
    dissipated
}

/// Stores the impulse and the spring of a compliant contact; returns what it dissipated, and the rest of the work done on
/// it, which its spring took.
fn commit_spring<S: Space>(
    contact: &mut Contact<S>,
    contact_step: &ContactStep<S>,
    step: &SpringStep<S>,
    h: f64,
) -> (ContactDissipation, f64) {
    let all = commit_contact(contact, contact_step, h);
    let (friction, viscous) = (step.friction, step.viscous);
    contact.friction_work += friction - all.friction;
    contact.spring = step.spring;
    let dissipated = ContactDissipation {
        friction,
        viscous,
        adhesion: step.adhesion,
        ..ContactDissipation::default()
    };
    let work = all.friction + all.impact + all.adhesion;
    (dissipated, work - friction - viscous - step.adhesion)
}

/// Stores the impulse of a rigid contact; returns what it dissipated.
#[inline]
fn commit_contact<S: Space>(
    contact: &mut Contact<S>,
    contact_step: &ContactStep<S>,
    h: f64,
) -> ContactDissipation {
    contact.impulse = contact_step.solution.impulse;
    contact.moment = S::Spin::zero();
    let n = &contact.normal;
    contact.compression_time = if n.dot(&contact.impulse) > 0.0 && !contact.beyond {
        contact.compression_time + h
    } else {
        0.0
    };
    let (un, ut) = (
        n.dot(&contact_step.average),
        S::tangential(n, &contact_step.average),
    );
    let friction = -contact_step.solution.unilateral_t.dot(&ut);
    contact.slides = contact_step.slides;
    contact.friction_work += friction;
    let work = -contact_step.solution.unilateral_n * un + contact_step.corrected;
    let adheres = contact_step.adheres && contact_step.solution.unilateral_n < 0.0;
    let (adhesion, impact) = if adheres { (work, 0.0) } else { (0.0, work) };
    ContactDissipation {
        friction,
        impact,
        adhesion,
        correction: -contact_step.corrected,
        ..ContactDissipation::default()
    }
}

/// Stores the moments of the contacts that resist rotation, and books their friction.
fn commit_moments<S: Space>(
    network: &mut Network<S>,
    moment_steps: &[MomentStep<S>],
    totals: &mut Totals,
) {
    for moment_step in moment_steps {
        let contact = &mut network.contacts[moment_step.moment.contact as usize];
        contact.moment = moment_step.moment.moment;
        let friction = -moment_step.moment.friction.dot(&moment_step.spin);
        totals.friction += friction;
        contact.friction_work += friction;
        if let Some(dissipation) = &mut network.dissipation {
            dissipation[moment_step.moment.contact as usize].friction += friction;
        }
    }
}

/// The end of a step for one law of an interface that acts on contacts: what a [`CommitHook`](super::kind::CommitHook) works
/// on.
#[derive(Debug)]
pub struct SlotCommit<'a, S: Space> {
    /// The interface.
    pub interface: &'a Interface,
    /// The law, one of its slots.
    pub law: &'a Loaded,
    /// All contacts.
    pub network: &'a mut Network<S>,
    /// What each contact did, in the order of the network, and time and scheme.
    pub step: &'a SolvedStep<'a, S>,
    /// Energies and volumes of the step.
    pub totals: &'a mut Totals,
    pub(super) evaluator: &'a mut LawEvaluator,
    history: &'a mut LawHistory,
    index: usize,
}

impl<S: Space> SlotCommit<'_, S> {
    /// Contacts that the law acts on, as places in the network; values of columns are in their order. Where the law acts on many, the hook is
    /// called for some at a time, several times in a step.
    pub fn contacts(&self) -> &[usize] {
        &self.evaluator.members
    }

    /// The columns, as the last call left them.
    pub fn columns(&self) -> &Columns {
        &self.evaluator.columns
    }

    /// Fills the columns by the end of the step.
    pub fn gather(&mut self) {
        let Self { evaluator, .. } = self;
        evaluator.gather_after(self.interface, self.network, self.step);
        evaluator.columns.size_outputs();
    }

    /// Adds the columns of slip (m) and friction work (J) over the step, negative where friction gave back.
    pub fn add_slip(&mut self) {
        let Self {
            evaluator, step, ..
        } = self;
        for at in &evaluator.members {
            let contact_step = &step.contacts[*at];
            let (slip, work) = match step.spring(*at) {
                Some(spring) => (spring.slip.norm(), spring.friction),
                None => {
                    let normal = &self.network.contacts[*at].normal;
                    let ut = S::tangential(normal, &contact_step.average);
                    let work = -contact_step.solution.unilateral_t.dot(&ut);
                    (step.info.h * ut.norm(), work)
                }
            };
            evaluator.columns.slip.push(slip);
            evaluator.columns.friction_work.push(work);
        }
    }

    /// The same with friction work that is not negative: where the velocity turns within a step, friction gives work back,
    /// and later steps owe it to the law.
    pub(super) fn add_slip_and_owed_work(&mut self) {
        self.history.forget_separated(&self.network.contacts);
        self.add_slip();
        let Self { evaluator, .. } = self;
        let works = &mut evaluator.columns.friction_work;
        for (at, work) in evaluator.members.iter().zip(works) {
            let pair = self.network.contacts[*at].key.pair();
            let owed = match self.history.negative_friction_work.is_empty() {
                true => 0.0,
                false => self
                    .history
                    .negative_friction_work
                    .remove(&pair)
                    .unwrap_or(0.0),
            };
            *work += owed;
            if *work < 0.0 {
                self.history.negative_friction_work.insert(pair, *work);
            }
            *work = work.max(0.0);
        }
    }

    /// Calls the law.
    ///
    /// # Errors
    /// Its own error, with the contact at fault.
    pub fn call(&mut self) -> Result<(), LawError> {
        let called = self
            .evaluator
            .run(self.law, self.history, self.step.info, 0.0, Call::Commit);
        called.map_err(|e| self.evaluator.locate(self.interface, self.network, e))
    }

    /// Stores the new internal variables.
    pub fn store_variables(&mut self) {
        self.evaluator.store_variables(self.index, self.network);
    }
}
