//! The points of a large system that carry impulses.
//!
//! An impulse on a node changes the velocities of all nodes of its system, and its column of the compliance would be read from memory in
//! each update of a contact. Contacts act on points, weighted sums of nodes. Between two tests of convergence sweeps update the velocities of
//! loaded points alone, by blocks of their own compliance that fit in a cache; those of the others stay as they were at the last test, and are
//! found exactly where a point is loaded for the first time and for all nodes at the next test.

use crate::geometry::space::{Space, VectorLike};
use pulp::Arch;

/// Of a point that is not loaded.
const NONE: u32 = u32::MAX;

/// Points for which columns have place beyond those that are loaded when they are found.
const SPARE: usize = 16;

/// Adds what an impulse does to velocities: `rows` has one row for each axis of the impulse (1/kg), `velocities` are those of nodes one after
/// the other (m/s).
pub(super) fn add_response<'a, S: Space>(
    velocities: &mut [f64],
    rows: impl Fn(usize) -> &'a [f64],
    impulse: &S::Vector,
) {
    let ([a, b], [p, q]) = ([rows(0), rows(1)], [impulse[0], impulse[1]]);
    // Compiled for wide registers where the processor has them; products and sums are rounded one by one all the same.
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

/// Weighted sums of the nodes of a system, told by their index: first each node alone, then those that are added.
#[derive(Clone, Debug)]
pub(super) struct Points {
    /// Where the terms of each point end.
    ends: Vec<u32>,
    /// Places of nodes with their weights, point by point.
    terms: Vec<(u32, f64)>,
}

impl Points {
    /// A number of nodes.
    pub fn new(nodes: usize) -> Self {
        let nodes = nodes as u32;
        Self {
            ends: (1..=nodes).collect(),
            terms: (0..nodes).map(|node| (node, 1.0)).collect(),
        }
    }

    /// Adds a point; gives its index.
    pub fn add(&mut self, terms: &[(u32, f64)]) -> u32 {
        if let [(node, 1.0)] = terms {
            return *node;
        }
        self.terms.extend_from_slice(terms);
        self.ends.push(self.terms.len() as u32);
        self.ends.len() as u32 - 1
    }

    /// The terms of a point.
    #[inline]
    pub fn terms(&self, point: u32) -> &[(u32, f64)] {
        let k = point as usize;
        let from = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.terms[from as usize..self.ends[k] as usize]
    }

    /// The sum of vectors that are given for nodes, one after the other.
    #[inline]
    pub fn sum<S: Space>(&self, point: u32, all: &[f64]) -> S::Vector {
        let terms = self.terms(point).iter();
        terms.fold(S::Vector::zero(), |sum, (node, weight)| {
            sum + vector::<S>(all, *node as usize) * *weight
        })
    }
}

/// See the module. `column` gives the compliance of all nodes for an impulse on the node at a place, see [`crate::bodies::Compliance`].
#[derive(Clone, Debug)]
pub(super) struct Loaded<S: Space> {
    points: Vec<u32>,
    /// The place of each point of the system among the loaded ones, as far as one was loaded.
    index: Vec<u32>,
    /// Velocities of loaded points, one after the other (m/s).
    velocity: Vec<f64>,
    /// Compliance between loaded points, column by column and in it by axis of the impulse; a column is completed when an impulse needs it.
    blocks: Vec<[Vec<f64>; 3]>,
    /// Impulses since the velocities of all nodes were found (N s).
    since: Vec<S::Vector>,
    /// Velocities of all nodes for an impulse on a point, kept for its memory.
    response: Vec<f64>,
}

impl<S: Space> Loaded<S> {
    /// No loaded point.
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

    /// The current velocity of a point, if it is loaded (m/s).
    #[inline]
    pub fn velocity(&self, point: u32) -> Option<S::Vector> {
        match self.index.get(point as usize) {
            None | Some(&NONE) => None,
            Some(k) => Some(vector::<S>(&self.velocity, *k as usize)),
        }
    }

    /// The place of a point among the loaded ones, which it joins with a velocity (m/s).
    fn place(&mut self, point: u32, velocity: impl FnOnce(&Self) -> S::Vector) -> usize {
        let at = point as usize;
        if self.index.len() <= at {
            self.index.resize(at + 1, NONE);
        }
        if self.index[at] == NONE {
            let velocity = velocity(self);
            self.index[at] = self.points.len() as u32;
            self.points.push(point);
            self.velocity.extend((0..S::D).map(|k| velocity[k]));
            self.blocks.push(Default::default());
            self.since.push(S::Vector::zero());
        }
        self.index[at] as usize
    }

    /// Adds an impulse (N s), whose velocities are found by [`Self::settle`].
    pub fn load(&mut self, point: u32, impulse: &S::Vector) {
        let k = self.place(point, |_| S::Vector::zero());
        self.since[k] += *impulse;
    }

    /// Adds an impulse (N s) and what it does to loaded points; `all` are the velocities of all nodes at the last test (m/s).
    pub fn push<'a>(
        &mut self,
        point: u32,
        impulse: &S::Vector,
        points: &Points,
        all: &[f64],
        column: impl Fn(usize) -> &'a [f64],
    ) {
        let row = all.len();
        let k = self.place(point, |loaded| {
            let mut velocity = points.sum::<S>(point, all);
            for (b, p) in loaded.points.iter().zip(&loaded.since) {
                for (node, weight) in points.terms(*b) {
                    let of = column(*node as usize);
                    for axis in 0..S::D {
                        let response = points.sum::<S>(point, &of[axis * row..][..row]);
                        velocity += response * (p[axis] * weight);
                    }
                }
            }
            velocity
        });
        let known = self.blocks[k][0].len() / S::D;
        if known < self.points.len() {
            for (axis, block) in self.blocks[k].iter_mut().enumerate().take(S::D) {
                // With place for points that are loaded later.
                let needed = (self.points.len() + SPARE) * S::D;
                block.reserve(needed - block.len());
                let of_node = |node: u32| &column(node as usize)[axis * row..][..row];
                self.response.clear();
                for (node, weight) in points.terms(point) {
                    if self.response.is_empty() {
                        let first = of_node(*node).iter().map(|v| v * weight);
                        self.response.extend(first);
                    } else {
                        let both = self.response.iter_mut().zip(of_node(*node));
                        both.for_each(|(sum, v)| *sum += v * weight);
                    }
                }
                for a in &self.points[known..] {
                    let response = points.sum::<S>(*a, &self.response);
                    block.extend((0..S::D).map(|d| response[d]));
                }
            }
        }
        let blocks = &self.blocks[k];
        add_response::<S>(&mut self.velocity, |axis| &blocks[axis], impulse);
        self.since[k] += *impulse;
    }

    /// Finds the velocities of all nodes (m/s) from those at the last test and the impulses since.
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

    /// Takes the velocities of all nodes (m/s), with no impulse since.
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
mod tests {
    use crate::geometry::space::{Dim3, VectorLike};
    use crate::solve::NodalSystem;
    use nalgebra::{Matrix3, Vector3};

    /// Impulses on nodes of a large system, of which new ones are loaded between two tests and after one: the velocities of loaded nodes
    /// are at all times those of the whole product, and those of all nodes once they are asked for.
    #[test]
    fn loaded_nodes_move_as_with_the_whole_compliance() {
        let count = 90usize;
        let block = |a: usize, b: usize| {
            let far = 1.0 + (a as f64 - b as f64).abs();
            let shear = 0.1 * (a as f64 - b as f64) / far;
            Matrix3::new(2.0, shear, 0.1, -shear, 3.0, 0.2, 0.1, 0.2, 1.0) / far
        };
        let free = |a: usize| Vector3::new((a as f64).sin(), 1.0, -0.5);
        let rows: Vec<_> = (0..count * count)
            .map(|k| block(k / count, k % count))
            .collect();
        let nodes = (0..count as u32).collect();
        let mut system = NodalSystem::<Dim3>::new(nodes, (0..count).map(free).collect(), &rows);
        let mut impulses = vec![Vector3::zeros(); count];
        let expected = |impulses: &[Vector3<f64>], a: usize| {
            let pairs = impulses.iter().enumerate();
            pairs.fold(free(a), |sum, (b, p)| sum + block(a, b) * p)
        };
        let impulse = |k: usize| Vector3::new(1.0, (k as f64).cos(), 0.3 * k as f64);
        for k in 0..5 {
            impulses[7 * k] += impulse(k);
            system.load(7 * k as u32, &impulse(k));
        }
        system.settle();
        for round in 0..3 {
            for k in 0..12 {
                let at = (5 * k + 11 * round) % count;
                impulses[at] += impulse(k);
                system.push(at as u32, &impulse(k));
                let loaded = (0..count).filter(|a| impulses[*a] != Vector3::zero());
                for a in loaded {
                    let off = system.velocity(a as u32) - expected(&impulses, a);
                    assert!(off.norm() < 1e-12, "{round} {k} {a}: {off}");
                }
            }
            let stale = (0..count).filter(|a| impulses[*a] == Vector3::zero());
            let off = |a: usize| (system.velocity(a as u32) - expected(&impulses, a)).norm();
            assert!(stale.clone().map(off).fold(0.0, f64::max) > 0.1);
            system.settle();
            for a in 0..count {
                let off = system.velocity(a as u32) - expected(&impulses, a);
                assert!(off.norm() < 1e-12, "{round} {a}: {off}");
            }
        }
    }
}
