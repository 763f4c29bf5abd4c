//! Commit of bonds: updates openings, damage and energies, and breaks bonds.

use super::batch::{BATCH, LawBatch, locate};
use super::bond_step::{BondStep, degradation_factor};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::{BondAfter, MotionSource, Source, store_states};
use super::history::LawHistory;
use super::interface::{Interface, LoadedLaw};
use super::step_info::StepInfo;
use super::step_result::{MomentStep, SolvedStep, Totals, Velocities};
use crate::contact::{Bond, Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::chunk_size;

/// Approximate time of the laws of a bond (ns).
const BOND: f64 = 100.0;

/// A bond at the end of a step.
struct BondEnd<S: Space> {
    opening: (f64, S::Tangent),
    rotation: S::Spin,
    /// Work done on the bond by opening, by sliding and by rotation (J).
    work: [f64; 3],
    /// Work of the bond's impulse (J).
    given: f64,
    /// Part of that work dissipated by damping and by the time scheme (J); `None` where it follows
    /// from the stored energy, see [`crate::solve::Elastic::lost`].
    lost: Option<f64>,
    /// Energy dissipated by friction against sliding and against rotation (J).
    friction: [f64; 2],
    /// Length of the change of the opening (m).
    slide: f64,
    /// Energy of the undamaged bond per area (J/m^2).
    intact: f64,
    /// The new damage.
    damage: f64,
}

/// The bonds of an interface, and the motion of their contacts.
struct BondOpenings<'a, S: Space> {
    source: Source<'a, S>,
    motion: MotionSource<'a, S>,
    /// Index of the moment of each contact, where the step is solved and bonds resist rotation.
    moment_places: &'a [u32],
}

impl<S: Space> BondOpenings<'_, S> {
    /// Returns the laws that act on bonds.
    fn laws(&self) -> Vec<&LoadedLaw> {
        let law = self.source.law;
        law.cohesion().into_iter().chain(law.damage()).collect()
    }

    /// Returns the moment and spin of a contact that resists rotation.
    fn moment(&self, at: usize) -> Option<&MomentStep<S>> {
        match &self.motion {
            MotionSource::Continued(_) => None,
            MotionSource::Solved(step) => step.moments.get(*self.moment_places.get(at)? as usize),
        }
    }

    /// Returns the spin of a contact that resists rotation, averaged over the step (rad/s).
    fn spin(&self, at: usize) -> Option<S::Spin> {
        match &self.motion {
            MotionSource::Continued(before) => before.turning.get(at).copied(),
            MotionSource::Solved(_) => self.moment(at).map(|m| m.spin),
        }
    }

    /// Returns the bond of a contact at the end of the step, with the damage at its start, as laws
    /// receive it.
    #[inline]
    fn after(
        &self,
        at: usize,
        normal: &S::Vector,
        bond: &Bond<S>,
        rotation: S::Spin,
    ) -> BondAfter<S> {
        let h = self.source.info.h;
        let average = self.motion.average(at);
        let (un, ut) = (normal.dot(&average), S::tangential(normal, &average));
        let mut turned = rotation;
        if self.source.law.rotates()
            && let Some(spin) = self.spin(at)
        {
            turned += spin * h;
        }
        let mut opening = (bond.opening_n, bond.opening_t);
        opening.0 += h * un;
        opening.1 += ut * h;
        BondAfter {
            opening,
            rotation: turned,
            damage: bond.damage,
        }
    }

    /// Returns the bond of a contact at the end of a solved step. Work of the bond's impulse that
    /// is not stored is damping.
    #[inline]
    fn end(
        &self,
        step: &SolvedStep<'_, S>,
        at: usize,
        normal: &S::Vector,
        after: &BondAfter<S>,
    ) -> BondEnd<S> {
        let contact_step = &step.contacts[at];
        let average = &contact_step.average;
        let (un, ut) = (normal.dot(average), S::tangential(normal, average));
        let s = &contact_step.solution;
        let (en, et) = (
            normal.dot(&s.impulse) - s.unilateral_n,
            S::tangential(normal, &s.impulse) - s.unilateral_t,
        );
        let (opens, shears) = (en * un, et.dot(&ut));
        let slips = match step.spring(at) {
            Some(spring) => spring.friction,
            None => -s.unilateral_t.dot(&ut),
        };
        let mut end = BondEnd {
            opening: after.opening,
            rotation: after.rotation,
            work: [opens, shears, 0.0],
            given: opens + shears,
            lost: contact_step.lost,
            friction: [slips, 0.0],
            slide: step.info.h * un.hypot(ut.norm()),
            intact: 0.0,
            damage: 0.0,
        };
        if let Some(moment_step) = self.moment(at) {
            let moment = &moment_step.moment;
            end.work[2] = (moment.moment - moment.friction).dot(&moment_step.spin);
            end.friction[1] = moment.friction.dot(&moment_step.spin);
            end.given += end.work[2];
            end.lost = end.lost.map(|lost| lost + moment_step.lost);
        }
        end
    }
}

