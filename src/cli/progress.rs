//! Progress: a bar on a terminal, plain lines elsewhere.

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
    unconverged: u64,
}

impl Display {
    /// A bar on a terminal, a line now and then elsewhere, nothing when quiet.
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
            unconverged: 0,
        }
    }

    /// After a step.
    pub fn step(&mut self, p: &Progress) {
        self.unconverged += u64::from(!p.converged);
        if self.quiet {
            return;
        }
        let elapsed = self.started.elapsed();
        if let Some(bar) = &self.bar {
            if elapsed >= self.next_update || p.steps.0 == p.steps.1 {
                self.next_update = elapsed + Duration::from_millis(100);
                bar.set_length(p.steps.1);
                bar.set_position(p.steps.0);
                bar.set_message(self.message(p));
            }
        } else if elapsed >= self.next_line || p.steps.0 == p.steps.1 {
            // Lines get rarer as the run gets longer.
            self.next_line = elapsed.mul_f64(1.25).max(elapsed + Duration::from_secs(2));
            let left =
                elapsed.as_secs_f64() * (p.steps.1 - p.steps.0) as f64 / p.steps.0.max(1) as f64;
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
        let missed = if self.unconverged > 0 {
            format!(" ({} steps not converged)", self.unconverged)
        } else {
            String::new()
        };
        format!(
            "{cycle}contacts {} iterations {} error {:.1e} damage {:.3}{missed}",
            p.contacts, p.iterations, p.error, p.damage_ratio
        )
    }

    /// At the end.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish();
        }
    }
}
