//! Imposed motions that no solution can follow: bodies driven into each other, or into bodies that
//! have nowhere to go.

use crate::bodies::Bodies;
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::step::{DrivenOverlap, Impossible, Simulation, StepReport};
use serde::{Deserialize, Serialize};

/// Ratio of residual velocities to those of the contacts from which impulses do not have their
/// effect: a thousand layers share the motion of a lid.
const NOT_OBEYED: f64 = 0.03;
/// Number of iterations below which a step that reached its limit does not show whether its motions
/// are possible.
const MIN_ITERATIONS: u32 = 100;
/// Smallest share of the work of the drives that goes into the residuals where drives squeeze what
/// does not yield.
const WASTED: f64 = 0.2;
/// Largest share of this work for which neither the residuals nor slip account there.
const UNEXPLAINED: f64 = 0.3;
/// Share of the work of all drives from which a body is named, and share of the largest impulse on
/// a body from which a contact transmits the squeezing.
const NAMED: f64 = 0.05;
/// Overlap of two bodies with imposed motion, over the length of the smaller one, that may be
/// rounding of their positions.
const ROUNDING: f64 = 1e-9;
/// Share of the displacement of two bodies by which they may approach by rounding.
const GRAZING: f64 = 1e-6;

/// Impossible motions over a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpossibleMotions {
    /// Number of steps in which imposed motions squeezed bodies without bound.
    pub squeezed_steps: u64,
    /// End of the first such step (s).
    pub squeezed_at: f64,
    /// Names of the squeezing bodies in the first of these steps.
    pub squeezing: Vec<String>,
    /// Number of steps in which two bodies with imposed motion moved into each other.
    pub overlapping_steps: u64,
    /// End of the first such step (s).
    pub overlapping_at: f64,
    /// The bodies with the largest overlap.
    pub overlapping: Vec<String>,
    /// Largest overlap of such bodies (m).
    pub overlap: f64,
}

impl ImpossibleMotions {
    /// Whether all motions were possible.
    pub fn is_empty(&self) -> bool {
        self.squeezed_steps == 0 && self.overlapping_steps == 0
    }

    /// Adds a step that ended at a time (s), with the names of bodies.
    pub fn add(&mut self, time: f64, name: impl Fn(u32) -> String, report: &StepReport) {
        let Some(step) = report.impossible.as_deref() else {
            return;
        };
        let name = |b: &u32| name(*b);
        if !step.squeezing.is_empty() {
            if self.squeezed_steps == 0 {
                self.squeezed_at = time;
                self.squeezing = step.squeezing.iter().map(name).collect();
            }
            self.squeezed_steps += 1;
        }
        if let Some(overlap) = step.overlap {
            if self.overlapping_steps == 0 {
                self.overlapping_at = time;
            }
            self.overlapping_steps += 1;
            if overlap.depth > self.overlap {
                self.overlap = overlap.depth;
                self.overlapping = overlap.bodies.iter().map(name).collect();
            }
        }
    }

    /// Returns the warning for the user; `None` if all motions were possible.
    pub fn warning(&self) -> Option<String> {
        let squeezed = (self.squeezed_steps > 0).then(|| {
            format!(
                "in {} steps, the first ends at t = {:.6e} s, {} squeezed bodies that can neither yield nor escape: no finite \
                 forces do that, and those of the run mean nothing; move a body by Force instead of a motion, use a compliant contact \
                 law (docs/compliant.md), or impose less displacement",
                self.squeezed_steps,
                self.squeezed_at,
                self.squeezing.join(" and ")
            )
        });
        let overlapping = (self.overlapping_steps > 0).then(|| {
            format!(
                "{}, whose motions are both imposed, moved into each other by up to {:.2e} m, from t = {:.6e} s on: a rigid contact \
                 between them carries nothing; move one of them by Force, use a compliant contact law (docs/compliant.md), or impose \
                 motions that keep them apart",
                self.overlapping.join(" and "),
                self.overlap,
                self.overlapping_at
            )
        });
        let warnings: Vec<String> = [squeezed, overlapping].into_iter().flatten().collect();
        (!warnings.is_empty()).then(|| warnings.join("; "))
    }
}

