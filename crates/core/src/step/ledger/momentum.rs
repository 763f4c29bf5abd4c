//! Adds up the momentum of a step, and the deepest overlap in the same pass over its contacts.

use crate::geometry::space::{Space, VectorLike};
use crate::momentum::MomentumSum;
use crate::step::detection::projection;
use crate::step::motion::StepStart;
use crate::step::{Simulation, StepReport};
use crate::threads::{map_ranges, worth_dividing};

/// Number of bodies or contacts of a task.
const CHUNK: usize = 1024;
/// Approximate time to compute the momentum of a body, and to check whether a contact acts from
/// outside (ns).
const BODY: f64 = 10.0;
const CONTACT: f64 = 4.0;

/// Adds the momentum that the free rigid bodies gained in the step, at q_m: there an impulse
/// changes the angular momentum of a step by its moment, for any theta.
pub(in crate::step) fn close_momentum<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    report: &mut StepReport,
) {
    let (bodies, network, laws) = (&s.state.bodies, &s.state.network, s.laws.as_slice());
    let grain = bodies.grain_flags();
    let mut free = grain.clone();
    for (free, carrier) in free.iter_mut().zip(&bodies.carriers) {
        *free &= carrier.is_none();
    }
    let about = match s.state.momentum.about {
        Some(about) => S::Vector::from_slice(&about[..S::D]),
        None => mean_place::<S>(&bodies.position, &free),
    };
    let turns = !s.shapes.periodic.any();
    let h = s.options.scheme.h;
    let pushed = s.state.gravity * h;
    let parallel = s.options.solver.parallel;
    let divide = worth_dividing(parallel, bodies.len(), BODY);
    let of_bodies = map_ranges(divide, bodies.len(), CHUNK, |some| {
        let mut sum = MomentumSum::<S>::zero();
        for b in some.filter(|b| free[*b]) {
            let (m, v, w) = (bodies.mass[b], bodies.velocity[b], bodies.spin[b]);
            let gain = (v - start.velocity(b) - pushed) * m;
            sum.linear += gain;
            sum.sizes[0] += m * v.norm();
            if turns {
                let arm = bodies.position[b] - about;
                sum.angular += S::moment(&arm, &gain);
                sum.angular += bodies.angular_momentum(b, &(w - start.spin(b)));
                let own = bodies.angular_momentum(b, &w).norm();
                sum.sizes[1] += S::moment(&arm, &(v * m)).norm() + own;
            }
        }
        sum
    });
    // A contact less deep than the deepest share so far of the smallest body cannot be the deepest,
    // and is skipped.
    let smallest = bodies.length.iter().copied().fold(f64::INFINITY, f64::min);
    let divide = worth_dividing(parallel, network.contacts.len(), CONTACT);
    let of_contacts = map_ranges(divide, network.contacts.len(), CHUNK, |some| {
        let (mut sum, mut deepest) = (MomentumSum::<S>::zero(), 0.0f64);
        for contact in &network.contacts[some] {
            if -contact.gap > deepest * smallest {
                let overlap = projection::overlap(contact, (bodies, network, laws), &grain);
                deepest = deepest.max(overlap);
            }
            let sides = contact.bodies.map(|b| free[b as usize]);
            let side = match sides {
                [true, false] => 0,
                [false, true] => 1,
                _ => continue,
            };
            let sign = [1.0, -1.0][side];
            let impulse = contact.impulse * sign;
            sum.linear -= impulse;
            if turns {
                let at = bodies.position[contact.bodies[side] as usize] + contact.levers()[side];
                sum.angular -= S::moment(&(at - about), &impulse) + contact.moment * sign;
            }
        }
        (sum, deepest)
    });
    let mut step = MomentumSum::zero();
    of_bodies.iter().for_each(|part| step.add(part));
    for (part, deepest) in &of_contacts {
        step.add(part);
        report.overlap = report.overlap.max(*deepest);
    }
    s.state.momentum.about = Some(about.padded());
    s.state.momentum.add_step(&step);
}

/// The mean place of some bodies (m).
fn mean_place<S: Space>(places: &[S::Vector], which: &[bool]) -> S::Vector {
    let (mut sum, mut count) = (S::Vector::zero(), 0.0);
    for (place, _) in places.iter().zip(which).filter(|(_, which)| **which) {
        sum += *place;
        count += 1.0;
    }
    match count > 0.0 {
        true => sum * (1.0 / count),
        false => sum,
    }
}
