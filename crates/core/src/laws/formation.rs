//! Formation of bonds, and memory for the internal variables of new contacts.

use super::batch::{BATCH, Batch, locate};
use super::columns::StepInfo;
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::gather::{Source, store_states};
use super::history::LawHistory;
use super::interface::{BondOpening, Interface, Loaded};
use super::library::Call;
use super::step_result::Velocities;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::threads::any_size;

impl LawEvaluator {
    /// Allocates the internal variables of contacts and forms the bonds that are due: by the case's bond
    /// rule, and by compression time (healing).
    ///
    /// # Errors
    /// The law's error in `initialise`.
    pub fn initialise_contacts<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        history.bonded.resize(laws.len(), false);
        for (index, law) in laws.iter().enumerate() {
            // Times are sums of steps, so that comparing at half a step is safe from rounding.
            let reached = |now: f64, time: f64| now > time - 0.5 * info.h;
            let due =
                !history.bonded[index] && law.bonding_time().is_some_and(|t| reached(info.time, t));
            history.bonded[index] |= due;
            let remembers = law.variables_of_contacts() > 0;
            if !due && !remembers && law.healing.is_none() {
                continue;
            }
            let initial = law.initial();
            let memory = &mut network.memory[index];
            let (mut new, mut stretched) = (Vec::new(), Vec::new());
            for (k, contact) in network.contacts.iter_mut().enumerate() {
                if contact.law as usize != index {
                    continue;
                }
                let area = law.area.area(S::D, contact.radius);
                let held = |slot: usize| memory.bonds[slot].intact();
                let intact = contact.memory().is_some_and(held);
                let healed = law.healing.is_some_and(|time| {
                    contact.compression_time > 0.0 && reached(contact.compression_time, time)
                });
                let near = law.bonds_within.is_none_or(|most| contact.gap <= most);
                let may = !intact && !contact.vertex_contact && !contact.beyond && near;
                let bonds = may && (due || healed);
                // The rest position of a new bond: a tension-only bond starts without tension over its gap;
                // one that also pushes yields until the gap is closed. Penetration is included in both, so
                // that a bond is formed without stress.
                let open = law.bond_opening == BondOpening::Gap && contact.gap > 0.0;
                let filled = if law.tension_only() && !open {
                    contact.gap
                } else {
                    contact.gap.min(0.0)
                };
                match contact.memory() {
                    Some(slot) if bonds => {
                        memory.bond(slot, filled, area);
                        // A new bond has no history; the variables of the contact itself are kept.
                        for v in law.variables_of_bonds() {
                            memory.variables[v][slot] = initial[v];
                        }
                    }
                    None if bonds || remembers => {
                        contact.slot = memory.allocate(bonds, filled, area, &initial);
                        new.push(k);
                    }
                    _ => {}
                }
                if let (true, Some(slot)) = (bonds && open, contact.memory()) {
                    memory.bonds[slot].opening_n = contact.gap;
                    stretched.push(k);
                }
                if bonds {
                    network.bonds_formed.push((contact.bodies, contact.law));
                }
                if bonds && contact.broken {
                    contact.broken = false;
                    network.broken_pairs.remove(&contact.key.pair());
                }
            }
            self.initialise(index, law, new, history, network, info)?;
            self.store_initial_energy(index, law, stretched, history, network, info)?;
        }
        Ok(())
    }

    /// Gives bonds that begin open the energy of their opening, which counts as negative fracture energy.
    fn store_initial_energy<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        stretched: Vec<usize>,
        history: &mut LawHistory,
        network: &mut Network<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        let Some(cohesion) = law.cohesion().filter(|_| !stretched.is_empty()) else {
            return Ok(());
        };
        let still = Velocities::still(&network.contacts);
        let source = Source {
            law,
            index,
            network: &*network,
            info,
        };
        let batches = stretched.chunks(any_size(BATCH)).collect();
        let of = |batch: &mut Batch, members: &mut &[usize]| {
            batch.gather_before(&source, members, &still, &[cohesion]);
            batch.columns.damage.fill(0.0);
            let run = batch.run_afresh(cohesion, info, 0.0, Call::Energy);
            run.map_err(|e| locate(law, source.network, members, e))?;
            Ok(batch.columns.out.energy.clone())
        };
        let energies = self.pool.evaluate(false, &mut history.largest, batches, of)?;
        for (at, energy) in stretched.iter().zip(energies.into_iter().flatten()) {
            let contact = &network.contacts[*at];
            let Some(slot) = contact.memory() else {
                continue;
            };
            let bond = &mut network.memory[usize::from(contact.law)].bonds[slot];
            bond.energy = energy * bond.area;
            bond.life.given += bond.energy;
            bond.life.fracture -= bond.energy;
            network.torn_energy -= bond.energy;
        }
        Ok(())
    }

    /// Calls the laws that initialise internal variables, for new contacts.
    fn initialise<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        new: Vec<usize>,
        history: &mut LawHistory,
        network: &mut Network<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        if new.is_empty() || !law.loaded().any(|l| l.plugin.initialises()) {
            return Ok(());
        }
        let still = Velocities::still(&network.contacts);
        let laws: Vec<&Loaded> = law.loaded().collect();
        let source = Source {
            law,
            index,
            network: &*network,
            info,
        };
        let batches = new.chunks(any_size(BATCH)).collect();
        let of = |batch: &mut Batch, members: &mut &[usize]| {
            batch.gather_before(&source, members, &still, &laws);
            for loaded in &laws {
                let run = batch.run_afresh(loaded, info, 0.0, Call::Initialise);
                run.map_err(|e| locate(law, source.network, members, e))?;
            }
            Ok(batch.new_states(&laws))
        };
        let states = self.pool.evaluate(false, &mut history.largest, batches, of)?;
        for (members, states) in new.chunks(any_size(BATCH)).zip(&states) {
            store_states(network, index, &laws, members, states);
        }
        Ok(())
    }
}
