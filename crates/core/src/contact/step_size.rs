//! Signs that the time step is too large for the motion: contacts found late, bodies that may have passed through others.

use super::network::Contact;
use crate::bodies::Bodies;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// Overlap, in parts of a contact's radius, from which a contact counts as found late.
const LATE: f64 = 0.01;
/// When and between which bodies something was first seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Occurrence {
    /// Time at the start of the step (s).
    pub time: f64,
    /// The bodies: names of first bodies, numbers of grains.
    pub bodies: Vec<String>,
}

impl Occurrence {
    fn new<S: Space>(time: f64, bodies: &Bodies<S>, of: &[u32]) -> Self {
        Self {
            time,
            bodies: of.iter().map(|b| bodies.name(*b)).collect(),
        }
    }

    fn text(&self) -> String {
        format!(
            "the first at t = {:.6e} s: {}",
            self.time,
            self.bodies.join(" and ")
        )
    }
}

/// What shows, over a run, whether the time step was small enough to see every contact in time.
///
/// Pairs whose motion in a step exceeds what detection covers are followed through the step, and get their contact before
/// they meet. What is left to report is what that could not settle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSizeDiagnostics {
    /// Contacts that were first seen overlapping by more than a hundredth of their radius.
    pub late: u64,
    /// The deepest of these overlaps, in parts of the radius.
    pub deepest: f64,
    /// The first of them.
    pub first_late: Option<Occurrence>,
    /// Times that two bodies went deeper into each other within a step than a quarter of the thinner one's half thickness.
    pub passed: u64,
    /// The first of them.
    pub first_passed: Option<Occurrence>,
    /// Impacts with restitution that followed another of the same body within a step: the two were kept apart in that step
    /// and bounced in the next, which takes more energy than two impacts one after the other.
    pub held_back: u64,
    /// The first of them.
    pub first_held_back: Option<Occurrence>,
    /// Steps in which a body moved so far that not all it may have met was looked at.
    pub unwatched_steps: u64,
    /// The first of them.
    pub first_unwatched: Option<Occurrence>,
    /// The start of the last of them (s).
    #[serde(skip)]
    last_unwatched: Option<f64>,
    /// When the motion of a body was first lost to rounding, and which.
    pub motion_lost: Option<Occurrence>,
    /// Contacts that were made ahead of the step in which they close.
    pub foreseen: u64,
    /// Solves repeated with contacts that only the velocities of the first solve would have closed.
    pub repeated_solves: u64,
}

impl StepSizeDiagnostics {
    /// Notes a contact that is seen for the first time, of a pair that overlaps by `known` elsewhere already (m): a body that
    /// rests in a surface a little too deep meets its next facet as deep, which is no matter of speed.
    pub(super) fn meet<S: Space>(
        &mut self,
        contact: &Contact<S>,
        known: f64,
        time: f64,
        bodies: &Bodies<S>,
    ) {
        let depth = -contact.gap / contact.radius;
        if depth > LATE + known.max(0.0) / contact.radius {
            self.late += 1;
            self.deepest = self.deepest.max(depth);
            self.first_late
                .get_or_insert_with(|| Occurrence::new(time, bodies, &contact.bodies));
        }
    }

    /// Notes two bodies that the step could not keep apart.
    pub(super) fn pass<S: Space>(&mut self, time: f64, bodies: &Bodies<S>, pair: [u32; 2]) {
        self.passed += 1;
        self.first_passed
            .get_or_insert_with(|| Occurrence::new(time, bodies, &pair));
    }

    /// Notes two bodies whose impact follows another of the same step.
    pub(crate) fn hold_back<S: Space>(&mut self, time: f64, bodies: &Bodies<S>, pair: [u32; 2]) {
        self.held_back += 1;
        self.first_held_back
            .get_or_insert_with(|| Occurrence::new(time, bodies, &pair));
    }

    /// Notes a body that moves farther in a step than others are looked for.
    pub(super) fn leave_unwatched<S: Space>(&mut self, time: f64, bodies: &Bodies<S>, body: u32) {
        // A step may be looked at several times.
        if self.last_unwatched == Some(time) {
            return;
        }
        self.last_unwatched = Some(time);
        self.unwatched_steps += 1;
        self.first_unwatched
            .get_or_insert_with(|| Occurrence::new(time, bodies, &[body]));
    }

    /// Notes a body that moves less in a step than the spacing of numbers where it is.
    pub(crate) fn lose_motion<S: Space>(&mut self, time: f64, bodies: &Bodies<S>, body: u32) {
        self.motion_lost
            .get_or_insert_with(|| Occurrence::new(time, bodies, &[body]));
    }

    /// What to tell the user of motion lost to rounding, if there is any.
    pub fn rounding_warning(&self) -> Option<String> {
        self.motion_lost.as_ref().map(|first| {
            format!(
                "bodies moved less in a step than the spacing of numbers where they are, and stood still, {}; put the \
                 origin nearer to the scene, or take a larger time.step",
                first.text()
            )
        })
    }

    fn late_contacts(&self) -> Option<String> {
        let first = self
            .first_late
            .as_ref()
            .map_or(String::new(), Occurrence::text);
        (self.late > 0).then(|| {
            format!(
                "{} contacts were first seen overlapping, by up to {:.2e} of the radius, {first}",
                self.late, self.deepest
            )
        })
    }

    /// What to tell the user; none where every contact was seen in time.
    pub fn warning(&self) -> Option<String> {
        let first = |o: &Option<Occurrence>| o.as_ref().map_or(String::new(), Occurrence::text);
        let passed = (self.passed > 0).then(|| {
            format!(
                "{} times two bodies went into or through each other within a step, {}",
                self.passed,
                first(&self.first_passed)
            )
        });
        let held_back = (self.held_back > 0).then(|| {
            format!(
                "{} times impacts with restitution followed each other within a step, {}; the later ones lost more energy \
                 than their restitution says",
                self.held_back,
                first(&self.first_held_back)
            )
        });
        let unwatched = (self.unwatched_steps > 0).then(|| {
            format!(
                "in {} steps a body moved so far that not all in its way was looked at, {}; it may have passed through others",
                self.unwatched_steps,
                first(&self.first_unwatched)
            )
        });
        let late = self.late_contacts();
        let told: Vec<String> = [passed, held_back, unwatched, late]
            .into_iter()
            .flatten()
            .collect();
        (!told.is_empty()).then(|| format!("{}; take a smaller time.step", told.join("; ")))
    }
}
