//! The file of a study.

use super::law_table::LawTableSpec;
use crate::factor::FactorSpec;
use crate::runs::launcher::Keep;
use crate::runs::stored::Limits;
use crate::spec::{Spec, SpecFile, check_runs, one, one_percent};
use fretwork_scene::source::{InputError, Source};
use serde::Deserialize;
use std::path::PathBuf;

/// A study as given in its file.
///
/// ```ron
/// (
///     case: "../cases/plane_shear.ron",
///     factors: [
///         Values(name: "friction", key: "interfaces.grains.parameters.contact.mu", values: [0.2, 0.4]),
///         Range(name: "speed", key: "phases.shear.drives.top.x.to", low: 0.1, high: 1.0, scale: Log, levels: 3),
///     ],
///     seeds: 3,
///     outputs: ["measures.bulk_mu"],
/// )
/// ```
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// Title; that of the case by default.
    #[serde(default)]
    pub title: Option<String>,
    /// The case, relative to the file of the study.
    pub case: PathBuf,
    /// Changes of all runs, `key.path=value`, as `--set` takes them; `${...}` in a value is
    /// computed from the factors, by their names: `bodies.top.mass=${2 * density}`.
    #[serde(default)]
    pub set: Vec<String>,
    /// Factors.
    pub factors: Vec<FactorSpec>,
    /// Design: the points at which runs are made.
    #[serde(default)]
    pub design: DesignSpec,
    /// Number of seeds of each point, from the case's own upwards.
    #[serde(default = "one")]
    pub seeds: u16,
    /// Numbers that are compared: names of `summary.json`, or `statistics.COLUMN`; by default
    /// friction, damage and wear, as far as the case has them.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// Texts of `summary.json` by which runs are classified on a map, such as `fretting.regime` or
    /// `findings.layer_regime`; of a sentence the part before its first colon, comma or semicolon
    /// is used.
    #[serde(default)]
    pub regimes: Vec<String>,
    /// Tables of the laws `tabulated` that are made of the runs.
    #[serde(default)]
    pub table: Option<LawTableSpec>,
    /// Files of each run that are kept.
    #[serde(default)]
    pub keep: Keep,
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

/// Points of its factors at which a case is run.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum DesignSpec {
    /// Every combination of levels.
    #[default]
    Grid,
    /// The case itself, and each level of each factor separately.
    OneAtATime,
    /// Points of a Latin hypercube: each factor has one value in each of as many equal parts of its
    /// range.
    LatinHypercube {
        /// Number of points.
        points: u32,
        /// Seed of the design.
        #[serde(default)]
        seed: u64,
    },
    /// Points of a scrambled Sobol sequence; more points continue it.
    Sobol {
        /// Number of points, best a power of two.
        points: u32,
        /// Seed of the design.
        #[serde(default)]
        seed: u64,
    },
    /// Points for Sobol indices: `points` times the number of factors plus two.
    Sensitivity {
        /// Number of base points, best a power of two.
        points: u32,
        /// Seed of the design.
        #[serde(default)]
        seed: u64,
    },
    /// The rows of a CSV file, relative to the file of the study; its columns are names of factors,
    /// or keys.
    Table {
        /// The file.
        file: PathBuf,
    },
}

/// The file of a study.
pub type StudyFile = SpecFile<StudySpec>;

impl StudySpec {
    /// Returns the limits of accepted runs.
    pub fn limits(&self) -> Limits {
        Limits {
            unconverged: self.unconverged,
            residual: self.residual,
        }
    }
}

impl Spec for StudySpec {
    fn check(&self, source: &Source) -> Result<(), InputError> {
        let fail = |path: &str, text: &str| Err(source.error_at(path, text));
        if self.seeds == 0 {
            return fail("seeds", "a point has one seed or more");
        }
        check_runs(source, self.threads, self.limits())?;
        match self.design {
            DesignSpec::LatinHypercube { points, .. }
            | DesignSpec::Sobol { points, .. }
            | DesignSpec::Sensitivity { points, .. }
                if points == 0 || points > 1_000_000 =>
            {
                fail("design", "the number of points is 1 to 1,000,000")
            }
            DesignSpec::Table { .. } => Ok(()),
            _ if self.factors.is_empty() && self.seeds < 2 => fail(
                "factors",
                "a study varies one factor or more, or has several `seeds`",
            ),
            _ => Ok(()),
        }
    }
}
