//! The runs of a study, numbered from 1: settings in the order of the design, each with its seeds.

use super::design::{Setting, settings};
use super::law_table::LawTable;
use super::spec::{DesignSpec, StudyFile};
use crate::changes::Changes;
use crate::factor::{AS_IN_THE_CASE, Factor, Level, Values};
use crate::runs::available::AvailableQuantities;
use crate::runs::launcher::{Launcher, Run};
use crate::runs::output::OutputName;
use crate::{Error, RunSetup, build, load};
use fretwork_core::laws::SearchPath;
use fretwork_scene::inputs::{self, Input};
use fretwork_scene::units::convert;
use fretwork_scene::{Built, InputError, LoadedCase};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Largest number of levels whose case is built before a run; if there are more, only the text is
/// checked.
const BUILT: usize = 60;

/// A run of a study.
#[derive(Clone, Debug)]
pub struct Point {
    /// Number of the run, from 1.
    pub number: usize,
    /// Number of the setting, from 1.
    pub setting: usize,
    /// The run.
    pub run: Run,
}

/// A study whose runs are known.
#[derive(Debug)]
pub struct Plan {
    /// Title.
    pub title: String,
    /// The file of the study.
    pub file: PathBuf,
    /// Folder of the results.
    pub out: PathBuf,
    /// Factors.
    pub factors: Vec<Factor>,
    /// One value of each factor, for each setting.
    pub settings: Vec<Setting>,
    /// Changes computed from the factors, for each setting.
    derived: Vec<Vec<String>>,
    units: Vec<String>,
    /// Seeds of each setting.
    pub seeds: Vec<u64>,
    /// Whether the seed changes the scene.
    pub random: bool,
    /// Outputs that are compared.
    pub outputs: Vec<OutputName>,
    /// SI units of the outputs by the case, `1` for pure numbers; empty where only runs have them.
    pub output_units: Vec<String>,
    /// Texts of the summary that are mapped as regimes.
    pub regimes: Vec<String>,
    /// Tables of laws that are made.
    pub law_table: Option<LawTable>,
    /// Design of the study.
    pub design: DesignSpec,
    /// Launcher of the runs.
    pub launcher: Launcher,
    /// The case with the changes of all runs.
    pub base: LoadedCase,
    known: StudyFacts,
}

/// Stored results of the preparation of a study, so that each of its points need not repeat it.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
struct StudyFacts {
    /// Keys of the case and of the program, and text of the study.
    fingerprint: String,
    random: bool,
    outputs: Vec<String>,
    /// SI units of the outputs.
    units: Vec<String>,
}

/// Name of the file with these results.
const KNOWN: &str = "study.json";

impl StudyFacts {
    fn read(file: &Path) -> Option<Self> {
        serde_json::from_str(&std::fs::read_to_string(file).ok()?).ok()
    }
}

/// Folders of a study.
#[derive(Debug)]
pub struct Location<'a> {
    /// Folder of its results.
    pub out: &'a Path,
    /// Folder of its runs, which other studies may share; by default `runs` in the folder of the
    /// results.
    pub cache: Option<&'a Path>,
    /// Laws, plugins and observers of the runs.
    pub setup: &'a RunSetup,
}

