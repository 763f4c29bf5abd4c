//! Contacts that close within the step although their bodies are beyond the alert distance at its
//! start. They are predicted for pairs whose relative motion in the step is fast. In scenes without
//! fast motion the only cost is a comparison of speeds.

use super::margin::SearchStage;
use super::meeting::{Meeting, MeetingSearch};
use super::order::{PredictedMeeting, mark_later};
use super::sweep::PairSweep;
use super::{CollisionScene, centres, rebuild};
use crate::contact::Occurrence;
use crate::contact::network::{Contact, Network};
use crate::geometry::grid::{self, Balls};
use crate::geometry::shape::{Carried, Shapes};
use crate::geometry::space::{Space, VectorLike};
use crate::threads;

/// Factor on the required range of the neighbour list, so that the list stays valid while bodies
/// accelerate.
const HEADROOM: f64 = 1.5;
/// Pairs per task.
const CHUNK: usize = 256;
/// Approximate time to examine a pair (ns).
const COST: f64 = 20.0;
/// Approximate time to compare the displacement of a body (ns).
const COMPARE: f64 = 2.0;
/// Limits on the pairs of a widened neighbour list: a multiple of the pairs of the plain list, plus
/// a constant.
const MAX_PAIRS: (f64, f64) = (4.0, 5e6);

/// Motion in a step: velocities (m/s, rad/s) of all bodies, start and length of the step (s).
pub struct StepMotion<'a, S: Space> {
    /// Velocities and spins of the bodies.
    pub velocities: &'a [(S::Vector, S::Spin)],
    /// Time at the start of the step (s).
    pub time: f64,
    /// Length of the step (s).
    pub h: f64,
    /// Whether pairs are distributed over threads; the results are the same.
    pub parallel: bool,
}

/// Returns whether no two bodies can move fast relative to each other in the step, so that no
/// contact has to be predicted. The test is cheap. `velocity` gives velocity and spin of a body.
pub fn is_calm<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    velocity: impl Fn(usize) -> (S::Vector, S::Spin) + Sync,
    h: f64,
    parallel: bool,
) -> bool {
    network.extents.update(scene);
    if !network.widened.is_empty() || network.turning.iter().any(|w| *w > 0.0) {
        return false;
    }
    let levers = &network.extents.levers;
    // NaN is reported by the solver.
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
    // The bound is too small to require a wider list or a check of pairs. A rotating surface always
    // requires them.
    let surfaces = &scene.shapes.surfaces;
    let spin = |s: &Carried<S>| &scene.bodies.spin[s.body as usize];
    let still = !surfaces.iter().any(|s| scene.sweeps(s, spin(s)));
    still && 2.0 * h * (fastest.sqrt() + turning.sqrt()) <= network.fast.min(network.alert)
}

/// Adds the contacts that the free velocities close in the step and that detection at its start did
/// not find.
pub fn add_predicted<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
) {
    let closing = find_closing(network, scene, motion, SearchStage::Before);
    network.merge_contacts(closing.contacts);
}

/// Returns the contacts that the velocities after a solve would close in the step and that were not
/// part of it. If there are any, the step must be solved again with them; see
/// [`Network::merge_contacts`].
///
/// A spring that pushed in the solve overlaps by its law, however far its bodies move: `pushes`
/// tells whether the contact of an index did. Such a contact is not solved for again, its pair only
/// reported where it passes through. A spring that did not push was not known to close: the step is
/// solved again, with the place where its bodies meet.
pub fn find_missed<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
    pushes: impl Fn(usize) -> bool,
) -> Vec<Contact<S>> {
    let mut closing = find_closing(network, scene, motion, SearchStage::After);
    let mut held: Vec<(u32, u32)> = Vec::new();
    closing.contacts.retain(|c| {
        let spring = network.is_held_by_spring(c, &pushes);
        held.extend(spring.then(|| c.key.pair()));
        !spring
    });
    if !closing.contacts.is_empty() {
        network.step_size.repeated_solves += 1;
        return closing.contacts;
    }
    if !held.is_empty() {
        held.sort_unstable();
        let passing = find_closing(network, scene, motion, SearchStage::Report).passing;
        let springs = passing.into_iter();
        let springs = springs.filter(|pair| held.binary_search(&pair.names).is_ok());
        closing.passing.extend(springs);
        closing.passing.sort_by_key(|pair| pair.names);
        closing.passing.dedup_by_key(|pair| pair.names);
    }
    record_passing(network, scene, motion, &closing.passing);
    Vec::new()
}

