//! Common parts of the files of studies and fits: reading them, keys of a case, distribution of
//! numbers in a range, and limits of accepted runs.

use crate::runs::stored::Limits;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::source::{InputError, Source};
use fretwork_scene::units;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// The file of a study or a fit, with its text for the location of errors.
#[derive(Debug)]
pub struct SpecFile<T> {
    /// Contents of the file.
    pub spec: T,
    /// Text of the file.
    pub source: Source,
    /// Path of the file.
    pub path: PathBuf,
}

/// Checks of a file beyond its syntax.
pub trait Spec: DeserializeOwned {
    /// Checks everything that can be checked without a case.
    ///
    /// # Errors
    /// Returns an error at the invalid key.
    fn check(&self, source: &Source) -> Result<(), InputError>;
}

impl<T: Spec> SpecFile<T> {
    /// Reads a file, RON, JSON or YAML by the ending of its name, and checks everything that can be
    /// checked without a case. Numbers may have units, `low: 5 um`, where the file gives values of
    /// a case.
    ///
    /// # Errors
    /// Returns an error with file, line and column.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let mut source = Source::read_as::<T>(path)?;
        source.pair_quantities()?;
        let spec: T = source.parse()?;
        spec.check(&source)?;
        Ok(Self {
            spec,
            source,
            path: path.to_owned(),
        })
    }

    /// Returns a path given in the file, which is relative to it.
    pub fn beside(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }
}

/// One key of a case or several.
#[derive(Debug, Default)]
pub struct CaseKeys(pub Vec<String>);

impl<'de> Deserialize<'de> for CaseKeys {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;
        impl<'de> serde::de::Visitor<'de> for OneOrMany {
            type Value = CaseKeys;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a key of the case, or a list of keys")
            }

            fn visit_str<E: serde::de::Error>(self, key: &str) -> Result<CaseKeys, E> {
                Ok(CaseKeys(vec![key.to_owned()]))
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                mut list: A,
            ) -> Result<CaseKeys, A::Error> {
                let mut keys = Vec::new();
                while let Some(key) = list.next_element()? {
                    keys.push(key);
                }
                Ok(CaseKeys(keys))
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}

/// Distribution of the numbers in a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum RangeScale {
    /// Evenly spaced.
    #[default]
    Linear,
    /// Evenly spaced logarithms.
    Log,
    /// Whole numbers.
    Integer,
}

/// Checks the threads of a run and the limits of accepted runs.
///
/// # Errors
/// Returns an error at the invalid key.
pub fn check_runs(source: &Source, threads: u16, limits: Limits) -> Result<(), InputError> {
    if threads == 0 {
        return Err(source.error_at("threads", "a run has one thread or more"));
    }
    for (key, limit) in [
        ("unconverged", limits.unconverged),
        ("residual", limits.residual),
    ] {
        if !(0.0..=1.0).contains(&limit) {
            return Err(source.error_at(key, "a number from 0 to 1 is expected"));
        }
    }
    Ok(())
}

/// Returns the ends of a range in SI units, with the symbol of their unit there. An end without a
/// unit is in SI units.
///
/// # Errors
/// Returns the field at fault and why: a unit is unknown, or the two are of different dimensions.
pub fn ends(low: &NumberSpec, high: &NumberSpec) -> Result<(f64, f64, String), (String, String)> {
    let si = |key: &str, number: &NumberSpec| {
        let unit = number.unit.as_deref().unwrap_or_default();
        units::in_si(number.value, unit).map_err(|e| (key.to_owned(), e.message))
    };
    let ((from, of_low), (to, of_high)) = (si("low", low)?, si("high", high)?);
    let unit = if of_low.is_empty() { &of_high } else { &of_low };
    if !of_high.is_empty()
        && let Err(e) = units::convert(1.0, &of_high, unit)
    {
        return Err(("high".to_owned(), e.message));
    }
    Ok((from, to, unit.clone()))
}

/// Reads a time (s), which may have a unit.
///
/// # Errors
/// The value is no number, or its unit is not that of a time.
pub fn seconds<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let number = NumberSpec::deserialize(deserializer)?;
    let unit = number.unit.as_deref().unwrap_or_default();
    units::convert(number.value, unit, "s").map_err(|e| serde::de::Error::custom(e.message))
}

/// Returns the default of one thread, or one seed.
pub fn one() -> u16 {
    1
}

/// The limit of accepted runs by default.
pub fn one_percent() -> f64 {
    0.01
}
