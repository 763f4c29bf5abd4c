//! Warnings of a run, for its summary and its pictures.

use super::Recorder;
use crate::geometry::space::Space;
use crate::record::summary::Summary;
use crate::record::warnings::{self, Warning};

/// Adds warnings to a summary.
pub(super) fn judge(summary: &mut Summary, list: &[Warning]) {
    summary.warnings = list.iter().map(Warning::to_string).collect();
    let reasons = list.iter().filter(|w| w.serious);
    summary.reasons = reasons.map(Warning::to_string).collect();
    summary.trustworthy = summary.reasons.is_empty();
}

/// Text of the warning band over pictures; `None` if there is no reason for one.
pub(super) fn band(list: &[Warning]) -> Option<String> {
    let mut names: Vec<&str> = list.iter().filter(|w| w.serious).map(|w| w.of).collect();
    names.dedup();
    (!names.is_empty()).then(|| format!("NOT TRUSTWORTHY: {} (see summary.json)", names.join(", ")))
}

impl<S: Space> Recorder<'_, S> {
    /// Text of the band over a picture during the run, as far as known.
    pub(super) fn notice(&mut self) -> Option<String> {
        self.observers.before_step(&self.simulation);
        self.observers.summarise_so_far(&mut self.summary);
        band(&warnings::of(&self.summary, None))
    }

    /// Adds the warnings of the whole run to the complete summary.
    pub(super) fn warn(&mut self) -> Option<String> {
        let missed = warnings::missed(&self.summary);
        let advice = missed.warning(&self.simulation, self.simulation.state.steps);
        let list = warnings::of(&self.summary, advice);
        judge(&mut self.summary, &list);
        band(&list)
    }
}
