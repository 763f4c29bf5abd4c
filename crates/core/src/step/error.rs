//! Errors of a time step.

use crate::heat::DiffusionError;
use crate::laws::LawError;
use crate::wear::WornThrough;

/// Error of a process; it ends the run.
pub type ProcessError = Box<dyn std::error::Error + Send + Sync>;

/// Reason why a step failed.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// A law reported an error.
    #[error("step {step} at t = {time:.6e} s: {source}")]
    Law {
        /// Number of the step.
        step: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// The law's error.
        source: LawError,
    },
    /// The method does not support what the laws require.
    #[error("step {step}: solver.method {method}: {reason}")]
    Method {
        /// Number of the step.
        step: u64,
        /// The method.
        method: &'static str,
        /// The reason, and the method to use instead.
        reason: &'static str,
    },
    /// Wear has reached the thickness of a surface.
    #[error("step {step} at t = {time:.6e} s: {source}")]
    WornThrough {
        /// Number of the step in which it happened.
        step: u64,
        /// Time at the end of that step (s).
        time: f64,
        /// The surface and the position.
        source: WornThrough,
    },
    /// A process refused.
    #[error("step {step} at t = {time:.6e} s: {process}: {source}")]
    Process {
        /// Number of the last completed step.
        step: u64,
        /// Time at the end of that step (s).
        time: f64,
        /// Name of the process.
        process: String,
        /// Error of the process.
        source: ProcessError,
    },
    /// Projection of overlaps is requested, which dynamical systems do not support.
    #[error(
        "step {step}: solver.projection moves grains and first bodies apart, not the system `{system}`; set solver.projection to 0, \
         and solver.correction above 0 to have overlaps removed"
    )]
    SystemProjection {
        /// Number of the step.
        step: u64,
        /// Name of the first system.
        system: String,
    },
    /// Heat or current cannot be computed.
    #[error("step {step} at t = {time:.6e} s: heat: {source}")]
    Heat {
        /// Number of the step.
        step: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// Reason.
        source: DiffusionError,
    },
    /// A velocity is not finite.
    #[error(
        "step {step} at t = {time:.6e} s: the velocity of body {body} is not finite; use a smaller step or softer parameters"
    )]
    NotFinite {
        /// Number of the step.
        step: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// Identity of the body.
        body: u64,
    },
    /// A velocity of a dynamical system is not finite.
    #[error(
        "step {step} at t = {time:.6e} s: a velocity of the system `{system}` is not finite; use a smaller step or softer \
         parameters"
    )]
    SystemNotFinite {
        /// Number of the step.
        step: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// Name of the system.
        system: String,
    },
    /// A dynamical system whose forces are not linear finds no balance.
    #[error("step {step} at t = {time:.6e} s: the body `{system}`: {why}")]
    SystemBalance {
        /// Number of the step.
        step: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// Name of the system.
        system: String,
        /// Reason, and what to change.
        why: String,
    },
    /// A quantity of the state or of the ledger is not finite.
    #[error(
        "step {step} at t = {time:.6e} s: {quantity} is {value}, beyond what can be computed with; check the units of sizes, \
         velocities, forces and laws, or take a smaller time.step"
    )]
    Overflow {
        /// Number of the step.
        step: u64,
        /// Time at the end of the step (s).
        time: f64,
        /// The quantity, with the body to which it belongs.
        quantity: String,
        /// Value of the quantity.
        value: f64,
    },
}

impl StepError {
    /// Whether a law or a dynamical system asks for a smaller time step.
    pub fn asks_for_smaller_step(&self) -> bool {
        match self {
            Self::Law { source, .. } => source.asks_for_smaller_step(),
            Self::SystemBalance { .. } => true,
            _ => false,
        }
    }
}
