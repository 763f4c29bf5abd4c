//! Detection at q_m: a neighbour list with a skin (broad), then gaps and normals (narrow).

use super::network::{Contact, Key, Network};
use crate::bodies::Bodies;
use crate::geometry::grid;
use crate::geometry::shape::{Ball, Shapes, Touch};
use crate::geometry::space::{Space, VectorLike};

/// Which interface law governs a pair of materials, row by row; `None` when none is given.
#[derive(Clone, Debug)]
pub struct LawTable {
    materials: usize,
    laws: Vec<Option<u16>>,
}

impl LawTable {
    /// No pair has a law yet.
    pub fn new(materials: usize) -> Self {
        Self {
            materials,
            laws: vec![None; materials * materials],
        }
    }

    /// Sets the law of a pair, in both orders.
    pub fn set(&mut self, a: u16, b: u16, law: u16) {
        let (a, b) = (a as usize, b as usize);
        self.laws[a * self.materials + b] = Some(law);
        self.laws[b * self.materials + a] = Some(law);
    }

    /// The law of a pair.
    #[inline]
    pub fn get(&self, a: u16, b: u16) -> Option<u16> {
        self.laws[a as usize * self.materials + b as usize]
    }
}

/// Where a ball's centre stands (m).
#[inline]
pub fn centre<S: Space>(ball: &Ball<S>, bodies: &Bodies<S>) -> S::Vector {
    let b = ball.body as usize;
    if ball.offset == S::Vector::null() {
        bodies.position[b]
    } else {
        bodies.position[b] + S::rotate(&bodies.rotation[b], &ball.offset)
    }
}

/// Finds the contacts of this step at the positions at hand and carries memories over.
///
/// Contacts that vanish lose their memory; a bond that holds keeps its contact whatever its gap. `h` is the
/// time since the last detection.
pub fn detect<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    time: f64,
    h: f64,
) {
    let centres: Vec<S::Vector> = shapes.balls.iter().map(|b| centre(b, bodies)).collect();
    if must_rebuild(network, shapes, bodies, &centres) {
        rebuild(network, shapes, bodies, laws, &centres);
    }
    std::mem::swap(&mut network.contacts, &mut network.old);
    network.contacts.clear();
    let candidates = std::mem::take(&mut network.candidates);
    let mut narrow = Narrow {
        shapes,
        bodies,
        centres: &centres,
        laws,
        time,
        h,
        at: 0,
        touches: Vec::new(),
    };
    for &(a, b) in &candidates {
        if b & Key::SURFACE == 0 {
            narrow.balls(network, a, b);
        } else {
            narrow.surface(network, a, b);
        }
    }
    let left = narrow.at;
    network.candidates = candidates;
    for k in left..network.old.len() {
        drop_contact(network, k);
    }
}

/// Where the neighbour list watches: the balls' centres, then the frames of the surfaces.
fn watched<'a, S: Space>(
    shapes: &'a Shapes<S>,
    bodies: &'a Bodies<S>,
    centres: &'a [S::Vector],
) -> impl Iterator<Item = S::Vector> + 'a {
    let frames = shapes
        .surfaces
        .iter()
        .map(|s| bodies.position[s.body as usize]);
    centres.iter().copied().chain(frames)
}

fn must_rebuild<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    centres: &[S::Vector],
) -> bool {
    if network.seen_at.len() != centres.len() + shapes.surfaces.len() {
        return true;
    }
    // A surface that turns sweeps more than its frame moves.
    if shapes
        .surfaces
        .iter()
        .any(|s| !s.shape.keeps_place(&bodies.spin[s.body as usize]))
    {
        return true;
    }
    let limit = 0.25 * network.skin * network.skin;
    watched(shapes, bodies, centres)
        .zip(&network.seen_at)
        .any(|(x, seen)| {
            let d = x - *seen;
            d.dot(&d) > limit
        })
}

