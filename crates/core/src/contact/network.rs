//! Contacts of the current step, and the state carried over from the previous one.

use super::events::{Break, ContactDissipation, ContactWear};
use super::memory::{BondState, Memory};
use super::spring::Spring;
use super::step_size::StepSizeDiagnostics;
use super::thermal::ContactHeat;
use crate::bodies::Bodies;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::threads::{count, sum};
use serde::{Deserialize, Serialize, Serializer};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Key of a contact, stable in time: candidate (a ball, or a convex piece with [`Key::PIECE`] set),
/// antagonist (a ball, a piece, or a surface with [`Key::SURFACE`] set), and the face, edge or
/// vertex in contact.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
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

    /// Creates the key of a candidate and an antagonist that touch with a feature.
    pub fn new(candidate: u32, antagonist: u32, feature: u64) -> Self {
        Self {
            candidate,
            antagonist,
            feature,
        }
    }

    /// Returns the index of the candidate if it is a ball.
    pub fn ball(&self) -> Option<usize> {
        (self.candidate & Self::PIECE == 0).then_some(self.candidate as usize)
    }

    /// Returns the index of the antagonist if it is a ball.
    pub fn antagonist_ball(&self) -> Option<usize> {
        let other = Self::SURFACE | Self::PIECE;
        (self.antagonist & other == 0).then_some(self.antagonist as usize)
    }

    /// Returns the index of the antagonist if it is a surface.
    pub fn surface(&self) -> Option<usize> {
        (self.antagonist & Self::SURFACE != 0)
            .then_some((self.antagonist & !Self::SURFACE) as usize)
    }

    /// Returns the pair, without the feature.
    pub fn pair(&self) -> (u32, u32) {
        (self.candidate, self.antagonist)
    }
}

/// A collision shape of a scene, decoded from a side of a [`Key`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeIndex {
    /// Index of a ball.
    Ball(usize),
    /// Index of a convex piece.
    Piece(usize),
    /// Index of a surface.
    Surface(usize),
}

impl ShapeIndex {
    /// Decodes a side of a key.
    #[inline]
    pub fn of(side: u32) -> Self {
        let index = (side & !(Key::SURFACE | Key::PIECE)) as usize;
        match (side & Key::SURFACE != 0, side & Key::PIECE != 0) {
            (true, _) => Self::Surface(index),
            (false, true) => Self::Piece(index),
            (false, false) => Self::Ball(index),
        }
    }

    /// Returns its place in a list of all balls, then all pieces, then all surfaces.
    #[inline]
    pub fn place(self, [balls, pieces]: [usize; 2]) -> usize {
        match self {
            Self::Ball(k) => k,
            Self::Piece(k) => balls + k,
            Self::Surface(k) => balls + pieces + k,
        }
    }

    /// Returns the index of its body; `None` if the scene has no such shape.
    pub fn body<S: Space>(self, shapes: &Shapes<S>) -> Option<u32> {
        match self {
            Self::Ball(k) => shapes.balls.get(k).map(|b| b.body),
            Self::Piece(k) => shapes.pieces.get(k).map(|p| p.body),
            Self::Surface(k) => shapes.surfaces.get(k).map(|s| s.body),
        }
    }
}

/// Where the impulse of a contact acts. The impulse acts at one point for both bodies, even where a
/// gap or an overlap separates their surfaces, so that it gives them no angular momentum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ActionPoint {
    /// Either surface: for rigid bodies that touch within the step, and for two surfaces that
    /// deform, whose forces act at their nodes.
    #[default]
    Surfaces,
    /// The middle between the surfaces.
    Middle,
    /// The surface of the candidate, which deforms.
    Candidate,
    /// The surface of the antagonist, which deforms.
    Antagonist,
}

