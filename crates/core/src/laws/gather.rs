//! Fills the columns of a batch from the network.

use super::batch::LawBatch;
use super::columns::Contents;
use super::interface::{Interface, LoadedLaw};
use super::step_info::StepInfo;
use super::step_result::{SolvedStep, Velocities};
use crate::contact::{Bond, Contact, Memory, Network};
use crate::geometry::space::{Space, VectorLike};

/// Contacts of one interface, whose columns are filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a, S: Space> {
    pub law: &'a Interface,
    /// Index of the interface.
    pub index: usize,
    pub network: &'a Network<S>,
    pub info: &'a StepInfo,
}

impl<'a, S: Space> Source<'a, S> {
    pub fn new(
        law: &'a Interface,
        index: usize,
        network: &'a Network<S>,
        info: &'a StepInfo,
    ) -> Self {
        Self {
            law,
            index,
            network,
            info,
        }
    }
}

/// Source of the motion of contacts in a step.
#[derive(Debug)]
pub(super) enum MotionSource<'a, S: Space> {
    /// The motion at the start of the step continues through it, with the impulses and springs of
    /// the last step, as an estimate of the load before the step is solved. Contacts that are new
    /// in this step carry no load.
    Continued(&'a Velocities<S>),
    /// The motion computed by the solver.
    Solved(&'a SolvedStep<'a, S>),
}

impl<S: Space> MotionSource<'_, S> {
    /// Returns the theta-averaged relative velocity of a contact (m/s).
    #[inline]
    pub fn average(&self, at: usize) -> S::Vector {
        match self {
            Self::Continued(before) => before.relative[at],
            Self::Solved(step) => step.contacts[at].average,
        }
    }

    /// Returns the values that laws receive for a contact at the end of the step.
    #[inline]
    pub fn after(&self, at: usize, contact: &Contact<S>, bond: BondAfter<S>) -> Values<S> {
        let mut values = Values {
            velocity: self.average(at),
            impulse: contact.impulse,
            opening: bond.opening,
            rotation: bond.rotation,
            damage: bond.damage,
            overlap: contact.spring.overlap,
            effective_mass: 0.0,
            spring: contact.spring.force_t,
            spring_before: contact.spring.force_t,
        };
        match self {
            Self::Continued(before) => {
                if let Some(overlap) = before.overlap.get(at) {
                    values.overlap = *overlap;
                }
            }
            Self::Solved(step) => {
                values.impulse = step.contacts[at].solution.impulse;
                if let Some(step) = step.spring(at) {
                    values.overlap = step.spring.overlap;
                    values.spring = step.spring.force_t;
                    values.spring_before = step.force_before;
                }
            }
        }
        values
    }
}

/// A bond at the end of a step; without a bond all values are zero, except the damage.
#[derive(Debug)]
pub(super) struct BondAfter<S: Space> {
    pub opening: (f64, S::Tangent),
    pub rotation: S::Spin,
    pub damage: f64,
}

impl<S: Space> BondAfter<S> {
    /// Returns the bond of a contact in its current state.
    #[inline]
    pub fn of(bond: Option<&Bond<S>>, rotation: S::Spin) -> Self {
        match bond {
            Some(bond) => Self {
                opening: (bond.opening_n, bond.opening_t),
                rotation,
                damage: bond.damage,
            },
            None => Self {
                opening: (0.0, S::Tangent::zero()),
                rotation,
                damage: 1.0,
            },
        }
    }
}

/// Values of a contact in the columns, in addition to geometry and age.
#[derive(Debug)]
pub(super) struct Values<S: Space> {
    pub velocity: S::Vector,
    pub impulse: S::Vector,
    pub opening: (f64, S::Tangent),
    pub rotation: S::Spin,
    pub damage: f64,
    pub overlap: f64,
    pub effective_mass: f64,
    pub spring: S::Tangent,
    pub spring_before: S::Tangent,
}

/// Number of contacts by which the prefetch of bonds is ahead: bonds are stored in the order in
/// which they formed.
pub(super) const AHEAD: usize = 8;

