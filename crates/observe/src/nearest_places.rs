//! Contacts between deformable bodies that act on the nearest place, where the mean one is not to be found.

use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use serde::{Deserialize, Serialize};

/// Contacts of points of deformable bodies with surfaces of others that act on the nearest place, at the row of the statistics where they carry the largest
/// share of the load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NearestPlaces {
    /// Loaded contacts that act on the nearest place.
    pub contacts: usize,
    /// All loaded contacts between deformable bodies.
    pub of: usize,
    /// Share of these contacts' forces that they carry.
    pub share: f64,
}

impl NearestPlaces {
    /// Of the last step of a simulation.
    pub fn of<S: Space>(s: &Simulation<S>) -> Self {
        let mut out = Self::default();
        let (mut near, mut all) = (0.0, 0.0);
        for (contact, mean) in s.acted_on_mean_places() {
            let force = contact.impulse.norm();
            if force > 0.0 {
                out.of += 1;
                all += force;
                if !mean {
                    out.contacts += 1;
                    near += force;
                }
            }
        }
        if near > 0.0 {
            out.share = near / all;
        }
        out
    }

    /// The one with the larger share.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        if other.share > self.share {
            other
        } else {
            self
        }
    }

    /// What that means for the result.
    pub fn warning(&self) -> Option<String> {
        (self.contacts > 0).then(|| {
            format!(
                "up to {} of {} loaded contacts between deformable bodies, with {:.0} % of the load, act on the nearest place of the surface, not on \
                 the mean place that their points face: pressure there alternates from point to point by about a tenth where meshes do not match; let \
                 surfaces reach beyond the points that touch them, and see the limits in docs/deformable.md",
                self.contacts,
                self.of,
                100.0 * self.share
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_on_nearest_places_are_told() {
        let none = NearestPlaces {
            contacts: 0,
            of: 40,
            share: 0.0,
        };
        assert_eq!(none.warning(), None);
        let some = NearestPlaces {
            contacts: 3,
            of: 40,
            share: 0.12,
        };
        let text = none.larger(some).larger(none).warning().unwrap();
        assert!(
            text.starts_with("up to 3 of 40 loaded contacts") && text.contains("12 % of the load"),
            "{text}"
        );
    }
}