/// A candidate pair within the alert distance, or held by a bond.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Contact<S: Space> {
    /// Key.
    pub key: Key,
    /// Bodies: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface law.
    pub law: u16,
    /// Whether the impulse cannot turn the bodies, see [`crate::solve::ContactForm::central`].
    pub central: bool,
    /// Whether the contact is at a corner of a polygon, so that there is no face for a bond.
    pub vertex_contact: bool,
    /// Whether a bond of this pair has broken.
    pub broken: bool,
    /// Index in the memory of its interface law, or [`Contact::NO_MEMORY`].
    pub slot: u32,
    /// Gap (m), positive when open.
    pub gap: f64,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Vectors from each body's centre to its surface at the contact (m).
    pub arms: [S::Vector; 2],
    /// Point at which the impulse acts, see [`Self::levers`].
    pub action_point: ActionPoint,
    /// Reduced radius r1 r2/(r1 + r2) (m).
    pub radius: f64,
    /// Impulse of the last solve in world axes (N s).
    pub impulse: S::Vector,
    /// Moment of the last solve on the candidate (N m s); zero where the contact does not resist
    /// rotation.
    pub moment: S::Spin,
    /// Time of formation of the contact (s).
    pub formed_at: f64,
    /// Uninterrupted time under a compressive impulse (s).
    pub compression_time: f64,
    /// Whether the contact closes within this step, too fast for detection at the start of the
    /// step: gap and normal are those at the time of closing, and the impact belongs to this step.
    pub closing: bool,
    /// For a closing contact: whether an earlier impact of the same step changes the motion from
    /// which it was predicted. The contact is then only kept from closing, without restitution, and
    /// rebounds in the next step.
    pub later: bool,
    /// Whether the contact was beyond the alert distance at the start of the step: only the
    /// unilateral constraint acts on it, no bond, no cohesion, no wear.
    pub beyond: bool,
    /// Whether friction was at its bound in the last solve (slip).
    pub slides: bool,
    /// Energy dissipated by friction since the contact formed (J).
    pub friction_work: f64,
    /// State of the spring, where the law of the contact is compliant.
    pub spring: Spring<S>,
}

/// Geometry of a contact between two bodies.
#[derive(Clone, Copy, Debug)]
pub struct ContactGeometry<S: Space> {
    /// Gap (m), positive when open.
    pub gap: f64,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Vectors from each body's centre to the contact point (m).
    pub arms: [S::Vector; 2],
    /// Reduced radius (m).
    pub radius: f64,
}

impl<S: Space> Contact<S> {
    /// Marks a frictional contact without memory.
    pub const NO_MEMORY: u32 = u32::MAX;

    /// Returns a contact of two faces that forms at a time (s): not central, without memory or
    /// impulse.
    #[inline]
    pub fn new(
        key: Key,
        bodies: [u32; 2],
        law: u16,
        geometry: ContactGeometry<S>,
        formed_at: f64,
    ) -> Self {
        Self {
            key,
            bodies,
            law,
            slot: Self::NO_MEMORY,
            gap: geometry.gap,
            normal: geometry.normal,
            arms: geometry.arms,
            radius: geometry.radius,
            formed_at,
            ..Self::default()
        }
    }

    /// Returns the vectors from each body's centre to where the impulse acts (m).
    #[inline]
    pub fn levers(&self) -> [S::Vector; 2] {
        let [i, j] = self.arms;
        let across = |share: f64| self.normal * (share * self.gap);
        match self.action_point {
            ActionPoint::Surfaces => [i, j],
            ActionPoint::Middle => [i - across(0.5), j + across(0.5)],
            ActionPoint::Candidate => [i, j + across(1.0)],
            ActionPoint::Antagonist => [i - across(1.0), j],
        }
    }

    /// Returns whether the contact is within the alert distance or bonded, or was predicted and has
    /// an impulse.
    pub fn counts(&self) -> bool {
        !self.beyond || self.impulse != S::Vector::zero()
    }

    /// Returns the velocity of the candidate relative to the antagonist, at the current velocities
    /// of rigid bodies (m/s).
    #[inline]
    pub fn relative_velocity(&self, bodies: &Bodies<S>) -> S::Vector {
        let [i, j] = self.bodies.map(|b| b as usize);
        let levers = self.levers();
        bodies.velocity[i] + S::spin_velocity(&bodies.spin[i], &levers[0])
            - bodies.velocity[j]
            - S::spin_velocity(&bodies.spin[j], &levers[1])
    }

    /// Returns the mass along the normal, 1/W_nn (kg; kg/m in 2D); zero between bodies that cannot
    /// move.
    pub fn effective_mass(&self, bodies: &Bodies<S>) -> f64 {
        let (n, levers) = (&self.normal, self.levers());
        let mobility = |side: usize| {
            let b = self.bodies[side] as usize;
            let turning = S::rotation_block(&levers[side], &bodies.inverse_tensor(b));
            n.dot(&n.scaled_by(&bodies.inverse_mass[b])) + n.dot(&turning.apply(n))
        };
        let w = mobility(0) + mobility(1);
        if w > 0.0 { 1.0 / w } else { 0.0 }
    }

    /// Returns the slot of its memory, if any.
    pub fn memory(&self) -> Option<usize> {
        (self.slot != Self::NO_MEMORY).then_some(self.slot as usize)
    }
}

