//! Motion of first bodies relative to each other, at their contacts.

use super::contacts::{Counterpart, counterpart, loaded};
use super::{SlidingBody, SlidingPart};
use crate::bodies::Dof;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;

/// Share of the mean speed that rotation adds at contacts below which the mean of these velocities
/// shows that it moves contacts in opposite directions.
const OPPOSITE: f64 = 0.9;
/// Share of the speed in the plane of the contacts that lies along the axis, below which the
/// contacts slide oblique to it.
const OBLIQUE: f64 = 0.98;
/// Share of that speed, and of a path, below which they slide across the axis: a sign along it is
/// due to rounding.
pub const ACROSS: f64 = 1e-3;

/// Motion of the rubbed body relative to what it rubs against.
pub(super) struct Relative {
    /// Velocity along the axis of what the body rubs against, less what its own rotation adds there
    /// (m/s).
    pub counter: f64,
    /// Speed of sliding in the plane of the contacts (m/s).
    pub speed: f64,
    /// Where an imposed motion makes contacts slide in opposite directions, or oblique to the axis:
    /// mean of their speeds with the sign of the motion (m/s), and the power of their forces (W).
    pub in_plane: Option<(f64, f64)>,
}

impl SlidingBody {
    /// Returns its motion relative to what it rubs against, with its own velocity (m/s).
    pub(super) fn relative_motion<S: Space>(&self, s: &Simulation<S>, own: &S::Vector) -> Relative {
        let own_speed = in_plane::<S>(own, self.normal);
        let oblique =
            |along: f64, speed: f64| along.abs() < OBLIQUE * speed && along.abs() > ACROSS * speed;
        let across = oblique(own[self.along], own_speed) && self.imposes_across(s);
        if !across && !self.others_move(s) {
            return Relative {
                counter: 0.0,
                speed: own_speed,
                in_plane: None,
            };
        }
        let spin = match self.part {
            SlidingPart::Driven(place) => step_spin(s, place),
            SlidingPart::System { .. } => S::Spin::zero(),
        };
        // Sums of weights, and of weights times velocities: of contacts with first bodies, and with
        // grains.
        let (mut all, mut grains) = (Mean::<S>::default(), 0.0);
        let mut turned = Mean::<S>::default();
        let held = held_velocities(s);
        let behind = self.behind_grains(s, &held);
        let (mut speed, mut power) = (0.0, 0.0);
        // Sums of weights times what rotation adds, with signs and without.
        let mut rotation = [0.0; 2];
        for side in self.sides(s) {
            let weight = side.impulse[self.normal].abs();
            let turning = S::spin_velocity(&spin, &side.arms[0]);
            turned.add(weight, turning);
            let other = velocity_of(s, side.counterpart, &side.arms[1], &held);
            match other {
                Some(velocity) => all.add(weight, velocity),
                None => grains += weight,
            }
            let slides = *own + turning - other.unwrap_or(behind);
            speed += weight * in_plane::<S>(&slides, self.normal);
            let turns = match side.counterpart {
                Counterpart::Driven(place) => {
                    turning - S::spin_velocity(&step_spin(s, place), &side.arms[1])
                }
                _ => turning,
            };
            rotation[0] += weight * turns[self.along];
            rotation[1] += weight * turns[self.along].abs();
            power -= (side.impulse).dot(&slides) - side.impulse[self.normal] * slides[self.normal];
        }
        if grains > 0.0 {
            all.add(grains, behind);
        }
        let weight = all.weight;
        let counter = all.value()[self.along] - turned.value()[self.along];
        let mean = |sum: f64| if weight > 0.0 { sum / weight } else { 0.0 };
        let speed = mean(speed);
        let velocity = own[self.along] - counter;
        let turns = imposed_rotation(s);
        let opposite = rotation[0].abs() < OPPOSITE * rotation[1];
        let sign = match turns.filter(|_| opposite) {
            Some(sign) => Some(sign),
            None => (oblique(velocity, speed) && (turns.is_some() || self.imposes_across(s)))
                .then(|| velocity.signum()),
        };
        Relative {
            counter,
            speed,
            in_plane: sign.map(|sign| (sign * speed, power / s.options.scheme.h)),
        }
    }

