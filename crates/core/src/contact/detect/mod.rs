//! Contact detection at q_m, the positions (1 - theta) h after the start of a step: a neighbour
//! list with a skin (broad phase), then gaps and normals (narrow phase).

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
mod sorted_centres;
mod sweep;
mod update;

pub use edges::{Impact, record_edges};
pub use extents::{Extents, fast_motion};
pub use prediction::{
    StepMotion, add_predicted, find_missed, is_calm, report_first_move, report_passing,
};

use super::network::{Contact, Network};
use crate::bodies::Bodies;
use crate::geometry::convex::ConvexCollider;
use crate::geometry::shape::{Ball, Carried, Shapes};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{any, fill, worth_dividing};
use neighbours::{NeighbourSearch, joined};
use update::{PlacedScene, update_contacts};

/// Corners whose distance along a face is less than this fraction of the alert distance count as on
/// the face.
const SLACK: f64 = 0.01;
/// Approximate time to compute or compare a centre (ns).
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

/// Input of detection.
#[derive(Clone, Copy, Debug)]
pub struct CollisionScene<'a, S: Space> {
    /// Collision shapes.
    pub shapes: &'a Shapes<S>,
    /// Bodies of the shapes.
    pub bodies: &'a Bodies<S>,
    /// Laws of pairs of materials; pairs without one do not touch.
    pub laws: &'a LawTable,
}

impl<'a, S: Space> CollisionScene<'a, S> {
    /// Collects the parts of a scene.
    pub fn new(shapes: &'a Shapes<S>, bodies: &'a Bodies<S>, laws: &'a LawTable) -> Self {
        Self {
            shapes,
            bodies,
            laws,
        }
    }

    /// Numbers of balls and of convex pieces.
    fn counts(&self) -> [usize; 2] {
        [self.shapes.balls.len(), self.shapes.pieces.len()]
    }

    /// Velocities and spins of the bodies.
    fn velocities(&self) -> Vec<(S::Vector, S::Spin)> {
        let velocities = self.bodies.velocity.iter().copied();
        velocities.zip(self.bodies.spin.iter().copied()).collect()
    }

    /// Returns whether a surface rotates, with these velocities and spins of the bodies, so that
    /// its points move relative to its origin. Surfaces that deform do not count: their vertices
    /// are tracked one by one.
    fn sweeps(&self, surface: &Carried<S>, spin: &S::Spin) -> bool {
        let own = S::unrotate_spin(&self.bodies.rotation[surface.body as usize], spin);
        !surface.shape.deforms() && !surface.shape.is_unchanged_by(&own)
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
/// Contacts that separate lose their memory; an intact bond keeps its contact at any gap. `time` is
/// the time at the start of the step and `h` the time since the last detection (s). Pairs are
/// divided among several threads if `parallel`; the results are the same.
pub fn detect<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    [time, h]: [f64; 2],
    parallel: bool,
) {
    let centres = centres(scene, parallel);
    if must_rebuild(network, scene, &centres, parallel) {
        let velocities = scene.velocities();
        let motion = StepMotion {
            velocities: &velocities,
            time,
            h,
            parallel,
        };
        rebuild(network, scene, &centres, &motion);
    }
    let placed = PlacedScene {
        scene,
        centres: &centres,
        time,
        h,
    };
    update_contacts(network, &placed, parallel);
}

/// Returns the centres of the balls, then of the convex pieces (m).
fn centres<S: Space>(scene: &CollisionScene<S>, parallel: bool) -> Vec<S::Vector> {
    let [balls, pieces] = scene.counts();
    let (shapes, bodies, count) = (scene.shapes, scene.bodies, balls + pieces);
    let (mut centres, divide) = (Vec::new(), worth_dividing(parallel, count, CENTRE));
    fill(divide, &mut centres, count, |k| {
        match k.checked_sub(balls) {
            Some(k) => piece_centre(&shapes.pieces[k], bodies),
            None => centre(&shapes.balls[k], bodies),
        }
    });
    centres
}

/// Returns the points that the neighbour list tracks beside the centres of balls and pieces (m):
/// the centres of the bodies that carry surfaces, then the vertices of surfaces that deform.
fn watched_of_surfaces<'a, S: Space>(
    scene: &'a CollisionScene<S>,
) -> impl Iterator<Item = S::Vector> + 'a {
    let surfaces = &scene.shapes.surfaces;
    let frames = surfaces
        .iter()
        .map(|s| scene.bodies.position[s.body as usize]);
    let vertices = surfaces.iter().flat_map(|s| {
        let (origin, rotation) = frame(s, scene.bodies);
        let vertices = s.shape.moving_vertices().iter();
        vertices.map(move |x| origin + S::rotate(&rotation, x))
    });
    frames.chain(vertices)
}

