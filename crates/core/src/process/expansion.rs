//! Thermal expansion in the step: surfaces that move relative to their bodies, and the work of this
//! motion.
//!
//! Over a step a body b that expands has a rate of strain e_b = (lambda'/lambda - 1)/h, with the
//! sizes lambda and lambda' at the start and at the end of the step. Its surface at an arm r from
//! its centre moves by e_b r relative to it, so that at a contact
//!
//! ```text
//! u_surface = u_bodies + w,   w = e_i r_i - e_j r_j
//! ```
//!
//! Contacts do the work sum p.u_bodies on bodies and receive sum p.u_surface (see
//! `step::surfaces`): the difference, -sum p.w, is the work of the expansion. It is an entry of the
//! energy ledger, and is subtracted from the heat of the body that expands.
//!
//! For a body of finite elements, the free strain is set from the temperatures at the start of the
//! step; the resulting increase of the stored energy is the work of the expansion.

use super::heat::has_begun;
use super::{Process, ProcessError};
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::expansion::free_strain;
use crate::heat::{ExpandingSystem, Expansion, Heat};
use crate::step::{Simulation, StepReport};
use std::sync::Arc;

/// Fraction of the skin of the neighbour list by which bodies may grow before the list is rebuilt.
const GROWTH: f64 = 0.25;

/// Bodies that change their size with their temperature.
#[derive(Debug)]
pub struct ThermalExpansion<S: Space> {
    expansion: Expansion<S>,
    heat: Arc<Heat>,
    /// Stretch lambda of each body at the end of the step.
    stretch: Vec<f64>,
    /// Rate of strain of each body in the step (1/s).
    rate: Vec<f64>,
}

impl<S: Space> ThermalExpansion<S> {
    /// Lets rigid bodies with these coefficients of linear expansion (1/K), and bodies of finite
    /// elements, expand relative to their current temperatures. Without heat, which must be added
    /// before, nothing expands.
    pub fn add_to(s: &mut Simulation<S>, coefficient: Vec<f64>, systems: Vec<ExpandingSystem>) {
        let Some(heat) = s.heat.clone() else {
            return;
        };
        let all = 0..s.state.bodies.len();
        let reference = all.map(|b| s.temperature(b).unwrap_or_default());
        let reference: Vec<f64> = reference.collect();
        if let Some(state) = &mut s.state.heat {
            state.stretch = vec![1.0; coefficient.len()];
            if !systems.is_empty() {
                state.expanded = state.nodes.iter().map(|n| n.temperature).collect();
                for system in &systems {
                    state.expanded[system.nodes.clone()].fill(system.reference);
                }
            }
        }
        let lengths = &s.state.bodies.length;
        let expansion = Expansion::new(coefficient, reference, systems, &s.shapes, lengths);
        s.add_feature(Self {
            expansion,
            heat,
            stretch: Vec::new(),
            rate: Vec::new(),
        });
    }

    /// Returns the expansion of a simulation; `None` if no body expands.
    pub fn of(s: &Simulation<S>) -> Option<&Expansion<S>> {
        Some(&s.process::<Self>()?.expansion)
    }

    /// Returns the velocities of the surfaces of a contact relative to their bodies (m/s): along
    /// its normal for balls that are bodies of their own.
    fn surface_velocities(&self, s: &Simulation<S>, contact: &Contact<S>) -> [S::Vector; 2] {
        std::array::from_fn(|side| {
            let body = contact.bodies[side] as usize;
            let rate = self.rate[body];
            if rate == 0.0 {
                return S::Vector::zero();
            }
            let arm = contact.arms[side];
            if !contact.central {
                return arm * rate;
            }
            let along = contact.normal * contact.normal.dot(&arm);
            // For a body that cannot move, the arm of a ball is from the centre of the ball.
            let offset = match [contact.key.ball(), contact.key.antagonist_ball()][side] {
                Some(ball) => s.shapes.balls[ball].offset,
                None => S::Vector::zero(),
            };
            (S::rotate(&s.state.bodies.rotation[body], &offset) + along) * rate
        })
    }