/// All contacts, sorted by key, and their neighbour list. What contacts dissipated and wore in the
/// last step is not part of checkpoints.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Network<S: Space> {
    /// Contacts of this step, sorted by key.
    pub contacts: Vec<Contact<S>>,
    /// Bonds and internal variables, one memory per interface law.
    pub memory: Vec<Memory<S>>,
    /// Pairs whose bond broke; they remain in the set when they separate and meet again.
    #[serde(serialize_with = "in_order")]
    pub broken_pairs: HashSet<(u32, u32)>,
    /// Distance within which a pair forms a contact (m).
    pub alert: f64,
    /// Range of the neighbour list beyond the alert distance (m).
    pub skin: f64,
    /// Energy of bonds broken because their contact moved out of range (J); collected by the energy
    /// ledger.
    pub torn_energy: f64,
    /// Bonds broken in the last step, in order.
    pub bond_breaks: Vec<Break>,
    /// Bodies (candidate, antagonist) and interface law of the bonds formed in the last step.
    pub bonds_formed: Vec<([u32; 2], u16)>,
    /// Energy dissipated at the contacts in the last step, in their order; `None` unless an output
    /// requests it.
    #[serde(skip)]
    pub dissipation: Option<Vec<ContactDissipation>>,
    /// Wear of surfaces in the last step; `None` unless requested.
    #[serde(skip)]
    pub losses: Option<Vec<ContactWear>>,
    /// Temperatures and conductances of the contacts in the last step; `None` where no heat is
    /// computed.
    #[serde(skip)]
    pub thermal: Option<ContactHeat>,
    /// Factor on wear and damage in a step: the number of cycles that the current cycle represents,
    /// see [`crate::wear::jump`]; 1 without jumps.
    pub cycle_multiplier: f64,
    /// Worn volume of each surface so far, by index (m^3; m^3/m in 2D).
    pub worn: BTreeMap<usize, f64>,
    /// Surfaces of grains that deform: material worn there is third body.
    pub of_grains: BTreeSet<usize>,
    /// Diagnostics of the step size.
    pub step_size: StepSizeDiagnostics,
    /// Change of distances by the largest growth of a body since the neighbour list was built (m).
    pub grown: f64,
    /// Number of rebuilds of the neighbour list.
    pub rebuilds: u64,
    /// Relative motion in a step (m) from which a pair is followed through the step.
    pub fast: f64,
    pub(super) candidates: Vec<(u32, u32)>,
    pub(super) seen_at: Vec<S::Vector>,
    /// Additional range of the neighbour list around each fast body (m); empty where there is none.
    pub(super) widened: Vec<f64>,
    /// Spin of each surface for which the list was built (rad/s); zero where rotation leaves the
    /// surface in place.
    pub(super) turning: Vec<f64>,
    /// Half thicknesses and extents of the collision shapes.
    #[serde(skip)]
    pub(crate) extents: super::detect::Extents,
    /// Cores of the convex pieces in world axes, as at the last detection.
    #[serde(skip)]
    pub(super) cores: Vec<S::Core>,
}

/// Sorted, so that equal sets are serialised to equal bytes.
fn in_order<T: Serializer>(pairs: &HashSet<(u32, u32)>, to: T) -> Result<T::Ok, T::Error> {
    let mut pairs: Vec<_> = pairs.iter().collect();
    pairs.sort_unstable();
    pairs.serialize(to)
}

/// Approximate time to compute the energy of a contact's spring (ns).
const ENERGY: f64 = 3.0;
/// Approximate time to decide whether a contact is counted (ns).
const COUNT: f64 = 2.0;

impl<S: Space> Network<S> {
    /// Replaces the normal of a contact and rotates its tangential memory (spring force, bond
    /// opening and rotation) with it.
    pub(crate) fn turn(&mut self, contact: usize, normal: &S::Vector) {
        let contact = &mut self.contacts[contact];
        let from = std::mem::replace(&mut contact.normal, *normal);
        if from == *normal {
            return;
        }
        let force = &mut contact.spring.force_t;
        *force = S::transport(&from, normal, 0.0, force);
        if let Some(slot) = contact.memory() {
            let memory = &mut self.memory[contact.law as usize];
            let opening = &mut memory.bonds[slot].opening_t;
            *opening = S::transport(&from, normal, 0.0, opening);
            if let Some(rotation) = memory.rotations.get_mut(slot) {
                *rotation = S::transport_spin(&from, normal, 0.0, rotation);
            }
        }
    }

    /// Forces a rebuild of the neighbour list in the next step, because the set of possible pairs
    /// has changed.
    pub fn forget_neighbours(&mut self) {
        self.seen_at.clear();
    }