/// Work that a driven body does on other bodies by its imposed motion in a step (J).
struct Push {
    body: u32,
    work: f64,
}

/// Checks whether the imposed motions of the step were possible, given the impulses and moments on
/// the driven bodies.
pub(in crate::step) fn watch_imposed<S: Space>(
    s: &Simulation<S>,
    received: &[(S::Vector, S::Spin)],
    report: &mut StepReport,
) {
    let impossible = Impossible {
        squeezing: squeezing(s, received, report),
        overlap: driven_overlap(s),
    };
    if let Some(DrivenOverlap { bodies, depth }) = impossible.overlap {
        let length = bodies.map(|b| s.state.bodies.length[b as usize]);
        report.overlap = report.overlap.max(depth / length[0].min(length[1]));
    }
    if impossible != Impossible::default() {
        report.impossible = Some(Box::new(impossible));
    }
}

/// Returns the bodies that squeeze others without bound.
fn squeezing<S: Space>(
    s: &Simulation<S>,
    received: &[(S::Vector, S::Spin)],
    report: &StepReport,
) -> Vec<u32> {
    let solver = &report.solver;
    if solver.converged || !(solver.unbounded || solver.parts.velocity > NOT_OBEYED) {
        return Vec::new();
    }
    let pushes = pushes(s, received);
    let work: f64 = pushes.iter().map(|p| p.work).sum();
    if !solver.unbounded {
        let wasted = solver.parts.residual_energy;
        let left = (work - wasted - solver.parts.slip_energy).abs();
        let tried = solver.iterations >= MIN_ITERATIONS
            || solver.iterations < s.options.solver.max_iterations;
        if !(tried && work > 0.0 && wasted > WASTED * work && left < UNEXPLAINED * work) {
            return Vec::new();
        }
    }
    let works = |p: &&Push| p.work > NAMED * work && p.work > 0.0;
    let pressed = pressed_by(s, pushes.iter().filter(works).map(|p| p.body as usize));
    let holds = |p: &&Push| !works(p) && pressed[p.body as usize];
    let (first, then) = (pushes.iter().filter(works), pushes.iter().filter(holds));
    first.chain(then).map(|p| p.body).collect()
}

/// Returns the bodies on which some bodies press through chains of contacts. Far from an imposed
/// motion impulses may be small when the iterations end, so each link is compared with the one
/// before.
fn pressed_by<S: Space>(s: &Simulation<S>, those: impl Iterator<Item = usize>) -> Vec<bool> {
    let (bodies, contacts) = (&s.state.bodies, &s.state.network.contacts);
    let mut largest = vec![0.0f64; bodies.len()];
    for contact in contacts {
        for b in contact.bodies {
            largest[b as usize] = largest[b as usize].max(contact.impulse.norm());
        }
    }
    let mut pressed = vec![false; bodies.len()];
    let mut passes_on = vec![false; bodies.len()];
    for b in those {
        (pressed[b], passes_on[b]) = (true, true);
    }
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for contact in contacts {
            let [i, j] = contact.bodies.map(|b| b as usize);
            let size = contact.impulse.norm();
            for (from, to) in [(i, j), (j, i)] {
                if passes_on[from] && !pressed[to] && size > NAMED * largest[from] {
                    pressed[to] = true;
                    passes_on[to] = !bodies.immovable(to);
                    changed = true;
                }
            }
        }
    }
    pressed
}

