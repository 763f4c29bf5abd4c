//! Contact detection at q_m: a neighbour list with a skin (broad phase), then gaps and normals
//! (narrow phase).

mod convex_pair;
mod edges;
mod extents;
mod margin;
mod meeting;
mod narrow;
mod neighbours;
mod order;
mod partners;
mod prediction;
mod renewal;
mod sorted;
mod sweep;

pub use edges::{Impact, record_edges};
pub use extents::{Extents, fast_motion};
pub use prediction::{
    Motion, add_predicted, find_missed, is_calm, report_first_move, report_passing,
};

use super::network::{Contact, Network};
use crate::bodies::Bodies;
use crate::geometry::convex::ConvexCollider;
use crate::geometry::shape::{Ball, Shapes};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{any, fill, pays};
use neighbours::{NeighbourSearch, joined};
use renewal::{Scene, renew_contacts};

/// Corners whose distance along a face is less than this fraction of the alert distance count as on
/// the face.
const SLACK: f64 = 0.01;
/// About what a pass over centres takes for each (ns).
const CENTRE: f64 = 4.0;

/// Index of the interface law of each pair of materials, in row-major order; `None` where no law is
/// given.
#[derive(Clone, Debug)]
pub struct LawTable {
    materials: usize,
    laws: Vec<Option<u16>>,
}

impl LawTable {
    /// Creates a table in which no pair has a law.
    pub fn new(materials: usize) -> Self {
        Self {
            materials,
            laws: vec![None; materials * materials],
        }
    }

    /// Sets the law of a pair, in both orders.
    pub fn set(&mut self, a: u16, b: u16, law: u16) {
        let (a, b) = (a as usize, b as usize);
        self.laws[a * self.materials + b] = Some(law);
        self.laws[b * self.materials + a] = Some(law);
    }

    /// Returns the law of a pair.
    #[inline]
    pub fn get(&self, a: u16, b: u16) -> Option<u16> {
        self.laws[a as usize * self.materials + b as usize]
    }
}

/// Returns the centre of a ball (m).
#[inline]
pub fn centre<S: Space>(ball: &Ball<S>, bodies: &Bodies<S>) -> S::Vector {
    let b = ball.body as usize;
    if ball.offset == S::Vector::zero() {
        bodies.position[b]
    } else {
        bodies.position[b] + S::rotate(&bodies.rotation[b], &ball.offset)
    }
}

/// Finds the contacts of this step at the current positions and carries their memory over.
///
/// Contacts that separate lose their memory; an intact bond keeps its contact at any gap. `h` is
/// the time since the last detection (s). Contact points of convex pairs are found by several
/// threads if `parallel`; the results are the same.
pub fn detect<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    [time, h]: [f64; 2],
    parallel: bool,
) {
    let centres = centres(shapes, bodies, parallel);
    if must_rebuild(network, shapes, bodies, &centres, parallel) {
        let velocities = bodies.velocity.iter().copied();
        let velocities: Vec<_> = velocities.zip(bodies.spin.iter().copied()).collect();
        let motion = Motion {
            velocities: &velocities,
            time,
            h,
            parallel,
        };
        rebuild(network, shapes, bodies, laws, &centres, &motion);
    }
    let scene = Scene {
        shapes,
        bodies,
        centres: &centres,
        laws,
        time,
        h,
    };
    renew_contacts(network, &scene, parallel);
}

/// Returns the centres of the balls, then of the convex pieces (m).
fn centres<S: Space>(shapes: &Shapes<S>, bodies: &Bodies<S>, parallel: bool) -> Vec<S::Vector> {
    let balls = &shapes.balls;
    let count = balls.len() + shapes.pieces.len();
    let mut centres = Vec::new();
    fill(pays(parallel, count, CENTRE), &mut centres, count, |k| {
        if k < balls.len() {
            return centre(&balls[k], bodies);
        }
        let piece = &shapes.pieces[k - balls.len()];
        frame(piece.body, &piece.offset, bodies).0
    });
    centres
}

/// Returns the points that the neighbour list tracks beside the centres of balls and pieces: the
/// frames of the surfaces, and the vertices of surfaces that deform.
fn watched_of_surfaces<'a, S: Space>(
    shapes: &'a Shapes<S>,
    bodies: &'a Bodies<S>,
) -> impl Iterator<Item = S::Vector> + 'a {
    let frames = shapes
        .surfaces
        .iter()
        .map(|s| bodies.position[s.body as usize]);
    let vertices = shapes.surfaces.iter().flat_map(move |s| {
        let (origin, rotation) = frame(s.body, &s.offset, bodies);
        let vertices = s.shape.moving_vertices().iter();
        vertices.map(move |x| origin + S::rotate(&rotation, x))
    });
    frames.chain(vertices)
}

