//! A setting: a value for every knob.

use super::knobs::StudyParameter;

/// The level of every knob, as an index into its levels, in the order of the knobs.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Setting(pub Vec<usize>);

impl Setting {
    /// The case as it is.
    pub fn own(knobs: &[StudyParameter]) -> Self {
        Self(knobs.iter().map(|k| k.own).collect())
    }

    /// The finest.
    pub fn reference(knobs: &[StudyParameter]) -> Self {
        Self(knobs.iter().map(|k| k.reference).collect())
    }

    /// The same with another level of one knob.
    pub fn with(&self, knob: usize, level: usize) -> Self {
        let mut levels = self.0.clone();
        levels[knob] = level;
        Self(levels)
    }

    /// The knobs whose level is not the case's own.
    pub fn changed(&self, knobs: &[StudyParameter]) -> Vec<usize> {
        (0..knobs.len())
            .filter(|&k| self.0[k] != knobs[k].own)
            .collect()
    }

    /// `step 5e-5, tolerance 1e-3`: what differs from the case.
    pub fn name(&self, knobs: &[StudyParameter]) -> String {
        let parts: Vec<String> = self
            .changed(knobs)
            .into_iter()
            .map(|k| format!("{} {}", knobs[k].name, knobs[k].levels[self.0[k]].label))
            .collect();
        if parts.is_empty() {
            "the case's own".to_owned()
        } else {
            parts.join(", ")
        }
    }

    /// The `--set` arguments that make it from the case.
    pub fn sets(&self, knobs: &[StudyParameter]) -> Vec<String> {
        let changed = self.changed(knobs);
        changed
            .iter()
            .flat_map(|&k| knobs[k].levels[self.0[k]].sets.iter().cloned())
            .collect()
    }
}
