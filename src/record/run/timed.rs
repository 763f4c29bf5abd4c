//! Measurement of how the wall time of a run is spent.

use super::Recorder;
use crate::step::StepReport;
use fretwork_observe::summary::TimeSpent;
use std::time::Instant;

impl Recorder<'_> {
    /// Calls `action`, and adds its duration to one part of the time spent.
    pub(super) fn timed<T>(
        &mut self,
        part: fn(&mut TimeSpent) -> &mut f64,
        action: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let begun = Instant::now();
        let result = action(self);
        *part(&mut self.summary.run.time_spent) += begun.elapsed().as_secs_f64();
        result
    }

    /// Adds a step that began at an instant.
    pub(super) fn add_step(&mut self, begun: Instant, report: &StepReport) {
        let timing = &report.timing;
        let stages = [timing.detect, timing.laws, timing.solve];
        self.summary
            .run
            .time_spent
            .add_steps(begun.elapsed(), stages);
    }
}
