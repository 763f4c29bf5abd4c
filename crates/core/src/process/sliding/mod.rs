//! Force and sliding of the rubbed body of a friction test.

mod contacts;
mod motion;

pub use motion::{ACROSS, first_body_paths, step_velocity};

use crate::geometry::space::Space;
use crate::step::Simulation;
use contacts::Counterpart;
use motion::system_velocity;
use serde::{Deserialize, Serialize};

/// The part that slides in a friction test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SlidingPart {
    /// A rigid body, by its index among the driven bodies.
    Driven(usize),
    /// A deformable body, by its index among the systems, and the holder that moves it.
    System {
        /// Index of the system.
        system: usize,
        /// Index among its holders.
        holder: usize,
    },
}

/// Force and sliding distance of a rubbed body, over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlidingStep {
    /// Tangential force that moves the body (N; N/m in 2D).
    pub force: f64,
    /// Sliding distance over the step (m), signed: of the body relative to what it rubs against.
    pub slide: f64,
    /// Distance over the step in the plane of the contacts (m), positive, the mean over the
    /// contacts with their loads as weights: other than `slide` where the body slides across the
    /// axis too, or turns.
    pub travel: f64,
    /// Distance that the faster of the body and what it rubs against moves along the axis (m).
    pub moved: f64,
    /// Fraction of the step at which the force has this value; 1/2 for a mean.
    pub at: f64,
}

impl SlidingStep {
    /// Returns the work of sliding over the step (J; J/m in 2D) with the force at its middle, which
    /// is interpolated between this force and that of the previous step (N; N/m): the sum over a
    /// loop is its area.
    pub fn work(&self, before: f64) -> f64 {
        if self.at == 0.5 {
            return self.force * self.slide;
        }
        (self.force - (self.at - 0.5) * (self.force - before)) * self.slide
    }
}

/// A body that slides along an axis in a friction test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlidingBody {
    /// The part that slides.
    pub part: SlidingPart,
    /// Axis of sliding.
    pub along: usize,
    /// Axis of the normal load.
    pub normal: usize,
}

impl SlidingBody {
    /// Returns force and sliding distance in the last step. The force is that of the drive, for a
    /// deformable body that of the holder that moves it. What it rubs against may move too: the
    /// velocities of its counterparts at their contacts are averaged with the normal loads as
    /// weights. Behind grains, the counterpart is that of the other first bodies which carries the
    /// load of grains.
    ///
    /// Where a motion that is imposed makes contacts slide oblique to the axis, or in opposite
    /// directions as of a disc under two pins, the distance is the mean of theirs in their plane
    /// and the force the sum of theirs, each against its own direction: force times distance is
    /// their work. Their sign is that of the rotation, or of the motion along the axis.
    pub fn drive<S: Space>(&self, s: &Simulation<S>) -> SlidingStep {
        let h = s.options.scheme.h;
        let (own, force, at) = match self.part {
            SlidingPart::Driven(place) => {
                let force = -s.state.received[place].0[self.along] / h;
                (step_velocity(s, place), force, 0.5)
            }
            SlidingPart::System { system, holder } => {
                let holders = s.state.systems.get(system).map(|s| s.holders());
                let held = holders.as_ref().and_then(|h| h.get(holder));
                let Some(held) = held else {
                    return SlidingStep::default();
                };
                let mut own = system_velocity(s, system);
                own[self.along] = held.velocity;
                (own, held.force, held.at)
            }
        };
        let relative = self.relative_motion(s, &own);
        if let Some((velocity, power)) = relative.in_plane {
            return SlidingStep {
                force: if velocity == 0.0 {
                    0.0
                } else {
                    power / velocity
                },
                slide: h * velocity,
                travel: h * relative.speed,
                moved: h * velocity.abs(),
                at: 0.5,
            };
        }
        let counter = relative.counter;
        SlidingStep {
            force,
            slide: h * (own[self.along] - counter),
            travel: h * relative.speed,
            moved: h * own[self.along].abs().max(counter.abs()),
            at,
        }
    }

    /// Returns the normal force of its contacts, the mean over the last step (N; N/m in 2D),
    /// positive in compression. Of a body between two others, which press from both sides, it is
    /// the sum of both forces, the load of both contacts.
    pub fn normal_force<S: Space>(&self, s: &Simulation<S>) -> f64 {
        let h = s.options.scheme.h;
        let mut groups: Vec<(Counterpart, Group)> = Vec::new();
        for side in self.sides(s) {
            let found = groups.iter().position(|g| g.0 == side.counterpart);
            let at = found.unwrap_or(groups.len());
            if found.is_none() {
                groups.push((side.counterpart, Group::default()));
            }
            let group = &mut groups[at].1;
            group.push += side.impulse[self.normal];
            group.facing += side.normal[self.normal];
            group.contacts += 1.0;
        }
        let presses = |up: bool| groups.iter().any(|(_, g)| g.presses(up));
        if presses(true) && presses(false) {
            return groups.iter().map(|(_, g)| g.push * g.sign()).sum::<f64>() / h;
        }
        let pushed = match self.part {
            SlidingPart::Driven(place) => s.state.received[place].0[self.normal],
            SlidingPart::System { .. } => groups.iter().map(|(_, g)| g.push).sum(),
        };
        let facing: f64 = groups.iter().map(|(_, g)| g.facing).sum();
        if facing < 0.0 {
            -pushed / h
        } else {
            pushed / h
        }
    }
}

/// Contacts of the rubbed body with one counterpart.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    /// Impulse along the normal axis (N s).
    push: f64,
    /// Sum of the normals along that axis.
    facing: f64,
    /// Number of contacts.
    contacts: f64,
}

impl Group {
    /// Returns whether it presses the body upwards, or downwards, along the normal axis: a side
    /// wall, whose friction acts along that axis, does not.
    fn presses(&self, up: bool) -> bool {
        let faces = self.facing.abs() > 0.5 * self.contacts;
        faces && self.push * self.sign() > 0.0 && (self.facing > 0.0) == up
    }

    /// Returns the sign of its normals: 1, -1, or 0 where they are across the axis.
    fn sign(&self) -> f64 {
        match self.facing.abs() > 0.5 * self.contacts {
            true => self.facing.signum(),
            false => 0.0,
        }
    }
}
