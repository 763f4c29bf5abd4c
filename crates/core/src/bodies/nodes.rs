//! Points of dynamical systems as weighted sums of nodes.

use crate::geometry::space::VectorLike;
use std::cmp::Ordering;
use std::sync::Arc;

/// A point of a system as a weighted sum of nodes: its displacement is u = sum w_a u_a, and an
/// impulse p on it acts as w_a p on each node a. The weights are shape functions, affine
/// coordinates of a point in a frame, or those of an average over several places.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes(Terms);

/// Nodes and weights: in place if there are few, which is the usual case, or else shared by all
/// copies.
#[derive(Clone, Debug, PartialEq)]
enum Terms {
    Inline {
        ids: [u32; INLINE],
        weights: [f64; INLINE],
        count: u8,
    },
    Shared(Arc<[(u32, f64)]>),
}

/// Magnitude of the weight up to which a vertex of a facet is left out.
const ROUNDING: f64 = 1e-9;

/// Largest number of nodes stored in place: those of a facet with quadratic shape functions.
const INLINE: usize = 8;

impl Nodes {
    /// The point at a node.
    pub fn one(node: u32) -> Self {
        Self::inline(&[(node, 1.0)])
    }

    fn inline(terms: &[(u32, f64)]) -> Self {
        let (mut ids, mut weights) = ([0; INLINE], [0.0; INLINE]);
        for (k, (node, weight)) in terms.iter().enumerate() {
            (ids[k], weights[k]) = (*node, *weight);
        }
        let count = terms.len() as u8;
        Self(Terms::Inline {
            ids,
            weights,
            count,
        })
    }

    /// A weighted sum of different nodes; `None` without nodes.
    pub fn sum(terms: &[(u32, f64)]) -> Option<Self> {
        match terms.len() {
            0 => None,
            1..=INLINE => Some(Self::inline(terms)),
            _ => Some(Self(Terms::Shared(terms.into()))),
        }
    }

    /// Returns a position on a facet as the weighted sum of its vertices by its shape functions: at
    /// a vertex, to rounding, the node alone, and on an edge two nodes, which costs the solver
    /// less. `None` without vertices.
    pub fn on_facet(terms: &[(u32, f64)]) -> Option<Self> {
        let there = terms.iter().filter(|(_, weight)| weight.abs() > ROUNDING);
        let there: Vec<_> = there.copied().collect();
        if there.len() == terms.len() {
            return Self::sum(terms);
        }
        if let [(node, _)] = there[..] {
            return Some(Self::one(node));
        }
        let all: f64 = there.iter().map(|(_, weight)| weight).sum();
        let scaled = there.iter().map(|(node, weight)| (*node, weight / all));
        Self::sum(&scaled.collect::<Vec<_>>())
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        match &self.0 {
            Terms::Inline { count, .. } => usize::from(*count),
            Terms::Shared(terms) => terms.len(),
        }
    }

    /// Compares points by nodes and then by weights; equal if both are equal.
    pub fn order(&self, other: &Self) -> Ordering {
        let ids = |p: &Self, q: &Self| p.terms().map(|t| t.0).cmp(q.terms().map(|t| t.0));
        let by_nodes = self.count().cmp(&other.count());
        by_nodes.then_with(|| ids(self, other)).then_with(|| {
            let weights = self.terms().zip(other.terms());
            weights.fold(Ordering::Equal, |order, (a, b)| {
                order.then_with(|| a.1.total_cmp(&b.1))
            })
        })
    }

    /// Returns the node at an index, from 0 to `count` - 1, and its weight.
    fn term(&self, k: usize) -> (u32, f64) {
        match &self.0 {
            Terms::Inline { ids, weights, .. } => (ids[k], weights[k]),
            Terms::Shared(terms) => terms[k],
        }
    }

    /// Returns the weighted sum of the vectors that `of` gives at the nodes.
    pub fn sum_of<V: VectorLike>(&self, of: impl Fn(u32) -> V) -> V {
        let terms = self.terms();
        terms.fold(V::zero(), |sum, (node, weight)| sum + of(node) * weight)
    }

    /// The nodes and their weights.
    pub fn terms(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        (0..self.count()).map(|k| self.term(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_at_a_vertex_is_its_node() {
        let at = |x: f64| [(4, x), (7, 1.0 - x)];
        for (x, node) in [(1e-10, 7), (-1e-10, 7), (1.0 - 1e-10, 4)] {
            assert_eq!(Nodes::on_facet(&at(x)), Some(Nodes::one(node)));
        }
        assert_eq!(Nodes::on_facet(&at(1e-8)), Nodes::sum(&at(1e-8)));
        let edge = [(4, 0.25), (5, 1e-12), (7, 0.75)];
        assert_eq!(Nodes::on_facet(&edge), Nodes::sum(&[(4, 0.25), (7, 0.75)]));
        assert_eq!(Nodes::on_facet(&[]), None);
    }

    #[test]
    fn any_number_of_nodes_is_kept_in_order() {
        for count in [1u32, 8, 9, 40] {
            let terms: Vec<(u32, f64)> = (0..count)
                .map(|k| (3 * k, 1.0 / f64::from(k + 1)))
                .collect();
            let nodes = Nodes::sum(&terms).unwrap();
            assert_eq!(nodes.terms().collect::<Vec<_>>(), terms);
            assert!(nodes.order(&nodes.clone()).is_eq());
            assert!(Nodes::one(0).order(&nodes).is_le());
        }
        assert_eq!(Nodes::sum(&[]), None);
    }
}