/// Reports the pairs that penetrate in the step despite the contacts solved for.
pub fn report_passing<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
) {
    let closing = find_closing(network, scene, motion, SearchStage::Report);
    record_passing(network, scene, motion, &closing.passing);
}

fn record_passing<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
    pairs: &[PassingPair],
) {
    for pair in pairs {
        let first = || Occurrence::new(motion.time, scene.bodies, &pair.bodies);
        network.step_size.record_passing(first);
    }
}

/// Reports the pairs that penetrate in a move before detection, at the current velocities, which no
/// previous step has checked.
pub fn report_first_move<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    time: f64,
    length: f64,
) {
    let velocities = scene.velocities();
    let motion = StepMotion {
        velocities: &velocities,
        time,
        h: length,
        parallel: false,
    };
    if network.seen_at.is_empty() {
        let centres = centres(scene, motion.parallel);
        rebuild(network, scene, &centres, &motion);
    }
    report_passing(network, scene, &motion);
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
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
) -> Vec<f64> {
    let bodies = scene.bodies;
    network.extents.update(scene);
    let travels = network
        .extents
        .travels(bodies, motion.velocities, motion.h, motion.parallel);
    let half = 0.5 * network.alert;
    let need = |travel: &f64| (travel - half).max(0.0);
    let longest = |list: &[f64]| longest(motion.parallel, list);
    let farthest = longest(&travels);
    let widest = longest(&network.widened);
    let turn_faster = surfaces_turn_faster(network, scene, motion);
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
    let listed = |b: usize| network.widened.get(b).copied().unwrap_or(0.0);
    let short = |b: usize| need(&travels[b]) > listed(b);
    let must = network.seen_at.is_empty()
        || turn_faster
        || threads::any(motion.parallel, bodies.len(), COMPARE, short);
    if must {
        network.widened = if farthest > half {
            travels.iter().map(wide).collect()
        } else {
            Vec::new()
        };
        let centres = centres(scene, motion.parallel);
        limit(network, scene.shapes, &centres);
        rebuild(network, scene, &centres, motion);
        let listed = |b: usize| network.widened.get(b).copied().unwrap_or(0.0);
        let beyond = |b: &usize| need(&travels[*b]) > listed(*b);
        let farthest = (0..bodies.len())
            .filter(beyond)
            .max_by(|a, b| travels[*a].total_cmp(&travels[*b]));
        if let Some(body) = farthest {
            let first = || Occurrence::new(motion.time, bodies, &[body as u32]);
            network.step_size.record_unwatched(motion.time, first);
        }
    }
    travels
}

