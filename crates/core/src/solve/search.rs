//! Decides when to search for another solution of a connected set, see [`super::sticking`].

use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of steps that are skipped after searches without another solution, while no
/// loaded contact that held begins to slide; also the number of steps without sliding after which
/// the waits of a set are forgotten.
const PASSED: i32 = 8;

/// State of the searches for a second solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SecondSearch {
    /// Waiting times of the sets that slid, by their first body.
    backoffs: BTreeMap<u32, Backoff>,
    /// Sets of which another solve ended in a solution in this step.
    #[serde(default)]
    searched: BTreeSet<u32>,
}

/// Steps to wait after searches without a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Backoff {
    /// Steps until the next search; negative where nothing slid since then.
    left: i32,
    /// Number of steps that are skipped.
    passed: i32,
}

impl SecondSearch {
    /// Begins a step.
    pub fn begin_step(&mut self) {
        self.searched.clear();
        self.backoffs
            .values_mut()
            .for_each(|backoff| backoff.left -= 1);
        self.backoffs.retain(|_, backoff| backoff.left >= -PASSED);
    }

    /// Returns whether a set is to be searched in this step.
    pub fn is_due(&self, set: u32) -> bool {
        self.backoffs
            .get(&set)
            .is_none_or(|backoff| backoff.left <= 0)
    }

    /// Returns whether another solve of a set ended in a solution in this step.
    pub fn was_searched(&self, set: u32) -> bool {
        self.searched.contains(&set)
    }

    /// Records that another solve of a set ended in a solution.
    pub fn answered(&mut self, set: u32) {
        self.searched.insert(set);
    }

    /// Records the result of a search.
    pub fn learn(&mut self, set: u32, found: bool) {
        if found {
            self.backoffs.remove(&set);
            return;
        }
        let backoff = self.backoffs.entry(set).or_default();
        backoff.passed = (2 * backoff.passed).clamp(1, PASSED);
        backoff.left = backoff.passed + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps are counted, not solves: searches follow after 1, 2, 4, 8, 8 steps without a result,
    /// whatever is solved in between.
    #[test]
    fn searches_are_put_off_by_steps() {
        let mut search = SecondSearch::default();
        let (mut last, mut passed) = (None, Vec::new());
        for step in 0..35 {
            search.begin_step();
            for solve in 0..3 {
                if search.is_due(7) {
                    assert_eq!(solve, 0, "once a step");
                    search.learn(7, false);
                    passed.extend(last.map(|last| step - last - 1));
                    last = Some(step);
                }
                assert!(search.is_due(8), "another set waits for nothing");
            }
        }
        assert_eq!(passed, [1, 2, 4, 8, 8]);
        search.learn(7, true);
        assert!(search.is_due(7));
        search.answered(7);
        assert_eq!([7, 8].map(|set| search.was_searched(set)), [true, false]);
        search.learn(7, false);
        for _ in 0..20 {
            search.begin_step();
        }
        assert_eq!(search, SecondSearch::default(), "it is forgotten");
    }
}
