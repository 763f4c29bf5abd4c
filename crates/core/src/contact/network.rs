//! Contacts of the current step and what carries over from the last one.

use super::events::{Break, ContactDissipation, Loss};
use super::memory::{BondState, Memory};
use super::step_size::StepSizeDiagnostics;
use crate::bodies::Bodies;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Serialize, Serializer};
use std::collections::{BTreeMap, HashSet};

/// The name of a contact, stable in time: candidate (a ball, or a convex piece with [`Key::PIECE`] set),
/// antagonist (the same, or a surface with [`Key::SURFACE`] set) and the face, edge or vertex that is
/// touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Key {
    /// Index of the candidate.
    pub candidate: u32,
    /// Index of the antagonist.
    pub antagonist: u32,
    /// Feature of a surface or piece, 0 between balls.
    pub feature: u64,
}

impl Key {
    /// Marks an antagonist that is a surface.
    pub const SURFACE: u32 = 1 << 31;
    /// Marks a candidate or antagonist that is a convex piece.
    pub const PIECE: u32 = 1 << 30;

    /// The candidate ball's index, when it is one.
    pub fn ball(&self) -> Option<usize> {
        (self.candidate & Self::PIECE == 0).then_some(self.candidate as usize)
    }

    /// The surface's index, when the antagonist is one.
    pub fn surface(&self) -> Option<usize> {
        (self.antagonist & Self::SURFACE != 0)
            .then_some((self.antagonist & !Self::SURFACE) as usize)
    }

    /// The same pair, whatever the feature.
    pub fn pair(&self) -> (u32, u32) {
        (self.candidate, self.antagonist)
    }
}

/// A candidate pair within the alert distance, or held by a bond.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Contact<S: Space> {
    /// Its name.
    pub key: Key,
    /// Bodies: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface law.
    pub law: u16,
    /// See [`crate::solve::ContactForm::central`].
    pub central: bool,
    /// A corner of a polygon touches, not a side: there is no face to bond over.
    pub vertex_contact: bool,
    /// Whether a bond of this pair broke.
    pub broken: bool,
    /// Place in the memory of its interface law, or [`Contact::NO_MEMORY`].
    pub slot: u32,
    /// Gap (m), positive when open.
    pub gap: f64,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// From each body's centre to the contact point (m).
    pub arms: [S::Vector; 2],
    /// Reduced radius r1 r2/(r1 + r2) (m).
    pub radius: f64,
    /// Impulse of the last solve in world axes (N s).
    pub impulse: S::Vector,
    /// Moment of the last solve on the candidate (N m s); zero where nothing resists rotation.
    pub moment: S::Spin,
    /// When the contact formed (s).
    pub formed_at: f64,
    /// Time under a compressive impulse without a break (s).
    pub pressed: f64,
    /// It closes within this step, faster than detection at the start of the step can follow: its gap and normal are those
    /// of the instant at which it closes, and an impact is one of this step.
    pub closing: bool,
    /// Of a closing one: an earlier impact of the same step changes the motion that it was foreseen from. Restitution does
    /// not act on it in this step: it is only kept from closing, and bounces in the next.
    pub later: bool,
    /// Beyond the alert distance at the start of the step: nothing but the constraint that it must not open below zero acts
    /// on it, no bond, no cohesion, no wear.
    pub beyond: bool,
    /// Whether the last solve left friction at its bound.
    pub slides: bool,
    /// Energy that friction took at this contact since it formed (J).
    pub friction_work: f64,
}

impl<S: Space> Contact<S> {
    /// No memory: plain frictional contact.
    pub const NO_MEMORY: u32 = u32::MAX;

    /// The slot of its memory, if any.
    pub fn memory(&self) -> Option<usize> {
        (self.slot != Self::NO_MEMORY).then_some(self.slot as usize)
    }
}

/// All contacts, sorted by key, and the neighbour list they come from. What tells of the last step alone is not kept in
/// checkpoints.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Network<S: Space> {
    /// Contacts of this step, sorted by key.
    pub contacts: Vec<Contact<S>>,
    /// Bonds and internal variables, one memory for each interface law.
    pub memory: Vec<Memory<S>>,
    /// Pairs whose bond broke: they stay broken when they part and meet again.
    #[serde(serialize_with = "in_order")]
    pub broken_pairs: HashSet<(u32, u32)>,
    /// Distance within which a pair is a contact (m).
    pub alert: f64,
    /// How far the neighbour list looks beyond the alert distance (m).
    pub skin: f64,
    /// Energy of bonds torn because their contact left all reach (J); the ledger takes it.
    pub torn_energy: f64,
    /// Bonds that broke in the last step, in its order.
    #[serde(skip)]
    pub bond_breaks: Vec<Break<S>>,
    /// Bodies, candidate and antagonist, and interface law of the bonds that were made in the last step.
    #[serde(skip)]
    pub bonds_formed: Vec<([u32; 2], u16)>,
    /// What the last step dissipated at its contacts, in their order; kept where something asked for it.
    #[serde(skip)]
    pub spent: Option<Vec<ContactDissipation>>,
    /// What the last step wore off surfaces; kept where something asked for it.
    #[serde(skip)]
    pub losses: Option<Vec<Loss>>,
    /// Times over that a step wears and damages: the cycles that the cycle at hand stands for, see
    /// [`crate::wear::jump`]; 1 without jumps.
    pub cycle_multiplier: f64,
    /// Volume worn off each surface so far, by its index (m^3; m^3/m in 2D).
    pub worn: BTreeMap<usize, f64>,
    /// What shows whether the step was small enough.
    pub step_size: StepSizeDiagnostics,
    /// How often the neighbour list was rebuilt.
    pub rebuilds: u64,
    /// Relative motion in a step (m) from which a pair is followed through the step.
    pub fast: f64,
    pub(super) candidates: Vec<(u32, u32)>,
    pub(super) seen_at: Vec<S::Vector>,
    /// How much farther the neighbour list looks about each body that is fast (m); empty where none is.
    pub(super) widened: Vec<f64>,
    /// The spin of each surface for which the list was made (rad/s); zero where turning leaves it in place.
    pub(super) turning: Vec<f64>,
    /// Half thicknesses and levers of what can touch.
    #[serde(skip)]
    pub(crate) extents: super::detect::Extents,
    #[serde(skip)]
    pub(super) old: Vec<Contact<S>>,
}

