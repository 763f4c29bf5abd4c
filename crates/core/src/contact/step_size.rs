//! Diagnostics of a time step that is too large for the motion: contacts found late, bodies that
//! may have passed through others.

use super::network::Contact;
use crate::bodies::Bodies;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Serialize};

/// Penetration, as a fraction of the reduced radius of two bodies, from which a contact counts as
/// found late.
const LATE: f64 = 0.01;
/// Penetration, relative to the reduced radius, from which a contact of springs counts as found
/// late. Springs overlap by that much under load; softer ones are too soft for a contact (`fretwork
/// check`).
const LATE_SPRING: f64 = 0.05;
/// Ratio of an overlap to the relative motion of the bodies in a step, above which the overlap is
/// not due to their speed.
const NOT_BY_SPEED: f64 = 2.0;

/// Time and bodies of the first occurrence of an event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Occurrence {
    /// Time at the start of the step (s).
    pub time: f64,
    /// The bodies: names of first bodies, indices of grains.
    pub bodies: Vec<String>,
}

impl Occurrence {
    pub(crate) fn new<S: Space>(time: f64, bodies: &Bodies<S>, of: &[u32]) -> Self {
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

/// Relative speed of a contact (m/s), or a bound on it where a surface deforms: its body has the
/// velocity of its origin alone.
fn speed_of<S: Space>(contact: &Contact<S>, bodies: &Bodies<S>) -> f64 {
    /// Largest assumed ratio of the speed of any point of a surface to that of its origin.
    const ELSEWHERE: f64 = 100.0;
    let at = |side: usize| {
        let b = contact.bodies[side] as usize;
        bodies.velocity[b] + S::spin_velocity(&bodies.spin[b], &contact.arms[side])
    };
    // Points of a system are separate bodies, and grains are nearly rigid; a contactor that is
    // alone in its system is a surface.
    let deforms = |side: usize| {
        let carrier = bodies.carrier(contact.bodies[side] as usize);
        let carrier = carrier.filter(|c| !c.grain);
        carrier.is_some_and(|carrier| {
            let all = bodies.carriers.iter().flatten();
            all.filter(|c| c.system == carrier.system).count() == 1
        })
    };
    match [0, 1].map(deforms) {
        [false, false] => (at(0) - at(1)).norm(),
        surfaces => {
            let of = |side: usize| at(side).norm() * if surfaces[side] { ELSEWHERE } else { 1.0 };
            of(0) + of(1)
        }
    }
}

/// Indicators, over a run, of whether the time step was small enough to find every contact in time.
///
/// Pairs whose motion in a step exceeds the range of detection are followed through the step and
/// get their contact before they meet. The cases that this cannot resolve are reported here.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSizeDiagnostics {
    /// Number of contacts first found with a penetration above a hundredth of their radius.
    pub late: u64,
    /// Deepest of these penetrations, as a fraction of the radius.
    pub deepest: f64,
    /// First occurrence.
    pub first_late: Option<Occurrence>,
    /// Number of contacts first found at such a depth although the bodies do not move that far in a
    /// step: they sank into each other, or met from behind a surface.
    pub sunk: u64,
    /// Deepest of these penetrations, as a fraction of the radius.
    pub deepest_sunk: f64,
    /// First occurrence.
    pub first_sunk: Option<Occurrence>,
    /// Number of times that two bodies penetrated within a step by more than a quarter of the
    /// thinner one's half thickness.
    pub passed: u64,
    /// First occurrence.
    pub first_passed: Option<Occurrence>,
    /// Number of impacts with restitution that followed another impact of the same body within a
    /// step: they were only kept from closing in that step and rebounded in the next, which
    /// dissipates more energy than two successive impacts.
    pub held_back: u64,
    /// First occurrence.
    pub first_held_back: Option<Occurrence>,
    /// Number of steps in which a body moved too far for all possible contacts to be examined.
    pub unwatched_steps: u64,
    /// First occurrence.
    pub first_unwatched: Option<Occurrence>,
    /// Start of the last step in which this happened (s).
    #[serde(skip)]
    last_unwatched: Option<f64>,
    /// Number of times that a sliding body hit the edge of a neighbour of its support, which was no
    /// higher than the overlaps in the scene.
    pub edges: u64,
    /// Height of the highest such edge (m).
    pub highest_edge: f64,
    /// Number of convex pieces in the scene when a body last hit such an edge.
    pub pieces: u64,
    /// First occurrence of such an impact.
    pub first_edge: Option<Occurrence>,
    /// First occurrence of a displacement lost to rounding.
    pub motion_lost: Option<Occurrence>,
    /// Number of contacts created before they closed.
    pub foreseen: u64,
    /// Number of solves repeated for contacts found from the velocities of the first solve.
    pub repeated_solves: u64,
}

impl StepSizeDiagnostics {
    /// Records a contact that is found for the first time, of a pair that already penetrates by
    /// `known` (m) elsewhere: a body that rests slightly too deep in a surface meets the next facet
    /// at the same depth, which is not due to its speed. `size` is the reduced radius of the bodies
    /// (m): that of the contact is the tributary part of a face, which may be much
    /// smaller. Bodies that move less than the overlap in the time `h` (s) between two detections
    /// did not get there by their speed.
    pub(super) fn record_late<S: Space>(
        &mut self,
        contact: &Contact<S>,
        [known, size]: [f64; 2],
        compliant: bool,
        [time, h]: [f64; 2],
        bodies: &Bodies<S>,
    ) {
        let known = known.max(0.0);
        let depth = -contact.gap / size;
        let allowed = if compliant { LATE_SPRING } else { LATE };
        if depth <= allowed + known / size {
            return;
        }
        let sank = -contact.gap - known > NOT_BY_SPEED * h * speed_of(contact, bodies);
        let (count, deepest, first) = if sank {
            (&mut self.sunk, &mut self.deepest_sunk, &mut self.first_sunk)
        } else {
            (&mut self.late, &mut self.deepest, &mut self.first_late)
        };
        *count += 1;
        *deepest = deepest.max(depth);
        first.get_or_insert_with(|| Occurrence::new(time, bodies, &contact.bodies));
    }