/// Returns whether a surface moves by rotation faster than the neighbour list allows.
fn surfaces_turn_faster<S: Space>(
    network: &Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
) -> bool {
    let mut surfaces = scene.shapes.surfaces.iter().zip(&network.turning);
    surfaces.any(|(surface, listed)| {
        let spin = motion.velocities[surface.body as usize].1;
        spin.norm() > *listed && scene.sweeps(surface, &spin)
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
    let pairs = |radii: &[f64]| {
        grid::pairs_bound(&Balls {
            centres,
            radii,
            reach,
            periodic: &shapes.periodic,
        })
    };
    let most = MAX_PAIRS.0 * pairs(&radii) + MAX_PAIRS.1;
    // After some halvings the widening vanishes.
    for _ in 0..64 {
        let widened = &network.widened;
        let wide: Vec<f64> = bodies
            .iter()
            .map(|(b, r)| r + widened[*b as usize])
            .collect();
        if pairs(&wide) <= most {
            return;
        }
        network.widened.iter_mut().for_each(|w| *w *= 0.5);
    }
    network.widened.iter_mut().for_each(|w| *w = 0.0);
}

/// A pair that may pass through each other in the step.
struct PassingPair {
    names: (u32, u32),
    bodies: [u32; 2],
}

/// Contacts that close in the step, and pairs that they cannot keep from passing, both in the order
/// of the pairs.
struct Closing<S: Space> {
    contacts: Vec<Contact<S>>,
    passing: Vec<PassingPair>,
}

/// Finds the contacts of the pairs that meet in the step, or the pairs to report.
fn find_closing<S: Space>(
    network: &mut Network<S>,
    scene: &CollisionScene<S>,
    motion: &StepMotion<S>,
    stage: SearchStage,
) -> Closing<S> {
    let (mut found, mut passing) = (Vec::new(), Vec::new());
    let travels = widen(network, scene, motion);
    let farthest = longest(motion.parallel, &travels);
    let turning = network.turning.iter().any(|w| *w > 0.0);
    if 2.0 * farthest <= network.fast && !turning {
        return Closing {
            contacts: found,
            passing,
        };
    }
    let extents = std::mem::take(&mut network.extents);
    let candidates = std::mem::take(&mut network.candidates);
    let sweep = PairSweep {
        scene,
        extents: &extents,
        velocities: motion.velocities,
        time: motion.time,
        h: motion.h,
        alert: network.alert,
    };
    let fast = network.fast;
    let shapes = scene.shapes;
    let bodies = shapes.balls.iter().map(|b| b.body);
    let bodies = bodies.chain(shapes.pieces.iter().map(|p| p.body));
    let bodies = bodies.chain(shapes.surfaces.iter().map(|s| s.body));
    let search = MeetingSearch {
        network,
        sweep: &sweep,
        travels: bodies.map(|b| travels[b as usize]).collect(),
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
    let divide = threads::worth_dividing(motion.parallel, candidates.len(), COST);
    let met = threads::map_chunks(
        divide,
        &candidates,
        threads::chunk_size(CHUNK),
        |_, pairs| examine(pairs),
    );
    let mut meetings = Vec::new();
    for meeting in met.into_iter().flatten() {
        let first = found.len();
        found.extend(meeting.contacts);
        if let Some(at) = meeting.at {
            meetings.push(PredictedMeeting {
                names: meeting.names,
                bodies: meeting.bodies,
                at,
                travel: meeting.travel,
                contacts: first..found.len(),
            });
        }
        if meeting.passing {
            passing.push(PassingPair {
                names: meeting.names,
                bodies: meeting.bodies,
            });
        }
    }
    if stage == SearchStage::Before {
        mark_later(&mut found, &meetings, &sweep, &candidates, fast);
    }
    network.candidates = candidates;
    network.extents = extents;
    Closing {
        contacts: found,
        passing,
    }
}

impl<S: Space> Network<S> {
    /// Returns whether a compliant contact with the key of this one pushes.
    fn is_held_by_spring(&self, contact: &Contact<S>, pushes: impl Fn(usize) -> bool) -> bool {
        let find = || self.contacts.binary_search_by_key(&contact.key, |c| c.key);
        self.memory[contact.law as usize].compliant && find().is_ok_and(pushes)
    }

    /// Merges contacts that close in the step into the network; contacts that already exist get the
    /// new geometry.
    pub fn merge_contacts(&mut self, found: Vec<Contact<S>>) {
        let known = self.contacts.len();
        self.step_size.foreseen += found.len() as u64;
        for mut contact in found {
            let at = self.contacts[..known].binary_search_by_key(&contact.key, |c| c.key);
            match at {
                Ok(at) => {
                    let old = &mut self.contacts[at];
                    old.closing = true;
                    old.later |= contact.later;
                    old.central = false;
                    old.gap = contact.gap;
                    old.normal = contact.normal;
                    old.arms = contact.arms;
                }
                Err(_) => {
                    contact.broken = self.broken_pairs.contains(&contact.key.pair());
                    self.contacts.push(contact);
                }
            }
        }
        if self.contacts.len() > known {
            self.contacts.sort_by_key(|c| c.key);
        }
    }
}
