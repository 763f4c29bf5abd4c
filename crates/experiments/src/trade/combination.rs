//! A setting of a trade: one level for every varied parameter.

use super::varied::{ParameterEffect, Varied};

/// Index of the level of every parameter, in the order of the parameters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Combination(pub Vec<usize>);

impl Combination {
    /// The setting of the case itself.
    pub fn own(parameters: &[Varied]) -> Self {
        Self(parameters.iter().map(|k| k.own).collect())
    }

    /// The reference setting.
    pub fn reference(parameters: &[Varied]) -> Self {
        Self(parameters.iter().map(|k| k.reference).collect())
    }

    /// Returns this setting with another level of one parameter.
    pub fn with(&self, parameter: usize, level: usize) -> Self {
        let mut levels = self.0.clone();
        levels[parameter] = level;
        Self(levels)
    }

    /// The parameters whose level is not the case's own.
    pub fn changed(&self, parameters: &[Varied]) -> Vec<usize> {
        (0..parameters.len())
            .filter(|&k| self.0[k] != parameters[k].own)
            .collect()
    }

    /// Returns the name of the setting by its differences from the case: `step 5e-5, tolerance
    /// 1e-3`.
    pub fn name(&self, parameters: &[Varied]) -> String {
        let named = |k: usize| {
            let parameter = &parameters[k];
            format!("{} {}", parameter.name, parameter.levels[self.0[k]].label)
        };
        let parts: Vec<String> = self.changed(parameters).into_iter().map(named).collect();
        if !parts.is_empty() {
            return parts.join(", ");
        }
        // The form of the case is named where other forms are compared with it.
        let forms =
            (0..parameters.len()).filter(|&k| parameters[k].effect == ParameterEffect::Form);
        let forms: Vec<String> = forms.map(named).collect();
        match forms.is_empty() {
            true => "the case's own".to_owned(),
            false => format!("the case's own ({})", forms.join(", ")),
        }
    }

    /// Returns the `--set` arguments for this setting.
    pub fn sets(&self, parameters: &[Varied]) -> Vec<String> {
        let changed = self.changed(parameters);
        changed
            .iter()
            .flat_map(|&k| parameters[k].levels[self.0[k]].sets.iter().cloned())
            .collect()
    }
}