/// Returns whether the neighbour list no longer covers all pairs within the search distance.
fn must_rebuild<S: Space>(
    network: &Network<S>,
    scene: &CollisionScene<S>,
    centres: &[S::Vector],
    parallel: bool,
) -> bool {
    let surfaces = &scene.shapes.surfaces;
    let vertices = surfaces.iter().map(|s| s.shape.moving_vertices().len());
    let watched = centres.len() + surfaces.len() + vertices.sum::<usize>();
    let spin = |s: &Carried<S>| &scene.bodies.spin[s.body as usize];
    if network.seen_at.len() != watched || surfaces.iter().any(|s| scene.sweeps(s, spin(s))) {
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
    let mut surfaces = watched_of_surfaces(scene).zip(&seen_at[centres.len()..]);
    any(parallel, centres.len(), CENTRE, centre) || surfaces.any(|(x, seen)| left(x, seen))
}

/// Builds the neighbour list: the pairs that may touch before a shape has moved by half the skin.
fn rebuild<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    centres: &[S::Vector],
    motion: &StepMotion<S>,
) {
    // Frees the memory of the old list before the new one is built.
    network.candidates = Vec::new();
    let search = NeighbourSearch::new(network, scene, centres, motion.parallel);
    let pairs = search.pairs_of_balls();
    let (mut more, turning) =
        search.pairs_with_surfaces(&network.widened, motion.velocities, motion.h);
    // A bond may be longer than the search distance.
    let held = |c: &&Contact<S>| {
        network.bond(c).is_some_and(|b| b.intact())
            && !c.bodies.iter().any(|b| scene.bodies.removed[*b as usize])
    };
    more.extend(network.contacts.iter().filter(held).map(|c| c.key.pair()));
    network.candidates = joined(pairs, more);
    network.turning = turning;
    network.seen_at.clear();
    network.seen_at.extend_from_slice(centres);
    network.seen_at.extend(watched_of_surfaces(scene));
    network.grown = 0.0;
    network.rebuilds += 1;
}

/// Returns the centre of a convex piece (m).
pub fn piece_centre<S: Space>(piece: &ConvexCollider<S>, bodies: &Bodies<S>) -> S::Vector {
    let b = piece.body as usize;
    bodies.position[b] + S::rotate(&bodies.rotation[b], &piece.offset)
}

/// Returns origin (m) and rotation of a surface.
fn frame<S: Space>(surface: &Carried<S>, bodies: &Bodies<S>) -> (S::Vector, S::Rotation) {
    let b = surface.body as usize;
    let rotation = bodies.rotation[b];
    (
        bodies.position[b] + S::rotate(&rotation, &surface.offset),
        rotation,
    )
}

/// Frees the memory of a contact that ends; an intact bond breaks.
fn drop_contact<S: Space>(network: &mut Network<S>, contact: &Contact<S>) {
    let Some(slot) = contact.memory() else {
        return;
    };
    let law = contact.law as usize;
    let bond = &mut network.memory[law].bonds[slot];
    if bond.intact() {
        // The contact of an intact bond ends only beyond the end of a surface.
        let (torn, damage) = (bond.energy, bond.damage);
        bond.energies.fracture += torn;
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

/// Returns whether an old contact, if there is one, has an intact bond.
#[inline]
fn held<S: Space>(network: &Network<S>, old: Option<&Contact<S>>) -> bool {
    old.is_some_and(|c| network.bond(c).is_some_and(|b| b.intact()))
}

#[cfg(test)]
mod tests;
