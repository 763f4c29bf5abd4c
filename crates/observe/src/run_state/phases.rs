//! Phases of a run.

use crate::quantity::unit::{ONE, SECOND, WORD};
use crate::quantity::{Field, Findings, Role, Topic, field, quantity};
use crate::statistics::Column;
use crate::typed::{ObserverIn, RunEndIn};
use crate::warning::{NOT_REACHED, Warning};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_core::step::control::Begun;

/// What is said of a phase that began.
const PHASE: [Field; 5] = [
    field("name", WORD, "name of the phase"),
    field("start", SECOND, "time at which it began"),
    field("first_step", ONE, "steps done before it"),
    field("end", SECOND, "time at which it ended; null while it runs"),
    field("ended_by", WORD, "what ended it"),
];

/// When a phase began and ended; of one that recurs its first and last times.
fn times(begun: &[Begun], phase: &Begun) -> (String, String) {
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
    /// Of the phases of a simulation.
    pub fn of<S: Space>(s: &Simulation<S>) -> Self {
        Self {
            any: !s.phases.is_empty(),
        }
    }
}

impl<S: Space> ObserverIn<S> for Phases {
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

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let phase = || s.state.control.phase() as f64;
        self.any.then(phase).into_iter().collect()
    }

    fn report(&self, end: &RunEndIn<'_, S>, found: &mut Findings) {
        let begun = end.simulation.state.control.begun();
        let left = end.simulation.phases.iter().skip(begun.len());
        let mut missed: Vec<&str> = left.map(|p| p.name.as_str()).collect();
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
