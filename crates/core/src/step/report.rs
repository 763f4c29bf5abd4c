//! What a step reports.

use super::agreement::Agreement;
use super::coupling::CouplingReport;
use super::impossible::Impossible;
use super::projection::Projected;
use crate::laws::Totals;
use crate::solve;
use std::time::Duration;

/// Wall-clock time of the parts of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timing {
    /// Detection, including the projection of penetrations.
    pub detect: Duration,
    /// Laws: prepare and commit.
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
    /// How laws and the step agree.
    pub agreement: Agreement,
    /// Sums over contacts.
    pub totals: Totals,
    /// Number of solves: above 1 where the first left contacts out that its velocities closed.
    pub solves: u32,
    /// Number of contacts that carry an impulse.
    pub active: usize,
    /// Number of contacts: those within the alert distance or bonded, and of the predicted ones those with an impulse.
    pub contacts: usize,
    /// Result of the projection of penetrations, if there was one.
    pub projected: Option<Projected>,
    /// Imposed motions that nothing could obey, if there were any.
    pub impossible: Option<Box<Impossible>>,
    /// Deepest overlap at detection, after a projection, see [`super::Simulation::deepest_overlap`].
    pub overlap: f64,
    /// Wall-clock time.
    pub timing: Timing,
}
