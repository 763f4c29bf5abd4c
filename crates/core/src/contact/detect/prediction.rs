//! Contacts that close within the step although their bodies are beyond the alert distance at its
//! start. They are predicted for pairs whose relative motion in the step is fast. Scenes without
//! fast motion only pay for a comparison of speeds.

use super::extents::Extents;
use super::margin::Stage;
use super::meeting::{Meeting, Search};
use super::order::{PredictedMeeting, mark_later};
use super::sweep::Sweep;
use super::{LawTable, centres, rebuild};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, Key, Network};
use crate::geometry::grid;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::threads;

/// Factor on the required range of the neighbour list, so that the list stays valid while bodies
/// accelerate.
const HEADROOM: f64 = 1.5;
/// Pairs per task.
const CHUNK: usize = 256;
/// Time of a pair (ns).
const COST: f64 = 20.0;
/// Time of a comparison of a body's displacement (ns).
const COMPARE: f64 = 2.0;
/// Limits on the pairs of a widened neighbour list: a multiple of those of the plain list, plus a
/// constant.
const MAX_PAIRS: (f64, f64) = (4.0, 5e6);

/// Motion of a step: velocities (m/s, rad/s) of all bodies, its start and length (s).
pub struct Motion<'a, S: Space> {
    /// Velocities and spins of the bodies.
    pub velocities: &'a [(S::Vector, S::Spin)],
    /// Time at the start of the step (s).
    pub time: f64,
    /// Its length (s).
    pub h: f64,
    /// Whether pairs are distributed over threads; the results are the same.
    pub parallel: bool,
}

/// Returns whether no two bodies can move fast relative to each other in the step, so that no
/// contact has to be predicted. Cheap. `velocity` gives velocity and spin of a body.
pub fn is_calm<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    velocity: impl Fn(usize) -> (S::Vector, S::Spin) + Sync,
    h: f64,
    parallel: bool,
) -> bool {
    if !network.extents.fits(shapes, bodies) {
        network.extents = Extents::new(shapes, bodies);
    }
    if !network.widened.is_empty() || network.turning.iter().any(|w| *w > 0.0) {
        return false;
    }
    let levers = &network.extents.levers;
    // What is not a number is reported where it is solved for.
    let known = |x: f64| if x.is_nan() { 0.0 } else { x };
    let largest = |of: &(dyn Fn(usize) -> f64 + Sync)| {
        threads::largest(parallel, levers.len(), COMPARE, |b| known(of(b)))
    };
    let fastest = largest(&|b| {
        let (v, _) = velocity(b);
        v.dot(&v)
    });
    let turning = largest(&|b| {
        let (lever, w) = (levers[b], velocity(b).1);
        lever * lever * w.dot(&w)
    });
    // The bound is below what requires a wider list or a check of pairs. A rotating surface always
    // requires them.
    let still = shapes.surfaces.iter().all(|s| {
        let b = s.body as usize;
        let spin = S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]);
        s.shape.keeps_place(&spin) || s.shape.deforms()
    });
    still && 2.0 * h * (fastest.sqrt() + turning.sqrt()) <= network.fast.min(network.alert)
}

/// Adds the contacts that the free velocities close in the step and that detection at its start did
/// not find.
pub fn add_predicted<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) {
    let found = find_closing(network, shapes, bodies, laws, motion, Stage::Before);
    network.merge_contacts(found);
}

/// Returns the contacts that the velocities after a solve would close in the step and that were not
/// part of it. If there are any, the step must be solved again with them; see
/// [`Network::merge_contacts`].
pub fn find_missed<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) -> Vec<Contact<S>> {
    let found = find_closing(network, shapes, bodies, laws, motion, Stage::After);
    network.step_size.repeated_solves += u64::from(!found.is_empty());
    found
}

/// Reports the pairs that penetrate in the step despite the contacts solved for.
pub fn report_passing<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
) {
    find_closing(network, shapes, bodies, laws, motion, Stage::Report);
}

/// Reports the pairs that penetrate in a move before detection, at the current velocities, which no
/// previous step has checked.
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
    let motion = Motion {
        velocities: &velocities,
        time,
        h: length,
        parallel: false,
    };
    if network.seen_at.is_empty() {
        let centres = centres(shapes, bodies, motion.parallel);
        rebuild(network, shapes, bodies, laws, &centres, &motion);
    }
    report_passing(network, shapes, bodies, laws, &motion);
}

/// The longest of some lengths (m), without those that are NaN.
fn longest(parallel: bool, list: &[f64]) -> f64 {
    let of = |k: usize| if list[k].is_nan() { 0.0 } else { list[k] };
    threads::largest(parallel, list.len(), COMPARE, of)
}

