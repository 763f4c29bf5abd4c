//! Update of the contacts: the contacts of each pair are replaced where they are, with the memory
//! of the old ones, so that a second list is not needed.

use super::narrow::{BallData, Narrow};
use super::partners::Partners;
use super::{CollisionScene, drop_contact};
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::convex::Core;
use crate::geometry::space::{Space, VectorLike};
use crate::threads;

/// Pairs per task: in scenes of balls alone, and in scenes with pieces or surfaces.
const CHUNK: [usize; 2] = [512, 128];
/// Approximate time per pair in these two kinds of scenes (ns).
const COST: [f64; 2] = [15.0, 200.0];
/// Approximate time to collect the data of a ball (ns).
const BALL: f64 = 5.0;
/// Number of tasks whose new contacts are kept at the same time: a few megabytes.
const BATCH: usize = 64;

/// A contact found in this step, without memory; the fields mean the same as in [`Contact`].
pub(super) struct DetectedContact<S: Space> {
    pub key: Key,
    pub bodies: [u32; 2],
    pub law: u16,
    pub central: bool,
    pub vertex_contact: bool,
    pub geometry: ContactGeometry<S>,
}

/// An event of the update that changes more than the contact; events are in the order of contacts.
enum UpdateEvent<S: Space> {
    /// A contact with memory separated.
    Dropped(Contact<S>),
    /// A new contact; the largest penetration among the old contacts of its pair (m), and the size
    /// of its bodies (m).
    New(Contact<S>, [f64; 2]),
}

/// The memory of a contact, rotated with its normal.
struct RotatedMemory<S: Space> {
    law: u16,
    slot: u32,
    /// Tangential opening in the new frame (m).
    opening: S::Tangent,
    /// Rotation of the bond in the new frame (rad), if it is stored.
    rotation: Option<S::Spin>,
}

/// The contacts of the pairs of a task while they are updated.
pub(super) struct ContactUpdate<'c, S: Space> {
    contacts: &'c mut [Contact<S>],
    /// The old contacts of the current pair.
    old: Vec<Contact<S>>,
    out: TaskResult<S>,
}

/// Changes made by a task besides the contacts that it updates in place.
#[derive(Default)]
struct TaskResult<S: Space> {
    /// Number of contacts updated in place.
    kept: usize,
    /// Number of old contacts read.
    read: usize,
    /// New contacts after those in place, for which there was no room.
    more: Vec<Contact<S>>,
    rotated: Vec<RotatedMemory<S>>,
    events: Vec<UpdateEvent<S>>,
}

impl<'c, S: Space> ContactUpdate<'c, S> {
    pub fn new(contacts: &'c mut [Contact<S>]) -> Self {
        Self {
            contacts,
            old: Vec::new(),
            out: TaskResult::default(),
        }
    }

    /// Drops the old contacts of pairs before this one.
    #[inline]
    fn skip_to(&mut self, pair: (u32, u32)) {
        while self.out.read < self.contacts.len() && self.contacts[self.out.read].key.pair() < pair
        {
            self.drop_old(self.out.read);
            self.out.read += 1;
        }
    }

    fn is_next(&self, pair: (u32, u32)) -> bool {
        let next = self.contacts.get(self.out.read);
        next.is_some_and(|c| c.key.pair() == pair)
    }

    /// Reads the old contacts of a pair, which [`Self::old`] then returns.
    pub fn begin_pair(&mut self, pair: (u32, u32)) {
        self.skip_to(pair);
        self.old.clear();
        while self.is_next(pair) {
            self.old.push(self.contacts[self.out.read].clone());
            self.out.read += 1;
        }
    }

    /// The old contacts of the pair that was begun.
    pub fn old(&self) -> &[Contact<S>] {
        &self.old
    }

    /// Reads the old contact of a pair of balls, of which there is at most one, and returns its
    /// place.
    #[inline]
    pub fn old_of_balls(&mut self, pair: (u32, u32)) -> Option<usize> {
        self.skip_to(pair);
        self.old.clear();
        let first = self.out.read;
        while self.is_next(pair) {
            self.out.read += 1;
        }
        (self.out.read > first).then_some(first)
    }

    /// Returns the contact found by [`Self::old_of_balls`].
    pub fn contact(&self, k: usize) -> &Contact<S> {
        &self.contacts[k]
    }

