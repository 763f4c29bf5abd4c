//! Prepare and commit: the laws' part of a step.
//!
//! Prepare writes friction, cohesion and the linearised bond of every contact into its standard local
//! form; commit moves openings, lets damage grow, breaks bonds, removes matter, and books the energy.

use super::bonds::Held;
use super::columns::{Columns, StepInfo};
use super::interface::{Interface, Loaded};
use super::library::{Call, LawError};
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Elastic};

/// What one contact did over the step.
#[derive(Clone, Copy, Debug)]
pub struct Site<S: Space> {
    /// Relative velocity u^- (m/s).
    pub before: S::Vector,
    /// Theta-averaged relative velocity u_th (m/s).
    pub average: S::Vector,
    /// The unilateral part may pull (h c_n > 0).
    pub adheres: bool,
    /// The solver's answer.
    pub solution: ContactSolution<S>,
}

/// Energies and events of one step, summed over contacts (J, m^3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by impacts.
    pub impact: f64,
    /// Spent against unilateral tension (cohesion without opening).
    pub adhesion: f64,
    /// Dissipated by damping of bonds.
    pub viscous: f64,
    /// Released by damage: fracture energy.
    pub fracture: f64,
    /// Bonds that broke.
    pub broken: u64,
    /// Volume worn off first bodies.
    pub worn_first: f64,
    /// Volume worn between grains.
    pub worn_third: f64,
}

/// Working memory of the passes.
#[derive(Debug, Default)]
pub struct Passes {
    pub(super) columns: Columns,
    pub(super) members: Vec<usize>,
    pub(super) held: Held,
    /// Interfaces whose bonds have been made.
    bonded: Vec<bool>,
}

/// Friction and restitution of one contact.
#[derive(Clone, Copy, Default)]
struct Friction {
    mu: f64,
    e_n: f64,
    e_t: f64,
    tension: f64,
    cohesion: f64,
}

impl Passes {
    /// Makes the bonds of the interfaces whose time has come.
    pub fn make_bonds<S: Space>(
        &mut self,
        laws: &[Interface],
        network: &mut Network<S>,
        time: f64,
    ) {
        self.bonded.resize(laws.len(), false);
        for (index, law) in laws.iter().enumerate() {
            if self.bonded[index] || law.bonding_time().is_none_or(|t| time < t) {
                continue;
            }
            self.bonded[index] = true;
            let initial = law.initial();
            for contact in network
                .contacts
                .iter_mut()
                .filter(|c| c.law as usize == index)
            {
                let area = law.area.area(S::D, contact.radius);
                let memory = &mut network.memory[index];
                contact.slot = memory.allocate(true, contact.gap, area, &initial);
            }
        }
    }

    /// Completes the contacts' forms, which hold the geometry, with what the laws say.
    ///
    /// # Errors
    /// A law's own error, with the contact at fault.
    pub fn prepare<S: Space>(
        &mut self,
        laws: &[Interface],
        network: &Network<S>,
        before: &[S::Vector],
        info: &StepInfo,
        forms: &mut [ContactForm<S>],
    ) -> Result<(), LawError> {
        for (index, law) in laws.iter().enumerate() {
            // Intact bonds first: the cohesion law then takes the head of the same columns.
            let bonded = |c: &Contact<S>| network.bond(c).is_some_and(|b| b.intact());
            let head = if law.cohesion.is_some() {
                self.select(network, |c| c.law as usize == index && bonded(c));
                let head = self.members.len();
                self.select_more(network, |c| c.law as usize == index && !bonded(c));
                head
            } else {
                self.select(network, |c| c.law as usize == index);
                0
            };
            if self.members.is_empty() {
                continue;
            }
            let constant = law.constant_contact();
            if constant {
                self.columns.clear();
                self.columns.n = 1;
            } else {
                self.gather(law, network, before, info);
            }
            self.columns.size_outputs();
            self.run(&law.contact, info, 0.0, Call::Prepare)?;
            let answer = |out: &super::columns::Outputs, k: usize| Friction {
                mu: out.friction[k],
                e_n: out.restitution_n[k],
                e_t: out.restitution_t[k],
                tension: out.tension_strength[k],
                cohesion: out.shear_cohesion[k],
            };
            for (k, at) in self.members.iter().enumerate() {
                let friction = answer(&self.columns.out, if constant { 0 } else { k });
                let area = contact_area(law, network, &network.contacts[*at]);
                apply_friction(
                    &mut forms[*at],
                    &friction,
                    &network.contacts[*at],
                    &before[*at],
                    area,
                    info,
                );
            }
            let Some(cohesion) = &law.cohesion else {
                continue;
            };
            if head == 0 {
                continue;
            }
            self.members.truncate(head);
            if constant {
                self.gather(law, network, before, info);
            } else {
                self.columns.truncate(head);
            }
            self.columns.size_outputs();
            self.run(cohesion, info, 0.0, Call::Prepare)?;
            for (k, at) in self.members.iter().enumerate() {
                self.apply_cohesion(law, k, &before[*at], info, &mut forms[*at]);
            }
        }
        Ok(())
    }

