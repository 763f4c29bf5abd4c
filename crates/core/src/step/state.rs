//! State of a simulation between two steps: the content of a checkpoint.
//!
//! All of it is saved by its derived form: a new field is saved without further code. Data of the
//! case (shapes, laws, phases, options) are built again, and work arrays of a step (forms, columns,
//! the solver's problem and its colouring) depend only on this state. Two kinds of data of the case
//! depend on the state: worn surfaces on their scars, and parameters of laws on phases;
//! [`super::Simulation::restore`] updates them.

use super::control::schedule::Control;
use crate::bodies::{Bodies, Systems};
use crate::contact::Network;
use crate::energy::Energy;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::HeatState;
use crate::laws::LawHistory;
use crate::momentum::Momentum;
use crate::solve::AutoState;
use crate::wear::{Scar, WornThrough};
use serde::{Deserialize, Serialize};

/// State of a simulation between two steps; see [`super::Simulation::restore`].
///
/// ```
/// use fretwork_core::encoding::{EncodingError, decode, encode};
/// use fretwork_core::geometry::space::Dim2;
/// use fretwork_core::step::{Simulation, StepError};
///
/// /// Takes a step twice: `again` was built as `simulation` was.
/// fn twice(simulation: &mut Simulation<Dim2>, again: &mut Simulation<Dim2>) -> Result<(), Box<dyn std::error::Error>> {
///     let bytes = encode(&simulation.state)?;
///     assert!(again.restore(decode(&bytes)?), "the state of another scene");
///     simulation.step()?;
///     again.step()?;
///     assert_eq!(encode(&simulation.state)?, encode(&again.state)?);
///     Ok(())
/// }
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct State<S: Space> {
    /// Time at the end of the last step (s).
    pub time: f64,
    /// Rounding error of the sum of the steps in `time` (s).
    pub(super) time_excess: f64,
    /// Steps completed.
    pub steps: u64,
    /// Whether the processes have acted on the state since the last step, see
    /// [`super::Simulation::between_steps`].
    pub(super) settled: bool,
    /// Grains and first bodies.
    pub bodies: Bodies<S>,
    /// Deformable and other bodies that are more than rigid; see [`super::Simulation::add_system`].
    pub systems: Systems<S>,
    /// The contacts.
    pub network: Network<S>,
    /// State of the laws from earlier steps that is not stored with contacts.
    pub(super) law_history: LawHistory,
    /// Acceleration of gravity (m/s^2).
    pub gravity: S::Vector,
    /// Progress of the external actions that change in time.
    pub control: Control<S>,
    /// Contact impulses and moments on the driven bodies in the last step, in their order.
    pub received: Vec<(S::Vector, S::Spin)>,
    /// Velocities and spins of the driven bodies at the start of the last step, after the jumps of
    /// imposed motion.
    pub started: Vec<(S::Vector, S::Spin)>,
    /// The energy ledger.
    pub energy: Energy,
    /// The ledger of momentum.
    pub momentum: Momentum,
    /// Work of projections on driven bodies against imposed forces (J).
    pub projection_work: f64,
    /// Scars of the surfaces that wear.
    pub scars: Vec<Scar<S>>,
    /// The first surface that was worn through, if any.
    pub worn_through: Option<WornThrough>,
    /// Temperatures and the account of heat; `None` where none is computed.
    pub heat: Option<HeatState>,
    /// State of the automatic choice of the solver.
    pub(super) auto_state: AutoState,
}

impl<S: Space> State<S> {
    /// Creates a state of bodies and contacts at rest at time zero.
    pub(super) fn at_rest(bodies: Bodies<S>, network: Network<S>) -> Self {
        let kinetic = bodies.kinetic_energy();
        Self {
            time: 0.0,
            time_excess: 0.0,
            steps: 0,
            settled: true,
            systems: Systems::default(),
            network,
            law_history: LawHistory::default(),
            gravity: S::Vector::zero(),
            control: Control::default(),
            received: vec![(S::Vector::zero(), S::Spin::zero()); bodies.driven.len()],
            started: bodies.motion_of_driven(),
            energy: Energy {
                kinetic,
                initial_kinetic: kinetic,
                ..Energy::default()
            },
            momentum: Momentum::default(),
            projection_work: 0.0,
            scars: Vec::new(),
            worn_through: None,
            heat: None,
            auto_state: AutoState::default(),
            bodies,
        }
    }
}
