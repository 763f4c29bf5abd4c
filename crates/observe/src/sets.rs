//! Disjoint sets.

/// Disjoint sets (union-find).
#[derive(Clone, Debug)]
pub struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Creates `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    /// Returns the representative of a member's set.
    pub fn of(&mut self, member: usize) -> usize {
        let mut k = member;
        while self.parent[k] as usize != k {
            self.parent[k] = self.parent[self.parent[k] as usize];
            k = self.parent[k] as usize;
        }
        k
    }

    /// Merges the sets of two members; the lower representative is kept, so that the result does
    /// not depend on the order.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }
}
