//! Wall time of the parts of a run.

use crate::quantity::quantity;
use crate::quantity::unit::SECOND;
use serde::{Deserialize, Serialize};
use std::time::Duration;

crate::described! {
    /// Wall time of a run (s) by parts. Reading the case, searching for plugins and the report page
    /// are not part of a run.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TimeSpent {
        /// Detection of contacts, in the steps.
        pub detection: f64 => SECOND,
        /// Evaluation of the laws.
        pub laws: f64 => SECOND,
        /// Solution of the contacts.
        pub solver: f64 => SECOND,
        /// Everything else in a step: motion, energy ledger, processes, and steps repeated to
        /// estimate an error.
        pub rest_of_steps: f64 => SECOND,
        /// Observers: statistics, tests and measures.
        pub observers: f64 => SECOND,
        /// Writing `results.h5`, `statistics.csv`, checkpoints and tables.
        pub files: f64 => SECOND,
        /// Drawing and writing frames and figures.
        pub pictures: f64 => SECOND,
    }
}

impl TimeSpent {
    /// Adds steps with their wall time, and the time of their detection, laws and solver.
    pub fn add_steps(&mut self, all: Duration, [detection, laws, solver]: [Duration; 3]) {
        self.detection += detection.as_secs_f64();
        self.laws += laws.as_secs_f64();
        self.solver += solver.as_secs_f64();
        let rest = all.saturating_sub(detection + laws + solver);
        self.rest_of_steps += rest.as_secs_f64();
    }

    fn parts(&self) -> [(&'static str, f64); 7] {
        [
            ("detection", self.detection),
            ("laws", self.laws),
            ("solver", self.solver),
            ("rest of the steps", self.rest_of_steps),
            ("statistics and measures", self.observers),
            ("files", self.files),
            ("pictures", self.pictures),
        ]
    }

    /// Returns the sentence for the terminal; `None` where nothing was timed.
    pub(super) fn sentence(&self) -> Option<String> {
        let parts = self.parts();
        let sum: f64 = parts.iter().map(|p| p.1).sum();
        let shares = parts.map(|(name, s)| format!("{name} {:.1} %", 100.0 * s / sum));
        (sum > 0.0).then(|| format!("{} of {}", shares.join(", "), quantity(sum, "s")))
    }
}

#[cfg(test)]
mod tests {
    use super::TimeSpent;
    use std::time::Duration;

    #[test]
    fn the_rest_is_what_the_stages_leave() {
        let mut spent = TimeSpent::default();
        let ms = Duration::from_millis;
        spent.add_steps(ms(10), [ms(1), ms(2), ms(4)]);
        assert!((spent.rest_of_steps - 3e-3).abs() < 1e-12, "{spent:?}");
        let sum: f64 = spent.parts().iter().map(|p| p.1).sum();
        assert!((sum - 0.01).abs() < 1e-12, "{spent:?}");
    }
}
