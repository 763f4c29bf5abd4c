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
    pub(super) negative_friction_work: Debts,
    /// Interfaces whose bonds have been formed.
    pub(super) bonded: Vec<bool>,
    /// Largest value of each output, the reference for its rounding errors.
    pub(super) largest: Largest,
}

impl LawHistory {
    /// Drops the deferred negative friction work of separated pairs once they outnumber the contacts.
    pub(super) fn forget_separated<S: Space>(&mut self, contacts: &[Contact<S>]) {
        let debts = &mut self.negative_friction_work.0;
        if debts.len() > 2 * contacts.len() {
            let near = |pair: &(u32, u32)| contacts.binary_search_by_key(pair, |c| c.key.pair());
            debts.retain(|(pair, _)| near(pair).is_ok());
        }
    }
}

/// Negative work by pair, in their order: contacts come in the same order, so that both are gone through together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "BTreeMap<Pair, f64>", into = "BTreeMap<Pair, f64>")]
pub(super) struct Debts(Vec<(Pair, f64)>);

type Pair = (u32, u32);

impl From<BTreeMap<Pair, f64>> for Debts {
    fn from(debts: BTreeMap<Pair, f64>) -> Self {
        Self(debts.into_iter().collect())
    }
}

impl From<Debts> for BTreeMap<Pair, f64> {
    fn from(debts: Debts) -> Self {
        debts.0.into_iter().collect()
    }
}

impl Debts {
    /// Returns the work of contacts, given by pair in ascending order, less what their pairs owe, and not negative: the rest they owe.
    pub fn pay(&mut self, works: impl Iterator<Item = (Pair, f64)>) -> Vec<f64> {
        let before = std::mem::take(&mut self.0);
        let mut before = before.into_iter().peekable();
        let debts = &mut self.0;
        let paid = works.map(|(pair, mut work)| {
            while let Some(other) = before.next_if(|(other, _)| *other < pair) {
                debts.push(other);
            }
            // Of an earlier contact of the pair in this step, or of an earlier step.
            let owed = debts.pop_if(|(other, _)| *other == pair);
            let owed = owed.or_else(|| before.next_if(|(other, _)| *other == pair));
            work += owed.map_or(0.0, |(_, owed)| owed);
            if work < 0.0 {
                debts.push((pair, work));
            }
            work.max(0.0)
        });
        let paid = paid.collect();
        debts.extend(before);
        paid
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_pair_owes_is_taken_from_its_next_work() {
        let mut debts = Debts::default();
        let mut pay = |works: &[((u32, u32), f64)]| debts.pay(works.iter().copied());
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
        let left = BTreeMap::from(debts.clone());
        assert_eq!(
            left,
            BTreeMap::from([((0, 9), -1.0), ((4, 1), -1.0), ((5, 1), -2.0)])
        );
        assert_eq!(Debts::from(left.clone()).0, debts.0);
        assert_eq!(
            debts.pay([((4, 1), 0.5), ((5, 1), 3.0)].into_iter()),
            [0.0, 1.0]
        );
        assert_eq!(debts.0, [((0, 9), -1.0), ((4, 1), -0.5)]);
    }
}
