//! Warnings of a run over its pictures.

use super::Recorder;
use crate::record::summary::Summary;
use crate::record::warning::Warning;

/// Text of the warning band over pictures; `None` if there is no reason for one.
pub(super) fn band(list: &[Warning]) -> Option<String> {
    let mut names: Vec<&str> = list.iter().filter(|w| w.serious).map(|w| w.of).collect();
    names.dedup();
    (!names.is_empty()).then(|| format!("NOT TRUSTWORTHY: {} (see summary.json)", names.join(", ")))
}

impl Recorder<'_> {
    /// Text of the band over a picture during the run, as far as known.
    pub(super) fn notice(&mut self) -> Option<String> {
        self.observers.before_step(self.simulation.view());
        let mut now = Summary {
            run: self.summary.run.clone(),
            found: self.observers.report_so_far(self.simulation.dimension()),
        };
        band(&now.check())
    }
}
