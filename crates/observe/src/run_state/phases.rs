//! Phases of a run.

use crate::observer::{Observer, RunEnd};
use crate::quantity::unit::{ONE, SECOND, WORD};
use crate::quantity::{Field, Findings, Role, Topic, field, quantity};
use crate::statistics::Column;
use crate::warning::{NOT_REACHED, Warning};
use fretwork_core::step::control::StartedPhase;
use fretwork_core::view::RunView;

/// Fields of a phase that began.
const PHASE: [Field; 5] = [
    field("name", WORD, "name of the phase"),
    field("start", SECOND, "time at which it began"),
    field("first_step", ONE, "steps done before it"),
    field("end", SECOND, "time at which it ended; null while it runs"),
    field("ended_by", WORD, "what ended it"),
];

/// Returns start and end of a phase; for a repeated phase the start of the first and the end of the
/// last.
fn times(begun: &[StartedPhase], phase: &StartedPhase) -> (String, String) {
    let same = || begun.iter().filter(|q| q.name == phase.name);
    let end = same().next_back().and_then(|last| last.end);
    let end = end.map_or_else(|| "the end of the run".to_owned(), |t| quantity(t, "s"));
    let start = quantity(phase.start, "s");
    let text = match (same().count(), phase.ended_by) {
        (1, Some(why)) => format!("from {start} to {end}, ended by {why}"),
        (1, None) => format!("from {start} to {end}"),
        (count, _) => format!("{count} times, from {start} to {end}"),
    };
    (format!("phase {}", phase.name), text)
}

/// Observes the phases of a run: the number of the current one.
#[derive(Clone, Copy, Debug)]
pub struct Phases {
    any: bool,
}

impl Phases {
    /// Creates the observer of the phases of a simulation.
    pub fn of(run: &dyn RunView) -> Self {
        Self {
            any: !run.phase_names().is_empty(),
        }
    }
}

impl Observer for Phases {
    fn name(&self) -> String {
        "phases".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let column = || Column::new("phase", "", "number of the phase, from 1");
        self.any.then(column).into_iter().collect()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let phase = || run.phase() as f64;
        self.any.then(phase).into_iter().collect()
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let begun = end.simulation.begun();
        let left = end.simulation.phase_names().into_iter();
        let mut missed: Vec<&str> = left.skip(begun.len()).collect();
        missed.dedup();
        found.begin(Topic::Run, Role::Diagnostic);
        found.fields("phases", begun, &PHASE, "phases that began");
        let doc = "names of the phases that the run did not reach";
        found.fields("phases_missed", &missed, &[], doc);
        for (k, phase) in begun.iter().enumerate() {
            if begun[..k].iter().all(|p| p.name != phase.name) {
                let (label, text) = times(begun, phase);
                found.edit(&format!("phases.{k}.start"), |q| {
                    q.sentence(label, text);
                });
            }
        }
        found.warn((!missed.is_empty()).then(|| {
            let text = format!(
                "the run ended before the phases {}; let it run longer (time.end)",
                missed.join(", ")
            );
            Warning::serious(NOT_REACHED, text)
        }));
    }
}
