//! `summary.json`, and the text at the end of a run: the facts of a run and the results of its
//! observers.

mod brief;
mod course;
mod estimate;
mod grade;
mod lines;
mod sample;
mod sliding;
mod text;
mod time_spent;

pub use self::course::{Course, RELATIVE_RESIDUAL, residual};
pub use self::estimate::{Estimate, Uncertainty};
pub use self::grade::{Grade, HeadlineError};
pub use self::lines::{COLUMNS, cut, fitted, wrapped};
pub use self::sample::{SampleFacts, SeedScatter};
pub use self::sliding::SlidingTest;
pub use self::time_spent::TimeSpent;

use crate::quantity::unit::{ONE, SECOND, WORD};
use crate::quantity::{Field, Findings, Role, Topic, field, part, parts, quantity, values};
use crate::warning::{self, Warning};
use fretwork_scene::input_ranges::GivenRange;
use fretwork_scene::wear_coefficient::WearCoefficient;
use serde::{Serialize, Serializer};

crate::described! {
    /// A loaded plugin.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub struct PluginStamp {
        /// Kind of the law.
        pub kind: String => WORD,
        /// Name of the law.
        pub name: String => WORD,
        /// Version of the law.
        pub version: String => WORD,
        /// SHA-256 of the file at `path`.
        pub sha256: String => WORD,
        /// Path of the library, or of the program that the law is built into.
        pub path: String => WORD,
        /// Libraries that it links to and that are not the system's: path and SHA-256.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub links: Vec<String> = values(WORD),
        /// Whether it passes certification with the parameters of this run.
        pub certified: bool => WORD,
    }
}

/// JSON pointers to the values that may differ between the summaries of two runs of a case: wall
/// and processor times, and the number of threads. All others are bit-identical, see
/// `docs/checkpoints.md`.
pub const NOT_REPRODUCIBLE: [&str; 5] = [
    "/wall_seconds",
    "/cpu_seconds",
    "/time_spent",
    "/threads",
    "/circuit/cost_share",
];

crate::described! {
    /// Facts of a run, in addition to the results of its observers.
    #[derive(Clone, Debug, Default, Serialize)]
    pub struct RunFacts {
        /// Title of the case.
        pub case: String => WORD,
        /// Whether all checks passed.
        pub trustworthy: bool => WORD,
        /// Trust in three grades: `not trustworthy`, a check failed; `consistent`, the ledgers
        /// close and the steps converged; `error known`, in addition the error of the headline is
        /// known and at most 5 %.
        pub grade: Grade => WORD,
        /// The grade with that of which the error is known, the causes, and what was not studied.
        pub verdict: String => WORD,
        /// What is known of the error of the headline, and what is not.
        pub grade_sentence: String => WORD,
        /// What decides how far its numbers go.
        pub sample: SampleFacts = part::<SampleFacts>(),
        /// Reasons why it is not trustworthy, as sentences, worst first.
        pub reasons: Vec<String> = values(WORD),
        /// The reasons, followed by notes.
        pub warnings: Vec<String> = values(WORD),
        /// Identity of the run (case, materials, laws and scene), by which the results file
        /// recognises its summary.
        pub identity: String => WORD,
        /// Dimension, 2 or 3.
        pub dimension: usize => ONE,
        /// Wall time of the run.
        pub wall_seconds: f64 => SECOND,
        /// Processor time of all threads, which depends little on other programs.
        pub cpu_seconds: f64 => SECOND,
        /// What the wall time was spent on.
        pub time_spent: TimeSpent = part::<TimeSpent>(),
        /// Loaded laws.
        pub plugins: Vec<PluginStamp> = parts::<PluginStamp>(),
        /// Wear coefficients that follow from the hardness of materials; left out without any.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub wear_coefficients: Vec<WearCoefficient> = crate::quantity::Schema::ListOfParts(&COEFFICIENT),
        /// Parameters of laws from files that give a range with them; left out without any.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub given: Vec<GivenRange> = crate::quantity::Schema::ListOfParts(&GIVEN),
        /// Number of threads that the run used.
        pub threads: usize => ONE,
        /// Seed of the random numbers of the case.
        pub seed: u64 => ONE,
        /// Version of the program.
        pub version: String => WORD,
        /// Reason why the run stopped before its end; null if it did not.
        pub stopped: Option<String> => WORD,
        /// Whether a signal stopped it; it can be resumed with `--resume`.
        pub interrupted: bool => WORD,
    }
}

