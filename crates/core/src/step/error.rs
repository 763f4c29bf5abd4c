//! Why a step could not be done.

use crate::laws::LawError;
use crate::process::ProcessError;
use crate::wear::WornThrough;

/// Why a step could not be done.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// A law refused.
    #[error("step {step} at t = {time:.6e} s: {source}")]
    Law {
        /// Number of the step.
        step: u64,
        /// Time at its start (s).
        time: f64,
        /// What the law said.
        source: LawError,
    },
    /// The method does not serve what the laws ask for.
    #[error("step {step}: solver.method {method}: {reason}")]
    Method {
        /// Number of the step.
        step: u64,
        /// The method.
        method: &'static str,
        /// Why, and what to take instead.
        reason: &'static str,
    },
    /// A surface has worn as deep as it is thick.
    #[error("step {step} at t = {time:.6e} s: {source}")]
    WornThrough {
        /// Number of the step that did it.
        step: u64,
        /// Time at its end (s).
        time: f64,
        /// Which and where.
        source: WornThrough,
    },
    /// A process refused.
    #[error("step {step} at t = {time:.6e} s: {process}: {source}")]
    Process {
        /// Number of the last step that was done.
        step: u64,
        /// Time at its end (s).
        time: f64,
        /// Name of the process.
        process: String,
        /// What it said.
        source: ProcessError,
    },
    /// A velocity is not finite.
    #[error(
        "step {step} at t = {time:.6e} s: the velocity of body {body} is not finite; use a smaller step or softer parameters"
    )]
    NotFinite {
        /// Number of the step.
        step: u64,
        /// Time at its start (s).
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
        /// Time at its start (s).
        time: f64,
        /// Name of the system.
        system: String,
    },
    /// A quantity of the state or of the ledger is not finite.
    #[error(
        "step {step} at t = {time:.6e} s: {quantity} is {value}, beyond what can be computed with; check the units of sizes, \
         velocities, forces and laws, or take a smaller time.step"
    )]
    Overflow {
        /// Number of the step.
        step: u64,
        /// Time at its end (s).
        time: f64,
        /// The quantity, and the body it is of.
        quantity: String,
        /// What it is.
        value: f64,
    },
}
