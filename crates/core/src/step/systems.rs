//! Dynamical systems in the step: they move with the bodies, their contactors follow them, and their contacts are solved with
//! those of rigid bodies.

use super::{Simulation, StepError};
use crate::bodies::{DynamicalSystem, SystemStep};
use crate::contact::{Contact, detect};
use crate::energy::BodyWork;
use crate::geometry::shape::Ball;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::{ContactForm, NodalSystem, Side};

impl<S: Space> Simulation<S> {
    /// Adds a dynamical system to a scene that has not stepped, with a body and a ball for each contactor; gives its index. The
    /// bodies are [`crate::bodies::Systems::bodies`]: shapes other than balls may be added to them.
    ///
    /// Energy that it holds counts as work done on it before the start.
    pub fn add_system(&mut self, system: Box<dyn DynamicalSystem<S>>) -> usize {
        let (kinetic, stored) = (system.kinetic_energy(), system.stored_energy());
        let contactors = system.contactors();
        let index = self.systems.add(system, &mut self.bodies);
        for (contactor, body) in contactors.iter().zip(self.systems.bodies(index)) {
            if contactor.ball {
                self.shapes.balls.push(Ball {
                    body: *body,
                    radius: contactor.radius,
                    offset: S::Vector::zero(),
                    material: contactor.material,
                });
            }
        }
        self.network.fast = detect::fast_motion(&self.shapes, self.network.alert);
        self.network.forget_neighbours();
        self.energy.kinetic += kinetic;
        self.energy.initial_kinetic += kinetic;
        self.energy.elastic += stored;
        self.energy.external_work += stored;
        self.energy.see(kinetic);
        self.energy.see(stored);
        index
    }

    /// The step at hand, as systems are told of it.
    fn system_step(&self) -> SystemStep<S> {
        SystemStep {
            time: self.time,
            h: self.scheme.h,
            theta: self.scheme.theta,
            gravity: self.gravity,
        }
    }

    /// Takes all systems through the first part of a step (s).
    pub(super) fn begin_systems(&mut self, time: f64) {
        if self.systems.is_empty() {
            return;
        }
        let step = self.system_step();
        self.systems.begin_step(&step);
        self.systems.advance(time);
        self.systems.carry(&mut self.bodies);
    }

    /// The velocities of systems without contacts; those of their bodies into `free`.
    pub(super) fn free_systems(&mut self, free: &mut [(S::Vector, S::Spin)]) {
        if !self.systems.is_empty() {
            let step = self.system_step();
            self.systems.free_velocities(&step, free);
        }
    }

    /// Has all systems at the velocities that they began the step with, their bodies too.
    pub(super) fn restart_systems(&mut self) {
        if !self.systems.is_empty() {
            self.systems.restart();
            self.systems.carry(&mut self.bodies);
        }
    }

    /// Takes all systems through the last part of a step (s) and adds their work; gives their kinetic and stored energy.
    pub(super) fn end_systems(&mut self, time: f64, work: &mut BodyWork) -> (f64, f64) {
        if self.systems.is_empty() {
            return (0.0, 0.0);
        }
        self.systems.advance(time);
        let own = self.systems.work(&self.system_step());
        work.potential += own.potential;
        work.external += own.external;
        work.damping += own.damping;
        work.scheme += own.scheme;
        self.systems.energies()
    }

    /// The sides of a contact; none where both are rigid.
    fn sides(&self, form: &ContactForm<S>) -> Option<[Side<S>; 2]> {
        let carriers = form.bodies.map(|b| self.bodies.carrier(b as usize));
        if carriers == [None; 2] {
            return None;
        }
        Some(std::array::from_fn(|k| {
            let (body, arm) = (form.bodies[k], form.arms[k]);
            match carriers[k] {
                Some(carrier) => Side::Nodes {
                    system: carrier.system,
                    nodes: self.systems.contact_nodes(carrier, &arm),
                },
                None => Side::Rigid { body, arm },
            }
        }))
    }

    /// Hands systems, as far as contacts see them, and all contacts to the solver.
    pub(super) fn pose_with_systems(&mut self) {
        let sides: Vec<_> = self
            .workspace
            .forms
            .iter()
            .map(|form| self.sides(form))
            .collect();
        let mut touched: Vec<Vec<u32>> = vec![Vec::new(); self.systems.len()];
        for side in sides.iter().flatten().flatten() {
            if let Side::Nodes { system, nodes } = side {
                touched[*system as usize].extend(nodes.terms().map(|(node, _)| node));
            }
        }
        for (system, mut nodes) in touched.into_iter().enumerate() {
            nodes.sort_unstable();
            nodes.dedup();
            let of = |node: &u32| self.systems.free_velocity_of(system, *node);
            let free = nodes.iter().map(of).collect();
            let compliance = self.systems.compliance(system, &nodes);
            let nodal = NodalSystem::new(nodes, free, compliance);
            self.workspace.problem.push_system(nodal);
        }
        for (form, sides) in self.workspace.forms.iter().zip(&sides) {
            match sides {
                None => self.workspace.problem.push(form),
                Some(sides) => {
                    let known = self.workspace.problem.push_between(form, sides);
                    debug_assert!(known, "all nodes of the sides were pushed");
                }
            }
        }
    }

    /// Gives systems and their bodies the velocities that the solved impulses lead to.
    ///
    /// # Errors
    /// A velocity that is not finite.
    pub(super) fn adopt_system_velocities(&mut self) -> Result<(), StepError> {
        if self.systems.is_empty() {
            return Ok(());
        }
        for system in 0..self.systems.len() {
            let impulses = self.workspace.problem.node_impulses(system);
            self.systems.apply(system, impulses);
        }
        if let Some(name) = self.systems.not_finite() {
            return Err(StepError::SystemNotFinite {
                step: self.steps + 1,
                time: self.time,
                system: name.to_owned(),
            });
        }
        self.systems.carry(&mut self.bodies);
        Ok(())
    }

    /// Velocity of a side of a contact at the contact, at the velocities at hand (m/s).
    fn velocity_of_side(&self, contact: &Contact<S>, side: usize) -> S::Vector {
        let (b, arm) = (contact.bodies[side] as usize, &contact.arms[side]);
        match self.bodies.carrier(b) {
            Some(carrier) => self.systems.contact_velocity(carrier, arm),
            None => self.bodies.velocity[b] + S::spin_velocity(&self.bodies.spin[b], arm),
        }
    }

    /// Velocity of the candidate of a contact relative to its antagonist where systems may take part (m/s).
    pub(super) fn relative_velocity_of_sides(&self, contact: &Contact<S>) -> S::Vector {
        self.velocity_of_side(contact, 0) - self.velocity_of_side(contact, 1)
    }
}
