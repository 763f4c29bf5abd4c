//! Assignment of grains to first bodies: a grain belongs to the first body to whose base it is
//! connected by a path of intact bonds.
//!
//! A spanning forest grows from the bases along bonds. A broken bond outside the forest changes
//! nothing; one of the forest disconnects a branch, which searches for another bond to a connected
//! grain: only the branch is traversed. If there is none, the branch is loose and divided into
//! connected pieces.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// No body.
const NONE: u32 = u32::MAX;

/// The forest.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BondForest {
    /// Neighbours of each body, once per bond.
    bonds: Vec<Vec<u32>>,
    /// Base to which a body is connected; a base is connected to itself.
    base: Vec<u32>,
    /// Parent of a body in the forest, one bond nearer to the base.
    parent: Vec<u32>,
    bases: Vec<u32>,
}

/// Effect of formed and broken bonds on the grains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForestChange {
    /// Pieces that became loose, each with its former base and its bodies in order.
    pub loose: Vec<(u32, Vec<u32>)>,
    /// Bodies that became connected, with their new base.
    pub tied: Vec<(u32, u32)>,
}

impl BondForest {
    /// Builds the forest of a number of bodies from these bases and bonds.
    pub fn new(bodies: usize, bases: &[u32], bonds: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let mut forest = Self {
            bonds: vec![Vec::new(); bodies],
            base: vec![NONE; bodies],
            parent: vec![NONE; bodies],
            bases: bases.to_vec(),
        };
        for [a, b] in bonds {
            forest.add_bond(a, b);
        }
        for base in bases {
            forest.base[*base as usize] = *base;
        }
        let mut tied = Vec::new();
        forest.spread(bases.to_vec(), &mut tied);
        forest
    }

    /// Returns the base to which a body is connected.
    pub fn base(&self, body: u32) -> Option<u32> {
        let base = self.base[body as usize];
        (base != NONE).then_some(base)
    }

    /// Returns the number of bonds of a body.
    pub fn degree(&self, body: u32) -> usize {
        self.bonds[body as usize].len()
    }

    /// Returns the connected piece of a body, in order; for a loose body the search does not enter
    /// bases or connected bodies, since no path leads there.
    pub fn piece(&self, body: u32) -> Vec<u32> {
        let mut piece = BTreeSet::from([body]);
        let mut open = vec![body];
        while let Some(x) = open.pop() {
            for y in &self.bonds[x as usize] {
                if !self.bases.contains(y) && piece.insert(*y) {
                    open.push(*y);
                }
            }
        }
        piece.into_iter().collect()
    }

    fn add_bond(&mut self, a: u32, b: u32) {
        self.bonds[a as usize].push(b);
        self.bonds[b as usize].push(a);
    }

    /// Removes a bond; returns whether there was one.
    fn remove_bond(&mut self, a: u32, b: u32) -> bool {
        let mut remove = |x: u32, y: u32| {
            let list = &mut self.bonds[x as usize];
            let at = list.iter().position(|z| *z == y);
            at.map(|k| list.swap_remove(k)).is_some()
        };
        remove(a, b) && remove(b, a)
    }

    /// Applies the bonds formed and broken since the last call, with one pair of bodies per bond.
    pub fn change(&mut self, made: &[[u32; 2]], broken: &[[u32; 2]]) -> ForestChange {
        for [a, b] in made {
            self.add_bond(*a, *b);
        }
        let mut cut = Vec::new();
        for [a, b] in broken {
            if !self.remove_bond(*a, *b) {
                continue;
            }
            for (child, parent) in [(*a, *b), (*b, *a)] {
                let holds = self.bonds[child as usize].contains(&parent);
                if self.parent[child as usize] == parent && !holds {
                    cut.push(child);
                }
            }
        }
        let mut change = ForestChange::default();
        // Connected bodies may now reach loose ones.
        let grown = made
            .iter()
            .flatten()
            .filter(|b| self.base[**b as usize] != NONE);
        let grown: Vec<u32> = grown.copied().collect();
        let branch = self.branch(cut);
        let was: Vec<(u32, u32)> = branch
            .iter()
            .map(|b| (*b, self.base[*b as usize]))
            .collect();
        for b in &branch {
            (self.base[*b as usize], self.parent[*b as usize]) = (NONE, NONE);
        }
        let tied_still = |forest: &Self, b: u32| forest.base[b as usize] != NONE;
        // Search from the bodies that remain connected next to the branch, along the remaining
        // bonds.
        let mut seeds: Vec<u32> = branch
            .iter()
            .flat_map(|b| self.bonds[*b as usize].iter().copied())
            .chain(grown)
            .filter(|b| tied_still(self, *b))
            .collect();
        seeds.sort_unstable();
        seeds.dedup();
        let mut tied = Vec::new();
        self.spread(seeds, &mut tied);
        let before = |b: u32| {
            let at = was.binary_search_by_key(&b, |w| w.0);
            at.ok().map(|k| was[k].1)
        };
        change.tied = tied
            .iter()
            .map(|b| (*b, self.base[*b as usize]))
            .filter(|(b, base)| before(*b) != Some(*base))
            .collect();
        change.tied.sort_unstable();
        let mut seen = BTreeSet::new();
        for (body, base) in &was {
            if self.base[*body as usize] != NONE || seen.contains(body) {
                continue;
            }
            // Only the newly loose part counts; loose grains bonded to it were debris before.
            let piece: Vec<u32> = self.piece(*body);
            let now = piece.iter().filter(|b| before(**b) == Some(*base));
            let now: Vec<u32> = now.copied().collect();
            seen.extend(now.iter().copied());
            change.loose.push((*base, now));
        }
        change
    }

