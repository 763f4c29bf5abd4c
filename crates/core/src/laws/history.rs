//! State of the laws from earlier steps that is not stored with contacts.

use super::range::Largest;
use crate::contact::Contact;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// State of the laws from earlier steps that is not stored with contacts.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LawHistory {
    /// Negative friction work of pairs, deferred to later steps of the wear laws (J).
    pub(super) negative_friction_work: DeferredWork,
    /// Interfaces whose bonds have been formed.
    pub(super) bonded: Vec<bool>,
    /// Largest value of each output, the reference for its rounding errors.
    pub(super) largest: Largest,
}

impl LawHistory {
    /// Returns whether the state belongs to this number of interfaces.
    pub(crate) fn fits(&self, interfaces: usize) -> bool {
        self.bonded.len() <= interfaces
    }

    /// Drops the deferred friction work of separated pairs once they outnumber the contacts.
    pub(super) fn forget_separated<S: Space>(&mut self, contacts: &[Contact<S>]) {
        let deferred = &mut self.negative_friction_work.0;
        if deferred.len() > 2 * contacts.len() {
            let near = |pair: &(u32, u32)| contacts.binary_search_by_key(pair, |c| c.key.pair());
            deferred.retain(|(pair, _)| near(pair).is_ok());
        }
    }
}

/// Negative work by pair, in ascending order. Contacts are in the same order, so that both lists
/// are traversed together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "BTreeMap<Pair, f64>", into = "BTreeMap<Pair, f64>")]
pub(super) struct DeferredWork(Vec<(Pair, f64)>);

type Pair = (u32, u32);

impl From<BTreeMap<Pair, f64>> for DeferredWork {
    fn from(deferred: BTreeMap<Pair, f64>) -> Self {
        Self(deferred.into_iter().collect())
    }
}

impl From<DeferredWork> for BTreeMap<Pair, f64> {
    fn from(deferred: DeferredWork) -> Self {
        deferred.0.into_iter().collect()
    }
}

impl DeferredWork {
    /// Returns the work of contacts, given by pair in ascending order, plus the deferred work of
    /// their pairs. A negative sum becomes zero and is deferred.
    pub fn not_negative(&mut self, works: impl Iterator<Item = (Pair, f64)>) -> Vec<f64> {
        let before = std::mem::take(&mut self.0);
        let mut before = before.into_iter().peekable();
        let deferred = &mut self.0;
        let done = works.map(|(pair, mut work)| {
            while let Some(other) = before.next_if(|(other, _)| *other < pair) {
                deferred.push(other);
            }
            // Work of an earlier contact of the pair in this step, or of an earlier step.
            let before_it = deferred.pop_if(|(other, _)| *other == pair);
            let before_it = before_it.or_else(|| before.next_if(|(other, _)| *other == pair));
            work += before_it.map_or(0.0, |(_, before_it)| before_it);
            if work < 0.0 {
                deferred.push((pair, work));
            }
            work.max(0.0)
        });
        let done = done.collect();
        deferred.extend(before);
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::sample_laws::contact;

    #[test]
    fn negative_work_of_a_pair_is_taken_from_its_next_work() {
        let mut deferred = DeferredWork::default();
        let mut done = |works: &[((u32, u32), f64)]| deferred.not_negative(works.iter().copied());
        // The second contact of a pair makes up for the first.
        assert_eq!(
            done(&[((1, 2), -3.0), ((1, 2), 5.0), ((4, 1), -1.0)]),
            [0.0, 2.0, 0.0]
        );
        // The work stays deferred while the pair is apart.
        assert_eq!(
            done(&[((0, 9), -1.0), ((1, 2), 1.0), ((5, 1), -2.0)]),
            [0.0, 1.0, 0.0]
        );
        let left = BTreeMap::from(deferred.clone());
        assert_eq!(
            left,
            BTreeMap::from([((0, 9), -1.0), ((4, 1), -1.0), ((5, 1), -2.0)])
        );
        assert_eq!(DeferredWork::from(left.clone()).0, deferred.0);
        assert_eq!(
            deferred.not_negative([((4, 1), 0.5), ((5, 1), 3.0)].into_iter()),
            [0.0, 1.0]
        );
        assert_eq!(deferred.0, [((0, 9), -1.0), ((4, 1), -0.5)]);
    }

    /// Of the pairs (0, 1) to (0, 6) only (0, 2) touches: six deferred entries are more than twice
    /// the number of contacts, two are not.
    #[test]
    fn work_of_separated_pairs_is_dropped_once_they_are_many() {
        let contact = contact([0, 2]);
        for (pairs, left) in [(6, vec![2]), (2, vec![1, 2])] {
            let mut history = LawHistory {
                negative_friction_work: DeferredWork((1..=pairs).map(|b| ((0, b), -1.0)).collect()),
                ..LawHistory::default()
            };
            history.forget_separated(std::slice::from_ref(&contact));
            let kept: Vec<u32> = history
                .negative_friction_work
                .0
                .iter()
                .map(|(pair, _)| pair.1)
                .collect();
            assert_eq!(kept, left);
        }
    }
}