    /// Returns the warning about bodies that sank into each other, if there were any.
    pub fn sunk_warning(&self) -> Option<String> {
        let first = self.first_sunk.as_ref()?;
        Some(format!(
            "{} contacts were first seen overlapping, by up to {:.2e} of the radius, of bodies that do not move as far in a step, {}: \
             bodies at rest sank into each other by the error of the solver (take a smaller solver.tolerance, or solver.norm \
             Velocity), or a surface faces the wrong way (anticlockwise corners of the triangles of a mesh, seen from outside)",
            self.sunk,
            self.deepest_sunk,
            first.text()
        ))
    }

    /// Records two bodies that the step could not keep apart.
    pub(super) fn record_passing(&mut self, first: impl FnOnce() -> Occurrence) {
        self.passed += 1;
        self.first_passed.get_or_insert_with(first);
    }

    /// Records two bodies whose impact follows another one of the same step.
    pub(crate) fn record_held_back(&mut self, first: impl FnOnce() -> Occurrence) {
        self.held_back += 1;
        self.first_held_back.get_or_insert_with(first);
    }

    /// Records a body that slides into an edge of this height (m), in a scene of `pieces` convex
    /// pieces.
    pub(super) fn record_edge(
        &mut self,
        height: f64,
        pieces: u64,
        first: impl FnOnce() -> Occurrence,
    ) {
        self.edges += 1;
        self.highest_edge = self.highest_edge.max(height);
        self.pieces = pieces;
        self.first_edge.get_or_insert_with(first);
    }