    /// Returns the bodies connected through `roots`, including them, in order.
    fn branch(&self, roots: Vec<u32>) -> Vec<u32> {
        let mut branch: BTreeSet<u32> = roots.iter().copied().collect();
        let mut open = roots;
        while let Some(x) = open.pop() {
            for y in &self.bonds[x as usize] {
                if self.parent[*y as usize] == x && branch.insert(*y) {
                    open.push(*y);
                }
            }
        }
        branch.into_iter().collect()
    }

    /// Connects the bodies reachable by bonds from connected bodies, breadth first.
    fn spread(&mut self, mut front: Vec<u32>, tied: &mut Vec<u32>) {
        while !front.is_empty() {
            let mut next = Vec::new();
            for x in front {
                for k in 0..self.bonds[x as usize].len() {
                    let y = self.bonds[x as usize][k];
                    if self.base[y as usize] == NONE {
                        self.base[y as usize] = self.base[x as usize];
                        self.parent[y as usize] = x;
                        next.push(y);
                    }
                }
            }
            next.sort_unstable();
            tied.extend(&next);
            front = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    #[test]
    fn a_chain_cut_in_the_middle_loses_its_end_and_gets_it_back() {
        let chain = (0..4).map(|k| [k, k + 1]);
        let mut forest = BondForest::new(6, &[0], chain);
        assert_eq!((forest.base(4), forest.base(5)), (Some(0), None));
        let change = forest.change(&[], &[[2, 3]]);
        assert_eq!(change.loose, [(0, vec![3, 4])]);
        assert_eq!(forest.piece(4), [3, 4]);
        let change = forest.change(&[[4, 1], [5, 3]], &[]);
        assert_eq!(change.tied, [(3, 0), (4, 0), (5, 0)]);
        assert!(change.loose.is_empty());
    }

    #[test]
    fn a_bond_that_is_doubled_holds_once_more() {
        let mut forest = BondForest::new(2, &[0], [[0, 1], [1, 0]]);
        assert_eq!(forest.change(&[], &[[0, 1]]), ForestChange::default());
        assert_eq!(forest.change(&[], &[[0, 1]]).loose, [(0, vec![1])]);
    }

    #[test]
    fn a_grain_between_two_bases_goes_over_to_the_other() {
        let mut forest = BondForest::new(4, &[0, 3], [[0, 1], [1, 2], [2, 3]]);
        assert_eq!((forest.base(1), forest.base(2)), (Some(0), Some(3)));
        assert_eq!(forest.change(&[], &[[0, 1]]).tied, [(1, 3)]);
        assert_eq!(forest.base(1), Some(3));
    }

    /// Bodies connected to a base, by traversing all bonds.
    fn reached(bodies: usize, bases: &[u32], bonds: &[[u32; 2]]) -> Vec<bool> {
        let mut tied = vec![false; bodies];
        bases.iter().for_each(|b| tied[*b as usize] = true);
        loop {
            let mut grew = false;
            for [a, b] in bonds.iter().map(|p| p.map(|b| b as usize)) {
                grew |= tied[a] != tied[b];
                let either = tied[a] || tied[b];
                (tied[a], tied[b]) = (either, either);
            }
            if !grew {
                return tied;
            }
        }
    }

    #[test]
    fn random_breaks_and_joins_agree_with_walking_all_bonds() {
        for seed in 0..20 {
            let mut rng = Pcg64::seed_from_u64(seed);
            let bodies = 120u32;
            let bases = [0, 1];
            let mut bonds: Vec<[u32; 2]> = (0..260)
                .map(|_| [rng.random_range(0..bodies), rng.random_range(0..bodies)])
                .filter(|[a, b]| a != b)
                .collect();
            let mut forest = BondForest::new(bodies as usize, &bases, bonds.iter().copied());
            for _ in 0..60 {
                let tied = |t: &BondForest| -> Vec<bool> {
                    (0..bodies).map(|b| t.base(b).is_some()).collect()
                };
                let before = tied(&forest);
                let broken: Vec<[u32; 2]> = (0..rng.random_range(0..12usize).min(bonds.len()))
                    .map(|_| bonds.swap_remove(rng.random_range(0..bonds.len())))
                    .collect();
                let made: Vec<[u32; 2]> = (0..rng.random_range(0..6))
                    .map(|_| [rng.random_range(0..bodies), rng.random_range(0..bodies)])
                    .filter(|[a, b]| a != b)
                    .collect();
                bonds.extend(&made);
                let change = forest.change(&made, &broken);
                let after = tied(&forest);
                assert_eq!(after, reached(bodies as usize, &bases, &bonds));
                // The reported change is exactly the difference.
                let mut told = before;
                for (_, piece) in &change.loose {
                    piece
                        .iter()
                        .for_each(|b| assert!(std::mem::take(&mut told[*b as usize])));
                }
                for (b, base) in &change.tied {
                    assert!(bases.contains(base));
                    told[*b as usize] = true;
                }
                assert_eq!(told, after);
            }
        }
    }
}
