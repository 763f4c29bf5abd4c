//! The file of a fit.

use crate::changes::Changes;
use crate::factor::{Factor, Values};
use crate::runs::stored::Limits;
use crate::spec::{
    CaseKeys, RangeScale, Spec, SpecFile, check_runs, ends, one, one_percent, seconds,
};
use fretwork_scene::invisible_characters;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::source::{InputError, Source};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The contents of the file of a fit.
///
/// ```ron
/// (
///     tests: [
///         Curve(
///             name: "opening",
///             case: "bond_mode_1.ron",
///             measured: (file: "opening.csv", x: "opening", y: "traction", sigma: Column("uncertainty")),
///             model: (x: "1e6 * (delta - delta_start)", y: "1e-6 * P / 0.5"),
///         ),
///     ],
///     parameters: [(name: "w", key: "interfaces.all.parameters.damage.w", low: 0.01, high: 1.0, scale: Log)],
/// )
/// ```
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitSpec {
    /// Title.
    #[serde(default)]
    pub title: Option<String>,
    /// Measurements, each with the case that represents it.
    pub tests: Vec<TestSpec>,
    /// Parameters that are fitted.
    pub parameters: Vec<ParameterSpec>,
    /// Pairs of names: the first parameter is at most the second.
    #[serde(default)]
    pub order: Vec<(String, String)>,
    /// Number of seeds of each point at the start of the search, and largest number where points
    /// cannot be distinguished.
    #[serde(default = "seeds")]
    pub seeds: (u16, u16),
    /// Whether the measured specimens scatter as runs do from seed to seed: their scatter is then
    /// added to the error of the measurement.
    #[serde(default)]
    pub specimen_scatters: bool,
    /// Whether each test has the weight of a single value, for any number of its values.
    #[serde(default)]
    pub balanced: bool,
    /// Settings of the search.
    #[serde(default)]
    pub search: SearchSpec,
    /// Whether the runs at the estimate are repeated with half the step.
    #[serde(default = "yes")]
    pub half_step: bool,
    /// Threads of each run.
    #[serde(default = "one")]
    pub threads: u16,
    /// Largest fraction of steps that may miss the tolerance in an accepted run.
    #[serde(default = "one_percent")]
    pub unconverged: f64,
    /// Largest energy residual, relative to the largest energy, of an accepted run.
    #[serde(default = "one_percent")]
    pub residual: f64,
}

/// A test: a measurement and the corresponding output of a case.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum TestSpec {
    /// A measured curve.
    Curve {
        /// Name of the test.
        name: String,
        /// The case, relative to the file of the fit.
        case: PathBuf,
        /// Changes of its runs, `key.path=value`; `${...}` in a value is computed from the
        /// parameters, by their names.
        #[serde(default)]
        set: Vec<String>,
        /// The measured curve.
        measured: MeasuredSpec,
        /// The computed curve, from columns of `statistics.csv`.
        model: ModelSpec,
    },
    /// A measured number.
    Value {
        /// Name of the test.
        name: String,
        /// The case, relative to the file of the fit.
        case: PathBuf,
        /// Changes of its runs, `key.path=value`, as for a curve.
        #[serde(default)]
        set: Vec<String>,
        /// Output: a number of `summary.json`, or `statistics.COLUMN`.
        output: String,
        /// Measured value, with a unit or in that of the output.
        measured: NumberSpec,
        /// Standard deviation of the measured value.
        sigma: NumberSpec,
    },
}

impl TestSpec {
    /// Returns name, case and changes of any test.
    pub fn common(&self) -> (&str, &Path, &[String]) {
        match self {
            Self::Curve {
                name, case, set, ..
            }
            | Self::Value {
                name, case, set, ..
            } => (name, case, set),
        }
    }
}

/// File and columns of a measured curve.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredSpec {
    /// A CSV file with headings, relative to the file of the fit.
    pub file: PathBuf,
    /// Heading of the abscissae, without unit.
    pub x: String,
    /// Heading of the values, without unit.
    pub y: String,
    /// Standard deviation of the values, which determines how closely the fit follows them.
    pub sigma: SigmaSpec,
    /// Smallest and largest abscissa that is used; all by default.
    #[serde(default)]
    pub within: Option<(f64, f64)>,
}

/// The standard deviation of measured values.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub enum SigmaSpec {
    /// A column of the file.
    Column(String),
    /// One standard deviation for all values.
    Value(f64),
    /// A share of the largest magnitude of the values.
    OfLargest(f64),
}

/// Curve of a run: expressions in the columns of `statistics.csv`; `COLUMN_start` is the value at
/// the first row that is used.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelSpec {
    /// Abscissae, in the unit of the measured ones.
    pub x: String,
    /// Values, in the unit of the measured ones.
    pub y: String,
    /// Rows that are used.
    #[serde(default)]
    pub rows: RowsSpec,
    /// Number of rows over which values are averaged, an odd number.
    #[serde(default = "one")]
    pub smooth: u16,
    /// Comparison of a curve that reverses.
    #[serde(default)]
    pub along: AlongSpec,
}

/// Rows of the statistics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub enum RowsSpec {
    /// All rows.
    #[default]
    All,
    /// Rows from a time on (s).
    From(#[serde(deserialize_with = "seconds")] f64),
    /// Rows between two times (s).
    Between(
        #[serde(deserialize_with = "seconds")] f64,
        #[serde(deserialize_with = "seconds")] f64,
    ),
    /// Rows of the last complete cycle of a friction test.
    LastCycle,
}

/// Correspondence of points of two curves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum AlongSpec {
    /// Points correspond by the abscissa, which increases.
    #[default]
    Abscissa,
    /// Points correspond by branch and abscissa, for loops: the measured loop must begin on the
    /// same branch.
    Branches,
}