    /// Records that the contact returned by [`Self::old_of_balls`] ends.
    #[inline]
    pub fn drop_old(&mut self, k: usize) {
        let contact = &self.contacts[k];
        if contact.memory().is_some() {
            self.out.events.push(UpdateEvent::Dropped(contact.clone()));
        }
    }

    /// Drops the old contacts of the pair that do not continue.
    pub fn drop_others(&mut self, continues: impl Fn(usize) -> bool) {
        for (k, contact) in self.old.iter().enumerate() {
            if !continues(k) && contact.memory().is_some() {
                self.out.events.push(UpdateEvent::Dropped(contact.clone()));
            }
        }
    }

    /// Drops the old contacts after the last pair.
    pub fn end(&mut self) {
        for k in self.out.read..self.contacts.len() {
            self.drop_old(k);
        }
        self.out.read = self.contacts.len();
    }

    /// Updates the contact found by [`Self::old_of_balls`].
    #[inline]
    pub fn continue_in_place(&mut self, narrow: &Narrow<S>, k: usize, found: &DetectedContact<S>) {
        if self.out.more.is_empty() {
            if self.out.kept < k {
                self.contacts.swap(self.out.kept, k);
            }
            set_geometry(
                narrow,
                &mut self.contacts[self.out.kept],
                found,
                &mut self.out.rotated,
            );
            self.out.kept += 1;
        } else {
            let mut contact = self.contacts[k].clone();
            set_geometry(narrow, &mut contact, found, &mut self.out.rotated);
            self.out.more.push(contact);
        }
    }

    /// Adds the contact that continues the old contact `k` of the pair.
    pub fn continue_old(&mut self, narrow: &Narrow<S>, k: usize, found: &DetectedContact<S>) {
        // In most cases the contact keeps its place in the list, which still holds it.
        if self.out.more.is_empty() && self.out.kept == self.out.read - self.old.len() + k {
            let contact = &mut self.contacts[self.out.kept];
            set_geometry(narrow, contact, found, &mut self.out.rotated);
            self.out.kept += 1;
            return;
        }
        let mut contact = self.old[k].clone();
        set_geometry(narrow, &mut contact, found, &mut self.out.rotated);
        self.push(contact);
    }

    /// Adds a new contact of bodies of the reduced radius `size` (m).
    pub fn add(&mut self, narrow: &Narrow<S>, found: &DetectedContact<S>, size: f64) {
        let mut contact = Contact {
            central: found.central,
            vertex_contact: found.vertex_contact,
            ..Contact::new(
                found.key,
                found.bodies,
                found.law,
                found.geometry,
                narrow.placed.time,
            )
        };
        contact.broken = narrow.network.broken_pairs.contains(&found.key.pair());
        // Penetrations in the initial state come from the sample, not from the step.
        if narrow.placed.time > 0.0 {
            let known = self.old.iter().map(|c| -c.gap).fold(0.0, f64::max);
            // The thickness behind a point on the surface of a grain is that of the whole grain.
            let bodies = narrow.placed.scene.bodies;
            let grain = |b: &&u32| bodies.carrier(**b as usize).is_some_and(|c| c.grain);
            let grain = contact.bodies.iter().find(grain);
            let size = grain.map_or(size, |b| bodies.length[*b as usize]);
            if contact.gap < 0.0 {
                self.out
                    .events
                    .push(UpdateEvent::New(contact.clone(), [known, size]));
            }
        }
        self.push(contact);
    }

    fn push(&mut self, contact: Contact<S>) {
        if self.out.more.is_empty() && self.out.kept < self.out.read {
            self.contacts[self.out.kept] = contact;
            self.out.kept += 1;
        } else {
            self.out.more.push(contact);
        }
    }
}

