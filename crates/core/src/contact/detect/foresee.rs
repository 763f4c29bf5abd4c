//! Contacts that close within the step although their bodies are beyond the alert distance at its start: found before they
//! close, for pairs whose relative motion in the step is fast. Scenes without fast motion do no more here than look at speeds.

use super::extents::Extents;
use super::order::{PredictedMeeting, mark_later};
use super::sweep::{Course, Pair, Sweep};
use super::{LawTable, centres, rebuild};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, Key, Network};
use crate::geometry::grid;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};

/// Overlap, in parts of what is fast, from which a pair that has no contact gets one.
pub(super) const TOLERATED: f64 = 0.05;
/// Part of the half thickness that a pair may go deeper into each other before it is reported.
const PASSED: f64 = 0.25;
/// The neighbour list looks this many times as far as the motion asks, so that it lasts while bodies become faster.
const HEADROOM: f64 = 1.5;
/// Pairs that a widened neighbour list may look at, in parts of those of the plain one, and beside that.
const MAX_PAIRS: (f64, f64) = (4.0, 5e6);

/// The motion of a step: velocities (m/s, rad/s) of all bodies over it, its start and length (s).
pub struct Motion<'a, S: Space> {
    /// What the bodies move with.
    pub velocities: &'a [(S::Vector, S::Spin)],
    /// Time at the start of the step (s).
    pub time: f64,
    /// Its length (s).
    pub h: f64,
}

/// When pairs are looked at.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// Before the solve, by the velocities that bodies would have without contacts.
    Before,
    /// After it, by those that they have.
    After,
    /// The same, to report.
    Report,
}

/// Whether no two bodies can move fast relative to each other in the step: then there is nothing to foresee. Cheap.
pub fn is_calm<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    velocities: impl Iterator<Item = (S::Vector, S::Spin)>,
    h: f64,
) -> bool {
    if !network.extents.fits(shapes, bodies) {
        network.extents = Extents::new(shapes, bodies);
    }
    if !network.widened.is_empty() || network.turning.iter().any(|w| *w > 0.0) {
        return false;
    }
    let levers = &network.extents.levers;
    let (mut fastest, mut turning) = (0.0f64, 0.0f64);
    for ((v, w), lever) in velocities.zip(levers) {
        fastest = fastest.max(v.dot(&v));
        if *lever > 0.0 {
            turning = turning.max(lever * lever * w.dot(&w));
        }
    }
    // Below what asks for a wider list, and for a look at pairs. A surface that turns is not calm.
    let still = shapes.surfaces.iter().all(|s| {
        let b = s.body as usize;
        let spin = S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]);
        s.shape.keeps_place(&spin)
    });
    still && 2.0 * h * (fastest.sqrt() + turning.sqrt()) <= network.fast.min(network.alert)
}

/// Adds the contacts of the step that the free velocities close, and that detection at its start did not see.
pub fn foresee<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) {
    let travels = widen(network, shapes, bodies, laws, motion);
    let found = look(
        network,
        shapes,
        bodies,
        laws,
        motion,
        &travels,
        Stage::Before,
    );
    network.take_in(found);
}

/// The contacts that the velocities after a solve would close in the step and that were not solved for: where there are any
/// the step is to be solved again with them, see [`Network::take_in`].
pub fn overlooked<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) -> Vec<Contact<S>> {
    let travels = widen(network, shapes, bodies, laws, motion);
    let found = look(
        network,
        shapes,
        bodies,
        laws,
        motion,
        &travels,
        Stage::After,
    );
    network.step_size.repeated_solves += u64::from(!found.is_empty());
    found
}

/// Reports the pairs that go into each other in the step whatever was solved for.
pub fn report_passing<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) {
    let travels = widen(network, shapes, bodies, laws, motion);
    look(
        network,
        shapes,
        bodies,
        laws,
        motion,
        &travels,
        Stage::Report,
    );
}

/// Reports the pairs that go into each other in a move at the velocities of the bodies before detection, which no step before
/// has looked at.
pub fn report_first_move<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    time: f64,
    length: f64,
) {
    let velocities = bodies.velocity.iter().copied();
    let velocities: Vec<_> = velocities.zip(bodies.spin.iter().copied()).collect();
    if network.seen_at.is_empty() {
        let centres = centres(shapes, bodies);
        rebuild(network, shapes, bodies, laws, &centres, &velocities, length);
    }
    let motion = Motion {
        velocities: &velocities,
        time,
        h: length,
    };
    report_passing(network, shapes, bodies, laws, &motion);
}