impl Plan {
    /// Plans a study. Results that take long are read from `study.json` in its folder, if
    /// [`keep`](Self::keep) wrote them.
    ///
    /// # Errors
    /// The study or its case is invalid, or the case refuses an output or a level.
    pub fn new(read: &StudyFile, place: Location<'_>) -> Result<Self, Error> {
        let spec = &read.spec;
        let case = read.beside(&spec.case);
        let mut factors = Vec::new();
        for (k, factor) in spec.factors.iter().enumerate() {
            factors.push(factor.factor(&read.source, &format!("factors.{k}"))?);
        }
        let fixed = spec.set.iter().filter(|set| !Changes::depends(set));
        let base = load(&case, &fixed.cloned().collect::<Vec<_>>())?;
        let inputs = inputs::of(base.source.text()).unwrap_or_default();
        let own = |factor: &Factor| own_value(factor, &inputs);
        let settings = settings(read, &mut factors, own)?;
        let units = units(read, &factors, &inputs)?;
        let names: Vec<&str> = factors.iter().map(|f| f.name.as_str()).collect();
        let refused = |why: String| read.source.error_at("set", why);
        let changes = Changes::parse(&spec.set, &names).map_err(|(_, why)| refused(why))?;
        let derived = settings.iter().map(|setting| {
            let numbers: Vec<Option<f64>> = setting.iter().map(|v| v.number).collect();
            changes.derived(&numbers)
        });
        let derived: Vec<Vec<String>> = derived.collect::<Result<_, _>>().map_err(refused)?;
        check_factors(read, &factors, &changes)?;
        let law_table = LawTable::new(read, &factors, &units, &base.case)?;
        let own = place.out.join("runs");
        let folder = place.cache.unwrap_or(&own);
        let fixed = &changes.fixed;
        let mut launcher = Launcher::new(&case, fixed, place.setup, folder, spec.limits())?;
        launcher.keep = spec.keep;
        launcher.threads = spec.threads;
        let fingerprint = format!("{} {}", launcher.fingerprint(), read.source.text());
        let known = StudyFacts::read(&place.out.join(KNOWN));
        let known = match known.filter(|k| k.fingerprint == fingerprint) {
            Some(known) => known,
            None => {
                let (scene, random) = build(&base, place.setup)?;
                let first = sets_of(&settings[0], &derived[0]);
                check_levels(read, &base, &factors, &first, &place.setup.search)?;
                let (outputs, units) =
                    outputs(read, &base, &scene, law_table.as_ref(), place.setup)?;
                StudyFacts {
                    units,
                    fingerprint,
                    random,
                    outputs: outputs.iter().map(|o| o.name.clone()).collect(),
                }
            }
        };
        let first = base.case.seed;
        launcher.perturb_unless(known.random, first);
        let outputs = known.outputs.iter().map(|name| OutputName::parse(name));
        Ok(Self {
            title: spec.title.clone().unwrap_or_else(|| base.case.name.clone()),
            file: read.path.clone(),
            out: place.out.to_owned(),
            factors,
            settings,
            derived,
            units,
            regimes: spec.regimes.clone(),
            law_table,
            design: spec.design.clone(),
            seeds: (0..u64::from(spec.seeds))
                .map(|k| first.wrapping_add(k))
                .collect(),
            random: known.random,
            outputs: outputs.collect::<Result<_, _>>().map_err(Error::Usage)?,
            output_units: known.units.clone(),
            launcher,
            base,
            known,
        })
    }