/// Gives an old contact the geometry of this step; the rotated memory is added to `rotated`.
#[inline]
fn set_geometry<S: Space>(
    narrow: &Narrow<S>,
    contact: &mut Contact<S>,
    found: &DetectedContact<S>,
    rotated: &mut Vec<RotatedMemory<S>>,
) {
    let from = contact.normal;
    let ContactGeometry {
        gap,
        normal,
        arms,
        radius,
    } = found.geometry;
    contact.key = found.key;
    contact.bodies = found.bodies;
    contact.law = found.law;
    contact.central = found.central;
    contact.vertex_contact = found.vertex_contact;
    (contact.gap, contact.normal) = (gap, normal);
    (contact.arms, contact.radius) = (arms, radius);
    (contact.closing, contact.later) = (false, false);
    contact.beyond = false;
    let springs = contact.spring.force_t != S::Tangent::zero();
    // In 2D tangential parts rotate with their frame.
    if S::D == 2 || !(springs || contact.memory().is_some()) {
        return;
    }
    let [i, j] = found
        .bodies
        .map(|b| narrow.placed.scene.bodies.spin[b as usize]);
    let angle = 0.5 * narrow.placed.h * S::split_spin(&normal, &(i + j)).0;
    if springs {
        let force = &mut contact.spring.force_t;
        *force = S::transport(&from, &normal, angle, force);
    }
    if let Some(slot) = contact.memory() {
        let memory = &narrow.network.memory[contact.law as usize];
        let opening = &memory.bonds[slot].opening_t;
        let rotation = memory.rotations.get(slot);
        rotated.push(RotatedMemory {
            law: contact.law,
            slot: contact.slot,
            opening: S::transport(&from, &normal, angle, opening),
            rotation: rotation.map(|r| S::transport_spin(&from, &normal, angle, r)),
        });
    }
}

/// A scene at the places where contacts are detected.
pub(super) struct PlacedScene<'a, S: Space> {
    pub scene: &'a CollisionScene<'a, S>,
    /// Centres of the balls, then of the pieces (m).
    pub centres: &'a [S::Vector],
    /// Time at the start of the step (s).
    pub time: f64,
    /// Time since the last detection (s).
    pub h: f64,
}

/// Updates all contacts of the network from its candidate pairs, on several threads if `parallel`.
pub(super) fn update_contacts<S: Space>(
    network: &mut Network<S>,
    placed: &PlacedScene<S>,
    parallel: bool,
) {
    let candidates = std::mem::take(&mut network.candidates);
    let (shapes, bodies) = (placed.scene.shapes, placed.scene.bodies);
    let cores = rotated_cores(network, placed.scene, parallel);
    let surfaces = shapes.surfaces.iter();
    let frames: Vec<_> = surfaces.map(|s| super::frame(s, bodies)).collect();
    let balls = &shapes.balls;
    let (mut ball_data, divide) = (
        Vec::new(),
        threads::worth_dividing(parallel, balls.len(), BALL),
    );
    threads::fill(divide, &mut ball_data, balls.len(), |k| {
        BallData::new(&balls[k], placed.centres[k], bodies)
    });
    let kind = usize::from(!(shapes.pieces.is_empty() && frames.is_empty()));
    let divide = threads::worth_dividing(parallel, candidates.len(), COST[kind]);
    let size = threads::chunk_size(CHUNK[kind]);
    let batch = if divide { BATCH } else { 1 };
    let mut list = ContactList {
        contacts: std::mem::take(&mut network.contacts),
        written: 0,
        read: 0,
    };
    let partners = Partners::default();
    let mut rest = &candidates[..];
    while !rest.is_empty() {
        let (pairs, after) = rest.split_at(rest.len().min(batch * size));
        rest = after;
        let narrow = Narrow {
            network,
            placed,
            cores: &cores,
            frames: &frames,
            ball_data: &ball_data,
            pairs: &candidates,
            partners: &partners,
        };
        let mut tasks = Vec::with_capacity(batch);
        let mut contacts = &mut list.contacts[list.read..];
        let mut chunks = pairs.chunks(size).peekable();
        while let Some(chunk) = chunks.next() {
            let next = chunks.peek().map_or(after.first(), |next| next.first());
            let of_chunk = next.map_or(contacts.len(), |next| first_from(contacts, next));
            let (own, others) = contacts.split_at_mut(of_chunk);
            contacts = others;
            tasks.push((chunk, own));
        }
        let results = threads::map_tasks(divide, tasks, |(pairs, contacts)| {
            narrow.update(pairs, contacts).out
        });
        for result in results {
            result.apply(network, &mut list, placed);
        }
    }
    // Where there are no candidates all old contacts end.
    for contact in &list.contacts[list.read..] {
        drop_contact(network, contact);
    }
    network.contacts = list.end();
    network.candidates = candidates;
    network.cores = cores;
}

