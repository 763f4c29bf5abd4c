//! Contacts as lines between their ends, with state, bonds and forces.

use super::images;
use crate::{Link, LinkState};
use fretwork_core::contact::Contact;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_observe::placement::{BondState, bond_state, ends};

/// State of a contact in pictures.
pub fn state<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> LinkState {
    match bond_state(s, contact) {
        BondState::Intact { damage } => LinkState::Intact { damage },
        BondState::Broken => LinkState::Broken,
        BondState::None => LinkState::Plain,
    }
}

/// The contacts that carry force, or had a bond, with the state of their bonds.
pub(crate) fn links<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Vec<Link> {
    links_in(s, window, |contact| state(s, contact))
}

/// The contacts that carry force, with those of the chains marked.
pub(crate) fn forces<S: Space>(
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
        .state
        .network
        .contacts
        .iter()
        .map(|c| c.impulse.norm())
        .filter(|p| *p > 0.0)
        .collect();
    let mean = loaded.iter().sum::<f64>() / loaded.len().max(1) as f64;
    let mut out = Vec::new();
    for contact in &s.state.network.contacts {
        let state = state(contact);
        let force = contact.impulse.norm();
        // A candidate pair without force is not drawn.
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
