//! The bonds' part of a commit: openings move, damage grows, energy is booked, bonds break.

use super::columns::StepInfo;
use super::interface::Interface;
use super::library::{Call, LawError};
use super::pass::{Passes, Site, Totals};
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};

/// What bonds hold after a step, in the order of the members.
#[derive(Debug, Default)]
pub(super) struct Held {
    /// Work done by the bond's impulse over the step (J).
    work: Vec<f64>,
    /// Energy per area at the new opening and the old damage (J/m^2).
    stored: Vec<f64>,
    /// Energy per area at the new opening and the new damage (J/m^2).
    kept: Vec<f64>,
    /// The new damage.
    damage: Vec<f64>,
}

impl Passes {
    /// Ends the step of the intact bonds of one interface, which are the members.
    pub(super) fn commit_bonds<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        network: &mut Network<S>,
        sites: &[Site<S>],
        info: &StepInfo,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        let Some(cohesion) = &law.cohesion else {
            return Ok(());
        };
        let mut held = std::mem::take(&mut self.held);
        self.open(index, network, sites, info, &mut held.work);
        self.gather_after(law, network, sites, info);
        self.columns.size_outputs();
        held.damage.clone_from(&self.columns.damage);
        if let Some(damage) = &law.damage {
            // The damage law sees what the undamaged bond would carry and store; what the damaged one
            // stores follows, psi = (1 - D)^m psi_0.
            let m = cohesion.plugin.degradation;
            self.columns.damage.fill(0.0);
            self.run(cohesion, info, 0.0, Call::Energy)?;
            self.run(cohesion, info, 0.0, Call::Prepare)?;
            self.columns.damage.clone_from(&held.damage);
            self.columns.expose_intact();
            self.run(damage, info, m, Call::Commit)?;
            let kept_of = |damage: &[f64], intact: &[f64], out: &mut Vec<f64>| {
                out.clear();
                out.extend(damage.iter().zip(intact).map(|(d, e)| left(*d, m) * e));
            };
            kept_of(&held.damage, &self.columns.energy_intact, &mut held.stored);
            for (new, old) in self.columns.out.damage.iter().zip(&mut held.damage) {
                *old = new.clamp(*old, 1.0);
            }
            kept_of(&held.damage, &self.columns.energy_intact, &mut held.kept);
            self.columns.damage.clone_from(&held.damage);
        } else {
            self.run(cohesion, info, 0.0, Call::Energy)?;
            held.stored.clone_from(&self.columns.out.energy);
            held.kept.clone_from(&self.columns.out.energy);
        }
        if cohesion.plugin.commits() {
            self.run(cohesion, info, 0.0, Call::Commit)?;
        }
        self.settle(index, law, network, &held, totals);
        self.held = held;
        Ok(())
    }

    /// Moves the openings. What the bond's impulse does beyond storing energy is damping.
    fn open<S: Space>(
        &self,
        index: usize,
        network: &mut Network<S>,
        sites: &[Site<S>],
        info: &StepInfo,
        works: &mut Vec<f64>,
    ) {
        works.clear();
        for at in &self.members {
            let (contact, site) = (&network.contacts[*at], &sites[*at]);
            let Some(slot) = contact.memory() else {
                continue;
            };
            let bond = &mut network.memory[index].bonds[slot];
            let n = &contact.normal;
            let (un, ut) = (n.dot(&site.average), S::tangential(n, &site.average));
            bond.opening_n += info.h * un;
            bond.opening_t += ut * info.h;
            let s = &site.solution;
            let (en, et) = (
                n.dot(&s.impulse) - s.unilateral_n,
                S::tangential(n, &s.impulse) - s.unilateral_t,
            );
            works.push(en * un + et.dot(&ut));
        }
    }

    /// Stores damage, energy and internal variables; breaks what is wholly damaged.
    fn settle<S: Space>(
        &self,
        index: usize,
        law: &Interface,
        network: &mut Network<S>,
        held: &Held,
        totals: &mut Totals,
    ) {
        for (k, at) in self.members.iter().enumerate() {
            let contact = &mut network.contacts[*at];
            let Some(slot) = contact.memory() else {
                continue;
            };
            let memory = &mut network.memory[index];
            for (column, next) in memory.variables.iter_mut().zip(&self.columns.state_next) {
                column[slot] = next[k];
            }
            let bond = &mut memory.bonds[slot];
            let (stored, kept) = (held.stored[k] * bond.area, held.kept[k] * bond.area);
            totals.viscous += -held.work[k] - (stored - bond.energy);
            bond.damage = held.damage[k];
            if bond.damage >= 1.0 {
                totals.fracture += stored;
                totals.broken += 1;
                memory.broken += 1;
                bond.energy = 0.0;
                contact.broken = true;
                network.broken_pairs.insert(contact.key.pair());
                if law.variables() == 0 {
                    memory.release(slot as u32);
                    contact.slot = Contact::<S>::NO_MEMORY;
                }
            } else {
                totals.fracture += stored - kept;
                bond.energy = kept;
            }
        }
    }
}

/// (1 - D)^m.
fn left(damage: f64, m: f64) -> f64 {
    let intact = 1.0 - damage;
    if m == 1.0 {
        intact
    } else if m == 2.0 {
        intact * intact
    } else {
        intact.powf(m)
    }
}
