//! Fills the columns of a batch from the network.

use super::columns::{Columns, StepInfo, Triple};
use super::evaluator::LawEvaluator;
use super::interface::Interface;
use super::step_result::{SolvedStep, Velocities};
use crate::contact::{Contact, Network, Spring};
use crate::geometry::space::{Space, VectorLike};

impl LawEvaluator {
    /// Fills the columns with the state at the start of the step.
    pub(super) fn gather<S: Space>(
        &mut self,
        law: &Interface,
        network: &Network<S>,
        before: &Velocities<S>,
        info: &StepInfo,
    ) {
        self.columns.clear();
        for at in &self.members {
            let contact = &network.contacts[*at];
            gather_contact(
                &mut self.columns,
                law,
                network,
                contact,
                &before.relative[*at],
                info,
                true,
            );
            push_vector::<S>(&mut self.columns.impulse, &contact.normal, &contact.impulse);
            if law.compliant() {
                let mass = before.effective_mass[*at];
                let overlap = before.overlap[*at];
                push_spring(&mut self.columns, contact, &contact.spring, overlap, mass);
            }
        }
        self.gather_state(law, network);
    }

    /// Fills the columns with the state at the end of the step: new openings, u_th, the step's impulses.
    pub(super) fn gather_after<S: Space>(
        &mut self,
        law: &Interface,
        network: &Network<S>,
        step: &SolvedStep<'_, S>,
    ) {
        self.columns.clear();
        for at in &self.members {
            let (contact, contact_step) = (&network.contacts[*at], &step.contacts[*at]);
            gather_contact(
                &mut self.columns,
                law,
                network,
                contact,
                &contact_step.average,
                step.info,
                false,
            );
            push_vector::<S>(
                &mut self.columns.impulse,
                &contact.normal,
                &contact_step.solution.impulse,
            );
            if law.compliant() {
                let spring = step.spring(*at).map_or(contact.spring, |s| s.spring);
                push_spring(&mut self.columns, contact, &spring, spring.overlap, 0.0);
                let before = step.spring(*at).map_or(spring.force_t, |s| s.force_before);
                let before = S::components(&contact.normal, &before);
                for (column, x) in self.columns.spring_before.iter_mut().zip(before) {
                    column.push(x);
                }
            }
        }
        self.gather_state(law, network);
    }

    fn gather_state<S: Space>(&mut self, law: &Interface, network: &Network<S>) {
        self.columns.n = self.members.len();
        for v in 0..law.variables() {
            let column: Vec<f64> = match self.members.first() {
                // Those of a batch belong to one interface.
                Some(first) => {
                    let law = network.contacts[*first].law as usize;
                    let values = &network.memory[law].variables[v];
                    let slots = self.members.iter().map(|at| network.contacts[*at].memory());
                    slots.map(|s| s.map_or(0.0, |s| values[s])).collect()
                }
                None => Vec::new(),
            };
            self.columns.state_next.push(column.clone());
            self.columns.state.push(column);
        }
    }
}

#[inline]
pub(super) fn contact_area<S: Space>(
    law: &Interface,
    network: &Network<S>,
    contact: &Contact<S>,
) -> f64 {
    match network.bond(contact) {
        Some(bond) => bond.area,
        None => law.area.area(S::D, contact.radius),
    }
}

#[inline]
fn push_vector<S: Space>(triple: &mut Triple, n: &S::Vector, v: &S::Vector) {
    let [t1, t2] = S::components(n, &S::tangential(n, v));
    triple[0].push(n.dot(v));
    triple[1].push(t1);
    triple[2].push(t2);
}

/// Fills the columns of a compliant contact.
fn push_spring<S: Space>(
    columns: &mut Columns,
    contact: &Contact<S>,
    spring: &Spring<S>,
    overlap: f64,
    effective_mass: f64,
) {
    columns.overlap.push(overlap);
    columns.effective_mass.push(effective_mass);
    let force = S::components(&contact.normal, &spring.force_t);
    for (column, x) in columns.spring.iter_mut().zip(force) {
        column.push(x);
    }
}

#[inline]
fn gather_contact<S: Space>(
    columns: &mut Columns,
    law: &Interface,
    network: &Network<S>,
    contact: &Contact<S>,
    velocity: &S::Vector,
    info: &StepInfo,
    // At the start of a step laws see the damage used in its impulse.
    start: bool,
) {
    columns.gap.push(contact.gap);
    columns.area.push(contact_area(law, network, contact));
    columns.radius.push(contact.radius);
    columns.age.push(info.time - contact.formed_at);
    columns.pressed.push(contact.compression_time);
    push_vector::<S>(&mut columns.velocity, &contact.normal, velocity);
    let (opening, damage) = match network.bond(contact) {
        Some(bond) => {
            let [t1, t2] = S::components(&contact.normal, &bond.opening_t);
            let damage = if start { bond.step_damage } else { bond.damage };
            ([bond.opening_n, t1, t2], damage)
        }
        None => ([0.0; 3], 1.0),
    };
    for (column, x) in columns.opening.iter_mut().zip(opening) {
        column.push(x);
    }
    columns.damage.push(damage);
    if law.rotates() {
        let memory = &network.memory[contact.law as usize];
        let rotation = contact.memory().map_or([0.0; 3], |slot| {
            S::spin_components(&contact.normal, &memory.rotations[slot])
        });
        for (column, x) in columns.rotation.iter_mut().zip(rotation) {
            column.push(x);
        }
    }
}