/// Computes the displacement of each body in the step, and widens the neighbour list around fast
/// bodies accordingly.
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
    let travels = network
        .extents
        .travels(bodies, motion.velocities, motion.h, motion.parallel);
    let half = 0.5 * network.alert;
    let need = |travel: &f64| (travel - half).max(0.0);
    let longest = |list: &[f64]| longest(motion.parallel, list);
    let farthest = longest(&travels);
    let widest = longest(&network.widened);
    let turn_faster = surfaces_turn_faster(network, shapes, bodies, motion);
    if farthest <= half && widest == 0.0 && !turn_faster {
        return travels;
    }
    // A margin for all bodies, so that a body that has just become fast does not require a new
    // list.
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
    let must = network.seen_at.is_empty()
        || turn_faster
        || threads::any(motion.parallel, bodies.len(), COMPARE, short);
    if must {
        network.widened = if farthest > half {
            travels.iter().map(wide).collect()
        } else {
            Vec::new()
        };
        let centres = centres(shapes, bodies, motion.parallel);
        limit(network, shapes, &centres);
        rebuild(network, shapes, bodies, laws, &centres, motion);
        let looked = |b: usize| network.widened.get(b).copied().unwrap_or(0.0);
        let beyond = |b: &usize| need(&travels[*b]) > looked(*b);
        let farthest = (0..bodies.len())
            .filter(beyond)
            .max_by(|a, b| travels[*a].total_cmp(&travels[*b]));
        if let Some(body) = farthest {
            network
                .step_size
                .record_unwatched(motion.time, bodies, body as u32);
        }
    }
    travels
}

/// Returns whether a surface moves by rotation faster than the neighbour list allows.
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
        // A surface that is invariant under its rotation does not move.
        spin.norm() > *seen
            && !surface.shape.deforms()
            && !surface
                .shape
                .keeps_place(&S::unrotate_spin(&bodies.rotation[b], &spin))
    })
}

/// Limits the widened list to the memory limit and to a period.
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
    // After some halvings the widening vanishes.
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

/// Finds the contacts of the pairs that meet in the step, in the order of the pairs, or reports the
/// pairs.
fn find_closing<S: Space>(
    network: &mut Network<S>,
    shapes: &Shapes<S>,
    bodies: &Bodies<S>,
    laws: &LawTable,
    motion: &Motion<S>,
    stage: Stage,
) -> Vec<Contact<S>> {
    let travels = widen(network, shapes, bodies, laws, motion);
    let farthest = longest(motion.parallel, &travels);
    let turning = network.turning.iter().any(|w| *w > 0.0);
    if 2.0 * farthest <= network.fast && !turning {
        return Vec::new();
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
    let fast = network.fast;
    let (balls, pieces) = (shapes.balls.len(), shapes.pieces.len());
    let count = balls + pieces + shapes.surfaces.len();
    let travel = |k: usize| {
        let body = if k < balls {
            shapes.balls[k].body
        } else if k < balls + pieces {
            shapes.pieces[k - balls].body
        } else {
            shapes.surfaces[k - balls - pieces].body
        };
        travels[body as usize]
    };
    let mut of_shapes = Vec::new();
    let divide = threads::pays(motion.parallel, count, COMPARE);
    threads::fill(divide, &mut of_shapes, count, travel);
    let search = Search {
        network,
        sweep: &sweep,
        laws,
        travels: of_shapes,
        // A pair with NaN is followed, and reported.
        farthest: threads::largest(motion.parallel, travels.len(), COMPARE, |b| travels[b]),
        turning,
        stage,
    };
    let examine = |pairs: &[(u32, u32)]| -> Vec<Meeting<S>> {
        // Pairs and contacts are in the same order.
        let contacts = &search.network.contacts;
        let mut at = pairs.first().map_or(0, |first| {
            contacts.partition_point(|c| c.key.pair() < *first)
        });
        let mut of_pair = |names: (u32, u32)| {
            while contacts.get(at).is_some_and(|c| c.key.pair() < names) {
                at += 1;
            }
            let first = at;
            while contacts.get(at).is_some_and(|c| c.key.pair() == names) {
                at += 1;
            }
            &contacts[first..at]
        };
        let pairs = pairs.iter();
        let examine = |names: &(u32, u32)| {
            if search.is_slow(*names) {
                return None;
            }
            let contacts = of_pair(*names);
            if search.detection_suffices(*names, contacts) {
                return None;
            }
            let pair = search.fast_pair(*names)?;
            search.examine(*names, &pair, contacts)
        };
        pairs.filter_map(examine).collect()
    };
    let divide = threads::pays(motion.parallel, candidates.len(), COST);
    let met = threads::map_chunks(divide, &candidates, threads::any_size(CHUNK), |_, pairs| {
        examine(pairs)
    });
    let (mut found, mut meetings) = (Vec::new(), Vec::new());
    for meeting in met.into_iter().flatten() {
        let known = found.len();
        found.extend(meeting.contacts);
        if let Some(at) = meeting.at {
            meetings.push(PredictedMeeting {
                names: meeting.names,
                bodies: meeting.bodies,
                at,
                travel: meeting.travel,
                contacts: known..found.len(),
            });
        }
        if meeting.passing {
            let step_size = &mut network.step_size;
            step_size.record_passing(sweep.time, sweep.bodies, meeting.bodies);
        }
    }
    if stage == Stage::Before {
        let body = |name| body_of(shapes, name);
        mark_later(&mut found, &meetings, &sweep, &candidates, body, fast);
    }
    network.candidates = candidates;
    network.extents = extents;
    found
}

/// Returns the body of the shape with this key.
fn body_of<S: Space>(shapes: &Shapes<S>, name: u32) -> usize {
    let k = (name & !(Key::PIECE | Key::SURFACE)) as usize;
    let body = if name & Key::SURFACE != 0 {
        shapes.surfaces[k].body
    } else if name & Key::PIECE != 0 {
        shapes.pieces[k].body
    } else {
        shapes.balls[k].body
    };
    body as usize
}

impl<S: Space> Network<S> {
    /// Merges contacts that close in the step into the network; contacts that already exist get the
    /// new geometry.
    pub fn merge_contacts(&mut self, found: Vec<Contact<S>>) {
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