/// Returns the place of the first contact whose pair is not before `pair`. That place is probably
/// near the start, hence the search by doubling.
fn first_from<S: Space>(contacts: &[Contact<S>], pair: &(u32, u32)) -> usize {
    let before = |c: &Contact<S>| c.key.pair() < *pair;
    let mut end = 64;
    while end < contacts.len() && before(&contacts[end]) {
        end *= 2;
    }
    contacts[..end.min(contacts.len())].partition_point(before)
}

/// Cores of the convex pieces in world axes.
fn rotated_cores<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    parallel: bool,
) -> Vec<S::Core> {
    /// Approximate time to rotate a core (ns).
    const TURN: f64 = 100.0;
    let pieces = &scene.shapes.pieces;
    let mut cores = std::mem::take(&mut network.cores);
    if cores.len() != pieces.len() {
        cores = pieces.iter().map(|p| p.core.clone()).collect();
    }
    let divide = threads::worth_dividing(parallel, pieces.len(), TURN);
    let size = threads::chunk_size(CHUNK[1]);
    threads::for_chunks(divide, &mut cores, size, |first, cores| {
        for (core, piece) in cores.iter_mut().zip(&pieces[first..]) {
            let rotation = &scene.bodies.rotation[piece.body as usize];
            piece.core.turn_into(rotation, core);
        }
    });
    cores
}

impl<S: Space> TaskResult<S> {
    /// Applies the result to the network; tasks are applied in the order of their pairs.
    fn apply(self, network: &mut Network<S>, list: &mut ContactList<S>, placed: &PlacedScene<S>) {
        for rotated in self.rotated {
            let memory = &mut network.memory[rotated.law as usize];
            memory.bonds[rotated.slot as usize].opening_t = rotated.opening;
            if let Some(rotation) = rotated.rotation {
                memory.rotations[rotated.slot as usize] = rotation;
            }
        }
        for event in self.events {
            match event {
                UpdateEvent::Dropped(contact) => drop_contact(network, &contact),
                UpdateEvent::New(contact, sizes) => {
                    let compliant = network.memory[contact.law as usize].compliant;
                    let step_size = &mut network.step_size;
                    let times = [placed.time, placed.h];
                    let bodies = placed.scene.bodies;
                    step_size.record_late(&contact, sizes, compliant, times, bodies);
                }
            }
        }
        list.keep(self.kept, self.read);
        for contact in self.more {
            list.insert(contact);
        }
    }
}

/// The list of contacts while it is updated: the new ones, free places, and the old contacts of
/// later pairs.
struct ContactList<S: Space> {
    contacts: Vec<Contact<S>>,
    /// Number of new contacts.
    written: usize,
    /// Place of the first old contact that has not been read.
    read: usize,
}

impl<S: Space> ContactList<S> {
    /// Keeps the first `kept` of the next `read` old contacts.
    fn keep(&mut self, kept: usize, read: usize) {
        if self.written == self.read {
            self.written += kept;
        } else {
            for k in self.read..self.read + kept {
                self.contacts.swap(self.written, k);
                self.written += 1;
            }
        }
        self.read += read;
    }

    fn insert(&mut self, contact: Contact<S>) {
        if self.written < self.read {
            self.contacts[self.written] = contact;
            self.written += 1;
            return;
        }
        let (written, count) = (self.written, self.contacts.len());
        if written < count {
            // The old contacts are moved once, to make room for this contact and some more.
            let room = 16 + count / 64;
            self.contacts.reserve_exact(room);
            self.contacts.resize(count + room, contact.clone());
            self.contacts[written..].rotate_right(room);
            self.contacts[written] = contact;
            self.read += room;
        } else {
            self.contacts.push(contact);
            self.read += 1;
        }
        self.written += 1;
    }

    fn end(mut self) -> Vec<Contact<S>> {
        self.contacts.truncate(self.written);
        // Frees memory if the list grew by doubling, or was longer before.
        let most = self.written + self.written / 4;
        if self.contacts.capacity() > most + 64 {
            self.contacts.shrink_to(self.written + self.written / 16);
        }
        self.contacts
    }
}
