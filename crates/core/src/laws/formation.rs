//! Formation of bonds, and memory for the internal variables of new contacts.

use super::batch::{BATCH, LawBatch, locate};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::{Source, store_states};
use super::history::LawHistory;
use super::interface::{BondOpening, Interface, LoadedLaw};
use super::step_info::StepInfo;
use super::step_result::Velocities;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::threads::{chunk_size, map_chunks, worth_dividing};

/// Number of contacts of a task.
const CHUNK: usize = 4096;
/// Approximate time to check whether a contact is new (ns).
const LOOK: f64 = 4.0;

impl LawEvaluator {
    /// Allocates internal variables of contacts and forms bonds: by the case's bond rule, and by
    /// compression time (healing).
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
        // Times are sums of steps, so that comparing at half a step is safe from rounding.
        let reached = |now: f64, time: f64| now > time - 0.5 * info.h;
        let due = |index: usize| {
            let time = laws[index].bonding_time();
            !history.bonded[index] && time.is_some_and(|t| reached(info.time, t))
        };
        let due: Vec<bool> = (0..laws.len()).map(due).collect();
        let concerned = self.find_concerned(laws, &due, network);
        for (index, law) in laws.iter().enumerate() {
            let due = due[index];
            history.bonded[index] |= due;
            let concerned = &concerned[index];
            if concerned.is_empty() {
                continue;
            }
            let remembers = law.variables_of_contacts() > 0;
            let initial = law.initial();
            let memory = &mut network.memory[index];
            let (mut new, mut stretched) = (Vec::new(), Vec::new());
            for &k in concerned {
                let contact = &mut network.contacts[k];
                let area = law.area.area(S::D, contact.radius);
                let held = |slot: usize| memory.bonds[slot].intact();
                let intact = contact.memory().is_some_and(held);
                let healed = law.healing.is_some_and(|time| {
                    contact.compression_time > 0.0 && reached(contact.compression_time, time)
                });
                let near = law.bonds_within.is_none_or(|most| contact.gap <= most);
                let may = !intact && !contact.vertex_contact && !contact.beyond && near;
                let bonds = may && (due || healed);
                // The rest position of a new bond: a bond in tension only starts without tension
                // over its gap; one that also pushes yields until the gap is closed. Penetration is
                // included in both cases, so that a bond is formed without stress.
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

    /// Returns, for each interface, the contacts that may become bonds, and the contacts without
    /// memory that need internal variables.
    fn find_concerned<S: Space>(
        &self,
        laws: &[Interface],
        due: &[bool],
        network: &Network<S>,
    ) -> Vec<Vec<usize>> {
        #[derive(Clone, Copy, PartialEq)]
        enum InitialisedContacts {
            None,
            New,
            All,
        }
        let both = laws.iter().zip(due);
        let of_laws: Vec<InitialisedContacts> = both
            .map(|(law, due)| {
                if *due || law.healing.is_some() {
                    InitialisedContacts::All
                } else if law.variables_of_contacts() > 0 {
                    InitialisedContacts::New
                } else {
                    InitialisedContacts::None
                }
            })
            .collect();
        let mut concerned = vec![Vec::new(); laws.len()];
        if of_laws.iter().all(|law| *law == InitialisedContacts::None) {
            return concerned;
        }
        let divide = worth_dividing(self.parallel, network.contacts.len(), LOOK);
        let parts = map_chunks(divide, &network.contacts, CHUNK, |first, contacts| {
            let contacts = contacts.iter().zip(first..);
            let found = contacts.filter(|(contact, _)| match of_laws[contact.law as usize] {
                InitialisedContacts::None => false,
                InitialisedContacts::New => contact.memory().is_none(),
                InitialisedContacts::All => true,
            });
            let found = found.map(|(contact, k)| (contact.law as usize, k));
            found.collect::<Vec<_>>()
        });
        for (law, k) in parts.into_iter().flatten() {
            concerned[law].push(k);
        }
        concerned
    }

    /// Gives bonds that begin open the energy of their opening, which counts as negative fracture
    /// energy.
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
        let still = Velocities::at_rest(&network.contacts);
        let batches = stretched.chunks(chunk_size(BATCH)).collect();
        let of = |network: &_, batch: &mut LawBatch, members: &mut &[usize]| {
            let source = Source::new(law, index, network, info);
            batch.gather_before(&source, members, &still, &[cohesion]);
            batch.columns.damage.fill(0.0);
            let run = batch.run_afresh(cohesion, info, 0.0, Call::Energy);
            run.map_err(|e| locate(law, network, members, e))?;
            Ok(batch.columns.out.energy.clone())
        };
        let take = |network: &mut Network<S>, members: &&[usize], energies: Vec<f64>| {
            for (at, energy) in members.iter().zip(energies) {
                let contact = &network.contacts[*at];
                let Some(slot) = contact.memory() else {
                    continue;
                };
                let bond = &mut network.memory[index].bonds[slot];
                bond.energy = energy * bond.area;
                bond.energies.given += bond.energy;
                bond.energies.fracture -= bond.energy;
                network.torn_energy -= bond.energy;
            }
        };
        let largest = &mut history.largest;
        self.pool
            .evaluate(false, largest, network, batches, of, take)
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
        let still = Velocities::at_rest(&network.contacts);
        let laws: Vec<&LoadedLaw> = law.loaded().collect();
        let batches = new.chunks(chunk_size(BATCH)).collect();
        let of = |network: &_, batch: &mut LawBatch, members: &mut &[usize]| {
            let source = Source::new(law, index, network, info);
            batch.gather_before(&source, members, &still, &laws);
            for loaded in &laws {
                let run = batch.run_afresh(loaded, info, 0.0, Call::Initialise);
                run.map_err(|e| locate(law, network, members, e))?;
            }
            Ok(batch.new_states(&laws))
        };
        let take = |network: &mut _, members: &&[usize], states: Vec<f64>| {
            store_states(network, index, &laws, members, &states);
        };
        let largest = &mut history.largest;
        self.pool
            .evaluate(false, largest, network, batches, of, take)
    }
}
