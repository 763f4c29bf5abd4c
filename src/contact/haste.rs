//! Bodies that move so far in a step that a contact is seen late, already overlapping, or not at all.

use crate::bodies::Bodies;
use crate::geometry::convex::DEEP;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Serialize};

/// Overlap, in parts of a contact's radius, from which a contact was seen too late.
const LATE: f64 = 0.01;

/// What was too fast for the step, over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Haste {
    /// Contacts that were first seen overlapping by more than a hundredth of their radius.
    pub late: u64,
    /// The deepest of these overlaps, in parts of the radius.
    pub deepest: f64,
    /// Steps in which a free body moved farther than its own length and the alert distance: what it meets there may have been
    /// jumped over.
    pub hasty_steps: u64,
    /// When the first of them began (s).
    pub first: f64,
    /// The farthest that a free body moved in a step, in parts of its length (a grain's radius).
    pub farthest: f64,
    /// Times that a polygon or polyhedron came near a profile or facets with a corner that moved more than a quarter of the piece's
    /// size and the alert distance in the step: corners deeper than that behind them are not seen.
    pub plunges: u64,
    /// The farthest that such a corner moved in a step, in parts of its piece's size.
    pub deepest_plunge: f64,
}

impl Haste {
    /// Notes how far the free bodies move in a step of h (s), at its beginning.
    pub(super) fn watch<S: Space>(&mut self, bodies: &Bodies<S>, alert: f64, time: f64, h: f64) {
        let mut hasty = false;
        for b in 0..bodies.len() {
            let free = bodies.inverse_mass[b] != S::Vector::null() && !bodies.gone[b];
            let length = bodies.length[b];
            if !free || length <= 0.0 {
                continue;
            }
            let v = &bodies.velocity[b];
            let path = h * v.dot(v).sqrt();
            self.farthest = self.farthest.max(path / length);
            hasty |= path > length + alert;
        }
        if hasty {
            if self.hasty_steps == 0 {
                self.first = time;
            }
            self.hasty_steps += 1;
        }
    }

    /// Notes how far the corners of a piece of this size moved in a step on to a skin that they are near (m).
    pub(super) fn plunge(&mut self, path: f64, size: f64, alert: f64) {
        if path > DEEP * size + alert {
            self.plunges += 1;
            self.deepest_plunge = self.deepest_plunge.max(path / size);
        }
    }

    /// Notes a contact that is seen for the first time.
    pub(super) fn meet(&mut self, gap: f64, radius: f64) {
        if gap < -LATE * radius {
            self.late += 1;
            self.deepest = self.deepest.max(-gap / radius);
        }
    }

    /// What to tell the user; none where nothing was too fast.
    pub fn warning(&self) -> Option<String> {
        let late = match self.late {
            0 => String::new(),
            n => format!(
                "{n} contacts were first seen overlapping, by up to {:.2e} of the radius",
                self.deepest
            ),
        };
        let hasty = match self.hasty_steps {
            0 => String::new(),
            n => format!(
                "in {n} steps, the first at t = {:.4e} s, a body moved farther than its own length (up to {:.2e} times) and \
                 may have jumped over others",
                self.first, self.farthest
            ),
        };
        let plunges = match self.plunges {
            0 => String::new(),
            n => format!(
                "{n} times the corners of a polygon or polyhedron moved farther than a quarter of its size in a step (up to \
                 {:.2e} times), near or along a profile, height field or mesh, which they may have passed unseen",
                self.deepest_plunge
            ),
        };
        let told: Vec<String> = [late, hasty, plunges]
            .into_iter()
            .filter(|t| !t.is_empty())
            .collect();
        (!told.is_empty()).then(|| {
            format!(
                "{}; take a smaller time.step or a larger detection.alert",
                told.join("; ")
            )
        })
    }
}