/// The same pairs are the same bytes.
fn in_order<T: Serializer>(pairs: &HashSet<(u32, u32)>, to: T) -> Result<T::Ok, T::Error> {
    let mut pairs: Vec<_> = pairs.iter().collect();
    pairs.sort_unstable();
    pairs.serialize(to)
}

impl<S: Space> Network<S> {
    /// Whether all bodies of its contacts are among this many. Broken pairs name what touches, not bodies, and are only
    /// compared.
    pub(crate) fn names_bodies_below(&self, bodies: usize) -> bool {
        let below = |b: &u32| (*b as usize) < bodies;
        self.contacts.iter().all(|c| c.bodies.iter().all(below))
    }

    /// Has the neighbour list made anew at the next step: what may touch has changed.
    pub fn forget_neighbours(&mut self) {
        self.seen_at.clear();
    }

    /// An empty network for so many interface laws.
    pub fn new(alert: f64, skin: f64, variables: &[usize]) -> Self {
        Self {
            contacts: Vec::new(),
            memory: variables.iter().map(|n| Memory::new(*n)).collect(),
            broken_pairs: HashSet::new(),
            alert,
            skin,
            torn_energy: 0.0,
            bond_breaks: Vec::new(),
            bonds_formed: Vec::new(),
            spent: None,
            losses: None,
            cycle_multiplier: 1.0,
            worn: BTreeMap::new(),
            step_size: StepSizeDiagnostics::default(),
            rebuilds: 0,
            fast: alert,
            candidates: Vec::new(),
            widened: Vec::new(),
            turning: Vec::new(),
            extents: Default::default(),
            seen_at: Vec::new(),
            old: Vec::new(),
        }
    }

    /// How many contacts there are: those within the alert distance or held, and of those made ahead because of speed the
    /// ones that carry an impulse.
    pub fn contact_count(&self) -> usize {
        self.counted_contacts().count()
    }

    /// The contacts that [`Self::contact_count`] counts.
    pub fn counted_contacts(&self) -> impl Iterator<Item = &Contact<S>> {
        let counts = |c: &&Contact<S>| !c.beyond || c.impulse != S::Vector::zero();
        self.contacts.iter().filter(counts)
    }

    /// The bond of a contact, broken or not.
    pub fn bond(&self, contact: &Contact<S>) -> Option<&super::Bond<S>> {
        contact
            .memory()
            .map(|slot| &self.memory[contact.law as usize].bonds[slot])
    }

    /// The state of the bond of a contact.
    pub fn bond_state(&self, contact: &Contact<S>) -> BondState {
        match self.bond(contact) {
            Some(bond) if bond.intact() => BondState::Intact {
                damage: bond.damage,
            },
            _ if contact.broken => BondState::Broken,
            _ => BondState::None,
        }
    }

    /// The gap of a contact less what its bond fills, while it holds (m).
    pub fn open_gap(&self, contact: &Contact<S>) -> f64 {
        let bond = self.bond(contact).filter(|b| b.intact());
        contact.gap - bond.map_or(0.0, |b| b.gap)
    }

    /// Tells that the bond of a contact broke, with what it went through.
    pub(crate) fn record_break(&mut self, contact: &Contact<S>) {
        let Some(bond) = self.bond(contact) else {
            return;
        };
        self.bond_breaks.push(Break {
            key: contact.key,
            bodies: contact.bodies,
            law: contact.law,
            place: contact.arms[0],
            opening: [bond.opening_n, bond.opening_t.norm()],
            area: bond.area,
            torn: 0.0,
            damaged: bond.damage >= 1.0,
            life: bond.life,
        });
    }

    /// Says where breaks are, which are told with the arms of their contacts.
    pub(crate) fn locate_breaks(&mut self, bodies: &Bodies<S>) {
        for b in &mut self.bond_breaks {
            b.place += bodies.position[b.bodies[0] as usize];
        }
    }

    /// Bonds made so far.
    pub fn bonds_made(&self) -> u64 {
        self.memory.iter().map(|m| m.made).sum()
    }

    /// Bonds broken so far.
    pub fn bonds_broken(&self) -> u64 {
        self.memory.iter().map(|m| m.broken).sum()
    }

    /// Mean damage over all bonds ever made, broken ones counting 1.
    pub fn mean_damage(&self) -> f64 {
        let made = self.bonds_made();
        if made == 0 {
            return 0.0;
        }
        let intact: f64 = self.memory.iter().map(Memory::intact_damage).sum();
        (self.bonds_broken() as f64 + intact) / made as f64
    }

    /// Energy stored in bonds (J).
    pub fn elastic_energy(&self) -> f64 {
        self.memory.iter().map(Memory::energy).sum()
    }
}
