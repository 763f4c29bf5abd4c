//! W of a step, applied matrix-free from its bodies and dynamical systems, and assembled only when
//! a method needs the matrix.
//!
//! A side that is a dynamical system acts on nodes: its body, which represents a contactor, has no
//! inertia and no velocity here.

use super::pattern::Neighbours;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::Mobility;
use crate::solve::local::block::{Block, BlockMatrix};
use crate::solve::local::factored;
use crate::solve::local::factored::{Shift, Shifted};
use crate::solve::local::form::Delassus;
use crate::solve::nodal::NodalSystem;
use crate::solve::row::{Term, turning};
use std::cell::{OnceCell, RefCell};

/// Direction of one component of a block.
#[derive(Clone, Copy, Debug)]
pub struct Axis<S: Space> {
    /// Linear impulse per unit of the component.
    pub linear: S::Vector,
    /// Moments about the two bodies per unit.
    pub angular: [S::Spin; 2],
    /// 1/B of a bond; 1 for an absent component.
    pub compliance: f64,
}

impl<S: Space> Axis<S> {
    /// Returns whether the component is present.
    pub fn pushes(&self) -> bool {
        self.linear != S::Vector::zero() || self.angular != [S::Spin::zero(); 2]
    }

    /// Returns the component with the compliance of a bond of stiffness `b` over the step; absent
    /// for zero stiffness.
    pub fn bonded(&self, b: f64) -> Self {
        if b > 0.0 {
            Self {
                compliance: 1.0 / b,
                ..*self
            }
        } else {
            Self {
                linear: S::Vector::zero(),
                angular: [S::Spin::zero(); 2],
                compliance: 1.0,
            }
        }
    }
}

/// A block of unknowns.
#[derive(Clone, Debug)]
pub struct Unknown<'a, S: Space, const D: usize> {
    /// Bodies on which the components act, with opposite signs.
    pub bodies: [u32; 2],
    /// Nodes of dynamical systems on which the components act, with their signs; empty between
    /// rigid bodies.
    pub nodes: &'a [Term],
    /// One axis per component.
    pub axes: [Axis<S>; D],
    /// Whether the block is a moment, which acts on nodes that represent rotation.
    pub turns: bool,
}

impl<S: Space, const D: usize> Unknown<'_, S, D> {
    /// The impulse on a node of weight 1 per unit of a component.
    fn on_node(&self, component: usize) -> S::Vector {
        let axis = &self.axes[component];
        match self.turns {
            true => turning::<S>(&axis.angular[0]),
            false => axis.linear,
        }
    }
}

/// Impulse and moment of a body, or its velocity and spin.
pub type LinearAngular<S> = (<S as Space>::Vector, <S as Space>::Spin);

/// Impulses on all bodies and on the nodes of all systems, or their velocities.
#[derive(Clone, Debug)]
pub struct Motions<S: Space> {
    /// Impulse or velocity by body.
    pub bodies: Vec<LinearAngular<S>>,
    /// Impulses or velocities by system, in the order of its nodes.
    pub nodes: Vec<Vec<S::Vector>>,
}

impl<S: Space> Motions<S> {
    /// Sets the velocities of as many bodies and nodes to zero.
    fn rest(&mut self, bodies: usize, systems: &[NodalSystem<S>]) {
        self.bodies.clear();
        self.bodies
            .resize(bodies, (S::Vector::zero(), S::Spin::zero()));
        self.nodes.resize(systems.len(), Vec::new());
        for (nodes, system) in self.nodes.iter_mut().zip(systems) {
            nodes.clear();
            nodes.resize(system.nodes.len(), S::Vector::zero());
        }
    }
}

