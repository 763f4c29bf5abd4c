//! The file of a study.

use crate::factor::FactorSpec;
use crate::runs::launcher::Keep;
use crate::runs::stored::Limits;
use crate::spec::{Spec, SpecFile, check_runs, one, one_percent};
use fretwork_scene::source::{InputError, Source};
use serde::Deserialize;
use std::path::PathBuf;

/// A study as its file says it.
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
    /// `key.path=value` of all runs, as `--set` takes them; with `${...}` in the value what follows
    /// from the factors, by their names: `bodies.top.mass=${2 * density}`.
    #[serde(default)]
    pub set: Vec<String>,
    /// What varies.
    pub factors: Vec<FactorSpec>,
    /// At which points.
    #[serde(default)]
    pub design: DesignSpec,
    /// Seeds of each point, from the case's own upwards.
    #[serde(default = "one")]
    pub seeds: u16,
    /// Numbers that are compared: names of `summary.json`, or `statistics.COLUMN`; friction, damage
    /// and wear by default, as far as the case has them.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// Texts of `summary.json` by which runs are classified on a map, such as `fretting.regime` or
    /// `findings.layer_regime`; of a sentence what stands before its first colon, comma or
    /// semicolon.
    #[serde(default)]
    pub regimes: Vec<String>,
    /// Which files of each run are kept.
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

/// At which points of its factors a case is run.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum DesignSpec {
    /// Every combination of levels.
    #[default]
    Grid,
    /// The case as it is, and each level of each factor alone.
    OneAtATime,
    /// Points of which each factor has one in each of as many equal parts of its range.
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
    /// The rows of a CSV file, relative to the file of the study; its columns are named as factors,
    /// or are keys.
    Table {
        /// The file.
        file: PathBuf,
    },
}

/// The file of a study.
pub type StudyFile = SpecFile<StudySpec>;

impl StudySpec {
    /// Limits of accepted runs.
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
            _ if self.factors.is_empty() => fail("factors", "a study varies one factor or more"),
            _ => Ok(()),
        }
    }
}
