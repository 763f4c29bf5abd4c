//! Sets of contacts connected through movable bodies. Within a step the sets do not act on each
//! other: bodies with imposed motion transmit no impulse.

use super::kinds::KINDS;

/// No set.
const NONE: u32 = u32::MAX;

/// The connected sets of the contacts of a problem, valid until the contacts change.
#[derive(Clone, Debug, Default)]
pub(super) struct ConnectedSets {
    /// The contacts for which the sets were found: the numbers of the orders of their rows
    /// ([`ContactOrder::changes`](super::colour::ContactOrder::changes)).
    pub of: Option<[u64; KINDS]>,
    /// Set of each body; `NONE` for bodies that do not move or have no contact.
    of_body: Vec<u32>,
    /// First body of each set.
    first: Vec<u32>,
    /// Number of contacts of each set.
    contacts: Vec<u32>,
    /// Whether each set has contacts with dynamical systems.
    with_systems: Vec<bool>,
    /// The controlled bodies, and their contacts with bodies that touch several controlled bodies,
    /// see `Problem::of_several_controlled`.
    pub controlled: Vec<u32>,
    pub of_several_controlled: Vec<usize>,
}

impl ConnectedSets {
    /// Finds the sets from the bodies that move and the pairs in contact.
    pub fn new(moves: &[bool], pairs: impl Fn(&mut dyn FnMut([u32; 2]))) -> Self {
        let mut parent: Vec<u32> = (0..moves.len() as u32).collect();
        pairs(&mut |[a, b]: [u32; 2]| {
            if moves[a as usize] && moves[b as usize] {
                let (a, b) = (root(&mut parent, a), root(&mut parent, b));
                parent[a.max(b) as usize] = a.min(b);
            }
        });
        let mut out = Self {
            of: None,
            of_body: vec![NONE; moves.len()],
            first: Vec::new(),
            contacts: Vec::new(),
            with_systems: Vec::new(),
            controlled: Vec::new(),
            of_several_controlled: Vec::new(),
        };
        pairs(&mut |[a, b]: [u32; 2]| {
            let body = if moves[a as usize] { a } else { b };
            if moves[body as usize] {
                let set = out.enter(root(&mut parent, body));
                out.contacts[set] += 1;
            }
        });
        // Parents come before their children.
        for (b, parent) in parent.iter().enumerate() {
            out.of_body[b] = out.of_body[*parent as usize];
        }
        out
    }

    /// Returns the set of a root body, which is added if it is new.
    fn enter(&mut self, root: u32) -> usize {
        let set = &mut self.of_body[root as usize];
        if *set == NONE {
            *set = self.contacts.len() as u32;
            self.first.push(root);
            self.contacts.push(0);
            self.with_systems.push(false);
        }
        *set as usize
    }

    /// Number of sets.
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Returns the first body of a set, which identifies it.
    pub fn first(&self, set: usize) -> u32 {
        self.first[set]
    }

    /// Number of contacts of a set between rigid bodies.
    pub fn contacts(&self, set: usize) -> usize {
        self.contacts[set] as usize
    }

    /// Records that a body has a contact with a dynamical system.
    pub fn touches_system(&mut self, body: u32) {
        if let Some(set) = self.of_body(body) {
            self.with_systems[set] = true;
        }
    }

    /// Returns whether a set has contacts with dynamical systems.
    pub fn with_systems(&self, set: usize) -> bool {
        self.with_systems[set]
    }

    /// The set of a body.
    pub fn of_body(&self, body: u32) -> Option<usize> {
        let set = *self.of_body.get(body as usize)?;
        (set != NONE).then_some(set as usize)
    }

    /// Returns the set of a contact of two bodies; `None` where neither moves.
    pub fn of(&self, [a, b]: [u32; 2]) -> Option<usize> {
        self.of_body(a).or_else(|| self.of_body(b))
    }
}

/// The first body of a tree, whose branches are shortened on the way.
fn root(parent: &mut [u32], mut body: u32) -> u32 {
    while parent[body as usize] != body {
        let above = parent[parent[body as usize] as usize];
        parent[body as usize] = above;
        body = above;
    }
    body
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two chains over a floor, which connects nothing; a body that touches only the floor, a body
    /// without contacts, and two fixed bodies.
    #[test]
    fn what_does_not_move_connects_nothing() {
        let moves = [false, true, true, true, true, true, true, false];
        let touching = [[0, 1], [2, 1], [4, 3], [0, 4], [3, 7], [5, 0], [0, 7]];
        let sets = ConnectedSets::new(&moves, |found| touching.into_iter().for_each(found));
        assert_eq!(sets.len(), 3);
        let of = [0, 1, 2, 3, 4, 5, 6, 7].map(|b| sets.of_body(b));
        let (a, b, c) = (Some(0), Some(1), Some(2));
        assert_eq!(of, [None, a, a, b, b, c, None, None]);
        assert_eq!([0, 1, 2].map(|k| sets.contacts(k)), [2, 3, 1]);
        assert_eq!([0, 1, 2].map(|k| sets.first(k)), [1, 3, 5]);
        assert_eq!((sets.of([0, 7]), sets.of([3, 7])), (None, b));
    }

    /// A long chain whose links are found in any order is one set.
    #[test]
    fn chains_are_one_set() {
        let moves = [true; 200];
        let links: Vec<[u32; 2]> = (0..199)
            .map(|k| (k * 83) % 199)
            .map(|k| [k + 1, k])
            .collect();
        let sets = ConnectedSets::new(&moves, |found| links.iter().copied().for_each(found));
        assert_eq!((sets.len(), sets.contacts(0)), (1, 199));
    }
}