    /// Records a body that moves farther in a step that starts at `time` (s) than the range in
    /// which contacts are searched.
    pub(super) fn record_unwatched(&mut self, time: f64, first: impl FnOnce() -> Occurrence) {
        // A step may be examined several times.
        if self.last_unwatched == Some(time) {
            return;
        }
        self.last_unwatched = Some(time);
        self.unwatched_steps += 1;
        self.first_unwatched.get_or_insert_with(first);
    }

    /// Records a body whose displacement in a step is below the floating-point spacing of its
    /// position.
    pub(crate) fn record_lost_motion(&mut self, first: impl FnOnce() -> Occurrence) {
        self.motion_lost.get_or_insert_with(first);
    }

    /// Returns the warning about bodies that slid into low edges, and whether these are more than
    /// one to a thousand pieces.
    pub fn edges_warning(&self) -> Option<(bool, String)> {
        let first = self.first_edge.as_ref()?;
        let text = format!(
            "{} times a body that slid over another one was slowed or stopped by the edge of its neighbour, {}. The edges stand out by up to \
             {:.1e} m, no more than bodies overlap: the error of the solver may have made them of faces that were flush. Take a smaller \
             solver.tolerance, or a detection.alert of {:.1e} m or more, since faces that differ by up to a hundredth of it count as one",
            self.edges,
            first.text(),
            self.highest_edge,
            200.0 * self.highest_edge.max(0.0)
        );
        Some((1000 * self.edges >= self.pieces, text))
    }

    /// Returns the warning about motion lost to rounding, if there was any.
    pub fn rounding_warning(&self) -> Option<String> {
        self.motion_lost.as_ref().map(|first| {
            format!(
                "bodies moved less in a step than the floating-point spacing of their coordinates, and did not move, {}; put the \
                 origin nearer to the scene, or take a larger time.step",
                first.text()
            )
        })
    }

