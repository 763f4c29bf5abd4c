//! The points of a large system that carry impulses.
//!
//! An impulse on a node changes the velocities of all nodes of its system, and each update of a
//! contact would read the column of the compliance from memory. Contacts act on points, which are
//! weighted sums of nodes. Between two convergence tests sweeps update the velocities of loaded
//! points only, with blocks of their own compliance that fit in a cache. The velocities of the
//! other points keep their values from the last test; they are computed when a point is loaded for
//! the first time, and for all nodes at the next test. Where contacts act on more points than there
//! are nodes, sweeps update the nodes instead, so that the blocks never have more columns than
//! there are nodes.

use crate::geometry::space::{Space, VectorLike};
use pulp::Arch;

/// Column of a point that is not loaded.
const NONE: u32 = u32::MAX;

/// Number of points for which columns are allocated in addition to those loaded at that time.
const SPARE: usize = 16;

/// Adds the effect of an impulse to velocities: `rows` has one row for each axis of the impulse
/// (1/kg), `velocities` the components of all nodes (m/s).
pub(super) fn add_response<'a, S: Space>(
    velocities: &mut [f64],
    rows: impl Fn(usize) -> &'a [f64],
    impulse: &S::Vector,
) {
    let ([a, b], [p, q]) = ([rows(0), rows(1)], [impulse[0], impulse[1]]);
    // This is compiled for wide registers where the processor has them; products and sums are still
    // rounded one by one.
    if S::D == 2 {
        Arch::new().dispatch(|| {
            for ((v, a), b) in velocities.iter_mut().zip(a).zip(b) {
                *v += a * p + b * q;
            }
        });
    } else {
        let (c, r) = (rows(2), impulse[2]);
        Arch::new().dispatch(|| {
            for (((v, a), b), c) in velocities.iter_mut().zip(a).zip(b).zip(c) {
                *v += a * p + b * q + c * r;
            }
        });
    }
}

/// Weighted sums of the nodes of a system, identified by index: first each single node, then the
/// added sums.
#[derive(Clone, Debug)]
pub(super) struct Points {
    /// End of the terms of each point.
    ends: Vec<u32>,
    /// Nodes with their weights, point by point.
    terms: Vec<(u32, f64)>,
    /// Number of points that are single nodes; these come first.
    nodes: u32,
    /// Whether contacts act on each node, and the number of such nodes.
    touched: Vec<bool>,
    touched_nodes: usize,
    /// Number of such nodes that are contact points by themselves.
    alone: Vec<bool>,
    alone_nodes: usize,
}

impl Points {
    /// A number of nodes.
    pub fn new(nodes: usize) -> Self {
        let nodes = nodes as u32;
        Self {
            ends: (1..=nodes).collect(),
            terms: (0..nodes).map(|node| (node, 1.0)).collect(),
            nodes,
            touched: vec![false; nodes as usize],
            touched_nodes: 0,
            alone: vec![false; nodes as usize],
            alone_nodes: 0,
        }
    }

    /// Adds a point; returns its index.
    pub fn add(&mut self, terms: &[(u32, f64)]) -> u32 {
        let mut count = 0;
        for (node, weight) in terms {
            if *weight != 0.0 {
                count += 1;
                let touched = std::mem::replace(&mut self.touched[*node as usize], true);
                self.touched_nodes += usize::from(!touched);
                self.terms.push((*node, *weight));
            }
        }
        if let Some((node, 1.0)) = self.terms.last().copied()
            && count == 1
        {
            self.terms.pop();
            let alone = std::mem::replace(&mut self.alone[node as usize], true);
            self.alone_nodes += usize::from(!alone);
            return node;
        }
        self.ends.push(self.terms.len() as u32);
        self.ends.len() as u32 - 1
    }

    /// Whether contacts act on more points than nodes.
    pub fn outnumber_nodes(&self) -> bool {
        let sums = self.ends.len() - self.nodes as usize;
        sums + self.alone_nodes > self.touched_nodes
    }

    /// The terms of a point.
    #[inline]
    pub fn terms(&self, point: u32) -> &[(u32, f64)] {
        let k = point as usize;
        let from = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.terms[from as usize..self.ends[k] as usize]
    }

    /// Returns the weighted sum for a point of vectors given per node.
    #[inline]
    pub fn sum<S: Space>(&self, point: u32, all: &[f64]) -> S::Vector {
        if point < self.nodes {
            return vector::<S>(all, point as usize);
        }
        let terms = self.terms(point).iter();
        terms.fold(S::Vector::zero(), |sum, (node, weight)| {
            sum + vector::<S>(all, *node as usize) * *weight
        })
    }
}

/// The loaded points of a system. `column` gives the compliance of all nodes for an impulse on the
/// node at a place, see [`crate::bodies::Compliance`].
#[derive(Clone, Debug)]
pub(super) struct LoadedPoints<S: Space> {
    points: Vec<u32>,
    /// Index of each point of the system among the loaded ones, if it was loaded.
    index: Vec<u32>,
    /// Velocities of loaded points, one after the other (m/s).
    velocity: Vec<f64>,
    /// Compliance between loaded points, by columns, and in a column by axis of the impulse; a
    /// column is completed when an impulse needs it. Further columns are unused memory from earlier
    /// steps.
    blocks: Vec<[Vec<f64>; 3]>,
    /// Impulses since the velocities of all nodes were last computed (N s).
    since: Vec<S::Vector>,
    /// Buffer for the velocities of all nodes due to an impulse on a point.
    response: Vec<f64>,
}

