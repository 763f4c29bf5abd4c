//! What a run says first: its warnings, in the summary and over its pictures.

use super::Recorder;
use crate::geometry::space::Space;
use crate::record::summary::Summary;
use crate::record::warnings::{self, Warning};

/// Puts warnings into a summary whose numbers are there.
pub(super) fn judge(summary: &mut Summary, list: &[Warning]) {
    summary.warnings = list.iter().map(Warning::to_string).collect();
    let reasons = list.iter().filter(|w| w.serious);
    summary.reasons = reasons.map(Warning::to_string).collect();
    summary.trustworthy = summary.reasons.is_empty();
}

/// The band over pictures: what is not to be trusted, in few words; none where nothing is.
pub(super) fn band(list: &[Warning]) -> Option<String> {
    let mut names: Vec<&str> = list.iter().filter(|w| w.serious).map(|w| w.of).collect();
    names.dedup();
    (!names.is_empty()).then(|| format!("NOT TRUSTWORTHY: {} (see summary.json)", names.join(", ")))
}

impl<S: Space> Recorder<'_, S> {
    /// The band over a picture of the moment: what is known so far.
    pub(super) fn notice(&mut self) -> Option<String> {
        self.observers.before_step(&self.simulation);
        self.observers.summarise_so_far(&mut self.summary);
        band(&warnings::of(&self.summary, None))
    }

    /// Warnings of the whole run, for a summary whose other numbers are there.
    pub(super) fn warn(&mut self) -> Option<String> {
        let missed = warnings::missed(&self.summary);
        let advice = missed.warning(&self.simulation, self.simulation.steps);
        let list = warnings::of(&self.summary, advice);
        judge(&mut self.summary, &list);
        band(&list)
    }
}