    /// Ends the step: `sites` are what the contacts did, in the network's order.
    ///
    /// # Errors
    /// A law's own error, with the contact at fault.
    pub fn commit<S: Space>(
        &mut self,
        laws: &[Interface],
        network: &mut Network<S>,
        sites: &[Site<S>],
        info: &StepInfo,
    ) -> Result<Totals, LawError> {
        let mut totals = Totals::default();
        for (contact, site) in network.contacts.iter_mut().zip(sites) {
            contact.impulse = site.solution.impulse;
            let n = &contact.normal;
            contact.pressed = if n.dot(&contact.impulse) > 0.0 {
                contact.pressed + info.h
            } else {
                0.0
            };
            let (un, ut) = (n.dot(&site.average), S::tangential(n, &site.average));
            totals.friction -= site.solution.unilateral_t.dot(&ut);
            let work = -site.solution.unilateral_n * un;
            if site.adheres && site.solution.unilateral_n < 0.0 {
                totals.adhesion += work;
            } else {
                totals.impact += work;
            }
        }
        for (index, law) in laws.iter().enumerate() {
            if law.cohesion.is_some() {
                self.select(network, |c| {
                    c.law as usize == index && network.bond(c).is_some_and(|b| b.intact())
                });
                if !self.members.is_empty() {
                    self.commit_bonds(index, law, network, sites, info, &mut totals)?;
                }
            }
            if let Some(wear) = &law.wear {
                self.select(network, |c| c.law as usize == index);
                if !self.members.is_empty() {
                    self.commit_wear(law, wear, network, sites, info, &mut totals)?;
                }
            }
        }
        totals.fracture += std::mem::take(&mut network.torn_energy);
        Ok(totals)
    }

    fn commit_wear<S: Space>(
        &mut self,
        law: &Interface,
        wear: &Loaded,
        network: &Network<S>,
        sites: &[Site<S>],
        info: &StepInfo,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        self.gather_after(law, network, sites, info);
        for at in &self.members {
            let (contact, site) = (&network.contacts[*at], &sites[*at]);
            let ut = S::tangential(&contact.normal, &site.average);
            self.columns.slip.push(info.h * ut.norm());
            let work = -site.solution.unilateral_t.dot(&ut);
            self.columns.friction_work.push(work.max(0.0));
        }
        self.columns.size_outputs();
        self.run(wear, info, 0.0, Call::Commit)?;
        for (k, at) in self.members.iter().enumerate() {
            let volume = self.columns.out.volume[k];
            if network.contacts[*at].key.surface().is_some() {
                totals.worn_first += volume;
            } else {
                totals.worn_third += volume;
            }
        }
        Ok(())
    }

    fn select<S: Space>(&mut self, network: &Network<S>, keep: impl Fn(&Contact<S>) -> bool) {
        self.members.clear();
        self.select_more(network, keep);
    }

    fn select_more<S: Space>(&mut self, network: &Network<S>, keep: impl Fn(&Contact<S>) -> bool) {
        let contacts = network.contacts.iter().enumerate();
        self.members
            .extend(contacts.filter(|(_, c)| keep(c)).map(|(k, _)| k));
    }

    pub(super) fn run(
        &mut self,
        loaded: &Loaded,
        info: &StepInfo,
        degradation: f64,
        call: Call,
    ) -> Result<(), LawError> {
        let plugin = &loaded.plugin;
        self.columns
            // SAFETY: columns of the batch have `n` values or are null, and live in `self`.
            .with_batch(loaded, info, degradation, |batch| unsafe {
                plugin.call(call, batch)
            })?;
        match self.columns.out.not_finite(plugin.kind, call) {
            None => Ok(()),
            Some(contact) => Err(LawError::Failed {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: Some(contact),
                reason: "it gave a value that is not finite; check its parameters and the law"
                    .into(),
            }),
        }
    }

    /// Columns at the start of the step.
    fn gather<S: Space>(
        &mut self,
        law: &Interface,
        network: &Network<S>,
        before: &[S::Vector],
        info: &StepInfo,
    ) {
        self.columns.clear();
        for at in &self.members {
            let contact = &network.contacts[*at];
            gather_contact(&mut self.columns, law, network, contact, &before[*at], info);
            push_vector::<S>(&mut self.columns.impulse, &contact.normal, &contact.impulse);
        }
        self.gather_state(law, network);
    }

