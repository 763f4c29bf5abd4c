//! The contact problem of a step: set up from bodies, contacts and laws, solved, and its velocities taken over.

use super::coupling::{Coupling, Progress};
use super::motion::StepStart;
use super::{Simulation, StepError, StepReport};
use crate::contact::{Acts, Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::LawError;
use crate::laws::columns::StepInfo;
use crate::solve::form::Mobility;
use crate::solve::local::solver::Method;
use crate::solve::{self, ContactForm};
use crate::threads::{fill, map_chunks_of_two, pays};
use std::time::Instant;

/// Bodies of a task.
const CHUNK: usize = 1024;
/// About what it takes to adopt the velocity of a body (ns).
const ADOPT: f64 = 5.0;

impl<S: Space> Simulation<S> {
    /// Prepares and solves the step: once with explicit coupling and with damage predicted at its middle, otherwise until the
    /// damage used in the impulses is the one that the resulting openings give.
    pub(super) fn couple(
        &mut self,
        start: &StepStart<S>,
        free: &[(S::Vector, S::Spin)],
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let mut coupling = Progress::new(&self.options.coupling);
        let options = self.solver_in_force();
        self.workspace.solved.predicted = self.options.coupling == Coupling::Midpoint;
        let clock = Instant::now();
        let evaluator = &mut self.workspace.evaluator;
        evaluator.select(&self.laws, &self.state.network);
        report.timing.laws += clock.elapsed();
        loop {
            let clock = Instant::now();
            let prepared = self.workspace.evaluator.prepare(
                &self.laws,
                &mut self.state.law_history,
                &mut self.state.network,
                &self.workspace.solved.before,
                info,
                self.workspace.solved.predicted,
                &mut self.workspace.forms,
                &mut self.workspace.springs,
                &mut self.workspace.moments,
            );
            prepared.map_err(|e| self.law_error(e))?;
            self.find_turned_systems();
            report.timing.laws += clock.elapsed();

            self.solve_in_agreement(start, free, &options, info, report)?;
            let Coupling::Implicit { .. } = self.options.coupling else {
                return Ok(());
            };
            let clock = Instant::now();
            let change = self.workspace.evaluator.trial_damage(
                &self.laws,
                &mut self.state.law_history,
                &mut self.state.network,
                &self.workspace.solved.step(info),
            );
            let change = change.map_err(|e| self.law_error(e))?;
            report.timing.laws += clock.elapsed();
            if coupling.ends(change) {
                report.coupling = coupling.report();
                return Ok(());
            }
            self.workspace
                .evaluator
                .adopt_trial_damage(&mut self.state.network);
            for (form, contact_step) in self
                .workspace
                .forms
                .iter_mut()
                .zip(&self.workspace.solved.contact_steps)
            {
                form.impulse = contact_step.solution.impulse;
            }
        }
    }

    /// Solves the contacts with the current forms, and again while dynamical systems linearise anew at the velocities that they
    /// reach.
    pub(super) fn solve_contacts(
        &mut self,
        free: &[(S::Vector, S::Spin)],
        options: &solve::Options,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        loop {
            // The solver knows the motion of bodies, laws that of their surfaces.
            let of_laws = self.forms_of_bodies();
            let of_laws = of_laws.map(|forms| std::mem::replace(&mut self.workspace.forms, forms));
            self.pose(free);
            let checked = self.check_method();
            if checked.is_ok() {
                let solved = solve::solve(
                    &mut self.workspace.problem,
                    &self.workspace.forms,
                    &self.workspace.moments,
                    options,
                    &mut self.state.auto_state,
                );
                report.solver.add(&solved);
            }
            if let Some(forms) = of_laws {
                self.workspace.forms = forms;
            }
            checked?;
            self.adopt_velocities()?;
            self.adopt_system_velocities()?;
            if !self.relinearise_systems()? {
                return Ok(());
            }
        }
    }

    /// Checks that the method supports the current forms; some requirements of laws appear only during a
    /// step.
    fn check_method(&self) -> Result<(), StepError> {
        let (method, operator) = (
            self.options.solver.method,
            self.workspace.problem.operator(),
        );
        let by_law = matches!(method, Method::Newton | Method::Interior);
        if !by_law && method.operator() <= operator {
            return Ok(());
        }
        let rotation = self
            .workspace
            .moments
            .iter()
            .any(|m| m.rolling > 0.0 || m.spinning > 0.0);
        let features = solve::Features {
            rotation,
            cohesion: self.workspace.forms.iter().any(|f| f.cohesion > 0.0),
            operator,
        };
        match solve::refusal(method, &features) {
            None => Ok(()),
            Some(reason) => Err(StepError::Method {
                step: self.state.steps + 1,
                method: method.name(),
                reason,
            }),
        }
    }

    /// The problem of the last step solved, in the form of the field's collection; none where a bond,
    /// cohesion or friction against rotation was at work, which that form does not hold.
    pub fn local_problem(&self) -> Option<solve::local::LocalProblem> {
        let of_bodies = self.forms_of_bodies();
        solve::choose::coulomb(
            &self.workspace.problem,
            of_bodies.as_ref().unwrap_or(&self.workspace.forms),
            &self.workspace.moments,
        )
    }

    pub(super) fn law_error(&self, source: LawError) -> StepError {
        StepError::Law {
            step: self.state.steps + 1,
            time: self.state.time,
            source,
        }
    }

    /// Computes the geometric part of the forms.
    pub(super) fn geometry_of_forms(&mut self, free: &[(S::Vector, S::Spin)], h: f64) {
        self.find_swerves(free, h);
        let swerves = &self.workspace.swerves;
        let mut forms = std::mem::take(&mut self.workspace.forms);
        let (network, correction) = (&self.state.network, self.options.correction);
        let count = network.contacts.len();
        fill(self.divides_contacts(), &mut forms, count, |k| {
            let contact = &network.contacts[k];
            ContactForm {
                bodies: contact.bodies,
                normal: contact.normal,
                arms: contact.levers(),
                central: contact.central,
                apart: contact.central && contact.acts != Acts::Surfaces,
                shift_n: shift_of_gap(network, contact, correction, h)
                    - swerves.get(k).map_or(0.0, |s| s / h),
                shift_t: S::Tangent::zero(),
                friction: 0.0,
                tension: 0.0,
                cohesion: 0.0,
                elastic: None,
                compliance: [0.0; 2],
                impulse: contact.impulse,
            }
        });
        self.workspace.forms = forms;
    }

    /// Sets up the solver's problem from bodies and contacts.
    fn pose(&mut self, free: &[(S::Vector, S::Spin)]) {
        let (bodies, problem) = (&self.state.bodies, &mut self.workspace.problem);
        problem.clear();
        let controlled = bodies.driven.iter().filter(|d| !d.is_free());
        problem.set_controlled(controlled.map(|d| d.body));
        problem.push_bodies(free, self.options.solver.parallel, |b| {
            let mobility = Mobility {
                mass: bodies.inverse_mass[b],
                inertia: bodies.inverse_tensor(b),
            };
            (mobility, bodies.length[b])
        });
        if self.state.systems.is_empty() {
            problem.push_all(&self.workspace.forms, self.options.solver.parallel);
        } else {
            self.pose_with_systems();
        }
        self.pose_moments();
    }

    fn adopt_velocities(&mut self) -> Result<(), StepError> {
        let (bodies, problem) = (&mut self.state.bodies, &self.workspace.problem);
        let divide = pays(self.options.solver.parallel, bodies.len(), ADOPT);
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
                step: self.state.steps + 1,
                time: self.state.time,
                body: bodies.id[b],
            }),
        }
    }
}

/// The velocity at which a step may close the gap of a contact; for a penetration, the (negative) velocity at which the correction
/// removes its share (m/s).
pub(super) fn shift_of_gap<S: Space>(
    network: &Network<S>,
    contact: &Contact<S>,
    correction: f64,
    h: f64,
) -> f64 {
    let gap = network.open_gap(contact);
    if gap > 0.0 {
        gap / h
    } else {
        correction * gap / h
    }
}
