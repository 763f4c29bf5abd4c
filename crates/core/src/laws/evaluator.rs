//! Evaluation of the laws in a step: selects the contacts on which they act, in batches on one or
//! several threads.

use super::batch::{BATCH, BatchPool};
use super::gather::{AHEAD, prefetch_bond};
use super::interface::Interface;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::threads::{chunk_size, map_chunks, worth_dividing};

/// Number of contacts of a task that selects the contacts of each interface.
const CHUNK: usize = 4096;
/// Approximate time to select a contact (ns).
const SELECT: f64 = 10.0;

/// Factor on the work above which dividing batches among threads pays, relative to a plain loop: an
/// interface is evaluated in several regions, between which one thread stores. On scenes of 5,000
/// to 6,000 contacts, which are below this limit, two threads were slower than one.
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
    /// Index of the moments of each contact, while bonds that resist rotation are committed.
    pub(super) moment_places: Vec<u32>,
    /// Slip (m) and friction work (J) of contacts.
    pub(super) slides: Vec<(f64, f64)>,
    /// Whether passes over contacts may be divided among threads.
    pub parallel: bool,
}

/// The contacts of an interface, as places in the network in ascending order.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// All contacts.
    pub all: Vec<usize>,
    /// Contacts with an intact bond, where the interface makes bonds.
    pub bonded: Vec<usize>,
    /// Contacts without an intact bond, where the interface makes bonds.
    pub loose: Vec<usize>,
    /// Contacts within the alert distance or held by a bond, if there are others.
    near: Vec<usize>,
    /// Contacts beyond the alert distance and held by no bond.
    pub beyond: Vec<usize>,
}

impl Members {
    /// Returns the contacts within the alert distance or held by a bond.
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
    /// Finds the contacts of each interface. This is the first call of a step; contacts and bonds
    /// must not change until the end of the step.
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

    /// Returns the contacts of the step that are beyond the alert distance and held by no bond, as
    /// indices in the network.
    pub(crate) fn beyond(&self) -> impl Iterator<Item = usize> {
        self.members.iter().flat_map(|m| m.beyond.iter().copied())
    }

    /// Returns whether to divide batches of contacts among threads, given the time per contact
    /// `each` (ns).
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
