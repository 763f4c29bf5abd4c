//! Progress display: a bar on a terminal, plain lines otherwise.

use super::output::report;
use crate::record::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Shows the progress of a run on standard error.
pub struct Display {
    bar: Option<ProgressBar>,
    quiet: bool,
    started: Instant,
    next_line: Duration,
    next_update: Duration,
    begun: bool,
}

impl Display {
    /// A bar on a terminal, occasional lines otherwise, nothing if quiet.
    pub fn new(quiet: bool) -> Self {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new(1);
            let template = "{bar:24.cyan/blue} {percent:>3}% step {pos}/{len} {msg} left {eta}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self {
            bar,
            quiet,
            started: Instant::now(),
            next_line: Duration::from_secs(2),
            next_update: Duration::ZERO,
            begun: false,
        }
    }

    /// Updates the display after a step.
    pub fn step(&mut self, p: &Progress) {
        if self.quiet {
            return;
        }
        let elapsed = self.started.elapsed();
        if let Some(bar) = &self.bar {
            if !self.begun && p.resumed_at > 0 {
                // The remaining time is estimated only from the part of the run since it was
                // resumed.
                bar.set_length(p.steps.1);
                bar.set_position(p.resumed_at);
                bar.reset_eta();
            }
            self.begun = true;
            if elapsed >= self.next_update || p.steps.0 == p.steps.1 {
                self.next_update = elapsed + Duration::from_millis(100);
                bar.set_length(p.steps.1);
                bar.set_position(p.steps.0);
                bar.set_message(self.message(p));
            }
        } else if elapsed >= self.next_line || p.steps.0 == p.steps.1 {
            // The interval between lines grows with the run time.
            self.next_line = elapsed.mul_f64(1.25).max(elapsed + Duration::from_secs(2));
            let left = left(elapsed, p);
            report(&format!(
                "step {}/{} {} left {left:.0} s",
                p.steps.0,
                p.steps.1,
                self.message(p)
            ));
        }
    }

    fn message(&self, p: &Progress) -> String {
        let cycle = if p.cycle.1 > 0 {
            format!("cycle {}/{} ", p.cycle.0, p.cycle.1)
        } else {
            String::new()
        };
        let missed = if p.unconverged > 0 {
            format!(" ({} steps not converged)", p.unconverged)
        } else {
            String::new()
        };
        format!(
            "{cycle}contacts {} iterations {} error {:.1e} damage {:.3}{missed}",
            p.contacts, p.iterations, p.error, p.damage_ratio
        )
    }

    /// Ends the display.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            // The bar of a run that ended early keeps its position.
            bar.abandon();
        }
    }
}

/// Estimates the remaining time (s) from the steps since the run started or was resumed.
fn left(elapsed: Duration, p: &Progress) -> f64 {
    let (done, all) = p.steps;
    let here = done.saturating_sub(p.resumed_at).max(1);
    elapsed.as_secs_f64() * all.saturating_sub(done) as f64 / here as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_counts_only_the_steps_of_this_part() {
        let p = Progress {
            steps: (900, 1000),
            resumed_at: 800,
            cycle: (0, 0),
            contacts: 0,
            iterations: 0,
            error: 0.0,
            unconverged: 0,
            damage_ratio: 0.0,
        };
        assert_eq!(left(Duration::from_secs(20), &p), 20.0);
        let whole = Progress { resumed_at: 0, ..p };
        assert_eq!(left(Duration::from_secs(90), &whole), 10.0);
    }
}