/// Prefetches the data of a contact's bond that laws read.
#[inline(always)]
pub(super) fn prefetch_bond<S: Space>(memory: &Memory<S>, contact: &Contact<S>) {
    #[cfg(target_arch = "x86_64")]
    if let Some(bond) = memory.bonds.get(contact.slot as usize) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: prefetching has no effect on memory.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(bond).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (memory, contact);
}

impl LawBatch {
    /// Fills the columns with the state at the start of the step: the damage is the one used in the
    /// step's impulses.
    pub(super) fn gather_before<S: Space>(
        &mut self,
        source: &Source<'_, S>,
        members: &[usize],
        before: &Velocities<S>,
        laws: &[&LoadedLaw],
    ) {
        let compliant = source.law.compliant();
        self.fill(
            source,
            members,
            laws,
            false,
            |at, contact, bond, rotation| {
                let bond = BondAfter {
                    damage: bond.map_or(1.0, |b| b.step_damage),
                    ..BondAfter::of(bond, rotation)
                };
                let of_springs = |list: &[f64]| if compliant { list[at] } else { 0.0 };
                Values {
                    velocity: before.relative[at],
                    impulse: contact.impulse,
                    opening: bond.opening,
                    rotation: bond.rotation,
                    damage: bond.damage,
                    overlap: of_springs(&before.overlap),
                    effective_mass: of_springs(&before.effective_mass),
                    spring: contact.spring.force_t,
                    spring_before: contact.spring.force_t,
                }
            },
        );
    }

    /// Fills the columns with the state at the end of the step: u_th and the impulses of the step,
    /// with the bonds of the network.
    pub(super) fn gather_after<S: Space>(
        &mut self,
        source: &Source<'_, S>,
        members: &[usize],
        motion: &MotionSource<'_, S>,
        laws: &[&LoadedLaw],
    ) {
        self.fill(
            source,
            members,
            laws,
            true,
            |at, contact, bond, rotation| motion.after(at, contact, BondAfter::of(bond, rotation)),
        );
    }

