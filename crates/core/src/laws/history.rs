//! What laws have to know of earlier steps, beyond what contacts remember.

use super::range::Largest;
use crate::contact::Contact;
use crate::geometry::space::Space;
use foldhash::fast::FixedState;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::{BTreeMap, HashMap};

/// By pair. It is looked up for every contact: the default hasher would take longer than the law.
pub(super) type Debts = HashMap<(u32, u32), f64, FixedState>;

/// What laws have to know of earlier steps, beyond what contacts remember.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LawHistory {
    /// Negative friction work of pairs, deferred to later steps of the wear laws (J).
    #[serde(serialize_with = "in_order")]
    pub(super) negative_friction_work: Debts,
    /// Interfaces whose bonds have been formed.
    pub(super) bonded: Vec<bool>,
    /// Largest value of each output, the reference for its rounding errors.
    pub(super) largest: Largest,
}

impl LawHistory {
    /// Drops the deferred negative friction work of separated pairs once they outnumber the contacts.
    pub(super) fn forget_separated<S: Space>(&mut self, contacts: &[Contact<S>]) {
        if self.negative_friction_work.len() > 2 * contacts.len() {
            let near = |pair: &(u32, u32)| contacts.binary_search_by_key(pair, |c| c.key.pair());
            self.negative_friction_work
                .retain(|pair, _| near(pair).is_ok());
        }
    }
}

/// Sorted, so that equal maps are serialised to equal bytes.
fn in_order<T: Serializer>(map: &Debts, to: T) -> Result<T::Ok, T::Error> {
    map.iter().collect::<BTreeMap<_, _>>().serialize(to)
}