    /// Returns whether the scene moves a first body in the plane of the contacts across the axis.
    fn imposes_across<S: Space>(&self, s: &Simulation<S>) -> bool {
        let driven = &s.state.bodies.driven;
        (0..driven.len()).any(|place| {
            let velocity = step_velocity(s, place);
            (0..S::D).any(|axis| {
                let across = axis != self.along && axis != self.normal;
                across && velocity[axis] != 0.0 && driven[place].dofs.get(axis).is_some_and(imposes)
            })
        })
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
            || held_velocities(s)
                .iter()
                .enumerate()
                .any(|(system, v)| v[self.along] != 0.0 && !self.is(Counterpart::System(system)))
    }

    /// Returns the mean velocity of the other first bodies at their contacts with grains (m/s),
    /// with the normal loads as weights.
    fn behind_grains<S: Space>(&self, s: &Simulation<S>, held: &[S::Vector]) -> S::Vector {
        let mut mean = Mean::<S>::default();
        for c in loaded(s) {
            let Some((k, part)) = beside_grain(c.bodies.map(|b| counterpart(s, b))) else {
                continue;
            };
            if self.is(part) {
                continue;
            }
            if let Some(velocity) = velocity_of(s, part, &c.arms[k], held) {
                mean.add(c.impulse[self.normal].abs(), velocity);
            }
        }
        mean.value()
    }
}

/// Returns the normal force times the distance of sliding of every first body over the last step
/// (J; J/m in 2D) with its name, over all of its contacts, of those that slid: relative to the
/// other first body, behind grains to the others that they touch.
pub fn first_body_paths<S: Space>(s: &Simulation<S>, normal: usize) -> Vec<(&str, f64)> {
    let driven = s.state.bodies.driven.len();
    let at = |part: Counterpart| match part {
        Counterpart::Driven(place) => Some(place),
        Counterpart::System(system) => Some(driven + system),
        Counterpart::Grain => None,
    };
    let held = held_velocities(s);
    let count = driven + s.state.systems.len();
    // Contacts of each with grains, and the sums over all of these.
    let mut with_grains: Vec<Vec<(f64, S::Vector)>> = vec![Vec::new(); count];
    let mut means = vec![Mean::<S>::default(); count];
    let mut all = Mean::<S>::default();
    let mut paths = vec![0.0; count];
    for c in loaded(s) {
        let weight = c.impulse[normal].abs();
        let parts = c.bodies.map(|b| counterpart(s, b));
        let velocity = |k: usize| velocity_of(s, parts[k], &c.arms[k], &held);
        if let (Some(i), Some(j), Some(u), Some(v)) =
            (at(parts[0]), at(parts[1]), velocity(0), velocity(1))
        {
            let path = weight * in_plane::<S>(&(u - v), normal);
            paths[i] += path;
            paths[j] += path;
        } else if let Some((k, part)) = beside_grain(parts)
            && let (Some(place), Some(v)) = (at(part), velocity(k))
        {
            with_grains[place].push((weight, v));
            means[place].add(weight, v);
            all.add(weight, v);
        }
    }
    for (place, contacts) in with_grains.iter().enumerate() {
        let others = Mean::<S> {
            weight: all.weight - means[place].weight,
            sum: all.sum - means[place].sum,
        };
        let behind = others.value();
        let slid = |(weight, v): &(f64, S::Vector)| weight * in_plane::<S>(&(*v - behind), normal);
        paths[place] += contacts.iter().map(slid).sum::<f64>();
    }
    let name = |place: usize| match s.state.bodies.driven.get(place) {
        Some(driven) => Some(driven.name.as_str()),
        None => s.state.systems.get(place - driven).map(|s| s.name()),
    };
    let slid = paths.into_iter().enumerate().filter(|p| p.1 > 0.0);
    slid.filter_map(|(place, path)| Some((name(place)?, path)))
        .collect()
}

