//! Warnings of a run that are shown over its pictures.

use crate::record::warning::Warning;

/// Text of the warning band over pictures; `None` if there is no reason for one.
pub(super) fn band(list: &[Warning]) -> Option<String> {
    let mut names: Vec<&str> = list.iter().filter(|w| w.serious).map(|w| w.of).collect();
    names.dedup();
    (!names.is_empty()).then(|| format!("NOT TRUSTWORTHY: {} (see summary.json)", names.join(", ")))
}
