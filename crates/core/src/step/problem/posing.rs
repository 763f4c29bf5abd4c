//! The contact problem of a step is set up from bodies, contacts and laws, and solved, and its
//! velocities are assigned to the bodies.

use super::nonlinear_closing::shift_of_gap;
use super::{nonlinear_closing, systems, turning};
use crate::contact::ActionPoint;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::Mobility;
use crate::solve::local::solver::Method;
use crate::solve::{self, ContactForm};
use crate::step::{Simulation, StepError, StepReport};
use crate::threads::{fill, map_chunks_of_two, worth_dividing};

/// Number of bodies of a task.
const CHUNK: usize = 1024;
/// Approximate time to set the velocity of a body (ns).
const ADOPT: f64 = 5.0;

/// Solves the contacts with the current forms, and again while dynamical systems are linearised at
/// the velocities that they reach.
pub(super) fn solve_contacts<S: Space>(
    s: &mut Simulation<S>,
    free: &[(S::Vector, S::Spin)],
    options: &solve::SolverOptions,
    report: &mut StepReport,
) -> Result<(), StepError> {
    loop {
        // The solver uses the motion of bodies, laws that of their surfaces.
        let (forms, contacts) = (&s.workspace.forms, &s.state.network.contacts);
        let of_laws = s.workspace.surfaces.forms_of_bodies(forms, contacts);
        let of_laws = of_laws.map(|forms| std::mem::replace(&mut s.workspace.forms, forms));
        pose(s, free);
        let checked = check_method(s);
        if checked.is_ok() {
            let solved = solve::solve(
                &mut s.workspace.problem,
                &s.workspace.forms,
                &s.workspace.moments,
                options,
                Some(solve::Start {
                    velocity: &s.state.bodies.velocity,
                    spin: &s.state.bodies.spin,
                }),
                &mut s.state.auto_state,
            );
            report.solver.add(&solved);
        }
        if let Some(forms) = of_laws {
            s.workspace.forms = forms;
        }
        checked?;
        adopt_velocities(s)?;
        systems::adopt_system_velocities(s)?;
        if !systems::relinearise_systems(s)? {
            return Ok(());
        }
    }
}

/// Checks that the method supports the current forms; some requirements of laws appear only during
/// a step.
fn check_method<S: Space>(s: &Simulation<S>) -> Result<(), StepError> {
    let (method, operator) = (s.options.solver.method, s.workspace.problem.operator());
    let by_law = matches!(method, Method::Newton | Method::Interior);
    if !by_law && method.operator() <= operator {
        return Ok(());
    }
    let rotation = s
        .workspace
        .moments
        .iter()
        .any(|m| m.rolling > 0.0 || m.spinning > 0.0);
    let features = solve::Features {
        rotation,
        cohesion: s.workspace.forms.iter().any(|f| f.cohesion > 0.0),
        operator,
    };
    match solve::refusal(method, &features) {
        None => Ok(()),
        Some(reason) => Err(StepError::Method {
            step: s.state.steps + 1,
            method: method.name(),
            reason,
        }),
    }
}

/// Computes the geometric part of the forms.
pub(super) fn geometry_of_forms<S: Space>(
    s: &mut Simulation<S>,
    free: &[(S::Vector, S::Spin)],
    h: f64,
) {
    nonlinear_closing::find_nonlinear_closing(s, free, h);
    let nonlinear_closing = &s.workspace.nonlinear_closing;
    let mut forms = std::mem::take(&mut s.workspace.forms);
    let (network, correction) = (&s.state.network, s.options.correction);
    let count = network.contacts.len();
    fill(s.divides_contacts(), &mut forms, count, |k| {
        let contact = &network.contacts[k];
        ContactForm {
            bodies: contact.bodies,
            normal: contact.normal,
            arms: contact.levers(),
            central: contact.central,
            apart: contact.central && contact.action_point != ActionPoint::Surfaces,
            shift_n: shift_of_gap(network, contact, correction, h)
                - nonlinear_closing.get(k).map_or(0.0, |s| s / h),
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: 0.0,
            cohesion: 0.0,
            elastic: None,
            compliance: [0.0; 2],
            impulse: contact.impulse,
        }
    });
    s.workspace.forms = forms;
}

/// Sets up the solver's problem from bodies and contacts.
fn pose<S: Space>(s: &mut Simulation<S>, free: &[(S::Vector, S::Spin)]) {
    let (bodies, problem) = (&s.state.bodies, &mut s.workspace.problem);
    problem.clear();
    let controlled = bodies.driven.iter().filter(|d| !d.is_free());
    problem.set_controlled(controlled.map(|d| d.body));
    problem.push_bodies(free, s.options.solver.parallel, |b| {
        let mobility = Mobility {
            mass: bodies.inverse_mass[b],
            inertia: bodies.inverse_tensor(b),
        };
        (mobility, bodies.length[b])
    });
    if s.state.systems.is_empty() {
        problem.push_all(&s.workspace.forms, s.options.solver.parallel);
    } else {
        systems::pose_with_systems(s);
    }
    turning::pose_moments(s);
}

fn adopt_velocities<S: Space>(s: &mut Simulation<S>) -> Result<(), StepError> {
    let (bodies, problem) = (&mut s.state.bodies, &s.workspace.problem);
    let divide = worth_dividing(s.options.solver.parallel, bodies.len(), ADOPT);
    let both = (&mut bodies.velocity[..], &mut bodies.spin[..]);
    let wrong = map_chunks_of_two(divide, CHUNK, both, |first, velocity, spin| {
        for ((velocity, spin), b) in velocity.iter_mut().zip(spin).zip(first..) {
            let (v, w) = problem.velocity(b);
            if !(v.is_finite() && w.is_finite()) {
                return Some(b);
            }
            (*velocity, *spin) = (v, w);
        }
        None
    });
    match wrong.into_iter().flatten().next() {
        None => Ok(()),
        Some(b) => Err(StepError::NotFinite {
            step: s.state.steps + 1,
            time: s.state.time,
            body: bodies.id[b],
        }),
    }
}
