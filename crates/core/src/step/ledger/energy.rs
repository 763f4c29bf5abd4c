//! Energies of a step.

use crate::geometry::space::{Space, VectorLike};
use crate::laws::{Interface, SpringForm};
use crate::step::control::watch_imposed;
use crate::step::motion::{BodyVelocity, StepStart, end_systems};
use crate::step::{Scheme, Simulation, StepReport};
use crate::threads::{map_chunks, worth_dividing};

/// Number of contacts of a task.
const CHUNK: usize = 1024;
/// Approximate time to check whether a contact belongs to a driven body (ns).
const RECEIVED: f64 = 5.0;

/// Adds the step to the energy ledger.
pub(in crate::step) fn close_energy<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    report: &mut StepReport,
) {
    let received = received(s);
    watch_imposed(s, &received, report);
    let totals = &report.totals;
    let Scheme { h, theta } = s.options.scheme;
    let mut work = start.work(
        &s.state.bodies,
        &received,
        &s.state.gravity,
        s.state.time,
        [h, theta],
        s.options.solver.parallel,
    );
    if s.state.steps == 0 {
        let springs = s.workspace.springs.iter().flatten();
        s.workspace.spring_energy = springs.map(SpringForm::initial_energy).sum();
        work.external += s.workspace.spring_energy;
    }
    let springs = spring_energy(s);
    work.scheme += totals.springs - (springs - s.workspace.spring_energy);
    work.expansion += s.workspace.surfaces.work;
    let (moving, stored) = end_systems(s, theta * h, &mut work);
    let (mut kinetic, mut elastic) = (
        s.state.bodies.sum_kinetic_energy(s.options.solver.parallel),
        s.state.network.bond_energy() + springs,
    );
    if !s.state.systems.is_empty() {
        (kinetic, elastic) = (kinetic + moving, elastic + stored);
    }
    s.state.energy.add_step(totals, &work, kinetic, elastic);
    s.state.received = received;
}

/// Returns the energy in the springs of compliant contacts (J).
pub(super) fn spring_energy<S: Space>(s: &Simulation<S>) -> f64 {
    if s.laws.iter().any(Interface::compliant) {
        let parallel = s.options.solver.parallel;
        s.state.network.sum_spring_energy(parallel)
    } else {
        0.0
    }
}

/// Returns the impulses and moments of contacts on the driven bodies, in their order (N s, N m s).
fn received<S: Space>(s: &Simulation<S>) -> Vec<BodyVelocity<S>> {
    let (driven, contacts) = (&s.state.bodies.driven, &s.state.network.contacts);
    let mut place = vec![u32::MAX; s.state.bodies.len()];
    for (driven, d) in driven.iter().zip(0..) {
        place[driven.body as usize] = d;
    }
    let divide = worth_dividing(s.options.solver.parallel, contacts.len(), RECEIVED);
    let parts = map_chunks(divide, contacts, CHUNK, |_, contacts| {
        let mut received = Vec::new();
        for contact in contacts {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let d = place[contact.bodies[side] as usize];
                if d != u32::MAX {
                    let impulse = contact.impulse * sign;
                    let moment =
                        S::moment(&contact.levers()[side], &impulse) + contact.moment * sign;
                    received.push((d, impulse, moment));
                }
            }
        }
        received
    });
    let mut received = vec![(S::Vector::zero(), S::Spin::zero()); driven.len()];
    for (d, impulse, moment) in parts.into_iter().flatten() {
        let all = &mut received[d as usize];
        all.0 += impulse;
        all.1 += moment;
    }
    received
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::network::{Contact, ContactGeometry, Key};
    use crate::geometry::space::Dim2;
    use nalgebra::{Vector1, Vector2};

    /// A driven candidate receives impulse and moment of its contact, a driven antagonist the
    /// opposite: r x p + M about its own centre. About a common point both cancel.
    #[test]
    fn driven_bodies_receive_the_moments_of_their_contacts() {
        let centres = [[0.0, 2.0], [1.0, -1.0]];
        let mut s = Simulation::of_disks(&centres.map(|at| (at, 0.5)));
        s.drive(1, Default::default());
        s.drive(0, Default::default());
        let place = Vector2::new(0.5, 0.25);
        let centres = centres.map(Vector2::from);
        let arms = centres.map(|c| place - c);
        let geometry = ContactGeometry {
            gap: 0.0,
            normal: Vector2::new(0.0, 1.0),
            arms,
            radius: 0.25,
        };
        let key = Key {
            candidate: 0,
            antagonist: 1,
            feature: 0,
        };
        let mut contact = Contact::<Dim2>::new(key, [0, 1], 0, geometry, 0.0);
        contact.impulse = Vector2::new(3.0, 5.0);
        contact.moment = Vector1::new(7.0);
        s.state.network.contacts = vec![contact.clone(), contact.clone()];
        let cross = |a: Vector2<f64>, b: Vector2<f64>| a.x * b.y - a.y * b.x;
        let [antagonist, candidate] = received(&s)[..] else {
            panic!("two driven bodies")
        };
        let p = contact.impulse;
        assert_eq!((candidate.0, antagonist.0), (2.0 * p, -2.0 * p));
        assert_eq!(candidate.1.x, 2.0 * (cross(arms[0], p) + 7.0));
        assert_eq!(antagonist.1.x, -2.0 * (cross(arms[1], p) + 7.0));
        let of = |(p, m): (Vector2<f64>, Vector1<f64>), at| cross(at, p) + m.x;
        assert_eq!(of(candidate, centres[0]) + of(antagonist, centres[1]), 0.0);
    }
}
