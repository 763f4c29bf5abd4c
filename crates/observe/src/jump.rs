//! Report on jumps over cycles.

use super::figures;
use super::output::Output;
use super::quantity::unit::{ONE, VOLUME, WORD};
use super::quantity::{Field, Findings, Role, Schema, Topic, field};
use super::statistics::Column;
use super::warning::{NOT_REACHED, Warning};
use crate::observer::{Observer, RunEnd};
use fretwork_core::process::jump::Jumps;
pub use fretwork_core::process::jump::{Jump, JumpPoint, JumpSummary};
use fretwork_core::view::RunView;

/// Observes the jumps over cycles, which are a process of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct CycleJumps;

impl CycleJumps {
    /// Files of its figures.
    pub const FIGURES: [&str; 1] = ["jump.png"];
}

impl Observer for CycleJumps {
    fn name(&self) -> String {
        "cycle jumps".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        vec![Column::new("cycles", "", "cycles with those jumped over")]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let jumps = run.process::<Jumps>();
        vec![jumps.map_or(f64::NAN, |j| j.cycles_at(run.time()))]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let Some(jump) = end.simulation.jump_summary() else {
            // The process is not installed yet.
            report_none(found);
            return found.edit("jump", |q| q.lacks = None);
        };
        found.begin(Topic::Wear, Role::Detail);
        found.fields("jump", &jump, &FIELDS, "jumps over cycles");
        found.edit("jump.error_estimate", |q| {
            q.secondary("error of the jumps");
            q.sentence("cycle jump", sentence(&jump));
        });
        found.warn(warnings(&jump));
        found.keep(jump);
    }

    fn file_names(&self) -> Vec<String> {
        Self::FIGURES.map(str::to_owned).to_vec()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let jumps = end.simulation.jump_summary();
        let charts = |jumps| figures::jump::charts(&jumps, end.simulation.dimension());
        jumps.map(charts).into_iter().collect()
    }

    fn set_end(&mut self, _: f64, later: bool) -> Result<(), &'static str> {
        match later {
            true => Err("the lengths of its cycle jumps depend on the end of the run"),
            false => Ok(()),
        }
    }
}

/// Relative change of the work per cycle over a jump above which the jump may have passed into
/// another state.
const CHANGED: f64 = 0.2;

/// Fields of a checked jump, and of the state at the end of a computed cycle.
const JUMP: [Field; 4] = [
    field(
        "after",
        ONE,
        "cycles before the jump, including those jumped over",
    ),
    field("cycles", ONE, "cycles that its computed cycle represents"),
    field(
        "error",
        ONE,
        "error of the jump, relative to what it added and to the scar at the end",
    ),
    field(
        "work_change",
        ONE,
        "relative change of the work of a cycle over the jump",
    ),
];
const POINT: [Field; 4] = [
    field("cycles", ONE, "cycles so far, including those jumped over"),
    field(
        "cycle_multiplier",
        ONE,
        "cycles that the last one represents",
    ),
    field("wear_volume", VOLUME, "volume worn off first bodies"),
    field("mean_damage", ONE, "mean damage of the bonds"),
];

/// Fields of the summary of the jumps.
const FIELDS: [Field; 10] = [
    field("computed_cycles", ONE, "completed computed cycles"),
    field("represented_cycles", ONE, "cycles that they represent"),
    field("asked_cycles", ONE, "cycles that the case asks for"),
    field("tolerance", ONE, "error of a jump that is aimed at"),
    field(
        "error_estimate",
        ONE,
        "estimated error of all jumps, relative to the wear or the growth of damage, whichever is worse",
    ),
    field(
        "unchecked_cycles",
        ONE,
        "cycles of a jump that the run ended before it was checked",
    ),
    field(
        "not_jumped",
        WORD,
        "variables of laws that advance with the computed cycles only",
    ),
    field(
        "wear_volume",
        VOLUME,
        "volume worn off first bodies over all cycles",
    ),
    Field {
        name: "jumps",
        doc: "checked jumps",
        schema: Schema::ListOfParts(&JUMP),
    },
    Field {
        name: "points",
        doc: "states after the computed cycles",
        schema: Schema::ListOfParts(&POINT),
    },
];

/// Marks the results that cases without jumps do not have.
pub(crate) fn report_none(found: &mut Findings) {
    found.begin(Topic::Wear, Role::Detail);
    let none = None::<JumpSummary>;
    found.fields("jump", &none, &FIELDS, "jumps over cycles; null without");
    found.edit("jump", |q| {
        q.lacks("the case has no jumps over cycles (`jump`)");
    });
}

/// Returns the sentence for the terminal.
fn sentence(jump: &JumpSummary) -> String {
    let longest = jump.jumps.iter().map(|j| j.cycles).max().unwrap_or(0);
    format!(
        "{} cycles from {} computed ones, {} jumps of at most {longest}; {}",
        jump.represented_cycles,
        jump.computed_cycles,
        jump.jumps.len(),
        match jump.error_estimate {
            Some(e) => format!("estimated error {:.1} %", 100.0 * e),
            None => "error unknown".to_owned(),
        }
    )
}

/// Returns warnings where the error estimate of the jumps does not hold.
pub fn warnings(jump: &JumpSummary) -> Vec<Warning> {
    let mut list = Vec::new();
    if !jump.not_jumped.is_empty() {
        let text = format!(
            "{} are not extrapolated by the jumps; compare with a run of smaller jump.at_most",
            jump.not_jumped.join(", ")
        );
        list.push(Warning::note("NOT JUMPED", text));
    }
    if jump.error_estimate.is_none() && !jump.jumps.is_empty() {
        let text = "the error of the jumps cannot be related to a growth; compare with a run of smaller jump.at_most";
        list.push(Warning::serious("JUMP ERROR UNKNOWN", text));
    }
    if jump.unchecked_cycles > 0 {
        let text = format!(
            "the run ended in or just after a jump of {} cycles, which is not checked",
            jump.unchecked_cycles
        );
        list.push(Warning::serious("NOT CHECKED", text));
    }
    let changed = jump.jumps.iter().filter(|j| j.work_change > CHANGED);
    if let Some(worst) = changed
        .clone()
        .max_by(|a, b| a.work_change.total_cmp(&b.work_change))
    {
        let text = format!(
            "over {} jumps the work of a cycle changes by more than {:.0} %, over that after cycle {} by {:.0} %: the estimate does \
             not hold; make jump.at_most smaller, and see whether the change stays",
            changed.count(),
            100.0 * CHANGED,
            worst.after,
            100.0 * worst.work_change
        );
        list.push(Warning::serious("CYCLES CHANGE", text));
    }
    let far = |j: &&Jump| j.error > 2.0 * jump.tolerance;
    if let Some(worst) = jump
        .jumps
        .iter()
        .filter(far)
        .max_by(|a, b| a.error.total_cmp(&b.error))
    {
        let count = jump.jumps.iter().filter(far).count();
        let text = format!(
            "{count} jumps have an error above twice jump.tolerance, the one of {} cycles after cycle {} of {:.1} %; \
             make jump.at_most smaller, or jump.after larger",
            worst.cycles,
            worst.after,
            100.0 * worst.error
        );
        list.push(Warning::serious("JUMPS TOO LONG", text));
    }
    if let Some(asked) = jump.asked_cycles.filter(|n| *n > jump.represented_cycles) {
        let text = format!(
            "the run ended at cycle {} of {asked}; let it run longer (time.end)",
            jump.represented_cycles
        );
        list.push(Warning::serious(NOT_REACHED, text));
    }
    list
}
