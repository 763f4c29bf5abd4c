//! Which first body each grain belongs to: the one to whose base a path of unbroken bonds ties it.
//!
//! A forest grows from the bases along bonds. A bond that breaks outside the forest changes nothing; one of the
//! forest cuts off a branch, which looks for another bond to what is tied: only the branch is walked. What finds
//! none is loose, in pieces that hang together.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// No body.
const NONE: u32 = u32::MAX;

/// The forest.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ties {
    /// Bodies at the other end of each body's bonds, once for each bond.
    bonds: Vec<Vec<u32>>,
    /// Base to which a body is tied; a base is tied to itself.
    base: Vec<u32>,
    /// The body through which it is tied, one step nearer to the base.
    parent: Vec<u32>,
    bases: Vec<u32>,
}

/// What a change of bonds did to the grains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// Pieces that came loose, each with the base that it was tied to and its bodies in their order.
    pub loose: Vec<(u32, Vec<u32>)>,
    /// Bodies that were tied, and the base to which they are now.
    pub tied: Vec<(u32, u32)>,
}

impl Ties {
    /// The forest of so many bodies from these bases, over these bonds.
    pub fn new(bodies: usize, bases: &[u32], bonds: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let mut ties = Self {
            bonds: vec![Vec::new(); bodies],
            base: vec![NONE; bodies],
            parent: vec![NONE; bodies],
            bases: bases.to_vec(),
        };
        for [a, b] in bonds {
            ties.join(a, b);
        }
        for base in bases {
            ties.base[*base as usize] = *base;
        }
        let mut tied = Vec::new();
        ties.spread(bases.to_vec(), &mut tied);
        ties
    }

    /// The base to which a body is tied.
    pub fn base(&self, body: u32) -> Option<u32> {
        let base = self.base[body as usize];
        (base != NONE).then_some(base)
    }

    /// Bonds of a body.
    pub fn degree(&self, body: u32) -> usize {
        self.bonds[body as usize].len()
    }

    /// The bodies that hang together with one over bonds, in their order; bases and what is tied to them are not
    /// crossed when the body is loose, for then there is no way to them.
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

    fn join(&mut self, a: u32, b: u32) {
        self.bonds[a as usize].push(b);
        self.bonds[b as usize].push(a);
    }

    fn part(&mut self, a: u32, b: u32) -> bool {
        let mut out = |x: u32, y: u32| {
            let list = &mut self.bonds[x as usize];
            let at = list.iter().position(|z| *z == y);
            at.map(|k| list.swap_remove(k)).is_some()
        };
        out(a, b) && out(b, a)
    }

    /// Bonds that were made and that broke since the last change; each pair of bodies once for each bond.
    pub fn change(&mut self, made: &[[u32; 2]], broken: &[[u32; 2]]) -> Change {
        for [a, b] in made {
            self.join(*a, *b);
        }
        let mut cut = Vec::new();
        for [a, b] in broken {
            if !self.part(*a, *b) {
                continue;
            }
            for (child, parent) in [(*a, *b), (*b, *a)] {
                let holds = self.bonds[child as usize].contains(&parent);
                if self.parent[child as usize] == parent && !holds {
                    cut.push(child);
                }
            }
        }
        let mut change = Change::default();
        // What is tied may now reach what is not.
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
        let tied_still = |ties: &Self, b: u32| ties.base[b as usize] != NONE;
        // From what stays tied beside the branch, along the bonds that are left.
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
            // What came loose now; what was loose before and is bonded to it was debris already.
            let piece: Vec<u32> = self.piece(*body);
            let now = piece.iter().filter(|b| before(**b) == Some(*base));
            let now: Vec<u32> = now.copied().collect();
            seen.extend(now.iter().copied());
            change.loose.push((*base, now));
        }
        change
    }

    /// The bodies tied through these, with them, in their order.
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

    /// Ties what bonds reach from bodies that are tied, nearest first.
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
        let mut ties = Ties::new(6, &[0], chain);
        assert_eq!((ties.base(4), ties.base(5)), (Some(0), None));
        let change = ties.change(&[], &[[2, 3]]);
        assert_eq!(change.loose, [(0, vec![3, 4])]);
        assert_eq!(ties.piece(4), [3, 4]);
        let change = ties.change(&[[4, 1], [5, 3]], &[]);
        assert_eq!(change.tied, [(3, 0), (4, 0), (5, 0)]);
        assert!(change.loose.is_empty());
    }

    #[test]
    fn a_bond_that_is_doubled_holds_once_more() {
        let mut ties = Ties::new(2, &[0], [[0, 1], [1, 0]]);
        assert_eq!(ties.change(&[], &[[0, 1]]), Change::default());
        assert_eq!(ties.change(&[], &[[0, 1]]).loose, [(0, vec![1])]);
    }

    #[test]
    fn a_grain_between_two_bases_goes_over_to_the_other() {
        let mut ties = Ties::new(4, &[0, 3], [[0, 1], [1, 2], [2, 3]]);
        assert_eq!((ties.base(1), ties.base(2)), (Some(0), Some(3)));
        assert_eq!(ties.change(&[], &[[0, 1]]).tied, [(1, 3)]);
        assert_eq!(ties.base(1), Some(3));
    }

    /// Bodies that a path joins to a base, by walking all bonds.
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
            let mut ties = Ties::new(bodies as usize, &bases, bonds.iter().copied());
            for _ in 0..60 {
                let tied =
                    |t: &Ties| -> Vec<bool> { (0..bodies).map(|b| t.base(b).is_some()).collect() };
                let before = tied(&ties);
                let broken: Vec<[u32; 2]> = (0..rng.random_range(0..12usize).min(bonds.len()))
                    .map(|_| bonds.swap_remove(rng.random_range(0..bonds.len())))
                    .collect();
                let made: Vec<[u32; 2]> = (0..rng.random_range(0..6))
                    .map(|_| [rng.random_range(0..bodies), rng.random_range(0..bodies)])
                    .filter(|[a, b]| a != b)
                    .collect();
                bonds.extend(&made);
                let change = ties.change(&made, &broken);
                let after = tied(&ties);
                assert_eq!(after, reached(bodies as usize, &bases, &bonds));
                // The change tells exactly what is different.
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
