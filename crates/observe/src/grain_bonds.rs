//! Bonds of the grains in recorded states: how damaged they are, and which grains they connect.

use crate::observer::Observer;
use crate::sets::Sets;
use crate::statistics::Column;
use fretwork_core::contact::BondState;
use fretwork_core::view::{FieldValues, RunView};
use std::collections::HashMap;

/// Writes `damage` and `cluster` of each grain, for cases with bonds.
#[derive(Clone, Copy, Debug)]
pub struct GrainBonds;

impl Observer for GrainBonds {
    fn name(&self) -> String {
        "bonds of grains".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn grain_columns(&self) -> Vec<Column> {
        let damage = "mean damage of its bonds, 1 for each that broke; not a number without bonds and on first bodies";
        let cluster = "least identity of the grains that intact bonds connect with it, its own without; not a number on first bodies";
        vec![
            Column::new("damage", "", damage),
            Column::new("cluster", "", cluster),
        ]
    }

    fn grain_values(&self, run: &dyn RunView) -> Vec<Vec<f64>> {
        let grain = run.grain_flags();
        let mut intact = Vec::new();
        run.visit_contacts(&mut |contact| {
            if let BondState::Intact { damage } = contact.bond {
                intact.push((contact.bodies, damage));
            }
        });
        let bonds = Bonds::of(&grain, &intact, &run.broken_pairs());
        let ids = run.bodies().id;
        let index: HashMap<i64, usize> =
            ids.iter().zip(0..).map(|(id, b)| (*id as i64, b)).collect();
        let Some(FieldValues::Number(rows)) = run.grain_field("id") else {
            return vec![Vec::new(); 2];
        };
        let of = |values: &[f64]| {
            let value = |id: &f64| index.get(&(*id as i64)).map_or(f64::NAN, |b| values[*b]);
            rows.iter().map(value).collect()
        };
        let least = bonds.least.iter();
        let cluster: Vec<f64> = least
            .map(|b| b.map_or(f64::NAN, |b| ids[b] as f64))
            .collect();
        vec![of(&bonds.damage), of(&cluster)]
    }
}

/// What the bonds say of each body.
struct Bonds {
    /// Mean damage; NaN without bonds, and of first bodies.
    damage: Vec<f64>,
    /// The first grain of its cluster; none for first bodies.
    least: Vec<Option<usize>>,
}

impl Bonds {
    /// From the bodies that are grains, the intact bonds with their damage, and the broken ones.
    fn of(grain: &[bool], intact: &[([u32; 2], f64)], broken: &[[u32; 2]]) -> Self {
        let mut sums = vec![(0.0, 0.0); grain.len()];
        let mut sets = Sets::new(grain.len());
        let lost = broken.iter().map(|bodies| (*bodies, 1.0));
        for (bodies, damage) in intact.iter().copied().chain(lost) {
            for body in bodies {
                let (sum, count) = sums[body as usize];
                sums[body as usize] = (sum + damage, count + 1.0);
            }
        }
        for ([a, b], _) in intact {
            let (a, b) = (*a as usize, *b as usize);
            if grain[a] && grain[b] {
                sets.join(a, b);
            }
        }
        let all = || grain.iter().enumerate();
        Self {
            damage: all()
                .map(|(b, grain)| match sums[b] {
                    (sum, count) if *grain && count > 0.0 => sum / count,
                    _ => f64::NAN,
                })
                .collect(),
            least: all().map(|(b, grain)| grain.then(|| sets.of(b))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall, to which grain 1 is bonded; 1 and 2 are connected, 3 has lost its bond to 2, and 4
    /// never had one.
    #[test]
    fn damage_is_the_mean_and_clusters_end_at_walls_and_broken_bonds() {
        let grain = [false, true, true, true, true];
        let bonds = Bonds::of(&grain, &[([1, 0], 0.0), ([2, 1], 0.5)], &[[3, 2]]);
        assert_eq!(bonds.damage[1..4], [0.25, 0.75, 1.0]);
        assert!(bonds.damage[0].is_nan() && bonds.damage[4].is_nan());
        assert_eq!(bonds.least, [None, Some(1), Some(1), Some(3), Some(4)]);
    }
}
