//! Commit: the laws' update at the end of a solved step.

use super::batch::{BATCH, LawBatch, locate};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::{MotionSource, Source, store_states};
use super::history::LawHistory;
use super::interface::{Interface, LoadedLaw};
use super::kind::{Domain, Kind};
use super::outputs::Outputs;
use super::slot::SlotCommit;
use super::spring::SpringStep;
use super::step_result::{ContactStep, MomentStep, SolvedStep, Totals};
use crate::contact::{Contact, ContactDissipation, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{chunk_size, fill, map_chunks_mut, map_chunks_of_two, worth_dividing};

/// Contacts of a task; sums are formed per chunk and added in order.
const CHUNK: usize = 1024;
/// Approximate time to store the impulse of a contact (ns).
const COMMIT: f64 = 15.0;
/// Approximate time to compute the slip of a contact (ns).
const SLIDE: f64 = 5.0;
/// Approximate time of a law per contact (ns).
const COMMIT_LAW: f64 = 40.0;

impl LawEvaluator {
    /// Completes the step. Contacts and bonds are as at the last [`Self::select`].
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
                self.commit_bonds(index, law, history, network, step, &mut totals)?;
            }
            self.commit_slots(index, law, history, network, step, &mut totals)?;
        }
        totals.fracture += std::mem::take(&mut network.torn_energy);
        Ok(totals)
    }

    /// Calls the laws of an interface that act on contacts, and stores their outputs.
    fn commit_slots<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        let slots = law.loaded().filter(|l| !law.acts_on_bonds(l));
        // A law without internal variables is called only where heat or current flows.
        let conducts = network.thermal.as_ref().map(|t| t.conducts);
        let idle = |l: &&LoadedLaw| {
            let remembers = l.variables() > 0 && conducts.is_some();
            l.plugin.kind == Kind::TRANSPORT && !remembers && conducts != Some(true)
        };
        let slots: Vec<&LoadedLaw> = slots
            .filter(|l| (sees_slip(l) || l.variables() > 0) && !idle(l))
            .collect();
        let all = |l: &&LoadedLaw| l.plugin.kind.spec().domain == Domain::All;
        let (of_all, of_near): (Vec<_>, Vec<_>) = slots.into_iter().partition(all);
        let members = std::mem::take(&mut self.members[index]);
        // Laws that act on the same contacts share the columns.
        let groups = if members.beyond.is_empty() {
            vec![(&members.all[..], [of_all, of_near].concat())]
        } else {
            vec![(&members.all[..], of_all), (members.near(), of_near)]
        };
        let done = groups.into_iter().try_for_each(|(members, slots)| {
            if members.is_empty() || slots.is_empty() {
                return Ok(());
            }
            let group = SlotGroup {
                law,
                index,
                slots: &slots,
                members,
            };
            self.commit_group(&group, history, network, step, totals)
        });
        self.members[index] = members;
        done
    }

    /// Calls laws that act on the same contacts.
    fn commit_group<S: Space>(
        &mut self,
        group: &SlotGroup<'_>,
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        let (law, index, slots) = (group.law, group.index, group.slots);
        let mut slides = std::mem::take(&mut self.slides);
        let mut paid = Vec::new();
        slides.clear();
        if slots.iter().any(|l| sees_slip(l)) {
            let divide = self.divides(group.members.len(), SLIDE);
            fill(divide, &mut slides, group.members.len(), |k| {
                slide(network, step, group.members[k])
            });
            if slots.iter().any(|l| is_paid(l)) {
                paid = pay_debts(&slides, network, history, group.members);
            }
        }
        let size = chunk_size(BATCH);
        let of = |network: &_, batch: &mut LawBatch, (first, members): &mut (usize, &[usize])| {
            let source = Source::new(law, index, network, step.info);
            batch.gather_after(&source, members, &MotionSource::Solved(step), slots);
            let here = *first..*first + members.len();
            let mut answers = Vec::with_capacity(slots.len());
            for loaded in slots {
                let columns = &mut batch.columns;
                columns.slip.clear();
                columns.friction_work.clear();
                if sees_slip(loaded) {
                    let here = &slides[here.clone()];
                    columns.slip.extend(here.iter().map(|s| s.0));
                    columns.friction_work.extend(here.iter().map(|s| s.1));
                }
                if is_paid(loaded) {
                    columns.friction_work.copy_from_slice(&paid[here.clone()]);
                }
                batch
                    .run_afresh(loaded, step.info, 0.0, Call::Commit)
                    .map_err(|e| locate(law, network, members, e))?;
                let outputs = loaded.plugin.kind.spec().outputs;
                let outputs = outputs(&mut batch.columns.out, Call::Commit);
                answers.extend(outputs.iter().map(|o| o.values.clone()));
            }
            Ok((answers, batch.new_states(slots)))
        };
        let mut outputs: Vec<Outputs> = slots.iter().map(|_| Outputs::default()).collect();
        let take = |network: &mut _,
                    (_, members): &(usize, &[usize]),
                    (answers, states): (Vec<Vec<f64>>, Vec<f64>)| {
            store_states(network, index, slots, members, &states);
            let columns = slots
                .iter()
                .zip(&mut outputs)
                .flat_map(|(loaded, outputs)| {
                    (loaded.plugin.kind.spec().outputs)(outputs, Call::Commit)
                });
            for (column, answer) in columns.zip(answers) {
                column.values.extend_from_slice(&answer);
            }
        };
        let batches = group.members.chunks(size).enumerate();
        let batches: Vec<_> = batches.map(|(k, m)| (k * size, m)).collect();
        let divide = self.divides(group.members.len(), COMMIT_LAW * slots.len() as f64);
        let largest = &mut history.largest;
        let done = self
            .pool
            .evaluate(divide, largest, network, batches, of, take);
        self.slides = slides;
        done?;
        for (loaded, outputs) in slots.iter().zip(&outputs) {
            let Some(commit) = loaded.plugin.kind.spec().commit.of::<S>() else {
                continue;
            };
            commit(&mut SlotCommit {
                interface: law,
                law: loaded,
                network,
                step,
                totals,
                members: group.members,
                outputs,
            })?;
        }
        Ok(())
    }
}

