//! Clusters: sets of at least two grains connected by intact bonds.

use crate::sets::Sets;
use fretwork_core::contact::BondState;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The clusters at an instant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Clusters {
    /// Number of sets of two grains or more.
    pub count: usize,
    /// Number of grains of the largest cluster; 1 if there are no bonds.
    pub largest: usize,
    /// Mass-weighted mean size, sum m n / sum m over all grains, with n the size of a grain's
    /// cluster: 1 if there are no bonds.
    pub mean: f64,
    /// Number of clusters and their mass by size (kg; kg/m in 2D), including single grains.
    pub sizes: BTreeMap<usize, (usize, f64)>,
}

/// Finds the clusters of the free grains.
pub(super) fn clusters(run: &dyn RunView, grain: &[bool]) -> Clusters {
    let mut tied = Vec::new();
    run.visit_contacts(&mut |contact| {
        if let BondState::Intact { .. } = contact.bond {
            tied.push(contact.bodies);
        }
    });
    count(run.bodies().mass, grain, tied.into_iter())
}

fn count(mass: &[f64], grain: &[bool], ties: impl Iterator<Item = [u32; 2]>) -> Clusters {
    let mut sets = Sets::new(mass.len());
    for [a, b] in ties.map(|t| t.map(|b| b as usize)) {
        if grain[a] && grain[b] {
            sets.join(a, b);
        }
    }
    let mut members = vec![(0usize, 0.0); mass.len()];
    for b in (0..mass.len()).filter(|b| grain[*b]) {
        let set = &mut members[sets.of(b)];
        *set = (set.0 + 1, set.1 + mass[b]);
    }
    let mut out = Clusters::default();
    let (mut total, mut weighted) = (0.0, 0.0);
    for (size, mass) in members.into_iter().filter(|m| m.0 > 0) {
        out.count += usize::from(size > 1);
        out.largest = out.largest.max(size);
        total += mass;
        weighted += mass * size as f64;
        let entry = out.sizes.entry(size).or_default();
        *entry = (entry.0 + 1, entry.1 + mass);
    }
    out.mean = if total > 0.0 { weighted / total } else { 0.0 };
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_are_counted() {
        // Body 0 is a wall to which two grains are bonded; it does not connect them to each other.
        let grain = [false, true, true, true, true, true, true, true];
        let mass = [100.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 3.0];
        let ties = [[1, 2], [3, 2], [0, 1], [0, 4], [5, 6]];
        let c = count(&mass, &grain, ties.into_iter());
        assert_eq!((c.count, c.largest), (2, 3));
        // The clusters are {1, 2, 3} of 4 kg, {4} of 1, {5, 6} of 2, {7} of 3.
        assert!((c.mean - (4.0 * 3.0 + 1.0 + 2.0 * 2.0 + 3.0) / 10.0).abs() < 1e-15);
        assert_eq!(
            c.sizes,
            [(1, (2, 4.0)), (2, (1, 2.0)), (3, (1, 4.0))].into()
        );
        let none = count(&mass, &grain, std::iter::empty());
        assert_eq!((none.count, none.largest, none.mean), (0, 1, 1.0));
    }
}
