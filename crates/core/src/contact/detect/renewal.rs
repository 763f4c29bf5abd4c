//! Renewal of the contacts: those of each pair are replaced where they are, with the memory of the
//! old ones, so that a second list is not needed.

use super::narrow::{Narrow, Round};
use super::partners::Partners;
use super::{LawTable, drop_contact};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, ContactGeometry, Key, Network};
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::threads;

/// Pairs of balls per task, and pairs of other shapes.
const CHUNK: [usize; 2] = [512, 128];
/// Time of a pair of balls, and of other shapes (ns).
const COST: [f64; 2] = [15.0, 200.0];
/// Time of a ball (ns).
const ROUND: f64 = 5.0;
/// Tasks whose new contacts are kept at a time: a few megabytes.
const BATCH: usize = 64;

/// A contact as it is found in this step.
pub(super) struct Touch<S: Space> {
    pub key: Key,
    pub bodies: [u32; 2],
    pub law: u16,
    pub central: bool,
    pub vertex_contact: bool,
    pub geometry: ContactGeometry<S>,
}

/// What the renewal of contacts changes beside them, in their order.
enum Event<S: Space> {
    /// A contact with memory separated.
    Dropped(Contact<S>),
    /// A new contact, whose pair penetrates by this much (m) elsewhere, and its size (m).
    New(Contact<S>, [f64; 2]),
}

/// The memory of a contact whose normal turned.
struct Turned<S: Space> {
    law: u16,
    slot: u32,
    opening: S::Tangent,
    rotation: Option<S::Spin>,
}

/// New contacts of the pairs of a task.
pub(super) struct Found<'c, S: Space> {
    contacts: &'c mut [Contact<S>],
    /// Number of contacts renewed in place, and of old ones read.
    kept: usize,
    read: usize,
    /// Those after them, for which there was no place.
    more: Vec<Contact<S>>,
    /// The old contacts of the current pair.
    old: Vec<Contact<S>>,
    turned: Vec<Turned<S>>,
    events: Vec<Event<S>>,
}