/// Fields of a parameter that was given with a range.
const GIVEN: [Field; 9] = [
    field("file", WORD, "file of the value, without .ron"),
    field("kind", WORD, "kind of the law"),
    field("law", WORD, "the law"),
    field("parameter", WORD, "the parameter"),
    field("value", WORD, "its value, in the unit of the law"),
    field(
        "range",
        WORD,
        "smallest and largest value in its source, in the unit of the law",
    ),
    field("unit", WORD, "unit of the law"),
    field("source", WORD, "source of the value"),
    field("keys", WORD, "keys of the case that would replace it"),
];

/// Fields of a wear coefficient.
const COEFFICIENT: [Field; 10] = [
    field(
        "interface",
        WORD,
        "interface of a wear law that was given K",
    ),
    field("law", WORD, "its wear law"),
    field("parameter", WORD, "the parameter that follows from K"),
    field("value", WORD, "its value, in the unit of the next entry"),
    field("unit", WORD, "unit of the value"),
    field("dimensionless", ONE, "Archard's coefficient K"),
    field(
        "hardness",
        crate::quantity::unit::PASCAL,
        "hardness of the softer material",
    ),
    field("softer", WORD, "the softer material"),
    field("friction", ONE, "friction coefficient, where it was used"),
    field("derivation", WORD, "the derivation in words"),
];

/// Summary of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Facts of the run.
    pub run: RunFacts,
    /// Results of the observers.
    pub found: Findings,
}

impl Summary {
    /// Adds the warnings of the observers and of the run itself; returns them, worst first.
    pub fn check(&mut self) -> Vec<Warning> {
        let run = &mut self.run;
        let mut list = self.found.warnings().to_vec();
        list.extend(run.own_warnings());
        // A stopped run did not reach later events.
        list.retain(|w| run.stopped.is_none() || w.of != warning::NOT_REACHED);
        warning::sort(&mut list);
        run.warnings = list.iter().map(Warning::to_string).collect();
        let reasons = list.iter().filter(|w| w.serious);
        run.reasons = reasons.map(Warning::to_string).collect();
        run.trustworthy = run.reasons.is_empty();
        let error = HeadlineError::of(&self.found, &run.sample);
        run.grade = match run.trustworthy {
            true => error.grade(),
            false => Grade::NotTrustworthy,
        };
        run.verdict = error.verdict(run.grade);
        run.grade_sentence = error.sentence();
        list
    }

    /// Returns all facts and results as quantities.
    pub fn quantities(&self) -> Findings {
        let mut all = Findings::new(self.run.dimension);
        all.begin(Topic::Run, Role::Diagnostic);
        all.part("", &self.run, "");
        self.run.word(&self.found, &mut all);
        for group in ["measures", "measure_units", "findings"] {
            let doc = "results of the measures of the case, by name";
            all.add(group, serde_json::Map::new(), WORD, doc);
        }
        all.extend(&self.found);
        all.edit("fretting.regime", |q| {
            q.about(Topic::Regime);
        });
        all
    }
}

