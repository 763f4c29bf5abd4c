//! Terminal output common to `study`, `fit` and `trade`.

use super::output::report;
use super::{Failure, again};
use crate::experiments::Error;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Duration;

impl From<Error> for Failure {
    fn from(e: Error) -> Self {
        match e {
            Error::Input(e) => Self::Input(e),
            Error::Usage(text) => Self::Usage(text),
            other => Self::Failed(other.to_string()),
        }
    }
}

/// The folder of the results; results/<command>/<file> by default.
pub fn results(out: Option<&Path>, command: &str, file: &Path) -> PathBuf {
    let default = || {
        let name = file.file_stem().unwrap_or_default();
        Path::new("results").join(command).join(name)
    };
    out.map_or_else(default, Path::to_owned)
}

/// Failure of a command that was asked to stop.
pub fn interrupted() -> Failure {
    Failure::Failed(format!(
        "interrupted: finished runs are kept; to continue from there:\n  {}",
        again::command(&[])
    ))
}

/// Returns whether there is a terminal on which bars are wanted.
fn shows_bars() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("FRETWORK_QUIET").is_none()
}

/// A bar over runs on a terminal; nothing elsewhere.
#[derive(Debug, Default)]
pub struct RunsBar(Option<ProgressBar>);

impl RunsBar {
    /// Makes a bar over `count` runs, with a name if there are several bars.
    pub fn new(count: usize, name: &str) -> Self {
        Self((shows_bars() && count > 0).then(|| {
            let template = match name {
                "" => "{bar:40} {pos}/{len} runs  {elapsed} of about {duration}",
                _ => "{msg:16} {bar:30} {pos}/{len} runs  {elapsed} of about {duration}",
            };
            let style = ProgressStyle::with_template(template);
            let bar = ProgressBar::new(count as u64).with_message(name.to_owned());
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.enable_steady_tick(Duration::from_secs(1));
            bar
        }))
    }

    /// Counts a finished run.
    pub fn run(&self) {
        if let Some(bar) = &self.0 {
            bar.inc(1);
        }
    }

    /// Prints a line above the bar if it must be seen, or if there is no bar.
    pub fn line(&self, text: &str, must: bool) {
        match &self.0 {
            Some(bar) if must => bar.println(text),
            Some(_) => {}
            None => report(text),
        }
    }
}

/// A bar over the parts of a computation on a terminal; nothing elsewhere.
#[derive(Debug, Default)]
pub struct PartsBar(Option<ProgressBar>);

/// Length of the bar of a part.
const WHOLE: f64 = 1000.0;

impl PartsBar {
    /// Makes a bar, unless it is to be `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self((!quiet && shows_bars()).then(|| {
            let template = "{msg:10} {bar:40} {percent:>3} %  {elapsed} of about {duration}";
            let style = ProgressStyle::with_template(template);
            let bar = ProgressBar::new(WHOLE as u64);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        }))
    }

    /// Shows how much of a part is done; another part begins a new bar.
    pub fn reached(&self, part: &str, done: f64) {
        let Some(bar) = &self.0 else { return };
        if bar.message() != part {
            bar.reset();
            bar.set_message(part.to_owned());
        }
        bar.set_position((WHOLE * done.clamp(0.0, 1.0)) as u64);
    }
}

impl Drop for PartsBar {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

impl Drop for RunsBar {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