    /// Computes the expansion of rigid bodies in the step: to the size at the temperature at its
    /// start, or, where a step of the heat spans several of the mechanics, by an equal part in
    /// each.
    fn find_rates(&mut self, s: &Simulation<S>) {
        let Some(state) = &s.state.heat else { return };
        let parts = state.parts(self.heat.every);
        let h = s.options.scheme.h;
        self.stretch.clone_from(&state.stretch);
        self.rate.clear();
        for (body, stretch) in self.stretch.iter_mut().enumerate() {
            if self.expansion.coefficient[body] == 0.0 {
                self.rate.push(0.0);
                continue;
            }
            let before = *stretch;
            if let Some(node) = self.heat.nodes[body].range().next() {
                let goal = self.expansion.stretch(body, state.nodes[node].temperature);
                *stretch += (goal - before) / parts;
            }
            self.rate.push((*stretch / before - 1.0) / h);
        }
    }

    /// Subtracts the work of rigid bodies from their heat; returns the total (J).
    fn take_work_of_bodies(&self, s: &mut Simulation<S>) -> f64 {
        let Some(state) = &mut s.state.heat else {
            return 0.0;
        };
        let mut all = 0.0;
        let surfaces = s.workspace.surfaces.velocities.iter();
        let contacts = s.state.network.contacts.iter().zip(surfaces);
        let steps = &s.workspace.solved.contact_steps;
        for ((contact, velocities), step) in contacts.zip(steps) {
            let impulse = &step.solution.impulse;
            if *impulse == S::Vector::zero() {
                continue;
            }
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let work = sign * impulse.dot(&velocities[side]);
                if work == 0.0 {
                    continue;
                }
                all += work;
                let nodes = &self.heat.nodes[contact.bodies[side] as usize];
                if let Some(node) = nodes.range().next() {
                    state.take_expansion_work(node, work);
                }
            }
        }
        all
    }

    /// Subtracts the work of bodies of finite elements from their heat.
    fn take_work_of_systems(&self, s: &mut Simulation<S>) {
        let Some(state) = &mut s.state.heat else {
            return;
        };
        for system in &self.expansion.systems {
            let found = s.state.systems.get(system.system);
            let work = found.map_or(&[][..], |s| s.expansion_work());
            for (point, work) in work.iter().enumerate().filter(|(_, work)| **work != 0.0) {
                // A single node has the temperature of all points.
                let node = (system.nodes.start + point).min(system.nodes.end - 1);
                state.take_expansion_work(node, *work);
            }
        }
    }
}

impl<S: Space> Process<S> for ThermalExpansion<S> {
    fn name(&self) -> &str {
        "thermal expansion"
    }

    /// Sets the free strain of bodies of finite elements for the step: that of their temperatures
    /// at its start, or, where a step of the heat spans several of the mechanics, an equal part of
    /// the change in each.
    fn before_detection(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        let begun = has_begun(&self.heat, s);
        let Some(state) = s.state.heat.as_mut().filter(|_| begun) else {
            return Ok(());
        };
        let parts = state.parts(self.heat.every);
        for system in &self.expansion.systems {
            let strain = system.nodes.clone().map(|node| {
                let expanded = &mut state.expanded[node];
                *expanded += (state.nodes[node].temperature - *expanded) / parts;
                free_strain(system.coefficient, *expanded - system.reference)
            });
            let strain: Vec<f64> = strain.collect();
            s.state.systems.set_free_strain(system.system, &strain);
        }
        Ok(())
    }

    fn contacts_found(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        self.find_rates(s);
        if self.rate.iter().any(|rate| *rate != 0.0) {
            let contacts = s.state.network.contacts.iter();
            let velocities = contacts.map(|c| self.surface_velocities(s, c)).collect();
            s.workspace.surfaces.velocities = velocities;
        }
        Ok(())
    }

    fn after_solve(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        s.workspace.surfaces.work += self.take_work_of_bodies(s);
        self.take_work_of_systems(s);
        Ok(())
    }

    /// Gives bodies the size of the end of the step.
    fn after_move(&mut self, s: &mut Simulation<S>, _: &StepReport) -> Result<(), ProcessError> {
        let Some(state) = &mut s.state.heat else {
            return Ok(());
        };
        if state.stretch == self.stretch {
            return Ok(());
        }
        state.stretch.clone_from(&self.stretch);
        let lengths = &mut s.state.bodies.length;
        let grown = (self.expansion).apply(&self.stretch, &mut s.shapes, lengths);
        let network = &mut s.state.network;
        network.grown += grown;
        if network.grown > GROWTH * network.skin {
            network.forget_neighbours();
        }
        Ok(())
    }

    /// Gives shapes the sizes of the state.
    fn follow_state(&mut self, s: &mut Simulation<S>) {
        if let Some(state) = &s.state.heat {
            let lengths = &mut s.state.bodies.length;
            self.expansion.apply(&state.stretch, &mut s.shapes, lengths);
        }
    }
}