/// A parameter that is fitted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterSpec {
    /// Name of the parameter.
    pub name: String,
    /// Key, or keys, of all cases that take the value of the parameter; empty for a parameter that
    /// is used by its name in `set` of the tests.
    #[serde(default)]
    pub key: CaseKeys,
    /// Lower limit, with a unit or in SI units.
    pub low: NumberSpec,
    /// Upper limit.
    pub high: NumberSpec,
    /// Distribution of its values.
    #[serde(default)]
    pub scale: RangeScale,
    /// Unit for display; by default that of the limits in SI.
    #[serde(default)]
    pub unit: String,
}

impl ParameterSpec {
    /// Returns the limits in SI units, with the symbol of their unit. A file is refused if they
    /// have none.
    fn ends(&self) -> (f64, f64, String) {
        let none = (f64::NAN, f64::NAN, String::new());
        ends(&self.low, &self.high).unwrap_or(none)
    }

    /// Returns the limits in SI units.
    pub fn limits(&self) -> [f64; 2] {
        let (low, high, _) = self.ends();
        [low, high]
    }

    /// Returns the unit for display.
    pub fn shown_unit(&self) -> String {
        match self.unit.as_str() {
            "" => self.ends().2,
            own => own.to_owned(),
        }
    }

    /// Returns the parameter as a factor.
    pub fn factor(&self) -> Factor {
        let (low, high, unit) = self.ends();
        Factor {
            name: self.name.clone(),
            keys: self.key.0.clone(),
            unit: self.shown_unit(),
            values: Values::Range {
                scale: self.scale.between(low, high),
                levels: None,
                unit,
            },
        }
    }
}

/// Settings of the search.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SearchSpec {
    /// Number of points of the initial Latin hypercube; 10 for each parameter by default.
    pub points: Option<u32>,
    /// Number of points of a generation; by default from the number of parameters.
    pub population: Option<u32>,
    /// Largest number of generations.
    pub generations: u32,
    /// Seed of the search.
    pub seed: u64,
}

impl Default for SearchSpec {
    fn default() -> Self {
        Self {
            points: None,
            population: None,
            generations: 60,
            seed: 1,
        }
    }
}

fn yes() -> bool {
    true
}

fn seeds() -> (u16, u16) {
    (3, 12)
}

/// The file of a fit.
pub type FitFile = SpecFile<FitSpec>;

impl FitSpec {
    /// Returns the limits of accepted runs.
    pub fn limits(&self) -> Limits {
        Limits {
            unconverged: self.unconverged,
            residual: self.residual,
        }
    }

    /// Returns the names of the parameters.
    pub fn names(&self) -> Vec<&str> {
        self.parameters.iter().map(|p| p.name.as_str()).collect()
    }
}

impl Spec for FitSpec {
    fn check(&self, source: &Source) -> Result<(), InputError> {
        let fail = |path: &str, text: &str| Err(source.error_at(path, text));
        if self.tests.is_empty() {
            return fail("tests", "a fit has one measurement or more");
        }
        if self.parameters.is_empty() {
            return fail("parameters", "a fit seeks one parameter or more");
        }
        let names = self.names();
        let mut used = vec![false; names.len()];
        for (k, test) in self.tests.iter().enumerate() {
            let changes = Changes::parse(test.common().2, &names)
                .map_err(|(i, why)| source.error_at(&format!("tests.{k}.set.{i}"), why))?;
            for (place, used) in used.iter_mut().enumerate() {
                *used |= changes.needs(place);
            }
        }
        for (k, parameter) in self.parameters.iter().enumerate() {
            let path = format!("parameters.{k}.name");
            if let Some(reason) = invisible_characters(&parameter.name) {
                return fail(&path, &reason);
            }
            if self.parameters[..k]
                .iter()
                .any(|p| p.name == parameter.name)
            {
                return fail(&path, "two parameters have this name");
            }
            if let Err((key, why)) = ends(&parameter.low, &parameter.high) {
                return fail(&format!("parameters.{k}.{key}"), &why);
            }
            if parameter.key.0.is_empty() && !used[k] {
                return fail(
                    &path,
                    "no test uses this parameter; give it a `key` of the case, or use it as `${name}` in `set` of a test",
                );
            }
            if parameter.scale == RangeScale::Integer {
                return fail(
                    &format!("parameters.{k}.scale"),
                    "a fit seeks numbers that vary continuously: `Linear` or `Log`; whole numbers are for the factors of a study",
                );
            }
        }
        for (k, test) in self.tests.iter().enumerate() {
            if let Some(reason) = invisible_characters(test.common().0) {
                return fail(&format!("tests.{k}.name"), &reason);
            }
            if self.tests[..k]
                .iter()
                .any(|t| t.common().0 == test.common().0)
            {
                return fail(&format!("tests.{k}.name"), "two tests have this name");
            }
            if let TestSpec::Curve { model, .. } = test
                && model.smooth % 2 == 0
            {
                return fail(
                    &format!("tests.{k}.model.smooth"),
                    "the number of rows is odd, so that a value stays in its place",
                );
            }
        }
        if self.seeds.0 == 0 || self.seeds.0 > self.seeds.1 {
            return fail(
                "seeds",
                "the first number of seeds is 1 or more, the second not less",
            );
        }
        check_runs(source, self.threads, self.limits())?;
        if self.search.points == Some(0) {
            return fail("search.points", "the region has one point or more");
        }
        if self.search.population.is_some_and(|n| n < 4) {
            return fail("search.population", "a generation has 4 points or more");
        }
        Ok(())
    }
}