    /// Fills the columns with the values that `of` gives for each member, its bond and the rotation
    /// of its bond at the start of the step, and with the internal variables of some laws.
    #[inline]
    pub(super) fn fill<S: Space>(
        &mut self,
        source: &Source<'_, S>,
        members: &[usize],
        laws: &[&LoadedLaw],
        after: bool,
        mut of: impl FnMut(usize, &Contact<S>, Option<&Bond<S>>, S::Spin) -> Values<S>,
    ) {
        let Source {
            law,
            index,
            network,
            info,
        } = *source;
        let read = laws.iter().any(|l| l.reads_temperatures());
        let thermal = network.thermal.as_ref().filter(|_| read);
        let contents = Contents {
            spatial: S::D == 3,
            rotates: law.rotates(),
            compliant: law.compliant(),
            after,
            heat: thermal.is_some(),
            current: thermal.is_some_and(|t| t.current),
        };
        let n = members.len();
        let memory = &network.memory[index];
        let Self {
            columns,
            open_gap,
            spring_gap,
            slots,
            ..
        } = self;
        columns.begin(n, contents);
        open_gap.resize(n, 0.0);
        spring_gap.resize(n, 0.0);
        slots.resize(n, 0);
        let (open_gap, spring_gap, slots) =
            (&mut open_gap[..n], &mut spring_gap[..n], &mut slots[..n]);
        let (gap, area, radius) = (
            &mut columns.gap[..n],
            &mut columns.area[..n],
            &mut columns.radius[..n],
        );
        let (age, compression_time, damage) = (
            &mut columns.age[..n],
            &mut columns.compression_time[..n],
            &mut columns.damage[..n],
        );
        let [opening_n, opening_t1, opening_t2] = &mut columns.opening;
        let [velocity_n, velocity_t1, velocity_t2] = &mut columns.velocity;
        let [impulse_n, impulse_t1, impulse_t2] = &mut columns.impulse;
        let (opening_n, opening_t1) = (&mut opening_n[..n], &mut opening_t1[..n]);
        let (velocity_n, velocity_t1) = (&mut velocity_n[..n], &mut velocity_t1[..n]);
        let (impulse_n, impulse_t1) = (&mut impulse_n[..n], &mut impulse_t1[..n]);
        for (k, at) in members.iter().enumerate() {
            if let Some(ahead) = members.get(k + AHEAD) {
                prefetch_bond(memory, &network.contacts[*ahead]);
            }
            let contact = &network.contacts[*at];
            let (bond, rotation) = match contact.memory() {
                Some(slot) if contents.rotates => {
                    (Some(&memory.bonds[slot]), memory.rotations[slot])
                }
                Some(slot) => (Some(&memory.bonds[slot]), S::Spin::zero()),
                None => (None, S::Spin::zero()),
            };
            slots[k] = contact.slot;
            let filled = bond.filter(|b| b.intact()).map_or(0.0, |b| b.gap);
            open_gap[k] = contact.gap - filled;
            spring_gap[k] = contact.gap - filled.max(0.0);
            gap[k] = contact.gap;
            area[k] = match bond {
                Some(bond) => bond.area,
                None => law.area.area(S::D, contact.radius),
            };
            radius[k] = contact.radius;
            age[k] = info.time - contact.formed_at;
            compression_time[k] = contact.compression_time;
            let values = of(*at, contact, bond, rotation);
            let n = &contact.normal;
            damage[k] = values.damage;
            let [t1, t2] = S::components(n, &values.opening.1);
            (opening_n[k], opening_t1[k]) = (values.opening.0, t1);
            let [v1, v2] = S::components(n, &S::tangential(n, &values.velocity));
            (velocity_n[k], velocity_t1[k]) = (n.dot(&values.velocity), v1);
            let [p1, p2] = S::components(n, &S::tangential(n, &values.impulse));
            (impulse_n[k], impulse_t1[k]) = (n.dot(&values.impulse), p1);
            if S::D == 3 {
                (opening_t2[k], velocity_t2[k], impulse_t2[k]) = (t2, v2, p2);
            }
            if contents.rotates {
                let rotation = S::spin_components(n, &values.rotation);
                for (column, x) in columns.rotation.iter_mut().zip(rotation) {
                    column[k] = x;
                }
            }
            if contents.compliant {
                columns.overlap[k] = values.overlap;
                columns.effective_mass[k] = values.effective_mass;
                let force = S::components(n, &values.spring);
                for (column, x) in columns.spring.iter_mut().zip(force) {
                    column[k] = x;
                }
                if after {
                    let force = S::components(n, &values.spring_before);
                    for (column, x) in columns.spring_before.iter_mut().zip(force) {
                        column[k] = x;
                    }
                }
            }
        }
        if let Some(thermal) = thermal {
            columns.take_heat(thermal, members);
        }
        for loaded in laws {
            for v in loaded.first_variable..loaded.first_variable + loaded.variables() {
                let values = &memory.variables[v];
                let [state, next] = columns.fit_state(v);
                for (x, slot) in state.iter_mut().zip(&*slots) {
                    *x = match *slot {
                        Contact::<S>::NO_MEMORY => 0.0,
                        slot => values[slot as usize],
                    };
                }
                next.copy_from_slice(state);
            }
        }
    }

    /// Returns the new internal variables of some laws, one column after the other.
    pub(super) fn new_states(&self, laws: &[&LoadedLaw]) -> Vec<f64> {
        let count: usize = laws.iter().map(|l| l.variables()).sum();
        let mut states = Vec::with_capacity(count * self.columns.n);
        for loaded in laws {
            let columns = self.columns.state_next.iter().skip(loaded.first_variable);
            for column in columns.take(loaded.variables()) {
                states.extend_from_slice(column);
            }
        }
        states
    }
}

/// Stores the new internal variables of some laws for contacts of one interface, as
/// [`LawBatch::new_states`] gives them.
pub(super) fn store_states<S: Space>(
    network: &mut Network<S>,
    index: usize,
    laws: &[&LoadedLaw],
    members: &[usize],
    states: &[f64],
) {
    let Network {
        contacts, memory, ..
    } = network;
    let mut columns = states.chunks_exact(members.len().max(1));
    for loaded in laws {
        for v in loaded.first_variable..loaded.first_variable + loaded.variables() {
            let Some(column) = columns.next() else { return };
            let stored = &mut memory[index].variables[v];
            for (at, x) in members.iter().zip(column) {
                if let Some(slot) = contacts[*at].memory() {
                    stored[slot] = *x;
                }
            }
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
