//! Bodies that slide into the edge of a neighbour of what they slide over, where the overlaps of
//! the scene are as large as the edge is high: the error of the solver lets free bodies sink, and
//! what lay flush no longer does.

use super::partners::Partners;
use super::piece_centre;
use crate::bodies::Bodies;
use crate::contact::network::{Contact, Key, Network};
use crate::geometry::convex::ContactPoint;
use crate::geometry::convex::seam::{Beside, Edge, edges_at};
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};

/// Height of an edge that may be of the solution, and distance of the piece below, over the size of
/// the smaller of the two that meet.
const LOW: f64 = 5e-3;
const NEAR: f64 = 0.05;
/// How many overlaps may add up to the height of an edge, as in a stack.
const OVERLAPS: f64 = 10.0;
/// Share of its speed along a face that a body loses where it meets an edge and does not just touch
/// it.
const STOPPED: f64 = 1e-2;
/// Share of the load on it below which an impulse on a body is of rounding, at any tolerance.
const NOISE: f64 = 1e-3;
/// Cosine of the angle to a face up to which a contact holds what lies on it.
const HOLDS: f64 = 0.9;

/// What a contact did in a step.
pub struct Impact<S: Space> {
    /// Velocity of the candidate relative to the antagonist before the step (m/s).
    pub before: S::Vector,
    /// Mass of the contact along its normal (kg; kg/m in 2D).
    pub mass: f64,
}

/// Records bodies that meet such edges in this step, of length `h` from `time` (s). `impact` tells
/// what a contact did, from its place in the network; none of a compliant one. Velocities that a
/// step at this `tolerance` may be off by count as none.
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
        // What pressed before has been met.
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
        let made = edges.iter().filter(|edge| {
            let load = load_on(network, contact, edge, time);
            load.is_some_and(|load| {
                slides_into(contact, edge, &impact, tolerance.max(NOISE) * load)
            })
        });
        let height = made
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
            let pieces = shapes.pieces.len() as u64;
            network
                .step_size
                .record_edge(time, bodies, pair, height, pieces);
        }
    }
}

/// Whether it is by sliding along the face that a body meets its edge, and whether the impulse that
/// it receives there is more than `noise` (N s) and slows it.
fn slides_into<S: Space>(
    contact: &Contact<S>,
    edge: &Edge<S>,
    impact: &Impact<S>,
    noise: f64,
) -> bool {
    let across = edge.normal.dot(&impact.before);
    let along = impact.before - edge.normal * across;
    let closing = -contact.normal.dot(&along);
    let lands = (across * edge.normal.dot(&contact.normal)).abs();
    let impulse = contact.normal.dot(&contact.impulse);
    // What passes a side on which it presses slides along another face.
    let slides = along.dot(&along) > across * across;
    let slows = closing * impulse > STOPPED * impact.mass * along.dot(&along);
    slides && closing > lands && impulse > noise && slows
}

/// The impulse of the piece below on the body that slides (N s), none where it touched it first at
/// `time`, the start of the step; the edge may lift the body off it.
fn load_on<S: Space>(
    network: &Network<S>,
    contact: &Contact<S>,
    edge: &Edge<S>,
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

/// The low edges of a contact of two pieces that the solution may have made: of different bodies,
/// one of which is free to move.
fn edges_of<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    partners: &Partners,
    contact: &Contact<S>,
) -> Vec<Edge<S>> {
    let names = [contact.key.candidate, contact.key.antagonist];
    let piece = |name: u32| &shapes.pieces[(name & !Key::PIECE) as usize];
    let centre = |k: usize| piece_centre(&shapes.pieces[k], bodies);
    let (cores, pairs) = (&network.cores, &network.candidates);
    let pieces = names.map(piece);
    let free = |b: &Beside<S>| {
        let own = pieces[usize::from(!b.of_candidate)].body;
        let other = piece(b.name).body;
        own != other && [own, other].iter().any(|b| !bodies.immovable(*b as usize))
    };
    let mut beside = partners.beside(pairs, shapes, cores, centre, names);
    beside.retain(free);
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
    let cores = names.map(|name| &cores[(name & !Key::PIECE) as usize]);
    let roundings = pieces.map(|p| p.rounding);
    let reach = [LOW * size, NEAR * size];
    edges_at::<S>(cores, &apart, roundings, &point, reach, &beside)
}
