//! The stepper's part of thermal expansion: surfaces that move on their bodies, and the work of that.
//!
//! Over a step a body b that expands has a rate of strain e_b = (lambda'/lambda - 1)/h, with its size lambda at the start and at the end of
//! the step. Its surface at an arm r from its centre moves by e_b r on it, so that at a contact
//!
//! ```text
//! u_surface = u_bodies + w,   w = e_i r_i - e_j r_j
//! ```
//!
//! Laws see u_surface. The solver, which knows bodies, gets w with what else is added to its velocities: s becomes s + w, and the impulse of a
//! bond -(a + B u) becomes -(a + B w + B u). Contacts then work on bodies by sum p.u_bodies and take sum p.u_surface: the difference, -sum p.w,
//! is the work that the expansion does. It is an entry of the ledger of energy, and is taken from the heat of the body that expands.
//!
//! A body of finite elements takes the free strain of its temperatures at the start of the step; what its stored energy gains by that is the
//! work of its expansion.

use super::Simulation;
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::expansion::free_strain;
use crate::heat::{ExpandingSystem, Expansion};
use crate::solve::ContactForm;

/// Share of the skin of the neighbour list by which bodies may grow before the list is built again.
const GROWTH: f64 = 0.25;

/// What bodies do in a step by expansion.
#[derive(Debug, Default)]
pub(super) struct Expanding {
    /// Lambda of each body at the end of the step.
    stretch: Vec<f64>,
    /// Rate of strain of each body (1/s).
    rate: Vec<f64>,
    /// Whether there is one other than zero.
    moves: bool,
    /// Work of rigid bodies in the step (J).
    pub work: f64,
}

impl<S: Space> Simulation<S> {
    /// Has rigid bodies expand from here on, by coefficients of linear expansion (1/K) of each, from the temperatures that they have now, and
    /// bodies of finite elements. Heat is set before.
    pub fn set_expansion(&mut self, coefficient: Vec<f64>, systems: Vec<ExpandingSystem>) {
        let all = 0..self.state.bodies.len();
        let reference = all.map(|b| self.temperature(b).unwrap_or_default());
        let reference: Vec<f64> = reference.collect();
        if let Some(heat) = &mut self.state.heat {
            heat.stretch = vec![1.0; coefficient.len()];
            if !systems.is_empty() {
                heat.expanded = heat.nodes.iter().map(|n| n.temperature).collect();
                for system in &systems {
                    heat.expanded[system.nodes.clone()].fill(system.reference);
                }
            }
            let lengths = &self.state.bodies.length;
            self.expansion = Some(Expansion::new(
                coefficient,
                reference,
                systems,
                &self.shapes,
                lengths,
            ));
        }
    }

    /// Thermal expansion, where bodies expand.
    pub fn expansion(&self) -> Option<&Expansion<S>> {
        self.expansion.as_ref()
    }

    /// Gives shapes the sizes of the state.
    pub(super) fn show_expansion(&mut self) {
        if let (Some(expansion), Some(heat)) = (&self.expansion, &self.state.heat) {
            let lengths = &mut self.state.bodies.length;
            expansion.show(&heat.stretch, &mut self.shapes, lengths);
        }
    }

    /// Gives bodies of finite elements the free strain of the step: that of their temperatures at its start, or where heat makes one step for several
    /// of the mechanics the same part of the way there in each of them.
    pub(super) fn strain_systems(&mut self) {
        let Some(heat) = self.heat.as_ref().filter(|heat| self.begun(heat)) else {
            return;
        };
        let (Some(expansion), Some(state)) = (&self.expansion, &mut self.state.heat) else {
            return;
        };
        let parts = state.parts(heat.every);
        for system in &expansion.systems {
            let strain = system.nodes.clone().map(|node| {
                let expanded = &mut state.expanded[node];
                *expanded += (state.nodes[node].temperature - *expanded) / parts;
                free_strain(system.coefficient, *expanded - system.reference)
            });
            let strain: Vec<f64> = strain.collect();
            let systems = &mut self.state.systems;
            systems.set_free_strain(system.system, &strain);
        }
    }

    /// Finds by how much rigid bodies expand in the step: to the size of their temperature at its start, or where heat makes one step for several of the
    /// mechanics by the same part in each of them.
    pub(super) fn begin_expansion(&mut self) {
        let (Some(expansion), Some(heat), Some(state)) =
            (&self.expansion, &self.heat, &self.state.heat)
        else {
            return;
        };
        let expanding = &mut self.workspace.expanding;
        let parts = state.parts(heat.every);
        let h = self.options.scheme.h;
        expanding.stretch.clone_from(&state.stretch);
        expanding.rate.clear();
        for (body, stretch) in expanding.stretch.iter_mut().enumerate() {
            let node = heat.nodes[body].range().next();
            if expansion.coefficient[body] == 0.0 {
                expanding.rate.push(0.0);
                continue;
            }
            let before = *stretch;
            if let Some(node) = node {
                let goal = expansion.stretch(body, state.nodes[node].temperature);
                *stretch += (goal - before) / parts;
            }
            expanding.rate.push((*stretch / before - 1.0) / h);
        }
        expanding.moves = expanding.rate.iter().any(|rate| *rate != 0.0);
    }

