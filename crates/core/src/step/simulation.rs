//! The simulation: data of the case, options of the computation, and state.

use super::control::phases::Phase;
use super::fields::Fields;
use super::process::Process;
use super::workspace::Workspace;
use super::{Options, State, StepError};
use crate::bodies::Bodies;
use crate::contact::detect::{self, LawTable};
use crate::contact::{Contact, Network};
use crate::geometry::shape::Shapes;
use crate::geometry::space::Space;
use crate::heat::Heat;
use crate::laws::{ContactStep, Interface, LawError};
use crate::solve::{self, ContactForm};
use crate::threads::worth_dividing;
use std::sync::Arc;

/// Approximate time per contact of a pass over contacts (ns).
const EACH: f64 = 15.0;

/// A scene that is advanced in time: data of the case, options of the computation, and state.
#[derive(Debug)]
pub struct Simulation<S: Space> {
    /// Collision shapes. Worn surfaces follow their scars.
    pub shapes: Shapes<S>,
    /// Interface laws, with the parameters that phases have set, which the state keeps too.
    pub laws: Vec<Interface>,
    /// Interface law of each pair of materials.
    pub table: LawTable,
    /// Phases in the order in which they run; the schedule in the state has the index of the
    /// current one.
    pub phases: Vec<Phase>,
    /// Options of the computation; no step changes them.
    pub options: Options,
    /// Heat and current; `None` if not computed. See [`crate::process::heat::HeatFlow`].
    pub(crate) heat: Option<Arc<Heat>>,
    /// Data that steps change; a checkpoint contains all of them.
    pub state: State<S>,
    /// Output quantities of grains and contacts, by name.
    pub fields: Fields<S>,
    /// Features that the core adds to the stages of a step, see [`Simulation::add_feature`].
    pub(super) features: Vec<Box<dyn Process<S>>>,
    /// Processes that act at the named moments of a step, in this order; they save their own state,
    /// see [`Simulation::save_processes`].
    pub(super) processes: Vec<Box<dyn Process<S>>>,
    pub(crate) workspace: Workspace<S>,
}

impl<S: Space> Simulation<S> {
    /// Bytes per contact in addition to the solver's rows and the bond: the contact, its pair in
    /// the neighbour list, its form, its results, and its relative velocities before and after.
    pub const BYTES_A_CONTACT: usize = size_of::<Contact<S>>()
        + size_of::<(u32, u32)>()
        + size_of::<ContactForm<S>>()
        + size_of::<ContactStep<S>>()
        + 2 * size_of::<S::Vector>();

    /// Builds a scene at rest at time zero.
    pub fn new(
        bodies: Bodies<S>,
        shapes: Shapes<S>,
        laws: Vec<Interface>,
        table: LawTable,
        alert: f64,
        skin: f64,
    ) -> Self {
        let variables: Vec<usize> = laws.iter().map(Interface::variables).collect();
        let mut network = Network::new(alert, skin, &variables);
        for (memory, law) in network.memory.iter_mut().zip(&laws) {
            memory.rotates = law.rotates();
            memory.compliant = law.compliant();
        }
        network.fast = detect::fast_motion(&shapes, alert);
        Self {
            shapes,
            laws,
            table,
            phases: Vec::new(),
            options: Options::default(),
            heat: None,
            state: State::at_rest(bodies, network),
            fields: Fields::default(),
            features: Vec::new(),
            processes: Vec::new(),
            workspace: Workspace::default(),
        }
    }

    /// Returns heat and current, as the case gives them.
    pub fn heat(&self) -> Option<&Heat> {
        self.heat.as_deref()
    }

    /// Returns the options of the solver, with the tolerance that the current phase has set, if
    /// any.
    pub fn solver_in_force(&self) -> solve::SolverOptions {
        let given = self.options.solver;
        solve::SolverOptions {
            tolerance: self.state.control.tolerance.unwrap_or(given.tolerance),
            ..given
        }
    }

    /// Whether a pass over the contacts is divided among threads.
    pub(super) fn divides_contacts(&self) -> bool {
        let parallel = self.options.solver.parallel;
        worth_dividing(parallel, self.state.network.contacts.len(), EACH)
    }

    /// The error of a law in the current step.
    pub(super) fn law_error(&self, source: LawError) -> StepError {
        StepError::Law {
            step: self.state.steps + 1,
            time: self.state.time,
            source,
        }
    }
}

/// Scenes of unit tests in the plane. Without a law the contacts are those that the test adds.
#[cfg(test)]
impl Simulation<crate::geometry::space::Dim2> {
    /// Creates disks at rest by centre and radius (m), of 1 kg/m^3 and the material 0.
    pub(crate) fn of_disks(disks: &[([f64; 2], f64)]) -> Self {
        use crate::geometry::periodic::Periodic;
        use crate::geometry::shape::Ball;
        use nalgebra::Vector2;
        let mut bodies = Bodies::default();
        let ball = |([x, y], radius): &([f64; 2], f64)| Ball {
            body: bodies.add_ball(Vector2::new(*x, *y), *radius, 1.0),
            radius: *radius,
            offset: Vector2::zeros(),
            material: 0,
            area: Vector2::zeros(),
        };
        let shapes = Shapes {
            balls: disks.iter().map(ball).collect(),
            pieces: Vec::new(),
            surfaces: Vec::new(),
            periodic: Periodic { period: [None; 3] },
        };
        Self::new(bodies, shapes, Vec::new(), LawTable::new(1), 1e-3, 1e-3)
    }

    /// Returns a scene of these bodies and shapes, which touch by a law.
    pub(crate) fn with_law(self, law: Interface) -> Self {
        let mut table = LawTable::new(1);
        table.set(0, 0, 0);
        Self::new(self.state.bodies, self.shapes, vec![law], table, 1e-3, 1e-3)
    }

    /// Drives a body with these drives of x, y and the rotation.
    pub(crate) fn drive(&mut self, body: u32, dofs: [crate::bodies::Dof; 3]) {
        let name = format!("body {body}");
        let dofs = dofs.to_vec();
        (self.state.bodies).drive(crate::bodies::Driven { name, body, dofs });
        let driven = self.state.bodies.driven.len();
        self.state.received.resize(driven, Default::default());
        self.state.started = self.state.bodies.motion_of_driven();
    }

    /// Adds a fixed body that carries a surface at the origin, of the material 0; returns its
    /// index.
    pub(crate) fn add_surface(&mut self, shape: crate::geometry::polyline::Polyline) -> u32 {
        use crate::bodies::Dof;
        let zero = nalgebra::Vector2::zeros();
        let body = self.state.bodies.add(zero, 1.0, 1.0, 1.0);
        self.drive(body, [Dof::Fixed, Dof::Fixed, Dof::Fixed]);
        self.shapes.surfaces.push(crate::geometry::shape::Carried {
            body,
            offset: zero,
            shape: Box::new(shape),
            material: 0,
        });
        body
    }
}