    /// Writes results that took long to `study.json` in its folder, if there is one, for the next
    /// call.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn keep(&self) -> Result<(), Error> {
        let file = self.out.join(KNOWN);
        if self.out.is_dir() && StudyFacts::read(&file).as_ref() != Some(&self.known) {
            let text = serde_json::to_string_pretty(&self.known).unwrap_or_default();
            std::fs::write(&file, text).map_err(|e| Error::write(&file, &e))?;
        }
        Ok(())
    }

    /// Number of runs.
    pub fn count(&self) -> usize {
        self.settings.len() * self.seeds.len()
    }

    /// The run of a number from 1 to [`count`](Self::count).
    pub fn point(&self, number: usize) -> Option<Point> {
        let k = number.checked_sub(1).filter(|k| *k < self.count())?;
        let (setting, seed) = (k / self.seeds.len(), k % self.seeds.len());
        Some(Point {
            number,
            setting: setting + 1,
            run: Run {
                sets: sets_of(&self.settings[setting], &self.derived[setting]),
                seed: self.seeds[seed],
            },
        })
    }

    /// Iterates over all runs.
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        (1..=self.count()).filter_map(|k| self.point(k))
    }

    /// Returns the SI unit of a factor, if the case has one for its key; empty otherwise.
    pub fn unit_of(&self, factor: usize) -> String {
        self.units.get(factor).cloned().unwrap_or_default()
    }

    /// Returns the labels of a factor, in the order of its first settings.
    pub fn labels(&self, factor: usize) -> Vec<&str> {
        let mut seen = HashSet::new();
        let all = self.settings.iter().map(|s| s[factor].label.as_str());
        all.filter(|label| seen.insert(*label)).collect()
    }

    /// Returns whether all values of a factor are numbers; that of the case itself may be unknown,
    /// where it is a default that the file does not give.
    pub fn is_numeric(&self, factor: usize) -> bool {
        let levels = self.settings.iter().map(|s| &s[factor]);
        let mut given = levels.filter(|level| !level.is_unknown()).peekable();
        given.peek().is_some() && given.all(|level| level.number.is_some())
    }

    /// Describes a run: `friction 0.2, speed 1.0, seed 4`.
    pub fn words(&self, point: &Point) -> String {
        let values = self.factors.iter().zip(&self.settings[point.setting - 1]);
        let mut words: Vec<String> = values
            .map(|(f, v)| format!("{} {}", f.name, v.short()))
            .collect();
        if self.seeds.len() > 1 {
            words.push(format!("seed {}", point.run.seed));
        }
        words.join(", ")
    }
}

/// Names of the table's own columns.
const OWN_COLUMNS: [&str; 11] = [
    "point",
    "setting",
    "seed",
    "status",
    "reason",
    "not_trustworthy",
    "steps",
    "cpu_seconds",
    "wall_seconds",
    "identity",
    "folder",
];

/// The changes of a setting.
fn sets_of(setting: &Setting, derived: &[String]) -> Vec<String> {
    let own = setting.iter().flat_map(|level| &level.sets);
    own.chain(derived).cloned().collect()
}

/// Refuses two factors of the same name, names of the table's own columns, keys that a study sets,
/// and factors without effect.
fn check_factors(
    read: &StudyFile,
    factors: &[Factor],
    changes: &Changes,
) -> Result<(), InputError> {
    let twice = |k: &usize| factors[..*k].iter().any(|f| f.name == factors[*k].name);
    if let Some(k) = (1..factors.len()).find(twice) {
        let text = format!("two factors are named `{}`", factors[k].name);
        return Err(read.source.error_at(&format!("factors.{k}.name"), text));
    }
    for (k, factor) in factors.iter().enumerate() {
        let fail = |text: String| Err(read.source.error_at(&format!("factors.{k}"), text));
        let name = factor.name.as_str();
        if factor.keys.iter().any(|key| key.trim() == "seed") {
            return fail("a study sets the seed itself; for more of them give `seeds`".to_owned());
        }
        if OWN_COLUMNS.contains(&name) || read.spec.outputs.iter().any(|o| o == name) {
            return fail(format!(
                "the table has a column `{name}` already; give the factor another `name`"
            ));
        }
        let sets = factor
            .levels()
            .is_none_or(|l| l.iter().any(|v| !v.sets.is_empty()));
        if factor.keys.is_empty() && !sets && !changes.needs(k) {
            return fail(format!(
                "`{name}` changes nothing: give it a `key`, or use it as `${{{name}}}` in `set`"
            ));
        }
    }
    Ok(())
}

