//! A contact with a dynamical system on at least one side: it is solved as a block, and its impulse
//! changes the velocities of all touched nodes of the system.

use super::block::Bonded;
use super::law::{LawLimits, RowLaw};
use super::solver_bodies::SolverBody;
use super::state::{Parts, RowState};
use crate::geometry::lane_space::{lanes_of, vector_of};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::lanes::{Batch, BatchMut};
use crate::solve::error::{Residual, Scale};
use crate::solve::form::{ContactForm, ContactSolution, Mobility};
use crate::solve::nodal::NodalSystem;

/// A node that a contact acts on, with its weight: positive on the side of the candidate.
#[derive(Clone, Copy, Debug)]
pub(in crate::solve) struct Term {
    pub system: u32,
    /// Index of the node in the list of the system.
    pub node: u32,
    pub weight: f64,
}

/// The rigid body of a side.
#[derive(Clone, Debug)]
struct RigidSide<S: Space> {
    body: u32,
    /// Arm divided by the length of the body.
    arm: S::Vector,
    inverse_mass: S::Vector,
    /// Inverse inertia times the length squared (1/kg).
    inverse_spin: S::Tensor,
}

/// A contact with a dynamical system on at least one side.
#[derive(Clone, Debug)]
pub(in crate::solve) struct SystemRow<S: Space> {
    rigid: [Option<RigidSide<S>>; 2],
    /// For each side with a system: index of the system, index of its point, and 1 for the
    /// candidate or -1 for the antagonist.
    points: [Option<(u32, u32, f64)>; 2],
    /// Nodes on which the contact acts.
    terms: Vec<Term>,
    /// W_cc in world axes (1/kg).
    block: S::Matrix,
    state: RowState<S>,
    law: Bonded<S>,
}

/// Body, arm (m), mobility and length (m) of a rigid side.
type RigidData<'a, S> = (u32, <S as Space>::Vector, &'a Mobility<S>, f64);

impl<S: Space> SystemRow<S> {
    pub fn new(
        contact: &ContactForm<S>,
        block: S::Matrix,
        rigid: [Option<RigidData<S>>; 2],
        points: [Option<(u32, u32, f64)>; 2],
        terms: Vec<Term>,
    ) -> Self {
        let rigid = rigid.map(|side| {
            let (body, arm, mobility, length) = side?;
            Some(RigidSide {
                body,
                arm: arm * (1.0 / length),
                inverse_mass: mobility.mass,
                inverse_spin: mobility.inertia.scaled(length).scaled(length),
            })
        });
        Self {
            rigid,
            points,
            terms,
            state: RowState::new(&contact.normal, &contact.impulse),
            law: Bonded::of(contact, &block),
            block,
        }
    }

    /// The rigid sides, with 1 for the candidate's and -1 for the antagonist's.
    fn rigid_sides(&self) -> impl Iterator<Item = (&RigidSide<S>, f64)> {
        let signed = self.rigid.iter().zip([1.0, -1.0]);
        signed.filter_map(|(side, sign)| Some((side.as_ref()?, sign)))
    }

    /// Returns the relative velocity of the contact (m/s).
    pub fn relative(
        &self,
        solver_bodies: &[SolverBody<S>],
        systems: &[NodalSystem<S>],
    ) -> S::Vector {
        let mut u = S::Vector::zero();
        for (side, sign) in self.rigid_sides() {
            let body = &solver_bodies[side.body as usize];
            u += (body.v + S::spin_velocity(&body.s, &side.arm)) * sign;
        }
        for (system, point, sign) in self.points.iter().flatten() {
            u += systems[*system as usize].velocity(*point) * *sign;
        }
        u
    }

    /// Returns the relative velocity along and across the normal (m/s).
    fn parts(&self, solver_bodies: &[SolverBody<S>], systems: &[NodalSystem<S>]) -> Parts<S> {
        let u = self.relative(solver_bodies, systems);
        Parts::of(&self.state.n, &lanes_of(&u))
    }

    fn limits(&self) -> LawLimits<S> {
        Bonded::limits(Batch::one(&self.law))
    }

    /// Adds the effect of an impulse to the velocities of bodies, and passes system, point and
    /// impulse to `on_point`.
    fn push(
        &self,
        p: &S::Vector,
        solver_bodies: &mut [SolverBody<S>],
        mut on_point: impl FnMut(u32, u32, &S::Vector),
    ) {
        if *p == S::Vector::zero() {
            return;
        }
        for (side, sign) in self.rigid_sides() {
            let body = &mut solver_bodies[side.body as usize];
            let p = *p * sign;
            body.v += p.scaled_by(&side.inverse_mass);
            body.s += side.inverse_spin.apply(&S::moment(&side.arm, &p));
        }
        for (system, point, sign) in self.points.iter().flatten() {
            on_point(*system, *point, &(*p * *sign));
        }
    }

