//! State of a simulation between two steps: the content of a checkpoint.
//!
//! All of it is saved, by its derived form: a new field is saved without being named anywhere else. What a case gives (shapes,
//! laws, phases, options) is built again, and work arrays of a step (forms, columns, the solver's problem and its colouring)
//! depend only on this state. Two things of the case follow the state while it changes: worn surfaces follow their scars, and
//! parameters of laws what phases have set; [`Simulation::restore`] has them follow again.

use super::Simulation;
use super::control::Control;
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

/// State of a simulation between two steps; see [`Simulation::restore`].
///
/// ```
/// use fretwork_core::code::{CodeError, decode, encode};
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
    /// What the sum of the steps in `time` has too much by rounding (s).
    pub(super) time_excess: f64,
    /// Steps completed.
    pub steps: u64,
    /// Whether the processes have acted on the state since the last step, see [`Simulation::between_steps`].
    pub(super) settled: bool,
    /// Grains and first bodies.
    pub bodies: Bodies<S>,
    /// Bodies that are more than rigid; see [`Simulation::add_system`].
    pub systems: Systems<S>,
    /// The contacts.
    pub network: Network<S>,
    /// What laws have to know of earlier steps, beyond what contacts remember.
    pub(super) law_history: LawHistory,
    /// Acceleration of gravity (m/s^2).
    pub gravity: S::Vector,
    /// What acts from outside and changes in time.
    pub control: Control<S>,
    /// Contact impulses and moments on the driven bodies in the last step, in their order.
    pub received: Vec<(S::Vector, S::Spin)>,
    /// Velocities and spins of the driven bodies at the start of the last step, after the jumps of imposed motion.
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
    /// What the automatic choice of the solver has learned.
    pub(super) auto_state: AutoState,
}

impl<S: Space> State<S> {
    /// Bodies and contacts at rest at time zero.
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

    /// Returns whether it is a state of this scene, in which a step can be made: its lists are as long as those of the scene, indices
    /// are in range, and numbers of motion are finite.
    fn fits(&self, scene: &Simulation<S>) -> bool {
        let built = &scene.state;
        let scars = self.scars.iter().zip(&built.scars);
        let heat = self.heat.iter().zip(&built.heat);
        self.bodies.len() == built.bodies.len()
            && self.bodies.fits(&built.bodies)
            && self.bodies.carriers == built.bodies.carriers
            && self
                .network
                .fits(&built.network, &scene.shapes, &self.bodies)
            && self.received.len() == built.received.len()
            && self.started.len() == built.started.len()
            && self.scars.len() == built.scars.len()
            && scars.into_iter().all(|(a, b)| a.fits(b))
            && self.heat.is_some() == built.heat.is_some()
            && heat.into_iter().all(|(a, b)| a.fits(b))
            && self.law_history.fits(scene.laws.len())
            && self.time.is_finite()
            && self.gravity.is_finite()
            && (self.control).fits(&scene.phases, &scene.laws, &self.bodies.driven)
    }
}

impl<S: Space> Simulation<S> {
    /// Continues from the state of a simulation that was built from the same case. The next step gives the same bits as in that
    /// simulation. Returns false, and changes nothing, if the state belongs to another case, or if this simulation has made steps
    /// already: build it again then, since laws and surfaces follow the state. A decoded state is restored here, not assigned to
    /// `state`, which would leave dynamical systems without their data.
    #[must_use]
    pub fn restore(&mut self, mut state: State<S>) -> bool {
        if self.state.steps > 0 || !state.fits(self) || !state.systems.take_up(&self.state.systems)
        {
            return false;
        }
        self.state = state;
        for scar in &self.state.scars {
            scar.show_again(&mut self.shapes);
        }
        self.show_expansion();
        // Results may be asked for before the next step.
        self.state
            .systems
            .deform(&self.state.bodies, &mut self.shapes);
        self.state.control.set_parameters(&mut self.laws);
        self.set_holder_drives();
        self.measure_areas();
        true
    }
}
