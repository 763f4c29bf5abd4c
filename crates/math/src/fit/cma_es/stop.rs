//! End of a search: appendix B.3 of Hansen's tutorial.

use thiserror::Error;

/// Settings of the end of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Standard deviation of all coordinates below which the search ends.
    pub step: f64,
    /// Range of the best values of the last generations, and of the values of the last one, below
    /// which it ends.
    pub value: f64,
}

impl Default for Limits {
    /// Returns steps and ranges of 1e-12.
    fn default() -> Self {
        Self {
            step: 1e-12,
            value: 1e-12,
        }
    }
}

/// Reason for the end of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Stop {
    /// All steps are below the limit: the usual end.
    #[error("the points differ by less than the wanted step")]
    Step,
    /// The values hardly change.
    #[error("the values differ by less than the wanted difference")]
    Value,
    /// Best and median values have not improved over many generations: noise, or a limit of
    /// precision.
    #[error("the values have not become better for many generations")]
    Stagnation,
    /// The steps grow: the start was far from any minimum, or the function has none.
    #[error("the search runs away: start with a larger step, or limit the region")]
    Diverges,
    /// The axes of the distribution differ by 1e7.
    #[error(
        "a combination of parameters has no effect on the values, or one has 1e7 times that of another: scale them, or leave one out"
    )]
    Condition,
    /// No run succeeds.
    #[error("no run of the last {0} generations succeeded: start elsewhere, or limit the region")]
    Failures(usize),
}

/// Number of generations without any success after which a search ends.
pub(super) const FAILED_GENERATIONS: usize = 5;

/// Data of earlier generations for the criteria.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct History {
    /// Best value of each generation that had one.
    pub best: Vec<f64>,
    /// Median value of each generation that had one.
    pub median: Vec<f64>,
    /// Largest less smallest value of the last generation.
    pub last_range: f64,
    /// Number of generations since a run succeeded.
    pub failed: usize,
}

impl History {
    /// Appends a generation: the sorted values of its successful runs.
    pub(super) fn record(&mut self, sorted: &[f64]) {
        let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
            self.failed += 1;
            return;
        };
        self.failed = 0;
        self.best.push(*first);
        self.median.push(sorted[sorted.len() / 2]);
        self.last_range = last - first;
    }

    /// Returns whether the best values of the last 10 + 30 n / lambda generations are equal, and
    /// all values of the last one too.
    pub(super) fn flat(&self, dimensions: usize, population: usize, limit: f64) -> bool {
        let recent = 10 + (30 * dimensions).div_ceil(population);
        let Some(start) = self.best.len().checked_sub(recent) else {
            return false;
        };
        let last = &self.best[start..];
        let most = last.iter().copied().fold(f64::MIN, f64::max);
        let least = last.iter().copied().fold(f64::MAX, f64::min);
        most - least < limit && self.last_range < limit
    }

    /// Returns whether, of the last 20 % of the generations, at least 120 + 30 n / lambda, the
    /// newest 30 % have medians of best and median values that are no better than those of the
    /// oldest 30 %.
    pub(super) fn stagnates(&self, dimensions: usize, population: usize) -> bool {
        let count = self.best.len();
        let span = (120 + 30 * dimensions / population)
            .max(count / 5)
            .min(20_000);
        if count < span {
            return false;
        }
        let part = span * 3 / 10;
        let worse = |list: &[f64]| {
            let window = &list[count - span..];
            median(&window[span - part..]) >= median(&window[..part])
        };
        worse(&self.best) && worse(&self.median)
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stagnation_needs_many_generations_without_progress() {
        let mut history = History::default();
        for i in 0..400 {
            history.record(&[-f64::from(i), 1.0 - f64::from(i), 2.0]);
            assert!(!history.stagnates(3, 7) && !history.flat(3, 7, 1e-3));
        }
        for _ in 0..400 {
            history.record(&[-400.0, -399.0]);
        }
        assert!(history.stagnates(3, 7));
        assert!(!history.flat(3, 7, 0.5) && history.flat(3, 7, 1.5));
        history.record(&[]);
        assert_eq!(history.failed, 1);
    }

    #[test]
    fn reasons_are_sentences() {
        let text = Stop::Failures(5).to_string();
        assert!(text.contains("last 5 generations") && text.contains("start elsewhere"));
    }
}
