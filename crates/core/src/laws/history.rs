//! What laws have to know of earlier steps, beyond what contacts remember.

use super::range::Largest;
use crate::contact::Contact;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::{BTreeMap, HashMap};

/// What laws have to know of earlier steps, beyond what contacts remember.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LawHistory {
    /// Negative friction work of pairs, deferred to later steps of the wear laws (J).
    #[serde(serialize_with = "in_order")]
    pub(super) negative_friction_work: HashMap<(u32, u32), f64>,
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
fn in_order<T: Serializer>(map: &HashMap<(u32, u32), f64>, to: T) -> Result<T::Ok, T::Error> {
    map.iter().collect::<BTreeMap<_, _>>().serialize(to)
}
