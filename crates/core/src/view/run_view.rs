//! Reading a simulation.

use super::bodies_view::BodiesView;
use super::contacts_view::ContactsView;
use super::fields::{self, FieldInfo, FieldValues, GrainFields};
use super::memory::MemoryUse;
use super::shapes_view::ShapesView;
use crate::contact::detect::LawTable;
use crate::energy::Energy;
use crate::geometry::periodic::Periodic;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::{Heat, HeatState};
use crate::laws::Interface;
use crate::momentum::Momentum;
use crate::process::cycle::{Drive, SlidingBody};
use crate::process::expansion::ThermalExpansion;
use crate::process::jump::{JumpSummary, Jumps};
use crate::solve;
use crate::step::control::{Begun, GravityDrive, StepBounds};
use crate::step::fields::GrainPart;
use crate::step::{Options, RepeatError, Simulation};
use std::any::{Any, TypeId};
use std::fmt::Debug;

/// A simulation for reading, between two steps. The [module](super) describes the third components.
///
/// Its bodies, shapes and contacts have traits of their own, whose methods a `&dyn RunView` has
/// too.
pub trait RunView: BodiesView + ShapesView + ContactsView + Debug {
    /// Number of dimensions, 2 or 3.
    fn dimension(&self) -> usize;
    /// Time at the end of the last step (s).
    fn time(&self) -> f64;
    /// Steps completed.
    fn steps(&self) -> u64;
    /// How it is computed.
    fn options(&self) -> &Options;
    /// The options of the solver, with the tolerance that the current phase has set, if any.
    fn solver_in_force(&self) -> solve::Options;
    /// The tolerance of the solver that the current phase has set, if any.
    fn phase_tolerance(&self) -> Option<f64>;
    /// Whether steps can be repeated.
    ///
    /// # Errors
    /// Which process does not permit it.
    fn repeatable(&self) -> Result<(), RepeatError>;
    /// What bounds the next step; see [`Simulation::step_bounds`].
    fn step_bounds(&self) -> StepBounds;
    /// The largest displacement of a point of a body in a step at the current velocities, over the
    /// length of the smallest grain; see [`Simulation::largest_displacement`].
    fn largest_displacement(&self) -> f64;
    /// Whether the next step is the first of a phase.
    fn phase_begins(&self) -> bool;
    /// Number of the current phase, from 1; 0 before the first step and without phases.
    fn phase(&self) -> usize;
    /// Whether phases or processes end the run before its time.
    fn finished(&self) -> bool;
    /// Names of the phases of the case, in order.
    fn phase_names(&self) -> Vec<&str>;
    /// The phases begun so far, in order.
    fn begun(&self) -> &[Begun];
    /// Acceleration of gravity (m/s^2).
    fn gravity(&self) -> [f64; 3];
    /// How gravity changes in time.
    fn gravity_drive(&self) -> Option<&GravityDrive>;
    /// Bodies that are removed at a time: index among the driven bodies, and time (s).
    fn gates(&self) -> &[(usize, f64)];
    /// Lengths of the periodic cell.
    fn periodic(&self) -> &Periodic;
    /// Distance within which a pair forms a contact (m).
    fn alert(&self) -> f64;
    /// Interface laws.
    fn laws(&self) -> &[Interface];
    /// Interface law of each pair of materials.
    fn table(&self) -> &LawTable;

    /// What grains and contacts take in memory.
    fn memory_use(&self) -> MemoryUse;
    /// The energy ledger (J; J/m in 2D).
    fn energies(&self) -> &Energy;
    /// Work of projections on driven bodies against imposed forces (J; J/m in 2D).
    fn projection_work(&self) -> f64;
    /// The ledger of momentum (N s, N m s; in 2D per m).
    fn momentum(&self) -> &Momentum;
    /// Heat and current, as the case gives them.
    fn heat(&self) -> Option<&Heat>;
    /// Temperatures and the account of heat.
    fn heat_state(&self) -> Option<&HeatState>;
    /// Temperature of a body (K): the mean over the nodes of its surface, or by capacity over its
    /// mesh; `None` where it has none or no heat is computed.
    fn temperature(&self, body: usize) -> Option<f64>;
    /// Coefficient of thermal expansion of each body (1/K), zero where it keeps its size, and the
    /// dynamical systems that expand; `None` where no body expands.
    fn expanding(&self) -> Option<(&[f64], Vec<usize>)>;

    /// What the drive of a rubbed body did in the last step, and the normal force of its contacts,
    /// the mean over the step (N; N/m in 2D), positive in compression.
    fn rubbing(&self, body: &SlidingBody) -> (Drive, f64);
    /// What the jumps over cycles came to so far; `None` where the case has none.
    fn jump_summary(&self) -> Option<JumpSummary>;
    /// The process of a type, the first where there are several; see
    /// [`process`](trait.RunView.html#method.process) of `dyn RunView`.
    fn process_of_type(&self, of: TypeId) -> Option<&dyn Any>;

    /// Centres of the parts of grains and first bodies that carry fields (m).
    fn grain_centres(&self) -> Vec<[f64; 3]>;
    /// Centres of the parts, moved into the periodic cell (m).
    fn grain_points(&self) -> Vec<[f64; 3]>;
    /// The fields of the parts of grains and first bodies, in the order in which they are written.
    fn grain_fields(&self, with: GrainFields) -> Vec<FieldInfo>;
    /// Their values, in the same order.
    fn grain_values(&self, with: GrainFields) -> Vec<FieldValues>;
    /// The values of one of them.
    fn grain_field(&self, name: &str) -> Option<FieldValues>;
    /// The fields of contacts, in the order in which they are written.
    fn contact_fields(&self) -> Vec<FieldInfo>;
    /// Their values at all contacts, or at those that [count](ContactView::counts), in the same
    /// order.
    fn contact_values(&self, counted: bool) -> Vec<FieldValues>;
    /// The values of one of them.
    fn contact_field(&self, name: &str, counted: bool) -> Option<FieldValues>;
}

impl dyn RunView + '_ {
    /// The process of a type, the first where there are several.
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
    fn solver_in_force(&self) -> solve::Options {
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
    fn begun(&self) -> &[Begun] {
        self.state.control.begun()
    }
    fn gravity(&self) -> [f64; 3] {
        self.state.gravity.padded()
    }
    fn gravity_drive(&self) -> Option<&GravityDrive> {
        self.state.control.gravity_drive.as_ref()
    }
    fn gates(&self) -> &[(usize, f64)] {
        &self.state.control.gates
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

    fn rubbing(&self, body: &SlidingBody) -> (Drive, f64) {
        (body.drive(self), body.normal_force(self))
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
