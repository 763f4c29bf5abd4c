//! Detects bodies that slide over one piece into the edge of its neighbour, where overlaps of the
//! scene are as large as the height of the edge: free bodies sink by the error of the solver, so
//! that faces are no longer flush.

use super::partners::Partners;
use super::piece_centre;
use crate::bodies::Bodies;
use crate::contact::Occurrence;
use crate::contact::network::{Contact, Key, Network};
use crate::geometry::convex::seam::{AdjacentPiece, SeamEdge, edges_at};
use crate::geometry::convex::{ContactPoint, ContactTolerances, CorePair};
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};

/// Greatest height of an edge that the solution may have caused, and greatest distance of the piece
/// below, as fractions of the size of the smaller piece.
const LOW: f64 = 5e-3;
const NEAR: f64 = 0.05;
/// Number of overlaps that may add up to the height of an edge, as in a stack.
const OVERLAPS: f64 = 10.0;
/// Fraction of its speed along a face that a body loses where an edge stops it.
const STOPPED: f64 = 1e-2;
/// Fraction of the load on a body below which an impulse is a rounding error, at any tolerance.
const NOISE: f64 = 1e-3;
/// Cosine of the angle to a face up to which a contact supports the body that lies on it.
const HOLDS: f64 = 0.9;

/// The impact at a contact in a step.
pub struct Impact<S: Space> {
    /// Velocity of the candidate relative to the antagonist before the step (m/s).
    pub before: S::Vector,
    /// Mass of the contact along its normal (kg; kg/m in 2D).
    pub mass: f64,
}

/// Records bodies that meet low edges in this step, of length `h` from `time` (s). `impact` returns
/// the impact at a contact, given its index in the network; `None` for compliant ones. Velocities
/// below the error of a solution at this `tolerance` count as zero.
pub fn record_edges<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    [time, h]: [f64; 2],
    tolerance: f64,
    impact: impl Fn(usize, &Contact<S>) -> Option<Impact<S>>,
) {
    if shapes.pieces.is_empty() {
        return;
    }
    let partners = Partners::default();
    let mut met = Vec::new();
    for (k, contact) in network.contacts.iter().enumerate() {
        let pieces = contact.key.candidate & contact.key.antagonist & Key::PIECE != 0;
        let new = contact.compression_time <= h && contact.normal.dot(&contact.impulse) > 0.0;
        if !pieces || !new {
            continue;
        }
        let Some(impact) = impact(k, contact) else {
            continue;
        };
        if contact.normal.dot(&impact.before) >= 0.0 {
            continue;
        }
        let edges = edges_of(network, shapes, bodies, &partners, contact);
        let stops = edges.iter().filter(|edge| {
            let load = load_on(network, contact, edge, time);
            load.is_some_and(|load| {
                slides_into(contact, edge, &impact, tolerance.max(NOISE) * load)
            })
        });
        let height = stops
            .map(|edge| edge.height)
            .fold(f64::NEG_INFINITY, f64::max);
        if height.is_finite() {
            met.push((contact.bodies, height));
        }
    }
    if met.is_empty() {
        return;
    }
    let gaps = network.contacts.iter().map(|c| c.gap);
    let overlap = gaps.fold(0.0, |deepest: f64, gap| deepest.max(-gap));
    for (pair, height) in met {
        if height <= OVERLAPS * overlap {
            let first = || Occurrence::new(time, bodies, &pair);
            let pieces = shapes.pieces.len() as u64;
            network.step_size.record_edge(height, pieces, first);
        }
    }
}

/// Returns whether a body meets an edge by sliding along the face, and whether the impulse that it
/// receives there is more than `noise` (N s) and slows it.
fn slides_into<S: Space>(
    contact: &Contact<S>,
    edge: &SeamEdge<S>,
    impact: &Impact<S>,
    noise: f64,
) -> bool {
    let across = edge.normal.dot(&impact.before);
    let along = impact.before - edge.normal * across;
    let closing = -contact.normal.dot(&along);
    let lands = (across * edge.normal.dot(&contact.normal)).abs();
    let impulse = contact.normal.dot(&contact.impulse);
    // A body that moves mainly across this face slides along another one.
    let slides = along.dot(&along) > across * across;
    let slows = closing * impulse > STOPPED * impact.mass * along.dot(&along);
    slides && closing > lands && impulse > noise && slows
}

/// Returns the impulse of the piece below on the sliding body (N s); `None` if the two first
/// touched at `time`, the start of the step. The edge may lift the body off that piece.
fn load_on<S: Space>(
    network: &Network<S>,
    contact: &Contact<S>,
    edge: &SeamEdge<S>,
    time: f64,
) -> Option<f64> {
    let slider = if edge.of_candidate {
        contact.key.antagonist
    } else {
        contact.key.candidate
    };
    let pair = (slider.min(edge.below), slider.max(edge.below));
    let contacts = &network.contacts;
    let first = contacts.partition_point(|c| c.key.pair() < pair);
    let of_pair = contacts[first..]
        .iter()
        .take_while(|c| c.key.pair() == pair);
    let holds = |c: &&Contact<S>| c.formed_at < time && c.normal.dot(&edge.normal).abs() > HOLDS;
    let loads = of_pair.filter(holds).map(|c| c.normal.dot(&c.impulse));
    loads.reduce(|a, b| a + b)
}

/// Returns the low edges at a contact of two pieces that the solution may have caused: they belong
/// to different bodies, one of which is free to move.
fn edges_of<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    partners: &Partners,
    contact: &Contact<S>,
) -> Vec<SeamEdge<S>> {
    let names = [contact.key.candidate, contact.key.antagonist];
    let piece = |name: u32| &shapes.pieces[(name & !Key::PIECE) as usize];
    let centre = |k: usize| piece_centre(&shapes.pieces[k], bodies);
    let (cores, pairs) = (&network.cores, &network.candidates);
    let pieces = names.map(piece);
    let free = |b: &AdjacentPiece<S>| {
        let own = pieces[usize::from(!b.of_candidate)].body;
        let other = piece(b.name).body;
        own != other && [own, other].iter().any(|b| !bodies.immovable(*b as usize))
    };
    let mut adjacent = partners.adjacent(pairs, shapes, cores, centre, names);
    adjacent.retain(free);
    let [at, origin] = pieces.map(|p| piece_centre(p, bodies));
    let apart = shapes.periodic.shortest(at - origin);
    let on = |side: usize| {
        let place = bodies.position[contact.bodies[side] as usize] + contact.arms[side];
        place - [at, origin][side]
    };
    let point = ContactPoint {
        on_candidate: apart + on(0),
        on_antagonist: on(1),
        normal: contact.normal,
        gap: contact.gap,
        feature: contact.key.feature,
        share: 0.0,
        facing: false,
    };
    let sizes = pieces.iter().map(|p| p.size);
    let size = sizes.fold(f64::INFINITY, f64::min);
    let pair = CorePair::<S> {
        cores: names.map(|name| &cores[(name & !Key::PIECE) as usize]),
        apart,
        roundings: pieces.map(|p| p.rounding),
        tolerances: ContactTolerances::default(),
    };
    edges_at(&pair, &point, [LOW * size, NEAR * size], &adjacent)
}