/// W of a step, computed from its bodies and systems.
pub struct BodyOperator<'a, S: Space, const D: usize> {
    /// Responses of the bodies to impulses.
    pub masses: &'a [Mobility<S>],
    /// Nodes of the dynamical systems on which contacts act.
    pub systems: &'a [NodalSystem<S>],
    /// The blocks.
    pub unknowns: Vec<Unknown<'a, S, D>>,
    /// W_cc of every block; set once all unknowns are present.
    pub diagonal: Vec<Block<D>>,
    scratch: RefCell<Motions<S>>,
    matrix: OnceCell<BlockMatrix<D>>,
    pattern: OnceCell<Neighbours>,
}

impl<'a, S: Space, const D: usize> BodyOperator<'a, S, D> {
    /// Creates an operator for bodies with these inverse masses and inertias and for systems,
    /// without unknowns.
    pub fn new(masses: &'a [Mobility<S>], systems: &'a [NodalSystem<S>]) -> Self {
        Self {
            masses,
            systems,
            unknowns: Vec::new(),
            diagonal: Vec::new(),
            scratch: RefCell::new(Motions {
                bodies: Vec::new(),
                nodes: Vec::new(),
            }),
            matrix: OnceCell::new(),
            pattern: OnceCell::new(),
        }
    }

    /// Returns the pairs of bodies in contact.
    pub(super) fn pattern(&self) -> &Neighbours {
        let pairs = self.unknowns.iter().map(|unknown| unknown.bodies);
        self.pattern
            .get_or_init(|| Neighbours::new(self.masses, pairs))
    }

    /// Returns M^-1 of an impulse and moment on a body.
    pub fn mobility(&self, body: u32, (p, m): LinearAngular<S>) -> LinearAngular<S> {
        self.masses[body as usize].apply(&p, &m)
    }

