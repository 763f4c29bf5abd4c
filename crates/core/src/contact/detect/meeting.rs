//! The search for a pair that meets within a step.

use super::margin::{SearchStage, margin};
use super::sweep::{PairSweep, SweepResult, SweptPair};
use crate::contact::network::{Contact, Key, Network, ShapeIndex};
use crate::geometry::space::Space;

/// Bound of the rounding of gaps, relative to the motion.
const ROUNDING: f64 = 1e-9;

/// The search for pairs that meet in the step.
pub(super) struct MeetingSearch<'a, S: Space> {
    pub network: &'a Network<S>,
    pub sweep: &'a PairSweep<'a, S>,
    /// Displacement of each ball, piece and surface in the step (m), in this order.
    pub travels: Vec<f64>,
    /// Largest displacement of all bodies in the step (m).
    pub farthest: f64,
    /// Whether a surface moves by rotation.
    pub turning: bool,
    pub stage: SearchStage,
}

/// A pair that meets in the step.
pub(super) struct Meeting<S: Space> {
    pub names: (u32, u32),
    pub bodies: [u32; 2],
    /// Fraction of the step after which the pair meets; `None` if the pair cannot be followed.
    pub at: Option<f64>,
    /// Largest relative displacement of two points of the pair in the step (m).
    pub travel: f64,
    /// Contacts at that time; empty for a pair that is only reported.
    pub contacts: Vec<Contact<S>>,
    /// Whether the pair is reported: its bodies may pass through each other.
    pub passing: bool,
}

impl<'a, S: Space> MeetingSearch<'a, S> {
    /// Returns whether the rotation of a surface moves it relative to the pair.
    fn turns(&self, names: (u32, u32)) -> bool {
        self.turning && names.1 & Key::SURFACE != 0
    }

    /// Relative motion in a step from which a pair is followed (m).
    fn slow(&self, names: (u32, u32)) -> f64 {
        // Two balls have a single contact: if they move less than the alert distance, detection has
        // found it.
        let balls = (names.0 | names.1) & (Key::PIECE | Key::SURFACE) == 0;
        if balls {
            self.network.alert
        } else {
            self.network.fast
        }
    }

    /// Upper bound of the relative motion of a pair, without that of a rotating surface (m).
    fn travel(&self, names: (u32, u32)) -> f64 {
        let counts = self.sweep.scene.counts();
        let travel = |side: u32| self.travels[ShapeIndex::of(side).place(counts)];
        travel(names.0) + travel(names.1)
    }

    /// Returns whether the relative motion of a pair is slow by the cheap upper bound.
    pub fn is_slow(&self, names: (u32, u32)) -> bool {
        let slow = self.slow(names);
        !self.turns(names) && (2.0 * self.farthest <= slow || self.travel(names) <= slow)
    }

    /// Returns whether a pair of convex bodies without a contact, at the places of detection, is
    /// farther apart than it moves.
    pub fn detection_suffices(&self, names: (u32, u32), contacts: &[Contact<S>]) -> bool {
        let convex = names.1 & Key::SURFACE == 0 && self.stage != SearchStage::Report;
        convex && contacts.is_empty() && self.travel(names) <= self.network.alert
    }

    /// Returns the pair with these keys if its relative motion in the step is fast.
    pub fn fast_pair(&self, names: (u32, u32)) -> Option<SweptPair<'a, S>> {
        let slow = self.slow(names);
        let pair = self.sweep.pair(names);
        // The comparison is false for NaN, so that such a pair is followed, and reported.
        if pair.travel <= slow {
            None
        } else {
            Some(pair)
        }
    }

    /// Follows a fast pair with these contacts through the step. Returns `None` if it does not
    /// meet, otherwise the contacts where it meets, or none if it is only to be reported.
    pub fn examine(
        &self,
        names: (u32, u32),
        pair: &SweptPair<S>,
        contacts: &[Contact<S>],
    ) -> Option<Meeting<S>> {
        let sweep = self.sweep;
        let [one, other] = pair.materials();
        let law = sweep.scene.laws.get(one, other);
        let compliant = law.is_some_and(|l| self.network.memory[l as usize].compliant);
        let margin = margin(self.network, contacts, pair, self.stage, compliant)?;
        // A pair without surfaces does not meet if its gap at detection is larger than its motion
        // along the normal.
        let known = names.1 & Key::SURFACE == 0 && !contacts.iter().any(|c| c.closing);
        let nearest = contacts.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
        if let Some(nearest) = nearest
            && known
            && pair.travel.is_finite()
            && self.stage == SearchStage::After
            && nearest.gap + margin.deepest
                > (1.0 + ROUNDING) * sweep.h * pair.closing_speed(&nearest.normal)
        {
            return None;
        }
        if sweep.follow(pair, margin.deepest) == SweepResult::Separate {
            return None;
        }
        let mut meeting = Meeting {
            names,
            bodies: pair.bodies(),
            at: None,
            travel: pair.travel,
            contacts: Vec::new(),
            passing: self.stage == SearchStage::Report,
        };
        if meeting.passing {
            return Some(meeting);
        }
        if let (SweepResult::Meets(s), Some(law)) = (sweep.follow(pair, margin.begins), law) {
            meeting.at = Some(s);
            sweep.contacts(pair, s, law, &mut meeting.contacts);
        }
        // A pair that cannot be followed, or cannot be held at the point of meeting, is reported.
        meeting.passing = meeting.contacts.is_empty() && self.stage == SearchStage::After;
        Some(meeting)
    }
}
