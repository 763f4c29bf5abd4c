//! Contacts between deformable bodies that act on the nearest position, because the mean one does
//! not exist.

use super::quantity::unit::ONE;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};

/// Share of the load that may act on nearest positions without a warning, as in a brief touch.
const NEGLIGIBLE: f64 = 1e-3;

crate::described! {
    /// Contacts of points of deformable bodies with surfaces of others that act on the nearest
    /// position, over the rows of the statistics.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct NearestPlaces {
        /// Loaded contacts that act on the nearest place, at the row where these carry most.
        pub contacts: usize => ONE,
        /// All loaded contacts between deformable bodies at that row.
        pub of: usize => ONE,
        /// Share of these contacts' forces that those on nearest places carry, over all rows.
        pub share: f64 => ONE,
        /// Force on nearest positions at that row.
        #[serde(skip)]
        most: f64,
        /// Sum over the rows of the forces on nearest positions, and of all forces.
        #[serde(skip)]
        near: f64,
        #[serde(skip)]
        all: f64,
    }
}

impl NearestPlaces {
    /// Returns the values of the last step of a simulation.
    pub fn of(run: &dyn RunView) -> Self {
        let mut out = Self::default();
        for (force, mean) in run.forces_on_points() {
            if force > 0.0 {
                out.of += 1;
                out.all += force;
                if !mean {
                    out.contacts += 1;
                    out.near += force;
                }
            }
        }
        (out.most, out.share) = (out.near, share(out.near, out.all));
        out
    }

    /// Combines two results over their rows.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let at = if other.most > self.most { other } else { self };
        let (near, all) = (self.near + other.near, self.all + other.all);
        Self {
            share: share(near, all),
            near,
            all,
            ..at
        }
    }

    /// Returns the state, to continue after a pause.
    pub fn state(&self) -> ([usize; 2], [f64; 3]) {
        ([self.contacts, self.of], [self.most, self.near, self.all])
    }

    /// Restores the state that [`Self::state`] returned.
    pub fn from_state(([contacts, of], [most, near, all]): ([usize; 2], [f64; 3])) -> Self {
        let share = share(near, all);
        Self {
            contacts,
            of,
            share,
            most,
            near,
            all,
        }
    }

    /// Returns a warning on the effect on the result.
    pub fn warning(&self) -> Option<String> {
        (self.share > NEGLIGIBLE).then(|| {
            let share = match 100.0 * self.share {
                share if share < 1.0 => "less than 1 %".to_owned(),
                share => format!("{share:.0} %"),
            };
            format!(
                "up to {} of {} loaded contacts between deformable bodies, over the run with {share} of the load, act on the nearest place of the surface, \
                 not on the mean place that their points face: pressure there alternates from point to point by about a tenth where meshes do not match; let \
                 surfaces reach beyond the points that touch them, and see docs/deformable/limits.md",
                self.contacts, self.of,
            )
        })
    }
}

/// Returns the ratio of two forces; zero over zero.
fn share(near: f64, all: f64) -> f64 {
    if near > 0.0 { near / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a row with this force on nearest positions, of 100 N on 40 contacts in total.
    fn row(contacts: usize, near: f64) -> NearestPlaces {
        NearestPlaces {
            contacts,
            of: 40,
            share: near / 100.0,
            most: near,
            near,
            all: 100.0,
        }
    }

    #[test]
    fn contacts_on_nearest_places_are_told() {
        assert_eq!(row(0, 0.0).warning(), None);
        let kept = row(3, 24.0).and(row(2, 12.0));
        assert_eq!(NearestPlaces::from_state(kept.state()), kept);
        let text = row(0, 0.0).and(row(3, 24.0)).and(row(2, 12.0)).warning();
        let text = text.unwrap();
        assert!(
            text.starts_with("up to 3 of 40 loaded contacts") && text.contains("12 % of the load"),
            "{text}"
        );
    }

    /// At the first touch of one point all of the force is on a nearest position, but it is
    /// negligible over the run.
    #[test]
    fn a_touch_of_negligible_force_decides_nothing() {
        let touch = NearestPlaces {
            contacts: 1,
            of: 1,
            share: 1.0,
            most: 1e-3,
            near: 1e-3,
            all: 1e-3,
        };
        assert_eq!(touch.and(row(0, 0.0)).warning(), None);
        let text = touch.and(row(4, 0.4)).warning().unwrap();
        assert!(
            text.contains("up to 4 of 40") && text.contains("less than 1 % of the load"),
            "{text}"
        );
    }
}