impl LawEvaluator {
    /// Completes the step of the intact bonds of one interface.
    pub(super) fn commit_bonds<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        history: &mut LawHistory,
        network: &mut Network<S>,
        step: &SolvedStep<'_, S>,
        totals: &mut Totals,
    ) -> Result<(), LawError> {
        self.place_moments(index, network, step);
        let moment_places = &self.moment_places;
        let laws: Vec<&LoadedLaw> = law.cohesion().into_iter().chain(law.damage()).collect();
        let members = &self.members[index].bonded;
        let divide = self.divides(members.len(), BOND);
        let batches = members.chunks(chunk_size(BATCH)).collect();
        let of = |network: &_, batch: &mut LawBatch, members: &mut &[usize]| {
            let source = Source::new(law, index, network, step.info);
            let opening = BondOpenings {
                source,
                motion: MotionSource::Solved(step),
                moment_places,
            };
            let mut ends = Vec::with_capacity(members.len());
            batch.open_bonds(&opening, members, |at, normal, _, after| {
                ends.push(opening.end(step, at, normal, after));
            })?;
            let given = batch.bond_step.intact.iter().zip(&batch.bond_step.damage);
            for (end, (intact, damage)) in ends.iter_mut().zip(given) {
                (end.intact, end.damage) = (*intact, *damage);
            }
            Ok((ends, batch.new_states(&laws)))
        };
        let take = |network: &mut _, members: &&[usize], (ends, states): (Vec<_>, Vec<_>)| {
            store_states(network, index, &laws, members, &states);
            store_bonds(index, law, network, members, ends, step.predicted, totals);
        };
        let largest = &mut history.largest;
        self.pool
            .evaluate(divide, largest, network, batches, of, take)
    }

    /// Returns the largest increase from the damage used in the step's impulses to the damage that
    /// the resulting openings give; [`LawEvaluator::adopt_trial_damage`] uses the latter in the
    /// next solve. Contacts are as at the last [`Self::select`].
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
            self.place_moments(index, network, step);
            let moment_places = &self.moment_places;
            let members = &self.members[index].bonded;
            let divide = self.divides(members.len(), BOND);
            let trials = &mut self.trials;
            let of = |network: &_, batch: &mut LawBatch, members: &mut &[usize]| {
                let source = Source::new(law, index, network, step.info);
                let opening = BondOpenings {
                    source,
                    motion: MotionSource::Solved(step),
                    moment_places,
                };
                batch.try_damage(&opening, members)
            };
            let take = |network: &mut Network<S>, _: &_, tried: Vec<(u32, f64)>| {
                for (slot, change) in tried {
                    let used = network.memory[index].bonds[slot as usize].step_damage;
                    worst = worst.max(change);
                    trials.push((index, slot as usize, used + change));
                }
            };
            let batches = members.chunks(chunk_size(BATCH)).collect();
            let largest = &mut history.largest;
            self.pool
                .evaluate(divide, largest, network, batches, of, take)?;
        }
        Ok(worst)
    }

    /// Uses the damage of the last trial in the impulses of the next solve.
    pub fn adopt_trial_damage<S: Space>(&mut self, network: &mut Network<S>) {
        for (index, slot, damage) in self.trials.drain(..) {
            network.memory[index].bonds[slot].step_damage = damage;
        }
    }

    /// Finds the moments of each contact, for [`BondOpenings`].
    fn place_moments<S: Space>(
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
}

impl LawBatch {
    /// Returns by how much damage would increase, if the motion at the start of the step continued
    /// through it, over the damage used in the step, by slot.
    pub(super) fn predict_damage<S: Space>(
        &mut self,
        source: &Source<'_, S>,
        members: &[usize],
        before: &Velocities<S>,
    ) -> Result<Vec<(u32, f64)>, LawError> {
        let opening = BondOpenings {
            source: *source,
            motion: MotionSource::Continued(before),
            moment_places: &[],
        };
        self.try_damage(&opening, members)
    }

    /// Returns by how much the damage that the laws give for the bonds of a batch exceeds the
    /// damage used in a step, by slot. Damage does not decrease within a step either, so that the
    /// iteration is monotonic and ends.
    fn try_damage<S: Space>(
        &mut self,
        opening: &BondOpenings<'_, S>,
        members: &[usize],
    ) -> Result<Vec<(u32, f64)>, LawError> {
        let mut tried = Vec::with_capacity(members.len());
        self.open_bonds(opening, members, |_, _, bond, _| {
            tried.push((0, bond.step_damage));
        })?;
        let given = self.slots.iter().zip(&self.bond_step.damage);
        for (place, (slot, damage)) in tried.iter_mut().zip(given) {
            *place = (*slot, (damage - place.1).max(0.0));
        }
        Ok(tried)
    }

