//! Reading a simulation.

use super::bodies_view::BodiesView;
use super::contacts_view::ContactsView;
use super::fields::{self, FieldInfo, FieldValues, GrainFields};
use super::memory::MemoryUse;
use super::part_corners;
use super::shapes_view::ShapesView;
use crate::contact::detect::LawTable;
use crate::energy::Energy;
use crate::geometry::periodic::Periodic;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::{Heat, HeatState};
use crate::laws::Interface;
use crate::momentum::Momentum;
use crate::process::expansion::ThermalExpansion;
use crate::process::jump::{JumpSummary, Jumps};
use crate::process::sliding::{self, SlidingBody, SlidingStep};
use crate::solve;
use crate::step::control::{GravityDrive, StartedPhase, StepBounds};
use crate::step::fields::GrainPart;
use crate::step::{Options, RepeatError, Simulation};
use std::any::{Any, TypeId};
use std::fmt::Debug;

/// A simulation for reading, between two steps. The [module](super) describes the use of three
/// components in 2D.
///
/// Bodies, shapes and contacts have separate traits, whose methods a `&dyn RunView` has too.
pub trait RunView: BodiesView + ShapesView + ContactsView + Debug {
    /// Number of dimensions, 2 or 3.
    fn dimension(&self) -> usize;
    /// Returns the time at the end of the last step (s).
    fn time(&self) -> f64;
    /// Returns the number of completed steps.
    fn steps(&self) -> u64;
    /// Returns the options of the computation.
    fn options(&self) -> &Options;
    /// Returns the options of the solver, with the tolerance that the current phase has set, if
    /// any.
    fn solver_in_force(&self) -> solve::SolverOptions;
    /// Returns the tolerance of the solver that the current phase has set, if any.
    fn phase_tolerance(&self) -> Option<f64>;
    /// Whether steps can be repeated.
    ///
    /// # Errors
    /// Returns an error with the first process that does not permit repetition.
    fn repeatable(&self) -> Result<(), RepeatError>;
    /// Returns the bounds of the next step; see [`Simulation::step_bounds`].
    fn step_bounds(&self) -> StepBounds;
    /// Returns the largest displacement of a point of a body in a step at the current velocities,
    /// over the length of the smallest grain; see [`Simulation::largest_displacement`].
    fn largest_displacement(&self) -> f64;
    /// Whether the next step is the first of a phase.
    fn phase_begins(&self) -> bool;
    /// Returns the number of the current phase, from 1; 0 before the first step and without phases.
    fn phase(&self) -> usize;
    /// Returns whether phases or processes end the run before its end time.
    fn finished(&self) -> bool;
    /// Returns the names of the phases of the case, in order.
    fn phase_names(&self) -> Vec<&str>;
    /// Returns the phases begun so far, in order.
    fn begun(&self) -> &[StartedPhase];
    /// Returns the acceleration of gravity (m/s^2).
    fn gravity(&self) -> [f64; 3];
    /// Returns the time dependence of gravity.
    fn gravity_drive(&self) -> Option<&GravityDrive>;
    /// Returns the bodies that are removed at a time: index among the driven bodies, and time (s).
    fn removals(&self) -> &[(usize, f64)];
    /// Returns the lengths of the periodic cell.
    fn periodic(&self) -> &Periodic;
    /// Returns the distance within which a pair forms a contact (m).
    fn alert(&self) -> f64;
    /// Returns the interface laws.
    fn laws(&self) -> &[Interface];
    /// Returns the interface law of each pair of materials.
    fn table(&self) -> &LawTable;