fn rebuild<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    centres: &[S::Vector],
) {
    let radii: Vec<f64> = shapes.balls.iter().map(|b| b.radius).collect();
    let reach = network.alert + network.skin;
    let balls = &shapes.balls;
    let still = bodies.still();
    let gone = |i: u32| bodies.gone[i as usize];
    let never =
        |i: u32, j: u32| i == j || gone(i) || gone(j) || (still[i as usize] && still[j as usize]);
    let touch = |i: u32, j: u32| !never(i, j);
    let mut pairs = grid::pairs(centres, &radii, reach, &shapes.periodic, |a, b| {
        let (a, b) = (&balls[a as usize], &balls[b as usize]);
        touch(a.body, b.body) && laws.get(a.material, b.material).is_some()
    });
    for (s, surface) in shapes.surfaces.iter().enumerate() {
        let (origin, rotation) = frame(surface.body, &surface.offset, bodies);
        for (a, ball) in balls.iter().enumerate() {
            let known = laws.get(ball.material, surface.material).is_some();
            if known && touch(ball.body, surface.body) {
                let local = S::unrotate(&rotation, &(centres[a] - origin));
                if surface.shape.near(&local, ball.radius + reach) {
                    pairs.push((a as u32, s as u32 | Key::SURFACE));
                }
            }
        }
    }
    // A bond may be longer than the reach.
    let held = |c: &&Contact<S>| {
        network.bond(c).is_some_and(|b| b.intact()) && !c.bodies.iter().any(|b| gone(*b))
    };
    pairs.extend(network.contacts.iter().filter(held).map(|c| c.key.pair()));
    pairs.sort_unstable();
    pairs.dedup();
    network.candidates = pairs;
    network.seen_at.clear();
    network.seen_at.extend(watched(shapes, bodies, centres));
    network.rebuilds += 1;
}

/// Origin and rotation of a surface carried by a body.
fn frame<S: Space>(body: u32, offset: &S::Vector, bodies: &Bodies<S>) -> (S::Vector, S::Rotation) {
    let b = body as usize;
    let rotation = bodies.rotation[b];
    (bodies.position[b] + S::rotate(&rotation, offset), rotation)
}

fn drop_contact<S: Space>(network: &mut Network<S>, k: usize) {
    let contact = &network.old[k];
    if let Some(slot) = contact.memory() {
        let memory = &mut network.memory[contact.law as usize];
        let bond = &memory.bonds[slot];
        if bond.intact() {
            // A grain that left its surface's reach tears the bond.
            network.torn_energy += bond.energy;
            memory.broken += 1;
            network.broken_pairs.insert(contact.key.pair());
        }
        memory.release(slot as u32);
    }
}

struct Narrow<'a, S: Space> {
    shapes: &'a Shapes<S>,
    bodies: &'a Bodies<S>,
    centres: &'a [S::Vector],
    laws: &'a LawTable,
    time: f64,
    h: f64,
    /// Next old contact not yet met.
    at: usize,
    touches: Vec<Touch<S::Vector>>,
}

