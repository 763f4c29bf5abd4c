//! Report of a step.

use crate::laws::Totals;
use crate::solve;
use std::time::Duration;

/// Wall-clock time of the parts of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timing {
    /// Detection, including the projection of penetrations.
    pub detect: Duration,
    /// Laws: preparation and commit.
    pub laws: Duration,
    /// The solver.
    pub solve: Duration,
}

/// Report of one step.
#[derive(Clone, Debug, Default)]
pub struct StepReport {
    /// The solver's report.
    pub solver: solve::Report,
    /// Report of the coupling of damage and opening.
    pub coupling: CouplingReport,
    /// Agreement of laws and solution.
    pub agreement: Agreement,
    /// Sums over contacts.
    pub totals: Totals,
    /// Number of solves; more than one if the first omitted contacts that its velocities closed.
    pub solves: u32,
    /// Number of contacts that carry an impulse.
    pub active: usize,
    /// Number of contacts: those within the alert distance or bonded, and predicted contacts with
    /// an impulse.
    pub contacts: usize,
    /// Result of the projection of penetrations, if there was one.
    pub projected: Option<ProjectionReport>,
    /// Imposed motions that no solution can follow, if there were any.
    pub impossible: Option<Box<Impossible>>,
    /// Deepest overlap at detection, after a projection, see
    /// [`super::Simulation::deepest_overlap`].
    pub overlap: f64,
    /// Wall-clock time.
    pub timing: Timing,
}

/// Report of the coupling in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CouplingReport {
    /// Number of solves; zero where the coupling is explicit.
    pub iterations: u32,
    /// Largest change of damage in the last iteration.
    pub change: f64,
    /// Whether the iteration ended without reaching the tolerance.
    pub missed: bool,
}

/// Agreement of laws and solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Number of solves: more than 1 where friction depends on velocity, or attraction on the gap.
    pub solves: u32,
    /// Sum over contacts of the difference between the friction used and that of the laws at the
    /// resulting sliding velocity, over the sum of the friction.
    pub friction: f64,
    /// Sum over contacts of the difference between the attraction used and that over the gaps
    /// passed, over the sum of their loads.
    pub attraction: f64,
}

/// Result of a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectionReport {
    /// Deepest penetration before it, as a fraction of the smaller body's length.
    pub before: f64,
    /// Deepest penetration left.
    pub after: f64,
    /// Iterations of the solver.
    pub sweeps: u32,
    /// Work done on driven bodies against imposed forces and moments (J; J/m in 2D).
    pub against_loads: f64,
}

/// Imposed motions that no solution can follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impossible {
    /// Bodies that squeeze others without bound: those that do the work first, then those against
    /// which they press; empty if there are none.
    pub squeezing: Vec<u32>,
    /// Deepest growing overlap of two bodies with imposed motions, if there is one.
    pub overlap: Option<DrivenOverlap>,
}

/// Two overlapping bodies with imposed motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenOverlap {
    /// The bodies.
    pub bodies: [u32; 2],
    /// Depth at the end of the step (m).
    pub depth: f64,
}