impl RunFacts {
    /// Returns warnings that no observer gives.
    fn own_warnings(&self) -> Vec<Warning> {
        let stopped = self.stopped.as_ref().map(|why| match self.interrupted {
            true => Warning::serious(
                "INTERRUPTED",
                format!("{why}; the results cover the completed part, the same command with --resume continues"),
            ),
            false => Warning::serious("STOPPED", format!("{why}; the results cover the completed part")),
        });
        let wrong = self.plugins.iter().filter(|p| !p.certified);
        let names: Vec<String> = wrong
            .map(|p| format!("{} law {}", p.kind, p.name))
            .collect();
        let uncertified = (!names.is_empty()).then(|| {
            let text = format!(
                "the {} does not pass its certificate with the parameters of this run; fretwork law certify says why",
                names.join(", the ")
            );
            Warning::serious("NOT CERTIFIED", text)
        });
        stopped.into_iter().chain(uncertified).collect()
    }

    /// Sets the sentences for the terminal.
    fn word(&self, found: &Findings, all: &mut Findings) {
        for (k, p) in self.plugins.iter().enumerate() {
            let hash = &p.sha256[..12.min(p.sha256.len())];
            let certified = if p.certified {
                "certified"
            } else {
                "NOT certified"
            };
            let text = format!("{} {} {} ({hash}), {certified}", p.kind, p.name, p.version);
            all.edit(&format!("plugins.{k}.name"), |q| {
                q.sentence("law", text);
            });
        }
        for (k, w) in self.wear_coefficients.iter().enumerate() {
            let text = format!("{}, {}: {}", w.interface, w.law, w.derivation);
            all.edit(&format!("wear_coefficients.{k}.derivation"), |q| {
                q.sentence("wear coefficient", text);
            });
        }
        let text = format!(
            "fretwork {}, seed {}, {} threads, {} of processor time",
            self.version,
            self.seed,
            self.threads,
            quantity(self.cpu_seconds, "s")
        );
        all.edit("version", |q| {
            q.sentence("made with", text);
        });
        if let Some(text) = self.time_spent.sentence() {
            all.edit("time_spent.detection", |q| {
                q.sentence("time spent", text);
            });
        }
        let [steps, time] = ["steps", "time"].map(|name| found.number(name).unwrap_or(0.0));
        let rate = steps / self.wall_seconds.max(1e-9);
        let text = format!(
            "{steps} steps to t = {} in {} ({rate:.0} a second)",
            quantity(time, "s"),
            quantity(self.wall_seconds, "s")
        );
        all.edit("wall_seconds", |q| {
            q.role = Role::Secondary;
            q.sentence("run", text);
        });
    }
}

impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.quantities().serialize(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_was_stopped_reached_nothing_later_and_its_laws_are_checked() {
        let mut summary = Summary::default();
        assert!(summary.check().is_empty() && summary.run.trustworthy);
        summary.found.warn([
            Warning::note("NOT UNIQUE", "n"),
            Warning::serious(
                warning::NOT_REACHED,
                "the run ended before the phases shear",
            ),
            Warning::serious("NOT CONVERGED", "12 of 600 steps"),
        ]);
        let of = |list: &[Warning]| list.iter().map(|w| w.of).collect::<Vec<_>>();
        let expected = ["NOT CONVERGED", warning::NOT_REACHED, "NOT UNIQUE"];
        assert_eq!(of(&summary.check()), expected);
        assert_eq!(summary.run.warnings[0], "NOT CONVERGED: 12 of 600 steps");
        assert!(!summary.run.trustworthy && summary.run.reasons.len() == 2);
        summary.run.stopped = Some("no room".to_owned());
        summary.run.plugins = vec![PluginStamp {
            kind: "contact".into(),
            name: "mine".into(),
            version: String::new(),
            sha256: String::new(),
            path: String::new(),
            links: Vec::new(),
            certified: false,
        }];
        let expected = ["STOPPED", "NOT CONVERGED", "NOT CERTIFIED", "NOT UNIQUE"];
        assert_eq!(of(&summary.check()), expected);
        summary.run.interrupted = true;
        assert_eq!(summary.check()[0].of, "INTERRUPTED");
    }
}
