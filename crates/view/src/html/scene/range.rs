//! Ranges of fields over all states that are shown, for the scales of colours.

use std::collections::HashMap;

/// The range of a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Smallest and largest value.
    pub all: [f64; 2],
    /// The same without the lowest and the highest hundredth of the values of each state.
    pub most: [f64; 2],
}

/// Ranges by group and name.
#[derive(Debug, Default)]
pub(super) struct Ranges(HashMap<(String, String), Range>);

impl Ranges {
    /// Takes in the values of a field in a state.
    pub fn note(&mut self, group: &str, name: &str, values: &[f64]) {
        let mut values: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        if values.is_empty() {
            return;
        }
        values.sort_unstable_by(f64::total_cmp);
        let (last, edge) = (values.len() - 1, values.len() / 100);
        let new = Range {
            all: [values[0], values[last]],
            most: [values[edge], values[last - edge]],
        };
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.0
            .entry((group.to_owned(), name.to_owned()))
            .and_modify(|old| {
                old.all = join(old.all, new.all);
                old.most = join(old.most, new.most);
            })
            .or_insert(new);
    }

    /// The range of a field, if it has values.
    pub fn of(&self, group: &str, name: &str) -> Option<Range> {
        self.0.get(&(group.to_owned(), name.to_owned())).copied()
    }
}