    /// Returns the memory of a grain and of a contact.
    fn memory_use(&self) -> MemoryUse;
    /// The energy ledger (J; J/m in 2D).
    fn energies(&self) -> &Energy;
    /// Returns the work of projections on driven bodies against imposed forces (J; J/m in 2D).
    fn projection_work(&self) -> f64;
    /// The ledger of momentum (N s, N m s; in 2D per m).
    fn momentum(&self) -> &Momentum;
    /// Returns heat and current, as the case gives them.
    fn heat(&self) -> Option<&Heat>;
    /// Returns the temperatures and the account of heat.
    fn heat_state(&self) -> Option<&HeatState>;
    /// Returns the temperature of a body (K): the mean over the nodes of its surface, or over its
    /// mesh weighted by heat capacity; `None` where it has none or no heat is computed.
    fn temperature(&self, body: usize) -> Option<f64>;
    /// Returns the coefficient of thermal expansion of each body (1/K), zero where it keeps its
    /// size, and the dynamical systems that expand; `None` where no body expands.
    fn expanding(&self) -> Option<(&[f64], Vec<usize>)>;

    /// Returns force and sliding distance of the drive of a rubbed body in the last step, and the
    /// mean normal force of its contacts over the step (N; N/m in 2D), positive in compression.
    fn rubbing(&self, body: &SlidingBody) -> (SlidingStep, f64);
    /// Returns the normal force, along this axis, times the distance of sliding of every first body
    /// over the last step (J; J/m in 2D), with its name.
    fn first_body_paths(&self, normal: usize) -> Vec<(&str, f64)>;
    /// Returns the summary of the cycle jumps so far; `None` where the case has none.
    fn jump_summary(&self) -> Option<JumpSummary>;
    /// Returns the process of a type, the first where there are several; see
    /// [`process`](trait.RunView.html#method.process) of `dyn RunView`.
    fn process_of_type(&self, of: TypeId) -> Option<&dyn Any>;

    /// Returns the centres of the parts of grains and first bodies that have fields (m).
    fn grain_centres(&self) -> Vec<[f64; 3]>;
    /// Returns the centres of these parts, moved into the periodic cell (m).
    fn grain_points(&self) -> Vec<[f64; 3]>;
    /// Returns the corners of each of these parts (m), as many at all times, in the periodic cell:
    /// in the plane of a polygon, anticlockwise, which stands for a disk too; in space of a convex
    /// piece, and the centre of anything else.
    fn grain_corners(&self) -> Vec<Vec<[f64; 3]>>;
    /// Returns the fields of the parts of grains and first bodies, in the order in which they are
    /// written.
    fn grain_fields(&self, with: GrainFields) -> Vec<FieldInfo>;
    /// Returns the values of these fields, in the same order.
    fn grain_values(&self, with: GrainFields) -> Vec<FieldValues>;
    /// Returns the values of one of these fields.
    fn grain_field(&self, name: &str) -> Option<FieldValues>;
    /// Returns the fields of contacts, in the order in which they are written.
    fn contact_fields(&self) -> Vec<FieldInfo>;
    /// Returns the values of these fields at all contacts, or at those that
    /// [count](ContactView::counts), in the same order.
    fn contact_values(&self, counted: bool) -> Vec<FieldValues>;
    /// Returns the values of one of these fields.
    fn contact_field(&self, name: &str, counted: bool) -> Option<FieldValues>;
}

impl dyn RunView + '_ {
    /// Returns the process of a type, the first where there are several.
    pub fn process<P: Any>(&self) -> Option<&P> {
        self.process_of_type(TypeId::of::<P>())?.downcast_ref()
    }
}