/// How far each body moves in the step, with a neighbour list that looks as far as the fast ones go.
fn widen<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) -> Vec<f64> {
    if !network.extents.fits(shapes, bodies) {
        network.extents = Extents::new(shapes, bodies);
    }
    let travels = network.extents.travels(bodies, motion.velocities, motion.h);
    let half = 0.5 * network.alert;
    let need = |travel: &f64| (travel - half).max(0.0);
    let farthest = travels.iter().copied().fold(0.0, f64::max);
    let widest = network.widened.iter().copied().fold(0.0, f64::max);
    let turn_faster = surfaces_turn_faster(network, shapes, bodies, motion);
    if farthest <= half && widest == 0.0 && !turn_faster {
        return travels;
    }
    // Some room for all, so that a body that has just become fast does not ask for a new list.
    let room = network.alert;
    let wide = |travel: &f64| (HEADROOM * need(travel)).max(room);
    if farthest < 0.5 * half || 4.0 * wide(&farthest) < widest {
        network.widened.clear();
        network.forget_neighbours();
        if farthest <= half && !turn_faster {
            return travels;
        }
    }
    let seen = |b: usize| network.widened.get(b).copied().unwrap_or(0.0);
    let short = |b: usize| need(&travels[b]) > seen(b);
    let must = network.seen_at.is_empty() || turn_faster || (0..bodies.len()).any(short);
    if must {
        network.widened = if farthest > half {
            travels.iter().map(wide).collect()
        } else {
            Vec::new()
        };
        let centres = centres(shapes, bodies);
        limit(network, shapes, &centres);
        rebuild(
            network,
            shapes,
            bodies,
            laws,
            &centres,
            motion.velocities,
            motion.h,
        );
        let looked = |b: usize| network.widened.get(b).copied().unwrap_or(0.0);
        let beyond = |b: &usize| need(&travels[*b]) > looked(*b);
        let farthest = (0..bodies.len())
            .filter(beyond)
            .max_by(|a, b| travels[*a].total_cmp(&travels[*b]));
        if let Some(body) = farthest {
            network
                .step_size
                .leave_unwatched(motion.time, bodies, body as u32);
        }
    }
    travels
}

/// Whether a surface sweeps faster than the neighbour list was made for.
fn surfaces_turn_faster<S: Space>(
    network: &Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    motion: &Motion<S>,
) -> bool {
    let mut surfaces = shapes.surfaces.iter().zip(&network.turning);
    surfaces.any(|(surface, seen)| {
        let b = surface.body as usize;
        let spin = motion.velocities[b].1;
        // One that turns in its place sweeps nothing.
        spin.norm() > *seen
            && !surface
                .shape
                .keeps_place(&S::unrotate_spin(&bodies.rotation[b], &spin))
    })
}

/// Keeps the widened list within memory, and within a period.
fn limit<S: Space>(network: &mut Network<S>, shapes: &Shapes<S>, centres: &[S::Vector]) {
    if network.widened.is_empty() {
        return;
    }
    let periods = shapes.periodic.period.iter().take(S::D).flatten();
    let period = periods.copied().fold(f64::INFINITY, f64::min);
    for wide in &mut network.widened {
        *wide = wide.min(0.125 * period);
        if !wide.is_finite() {
            *wide = 0.0;
        }
    }
    let reach = network.alert + network.skin;
    let bodies = shapes.balls.iter().map(|b| (b.body, b.radius));
    let bodies = bodies.chain(shapes.pieces.iter().map(|p| (p.body, p.bound)));
    let bodies: Vec<(u32, f64)> = bodies.collect();
    let radii: Vec<f64> = bodies.iter().map(|b| b.1).collect();
    let look_at = |radii: &[f64]| grid::most_pairs(centres, radii, reach, &shapes.periodic);
    let most = MAX_PAIRS.0 * look_at(&radii) + MAX_PAIRS.1;
    // Halved a few times it is nothing.
    for _ in 0..64 {
        let widened = &network.widened;
        let wide: Vec<f64> = bodies
            .iter()
            .map(|(b, r)| r + widened[*b as usize])
            .collect();
        if look_at(&wide) <= most {
            return;
        }
        network.widened.iter_mut().for_each(|w| *w *= 0.5);
    }
    network.widened.iter_mut().for_each(|w| *w = 0.0);
}

