//! The runs of a study for other engines: scripts that call `fretwork study point` for each and
//! `fretwork study collect` at the end.

mod hyperqueue;
mod jobs;
mod slurm;
mod snakemake;

use super::plan::Plan;
use crate::Error;
use crate::shell::{command as shell, quote};
use fretwork_core::program;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// An engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Slurm: a job array and a job that collects
    Slurm,
    /// HyperQueue: a job file with a task for each chunk
    Hq,
    /// Snakemake: a Snakefile with a rule for runs and one that collects
    Snakemake,
    /// A list of commands, one a line, for GNU parallel, xargs and others
    Jobs,
}

/// Inputs of an export in addition to the study.
#[derive(Clone, Debug)]
pub struct Export<'a> {
    /// The study.
    pub plan: &'a Plan,
    /// Options for every call: plugins, cache.
    pub options: Vec<String>,
    /// Time limit of a run.
    pub limit: Option<Duration>,
    /// Number of runs of a task.
    pub chunk: usize,
    /// Expected time of a task (s), if it is known.
    pub task_seconds: Option<f64>,
    /// Lines for the head of a batch script.
    pub lines: Vec<String>,
}

/// Written files, and the command that starts them.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// The command.
    pub start: String,
}

impl Export<'_> {
    /// Writes the files of an engine into the folder of the study.
    ///
    /// # Errors
    /// A file cannot be written, or the path of the program is not known.
    pub fn write(&self, engine: Engine) -> Result<Written, Error> {
        self.check_texts(engine)?;
        match engine {
            Engine::Slurm => slurm::write(self),
            Engine::Hq => hyperqueue::write(self),
            Engine::Snakemake => snakemake::write(self),
            Engine::Jobs => jobs::write(self),
        }
    }

    /// Refuses texts that a script cannot contain: they would end a line of it, or an engine would
    /// interpret them.
    fn check_texts(&self, engine: Engine) -> Result<(), Error> {
        let plan = self.plan;
        for path in [&plan.file, &plan.out, &plan.launcher.case] {
            if path.to_str().is_none() {
                return Err(Error::Usage(format!(
                    "the name {path:?} is not UTF-8, and a script cannot hold it; rename it"
                )));
            }
        }
        let texts = self
            .call("point", &[])?
            .into_iter()
            .chain(self.lines.iter().cloned());
        let case = absolute(&plan.launcher.case);
        for text in texts.chain([case]) {
            if text.chars().any(char::is_control) {
                return Err(Error::Usage(format!(
                    "{text:?} has a control character, such as the end of a line, and a script would take what follows for a command; rename it"
                )));
            }
        }
        let special = match engine {
            Engine::Slurm => "\"\\",
            Engine::Snakemake => "{}",
            Engine::Hq | Engine::Jobs => "",
        };
        let out = absolute(&plan.out);
        if engine == Engine::Hq && out.contains("%{") {
            return Err(Error::Usage(format!(
                "the folder {out} has `%{{`, which HyperQueue takes for a word that it fills in; give another with --out"
            )));
        }
        match out.chars().find(|c| special.contains(*c)) {
            None => Ok(()),
            Some(c) => Err(Error::Usage(format!(
                "the folder {out} has a `{c}`, which the engine does not take as a part of a name; give another with --out"
            ))),
        }
    }

    /// Returns the words of a call of the program, `study VERB FILE ...`, with absolute paths.
    fn call(&self, verb: &str, middle: &[&str]) -> Result<Vec<String>, Error> {
        let command = program::command().map_err(|e| {
            Error::Usage(format!("the path of the program cannot be determined: {e}"))
        })?;
        let text = |s: &std::ffi::OsStr| s.to_string_lossy().into_owned();
        let mut words = vec![text(command.get_program())];
        words.extend(command.get_args().map(text));
        words.extend([
            "study".to_owned(),
            verb.to_owned(),
            absolute(&self.plan.file),
        ]);
        words.extend(middle.iter().map(|w| (*w).to_owned()));
        words.extend(["--out".to_owned(), absolute(&self.plan.out)]);
        words.extend(self.options.iter().cloned());
        if let Some(limit) = self.limit.filter(|_| verb == "point") {
            words.extend(["--limit".to_owned(), format!("{}s", limit.as_secs_f64())]);
        }
        Ok(words)
    }

    /// Returns the numbers of the first and the last run of each task.
    fn tasks(&self) -> Vec<(usize, usize)> {
        let count = self.plan.count();
        (1..=count)
            .step_by(self.chunk)
            .map(|first| (first, (first + self.chunk - 1).min(count)))
            .collect()
    }

    /// Creates the folder for the output of the tasks.
    fn logs(&self) -> Result<PathBuf, Error> {
        let logs = self.plan.out.join("logs");
        std::fs::create_dir_all(&logs).map_err(|e| Error::write(&logs, &e))?;
        Ok(logs)
    }

    fn put(&self, name: &str, text: &str) -> Result<PathBuf, Error> {
        let path = self.plan.out.join(name);
        std::fs::write(&path, text).map_err(|e| Error::write(&path, &e))?;
        Ok(path)
    }

    /// Returns a name without spaces, for engines that need one.
    fn name(&self) -> String {
        let stem = self
            .plan
            .file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let plain = |c: char| {
            if c.is_ascii_alphanumeric() || "-_".contains(c) {
                c
            } else {
                '_'
            }
        };
        stem.chars().map(plain).collect()
    }
}

fn absolute(path: &Path) -> String {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    whole.display().to_string()
}

/// Returns words for a POSIX shell, one of which is a text that is already quoted.
fn shell_with(words: &[String], marked: &str, text: &str) -> String {
    let word = |w: &String| match w == marked {
        true => text.to_owned(),
        false => quote(w),
    };
    words.iter().map(word).collect::<Vec<_>>().join(" ")
}
