//! The compliance of the nodes of a system, kept between steps of the same length and read in place
//! by the solver.

use crate::geometry::space::{MatrixLike, Space, VectorLike};
use std::marker::PhantomData;
use std::sync::OnceLock;

/// Blocks P_a A^-1 P_b^T (1/kg) of nodes of a system, column by column: the column of a node b has
/// the change of the velocities of all nodes a by an impulse on b. Columns are computed when they
/// are first requested.
///
/// A column is D rows of numbers, one for each axis of the impulse, with the velocities of all
/// nodes one after the other (see [`column_of`]).
#[derive(Clone, Debug)]
pub struct Compliance<S: Space> {
    nodes: Vec<u32>,
    columns: Vec<OnceLock<Box<[f64]>>>,
    space: PhantomData<S>,
}

impl<S: Space> Compliance<S> {
    /// Creates the compliance of some nodes (in any order, each counts once), without columns.
    pub fn new(mut nodes: Vec<u32>) -> Self {
        nodes.sort_unstable();
        nodes.dedup();
        let columns = nodes.iter().map(|_| OnceLock::new()).collect();
        Self {
            nodes,
            columns,
            space: PhantomData,
        }
    }

    /// Ids of the nodes in the system, in increasing order.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Returns the index of a node in the list; `None` for a node that is not in it.
    pub fn place(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Returns the column of the node at an index, which is computed at the first call: `find`
    /// gives the velocity of a node for a unit impulse along an axis (1/kg).
    pub fn column_or<F: Fn(usize) -> S::Vector>(
        &self,
        at: usize,
        find: impl FnMut(usize) -> F,
    ) -> &[f64] {
        self.columns[at]
            .get_or_init(|| column_of::<S, F>(self.nodes.len(), find).into_boxed_slice())
    }

    /// Returns the column of a node by its index; empty if it was not requested.
    pub fn column(&self, at: usize) -> &[f64] {
        self.columns[at].get().map_or(&[], |column| column)
    }
}

/// Returns a column of a number of nodes: for each axis of the impulse `find` gives the velocity of
/// a node by its index (1/kg).
pub fn column_of<S: Space, F: Fn(usize) -> S::Vector>(
    count: usize,
    mut find: impl FnMut(usize) -> F,
) -> Vec<f64> {
    let mut out = Vec::with_capacity(S::D * S::D * count);
    for axis in 0..S::D {
        let velocity = find(axis);
        for node in 0..count {
            let v = velocity(node);
            out.extend((0..S::D).map(|k| v[k]));
        }
    }
    out
}

/// The block of the node at a place in a column of a number of nodes (1/kg).
pub fn block_of<S: Space>(column: &[f64], count: usize, at: usize) -> S::Matrix {
    let mut block = S::Matrix::uniform(0.0);
    for (axis, row) in column.chunks_exact(S::D * count).enumerate() {
        let mut unit = S::Vector::zero();
        unit[axis] = 1.0;
        let velocity = S::Vector::from_slice(&row[at * S::D..][..S::D]);
        block = block + S::Matrix::dyad(&velocity, &unit);
    }
    block
}