/// Laws of an interface that act on the same contacts.
struct SlotGroup<'a> {
    law: &'a Interface,
    index: usize,
    slots: &'a [&'a LoadedLaw],
    members: &'a [usize],
}

/// Returns whether a law receives slip and friction work: its outputs are not used at the start of
/// a step.
fn sees_slip(law: &LoadedLaw) -> bool {
    !law.plugin.kind.spec().functions.contains(&Call::Prepare)
}

/// Returns whether a law receives friction work that is not negative: where the velocity reverses
/// within a step, friction gives work back, which is deducted from the work of later steps.
fn is_paid(law: &LoadedLaw) -> bool {
    law.plugin.kind == Kind::WEAR
}

/// Returns slip (m) and friction work (J) of a contact over the step; the work is negative where
/// friction gave energy back.
#[inline]
fn slide<S: Space>(network: &Network<S>, step: &SolvedStep<'_, S>, at: usize) -> (f64, f64) {
    let contact_step = &step.contacts[at];
    match step.spring(at) {
        Some(spring) => (spring.slip.norm(), spring.friction),
        None => {
            let ut = S::tangential(&network.contacts[at].normal, &contact_step.average);
            let work = -contact_step.solution.unilateral_t.dot(&ut);
            (step.info.h * ut.norm(), work)
        }
    }
}

/// Returns the friction work of contacts less the deferred negative work of their pairs. It is not
/// negative: the remainder is deferred to later steps.
fn pay_debts<S: Space>(
    slides: &[(f64, f64)],
    network: &Network<S>,
    history: &mut LawHistory,
    members: &[usize],
) -> Vec<f64> {
    history.forget_separated(&network.contacts);
    let pairs = members.iter().map(|at| network.contacts[*at].key.pair());
    let works = pairs.zip(slides.iter().map(|slide| slide.1));
    history.negative_friction_work.not_negative(works)
}

/// Stores the impulses of the contacts, and adds up the dissipated energies.
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
    let divide = worth_dividing(parallel, contacts.len(), COMMIT);
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

/// Stores the impulse of a contact, adds its energies to the totals, and returns the dissipated
/// energy.
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
            totals.friction_of_springs += dissipated.friction;
            dissipated
        }
    };
    totals.friction += dissipated.friction;
    totals.correction += dissipated.correction;
    totals.adhesion += dissipated.adhesion;
    totals.impact += dissipated.impact;
    dissipated
}

/// Stores the impulse and the spring of a compliant contact. Returns the dissipated energy, and the
/// rest of the work, which the spring stored.
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

/// Stores the impulse of a rigid contact; returns the dissipated energy.
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

/// Stores the moments of the contacts that resist rotation, and adds up their work of friction.
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

#[cfg(test)]
mod tests;
