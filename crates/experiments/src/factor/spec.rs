//! Factors in the file of a study.

use super::{Factor, Level, Values};
use crate::spec::{CaseKeys, RangeScale, ends};
use fretwork_math::design::scale::Scale;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::quantity::si_quantity;
use fretwork_scene::source::Source;
use fretwork_scene::units::{self, UnitError};
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
        /// Values, as a case has them, with units or without.
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
        /// Lower end, with a unit or in SI units.
        low: NumberSpec,
        /// Upper end.
        high: NumberSpec,
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
        let located = |(key, why): Wrong| source.error_at(&format!("{path}{key}"), why);
        let values = self.values(&keys).map_err(located)?;
        let written = self.unit().map_err(located)?;
        let unit = match unit {
            Some(own) if !written.is_empty() => {
                let fits = units::convert(1.0, &written, &own);
                if fits.map_err(|e| located((".unit".to_owned(), e.message)))? != 1.0 {
                    let why = format!("tables have the values in SI units, in `{written}`");
                    return Err(located((".unit".to_owned(), why)));
                }
                own
            }
            own => own.unwrap_or(written),
        };
        // A name of `let` has no unit of its own: its numbers have that of the factor.
        let of_names = !keys.is_empty() && keys.iter().all(|key| key.starts_with("let."));
        let values = match values {
            Values::Listed(levels) if of_names && !unit.is_empty() => {
                let levels = levels.into_iter().map(|level| level.in_unit(&unit));
                Values::Listed(levels.collect())
            }
            Values::Range {
                scale,
                levels,
                unit: own,
            } if of_names && own.is_empty() => Values::Range {
                scale,
                levels,
                unit: unit.clone(),
            },
            values => values,
        };
        Ok(Factor {
            values,
            name: name.clone(),
            keys,
            unit,
        })
    }

    /// Returns the SI unit of the values, if they have units.
    fn unit(&self) -> Result<String, Wrong> {
        match self {
            Self::Options { .. } => Ok(String::new()),
            Self::Range { low, high, .. } => {
                let found = ends(low, high);
                Ok(found.map_err(|(key, why)| (format!(".{key}"), why))?.2)
            }
            Self::Values { values, .. } => {
                let mut unit = String::new();
                for (k, value) in values.iter().enumerate() {
                    let wrong = |e: UnitError| (format!(".values.{k}"), e.message);
                    let Some(found) = si_quantity(&unpaired(value.get_ron())) else {
                        continue;
                    };
                    let (_, own) = found.map_err(wrong)?;
                    if unit.is_empty() {
                        unit = own;
                    } else if !own.is_empty() {
                        units::convert(1.0, &own, &unit).map_err(wrong)?;
                    }
                }
                Ok(unit)
            }
        }
    }

    fn values(&self, keys: &[String]) -> Result<Values, Wrong> {
        let wrong = |key: &str, why: &str| Err((key.to_owned(), why.to_owned()));
        match self {
            Self::Values { values, .. } => {
                if values.is_empty() {
                    return wrong(".values", "a factor takes one value or more");
                }
                let texts: Vec<String> = values.iter().map(|v| unpaired(v.get_ron())).collect();
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
                let found = ends(low, high);
                let (low, high, unit) = found.map_err(|(key, why)| (format!(".{key}"), why))?;
                if *scale == RangeScale::Integer && (low.fract() != 0.0 || high.fract() != 0.0) {
                    return wrong(".low", "a range of whole numbers has whole ends");
                }
                let scale = scale.between(low, high);
                scale
                    .check()
                    .map_err(|e| (".low".to_owned(), e.to_string()))?;
                if levels.is_some_and(|n| n < 2) {
                    return wrong(".levels", "a range has two levels or more, its ends");
                }
                Ok(Values::Range {
                    scale,
                    levels: *levels,
                    unit,
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

/// Returns the text of a value as it was written: numbers with units, which the reader of the file
/// made into pairs, `(value: 5, unit: "um")`, are `5 um` again.
fn unpaired(text: &str) -> String {
    const PAIR: [&str; 3] = ["(value: ", ", unit: \"", "\")"];
    let mut out = String::new();
    let mut rest = text.trim();
    while let Some((before, after)) = rest.split_once(PAIR[0]) {
        let pair = after.split_once(PAIR[1]);
        let pair = pair.filter(|(number, _)| number.parse::<f64>().is_ok());
        out += before;
        let whole = pair.and_then(|(number, tail)| Some((number, tail.split_once(PAIR[2])?)));
        match whole.filter(|(_, (unit, _))| !unit.contains('"')) {
            Some((number, (unit, tail))) => {
                out += number;
                if unit != "1" {
                    out += &format!(" {unit}");
                }
                rest = tail;
            }
            None => {
                out += PAIR[0];
                rest = after;
            }
        }
    }
    out + rest
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_become_the_numbers_as_written() {
        for (text, written) in [
            ("(value: 5, unit: \"um\")", "5 um"),
            (" [(value: 0, unit: \"m/s\"), 1] ", "[0 m/s, 1]"),
            (
                "Force(Constant((value: -5e2, unit: \"kN\")))",
                "Force(Constant(-5e2 kN))",
            ),
            (
                "(value: 5, unit: \"um\", source: \"a\")",
                "(value: 5, unit: \"um\", source: \"a\")",
            ),
            ("\"sand\"", "\"sand\""),
            ("0.3", "0.3"),
        ] {
            assert_eq!(unpaired(text), written);
        }
    }

    #[test]
    fn values_and_ends_have_units() {
        let factor = |text: &str| {
            let mut source = Source::from_text("study.ron", text);
            source.pair_quantities()?;
            source.parse::<FactorSpec>()?.factor(&source, "")
        };
        let listed =
            factor(r#"Values(name: "d", key: "a.b", values: [5um, 10 um, 2e-5])"#).unwrap();
        let numbers = listed
            .levels()
            .unwrap()
            .into_iter()
            .map(|l| l.number.unwrap());
        assert_eq!(numbers.collect::<Vec<_>>(), [5e-6, 10e-6, 2e-5]);
        assert_eq!(listed.unit, "m");
        assert_eq!(listed.at(0.0).sets, ["a.b=5 um"]);
        let range = factor(r#"Range(name: "d", key: "a.b", low: 0, high: 20 um)"#).unwrap();
        assert_eq!(
            (range.at(1.0).number, range.unit.as_str()),
            (Some(2e-5), "m")
        );
        for (text, words) in [
            (
                r#"Values(name: "d", values: [5um, 10 ms])"#,
                "does not measure the same",
            ),
            (
                r#"Range(name: "d", low: 1 um, high: 2 s)"#,
                "does not measure the same",
            ),
            (
                r#"Values(name: "d", values: [5 mss])"#,
                "is not a known unit",
            ),
            (
                r#"Range(name: "d", low: 1um, high: 2um, unit: "s")"#,
                "does not measure the same",
            ),
            (
                r#"Values(name: "d", values: [5um, 5e-6])"#,
                "are the same value",
            ),
        ] {
            let error = factor(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
