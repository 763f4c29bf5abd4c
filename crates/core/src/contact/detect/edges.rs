//! Bodies that meet the edge of a neighbour of what they slide over: it stands out by what a loose solution lets free bodies sink.

use super::partners::Partners;
use super::piece_centre;
use crate::bodies::Bodies;
use crate::contact::network::{Contact, Key, Network};
use crate::geometry::convex::ContactPoint;
use crate::geometry::convex::seam::{Beside, is_at_edge};
use crate::geometry::shape::Shapes;
use crate::geometry::space::Space;

/// Height of an edge that may be of the solution, and distance of the piece beside it, over the size of the smallest piece.
const LOW: f64 = 5e-3;
const NEAR: f64 = 0.05;

/// Records what bodies lose at edges that are so low in this step, of length `h` from `time` (s): the impacts above `least` (J) among those that
/// contacts in their order dissipated.
pub fn record_edges<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    [time, h]: [f64; 2],
    impact: impl Fn(usize, &Contact<S>) -> f64,
    least: f64,
) {
    if shapes.pieces.is_empty() {
        return;
    }
    let partners = Partners::default();
    let mut met = Vec::new();
    for (k, contact) in network.contacts.iter().enumerate() {
        let Key {
            candidate,
            antagonist,
            ..
        } = contact.key;
        let pieces = candidate & antagonist & Key::PIECE != 0;
        // What pressed before has lost its speed.
        if !pieces || contact.compression_time > h {
            continue;
        }
        let lost = impact(k, contact);
        if lost > least && is_edge(network, shapes, bodies, &partners, contact) {
            met.push((contact.bodies, lost));
        }
    }
    for (pair, lost) in met {
        network.step_size.record_edge(time, bodies, pair, lost);
    }
}

/// Whether a contact of two pieces is at a low edge which the solution may have made: of two bodies, one of which is free to move.
fn is_edge<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    partners: &Partners,
    contact: &Contact<S>,
) -> bool {
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
    is_at_edge::<S>(
        cores,
        &apart,
        roundings,
        &point,
        [LOW * size, NEAR * size],
        &beside,
    )
}
