//! Loaded contacts of a first body, and what is on their other side.

use super::{SlidingBody, SlidingPart};
use crate::contact::network::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;

/// What lies on the other side of a contact of the rubbed body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counterpart {
    /// A rigid body that is not a grain, by its index among the driven bodies.
    Driven(usize),
    /// A deformable body that is not a grain, by its index among the systems.
    System(usize),
    /// A grain.
    Grain,
}

/// A loaded contact of the rubbed body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<S: Space> {
    pub counterpart: Counterpart,
    /// Impulse on the rubbed body (N s).
    pub impulse: S::Vector,
    /// Unit normal towards the rubbed body.
    pub normal: S::Vector,
    /// Vectors from the centres of the rubbed body and of the other one to the contact (m).
    pub arms: [S::Vector; 2],
}

impl SlidingBody {
    /// Returns the loaded contacts of the body.
    pub(super) fn sides<S: Space>(&self, s: &Simulation<S>) -> impl Iterator<Item = Side<S>> {
        let bodies = &s.state.bodies;
        let own = match self.part {
            SlidingPart::Driven(place) => Some(bodies.driven[place].body),
            SlidingPart::System { .. } => None,
        };
        let index = match self.part {
            SlidingPart::System { system, .. } => Some(system as u32),
            SlidingPart::Driven(_) => None,
        };
        let is = move |body: u32| match own {
            Some(own) => body == own,
            None => bodies.carrier(body as usize).map(|c| c.system) == index,
        };
        loaded(s).filter_map(move |c| {
            let [i, j] = c.bodies;
            match (is(i), is(j)) {
                (true, _) => Some(Side {
                    counterpart: counterpart(s, j),
                    impulse: c.impulse,
                    normal: c.normal,
                    arms: c.arms,
                }),
                (false, true) => Some(Side {
                    counterpart: counterpart(s, i),
                    impulse: -c.impulse,
                    normal: -c.normal,
                    arms: [c.arms[1], c.arms[0]],
                }),
                (false, false) => None,
            }
        })
    }

    /// Returns whether this is the rubbed body.
    pub(super) fn is(&self, part: Counterpart) -> bool {
        match self.part {
            SlidingPart::Driven(place) => part == Counterpart::Driven(place),
            SlidingPart::System { system, .. } => part == Counterpart::System(system),
        }
    }
}

/// Returns the contacts that carry a load.
pub(super) fn loaded<S: Space>(s: &Simulation<S>) -> impl Iterator<Item = &Contact<S>> {
    let contacts = s.state.network.contacts.iter();
    contacts.filter(|c| c.impulse.norm() > 0.0)
}

/// Returns what a body of a contact is.
pub(super) fn counterpart<S: Space>(s: &Simulation<S>, body: u32) -> Counterpart {
    let bodies = &s.state.bodies;
    if let Some(carrier) = bodies.carrier(body as usize) {
        return match carrier.grain {
            true => Counterpart::Grain,
            false => Counterpart::System(carrier.system as usize),
        };
    }
    let driven = bodies.driven.iter().position(|d| d.body == body);
    driven.map_or(Counterpart::Grain, Counterpart::Driven)
}