/// Returns the SI units of the factors: those of their keys, or where there is none those that the
/// study gives.
fn units(
    read: &StudyFile,
    factors: &[Factor],
    inputs: &[Input],
) -> Result<Vec<String>, InputError> {
    let of = |(k, factor): (usize, &Factor)| {
        let known = inputs.iter().find(|i| factor.keys.contains(&i.path));
        let known = known.map_or("", |i| i.unit);
        match (known, factor.unit.as_str()) {
            ("", own) => Ok(own.to_owned()),
            (known, own) if own.is_empty() || convert(1.0, own, known) == Ok(1.0) => {
                Ok(known.to_owned())
            }
            (known, own) => {
                let path = format!("factors.{k}.unit");
                let written = read.source.position_of(&path).is_some();
                let (path, help) = match written {
                    true => (path, "; leave the unit out"),
                    false => (format!("factors.{k}"), ""),
                };
                let why = format!("the case has its key in `{known}`, not in `{own}`{help}");
                Err(read.source.error_at(&path, why))
            }
        }
    };
    factors.iter().enumerate().map(of).collect()
}

/// Returns the value of a factor in the case, without changes.
fn own_value(factor: &Factor, inputs: &[Input]) -> Level {
    let of_key = |key: &String| inputs.iter().find(|i| i.path == *key);
    let own = factor.keys.first().and_then(of_key);
    let text = own.map_or("", |i| i.value.trim_matches('"'));
    Level {
        label: if text.is_empty() {
            AS_IN_THE_CASE.to_owned()
        } else {
            text.to_owned()
        },
        number: text.parse().ok(),
        sets: Vec::new(),
    }
}

/// Returns the requested outputs, or those that the case has, with their units; those of a table of
/// laws are checked too.
fn outputs(
    read: &StudyFile,
    base: &LoadedCase,
    scene: &Built,
    law_table: Option<&LawTable>,
    setup: &RunSetup,
) -> Result<(Vec<OutputName>, Vec<String>), Error> {
    let available = AvailableQuantities::of(base, scene, setup);
    for (key, output) in law_table.map(LawTable::outputs).unwrap_or_default() {
        let checked = available.check(&output);
        checked.map_err(|why| read.source.error_at(key, why))?;
    }
    let asked = &read.spec.outputs;
    let mut all: Vec<OutputName> = Vec::new();
    if asked.is_empty() {
        let usual = available.usual();
        let parsed: Result<Vec<OutputName>, String> =
            usual.iter().map(|name| OutputName::parse(name)).collect();
        all = parsed.map_err(Error::Usage)?;
        if all.is_empty() {
            let text = "the case has no main result to compare; name an output, such as outputs: [\"energy.kinetic\"]";
            return Err(read.source.error_at("outputs", text).into());
        }
    }
    for (k, name) in asked.iter().enumerate() {
        let refused = |why: String| read.source.error_at(&format!("outputs.{k}"), why);
        let quantity = OutputName::parse(name).map_err(refused)?;
        available.check(&quantity).map_err(refused)?;
        if all.contains(&quantity) {
            return Err(refused("it is given twice".to_owned()).into());
        }
        all.push(quantity);
    }
    let units = all.iter().map(|output| available.unit(output)).collect();
    Ok((all, units))
}

/// Reads the case with each level separately, and builds it if there are few, so that an invalid
/// level is refused before any run; then builds the first setting.
fn check_levels(
    read: &StudyFile,
    base: &LoadedCase,
    factors: &[Factor],
    first: &[String],
    search: &SearchPath,
) -> Result<(), InputError> {
    let levels = |f: &Factor| match &f.values {
        Values::Listed(values) => values.clone(),
        Values::Range { .. } => vec![f.at(0.0), f.at(1.0)],
    };
    let built = factors.iter().map(|f| levels(f).len()).sum::<usize>() <= BUILT;
    for factor in factors {
        for value in levels(factor).into_iter().filter(|v| !v.sets.is_empty()) {
            let sets = [base.source.sets(), &value.sets].concat();
            let checked = load(&base.path, &sets).and_then(|loaded| match built {
                true => loaded.build(search).map(|_| ()),
                false => Ok(()),
            });
            checked.map_err(|e| {
                e.note(format!(
                    "with `{}` = {} of {}",
                    factor.name,
                    value.label,
                    read.path.display()
                ))
            })?;
        }
    }
    load(&base.path, &[base.source.sets(), first].concat())?.build(search)?;
    Ok(())
}
