//! The time step, compiled once for each dimension, so that dependent crates do not compile the solver
//! again.

use super::fields::Fields;
use super::{
    ContactForces, RepeatError, Saved, Simulation, StepChange, StepError, StepReport, change,
    repeat,
};
use crate::contact::detect::detect;
use crate::geometry::space::{Dim2, Dim3, Space};
use crate::solve::{AutoState, ContactForm, MomentForm, Options, Problem, Report, solve};

/// A simulation whose dimension is known: other crates compile what they do with it once for each of the two.
#[derive(Debug)]
pub enum InDimension<'a> {
    /// Two dimensions.
    Dim2(&'a Simulation<Dim2>),
    /// Three dimensions.
    Dim3(&'a Simulation<Dim3>),
}

/// A dimension for which this crate compiles the time step.
pub trait Steps: Space {
    /// Performs one step of a scene; see [`Simulation::step`].
    ///
    /// # Errors
    /// As [`Simulation::step`].
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError>;
    /// Detects the contacts at the current positions, without an alert distance.
    fn detect(simulation: &mut Simulation<Self>);
    /// Solves a contact problem, as a step does; see [`crate::solve::solve`].
    fn solve(
        problem: &mut Problem<Self>,
        forms: &[ContactForm<Self>],
        moments: &[MomentForm<Self>],
        options: &Options,
        auto_state: &mut AutoState,
    ) -> Report;
    /// The fields that every simulation has.
    fn fields() -> Fields<Self>;
    /// The simulation, of known dimension.
    fn in_dimension(simulation: &Simulation<Self>) -> InDimension<'_>;
    /// Copies all that steps may change; see [`Simulation::repeat`].
    ///
    /// # Errors
    /// Steps cannot be repeated.
    fn save(simulation: &Simulation<Self>) -> Result<Saved<Self>, RepeatError>;
    /// The forces of the contacts; see [`Simulation::contact_forces`].
    fn contact_forces(simulation: &Simulation<Self>) -> ContactForces<Self>;
    /// Largest displacement and change of forces; see [`Simulation::change_since`].
    fn change_since(simulation: &Simulation<Self>, before: &ContactForces<Self>) -> StepChange;
    /// See [`Simulation::largest_displacement`].
    fn largest_displacement(simulation: &Simulation<Self>) -> f64;
}

impl Steps for Dim2 {
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError> {
        simulation.one_step()
    }
    fn detect(simulation: &mut Simulation<Self>) {
        touching(simulation);
    }
    fn solve(
        problem: &mut Problem<Self>,
        forms: &[ContactForm<Self>],
        moments: &[MomentForm<Self>],
        options: &Options,
        auto_state: &mut AutoState,
    ) -> Report {
        solve(problem, forms, moments, options, auto_state)
    }
    fn fields() -> Fields<Self> {
        Fields::default()
    }
    fn in_dimension(simulation: &Simulation<Self>) -> InDimension<'_> {
        InDimension::Dim2(simulation)
    }
    fn save(simulation: &Simulation<Self>) -> Result<Saved<Self>, RepeatError> {
        repeat::save(simulation)
    }
    fn contact_forces(simulation: &Simulation<Self>) -> ContactForces<Self> {
        change::contact_forces(simulation)
    }
    fn change_since(simulation: &Simulation<Self>, before: &ContactForces<Self>) -> StepChange {
        change::change_since(simulation, before)
    }
    fn largest_displacement(simulation: &Simulation<Self>) -> f64 {
        change::largest_displacement(simulation)
    }
}

impl Steps for Dim3 {
    fn step(simulation: &mut Simulation<Self>) -> Result<StepReport, StepError> {
        simulation.one_step()
    }
    fn detect(simulation: &mut Simulation<Self>) {
        touching(simulation);
    }
    fn solve(
        problem: &mut Problem<Self>,
        forms: &[ContactForm<Self>],
        moments: &[MomentForm<Self>],
        options: &Options,
        auto_state: &mut AutoState,
    ) -> Report {
        solve(problem, forms, moments, options, auto_state)
    }
    fn fields() -> Fields<Self> {
        Fields::default()
    }
    fn in_dimension(simulation: &Simulation<Self>) -> InDimension<'_> {
        InDimension::Dim3(simulation)
    }
    fn save(simulation: &Simulation<Self>) -> Result<Saved<Self>, RepeatError> {
        repeat::save(simulation)
    }
    fn contact_forces(simulation: &Simulation<Self>) -> ContactForces<Self> {
        change::contact_forces(simulation)
    }
    fn change_since(simulation: &Simulation<Self>, before: &ContactForces<Self>) -> StepChange {
        change::change_since(simulation, before)
    }
    fn largest_displacement(simulation: &Simulation<Self>) -> f64 {
        change::largest_displacement(simulation)
    }
}

fn touching<S: Space>(s: &mut Simulation<S>) {
    let (network, bodies) = (&mut s.state.network, &s.state.bodies);
    detect(network, &s.shapes, bodies, &s.table, [0.0; 2], false);
}

impl<S: Steps> Simulation<S> {
    /// One step of h. Processes act at its named moments, see [`crate::process`]; those that are due between the last step and
    /// this one first, where [`Simulation::between_steps`] was not called.
    ///
    /// # Errors
    /// A law or a process failed, the method does not support what the laws require, or a velocity is not finite; the state is
    /// then that of the failed step, or of the end of the previous one if a process failed between the two. A surface was worn
    /// through in the previous step; the state is then that at its end.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        S::step(self)
    }
}
