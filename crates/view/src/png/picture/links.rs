//! Contacts as lines between their ends, with state, bonds and forces.

use super::images;
use crate::{Link, LinkState};
use fretwork_core::contact::BondState;
use fretwork_core::view::{ContactView, RunView};
use nalgebra::Vector3;

/// State of a contact in pictures.
pub fn state(contact: &ContactView) -> LinkState {
    match contact.bond {
        BondState::Intact { damage } => LinkState::Intact { damage },
        BondState::Broken => LinkState::Broken,
        BondState::None => LinkState::Plain,
    }
}

/// Returns the contacts that carry force or had a bond, with the state of their bonds.
pub(crate) fn links(run: &dyn RunView, window: [f64; 4]) -> Vec<Link> {
    links_in(run, window, state)
}

/// Returns the contacts that carry force, with those of the force chains marked.
pub(crate) fn forces(run: &dyn RunView, window: [f64; 4], chains: &[[u32; 2]]) -> Vec<Link> {
    let pair = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    links_in(run, window, |contact| {
        let presses = Vector3::from(contact.normal).dot(&Vector3::from(contact.impulse)) > 0.0;
        if presses && chains.binary_search(&pair(contact.bodies)).is_ok() {
            LinkState::Chain
        } else {
            LinkState::Plain
        }
    })
}

fn links_in(
    run: &dyn RunView,
    window: [f64; 4],
    state: impl Fn(&ContactView) -> LinkState,
) -> Vec<Link> {
    let period = run.periodic().period[0];
    let norm = |v: [f64; 3]| Vector3::from(v).norm();
    let mut loaded: Vec<f64> = Vec::new();
    run.visit_contacts(&mut |contact| {
        let impulse = norm(contact.impulse);
        if impulse > 0.0 {
            loaded.push(impulse);
        }
    });
    let mean = loaded.iter().sum::<f64>() / loaded.len().max(1) as f64;
    let mut out = Vec::new();
    run.visit_contacts(&mut |contact| {
        let state = state(contact);
        let force = norm(contact.impulse);
        // A candidate pair without force is not drawn.
        if state == LinkState::Plain && force == 0.0 {
            return;
        }
        let [a, b] = run.ends_of_contact(contact.place).map(Vector3::from);
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
    });
    out
}
