//! Commit of bonds: updates openings, damage and energies, and breaks bonds.

use super::columns::StepInfo;
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::history::LawHistory;
use super::interface::Interface;
use super::library::Call;
use super::step_result::{SolvedStep, Totals, Velocities};
use crate::contact::{Contact, Memory, Network};
use crate::geometry::space::{Space, VectorLike};

/// State of the bonds after a step, in the order of the batch members.
#[derive(Debug, Default)]
pub(super) struct BondStep {
    /// Work done by the bond's impulse over the step (J).
    work: Vec<f64>,
    /// Part of it dissipated by damping and by the time scheme (J).
    lost: Vec<f64>,
    /// Whether the tension-only normal part was switched on or off within the step.
    turned: Vec<bool>,
    /// Length of the change of the opening (m).
    slide: Vec<f64>,
    /// Energy of the undamaged bond per area at the new opening (J/m^2).
    intact: Vec<f64>,
    /// The new damage.
    pub damage: Vec<f64>,
}

impl BondStep {
    /// Energy per area stored at the new opening and damage (J/m^2).
    pub fn stored(&self, law: &Interface, k: usize) -> f64 {
        let m = law.cohesion().map_or(0.0, |c| c.plugin.degradation);
        let share = if law.damages() {
            degradation_factor(self.damage[k], m)
        } else {
            1.0
        };
        share * self.intact[k]
    }
}