fn must_rebuild<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    centres: &[S::Vector],
    parallel: bool,
) -> bool {
    let surfaces = shapes.surfaces.iter();
    let vertices: usize = surfaces.map(|s| s.shape.moving_vertices().len()).sum();
    if network.seen_at.len() != centres.len() + shapes.surfaces.len() + vertices {
        return true;
    }
    // A rotating surface moves more than its frame does; of one that deforms each vertex is
    // watched.
    if shapes.surfaces.iter().any(|s| {
        let b = s.body as usize;
        let spin = S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]);
        !s.shape.keeps_place(&spin) && !s.shape.deforms()
    }) {
        return true;
    }
    let half = (0.5 * network.skin - network.grown).max(0.0);
    let limit = half * half;
    let left = |x: S::Vector, seen: &S::Vector| {
        let d = x - *seen;
        d.dot(&d) > limit
    };
    let seen_at = &network.seen_at;
    let centre = |k: usize| left(centres[k], &seen_at[k]);
    let mut surfaces = watched_of_surfaces(shapes, bodies).zip(&seen_at[centres.len()..]);
    any(parallel, centres.len(), CENTRE, centre) || surfaces.any(|(x, seen)| left(x, seen))
}

/// Builds the neighbour list: the pairs that may touch before one of them leaves its skin.
fn rebuild<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    centres: &[S::Vector],
    motion: &Motion<S>,
) {
    // The old list makes room for the new one.
    network.candidates = Vec::new();
    let search = NeighbourSearch::new(network, shapes, bodies, laws, centres, motion.parallel);
    let pairs = search.pairs_of_balls();
    let (mut more, turning) =
        search.pairs_with_surfaces(&network.widened, motion.velocities, motion.h);
    // A bond may be longer than the search distance.
    let held = |c: &&Contact<S>| {
        network.bond(c).is_some_and(|b| b.intact())
            && !c.bodies.iter().any(|b| bodies.removed[*b as usize])
    };
    more.extend(network.contacts.iter().filter(held).map(|c| c.key.pair()));
    network.candidates = joined(pairs, more);
    network.turning = turning;
    network.seen_at.clear();
    network.seen_at.extend_from_slice(centres);
    let of_surfaces = watched_of_surfaces(shapes, bodies);
    network.seen_at.extend(of_surfaces);
    network.grown = 0.0;
    network.rebuilds += 1;
}

/// Where the centre of a piece stands (m).
pub fn piece_centre<S: Space>(piece: &ConvexCollider<S>, bodies: &Bodies<S>) -> S::Vector {
    let b = piece.body as usize;
    bodies.position[b] + S::rotate(&bodies.rotation[b], &piece.offset)
}

/// Origin and rotation of a surface carried by a body.
fn frame<S: Space>(body: u32, offset: &S::Vector, bodies: &Bodies<S>) -> (S::Vector, S::Rotation) {
    let b = body as usize;
    let rotation = bodies.rotation[b];
    (bodies.position[b] + S::rotate(&rotation, offset), rotation)
}

fn drop_contact<S: Space>(network: &mut Network<S>, contact: &Contact<S>) {
    let Some(slot) = contact.memory() else {
        return;
    };
    let law = contact.law as usize;
    let bond = &mut network.memory[law].bonds[slot];
    if bond.intact() {
        // A grain beyond the end of its surface breaks the bond.
        let (torn, damage) = (bond.energy, bond.damage);
        bond.life.fracture += torn;
        network.torn_energy += torn;
        network.memory[law].broken += 1;
        network.broken_pairs.insert(contact.key.pair());
        network.record_break(contact, damage);
        if let Some(record) = network.bond_breaks.last_mut() {
            record.torn = torn;
        }
    }
    network.memory[law].release(slot as u32);
}

#[inline]
fn held<S: Space>(network: &Network<S>, old: Option<&Contact<S>>) -> bool {
    old.is_some_and(|c| network.bond(c).is_some_and(|b| b.intact()))
}

#[cfg(test)]
mod tests;