impl<S: Space> LoadedPoints<S> {
    /// Creates a list without loaded points.
    pub fn new() -> Self {
        Self {
            points: Vec::new(),
            index: Vec::new(),
            velocity: Vec::new(),
            blocks: Vec::new(),
            since: Vec::new(),
            response: Vec::new(),
        }
    }

    /// Removes all loaded points, keeping the memory.
    pub fn clear(&mut self) {
        self.points.clear();
        self.index.clear();
        self.velocity.clear();
        self.since.clear();
    }

    /// Returns the current velocity of a point, if it is loaded (m/s).
    #[inline]
    pub fn velocity(&self, point: u32) -> Option<S::Vector> {
        match self.index.get(point as usize) {
            None | Some(&NONE) => None,
            Some(k) => Some(vector::<S>(&self.velocity, *k as usize)),
        }
    }

    /// Returns the index of a point among the loaded ones, to which it is added, and whether it was
    /// new.
    fn place(&mut self, point: u32) -> (usize, bool) {
        let at = point as usize;
        if self.index.len() <= at {
            self.index.resize(at + 1, NONE);
        }
        let joins = self.index[at] == NONE;
        if joins {
            let k = self.points.len();
            self.index[at] = k as u32;
            self.points.push(point);
            self.velocity.extend(std::iter::repeat_n(0.0, S::D));
            match self.blocks.get_mut(k) {
                Some(block) => block.iter_mut().for_each(Vec::clear),
                None => self.blocks.push(Default::default()),
            }
            self.since.push(S::Vector::zero());
        }
        (self.index[at] as usize, joins)
    }

    /// Adds an impulse (N s), whose velocities are found by [`Self::settle`].
    pub fn load(&mut self, point: u32, impulse: &S::Vector) {
        let (k, _) = self.place(point);
        self.since[k] += *impulse;
    }

    /// Adds an impulse (N s) and its effect on loaded points; `all` holds the velocities of all
    /// nodes at the last test (m/s).
    pub fn push<'a>(
        &mut self,
        point: u32,
        impulse: &S::Vector,
        points: &Points,
        all: &[f64],
        column: impl Fn(usize) -> &'a [f64],
    ) {
        let (k, joins) = self.place(point);
        if joins {
            let sum = points.sum::<S>(point, all);
            (0..S::D).for_each(|d| self.velocity[k * S::D + d] = sum[d]);
        }
        if joins || self.blocks[k][0].len() / S::D < self.points.len() {
            self.complete(k, joins, points, all.len(), column);
        }
        let blocks = &self.blocks[k];
        add_response::<S>(&mut self.velocity, |axis| &blocks[axis], impulse);
        self.since[k] += *impulse;
    }

    /// Completes the column of a loaded point. A new point also gets the velocity due to the
    /// impulses since the last test: since the compliance is symmetric, its response to an impulse
    /// on another point equals the response of that point to an impulse on it.
    fn complete<'a>(
        &mut self,
        k: usize,
        joins: bool,
        points: &Points,
        row: usize,
        column: impl Fn(usize) -> &'a [f64],
    ) {
        let point = self.points[k];
        for axis in 0..S::D {
            let of_node = |node: u32| &column(node as usize)[axis * row..][..row];
            let response = if let [(node, 1.0)] = points.terms(point) {
                of_node(*node)
            } else {
                self.response.clear();
                self.response.resize(row, 0.0);
                for (node, weight) in points.terms(point) {
                    let both = self.response.iter_mut().zip(of_node(*node));
                    both.for_each(|(sum, v)| *sum += v * weight);
                }
                &self.response
            };
            let block = &mut self.blocks[k][axis];
            let known = block.len() / S::D;
            // Reserves room for points that are loaded later.
            block.reserve((self.points.len() + SPARE - known) * S::D);
            for a in &self.points[known..] {
                let response = points.sum::<S>(*a, response);
                block.extend((0..S::D).map(|d| response[d]));
            }
            if joins {
                let pairs = block.chunks_exact(S::D).zip(&self.since);
                self.velocity[k * S::D + axis] += pairs.fold(0.0, |sum, (response, p)| {
                    sum + S::Vector::from_slice(response).dot(p)
                });
            }
        }
    }

    /// Computes the velocities of all nodes (m/s) from those at the last test and the impulses
    /// since.
    pub fn settle<'a>(
        &mut self,
        points: &Points,
        all: &mut [f64],
        column: impl Fn(usize) -> &'a [f64],
    ) {
        let row = all.len();
        let mut on_nodes = vec![S::Vector::zero(); row / S::D];
        for (point, impulse) in self.points.iter().zip(&self.since) {
            for (node, weight) in points.terms(*point) {
                on_nodes[*node as usize] += *impulse * *weight;
            }
        }
        for (node, impulse) in on_nodes.iter().enumerate() {
            if *impulse != S::Vector::zero() {
                let of = column(node);
                add_response::<S>(all, |axis| &of[axis * row..][..row], impulse);
            }
        }
        self.adopt(points, all);
    }

    /// Sets the velocities of all nodes (m/s), without impulses since.
    pub fn adopt(&mut self, points: &Points, all: &[f64]) {
        self.since.fill(S::Vector::zero());
        for (velocity, point) in self.velocity.chunks_exact_mut(S::D).zip(&self.points) {
            let sum = points.sum::<S>(*point, all);
            velocity
                .iter_mut()
                .enumerate()
                .for_each(|(k, v)| *v = sum[k]);
        }
    }
}

/// The velocity of the node at a place of a list.
#[inline]
pub(super) fn vector<S: Space>(all: &[f64], at: usize) -> S::Vector {
    S::Vector::from_slice(&all[at * S::D..][..S::D])
}

#[cfg(test)]
mod tests;