    /// Solves the contact for the current velocities, applies `relaxation` times the change, and
    /// updates the velocities.
    pub fn update(
        &mut self,
        solver_bodies: &mut [SolverBody<S>],
        systems: &mut [NodalSystem<S>],
        relaxation: f64,
    ) {
        let u = self.parts(solver_bodies, systems);
        let law = BatchMut::one(&mut self.law);
        let change = Bonded::solve(law, &mut self.state, u, relaxation);
        let change = vector_of(&change.joined(&self.state.n));
        self.push(&change, solver_bodies, |system, point, p| {
            systems[system as usize].push(point, p);
        });
    }

    /// Adds the effect of the stored impulse to the velocities; velocities of nodes are valid once
    /// their systems are settled.
    pub fn load(&self, solver_bodies: &mut [SolverBody<S>], systems: &mut [NodalSystem<S>]) {
        let impulse = self.state.impulse();
        self.push(&impulse, solver_bodies, |system, point, p| {
            systems[system as usize].load(point, p);
        });
    }

    /// Adds the impulse to the impulses on the nodes of the systems, by system.
    pub fn add_impulses(&self, impulses: &mut [Vec<S::Vector>]) {
        for term in &self.terms {
            impulses[term.system as usize][term.node as usize] +=
                self.state.impulse() * term.weight;
        }
    }

    /// Returns rho of the natural map, see [`LawLimits::rho`].
    pub fn rho(&self) -> f64 {
        self.limits().rho
    }

    /// Returns the nodes on which the contact acts.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// Returns the systems on which the contact acts.
    pub fn systems(&self) -> impl Iterator<Item = u32> {
        self.points.iter().flatten().map(|(system, _, _)| *system)
    }

    /// Returns the rigid bodies of the contact, with the smallest inverse mass of each along an
    /// axis (1/kg).
    pub fn rigid_masses(&self) -> impl Iterator<Item = (u32, f64)> {
        self.rigid_sides().map(|(side, _)| {
            let along = (0..S::D).map(|k| side.inverse_mass[k]);
            (side.body, along.fold(f64::INFINITY, f64::min))
        })
    }

    /// Returns the compliance of the law plus that of the sides, which is given as `sides` (1/kg);
    /// at most that of the natural map.
    pub fn compliance_beside(&self, sides: f64) -> f64 {
        let limits = self.limits();
        if limits.rho <= 0.0 {
            return 0.0;
        }
        (sides + limits.compliance[0]).min(1.0 / limits.rho)
    }

    /// Whether a side is a rigid body, by side.
    pub fn is_rigid(&self) -> [bool; 2] {
        std::array::from_fn(|side| self.rigid[side].is_some())
    }

    /// Returns W_cc in world axes (1/kg).
    pub fn block(&self) -> &S::Matrix {
        &self.block
    }

    /// Returns whether a bond may act on the contact.
    pub fn is_bonded(&self) -> bool {
        self.law.is_bonded()
    }

    /// The normal and the tangential impulse.
    pub fn impulse(&self) -> Parts<S> {
        self.state.p
    }

    /// Sets the impulse; the caller updates the velocities.
    pub fn set_impulse(&mut self, parts: Parts<S>) {
        self.state.p = parts;
    }

    /// Sets an impulse given in world axes; the caller updates the velocities.
    pub fn set(&mut self, impulse: &S::Vector) {
        self.state.set(impulse);
    }

    pub fn residual(
        &self,
        solver_bodies: &[SolverBody<S>],
        systems: &[NodalSystem<S>],
    ) -> Residual {
        let u = self.parts(solver_bodies, systems);
        Bonded::residual(Batch::one(&self.law), &self.state, &u)
    }

    /// The work on the compliance of the unilateral part, c |p|^2 (J).
    pub fn work_on_compliance(
        &self,
        solver_bodies: &[SolverBody<S>],
        systems: &[NodalSystem<S>],
    ) -> f64 {
        let u = self.parts(solver_bodies, systems);
        self.law.work_on_compliance(&self.state, &u)
    }

    pub fn solution(
        &self,
        solver_bodies: &[SolverBody<S>],
        systems: &[NodalSystem<S>],
    ) -> ContactSolution<S> {
        let u = self.parts(solver_bodies, systems);
        self.law.solution(&self.state, &u)
    }

    /// Returns the scales of the error from the free velocities, which must be the current ones.
    pub fn scale(&self, solver_bodies: &[SolverBody<S>], systems: &[NodalSystem<S>]) -> Scale {
        let u = self.relative(solver_bodies, systems);
        let speed = u.dot(&u);
        let rigid = self.rigid_sides().map(|(side, _)| {
            let body = &solver_bodies[side.body as usize];
            body.v.dot(&body.v) + body.s.dot(&body.s)
        });
        let points = self.points.iter().flatten().map(|(system, point, _)| {
            let v = systems[*system as usize].velocity(*point);
            v.dot(&v)
        });
        let own: f64 = rigid.chain(points).sum();
        Scale {
            free: speed,
            energy: self.limits().rho * speed,
            noise: super::visit::noise(own, self.limits().mu),
            ..Scale::default()
        }
    }
}