impl<'c, S: Space> Found<'c, S> {
    pub fn new(contacts: &'c mut [Contact<S>]) -> Self {
        Self {
            contacts,
            kept: 0,
            read: 0,
            more: Vec::new(),
            old: Vec::new(),
            turned: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Drops the old contacts of pairs before this one.
    #[inline]
    fn skip_to(&mut self, pair: (u32, u32)) {
        while self.read < self.contacts.len() && self.contacts[self.read].key.pair() < pair {
            self.drop_old(self.read);
            self.read += 1;
        }
    }

    fn is_next(&self, pair: (u32, u32)) -> bool {
        let next = self.contacts.get(self.read);
        next.is_some_and(|c| c.key.pair() == pair)
    }

    /// Takes the old contacts of a pair; see [`Self::old`].
    pub fn begin_pair(&mut self, pair: (u32, u32)) {
        self.skip_to(pair);
        self.old.clear();
        while self.is_next(pair) {
            self.old.push(self.contacts[self.read].clone());
            self.read += 1;
        }
    }

    /// The old contacts of the pair that was begun.
    pub fn old(&self) -> &[Contact<S>] {
        &self.old
    }

    /// Takes the old contact of a pair of balls, of which there is one at most.
    #[inline]
    pub fn old_of_balls(&mut self, pair: (u32, u32)) -> Option<usize> {
        self.skip_to(pair);
        self.old.clear();
        let first = self.read;
        while self.is_next(pair) {
            self.read += 1;
        }
        (self.read > first).then_some(first)
    }

    /// The contact that [`Self::old_of_balls`] gave.
    pub fn contact(&self, k: usize) -> &Contact<S> {
        &self.contacts[k]
    }

    /// Drops the contact that [`Self::old_of_balls`] gave.
    #[inline]
    pub fn drop_old(&mut self, k: usize) {
        let contact = &self.contacts[k];
        if contact.memory().is_some() {
            self.events.push(Event::Dropped(contact.clone()));
        }
    }

    /// Drops the old contacts of the pair that do not go on.
    pub fn drop_others(&mut self, goes_on: impl Fn(usize) -> bool) {
        for (k, contact) in self.old.iter().enumerate() {
            if !goes_on(k) && contact.memory().is_some() {
                self.events.push(Event::Dropped(contact.clone()));
            }
        }
    }

    /// Drops the old contacts after the last pair.
    pub fn end(&mut self) {
        for k in self.read..self.contacts.len() {
            self.drop_old(k);
        }
        self.read = self.contacts.len();
    }

    /// Renews the contact that [`Self::old_of_balls`] gave.
    #[inline]
    pub fn renew_in_place(&mut self, narrow: &Narrow<S>, k: usize, touch: &Touch<S>) {
        if self.more.is_empty() {
            if self.kept < k {
                self.contacts.swap(self.kept, k);
            }
            renew(
                narrow,
                &mut self.contacts[self.kept],
                touch,
                &mut self.turned,
            );
            self.kept += 1;
        } else {
            let mut contact = self.contacts[k].clone();
            renew(narrow, &mut contact, touch, &mut self.turned);
            self.more.push(contact);
        }
    }

    /// Adds the contact that continues the old contact `k` of the pair.
    pub fn renew(&mut self, narrow: &Narrow<S>, k: usize, touch: &Touch<S>) {
        // Mostly it stays at its place, which still holds it.
        if self.more.is_empty() && self.kept == self.read - self.old.len() + k {
            let contact = &mut self.contacts[self.kept];
            renew(narrow, contact, touch, &mut self.turned);
            self.kept += 1;
            return;
        }
        let mut contact = self.old[k].clone();
        renew(narrow, &mut contact, touch, &mut self.turned);
        self.push(contact);
    }

    /// Adds a new contact of bodies of the reduced radius `size` (m).
    pub fn add(&mut self, narrow: &Narrow<S>, touch: &Touch<S>, size: f64) {
        let mut contact = Contact {
            central: touch.central,
            vertex_contact: touch.vertex_contact,
            ..Contact::new(
                touch.key,
                touch.bodies,
                touch.law,
                touch.geometry,
                narrow.time,
            )
        };
        contact.broken = narrow.network.broken_pairs.contains(&touch.key.pair());
        // Penetrations in the initial state belong to the sample.
        if narrow.time > 0.0 {
            let known = self.old.iter().map(|c| -c.gap).fold(0.0, f64::max);
            // A point of a grain is as thick as its grain.
            let bodies = narrow.bodies;
            let grain = |b: &&u32| bodies.carrier(**b as usize).is_some_and(|c| c.grain);
            let grain = contact.bodies.iter().find(grain);
            let size = grain.map_or(size, |b| bodies.length[*b as usize]);
            if contact.gap < 0.0 {
                self.events.push(Event::New(contact.clone(), [known, size]));
            }
        }
        self.push(contact);
    }

    fn push(&mut self, contact: Contact<S>) {
        if self.more.is_empty() && self.kept < self.read {
            self.contacts[self.kept] = contact;
            self.kept += 1;
        } else {
            self.more.push(contact);
        }
    }
}

/// Gives an old contact the geometry of this step; what it remembers turns with the pair.
#[inline]
fn renew<S: Space>(
    narrow: &Narrow<S>,
    contact: &mut Contact<S>,
    touch: &Touch<S>,
    turned: &mut Vec<Turned<S>>,
) {
    let from = contact.normal;
    let ContactGeometry {
        gap,
        normal,
        arms,
        radius,
    } = touch.geometry;
    contact.key = touch.key;
    contact.bodies = touch.bodies;
    contact.law = touch.law;
    contact.central = touch.central;
    contact.vertex_contact = touch.vertex_contact;
    (contact.gap, contact.normal) = (gap, normal);
    (contact.arms, contact.radius) = (arms, radius);
    (contact.closing, contact.later) = (false, false);
    contact.beyond = false;
    let springs = contact.spring.force_t != S::Tangent::zero();
    // In the plane tangential parts turn with their frame.
    if S::D == 2 || !(springs || contact.memory().is_some()) {
        return;
    }
    let [i, j] = touch.bodies.map(|b| narrow.bodies.spin[b as usize]);
    let angle = 0.5 * narrow.h * S::split_spin(&normal, &(i + j)).0;
    if springs {
        let force = &mut contact.spring.force_t;
        *force = S::transport(&from, &normal, angle, force);
    }
    if let Some(slot) = contact.memory() {
        let memory = &narrow.network.memory[contact.law as usize];
        let opening = &memory.bonds[slot].opening_t;
        let rotation = memory.rotations.get(slot);
        turned.push(Turned {
            law: contact.law,
            slot: contact.slot,
            opening: S::transport(&from, &normal, angle, opening),
            rotation: rotation.map(|r| S::transport_spin(&from, &normal, angle, r)),
        });
    }
}

/// What the narrow phase needs beside the network.
pub(super) struct Scene<'a, S: Space> {
    pub shapes: &'a Shapes<S>,
    pub bodies: &'a Bodies<S>,
    pub centres: &'a [S::Vector],
    pub laws: &'a LawTable,
    pub time: f64,
    pub h: f64,
}

/// Renews all contacts of the network from its candidate pairs, on several threads if `parallel`.
pub(super) fn renew_contacts<S: Space>(network: &mut Network<S>, scene: &Scene<S>, parallel: bool) {
    let candidates = std::mem::take(&mut network.candidates);
    let cores = turned_cores(network, scene, parallel);
    let surfaces = scene.shapes.surfaces.iter();
    let frame =
        |s: &crate::geometry::shape::Carried<S>| super::frame(s.body, &s.offset, scene.bodies);
    let frames: Vec<_> = surfaces.map(frame).collect();
    let balls = &scene.shapes.balls;
    let (mut round, divide) = (Vec::new(), threads::pays(parallel, balls.len(), ROUND));
    threads::fill(divide, &mut round, balls.len(), |k| {
        Round::new(&balls[k], scene.centres[k], scene.bodies)
    });
    let kind = usize::from(!(scene.shapes.pieces.is_empty() && frames.is_empty()));
    let divide = threads::pays(parallel, candidates.len(), COST[kind]);
    let size = threads::any_size(CHUNK[kind]);
    let batch = if divide { BATCH } else { 1 };
    let mut renewal = Renewal {
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
            shapes: scene.shapes,
            bodies: scene.bodies,
            centres: scene.centres,
            cores: &cores,
            frames: &frames,
            round: &round,
            laws: scene.laws,
            pairs: &candidates,
            partners: &partners,
            time: scene.time,
            h: scene.h,
        };
        let mut tasks = Vec::with_capacity(batch);
        let mut contacts = &mut renewal.contacts[renewal.read..];
        let mut chunks = pairs.chunks(size).peekable();
        while let Some(chunk) = chunks.next() {
            let next = chunks.peek().map_or(after.first(), |next| next.first());
            let of_chunk = next.map_or(contacts.len(), |next| first_from(contacts, next));
            let (own, others) = contacts.split_at_mut(of_chunk);
            contacts = others;
            tasks.push((chunk, own));
        }
        let found = threads::map_tasks(divide, tasks, |(pairs, contacts)| {
            Part::from(narrow.renew(pairs, contacts))
        });
        for part in found {
            part.settle(network, &mut renewal, scene);
        }
    }
    // Without candidates nothing goes on.
    for contact in &renewal.contacts[renewal.read..] {
        drop_contact(network, contact);
    }
    network.contacts = renewal.end();
    network.candidates = candidates;
    network.cores = cores;
}

