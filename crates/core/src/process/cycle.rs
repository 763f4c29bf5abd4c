//! Cycles of a test, as a function of time only.

use serde::{Deserialize, Serialize};

/// Start and length of the cycles. Without a length the whole time after the start is one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleClock {
    /// Start of the first cycle (s).
    pub start: f64,
    /// Length of a cycle (s).
    pub period: Option<f64>,
}

impl CycleClock {
    /// Creates cycles of a length (s) from `start` on. Without a length, the second half of the
    /// time from `start` to `end` (s) is one cycle.
    pub fn new(start: f64, period: Option<f64>, end: f64) -> Self {
        let start = if period.is_some() {
            start
        } else {
            0.5 * (start + end)
        };
        Self { start, period }
    }

    /// Number of the cycle at a time, from 1; 0 before the start.
    pub fn number(&self, time: f64) -> u32 {
        if time <= self.start {
            return 0;
        }
        match self.period {
            // A step that ends at the end of a cycle is part of that cycle.
            Some(period) => ((time - self.start) / period - 1e-9).floor().max(0.0) as u32 + 1,
            None => 1,
        }
    }

    /// Returns the completed share of the cycle at a time; 1 at its end.
    pub fn share(&self, time: f64) -> f64 {
        let before = f64::from(self.number(time).saturating_sub(1));
        let cycles = |period: f64| (time - self.start) / period - before;
        let share = self.period.map_or(0.0, cycles).max(0.0);
        if share > 1.0 - 1e-6 { 1.0 } else { share }
    }

    /// Returns start and end of a cycle (s); `None` without cycles.
    pub fn span(&self, number: u32) -> Option<[f64; 2]> {
        let begun = self.start + f64::from(number.saturating_sub(1)) * self.period?;
        Some([begun, begun + self.period?])
    }
}