impl LawEvaluator {
    /// Completes the step of the intact bonds of one interface, given as members.
    pub(super) fn commit_bonds<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        let mut bond_step = self.open_bonds(index, law, history, network, step)?;
        for (at, damage) in self.members.iter().zip(&mut bond_step.damage) {
            let bond = network.bond(&network.contacts[*at]);
            let (before, used) = bond.map_or((0.0, 0.0), |b| (b.damage, b.step_damage));
            if !step.predicted {
                *damage = damage.max(used);
            }
            if network.cycle_multiplier != 1.0 {
                *damage = (before + network.cycle_multiplier * (*damage - before)).min(1.0);
            }
        }
        self.store_variables(index, network);
        self.store_damage(index, law, network, &bond_step, totals);
        self.bond_step = bond_step;
        Ok(())
    }

    /// Returns the largest increase from the damage used in the step's impulses to the damage that the
    /// resulting openings give; [`LawEvaluator::adopt_trial_damage`] takes the latter for the next solve.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn trial_damage<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
    ) -> Result<f64, LawError> {
        let mut worst = 0.0f64;
        self.trials.clear();
        for (index, law) in laws.iter().enumerate().filter(|(_, l)| l.damages()) {
            self.select(network, |c| {
                c.law as usize == index && network.bond(c).is_some_and(|b| b.intact())
            });
            if self.members.is_empty() {
                continue;
            }
            let before = network.memory[index].clone_openings();
            self.place_moments(index, network, step);
            let tried = self.in_batches(|batch| {
                let bond_step = batch.open_bonds(index, law, history, network, step)?;
                for (k, at) in batch.members.iter().enumerate() {
                    let Some(slot) = network.contacts[*at].memory() else {
                        continue;
                    };
                    let bond = &network.memory[index].bonds[slot];
                    // Damage does not decrease within a step either, so that the iteration is monotonic and
                    // ends.
                    let change = (bond_step.damage[k] - bond.step_damage).max(0.0);
                    worst = worst.max(change);
                    let next = bond.step_damage + change;
                    batch.trials.push((index, slot, next));
                }
                batch.bond_step = bond_step;
                Ok(())
            });
            network.memory[index].restore_openings(before);
            tried?;
        }
        Ok(worst)
    }

    /// Uses in the step, for every intact bond, the mean of its damage and of the damage that the law gives for the opening
    /// which the motion at the start of the step leads to.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn predict_damage<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        before: &Velocities<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        if !laws.iter().any(Interface::damages) {
            return Ok(());
        }
        let (contacts, moments) = before.continued();
        let step = SolvedStep {
            contacts: &contacts,
            springs: &[],
            moments: &moments,
            info,
            predicted: true,
        };
        self.trial_damage(laws, history, network, &step)?;
        for (index, slot, damage) in self.trials.drain(..) {
            let bond = &mut network.memory[index].bonds[slot];
            bond.step_damage = 0.5 * (bond.damage + damage);
        }
        Ok(())
    }

    /// Uses the damage of the last trial in the impulses of the next solve.
    pub fn adopt_trial_damage<S: Space>(&mut self, network: &mut Network<S>) {
        for (index, slot, damage) in self.trials.drain(..) {
            network.memory[index].bonds[slot].step_damage = damage;
        }
    }

    /// Finds the moments of each contact, for [`Self::open_bonds`].
    pub(super) fn place_moments<S: Space>(
        &mut self,
        index: usize,
        network: &Network<S>,
        step: &SolvedStep<'_, S>,
    ) {
        self.moment_places.clear();
        if !network.memory[index].rotates {
            return;
        }
        self.moment_places.resize(network.contacts.len(), u32::MAX);
        for (k, moment_step) in step.moments.iter().enumerate() {
            self.moment_places[moment_step.moment.contact as usize] = k as u32;
        }
    }

    /// Updates the openings of the bonds of one interface with the motion of the step, and computes the damage that they give.
    fn open_bonds<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
    ) -> Result<BondStep, LawError> {
        let mut bond_step = std::mem::take(&mut self.bond_step);
        self.update_openings(index, law, network, step, &mut bond_step);
        self.gather_after(law, network, step);
        self.update_damage(law, history, step.info, &mut bond_step)
            .map_err(|e| self.locate(law, network, e))?;
        Ok(bond_step)
    }

    /// Computes damage at the current openings as the maximum of the cohesion law's and the damage law's
    /// value.
    pub(super) fn update_damage(
        &mut self,
        law: &Interface,
        history: &mut LawHistory,
        info: &StepInfo,
        bond_step: &mut BondStep,
    ) -> Result<(), LawError> {
        let Some(cohesion) = law.cohesion() else {
            return Ok(());
        };
        self.columns.size_outputs();
        bond_step.damage.clone_from(&self.columns.damage);
        let m = cohesion.plugin.degradation;
        // The stored energy of the damaged bond is psi = (1 - D)^m psi_0, with psi_0 of the undamaged one.
        if law.damages() {
            self.columns.damage.fill(0.0);
        }
        self.run(cohesion, history, info, 0.0, Call::Energy)?;
        bond_step.intact.clone_from(&self.columns.out.energy);
        if law.damage().is_some() {
            self.run(cohesion, history, info, 0.0, Call::Prepare)?;
        }
        self.columns.damage.clone_from(&bond_step.damage);
        if cohesion.plugin.commits() {
            self.columns.out.damage.clone_from(&bond_step.damage);
            self.run(cohesion, history, info, 0.0, Call::Commit)?;
            if law.damages() {
                raise(&mut bond_step.damage, &self.columns.out.damage);
            }
        }
        if let Some(damage) = law.damage() {
            // The damage law sees what the undamaged bond would carry and store.
            self.columns.expose_intact();
            self.run(damage, history, info, m, Call::Commit)?;
            raise(&mut bond_step.damage, &self.columns.out.damage);
        }
        Ok(())
    }

    /// Updates the openings. Work of the bond's impulse that is not stored is damping.
    fn update_openings<S: Space>(
        &self,
        index: usize,
        law: &Interface,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
        bond_step: &mut BondStep,
    ) {
        let (works, lost, turned, slides) = (
            &mut bond_step.work,
            &mut bond_step.lost,
            &mut bond_step.turned,
            &mut bond_step.slide,
        );
        works.clear();
        lost.clear();
        turned.clear();
        slides.clear();
        let Network {
            contacts, memory, ..
        } = network;
        let memory = &mut memory[index];
        for at in &self.members {
            let (contact, contact_step) = (&contacts[*at], &step.contacts[*at]);
            let Some(slot) = contact.memory() else {
                works.push(0.0);
                lost.push(0.0);
                turned.push(false);
                slides.push(0.0);
                continue;
            };
            let bond = &mut memory.bonds[slot];
            let n = &contact.normal;
            let (un, ut) = (
                n.dot(&contact_step.average),
                S::tangential(n, &contact_step.average),
            );
            let before = bond.opening_n;
            bond.opening_n += step.info.h * un;
            // A tension-only bond is not linear across zero opening; its energy there depends on the step.
            turned.push(law.tension_only() && (before > 0.0) != (bond.opening_n > 0.0));
            lost.push(contact_step.lost);
            bond.opening_t += ut * step.info.h;
            slides.push(step.info.h * un.hypot(ut.norm()));
            let s = &contact_step.solution;
            let (en, et) = (
                n.dot(&s.impulse) - s.unilateral_n,
                S::tangential(n, &s.impulse) - s.unilateral_t,
            );
            let (opens, shears) = (en * un, et.dot(&ut));
            bond.life.work[0] -= opens;
            bond.life.work[1] -= shears;
            bond.life.friction += match step.spring(*at) {
                Some(spring) => spring.friction,
                None => -s.unilateral_t.dot(&ut),
            };
            works.push(opens + shears);
        }
        if memory.rotates {
            self.update_rotations(contacts, memory, step, works, lost);
        }
    }

    /// Updates the rotations of the bonds of one interface, and adds the work of their moments.
    fn update_rotations<S: Space>(
        &self,
        contacts: &[Contact<S>],
        memory: &mut Memory<S>,
        step: &SolvedStep<'_, S>,
        works: &mut [f64],
        lost: &mut [f64],
    ) {
        for (at, (work, lost)) in self.members.iter().zip(works.iter_mut().zip(lost)) {
            let (Some(moment_step), Some(slot)) = (
                step.moments.get(self.moment_places[*at] as usize),
                contacts[*at].memory(),
            ) else {
                continue;
            };
            memory.rotations[slot] += moment_step.spin * step.info.h;
            let turned =
                (moment_step.moment.moment - moment_step.moment.friction).dot(&moment_step.spin);
            let life = &mut memory.bonds[slot].life;
            life.work[2] -= turned;
            life.friction -= moment_step.moment.friction.dot(&moment_step.spin);
            *work += turned;
            *lost += moment_step.lost;
        }
    }

    /// Stores damage and energy; breaks fully damaged bonds.
    fn store_damage<S: Space>(
        &self,
        index: usize,
        law: &Interface,
        network: &mut Network<S>,
        bond_step: &BondStep,
        totals: &mut Totals,
    ) {
        let m = law.cohesion().map_or(0.0, |c| c.plugin.degradation);
        let damages = law.damages();
        let share = |damage: f64| {
            if damages {
                degradation_factor(damage, m)
            } else {
                1.0
            }
        };
        for (k, at) in self.members.iter().enumerate() {
            let contact = &mut network.contacts[*at];
            let Some(slot) = contact.memory() else {
                continue;
            };
            let memory = &mut network.memory[index];
            let bond = &mut memory.bonds[slot];
            let intact = bond_step.intact[k] * bond.area;
            // The impulses were computed with D = `step_damage`: the stored energy at that damage, at start and end
            // of the step.
            let (start, end) = if bond.step_damage == bond.damage {
                (bond.energy, intact * share(bond.damage))
            } else {
                let ratio = share(bond.step_damage) / share(bond.damage);
                (bond.energy * ratio, intact * share(bond.step_damage))
            };
            // Where the energy is defined by the law, any imbalance appears in the residual.
            let viscous = if bond_step.turned[k] {
                -bond_step.work[k] - (end - start)
            } else {
                bond_step.lost[k]
            };
            let kept = if bond_step.damage[k] >= 1.0 {
                0.0
            } else {
                intact * share(bond_step.damage[k])
            };
            let fracture = (bond.energy - start) + (end - kept);
            totals.viscous += viscous;
            totals.fracture += fracture;
            bond.life.viscous += viscous;
            bond.life.fracture += fracture;
            if let Some(dissipation) = &mut network.dissipation {
                dissipation[*at].viscous += viscous;
                dissipation[*at].fracture += fracture;
            }
            let damage_before = bond.damage;
            bond.energy = kept;
            bond.damage = bond_step.damage[k];
            bond.step_damage = bond.damage;
            memory.slides.add(bond_step.slide[k], fracture);
            if bond_step.damage[k] >= 1.0 {
                totals.broken += 1;
                memory.broken += 1;
                contact.broken = true;
                contact.compression_time = 0.0;
                network.broken_pairs.insert(contact.key.pair());
                let contact = contact.clone();
                network.record_break(&contact, damage_before);
                if law.variables() == 0 {
                    network.memory[index].release(slot as u32);
                    network.contacts[*at].slot = Contact::<S>::NO_MEMORY;
                }
            }
        }
    }
}

/// Raises the damage where the new value is larger; damage never decreases.
fn raise(damage: &mut [f64], new: &[f64]) {
    for (old, new) in damage.iter_mut().zip(new) {
        *old = old.max(*new).min(1.0);
    }
}

/// (1 - D)^m.
fn degradation_factor(damage: f64, m: f64) -> f64 {
    let intact = 1.0 - damage;
    if m == 1.0 {
        intact
    } else if m == 2.0 {
        intact * intact
    } else {
        intact.powf(m)
    }
}