/// Returns the work of driven bodies on others.
fn pushes<S: Space>(s: &Simulation<S>, received: &[(S::Vector, S::Spin)]) -> Vec<Push> {
    let bodies = &s.state.bodies;
    let of = |(driven, (impulse, moment)): (&crate::bodies::Driven, &(S::Vector, S::Spin))| {
        let b = driven.body as usize;
        let along = |k: usize| -impulse[k] * bodies.velocity[b][k];
        let imposed = (0..S::D).filter(|k| bodies.inverse_mass[b][*k] == 0.0);
        let turning = if bodies.inverse_inertia[b] == 0.0 {
            -moment.dot(&bodies.spin[b])
        } else {
            0.0
        };
        Push {
            body: driven.body,
            work: imposed.map(along).sum::<f64>() + turning,
        }
    };
    bodies.driven.iter().zip(received).map(of).collect()
}

/// Returns the deepest growing overlap of two bodies with imposed motions and rigid contacts.
/// (Springs and bonds between such bodies transmit forces.)
fn driven_overlap<S: Space>(s: &Simulation<S>) -> Option<DrivenOverlap> {
    let bodies = &s.state.bodies;
    let at_rest =
        |b: usize| bodies.velocity[b] == S::Vector::zero() && bodies.spin[b] == S::Spin::zero();
    let driven = bodies.driven.iter().map(|d| d.body as usize);
    let immovable: Vec<usize> = driven.filter(|b| bodies.immovable(*b)).collect();
    if immovable.len() < 2 || immovable.iter().all(|b| at_rest(*b)) {
        return None;
    }
    let mut stays = vec![false; bodies.len()];
    immovable.iter().for_each(|b| stays[*b] = true);
    let contacts = s.state.network.contacts.iter().enumerate();
    let between = contacts.filter(|(_, c)| c.bodies.iter().all(|b| stays[*b as usize]));
    let deep = between.filter_map(|(k, contact)| {
        let depth = depth_of_driven(s, k, contact, bodies)?;
        Some(DrivenOverlap {
            bodies: contact.bodies,
            depth,
        })
    });
    deep.reduce(|a, b| if b.depth > a.depth { b } else { a })
}

/// Returns the depth at the end of the step of a rigid contact that closes, where it exceeds
/// rounding (m).
fn depth_of_driven<S: Space>(
    s: &Simulation<S>,
    k: usize,
    contact: &Contact<S>,
    bodies: &Bodies<S>,
) -> Option<f64> {
    let law = &s.laws[contact.law as usize];
    let bonded = s.state.network.bond(contact).is_some_and(|b| b.intact());
    if law.compliant() || bonded {
        return None;
    }
    let closing = contact.normal.dot(s.workspace.solved.after.get(k)?);
    let scheme = &s.options.scheme;
    let depth = -contact.gap - scheme.theta * scheme.h * closing;
    let b = contact.bodies.map(|b| b as usize);
    let size = bodies.length[b[0]].min(bodies.length[b[1]]);
    let speed = |side: usize| {
        let turning = S::spin_velocity(&bodies.spin[b[side]], &contact.arms[side]);
        (bodies.velocity[b[side]] + turning).norm()
    };
    let travelled = scheme.h * (speed(0) + speed(1));
    // A step follows the chord of a curved path.
    let overlaps = depth > ROUNDING * size + travelled * travelled / size;
    (-closing * scheme.h > GRAZING * travelled && overlaps).then_some(depth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::Dof;
    use crate::geometry::space::Dim2;
    use nalgebra::{Vector1, Vector2};

    /// For a body driven along x and in rotation, and free along y, only the imposed motions do
    /// work, against the forces that the body receives.
    #[test]
    fn imposed_motions_push() {
        let mut s = Simulation::<Dim2>::of_disks(&[([0.0, 0.0], 0.5)]);
        s.drive(0, [Dof::Fixed, Dof::Free, Dof::Fixed]);
        s.state.bodies.velocity[0] = Vector2::new(2.0, 3.0);
        s.state.bodies.spin[0].x = 5.0;
        let pushes = pushes(&s, &[(Vector2::new(-7.0, 11.0), Vector1::new(-13.0))]);
        let pushes: Vec<(u32, f64)> = pushes.iter().map(|p| (p.body, p.work)).collect();
        assert_eq!(pushes, [(0, 7.0 * 2.0 + 13.0 * 5.0)]);
    }
}
