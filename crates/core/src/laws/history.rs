//! What laws have to know of earlier steps, beyond what contacts remember.

use super::range::Largest;
use crate::contact::Contact;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What laws have to know of earlier steps, beyond what contacts remember.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LawHistory {
    /// Negative friction work of pairs, deferred to later steps of the wear laws (J).
    pub(super) negative_friction_work: NegativeWorks,
    /// Interfaces whose bonds have been formed.
    pub(super) bonded: Vec<bool>,
    /// Largest value of each output, the reference for its rounding errors.
    pub(super) largest: Largest,
}

impl LawHistory {
    /// Drops the deferred negative friction work of separated pairs once they outnumber the contacts.
    pub(super) fn forget_separated<S: Space>(&mut self, contacts: &[Contact<S>]) {
        let negative = &mut self.negative_friction_work.0;
        if negative.len() > 2 * contacts.len() {
            let near = |pair: &(u32, u32)| contacts.binary_search_by_key(pair, |c| c.key.pair());
            negative.retain(|(pair, _)| near(pair).is_ok());
        }
    }
}

/// Negative work by pair, in their order: contacts come in the same order, so that both are gone through together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "BTreeMap<Pair, f64>", into = "BTreeMap<Pair, f64>")]
pub(super) struct NegativeWorks(Vec<(Pair, f64)>);

type Pair = (u32, u32);

impl From<BTreeMap<Pair, f64>> for NegativeWorks {
    fn from(negative: BTreeMap<Pair, f64>) -> Self {
        Self(negative.into_iter().collect())
    }
}

impl From<NegativeWorks> for BTreeMap<Pair, f64> {
    fn from(negative: NegativeWorks) -> Self {
        negative.0.into_iter().collect()
    }
}

impl NegativeWorks {
    /// Returns the work of contacts, given by pair in ascending order, less what their pairs owe, and not negative: the rest they owe.
    pub fn pay(&mut self, works: impl Iterator<Item = (Pair, f64)>) -> Vec<f64> {
        let before = std::mem::take(&mut self.0);
        let mut before = before.into_iter().peekable();
        let negative = &mut self.0;
        let paid = works.map(|(pair, mut work)| {
            while let Some(other) = before.next_if(|(other, _)| *other < pair) {
                negative.push(other);
            }
            // Of an earlier contact of the pair in this step, or of an earlier step.
            let owed = negative.pop_if(|(other, _)| *other == pair);
            let owed = owed.or_else(|| before.next_if(|(other, _)| *other == pair));
            work += owed.map_or(0.0, |(_, owed)| owed);
            if work < 0.0 {
                negative.push((pair, work));
            }
            work.max(0.0)
        });
        let paid = paid.collect();
        negative.extend(before);
        paid
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_pair_owes_is_taken_from_its_next_work() {
        let mut negative = NegativeWorks::default();
        let mut pay = |works: &[((u32, u32), f64)]| negative.pay(works.iter().copied());
        // The second contact of a pair pays for the first.
        assert_eq!(
            pay(&[((1, 2), -3.0), ((1, 2), 5.0), ((4, 1), -1.0)]),
            [0.0, 2.0, 0.0]
        );
        // A pair that is apart still owes.
        assert_eq!(
            pay(&[((0, 9), -1.0), ((1, 2), 1.0), ((5, 1), -2.0)]),
            [0.0, 1.0, 0.0]
        );
        let left = BTreeMap::from(negative.clone());
        assert_eq!(
            left,
            BTreeMap::from([((0, 9), -1.0), ((4, 1), -1.0), ((5, 1), -2.0)])
        );
        assert_eq!(NegativeWorks::from(left.clone()).0, negative.0);
        assert_eq!(
            negative.pay([((4, 1), 0.5), ((5, 1), 3.0)].into_iter()),
            [0.0, 1.0]
        );
        assert_eq!(negative.0, [((0, 9), -1.0), ((4, 1), -0.5)]);
    }
}
