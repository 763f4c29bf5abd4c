//! Commit: the laws' update at the end of a solved step.

use super::columns::StepInfo;
use super::interface::{Interface, Loaded};
use super::library::{Call, LawError};
use super::pass::{ContactStep, LawEvaluator, MomentStep, Totals};
use crate::contact::network::Key;
use crate::contact::{ContactDissipation, Loss, Network};
use crate::geometry::space::{Space, VectorLike};
use std::collections::HashSet;

impl LawEvaluator {
    /// Completes the step. `sites` holds the results of the contacts in the network's order, `turns` the
    /// moments of those that resist rotation.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn commit<S: Space>(
        &mut self,
        laws: &[Interface],
        network: &mut Network<S>,
        sites: &[ContactStep<S>],
        turns: &[MomentStep<S>],
        info: &StepInfo,
    ) -> Result<Totals, LawError> {
        let mut totals = Totals::default();
        if let Some(spent) = &mut network.spent {
            spent.clear();
            spent.resize(network.contacts.len(), ContactDissipation::default());
        }
        if let Some(losses) = &mut network.losses {
            losses.clear();
        }
        for (k, (contact, site)) in network.contacts.iter_mut().zip(sites).enumerate() {
            contact.impulse = site.solution.impulse;
            contact.moment = S::Spin::zero();
            let n = &contact.normal;
            contact.pressed = if n.dot(&contact.impulse) > 0.0 && !contact.beyond {
                contact.pressed + info.h
            } else {
                0.0
            };
            let (un, ut) = (n.dot(&site.average), S::tangential(n, &site.average));
            let friction = -site.solution.unilateral_t.dot(&ut);
            totals.friction += friction;
            contact.slides = site.slides;
            contact.friction_work += friction;
            let work = -site.solution.unilateral_n * un + site.corrected;
            totals.correction -= site.corrected;
            let adheres = site.adheres && site.solution.unilateral_n < 0.0;
            if adheres {
                totals.adhesion += work;
            } else {
                totals.impact += work;
            }
            if let Some(spent) = &mut network.spent {
                let (adhesion, impact) = if adheres { (work, 0.0) } else { (0.0, work) };
                spent[k] = ContactDissipation {
                    friction,
                    impact,
                    adhesion,
                    correction: -site.corrected,
                    ..ContactDissipation::default()
                };
            }
        }
        for turn in turns {
            let contact = &mut network.contacts[turn.moment.contact as usize];
            contact.moment = turn.moment.moment;
            let friction = -turn.moment.friction.dot(&turn.spin);
            totals.friction += friction;
            contact.friction_work += friction;
            if let Some(spent) = &mut network.spent {
                spent[turn.moment.contact as usize].friction += friction;
            }
        }
        for (index, law) in laws.iter().enumerate() {
            let bonded = |n: &Network<S>, c: &crate::contact::Contact<S>| {
                n.bond(c).is_some_and(|b| b.intact())
            };
            if law.opens() {
                self.select(network, |c| c.law as usize == index && bonded(network, c));
                if !self.members.is_empty() {
                    self.commit_bonds(index, law, network, sites, turns, info, &mut totals)?;
                }
            }
            self.select(network, |c| c.law as usize == index);
            if self.members.is_empty() {
                continue;
            }
            if law.contact.variables() > 0 {
                self.commit_state(index, law, &law.contact, network, sites, info)?;
            }
            self.select(network, |c| c.law as usize == index && !c.beyond);
            if self.members.is_empty() {
                continue;
            }
            if let (Some(cohesion), false) = (&law.cohesion, law.opens())
                && cohesion.variables() > 0
            {
                self.commit_state(index, law, cohesion, network, sites, info)?;
            }
            if let Some(wear) = &law.wear {
                self.commit_wear(index, law, wear, network, sites, info, &mut totals)?;
            }
        }
        totals.fracture += std::mem::take(&mut network.torn_energy);
        Ok(totals)
    }

    /// Updates the internal variables of a law that acts on all contacts.
    fn commit_state<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        loaded: &Loaded,
        network: &mut Network<S>,
        sites: &[ContactStep<S>],
        info: &StepInfo,
    ) -> Result<(), LawError> {
        self.gather_after(law, network, sites, info);
        self.columns.size_outputs();
        self.run(loaded, info, 0.0, Call::Commit)
            .map_err(|e| self.at(law, network, e))?;
        self.keep_state(index, network);
        Ok(())
    }

    /// Stores the new internal variables of the members.
    pub(super) fn keep_state<S: Space>(&self, index: usize, network: &mut Network<S>) {
        for (k, at) in self.members.iter().enumerate() {
            let Some(slot) = network.contacts[*at].memory() else {
                continue;
            };
            let columns = &mut network.memory[index].variables;
            for (column, next) in columns.iter_mut().zip(&self.columns.state_next) {
                column[slot] = next[k];
            }
        }
    }

    /// Drops the deferred negative friction work of separated pairs once they outnumber the contacts.
    fn forget_debts<S: Space>(&mut self, network: &Network<S>) {
        let contacts = &network.contacts;
        if self.negative_friction_work.len() > 2 * contacts.len() {
            let near = |pair: &(u32, u32)| contacts.binary_search_by_key(pair, |c| c.key.pair());
            self.negative_friction_work
                .retain(|pair, _| near(pair).is_ok());
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn commit_wear<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        wear: &Loaded,
        network: &mut Network<S>,
        sites: &[ContactStep<S>],
        info: &StepInfo,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        self.gather_after(law, network, sites, info);
        self.forget_debts(network);
        for at in &self.members {
            let (contact, site) = (&network.contacts[*at], &sites[*at]);
            let ut = S::tangential(&contact.normal, &site.average);
            self.columns.slip.push(info.h * ut.norm());
            let work = -site.solution.unilateral_t.dot(&ut);
            // Where the slip direction reverses within a step the friction work can be negative; it is
            // deferred to later steps of the law.
            let pair = contact.key.pair();
            let owed = match self.negative_friction_work.is_empty() {
                true => 0.0,
                false => self.negative_friction_work.remove(&pair).unwrap_or(0.0),
            };
            let work = work + owed;
            if work < 0.0 {
                self.negative_friction_work.insert(pair, work);
            }
            self.columns.friction_work.push(work.max(0.0));
        }
        self.columns.size_outputs();
        self.run(wear, info, 0.0, Call::Commit)
            .map_err(|e| self.at(law, network, e))?;
        // Breakage happens once, even in a cycle that represents many: its energy is not multiplied.
        let breaks = network
            .bond_breaks
            .iter()
            .filter(|_| network.cycle_multiplier > 1.0);
        let broke: HashSet<Key> = breaks.map(|b| b.key).collect();
        for (k, at) in self.members.iter().enumerate() {
            let times = if broke.contains(&network.contacts[*at].key) {
                1.0
            } else {
                network.cycle_multiplier
            };
            let volume = times * self.columns.out.volume[k];
            if let Some(surface) = network.contacts[*at].key.surface() {
                totals.worn_first += volume;
                if volume > 0.0 {
                    *network.worn.entry(surface).or_default() += volume;
                }
                if let (Some(losses), true) = (&mut network.losses, volume > 0.0) {
                    let contact = *at as u32;
                    losses.push(Loss { contact, volume });
                }
            } else {
                totals.worn_third += volume;
            }
        }
        if wear.variables() > 0 {
            self.keep_state(index, network);
        }
        Ok(())
    }
}