    /// Creates an empty network, with one entry of `variables` per interface law.
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
            dissipation: None,
            losses: None,
            thermal: None,
            cycle_multiplier: 1.0,
            worn: BTreeMap::new(),
            of_grains: BTreeSet::new(),
            step_size: StepSizeDiagnostics::default(),
            rebuilds: 0,
            fast: alert,
            candidates: Vec::new(),
            widened: Vec::new(),
            turning: Vec::new(),
            extents: Default::default(),
            grown: 0.0,
            seen_at: Vec::new(),
            cores: Vec::new(),
        }
    }

    /// Returns the number of contacts: those within the alert distance or bonded, and predicted
    /// contacts with an impulse.
    pub fn contact_count(&self, parallel: bool) -> usize {
        let contacts = &self.contacts;
        count(parallel, contacts.len(), COUNT, |k| contacts[k].counts())
    }

    /// Iterates over the contacts that [`Self::contact_count`] counts.
    pub fn counted_contacts(&self) -> impl Iterator<Item = &Contact<S>> {
        self.contacts.iter().filter(|c| c.counts())
    }

    /// Returns the bond of a contact, intact or broken.
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

    /// Returns the gap of a contact (m), less the rest gap of its bond while that is intact.
    pub fn open_gap(&self, contact: &Contact<S>) -> f64 {
        let bond = self.bond(contact).filter(|b| b.intact());
        contact.gap - bond.map_or(0.0, |b| b.gap)
    }

    /// Records that the bond of a contact broke, with its energy history and its damage at the
    /// start of the step.
    pub(crate) fn record_break(&mut self, contact: &Contact<S>, damage_before: f64) {
        let Some(bond) = self.bond(contact) else {
            return;
        };
        let memory = &self.memory[contact.law as usize];
        let rotation = contact.memory().and_then(|k| memory.rotations.get(k));
        let rotation = rotation.map_or([0.0; 2], |rotation| {
            let (twist, bend) = S::split_spin(&contact.normal, rotation);
            [twist, bend.norm()]
        });
        self.bond_breaks.push(Break {
            key: contact.key,
            bodies: contact.bodies,
            law: contact.law,
            place: contact.arms[0].padded(),
            opening: [bond.opening_n, bond.opening_t.norm()],
            rotation,
            area: bond.area,
            torn: 0.0,
            damaged: bond.damage >= 1.0,
            damage_before,
            energies: bond.energies,
        });
    }

    /// Completes the positions of breaks, which are recorded as lever arms.
    pub(crate) fn locate_breaks(&mut self, bodies: &Bodies<S>) {
        for b in &mut self.bond_breaks {
            let centre = bodies.position[b.bodies[0] as usize].padded();
            b.place = std::array::from_fn(|k| b.place[k] + centre[k]);
        }
    }

    /// Returns the number of bonds formed so far.
    pub fn bonds_made(&self) -> u64 {
        self.memory.iter().map(|m| m.made).sum()
    }

    /// Returns the number of bonds broken so far.
    pub fn bonds_broken(&self) -> u64 {
        self.memory.iter().map(|m| m.broken).sum()
    }

    /// Returns the mean damage over all bonds formed so far; broken ones count 1.
    pub fn mean_damage(&self) -> f64 {
        let made = self.bonds_made();
        if made == 0 {
            return 0.0;
        }
        let intact: f64 = self.memory.iter().map(Memory::intact_damage).sum();
        (self.bonds_broken() as f64 + intact) / made as f64
    }

    /// Returns the gap of the spring of a compliant contact (m), without the part filled by an
    /// intact bond. An overlap at which a bond formed stays in the spring.
    pub fn spring_gap(&self, contact: &Contact<S>) -> f64 {
        let bond = self.bond(contact).filter(|b| b.intact());
        contact.gap - bond.map_or(0.0, |b| b.gap.max(0.0))
    }

    /// Returns the energy stored in bonds (J).
    pub fn bond_energy(&self) -> f64 {
        self.memory.iter().map(Memory::energy).sum()
    }

    /// Returns the energy stored in the springs of compliant contacts (J).
    pub fn spring_energy(&self) -> f64 {
        self.sum_spring_energy(false)
    }

    /// Returns [`Self::spring_energy`] with the same bits, on several threads if `parallel` and
    /// there are enough contacts.
    pub fn sum_spring_energy(&self, parallel: bool) -> f64 {
        sum(parallel, self.contacts.len(), ENERGY, |k| {
            self.contacts[k].spring.stored()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of a contactor encodes its kind; two contactors without the feature name a pair.
    #[test]
    fn a_key_contains_the_kinds_of_its_sides() {
        let (piece, surface) = (Key::PIECE | 3, Key::SURFACE | 4);
        let key = |candidate, antagonist| Key::new(candidate, antagonist, 7);
        for (key, ball, other, plane) in [
            (key(3, 4), Some(3), Some(4), None),
            (key(3, piece), Some(3), None, None),
            (key(3, surface), Some(3), None, Some(4)),
            (key(piece, piece), None, None, None),
            (key(piece, surface), None, None, Some(4)),
            (key(0, 0), Some(0), Some(0), None),
        ] {
            let found = (key.ball(), key.antagonist_ball(), key.surface());
            assert_eq!(found, (ball, other, plane), "{key:?}");
            assert_eq!(key.pair(), (key.candidate, key.antagonist));
        }
    }
}
