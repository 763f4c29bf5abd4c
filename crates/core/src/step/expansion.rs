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

use super::Simulation;
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::expansion::Expansion;
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
    /// Work of the step (J).
    pub work: f64,
}

impl<S: Space> Simulation<S> {
    /// Has bodies expand from here on, by coefficients of linear expansion (1/K) of each, from the temperatures that they have now. Heat is set before.
    pub fn set_expansion(&mut self, coefficient: Vec<f64>) {
        let all = 0..self.state.bodies.len();
        let reference = all.map(|b| self.temperature(b).unwrap_or_default());
        let reference: Vec<f64> = reference.collect();
        if let Some(heat) = &mut self.state.heat {
            heat.stretch = vec![1.0; coefficient.len()];
            let lengths = &self.state.bodies.length;
            self.expansion = Some(Expansion::new(
                coefficient,
                reference,
                &self.shapes,
                lengths,
            ));
        }
    }

    /// Gives shapes the sizes of the state.
    pub(super) fn show_expansion(&mut self) {
        if let (Some(expansion), Some(heat)) = (&self.expansion, &self.state.heat) {
            let lengths = &mut self.state.bodies.length;
            expansion.show(&heat.stretch, &mut self.shapes, lengths);
        }
    }

    /// Finds by how much bodies expand in the step: to the size of their temperature at its start, or where heat makes one step for several of the
    /// mechanics by the same part in each of them.
    pub(super) fn begin_expansion(&mut self) {
        let (Some(expansion), Some(heat), Some(state)) =
            (&self.expansion, &self.heat, &self.state.heat)
        else {
            return;
        };
        let expanding = &mut self.workspace.expanding;
        let parts = heat.every.saturating_sub(state.pending_steps).max(1) as f64;
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
    }

    /// The velocities of the surfaces of a contact on their bodies (m/s): at a contact of balls along its normal.
    fn surface_velocities(&self, contact: &Contact<S>) -> [S::Vector; 2] {
        let rate = &self.workspace.expanding.rate;
        std::array::from_fn(|side| {
            let velocity = contact.arms[side] * rate[contact.bodies[side] as usize];
            match contact.central {
                true => contact.normal * contact.normal.dot(&velocity),
                false => velocity,
            }
        })
    }

    /// Adds w to the relative velocities of all contacts.
    pub(super) fn add_surface_velocities(&self, relative: &mut [S::Vector]) {
        if self.expansion.is_none() {
            return;
        }
        for (u, contact) in relative.iter_mut().zip(&self.state.network.contacts) {
            let [i, j] = self.surface_velocities(contact);
            *u += i - j;
        }
    }

    /// The forms of the contacts in the velocities of the bodies, where these are not those of the surfaces.
    pub(super) fn forms_of_bodies(&self) -> Option<Vec<ContactForm<S>>> {
        self.expansion.as_ref()?;
        let mut forms = self.workspace.forms.clone();
        for (form, contact) in forms.iter_mut().zip(&self.state.network.contacts) {
            let [i, j] = self.surface_velocities(contact);
            let w = i - j;
            let (n, t) = (form.normal.dot(&w), S::tangential(&form.normal, &w));
            form.shift_n += n;
            if let Some(bond) = &mut form.elastic {
                bond.a_n += bond.b_n * n;
            }
            // The part along the normal of balls has none across it but for rounding.
            if !contact.central {
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
        if self.expansion.is_none() {
            return;
        }
        let contacts = &self.state.network.contacts;
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
        let mut all = 0.0;
        if let (Some(heat), Some(state)) = (&self.heat, &mut self.state.heat) {
            for (body, work) in works {
                all += work;
                if let Some(node) = heat.nodes[body as usize].range().next() {
                    state.pending[node] -= work;
                    state.ledger.pending -= work;
                    state.ledger.expansion += work;
                }
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
