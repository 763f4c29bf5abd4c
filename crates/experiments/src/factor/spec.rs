//! Factors in the file of a study.

use super::{Factor, Level, Values};
use crate::spec::{CaseKeys, RangeScale};
use fretwork_math::design::scale::Scale;
use fretwork_scene::source::Source;
use fretwork_scene::{InputError, invisible_characters};
use ron::value::RawValue;
use serde::Deserialize;

/// A factor in the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FactorSpec {
    /// A key of the case with listed values.
    Values {
        /// Name in tables and figures; the key by default.
        #[serde(default)]
        name: Option<String>,
        /// The key, or several keys with the same value; empty for a factor that is used by its
        /// name in `set`.
        #[serde(default)]
        key: CaseKeys,
        /// Values, as a case has them.
        values: Vec<Box<RawValue>>,
        /// SI unit of a factor without a key.
        #[serde(default)]
        unit: Option<String>,
    },
    /// A key of the case with a range of numbers.
    Range {
        /// Name in tables and figures; the key by default.
        #[serde(default)]
        name: Option<String>,
        /// The key, or several keys with the same value; empty for a factor that is used by its
        /// name in `set`.
        #[serde(default)]
        key: CaseKeys,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
        /// Distribution of the numbers.
        #[serde(default)]
        scale: RangeScale,
        /// Number of values, from end to end, where the design consists of levels.
        #[serde(default)]
        levels: Option<u16>,
        /// SI unit of a factor without a key.
        #[serde(default)]
        unit: Option<String>,
    },
    /// Named sets of changes, such as laws with their parameters.
    Options {
        /// Name in tables and figures.
        name: String,
        /// The alternatives.
        options: Vec<OptionSpec>,
    },
}

/// One alternative.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OptionSpec {
    /// Name of the alternative.
    pub name: String,
    /// Changes `key.path=value`; empty for the case itself.
    #[serde(default)]
    pub set: Vec<String>,
}

/// An invalid field of a factor: the end of the path of its key in the file, and the reason.
type Wrong = (String, String);

impl FactorSpec {
    /// Returns the factor that is at `path` of the file.
    ///
    /// # Errors
    /// A range is empty, a value is given twice, or there are no values.
    pub fn factor(&self, source: &Source, path: &str) -> Result<Factor, InputError> {
        let (name, keys, unit) = match self {
            Self::Values {
                name, key, unit, ..
            }
            | Self::Range {
                name, key, unit, ..
            } => (name.as_ref().or(key.0.first()), key.0.clone(), unit.clone()),
            Self::Options { name, .. } => (Some(name), Vec::new(), None),
        };
        let name = name.ok_or_else(|| {
            source.error_at(
                path,
                "a factor has a `key` of the case, or a `name` for use in `set`",
            )
        })?;
        let options = matches!(self, Self::Options { .. });
        if let Some(reason) = invisible_characters(name).filter(|_| !options) {
            return Err(source.error_at(path, reason));
        }
        let values = self.values(&keys);
        Ok(Factor {
            values: values.map_err(|(key, why)| source.error_at(&format!("{path}{key}"), why))?,
            name: name.clone(),
            keys,
            unit: unit.unwrap_or_default(),
        })
    }

    fn values(&self, keys: &[String]) -> Result<Values, Wrong> {
        let wrong = |key: &str, why: &str| Err((key.to_owned(), why.to_owned()));
        match self {
            Self::Values { values, .. } => {
                if values.is_empty() {
                    return wrong(".values", "a factor takes one value or more");
                }
                let texts: Vec<&str> = values.iter().map(|v| v.get_ron().trim()).collect();
                let listed: Vec<Level> = texts.iter().map(|t| Level::of(keys, t)).collect();
                match repeated(&listed, Level::equals) {
                    None => Ok(Values::Listed(listed)),
                    Some((first, k)) if texts[first] == texts[k] => Err((
                        format!(".values.{k}"),
                        format!("{} is given twice", texts[k]),
                    )),
                    Some((first, k)) => Err((
                        format!(".values.{k}"),
                        format!("{} and {} are the same value", texts[first], texts[k]),
                    )),
                }
            }
            Self::Range {
                low,
                high,
                scale,
                levels,
                ..
            } => {
                if *scale == RangeScale::Integer && (low.fract() != 0.0 || high.fract() != 0.0) {
                    return wrong(".low", "a range of whole numbers has whole ends");
                }
                let scale = scale.between(*low, *high);
                scale
                    .check()
                    .map_err(|e| (".low".to_owned(), e.to_string()))?;
                if levels.is_some_and(|n| n < 2) {
                    return wrong(".levels", "a range has two levels or more, its ends");
                }
                Ok(Values::Range {
                    scale,
                    levels: *levels,
                })
            }
            Self::Options { options, .. } => {
                if options.is_empty() {
                    return wrong(".options", "a factor has one option or more");
                }
                if let Some((_, k)) = repeated(options, |a, b| a.name == b.name) {
                    let why = format!("`{}` is given twice", options[k].name);
                    return Err((format!(".options.{k}.name"), why));
                }
                let levels = options.iter().map(|o| Level::named(&o.name, o.set.clone()));
                Ok(Values::Listed(levels.collect()))
            }
        }
    }
}

/// Returns the positions of the first two equal elements.
fn repeated<T>(list: &[T], same: impl Fn(&T, &T) -> bool) -> Option<(usize, usize)> {
    let first = |k: usize| (0..k).find(|&i| same(&list[i], &list[k]));
    (1..list.len()).find_map(|k| Some((first(k)?, k)))
}

impl RangeScale {
    /// Returns the scale of a range between these ends.
    pub fn between(self, low: f64, high: f64) -> Scale {
        match self {
            Self::Linear => Scale::Linear {
                from: low,
                to: high,
            },
            Self::Log => Scale::Logarithmic {
                from: low,
                to: high,
            },
            Self::Integer => Scale::Integer {
                from: low as i64,
                to: high as i64,
            },
        }
    }
}
