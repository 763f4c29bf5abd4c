//! Coupling of bodies by contacts.

use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::Mobility;

/// Pairs of bodies in contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::solve) struct Neighbours {
    /// First row of each body; immovable bodies have no rows.
    pub starts: Vec<usize>,
    /// Movable neighbours of each body, including itself, increasing.
    pub near: Vec<Vec<u32>>,
}

/// Returns the number of degrees of freedom of a body.
pub(in crate::solve) fn degrees_of_freedom<S: Space>() -> usize {
    S::D + S::Spin::N
}

impl Neighbours {
    /// Finds the neighbours among bodies with these mobilities from the pairs that are in contact.
    pub fn new<S: Space>(masses: &[Mobility<S>], pairs: impl Iterator<Item = [u32; 2]>) -> Self {
        let moves: Vec<bool> = masses.iter().map(Mobility::moves).collect();
        let mut near: Vec<Vec<u32>> = (0..masses.len())
            .map(|b| if moves[b] { vec![b as u32] } else { Vec::new() })
            .collect();
        for [a, b] in pairs {
            if moves[a as usize] && moves[b as usize] {
                near[a as usize].push(b);
                near[b as usize].push(a);
            }
        }
        let mut starts = vec![0];
        for (near, moves) in near.iter_mut().zip(&moves) {
            near.sort_unstable();
            near.dedup();
            starts.push(
                starts[starts.len() - 1] + if *moves { degrees_of_freedom::<S>() } else { 0 },
            );
        }
        Self { starts, near }
    }

    /// Returns the total number of degrees of freedom.
    pub fn rows(&self) -> usize {
        self.starts[self.near.len()]
    }

    /// Whether a body moves.
    pub fn moves(&self, body: u32) -> bool {
        !self.near[body as usize].is_empty()
    }
}