/// Returns the place of the first contact whose pair is not before this one: probably near the
/// start.
fn first_from<S: Space>(contacts: &[Contact<S>], pair: &(u32, u32)) -> usize {
    let before = |c: &Contact<S>| c.key.pair() < *pair;
    let mut end = 64;
    while end < contacts.len() && before(&contacts[end]) {
        end *= 2;
    }
    contacts[..end.min(contacts.len())].partition_point(before)
}

/// Cores of the convex pieces in world axes.
fn turned_cores<S: Space>(
    network: &mut Network<S>,
    scene: &Scene<S>,
    parallel: bool,
) -> Vec<S::Core> {
    use crate::geometry::convex::Core;
    const TURN: f64 = 100.0;
    let pieces = &scene.shapes.pieces;
    let mut cores = std::mem::take(&mut network.cores);
    if cores.len() != pieces.len() {
        cores = pieces.iter().map(|p| p.core.clone()).collect();
    }
    let divide = threads::pays(parallel, pieces.len(), TURN);
    let size = threads::any_size(CHUNK[1]);
    threads::for_chunks(divide, &mut cores, size, |first, cores| {
        for (core, piece) in cores.iter_mut().zip(&pieces[first..]) {
            let rotation = &scene.bodies.rotation[piece.body as usize];
            piece.core.turn_into(rotation, core);
        }
    });
    cores
}

/// What a task found, without its slice.
struct Part<S: Space> {
    kept: usize,
    read: usize,
    more: Vec<Contact<S>>,
    turned: Vec<Turned<S>>,
    events: Vec<Event<S>>,
}

impl<S: Space> From<Found<'_, S>> for Part<S> {
    fn from(found: Found<'_, S>) -> Self {
        Self {
            kept: found.kept,
            read: found.read,
            more: found.more,
            turned: found.turned,
            events: found.events,
        }
    }
}

impl<S: Space> Part<S> {
    fn settle(self, network: &mut Network<S>, renewal: &mut Renewal<S>, scene: &Scene<S>) {
        for turned in self.turned {
            let memory = &mut network.memory[turned.law as usize];
            memory.bonds[turned.slot as usize].opening_t = turned.opening;
            if let Some(rotation) = turned.rotation {
                memory.rotations[turned.slot as usize] = rotation;
            }
        }
        for event in self.events {
            match event {
                Event::Dropped(contact) => drop_contact(network, &contact),
                Event::New(contact, sizes) => {
                    let compliant = network.memory[contact.law as usize].compliant;
                    let step_size = &mut network.step_size;
                    let times = [scene.time, scene.h];
                    step_size.record_late(&contact, sizes, compliant, times, scene.bodies);
                }
            }
        }
        renewal.keep(self.kept, self.read);
        for contact in self.more {
            renewal.insert(contact);
        }
    }
}

/// The list of contacts while it is renewed: the new ones, room, and the old ones of pairs to come.
struct Renewal<S: Space> {
    contacts: Vec<Contact<S>>,
    /// Number of new ones.
    written: usize,
    /// Place of the first of the old ones to come.
    read: usize,
}

impl<S: Space> Renewal<S> {
    /// Keeps the first of the next `read` contacts.
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
            // Room for this one and some to come moves the old ones once.
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
        // A list that grew by doubling, or once was longer.
        let most = self.written + self.written / 4;
        if self.contacts.capacity() > most + 64 {
            self.contacts.shrink_to(self.written + self.written / 16);
        }
        self.contacts
    }
}