    /// Computes the damage of the bonds of a batch at their openings at the end of the step; `each`
    /// receives the contact, its normal, and its bond before and after the step.
    fn open_bonds<S: Space>(
        &mut self,
        opening: &BondOpenings<'_, S>,
        members: &[usize],
        mut each: impl FnMut(usize, &S::Vector, &Bond<S>, &BondAfter<S>),
    ) -> Result<(), LawError> {
        let Source {
            law, network, info, ..
        } = opening.source;
        self.fill(
            &opening.source,
            members,
            &opening.laws(),
            true,
            |at, contact, bond, rotation| {
                let after = match bond {
                    Some(bond) => {
                        let after = opening.after(at, &contact.normal, bond, rotation);
                        each(at, &contact.normal, bond, &after);
                        after
                    }
                    None => BondAfter::of(None, rotation),
                };
                opening.motion.after(at, contact, after)
            },
        );
        let mut bond_step = std::mem::take(&mut self.bond_step);
        let updated = self.update_damage(law, info, &mut bond_step);
        self.bond_step = bond_step;
        updated.map_err(|e| locate(law, network, members, e))
    }

    /// Computes damage at the current openings as the larger of the values of the cohesion law and
    /// of the damage law.
    pub(super) fn update_damage(
        &mut self,
        law: &Interface,
        info: &StepInfo,
        bond_step: &mut BondStep,
    ) -> Result<(), LawError> {
        let Some(cohesion) = law.cohesion() else {
            return Ok(());
        };
        bond_step.damage.clone_from(&self.columns.damage);
        let m = cohesion.plugin.degradation;
        // The stored energy of the damaged bond is psi = (1 - D)^m psi_0, with psi_0 of the
        // undamaged one.
        if law.damages() {
            self.columns.damage.fill(0.0);
        }
        self.run_afresh(cohesion, info, 0.0, Call::Energy)?;
        bond_step.intact.clone_from(&self.columns.out.energy);
        if law.damage().is_some() {
            self.run_afresh(cohesion, info, 0.0, Call::Prepare)?;
        }
        self.columns.damage.clone_from(&bond_step.damage);
        if cohesion.plugin.commits() {
            self.columns.out.damage.clone_from(&bond_step.damage);
            self.run(cohesion, info, 0.0, Call::Commit)?;
            if law.damages() {
                raise(&mut bond_step.damage, &self.columns.out.damage);
            }
        } else {
            self.columns.out.damage.fill(0.0);
        }
        if let Some(damage) = law.damage() {
            // The damage law receives traction and energy of the undamaged bond.
            self.columns.expose_intact();
            self.run(damage, info, m, Call::Commit)?;
            raise(&mut bond_step.damage, &self.columns.out.damage);
        }
        Ok(())
    }
}

/// Stores openings, damage and energies of bonds; breaks fully damaged ones.
fn store_bonds<S: Space>(
    index: usize,
    law: &Interface,
    network: &mut Network<S>,
    members: &[usize],
    ends: Vec<BondEnd<S>>,
    predicted: bool,
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
    for (at, end) in members.iter().zip(ends) {
        let contact = &mut network.contacts[*at];
        let Some(slot) = contact.memory() else {
            continue;
        };
        let memory = &mut network.memory[index];
        let bond = &mut memory.bonds[slot];
        (bond.opening_n, bond.opening_t) = end.opening;
        bond.energies.work[0] -= end.work[0];
        bond.energies.work[1] -= end.work[1];
        bond.energies.friction += end.friction[0];
        if memory.rotates {
            memory.rotations[slot] = end.rotation;
            bond.energies.work[2] -= end.work[2];
            bond.energies.friction -= end.friction[1];
        }
        let mut damage = end.damage;
        if !predicted {
            damage = damage.max(bond.step_damage);
        }
        if network.cycle_multiplier != 1.0 {
            damage = (bond.damage + network.cycle_multiplier * (damage - bond.damage)).min(1.0);
        }
        let intact = end.intact * bond.area;
        // The impulses were computed with D = `step_damage`: the stored energy at that damage, at
        // start and end of the step.
        let (start, stop) = if bond.step_damage == bond.damage {
            (bond.energy, intact * share(bond.damage))
        } else {
            let ratio = share(bond.step_damage) / share(bond.damage);
            (bond.energy * ratio, intact * share(bond.step_damage))
        };
        // Where the loss is computed separately, a wrong energy of the law appears in the residual.
        let viscous = end.lost.unwrap_or(-end.given - (stop - start));
        let kept = if damage >= 1.0 {
            0.0
        } else {
            intact * share(damage)
        };
        let fracture = (bond.energy - start) + (stop - kept);
        totals.viscous += viscous;
        totals.fracture += fracture;
        bond.energies.viscous += viscous;
        bond.energies.fracture += fracture;
        if let Some(dissipation) = &mut network.dissipation {
            dissipation[*at].viscous += viscous;
            dissipation[*at].fracture += fracture;
        }
        let damage_before = bond.damage;
        bond.energy = kept;
        bond.damage = damage;
        bond.step_damage = damage;
        memory.slides.add(end.slide, fracture);
        if damage >= 1.0 {
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

/// Raises the damage where the new value is larger; damage never decreases.
fn raise(damage: &mut [f64], new: &[f64]) {
    for (old, new) in damage.iter_mut().zip(new) {
        *old = old.max(*new).min(1.0);
    }
}

#[cfg(test)]
mod tests;
