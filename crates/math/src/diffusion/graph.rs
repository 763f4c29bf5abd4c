//! Conductances between nodes at one instant.

use crate::diffusion::DiffusionError;

/// A conductance between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The nodes.
    pub nodes: [u32; 2],
    /// Conductance (W/K or S; per metre of depth in 2D), not negative.
    pub conductance: f64,
}

/// Nodes and the conductances between them.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Number of nodes.
    pub nodes: usize,
    /// Conductances, in an order that determines the last bits of results. Two edges of the same
    /// pair are added; an edge of a node to itself has no effect.
    pub edges: Vec<Edge>,
    /// Conductances of the elements of meshes, in the same units. They may be negative, as opposite
    /// an obtuse angle; a whole mesh still conducts no heat from a lower temperature to a higher
    /// one.
    pub elements: Vec<Edge>,
}

impl Graph {
    /// A graph of nodes with edges, without elements.
    pub fn new(nodes: usize, edges: Vec<Edge>) -> Self {
        Self {
            nodes,
            edges,
            elements: Vec::new(),
        }
    }

    /// Iterates over all conductances, of edges and of elements.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Edge> {
        self.edges.iter().chain(&self.elements)
    }

    /// Checks that conductances are finite and those of edges not negative, and that nodes exist.
    ///
    /// # Errors
    /// Returns the first invalid conductance.
    pub fn check(&self) -> Result<(), DiffusionError> {
        let is_valid = |e: &Edge| {
            e.conductance.is_finite() && e.nodes.iter().all(|n| (*n as usize) < self.nodes)
        };
        let mut edges = self.edges.iter();
        let wrong = edges.find(|e| !(is_valid(e) && e.conductance >= 0.0));
        match wrong.or_else(|| self.elements.iter().find(|e| !is_valid(e))) {
            None => Ok(()),
            Some(e) => Err(DiffusionError::Conductance {
                nodes: e.nodes.map(|n| n as usize),
                value: e.conductance,
            }),
        }
    }

    /// Returns the number of the component of each node: nodes connected by positive conductances.
    pub fn components(&self) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.nodes).collect();
        fn root(parent: &mut [usize], mut k: usize) -> usize {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        }
        for e in self.all().filter(|e| e.conductance > 0.0) {
            let [a, b] = e.nodes.map(|n| root(&mut parent, n as usize));
            // The smaller number is the root, so that components are numbered by their first node.
            parent[a.max(b)] = a.min(b);
        }
        (0..self.nodes).map(|k| root(&mut parent, k)).collect()
    }
}