/// Returns the part of two that touch which is no grain while the other one is, with its place.
fn beside_grain(parts: [Counterpart; 2]) -> Option<(usize, Counterpart)> {
    match parts {
        [Counterpart::Grain, Counterpart::Grain] => None,
        [Counterpart::Grain, part] => Some((1, part)),
        [part, Counterpart::Grain] => Some((0, part)),
        _ => None,
    }
}

/// Returns the length of a vector across an axis.
fn in_plane<S: Space>(v: &S::Vector, normal: usize) -> f64 {
    let mut v = *v;
    v[normal] = 0.0;
    v.norm()
}

/// Returns whether a drive imposes a motion.
fn imposes(drive: &Dof) -> bool {
    match drive {
        Dof::Velocity(_) | Dof::Displacement(_) => true,
        Dof::Stages(stages) => stages.iter().any(|stage| imposes(&stage.drive)),
        _ => false,
    }
}

/// Returns the sign of the rotation that the scene imposes on a first body; 0 while it rests,
/// `None` without one.
fn imposed_rotation<S: Space>(s: &Simulation<S>) -> Option<f64> {
    let driven = &s.state.bodies.driven;
    let mut turning = (0..driven.len()).filter_map(|place| {
        let axis = (driven[place].dofs.iter().skip(S::D)).position(imposes)?;
        let rate = step_spin(s, place)[axis];
        Some(if rate == 0.0 { 0.0 } else { rate.signum() })
    });
    turning.next()
}

/// Returns the velocity of the parts of each system that are held (m/s), their mean along each
/// axis; 0 where none is.
fn held_velocities<S: Space>(s: &Simulation<S>) -> Vec<S::Vector> {
    (0..s.state.systems.len())
        .map(|system| system_velocity(s, system))
        .collect()
}

/// Returns the velocity of the parts of a system that are held (m/s), their mean along each axis; 0
/// where none is.
pub(super) fn system_velocity<S: Space>(s: &Simulation<S>, system: usize) -> S::Vector {
    let mut velocity = S::Vector::zero();
    let holders = s.state.systems.get(system).map(|s| s.holders());
    for axis in 0..S::D {
        let along = holders.iter().flatten().filter(|h| h.axis == axis);
        let (count, sum) = along.fold((0.0, 0.0), |(n, sum), h| (n + 1.0, sum + h.velocity));
        if count > 0.0 {
            velocity[axis] = sum / count;
        }
    }
    velocity
}

/// Returns the velocity of a first body at `arm` from its centre (m/s), of a deformable one that of
/// its parts that are held; `None` for a grain.
fn velocity_of<S: Space>(
    s: &Simulation<S>,
    part: Counterpart,
    arm: &S::Vector,
    held: &[S::Vector],
) -> Option<S::Vector> {
    match part {
        Counterpart::Driven(place) => {
            let turning = S::spin_velocity(&step_spin(s, place), arm);
            Some(step_velocity(s, place) + turning)
        }
        Counterpart::System(system) => held.get(system).copied(),
        Counterpart::Grain => None,
    }
}

/// Weighted mean of velocities.
#[derive(Clone, Copy, Debug)]
struct Mean<S: Space> {
    weight: f64,
    sum: S::Vector,
}

impl<S: Space> Default for Mean<S> {
    fn default() -> Self {
        Self {
            weight: 0.0,
            sum: S::Vector::zero(),
        }
    }
}

impl<S: Space> Mean<S> {
    fn add(&mut self, weight: f64, value: S::Vector) {
        self.weight += weight;
        self.sum += value * weight;
    }

    /// Returns the mean; 0 without weights.
    fn value(&self) -> S::Vector {
        let mut mean = S::Vector::zero();
        if self.weight > 0.0 {
            (0..S::D).for_each(|k| mean[k] = self.sum[k] / self.weight);
        }
        mean
    }
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
