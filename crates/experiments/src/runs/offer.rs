//! Outputs that a case has, determined before anything runs.

use super::quantity::{Quantity, flatten, listed};
use fretwork_core::laws::Interface;
use fretwork_observe::standard::{self, Observed};
use fretwork_scene::Scene;
use fretwork_scene::build::Built;
use fretwork_scene::case::Case;
use fretwork_scene::measures::MeasureSpec;
use fretwork_store::Summary;
use serde_json::Value;

/// The outputs of a case.
#[derive(Clone, Debug)]
pub struct Offer {
    /// A summary for this kind of case, without values.
    summary: Value,
    /// Columns of the statistics.
    columns: Vec<String>,
    /// Names of its measures.
    measures: Vec<String>,
    /// Names and groups that its runs leave empty, and what the case lacks for them.
    absent: Vec<(&'static str, &'static str)>,
    /// Whether the case has bonds.
    bonded: bool,
}

const NO_TEST: &str = "the case has no friction test (`friction`)";
const NO_BONDS: &str = "no interface of the case makes bonds";
const NO_DAMAGE: &str = "no interface of the case has a damage law";
const NO_WEAR: &str = "no interface of the case has a wear law";
const OF_THE_RUN: &str = "it describes the course of the run, not a result of the case";
const NO_CIRCUIT: &str = "the case has no circuit of grains (`circuit`)";

impl Offer {
    /// The outputs of a case and its scene.
    pub fn of<S: Observed>(case: &Case, built: &Built<S>) -> Self {
        let s = &built.simulation;
        let bonds =
            |l: &Interface| l.opens() && (l.bonding_time().is_some() || l.healing.is_some());
        let bonded = s.laws.iter().any(bonds) || s.state.network.bonds_made() > 0;
        let damaged = bonded && s.laws.iter().any(Interface::damages);
        let wears = s.laws.iter().any(|l| l.wear().is_some());
        let circuit = case.circuit.is_some();
        let needs: [(&[&str], bool, &str); 10] = [
            (&["haste", "uncertainty", "energy.scale"], false, OF_THE_RUN),
            (
                &[
                    "friction_coefficient",
                    "friction_from_dissipation",
                    "peak_friction",
                    "plateau_friction",
                    "cycles",
                    "fretting",
                ],
                case.friction.is_some(),
                NO_TEST,
            ),
            (
                &["bonds", "broken", "damage_ratio", "energy.elastic"],
                bonded,
                NO_BONDS,
            ),
            (&["mean_damage", "energy.fracture"], damaged, NO_DAMAGE),
            (&["wear.Qs"], wears || circuit, NO_WEAR),
            (
                &["wear.volume_first_bodies", "wear.volume_third_body"],
                wears,
                NO_WEAR,
            ),
            (&["wear.Qe", "wear.Qw", "circuit"], circuit, NO_CIRCUIT),
            (
                &["biaxial"],
                case.biaxial.is_some(),
                "the case has no biaxial test (`biaxial`)",
            ),
            (
                &["jump"],
                case.jump.is_some(),
                "the case has no jumps over cycles (`jump`)",
            ),
            (
                &["scars"],
                !s.state.scars.is_empty(),
                "no surface of the case recedes by wear (`wears`)",
            ),
        ];
        let lacking = needs.iter().filter(|n| !n.1);
        let absent = lacking.flat_map(|(names, _, why)| names.iter().map(|n| (*n, *why)));
        Self {
            summary: serde_json::to_value(Summary::default()).unwrap_or_default(),
            columns: columns_of(case, built),
            measures: case.measures.iter().map(|m| m.name().to_owned()).collect(),
            absent: absent.collect(),
            bonded,
        }
    }

    /// Names of the default outputs: friction if the case has a friction test, the damage ratio if it has a damage law, the
    /// source flow if it has a wear law.
    pub fn usual(&self) -> Vec<&'static str> {
        let names = ["friction_coefficient", "damage_ratio", "wear.Qs"];
        let damaged = self.bonded && self.lack(&["mean_damage".to_owned()]).is_none();
        let there = names.into_iter().filter(|n| {
            let path: Vec<String> = n.split('.').map(str::to_owned).collect();
            self.lack(&path).is_none() && (*n != "damage_ratio" || damaged)
        });
        there.collect()
    }

    /// What the case lacks for an output.
    fn lack(&self, path: &[String]) -> Option<&'static str> {
        let name = path.join(".");
        let below = |group: &str| {
            let rest = name.strip_prefix(group);
            rest.is_some_and(|r| r.is_empty() || r.starts_with('.'))
        };
        self.absent.iter().find(|a| below(a.0)).map(|a| a.1)
    }

    /// The names of the outputs in the summary.
    fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        flatten(&self.summary, "", &mut names);
        names.retain(|n| self.lack(std::slice::from_ref(n)).is_none());
        names.extend(self.measures.iter().map(|m| format!("measures.{m}")));
        names
    }

    /// Checks that runs of the case have an output.
    ///
    /// # Errors
    /// A sentence that says what the case lacks, with the nearest name and the existing ones.
    pub fn check(&self, output: &Quantity) -> Result<(), String> {
        if let Some(column) = output.column_name() {
            return if self.columns.iter().any(|c| c == column) {
                Ok(())
            } else {
                Err(output.unknown(&self.columns, "statistics.", column))
            };
        }
        let path = output.summary_path().unwrap_or_default();
        let unknown = || Err(output.unknown(&self.names(), "", &output.name));
        if let Some(why) = self.lack(path) {
            return Err(format!(
                "{why}, so there is nothing to compare; {}",
                listed(&self.names(), "")
            ));
        }
        if path.first().is_some_and(|p| p == "measures") {
            let measures: Vec<&str> = self.measures.iter().map(String::as_str).collect();
            return match output.measured(&measures) {
                true => Ok(()),
                false => unknown(),
            };
        }
        let mut at = &self.summary;
        for part in path {
            match at {
                // Filled by a run only; checked later on a run of two steps.
                Value::Null | Value::Array(_) => return Ok(()),
                Value::Object(map) if map.is_empty() => return Ok(()),
                _ => match at.get(part) {
                    Some(next) => at = next,
                    None => return unknown(),
                },
            }
        }
        match at {
            Value::Number(_) | Value::Null => Ok(()),
            Value::Object(_) | Value::Array(_) => Err(format!(
                "it is not a number but a group; name one of its entries, as {}.NAME",
                output.name
            )),
            _ => unknown(),
        }
    }
}

/// Names of the columns of the statistics of a case.
pub fn columns(case: &Case, scene: &Scene) -> Vec<String> {
    match scene {
        Scene::Dim2(built) => columns_of(case, built),
        Scene::Dim3(built) => columns_of(case, built),
    }
}

fn columns_of<S: Observed>(case: &Case, built: &Built<S>) -> Vec<String> {
    let observers = standard::observers(case, &built.simulation, 0.0);
    observers.columns().into_iter().map(|c| c.name).collect()
}

/// Names of the measures of a case.
pub fn measure_names(case: &Case) -> Vec<&str> {
    case.measures.iter().map(MeasureSpec::name).collect()
}