    /// Returns the warning for the user; `None` if every contact was found in time.
    pub fn warning(&self) -> Option<String> {
        let first = |o: &Option<Occurrence>| o.as_ref().map_or(String::new(), Occurrence::text);
        let passed = (self.passed > 0).then(|| {
            format!(
                "{} times two bodies penetrated or passed through each other within a step, {}",
                self.passed,
                first(&self.first_passed)
            )
        });
        let held_back = (self.held_back > 0).then(|| {
            format!(
                "{} times impacts with restitution followed each other within a step, {}; the later ones dissipated more energy \
                 than their restitution says",
                self.held_back,
                first(&self.first_held_back)
            )
        });
        let unwatched = (self.unwatched_steps > 0).then(|| {
            format!(
                "in {} steps a body moved farther than contacts were searched for, {}; it may have passed through others",
                self.unwatched_steps,
                first(&self.first_unwatched)
            )
        });
        let late = (self.late > 0).then(|| {
            format!(
                "{} contacts were first seen overlapping, by up to {:.2e} of the radius, {}",
                self.late,
                self.deepest,
                first(&self.first_late)
            )
        });
        let all = [passed, held_back, unwatched, late];
        let warnings: Vec<String> = all.into_iter().flatten().collect();
        (!warnings.is_empty()).then(|| format!("{}; take a smaller time.step", warnings.join("; ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::Carrier;
    use crate::contact::Key;
    use crate::contact::network::ContactGeometry;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    /// A contact of two faces at the body of index 0.
    fn contact(depth: f64, radius: f64) -> Contact<Dim2> {
        let geometry = ContactGeometry {
            gap: -depth,
            normal: Vector2::new(0.0, 1.0),
            arms: [Vector2::zeros(); 2],
            radius,
        };
        let key = Key::new(Key::PIECE, Key::PIECE | 1, 0);
        Contact::new(key, [0, 1], 0, geometry, 0.0)
    }

    /// Grains of 1e-6 m, one metre apart.
    fn grains(count: usize) -> Bodies<Dim2> {
        let mut bodies = Bodies::default();
        for x in 0..count {
            bodies.add_ball(Vector2::new(x as f64, 0.0), 1e-6, 1e3);
        }
        bodies
    }

    /// Returns the numbers of contacts found late and of contacts that sank, after a contact with a
    /// penetration of 2e-8 m between grains of 1e-6 m was found within a second.
    fn late_and_sunk(bodies: &Bodies<Dim2>) -> (u64, u64) {
        let mut found = StepSizeDiagnostics::default();
        let contact = contact(2e-8, 1e-6);
        found.record_late(&contact, [0.0, 1e-6], false, [1.0, 1.0], bodies);
        (found.late, found.sunk)
    }

    /// Two surfaces share a facet of 1e-9 m on grains of 1e-6 m: an overlap of twice that length is
    /// not due to speed, an overlap of 2 % of the grain is.
    #[test]
    fn late_contacts_are_measured_by_their_bodies() {
        let mut bodies = grains(2);
        // Faster than any of these overlaps in a second.
        bodies.velocity[0] = Vector2::new(0.0, -1.0);
        let mut found = StepSizeDiagnostics::default();
        for (depth, compliant, late) in [(2e-9, false, 0), (2e-8, true, 0), (2e-8, false, 1)] {
            let contact = contact(depth, 1e-9);
            found.record_late(&contact, [0.0, 1e-6], compliant, [1.0, 1.0], &bodies);
            assert_eq!(found.late, late);
        }
        assert!((found.deepest - 0.02).abs() < 1e-12 && found.sunk == 0);
    }

    /// The overlap of a body at 1e-9 m/s, of 2e-8 m after a second, is not due to its speed.
    #[test]
    fn overlaps_of_slow_bodies_are_not_due_to_speed() {
        let mut bodies = grains(2);
        for (speed, sunk) in [(1e-9, 1), (2e-8, 0)] {
            bodies.velocity[0] = Vector2::new(0.0, -speed);
            assert_eq!(late_and_sunk(&bodies), (1 - sunk, sunk), "{speed}");
        }
    }

    /// The limits of speed of a point of a system are those of a body. The speed of a surface is
    /// known at its origin only; elsewhere it may be a hundred times as large.
    #[test]
    fn contactors_of_systems_sink_too() {
        for (points, speed, sunk) in [
            (2, 0.0, 1),
            (2, 1e-9, 1),
            (2, 2e-8, 0),
            (0, 0.0, 1),
            (0, 1e-11, 1),
            (0, 1e-9, 0),
        ] {
            let mut bodies = grains(2 + points);
            bodies.carriers.resize(2 + points, None);
            for b in 1..2 + points {
                bodies.carriers[b] = Some(Carrier {
                    system: 0,
                    contactor: b as u32 - 1,
                    touches_itself: false,
                    grain: false,
                });
            }
            bodies.velocity[1] = Vector2::new(speed, 0.0);
            assert_eq!(
                late_and_sunk(&bodies),
                (1 - sunk, sunk),
                "{points}, {speed}"
            );
        }
    }

    /// A step that is examined twice counts once, and the warning names only the events that
    /// happened.
    #[test]
    fn unwatched_steps_are_counted_once() {
        let bodies = grains(1);
        let mut found = StepSizeDiagnostics::default();
        assert_eq!(found.warning(), None);
        for time in [0.0, 0.0, 1.0, 2.0, 2.0] {
            found.record_unwatched(time, || Occurrence::new(time, &bodies, &[0]));
        }
        assert_eq!(found.unwatched_steps, 3);
        let warning = found.warning().unwrap();
        assert!(
            warning.starts_with("in 3 steps a body moved farther"),
            "{warning}"
        );
        assert!(warning.ends_with("take a smaller time.step"), "{warning}");
        for other in ["restitution", "penetrated", "overlapping"] {
            assert!(!warning.contains(other), "{warning}");
        }
    }
}