/// The contacts of the pairs that meet in the step, in the order of the pairs; or reports the pairs.
fn look<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
    travels: &[f64],
    stage: Stage,
) -> Vec<Contact<S>> {
    let mut found = Vec::new();
    let mut meetings = Vec::new();
    let fast = network.fast;
    let farthest = travels.iter().copied().fold(0.0, f64::max);
    let turning = network.turning.iter().any(|w| *w > 0.0);
    if 2.0 * farthest <= fast && !turning {
        return found;
    }
    let extents = std::mem::take(&mut network.extents);
    let candidates = std::mem::take(&mut network.candidates);
    let sweep = Sweep {
        shapes,
        bodies,
        extents: &extents,
        velocities: motion.velocities,
        time: motion.time,
        h: motion.h,
        alert: network.alert,
    };
    let body = |name: u32| {
        let k = (name & !(Key::PIECE | Key::SURFACE)) as usize;
        if name & Key::SURFACE != 0 {
            shapes.surfaces[k].body as usize
        } else if name & Key::PIECE != 0 {
            shapes.pieces[k].body as usize
        } else {
            shapes.balls[k].body as usize
        }
    };
    for &names in &candidates {
        let turns = turning && names.1 & Key::SURFACE != 0;
        // Two balls have one contact: where they go less than the alert distance, detection has seen it.
        let balls = (names.0 | names.1) & (Key::PIECE | Key::SURFACE) == 0;
        let slow = if balls { network.alert } else { fast };
        if travels[body(names.0)] + travels[body(names.1)] <= slow && !turns {
            continue;
        }
        let pair = sweep.pair(names);
        if pair.travel <= slow {
            continue;
        }
        let Some(margin) = margin(network, names, &pair, stage) else {
            continue;
        };
        let course = sweep.course(&pair, margin.deepest);
        if course == Course::Clear {
            continue;
        }
        if stage == Stage::Report {
            network.step_size.pass(motion.time, bodies, pair.bodies());
            continue;
        }
        let [one, other] = pair.materials();
        let known = found.len();
        if let (Course::Meets(s), Some(law)) =
            (sweep.course(&pair, margin.begins), laws.get(one, other))
        {
            sweep.contacts(&pair, s, law, &mut found);
            meetings.push(PredictedMeeting {
                names,
                bodies: pair.bodies(),
                at: s,
                travel: pair.travel,
                contacts: known..found.len(),
            });
        }
        if found.len() == known && stage == Stage::After {
            // It cannot be followed, or not be held where it meets.
            network.step_size.pass(motion.time, bodies, pair.bodies());
        }
    }
    if stage == Stage::Before {
        mark_later(&mut found, &meetings, &sweep, &candidates, body, fast);
    }
    network.candidates = candidates;
    network.extents = extents;
    found
}

/// How deep a pair may go into each other (m).
struct Margin {
    /// Before something is done about it.
    deepest: f64,
    /// From where on it is held.
    begins: f64,
}

/// How deep a pair may go into each other; none where it is not to be looked at.
fn margin<S: Space>(
    network: &Network<S>,
    names: (u32, u32),
    pair: &Pair<S>,
    stage: Stage,
) -> Option<Margin> {
    let contacts = &network.contacts;
    let first = contacts.partition_point(|c| c.key.pair() < names);
    let of_pair = contacts[first..]
        .iter()
        .take_while(|c| c.key.pair() == names);
    let (mut any, mut overlap) = (false, 0.0f64);
    for contact in of_pair {
        // A bond that holds keeps its gap.
        if network.bond(contact).is_some_and(|b| b.intact()) {
            return None;
        }
        any = true;
        if !contact.closing {
            overlap = overlap.max(-contact.gap);
        }
    }
    let begins = TOLERATED * network.fast + overlap;
    let deepest = match stage {
        Stage::Before if any => return None,
        Stage::After if any => network.fast + overlap,
        Stage::Before | Stage::After => begins,
        Stage::Report => PASSED * pair.half_thickness + overlap,
    };
    Some(Margin { deepest, begins })
}

impl<S: Space> Network<S> {
    /// Takes contacts that close in the step in among the others; of those that are there already it changes the geometry.
    pub fn take_in(&mut self, found: Vec<Contact<S>>) {
        let there = self.contacts.len();
        self.step_size.foreseen += found.len() as u64;
        for mut contact in found {
            let at = self.contacts[..there].binary_search_by_key(&contact.key, |c| c.key);
            match at {
                Ok(at) => {
                    let known = &mut self.contacts[at];
                    known.closing = true;
                    known.later |= contact.later;
                    known.central = false;
                    known.gap = contact.gap;
                    known.normal = contact.normal;
                    known.arms = contact.arms;
                }
                Err(_) => {
                    contact.broken = self.broken_pairs.contains(&contact.key.pair());
                    self.contacts.push(contact);
                }
            }
        }
        if self.contacts.len() > there {
            self.contacts.sort_by_key(|c| c.key);
        }
    }
}