    /// Whether a rigid body changes its size in the step.
    fn surfaces_move(&self) -> bool {
        self.expansion.is_some() && self.workspace.expanding.moves
    }

    /// The velocities of the surfaces of a contact on their bodies (m/s): of balls that are bodies of their own along its normal.
    fn surface_velocities(&self, contact: &Contact<S>) -> [S::Vector; 2] {
        let rate = &self.workspace.expanding.rate;
        std::array::from_fn(|side| {
            let body = contact.bodies[side] as usize;
            if rate[body] == 0.0 {
                return S::Vector::zero();
            }
            let arm = contact.arms[side];
            if !contact.central {
                return arm * rate[body];
            }
            let along = contact.normal * contact.normal.dot(&arm);
            // The arm of a ball of a body that nothing moves is from the centre of the ball.
            let offset = match [contact.key.ball(), contact.key.antagonist_ball()][side] {
                Some(ball) => self.shapes.balls[ball].offset,
                None => S::Vector::zero(),
            };
            (S::rotate(&self.state.bodies.rotation[body], &offset) + along) * rate[body]
        })
    }

    /// Adds w to the relative velocities of all contacts.
    pub(super) fn add_surface_velocities(&self, relative: &mut [S::Vector]) {
        if !self.surfaces_move() {
            return;
        }
        for (u, contact) in relative.iter_mut().zip(&self.state.network.contacts) {
            let [i, j] = self.surface_velocities(contact);
            *u += i - j;
        }
    }

    /// The forms of the contacts in the velocities of the bodies, where these are not those of the surfaces.
    pub(super) fn forms_of_bodies(&self) -> Option<Vec<ContactForm<S>>> {
        if !self.surfaces_move() {
            return None;
        }
        let mut forms = self.workspace.forms.clone();
        for (form, contact) in forms.iter_mut().zip(&self.state.network.contacts) {
            let [i, j] = self.surface_velocities(contact);
            let w = i - j;
            let (n, t) = (form.normal.dot(&w), S::tangential(&form.normal, &w));
            form.shift_n += n;
            if let Some(bond) = &mut form.elastic {
                bond.a_n += bond.b_n * n;
            }
            // What is along the normal has a part across it that is rounding.
            if !contact.central || t.norm() > 1e-12 * w.norm() {
                form.shift_t += t;
                if let Some(bond) = &mut form.elastic {
                    bond.a_t += t * bond.b_t;
                }
            }
        }
        Some(forms)
    }

    /// Takes the work of expansion from the heat of the bodies that do it.
    pub(super) fn book_expansion(&mut self) {
        let Some(expansion) = &self.expansion else {
            return;
        };
        let contacts = match self.surfaces_move() {
            true => &self.state.network.contacts[..],
            false => &[],
        };
        let steps = &self.workspace.solved.contact_steps;
        let mut works = Vec::new();
        for (contact, step) in contacts.iter().zip(steps) {
            let impulse = &step.solution.impulse;
            if *impulse == S::Vector::zero() {
                continue;
            }
            let velocities = self.surface_velocities(contact);
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let work = sign * impulse.dot(&velocities[side]);
                if work != 0.0 {
                    works.push((contact.bodies[side], work));
                }
            }
        }
        let mut of_systems = Vec::new();
        for system in &expansion.systems {
            let found = self.state.systems.get(system.system);
            let work = found.map_or(&[][..], |s| s.expansion_work());
            for (point, work) in work.iter().enumerate().filter(|(_, work)| **work != 0.0) {
                // A single node is that of all points.
                let node = system.nodes.start + point;
                of_systems.push((node.min(system.nodes.end - 1), *work));
            }
        }
        let mut all = 0.0;
        if let (Some(heat), Some(state)) = (&self.heat, &mut self.state.heat) {
            for (body, work) in works {
                all += work;
                if let Some(node) = heat.nodes[body as usize].range().next() {
                    state.pay_for_expansion(node, work);
                }
            }
            for (node, work) in of_systems {
                state.pay_for_expansion(node, work);
            }
        }
        self.workspace.expanding.work = all;
    }

    /// Gives bodies the size of the end of the step.
    pub(super) fn end_expansion(&mut self) {
        let (Some(expansion), Some(state)) = (&self.expansion, &mut self.state.heat) else {
            return;
        };
        let stretch = &self.workspace.expanding.stretch;
        if state.stretch == *stretch {
            return;
        }
        state.stretch.clone_from(stretch);
        let lengths = &mut self.state.bodies.length;
        let grown = expansion.show(stretch, &mut self.shapes, lengths);
        let network = &mut self.state.network;
        network.grown += grown;
        if network.grown > GROWTH * network.skin {
            network.forget_neighbours();
        }
    }
}
