//! Which of the impacts that are foreseen in one step come first: an impact changes the motion from which later ones of the
//! same bodies were foreseen.

use super::foresee::TOLERATED;
use super::sweep::{Course, Sweep};
use crate::bodies::Bodies;
use crate::contact::network::Contact;
use crate::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;
use std::ops::Range;

/// A pair that meets in the step.
pub(super) struct PredictedMeeting {
    /// Candidate and antagonist, and their bodies.
    pub names: (u32, u32),
    pub bodies: [u32; 2],
    /// The part of the step that is over when they meet.
    pub at: f64,
    /// The farthest that two of their points move in the step (m).
    pub travel: f64,
    /// Its contacts among those found.
    pub contacts: Range<usize>,
}

/// Marks the contacts of meetings that come after an impact of one of their bodies, and of those before which a body would
/// have to go through another that was stopped on its way. Meetings nearer to each other than `fast` (m) are simultaneous.
pub(super) fn mark_later<S: Space>(
    found: &mut [Contact<S>],
    meetings: &[PredictedMeeting],
    sweep: &Sweep<S>,
    candidates: &[(u32, u32)],
    body: impl Fn(u32) -> usize,
    fast: f64,
) {
    if meetings.len() < 2 {
        return;
    }
    let mut order: Vec<&PredictedMeeting> = meetings.iter().collect();
    order.sort_by(|m, n| m.at.total_cmp(&n.at));
    // The first impact of each movable body, among meetings that come first.
    let mut first: BTreeMap<u32, f64> = BTreeMap::new();
    for meeting in order {
        let after = |b: &u32| {
            first
                .get(b)
                .is_some_and(|s| (meeting.at - s) * meeting.travel > fast)
        };
        if meeting.bodies.iter().any(after) {
            found[meeting.contacts.clone()]
                .iter_mut()
                .for_each(|c| c.later = true);
            continue;
        }
        for b in meeting.bodies {
            if is_movable(sweep.bodies, b as usize) {
                first.entry(b).or_insert(meeting.at);
            }
        }
    }
    // Each body goes to the place of its first impact: those that would meet on the way do so before the later one is there.
    let mut velocities = sweep.velocities.to_vec();
    for (b, s) in &first {
        let (v, w) = &mut velocities[*b as usize];
        (*v, *w) = (*v * *s, *w * *s);
    }
    let stopped = Sweep {
        velocities: &velocities,
        ..*sweep
    };
    for &names in candidates {
        let of = [names.0, names.1].map(|name| body(name) as u32);
        let [Some(one), Some(other)] = of.map(|b| first.get(&b).copied()) else {
            continue;
        };
        let pair = stopped.pair(names);
        let own = meetings.iter().any(|m| m.names == names);
        if own || (one - other).abs() * sweep.pair(names).travel.max(pair.travel) <= fast {
            continue;
        }
        if stopped.course(&pair, TOLERATED * fast) != Course::Clear {
            let blocked = if one > other { of[0] } else { of[1] };
            for meeting in meetings.iter().filter(|m| m.bodies.contains(&blocked)) {
                found[meeting.contacts.clone()]
                    .iter_mut()
                    .for_each(|c| c.later = true);
            }
        }
    }
}

fn is_movable<S: Space>(bodies: &Bodies<S>, b: usize) -> bool {
    bodies.inverse_mass[b] != S::Vector::zero()
        || bodies.inverse_inertia[b] > 0.0
        || bodies.carrier(b).is_some()
}
