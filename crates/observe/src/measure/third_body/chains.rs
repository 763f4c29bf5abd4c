//! Force chains after Peters, Muthuswamy, Wibowo, Tordesillas, Phys. Rev. E 72 (2005) 041307.
//!
//! The load of a grain is its own stress, sum f (x) l over its contacts divided by its volume.
//! Candidates are the grains whose major principal stress is at least the mean over those that
//! carry load. Two of them are linked if the line between them is within 45 degrees of the major
//! principal directions of both. If there are several such neighbours on one side of a grain, the
//! one with the largest force is chosen, and the link must be chosen from both ends, so that chains
//! do not branch. A chain has at least three grains.

use crate::sets::Sets;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_1_SQRT_2;

/// Two grains that press on each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct GrainPair {
    /// The grains.
    pub ends: [usize; 2],
    /// Vector from the first to the second (m).
    pub branch: Vector3<f64>,
    /// Normal force (any unit).
    pub force: f64,
}

/// The force chains at an instant.
#[derive(Clone, Debug, Default)]
pub(super) struct Chains {
    /// Number of chains.
    pub count: usize,
    /// Number of grains in chains.
    pub grains: usize,
    /// Links of the chains, as indices of pairs.
    pub links: Vec<usize>,
}

/// Finds the chains. `loads` are the stresses of the grains, symmetric and positive in compression.
pub(super) fn chains(loads: &[Matrix3<f64>], flat: bool, pairs: &[GrainPair]) -> Chains {
    let major: Vec<(f64, Vector3<f64>)> = loads.iter().map(|m| principal(m, flat)).collect();
    let carrying = || major.iter().filter(|m| m.0 > 0.0);
    let mean = carrying().map(|m| m.0).sum::<f64>() / carrying().count().max(1) as f64;
    let heavy = |k: usize| major[k].0 > 0.0 && major[k].0 >= mean * (1.0 - 1e-12);
    // This is the best pair of each grain on either side.
    let mut best: Vec<[Option<usize>; 2]> = vec![[None; 2]; loads.len()];
    let side = |pair: &GrainPair, end: usize| {
        let away = if end == 0 { pair.branch } else { -pair.branch };
        let cosine = major[pair.ends[end]].1.dot(&away) / away.norm();
        (cosine.abs() >= FRAC_1_SQRT_2).then_some(usize::from(cosine < 0.0))
    };
    for (k, pair) in pairs.iter().enumerate() {
        if !(heavy(pair.ends[0]) && heavy(pair.ends[1])) {
            continue;
        }
        let (Some(a), Some(b)) = (side(pair, 0), side(pair, 1)) else {
            continue;
        };
        for (end, side) in [(0, a), (1, b)] {
            let seen = &mut best[pair.ends[end]][side];
            if seen.is_none_or(|old| pairs[old].force < pair.force) {
                *seen = Some(k);
            }
        }
    }
    let mutual = |k: &usize| pairs[*k].ends.iter().all(|e| best[*e].contains(&Some(*k)));
    let links: Vec<usize> = (0..pairs.len()).filter(mutual).collect();
    let mut sets = Sets::new(loads.len());
    for k in &links {
        sets.join(pairs[*k].ends[0], pairs[*k].ends[1]);
    }
    let mut sizes = vec![0usize; loads.len()];
    for k in 0..loads.len() {
        sizes[sets.of(k)] += 1;
    }
    let long = |sets: &mut Sets, k: usize| sizes[sets.of(k)] >= 3;
    Chains {
        count: sizes.iter().filter(|n| **n >= 3).count(),
        grains: sizes.iter().filter(|n| **n >= 3).sum(),
        links: links
            .into_iter()
            .filter(|k| long(&mut sets, pairs[*k].ends[0]))
            .collect(),
    }
}

/// Returns the major principal value and its direction.
fn principal(m: &Matrix3<f64>, flat: bool) -> (f64, Vector3<f64>) {
    if flat {
        let (mean, half) = (0.5 * (m[(0, 0)] + m[(1, 1)]), 0.5 * (m[(0, 0)] - m[(1, 1)]));
        let shear = m[(0, 1)];
        let (sin, cos) = (0.5 * shear.atan2(half)).sin_cos();
        return (mean + half.hypot(shear), Vector3::new(cos, sin, 0.0));
    }
    if !m.iter().all(|x| x.is_finite()) {
        return (0.0, Vector3::x());
    }
    let eigen = m.symmetric_eigen();
    let k = eigen.eigenvalues.imax();
    (eigen.eigenvalues[k], eigen.eigenvectors.column(k).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns grains on a line through the origin, with stress `load` along it.
    fn column(n: usize, direction: Vector3<f64>, load: f64) -> (Vec<Matrix3<f64>>, Vec<GrainPair>) {
        let loads = vec![direction * direction.transpose() * load; n];
        let pair = |k: usize| GrainPair {
            ends: [k, k + 1],
            branch: direction,
            force: load,
        };
        (loads, (0..n - 1).map(pair).collect())
    }

    #[test]
    fn a_loaded_column_is_one_chain_and_a_pair_is_none() {
        for (flat, direction) in [
            (true, Vector3::y()),
            (true, Vector3::new(0.6, 0.8, 0.0)),
            (false, Vector3::new(0.48, 0.6, 0.64)),
        ] {
            let (mut loads, mut pairs) = column(7, direction, 5.0);
            // Two weakly loaded grains are next to the line, one of them touching it.
            loads.extend([Matrix3::identity() * 0.1; 2]);
            for ends in [[3, 7], [7, 8]] {
                let branch = Vector3::new(0.8, -0.6, 0.0);
                let force = 0.1;
                pairs.push(GrainPair {
                    ends,
                    branch,
                    force,
                });
            }
            let found = chains(&loads, flat, &pairs);
            assert_eq!((found.count, found.grains), (1, 7));
            assert_eq!(found.links, [0, 1, 2, 3, 4, 5]);
            let (loads, pairs) = column(2, direction, 5.0);
            assert_eq!(chains(&loads, flat, &pairs).count, 0);
        }
    }

    #[test]
    fn a_chain_ends_where_it_would_turn_by_more_than_45_degrees() {
        let (loads, mut pairs) = column(7, Vector3::y(), 1.0);
        for (turn, count) in [(44f64, 1), (46.0, 2)] {
            let (sin, cos) = turn.to_radians().sin_cos();
            pairs[2].branch = Vector3::new(sin, cos, 0.0);
            let found = chains(&loads, true, &pairs);
            assert_eq!((found.count, found.grains), (count, 7));
        }
    }

    #[test]
    fn a_chain_follows_the_largest_force() {
        let (mut loads, mut pairs) = column(4, Vector3::y(), 1.0);
        loads.push(loads[0]);
        pairs.push(GrainPair {
            ends: [1, 4],
            branch: Vector3::new(0.5, 0.9, 0.0),
            force: 2.0,
        });
        // The chain is 0-1-4; 2-3 remain as a pair.
        let found = chains(&loads, true, &pairs);
        assert_eq!((found.count, found.grains), (1, 3));
        assert_eq!(found.links, [0, 3]);
    }
}
