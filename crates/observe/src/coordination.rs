//! Coordination number: contacts per grain that carry force.

use fretwork_core::view::RunView;
use nalgebra::Vector3;
use std::collections::HashSet;

/// A contact counts if its normal force exceeds this fraction of the mean; smaller forces are
/// within the solver's tolerance.
const FAINT: f64 = 1e-3;

/// Coordination of the free grains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordination {
    /// Mean number of contacts that carry force, over all grains; a contact with a wall counts
    /// once, and so do all contacts with one neighbour of a deformable grain.
    pub mean: f64,
    /// Mean number of contacts over the grains and contacts that remain after removing rattlers.
    pub carried: f64,
    /// Fraction of rattlers: grains with fewer than two such contacts, which cannot be in
    /// equilibrium, and those that become so when other rattlers are removed.
    pub rattlers: f64,
}

/// Returns the coordination of the contacts of the last step.
pub fn coordination(run: &dyn RunView) -> Coordination {
    count_pairs(&run.grain_flags(), &bearing(run))
}

/// Returns the number of contacts of each body that carry force in the last step, with the
/// threshold of [`coordination`].
pub fn degrees(run: &dyn RunView) -> Vec<u32> {
    let mut degree = vec![0; run.bodies().len()];
    for body in bearing(run).into_iter().flatten() {
        degree[body as usize] += 1;
    }
    degree
}

/// Returns the bodies of the contacts that carry force.
fn bearing(run: &dyn RunView) -> Vec<[u32; 2]> {
    let mut pressed: Vec<([u32; 2], f64)> = Vec::new();
    run.visit_contacts(&mut |c| {
        let force = Vector3::from(c.normal).dot(&Vector3::from(c.impulse));
        if force > 0.0 {
            pressed.push((c.bodies, force));
        }
    });
    let (sum, count) = pressed.iter().fold((0.0, 0), |(f, n), p| (f + p.1, n + 1));
    let least = FAINT * sum / f64::from(count.max(1));
    let pairs = pressed.into_iter().filter(|p| p.1 > least);
    let bodies = run.bodies();
    let deforms = |b: u32| bodies.carrier(b as usize).is_some_and(|c| c.grain);
    // Points of deformable grains touch one by one; a neighbour counts once.
    let mut seen = HashSet::new();
    let once = |bodies: &[u32; 2]| {
        let [a, b] = *bodies;
        !(deforms(a) || deforms(b)) || seen.insert([a.min(b), a.max(b)])
    };
    pairs.map(|p| p.0).filter(once).collect()
}

fn count_pairs(free: &[bool], pairs: &[[u32; 2]]) -> Coordination {
    let mut held = free.to_vec();
    let mut first = None;
    loop {
        let mut degree = vec![0u32; free.len()];
        for pair in pairs {
            let [a, b] = pair.map(|b| b as usize);
            // Walls always count as supports, rattlers do not.
            if (held[a] || !free[a]) && (held[b] || !free[b]) {
                degree[a] += 1;
                degree[b] += 1;
            }
        }
        let mean = |of: &[bool]| {
            let members = || degree.iter().zip(of).filter(|(_, m)| **m).map(|(d, _)| *d);
            f64::from(members().sum::<u32>()) / members().count().max(1) as f64
        };
        let all = *first.get_or_insert_with(|| mean(free));
        let left: Vec<bool> = held
            .iter()
            .zip(&degree)
            .map(|(h, d)| *h && *d >= 2)
            .collect();
        if left == held {
            let count = |of: &[bool]| of.iter().filter(|m| **m).count() as f64;
            let grains = count(free).max(1.0);
            return Coordination {
                mean: all,
                carried: mean(&held),
                rattlers: 1.0 - count(&held) / grains,
            };
        }
        held = left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rattlers_are_taken_out_one_after_another() {
        // A triangle of grains on a wall (body 0), a chain of two attached to it, and one single
        // grain.
        let free = [false, true, true, true, true, true, true];
        let pairs = [[1, 2], [2, 3], [1, 3], [1, 0], [3, 4], [4, 5]];
        let z = count_pairs(&free, &pairs);
        assert!((z.mean - 11.0 / 6.0).abs() < 1e-12);
        assert!((z.carried - 7.0 / 3.0).abs() < 1e-12);
        assert!((z.rattlers - 0.5).abs() < 1e-12);
    }

    #[test]
    fn no_contacts_no_neighbours() {
        let z = count_pairs(&[true, true], &[]);
        assert_eq!((z.mean, z.carried, z.rattlers), (0.0, 0.0, 1.0));
    }
}