    /// Adds the velocities due to the impulses of a block to its bodies, and its impulses on nodes
    /// to those of the systems.
    pub fn push(&self, c: usize, p: &[f64; D], motions: &mut Motions<S>) {
        let unknown = &self.unknowns[c];
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let mut impulse = S::Vector::zero();
            let mut moment = S::Spin::zero();
            for (axis, p) in unknown.axes.iter().zip(p) {
                impulse += axis.linear * (sign * p);
                moment += axis.angular[side] * (sign * p);
            }
            let body = unknown.bodies[side];
            let (v, w) = self.mobility(body, (impulse, moment));
            let motion = &mut motions.bodies[body as usize];
            motion.0 += v;
            motion.1 += w;
        }
        for term in unknown.nodes {
            let components = p.iter().enumerate();
            let impulse = components.fold(S::Vector::zero(), |sum, (k, p)| {
                sum + unknown.on_node(k) * *p
            });
            motions.nodes[term.system as usize][term.node as usize] += impulse * term.weight;
        }
    }

    /// Replaces impulses on the nodes of all systems by the resulting velocities.
    pub fn respond(&self, nodes: &mut [Vec<S::Vector>]) {
        for (system, nodes) in self.systems.iter().zip(nodes) {
            *nodes = system.response(nodes);
        }
    }

    /// Returns the velocities of a block, without its compliance.
    pub fn relative(&self, c: usize, motions: &Motions<S>) -> [f64; D] {
        let unknown = &self.unknowns[c];
        let [a, b] = unknown.bodies.map(|b| &motions.bodies[b as usize]);
        let mut u: [f64; D] = std::array::from_fn(|k| {
            let axis = &unknown.axes[k];
            axis.linear.dot(&a.0) + axis.angular[0].dot(&a.1)
                - axis.linear.dot(&b.0)
                - axis.angular[1].dot(&b.1)
        });
        for term in unknown.nodes {
            let v = motions.nodes[term.system as usize][term.node as usize] * term.weight;
            for (k, u) in u.iter_mut().enumerate() {
                *u += unknown.on_node(k).dot(&v);
            }
        }
        u
    }

    /// Computes the block W_cd.
    pub fn coupling(&self, c: usize, d: usize) -> Block<D> {
        let (x, y) = (&self.unknowns[c], &self.unknowns[d]);
        let mut out = [[0.0; D]; D];
        for (i, sign_i) in [(0, 1.0), (1, -1.0)] {
            for (j, sign_j) in [(0, 1.0), (1, -1.0)] {
                if x.bodies[i] != y.bodies[j] {
                    continue;
                }
                for (l, axis) in y.axes.iter().enumerate() {
                    let motion = self.mobility(y.bodies[j], (axis.linear, axis.angular[j]));
                    for (k, own) in x.axes.iter().enumerate() {
                        out[k][l] += sign_i
                            * sign_j
                            * (own.linear.dot(&motion.0) + own.angular[i].dot(&motion.1));
                    }
                }
            }
        }
        for a in x.nodes {
            for b in y.nodes.iter().filter(|b| b.system == a.system) {
                let block = self.systems[a.system as usize].block(a.node, b.node);
                for l in 0..D {
                    let v = block.apply(&y.on_node(l)) * (a.weight * b.weight);
                    for (k, row) in out.iter_mut().enumerate() {
                        row[l] += x.on_node(k).dot(&v);
                    }
                }
            }
        }
        if c == d {
            for (k, axis) in x.axes.iter().enumerate() {
                out[k][k] += axis.compliance;
            }
        }
        out
    }

    /// Returns W as a matrix, assembled at the first call.
    pub fn assembled(&self) -> &BlockMatrix<D> {
        self.matrix.get_or_init(|| {
            let mut of_body: Vec<Vec<u32>> = vec![Vec::new(); self.masses.len()];
            for (c, unknown) in self.unknowns.iter().enumerate() {
                for body in unknown.bodies {
                    of_body[body as usize].push(c as u32);
                }
            }
            let mut of_system: Vec<Vec<u32>> = vec![Vec::new(); self.systems.len()];
            for (c, unknown) in self.unknowns.iter().enumerate() {
                for term in unknown.nodes {
                    of_system[term.system as usize].push(c as u32);
                }
            }
            of_system.iter_mut().for_each(Vec::dedup);
            let moves = |b: u32| self.masses[b as usize].moves();
            let mut out = BlockMatrix::new(self.diagonal.clone());
            for (c, unknown) in self.unknowns.iter().enumerate() {
                let mut near: Vec<u32> = unknown
                    .bodies
                    .iter()
                    .filter(|b| moves(**b))
                    .flat_map(|b| of_body[*b as usize].iter().copied())
                    .collect();
                let mut systems: Vec<u32> = unknown.nodes.iter().map(|t| t.system).collect();
                systems.dedup();
                for system in systems {
                    near.extend_from_slice(&of_system[system as usize]);
                }
                near.retain(|d| *d as usize != c);
                near.sort_unstable();
                near.dedup();
                for d in near {
                    out.push(d as usize, &self.coupling(c, d as usize));
                }
                out.end_row();
            }
            out
        })
    }
}

impl<S: Space, const D: usize> Delassus<D> for BodyOperator<'_, S, D> {
    fn len(&self) -> usize {
        self.unknowns.len()
    }

    fn diagonal(&self, c: usize) -> &Block<D> {
        &self.diagonal[c]
    }

    fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]) {
        let mut motions = self.scratch.borrow_mut();
        motions.rest(self.masses.len(), self.systems);
        for (c, p) in p.iter().enumerate() {
            self.push(c, p, &mut motions);
        }
        self.respond(&mut motions.nodes);
        for (c, u) in u.iter_mut().enumerate() {
            *u = self.relative(c, &motions);
            for k in 0..D {
                u[k] += q[c][k] + self.unknowns[c].axes[k].compliance * p[c][k];
            }
        }
    }

    fn shifted(&self, shift: &Shift<D>) -> Option<Box<dyn Shifted<D> + '_>> {
        // With more motions than impulses the form in body motions has no advantage and adds
        // rounding errors; it does not know the masses of systems.
        if self.systems.is_empty() && self.pattern().rows() < D * self.len() {
            self.factor(shift)
        } else {
            factored::factor(self.assembled(), shift)
        }
    }

    fn matrix(&self) -> Option<&BlockMatrix<D>> {
        Some(self.assembled())
    }
}
