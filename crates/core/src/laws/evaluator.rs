//! Evaluation of the laws in a step: which contacts they act on, in batches on one or several
//! threads.

use super::batch::{BATCH, BatchPool};
use super::gather::{AHEAD, prefetch_bond};
use super::interface::Interface;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::threads::{chunk_size, map_chunks, worth_dividing};

/// Contacts of a task that looks to which interface they belong.
const CHUNK: usize = 4096;
/// About what that takes for each (ns).
const SELECT: f64 = 10.0;

/// How many times more work than for a plain loop makes dividing batches pay: an interface is
/// evaluated in several regions, between which one thread stores. On scenes of 5,000 to 6,000
/// contacts, which are below it, two threads were slower than one.
const OVERHEAD: f64 = 8.0;

/// Evaluates the laws; owns the working memory of prepare and commit, and nothing that outlasts a
/// step.
#[derive(Debug, Default)]
pub struct LawEvaluator {
    pub(super) pool: BatchPool,
    /// The contacts of each interface in this step.
    pub(super) members: Vec<Members>,
    /// Interface, slot and damage of the bonds in the last trial of an implicit coupling.
    pub(super) trials: Vec<(usize, usize, f64)>,
    /// Contacts of the last solve that close within the step and were kept from closing although
    /// their law has restitution.
    pub(crate) held_back: Vec<usize>,
    /// Place of the moments of each contact in the step, while bonds that resist rotation are
    /// committed.
    pub(super) moment_places: Vec<u32>,
    /// Slip (m) and friction work (J) of contacts.
    pub(super) slides: Vec<(f64, f64)>,
    /// Whether passes over contacts may be divided among threads.
    pub parallel: bool,
}

/// The contacts of an interface, as places in the network in ascending order.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// All.
    pub all: Vec<usize>,
    /// Contacts with an intact bond, where the interface makes bonds.
    pub bonded: Vec<usize>,
    /// The others, where the interface makes bonds.
    pub loose: Vec<usize>,
    /// Contacts within the alert distance or held by a bond, if these are not all.
    near: Vec<usize>,
    /// The others.
    pub beyond: Vec<usize>,
}

impl Members {
    /// Contacts within the alert distance or held by a bond.
    pub fn near(&self) -> &[usize] {
        if self.beyond.is_empty() {
            &self.all
        } else {
            &self.near
        }
    }

    fn lists(&mut self) -> [&mut Vec<usize>; 5] {
        [
            &mut self.all,
            &mut self.bonded,
            &mut self.loose,
            &mut self.near,
            &mut self.beyond,
        ]
    }
}

impl LawEvaluator {
    /// Finds the contacts of each interface. It comes before the other calls of a step, until whose
    /// end the contacts and their bonds stay.
    pub fn select<S: Space>(&mut self, laws: &[Interface], network: &Network<S>) {
        self.members.resize_with(laws.len(), Members::default);
        for list in self.members.iter_mut().flat_map(Members::lists) {
            list.clear();
        }
        if !worth_dividing(self.parallel, network.contacts.len(), SELECT) {
            let whole = 0..network.contacts.len();
            select(laws, network, whole, &mut self.members);
        } else {
            let parts = map_chunks(
                true,
                &network.contacts,
                chunk_size(CHUNK),
                |first, chunk| {
                    let mut members = Vec::new();
                    members.resize_with(laws.len(), Members::default);
                    let range = first..first + chunk.len();
                    select(laws, network, range, &mut members);
                    members
                },
            );
            for mut part in parts {
                for (to, from) in self.members.iter_mut().zip(&mut part) {
                    for (to, from) in to.lists().into_iter().zip(from.lists()) {
                        to.append(from);
                    }
                }
            }
        }
        for members in self.members.iter_mut().filter(|m| !m.beyond.is_empty()) {
            let near = |at: &&usize| !network.contacts[**at].beyond;
            members.near.extend(members.all.iter().filter(near));
        }
    }

    /// The contacts of the step that are beyond the alert distance and held by no bond, as places
    /// in the network.
    pub(crate) fn beyond(&self) -> impl Iterator<Item = usize> {
        self.members.iter().flat_map(|m| m.beyond.iter().copied())
    }

    /// Whether to divide batches of some contacts, each of which takes about `each` nanoseconds,
    /// among threads.
    pub(super) fn divides(&self, contacts: usize, each: f64) -> bool {
        contacts > chunk_size(BATCH) && worth_dividing(self.parallel, contacts, each / OVERHEAD)
    }
}

fn select<S: Space>(
    laws: &[Interface],
    network: &Network<S>,
    range: std::ops::Range<usize>,
    members: &mut [Members],
) {
    let contacts = &network.contacts[range.clone()];
    for (contact, k) in contacts.iter().zip(range.clone()) {
        if let Some(ahead) = contacts.get(k - range.start + AHEAD) {
            prefetch_bond(&network.memory[ahead.law as usize], ahead);
        }
        let index = contact.law as usize;
        let members = &mut members[index];
        members.all.push(k);
        if contact.beyond {
            members.beyond.push(k);
        }
        if laws[index].opens() {
            if network.bond(contact).is_some_and(|b| b.intact()) {
                members.bonded.push(k);
            } else {
                members.loose.push(k);
            }
        }
    }
}
