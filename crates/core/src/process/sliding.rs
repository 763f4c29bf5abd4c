//! Force and sliding of the rubbed body of a friction test.

use crate::contact::network::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
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
    /// Velocity of what the body rubs against, less that which the rotation of the body adds there
    /// to its own (m/s): the sliding velocity is that of the body less this one.
    pub counter: f64,
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

/// What lies on the other side of a contact of the rubbed body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Counterpart {
    /// A rigid body that is not a grain, by its index among the driven bodies.
    Driven(usize),
    /// A deformable body that is not a grain, by its index among the systems.
    System(usize),
    /// A grain.
    Grain,
}

/// A loaded contact of the rubbed body.
#[derive(Clone, Copy, Debug)]
struct Side<S: Space> {
    counterpart: Counterpart,
    /// Impulse on the rubbed body (N s).
    impulse: S::Vector,
    /// Unit normal towards the rubbed body.
    normal: S::Vector,
    /// Vectors from the centres of the rubbed body and of the other one to the contact (m).
    arms: [S::Vector; 2],
}

impl SlidingBody {
    /// Returns force and sliding distance in the last step. The force is that of the drive, for a
    /// deformable body that of the holder that moves it. What it rubs against may move too: the
    /// velocities of its counterparts at their contacts are averaged with the normal loads as
    /// weights. Behind grains, the counterpart is that of the other first bodies which carries the
    /// load of grains.
    pub fn drive<S: Space>(&self, s: &Simulation<S>) -> SlidingStep {
        let h = s.options.scheme.h;
        let counter = self.counter_velocity(s);
        match self.part {
            SlidingPart::Driven(place) => SlidingStep {
                force: -s.state.received[place].0[self.along] / h,
                slide: h * (step_velocity(s, place)[self.along] - counter),
                counter,
                at: 0.5,
            },
            SlidingPart::System { system, holder } => {
                let holders = s.state.systems.get(system).map(|s| s.holders());
                let held = holders.as_ref().and_then(|h| h.get(holder));
                held.map_or_else(SlidingStep::default, |held| SlidingStep {
                    force: held.force,
                    slide: h * (held.velocity - counter),
                    counter,
                    at: held.at,
                })
            }
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

    /// Returns the velocity along the axis of what the body rubs against, less what its own
    /// rotation adds there (m/s).
    fn counter_velocity<S: Space>(&self, s: &Simulation<S>) -> f64 {
        if !self.others_move(s) {
            return 0.0;
        }
        let spin = match self.part {
            SlidingPart::Driven(place) => step_spin(s, place),
            SlidingPart::System { .. } => S::Spin::zero(),
        };
        // Sums of weights, and of weights times velocities: of contacts with first bodies, and with
        // grains.
        let (mut all, mut grains) = (Mean::default(), 0.0);
        let mut own = Mean::default();
        let held = self.held_velocities(s);
        for side in self.sides(s) {
            let weight = side.impulse[self.normal].abs();
            own.add(weight, S::spin_velocity(&spin, &side.arms[0])[self.along]);
            match self.velocity_of(s, side.counterpart, &side.arms[1], &held) {
                Some(velocity) => all.add(weight, velocity),
                None => grains += weight,
            }
        }
        if grains > 0.0 {
            all.add(grains, self.behind_grains(s, &held));
        }
        all.value() - own.value()
    }

    /// Returns whether anything but the translation of the body itself can make it slide.
    fn others_move<S: Space>(&self, s: &Simulation<S>) -> bool {
        let own = match self.part {
            SlidingPart::Driven(place) => Some(place),
            SlidingPart::System { .. } => None,
        };
        let driven = (0..s.state.bodies.driven.len()).any(|place| {
            let translates = step_velocity(s, place) != S::Vector::zero();
            (translates && own != Some(place)) || step_spin(s, place) != S::Spin::zero()
        });
        driven
            || self
                .held_velocities(s)
                .iter()
                .enumerate()
                .any(|(system, v)| *v != 0.0 && !self.is(Counterpart::System(system)))
    }

    /// Returns the mean velocity along the axis of the other first bodies at their contacts with
    /// grains (m/s), with the normal loads as weights.
    fn behind_grains<S: Space>(&self, s: &Simulation<S>, held: &[f64]) -> f64 {
        let mut mean = Mean::default();
        for c in loaded(s) {
            let sides = [0, 1].map(|k| counterpart(s, c.bodies[k]));
            let k = match sides {
                [Counterpart::Grain, Counterpart::Grain] => continue,
                [Counterpart::Grain, _] => 1,
                [_, Counterpart::Grain] => 0,
                _ => continue,
            };
            if self.is(sides[k]) {
                continue;
            }
            if let Some(velocity) = self.velocity_of(s, sides[k], &c.arms[k], held) {
                mean.add(c.impulse[self.normal].abs(), velocity);
            }
        }
        mean.value()
    }

    /// Returns the velocity along the axis of the parts of each system that are held (m/s), their
    /// mean; 0 where none is.
    fn held_velocities<S: Space>(&self, s: &Simulation<S>) -> Vec<f64> {
        let of = |system: usize| {
            let mut mean = Mean::default();
            let holders = s.state.systems.get(system).map(|s| s.holders());
            let along = holders.iter().flatten().filter(|h| h.axis == self.along);
            along.for_each(|h| mean.add(1.0, h.velocity));
            mean.value()
        };
        (0..s.state.systems.len()).map(of).collect()
    }

    /// Returns the velocity along the axis of a first body at `arm` from its centre (m/s), of a
    /// deformable one that of its parts that are held; `None` for a grain.
    fn velocity_of<S: Space>(
        &self,
        s: &Simulation<S>,
        part: Counterpart,
        arm: &S::Vector,
        held: &[f64],
    ) -> Option<f64> {
        match part {
            Counterpart::Driven(place) => {
                let turning = S::spin_velocity(&step_spin(s, place), arm);
                Some(step_velocity(s, place)[self.along] + turning[self.along])
            }
            Counterpart::System(system) => held.get(system).copied(),
            Counterpart::Grain => None,
        }
    }

    /// Returns whether this is the rubbed body.
    fn is(&self, part: Counterpart) -> bool {
        match self.part {
            SlidingPart::Driven(place) => part == Counterpart::Driven(place),
            SlidingPart::System { system, .. } => part == Counterpart::System(system),
        }
    }

    /// Returns the loaded contacts of the body.
    fn sides<S: Space>(&self, s: &Simulation<S>) -> impl Iterator<Item = Side<S>> {
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

/// Weighted mean of velocities.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    weight: f64,
    sum: f64,
}

impl Mean {
    fn add(&mut self, weight: f64, value: f64) {
        self.weight += weight;
        self.sum += weight * value;
    }

    /// Returns the mean; 0 without weights.
    fn value(&self) -> f64 {
        if self.weight > 0.0 {
            self.sum / self.weight
        } else {
            0.0
        }
    }
}

fn loaded<S: Space>(s: &Simulation<S>) -> impl Iterator<Item = &Contact<S>> {
    let contacts = s.state.network.contacts.iter();
    contacts.filter(|c| c.impulse.norm() > 0.0)
}

/// Returns what a body of a contact is.
fn counterpart<S: Space>(s: &Simulation<S>, body: u32) -> Counterpart {
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

/// Returns the velocity of a driven body over the last step, v_theta, by its index among them
/// (m/s).
pub fn step_velocity<S: Space>(s: &Simulation<S>, place: usize) -> S::Vector {
    let theta = s.options.scheme.theta;
    let now = s.state.bodies.velocity[s.state.bodies.driven[place].body as usize];
    s.state.started[place].0 * (1.0 - theta) + now * theta
}

/// Returns the spin of a driven body over the last step, by its index among them (rad/s).
fn step_spin<S: Space>(s: &Simulation<S>, place: usize) -> S::Spin {
    let theta = s.options.scheme.theta;
    let now = s.state.bodies.spin[s.state.bodies.driven[place].body as usize];
    s.state.started[place].1 * (1.0 - theta) + now * theta
}