    /// Columns at the end of the step: new openings, u_th, this step's impulses.
    pub(super) fn gather_after<S: Space>(
        &mut self,
        law: &Interface,
        network: &Network<S>,
        sites: &[Site<S>],
        info: &StepInfo,
    ) {
        self.columns.clear();
        for at in &self.members {
            let (contact, site) = (&network.contacts[*at], &sites[*at]);
            gather_contact(
                &mut self.columns,
                law,
                network,
                contact,
                &site.average,
                info,
            );
            push_vector::<S>(
                &mut self.columns.impulse,
                &contact.normal,
                &site.solution.impulse,
            );
        }
        self.gather_state(law, network);
    }

    fn gather_state<S: Space>(&mut self, law: &Interface, network: &Network<S>) {
        self.columns.n = self.members.len();
        for v in 0..law.variables() {
            let column: Vec<f64> = self
                .members
                .iter()
                .map(|at| {
                    let contact = &network.contacts[*at];
                    let memory = &network.memory[contact.law as usize];
                    contact
                        .memory()
                        .map_or(0.0, |slot| memory.variables[v][slot])
                })
                .collect();
            self.columns.state_next.push(column.clone());
            self.columns.state.push(column);
        }
    }

    fn apply_cohesion<S: Space>(
        &self,
        law: &Interface,
        k: usize,
        before: &S::Vector,
        info: &StepInfo,
        form: &mut ContactForm<S>,
    ) {
        let (out, n) = (&self.columns.out, &form.normal);
        let StepInfo { h, theta, .. } = *info;
        let area = self.columns.area[k];
        let (un, ut) = (n.dot(before), S::tangential(n, before));
        let memory = h * theta * (1.0 - theta);
        let (kn, kt) = (out.stiffness_n[k].max(0.0), out.stiffness_t[k].max(0.0));
        let (dn, dt) = (out.damping_n[k].max(0.0), out.damping_t[k].max(0.0));
        let traction_t = S::from_components(n, out.traction[1][k], out.traction[2][k]);
        form.tension += h * area * out.tension_strength[k];
        form.cohesion += h * area * out.shear_cohesion[k];
        form.elastic = Some(Elastic {
            a_n: h * area * (out.traction[0][k] + (kn * memory + dn * (1.0 - theta)) * un),
            a_t: (traction_t + ut * (kt * memory + dt * (1.0 - theta))) * (h * area),
            b_n: h * area * (h * theta * theta * kn + theta * dn),
            b_t: h * area * (h * theta * theta * kt + theta * dt),
            tension_only: law.tension_only(),
        });
    }
}

#[inline]
fn contact_area<S: Space>(law: &Interface, network: &Network<S>, contact: &Contact<S>) -> f64 {
    match network.bond(contact) {
        Some(bond) => bond.area,
        None => law.area.area(S::D, contact.radius),
    }
}

fn apply_friction<S: Space>(
    form: &mut ContactForm<S>,
    friction: &Friction,
    contact: &Contact<S>,
    before: &S::Vector,
    area: f64,
    info: &StepInfo,
) {
    form.friction = friction.mu;
    form.tension = info.h * area * friction.tension;
    form.cohesion = info.h * area * friction.cohesion;
    // Newton's restitution: closed contacts bounce off the velocity they come with, open ones are free
    // (a quasi-shock would take the approach away before the impact).
    let un = contact.normal.dot(before);
    if friction.e_n > 0.0 {
        if contact.gap > 0.0 {
            form.shift_n = f64::INFINITY;
        } else if un < 0.0 {
            form.shift_n = friction.e_n * un;
        }
    }
    if contact.gap <= 0.0 && friction.e_t > 0.0 {
        form.shift_t = S::tangential(&contact.normal, before) * friction.e_t;
    }
}

#[inline]
fn push_vector<S: Space>(triple: &mut super::columns::Triple, n: &S::Vector, v: &S::Vector) {
    let [t1, t2] = S::components(n, &S::tangential(n, v));
    triple[0].push(n.dot(v));
    triple[1].push(t1);
    triple[2].push(t2);
}

#[inline]
fn gather_contact<S: Space>(
    columns: &mut Columns,
    law: &Interface,
    network: &Network<S>,
    contact: &Contact<S>,
    velocity: &S::Vector,
    info: &StepInfo,
) {
    columns.gap.push(contact.gap);
    columns.area.push(contact_area(law, network, contact));
    columns.radius.push(contact.radius);
    columns.age.push(info.time - contact.born);
    columns.pressed.push(contact.pressed);
    push_vector::<S>(&mut columns.velocity, &contact.normal, velocity);
    let (opening, damage) = match network.bond(contact) {
        Some(bond) => {
            let [t1, t2] = S::components(&contact.normal, &bond.opening_t);
            ([bond.opening_n, t1, t2], bond.damage)
        }
        None => ([0.0; 3], 1.0),
    };
    for (column, x) in columns.opening.iter_mut().zip(opening) {
        column.push(x);
    }
    columns.damage.push(damage);
}