impl<S: Space> RunView for Simulation<S> {
    fn dimension(&self) -> usize {
        S::D
    }
    fn time(&self) -> f64 {
        self.state.time
    }
    fn steps(&self) -> u64 {
        self.state.steps
    }
    fn options(&self) -> &Options {
        &self.options
    }
    fn solver_in_force(&self) -> solve::SolverOptions {
        self.solver_in_force()
    }
    fn phase_tolerance(&self) -> Option<f64> {
        self.state.control.tolerance
    }
    fn repeatable(&self) -> Result<(), RepeatError> {
        self.repeatable()
    }
    fn step_bounds(&self) -> StepBounds {
        self.step_bounds()
    }
    fn largest_displacement(&self) -> f64 {
        self.largest_displacement()
    }
    fn phase_begins(&self) -> bool {
        self.phase_begins()
    }
    fn phase(&self) -> usize {
        self.state.control.phase()
    }
    fn finished(&self) -> bool {
        self.finished()
    }
    fn phase_names(&self) -> Vec<&str> {
        self.phases
            .iter()
            .map(|phase| phase.name.as_str())
            .collect()
    }
    fn begun(&self) -> &[StartedPhase] {
        self.state.control.begun()
    }
    fn gravity(&self) -> [f64; 3] {
        self.state.gravity.padded()
    }
    fn gravity_drive(&self) -> Option<&GravityDrive> {
        self.state.control.gravity_drive.as_ref()
    }
    fn removals(&self) -> &[(usize, f64)] {
        &self.state.control.removals
    }
    fn periodic(&self) -> &Periodic {
        &self.shapes.periodic
    }
    fn alert(&self) -> f64 {
        self.state.network.alert
    }
    fn laws(&self) -> &[Interface] {
        &self.laws
    }
    fn table(&self) -> &LawTable {
        &self.table
    }

    fn memory_use(&self) -> MemoryUse {
        MemoryUse::of::<S>()
    }
    fn energies(&self) -> &Energy {
        &self.state.energy
    }
    fn projection_work(&self) -> f64 {
        self.state.projection_work
    }
    fn momentum(&self) -> &Momentum {
        &self.state.momentum
    }
    fn heat(&self) -> Option<&Heat> {
        self.heat()
    }
    fn heat_state(&self) -> Option<&HeatState> {
        self.state.heat.as_ref()
    }
    fn temperature(&self, body: usize) -> Option<f64> {
        self.temperature(body)
    }
    fn expanding(&self) -> Option<(&[f64], Vec<usize>)> {
        let expansion = ThermalExpansion::of(self)?;
        let systems = expansion.systems.iter().map(|e| e.system).collect();
        Some((&expansion.coefficient, systems))
    }

    fn rubbing(&self, body: &SlidingBody) -> (SlidingStep, f64) {
        (body.drive(self), body.normal_force(self))
    }
    fn first_body_paths(&self, normal: usize) -> Vec<(&str, f64)> {
        sliding::first_body_paths(self, normal)
    }
    fn jump_summary(&self) -> Option<JumpSummary> {
        Some(self.process::<Jumps>()?.outcome(self))
    }
    fn process_of_type(&self, of: TypeId) -> Option<&dyn Any> {
        self.processes_as_any()
            .find(|process| (*process).type_id() == of)
    }

    fn grain_centres(&self) -> Vec<[f64; 3]> {
        GrainPart::all(self)
            .map(|part| part.centre.padded())
            .collect()
    }
    fn grain_points(&self) -> Vec<[f64; 3]> {
        let wrapped = |part: GrainPart<S>| self.shapes.periodic.wrapped(part.centre).padded();
        GrainPart::all(self).map(wrapped).collect()
    }
    fn grain_corners(&self) -> Vec<Vec<[f64; 3]>> {
        part_corners::of(self)
    }
    fn grain_fields(&self, with: GrainFields) -> Vec<FieldInfo> {
        fields::grain_fields(self, with)
    }
    fn grain_values(&self, with: GrainFields) -> Vec<FieldValues> {
        fields::grain_values(self, with)
    }
    fn grain_field(&self, name: &str) -> Option<FieldValues> {
        fields::grain_field(self, name)
    }
    fn contact_fields(&self) -> Vec<FieldInfo> {
        fields::contact_fields(self)
    }
    fn contact_values(&self, counted: bool) -> Vec<FieldValues> {
        fields::contact_values(self, counted)
    }
    fn contact_field(&self, name: &str, counted: bool) -> Option<FieldValues> {
        fields::contact_field(self, name, counted)
    }
}