impl<S: Space> Narrow<'_, S> {
    /// The old contacts of a pair; drops those of pairs passed over.
    fn old_of(&mut self, network: &mut Network<S>, pair: (u32, u32)) -> std::ops::Range<usize> {
        while self.at < network.old.len() && network.old[self.at].key.pair() < pair {
            drop_contact(network, self.at);
            self.at += 1;
        }
        let first = self.at;
        while self.at < network.old.len() && network.old[self.at].key.pair() == pair {
            self.at += 1;
        }
        first..self.at
    }

    fn balls(&mut self, network: &mut Network<S>, a: u32, b: u32) {
        let (p, q) = (
            &self.shapes.balls[a as usize],
            &self.shapes.balls[b as usize],
        );
        let d = self
            .shapes
            .periodic
            .shortest(self.centres[a as usize] - self.centres[b as usize]);
        let old = self.old_of(network, (a, b)).next();
        let sum = p.radius + q.radius;
        let squared = d.dot(&d);
        let limit = sum + network.alert;
        if squared >= limit * limit && !held(network, old) {
            if let Some(k) = old {
                drop_contact(network, k);
            }
            return;
        }
        let length = squared.sqrt();
        let normal = if length > 0.0 {
            d * (1.0 / length)
        } else {
            S::Vector::from_slice(&[1.0])
        };
        let (i, j) = (p.body as usize, q.body as usize);
        let isotropic = |b: usize| {
            (1..S::D).all(|k| self.bodies.inverse_mass[b][k] == self.bodies.inverse_mass[b][0])
        };
        let simple = |ball: &Ball<S>, b: usize| {
            (ball.offset == S::Vector::null()
                && self.bodies.length[b] == ball.radius
                && isotropic(b))
                || (self.bodies.immovable(b) && self.bodies.spin[b] == S::Spin::null())
        };
        let Some(law) = self.laws.get(p.material, q.material) else {
            return;
        };
        let foot = self.centres[a as usize] - normal * p.radius;
        let central = simple(p, i) && simple(q, j);
        let arms = if central {
            [normal * -p.radius, normal * q.radius]
        } else {
            let other = self.centres[b as usize] + normal * q.radius;
            [
                foot - self.bodies.position[i],
                other - self.bodies.position[j],
            ]
        };
        let found = Contact {
            key: Key {
                candidate: a,
                antagonist: b,
                feature: 0,
            },
            bodies: [p.body, q.body],
            law,
            central,
            broken: false,
            slot: Contact::<S>::NO_MEMORY,
            gap: length - sum,
            normal,
            arms,
            radius: p.radius * q.radius / sum,
            impulse: S::Vector::null(),
            moment: S::Spin::null(),
            born: self.time,
            pressed: 0.0,
        };
        self.admit(network, found, old);
    }

    fn surface(&mut self, network: &mut Network<S>, a: u32, b: u32) {
        let ball = &self.shapes.balls[a as usize];
        let surface = &self.shapes.surfaces[(b & !Key::SURFACE) as usize];
        let old = self.old_of(network, (a, b));
        let (origin, rotation) = frame(surface.body, &surface.offset, self.bodies);
        let local = S::unrotate(&rotation, &(self.centres[a as usize] - origin));
        // A bond reaches as far as it is stretched, and again as far within a step.
        let stretch = |k: usize| {
            let old = &network.old[k];
            let bond = network.bond(old).filter(|b| b.intact())?;
            Some(network.skin + 2.0 * (old.gap.max(0.0) + bond.opening_t.norm()))
        };
        let margin = network.alert + old.clone().filter_map(stretch).fold(0.0, f64::max);
        let mut touches = std::mem::take(&mut self.touches);
        touches.clear();
        surface
            .shape
            .touches(&local, ball.radius + margin, &mut touches);
        let Some(law) = self.laws.get(ball.material, surface.material) else {
            return;
        };
        let mut taken = vec![false; old.len()];
        let (i, j) = (ball.body as usize, surface.body as usize);
        for touch in &touches {
            // The same feature, or the nearest of those that are no longer touched.
            let same = old
                .clone()
                .find(|k| network.old[*k].key.feature == touch.feature);
            let matched = same.or_else(|| {
                old.clone().find(|k| {
                    !taken[k - old.start]
                        && !touches
                            .iter()
                            .any(|t| t.feature == network.old[*k].key.feature)
                })
            });
            let gap = touch.distance - ball.radius;
            if gap >= network.alert && !held(network, matched) {
                continue;
            }
            if let Some(k) = matched {
                taken[k - old.start] = true;
            }
            let normal = S::rotate(&rotation, &touch.normal);
            let foot = origin + S::rotate(&rotation, &touch.foot);
            let still = self.bodies.immovable(j) && self.bodies.spin[j] == S::Spin::null();
            let centred = ball.offset == S::Vector::null() && self.bodies.length[i] == ball.radius;
            let arm = self.centres[a as usize] - normal * ball.radius - self.bodies.position[i];
            let found = Contact {
                key: Key {
                    candidate: a,
                    antagonist: b,
                    feature: touch.feature,
                },
                bodies: [ball.body, surface.body],
                law,
                central: still
                    && centred
                    && self.bodies.inverse_mass[i][0] == self.bodies.inverse_mass[i][S::D - 1],
                broken: false,
                slot: Contact::<S>::NO_MEMORY,
                gap,
                normal,
                arms: [arm, foot - self.bodies.position[j]],
                radius: ball.radius,
                impulse: S::Vector::null(),
                moment: S::Spin::null(),
                born: self.time,
                pressed: 0.0,
            };
            self.admit(network, found, matched);
        }
        for k in old.clone() {
            if !taken[k - old.start] {
                drop_contact(network, k);
            }
        }
        self.touches = touches;
    }

    /// Takes a contact in, with what an old one of the same name remembers.
    fn admit(&self, network: &mut Network<S>, mut found: Contact<S>, old: Option<usize>) {
        match old {
            Some(k) => {
                let old = &network.old[k];
                found.impulse = old.impulse;
                found.moment = old.moment;
                found.born = old.born;
                found.pressed = old.pressed;
                found.slot = old.slot;
                found.broken = old.broken;
                let from = old.normal;
                if let Some(slot) = found.memory() {
                    // What a bond remembers turns with the pair.
                    let [i, j] = found.bodies.map(|b| self.bodies.spin[b as usize]);
                    let angle = 0.5 * self.h * S::split_spin(&found.normal, &(i + j)).0;
                    let memory = &mut network.memory[found.law as usize];
                    let bond = &mut memory.bonds[slot];
                    bond.opening_t = S::carry(&from, &found.normal, angle, &bond.opening_t);
                    if let Some(rotation) = memory.rotations.get_mut(slot) {
                        *rotation = S::carry_spin(&from, &found.normal, angle, rotation);
                    }
                }
            }
            None => found.broken = network.broken_pairs.contains(&found.key.pair()),
        }
        network.contacts.push(found);
    }
}

fn held<S: Space>(network: &Network<S>, old: Option<usize>) -> bool {
    old.is_some_and(|k| network.bond(&network.old[k]).is_some_and(|b| b.intact()))
}
