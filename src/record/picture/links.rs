//! Contacts as lines between their ends: their state, bonds and forces.

use super::{images, is_first};
use crate::contact::{Contact, Key};
use crate::geometry::space::{Space, VectorLike};
use crate::report::{Link, LinkState};
use crate::step::Simulation;

/// The state of a contact in pictures and files.
pub fn state<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> LinkState {
    match s.network.bond(contact) {
        Some(bond) if bond.intact() => LinkState::Intact {
            damage: bond.damage,
        },
        _ if contact.broken => LinkState::Broken,
        _ => LinkState::Plain,
    }
}

/// The two ends of a contact: the candidate's centre, and the antagonist's centre or the foot on a
/// surface.
pub fn ends<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> (S::Vector, S::Vector) {
    let key = &contact.key;
    let (Some(candidate), 0) = (key.ball(), key.antagonist & Key::PIECE) else {
        return ends_of_piece(s, contact);
    };
    let ball = &s.shapes.balls[candidate];
    let a = crate::contact::detect::centre(ball, &s.bodies);
    let length = match key.surface() {
        Some(_) => ball.radius + contact.gap,
        None => {
            let other = &s.shapes.balls[key.antagonist as usize];
            ball.radius + other.radius + contact.gap
        }
    };
    (a, a - contact.normal * length)
}

/// The same where a piece is in it: by way of the contact point, which is the end at a first body.
fn ends_of_piece<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> (S::Vector, S::Vector) {
    let centre = s.bodies.position[contact.bodies[0] as usize];
    let at = centre + contact.arms[0];
    let foot = at - contact.normal * contact.gap;
    let [first, other] = contact.bodies.map(|b| is_first(s, b));
    let a = if first { at } else { centre };
    let b = if other || contact.key.surface().is_some() {
        foot
    } else {
        foot - contact.arms[1]
    };
    (a, b)
}

/// The contacts that carry force, or had a bond, with the state of their bonds.
pub(super) fn links<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Vec<Link> {
    links_in(s, window, |contact| state(s, contact))
}

/// The contacts that carry force, those of the chains told apart.
pub(super) fn forces<S: Space>(
    s: &Simulation<S>,
    window: [f64; 4],
    chains: &[[u32; 2]],
) -> Vec<Link> {
    let pair = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    links_in(s, window, |contact| {
        let presses = contact.normal.dot(&contact.impulse) > 0.0;
        if presses && chains.binary_search(&pair(contact.bodies)).is_ok() {
            LinkState::Chain
        } else {
            LinkState::Plain
        }
    })
}

fn links_in<S: Space>(
    s: &Simulation<S>,
    window: [f64; 4],
    state: impl Fn(&Contact<S>) -> LinkState,
) -> Vec<Link> {
    let period = s.shapes.periodic.period[0];
    let loaded: Vec<f64> = s
        .network
        .contacts
        .iter()
        .map(|c| c.impulse.norm())
        .filter(|p| *p > 0.0)
        .collect();
    let mean = loaded.iter().sum::<f64>() / loaded.len().max(1) as f64;
    let mut out = Vec::new();
    for contact in &s.network.contacts {
        let state = state(contact);
        let force = contact.impulse.norm();
        // A plain candidate pair that carries nothing is no interaction.
        if state == LinkState::Plain && force == 0.0 {
            continue;
        }
        let (a, b) = ends(s, contact);
        let width = if mean > 0.0 {
            (force / mean).clamp(0.3, 3.0)
        } else {
            0.5
        };
        for x in images(a[0], (b - a).norm(), window, period) {
            out.push(Link {
                a: [x, a[1]],
                b: [b[0] - a[0] + x, b[1]],
                state,
                width,
            });
        }
    }
    out
}
