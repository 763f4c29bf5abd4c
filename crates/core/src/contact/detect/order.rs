//! Order of the impacts predicted in one step. The first impact of a body changes the motion from
//! which its later impacts were predicted.

use super::margin::TOLERATED;
use super::sweep::{PairSweep, SweepResult};
use crate::bodies::Bodies;
use crate::contact::network::{Contact, ShapeIndex};
use crate::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;
use std::ops::Range;

/// A pair that meets within the step.
pub(super) struct PredictedMeeting {
    /// Keys of candidate and antagonist, and their bodies.
    pub names: (u32, u32),
    pub bodies: [u32; 2],
    /// Fraction of the step after which they meet.
    pub at: f64,
    /// Largest relative displacement of two points of the pair in the step (m).
    pub travel: f64,
    /// Range of the pair's contacts in the list of contacts found.
    pub contacts: Range<usize>,
}

/// Marks the contacts of meetings that follow an impact of one of their bodies, and of meetings
/// that would require a body to pass through another one that was stopped on its way. Meetings
/// closer together than `fast` (m) count as simultaneous.
pub(super) fn mark_later<S: Space>(
    found: &mut [Contact<S>],
    meetings: &[PredictedMeeting],
    sweep: &PairSweep<S>,
    candidates: &[(u32, u32)],
    fast: f64,
) {
    if meetings.len() < 2 {
        return;
    }
    let mut mark = |meeting: &PredictedMeeting| {
        let contacts = found[meeting.contacts.clone()].iter_mut();
        contacts.for_each(|c| c.later = true);
    };
    let mut order: Vec<&PredictedMeeting> = meetings.iter().collect();
    order.sort_by(|m, n| m.at.total_cmp(&n.at));
    // Time of the first impact of each movable body, among the first meetings.
    let mut first: BTreeMap<u32, f64> = BTreeMap::new();
    for meeting in order {
        let after = |b: &u32| {
            first
                .get(b)
                .is_some_and(|s| (meeting.at - s) * meeting.travel > fast)
        };
        if meeting.bodies.iter().any(after) {
            mark(meeting);
            continue;
        }
        for b in meeting.bodies {
            if is_movable(sweep.scene.bodies, b as usize) {
                first.entry(b).or_insert(meeting.at);
            }
        }
    }
    // Each body is moved to its first impact: bodies in its way meet it before the later impact
    // takes place.
    let mut velocities = sweep.velocities.to_vec();
    for (b, s) in &first {
        let (v, w) = &mut velocities[*b as usize];
        (*v, *w) = (*v * *s, *w * *s);
    }
    let stopped = PairSweep {
        velocities: &velocities,
        ..*sweep
    };
    for &names in candidates {
        let of = [names.0, names.1].map(|side| ShapeIndex::of(side).body(sweep.scene.shapes));
        let [Some(one), Some(other)] = of.map(|b| first.get(&b?).copied()) else {
            continue;
        };
        let pair = stopped.pair(names);
        let own = meetings.iter().any(|m| m.names == names);
        if own || (one - other).abs() * sweep.pair(names).travel.max(pair.travel) <= fast {
            continue;
        }
        if stopped.follow(&pair, TOLERATED * fast) != SweepResult::Separate
            && let Some(blocked) = if one > other { of[0] } else { of[1] }
        {
            let of_blocked = meetings.iter().filter(|m| m.bodies.contains(&blocked));
            of_blocked.for_each(&mut mark);
        }
    }
}

fn is_movable<S: Space>(bodies: &Bodies<S>, b: usize) -> bool {
    bodies.inverse_mass[b] != S::Vector::zero()
        || bodies.inverse_inertia[b] > 0.0
        || bodies.carrier(b).is_some()
}
