//! A setting: one level for every varied parameter.

use super::knobs::StudyParameter;

/// Index of the level of every parameter, in the order of the parameters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Setting(pub Vec<usize>);

impl Setting {
    /// The setting of the case itself.
    pub fn own(knobs: &[StudyParameter]) -> Self {
        Self(knobs.iter().map(|k| k.own).collect())
    }

    /// The reference setting.
    pub fn reference(knobs: &[StudyParameter]) -> Self {
        Self(knobs.iter().map(|k| k.reference).collect())
    }

    /// This setting with another level of one parameter.
    pub fn with(&self, knob: usize, level: usize) -> Self {
        let mut levels = self.0.clone();
        levels[knob] = level;
        Self(levels)
    }

    /// The parameters whose level is not the case's own.
    pub fn changed(&self, knobs: &[StudyParameter]) -> Vec<usize> {
        (0..knobs.len())
            .filter(|&k| self.0[k] != knobs[k].own)
            .collect()
    }

    /// Name of the setting by its differences from the case: `step 5e-5, tolerance 1e-3`.
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

    /// The `--set` arguments for this setting.
    pub fn sets(&self, knobs: &[StudyParameter]) -> Vec<String> {
        let changed = self.changed(knobs);
        changed
            .iter()
            .flat_map(|&k| knobs[k].levels[self.0[k]].sets.iter().cloned())
            .collect()
    }
}
