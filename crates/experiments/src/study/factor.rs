//! What varies in a study: a factor turns a number from 0 to 1, or a level, into changes of the case.

use super::spec::{FactorSpec, OptionSpec, ReadSpec};
use crate::runs::spec::{CaseKeys, RangeScale};
use fretwork_scene::{InputError, unseen_fault};
use fretwork_study::design::scale::Scale;

/// Label of the value that a case has, where its file does not give it.
pub const AS_IN_THE_CASE: &str = "as in the case";

/// A value that a factor takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// As it stands in tables.
    pub label: String,
    /// As a number, if it is one.
    pub number: Option<f64>,
    /// `key.path=value` for the case.
    pub sets: Vec<String>,
}

impl Value {
    /// Whether it is that of the case as it is, and the case does not tell it.
    pub fn is_unknown(&self) -> bool {
        self.label == AS_IN_THE_CASE && self.number.is_none() && self.sets.is_empty()
    }

    /// Whether it is the same number, or without numbers the same text.
    pub fn equals(&self, other: &Self) -> bool {
        match (self.number, other.number) {
            (Some(a), Some(b)) => a == b,
            _ => self.label == other.label,
        }
    }
}

/// Which values a factor takes.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Numbers of a range.
    Range {
        /// Its ends, and how they are spread.
        scale: Scale,
        /// How many there are in designs of levels.
        levels: Option<u16>,
    },
    /// Listed values.
    Listed(Vec<Value>),
}

/// A factor of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Name in tables and figures.
    pub name: String,
    /// The keys that take its value; none for named alternatives.
    pub keys: Vec<String>,
    /// SI unit, where the file gives it, since no key has one.
    pub unit: String,
    /// Its values.
    pub kind: Kind,
}

/// Digits of a number of a range: more would be noise of the last bit in tables.
const DIGITS: usize = 10;

impl Factor {
    /// The factor that a file describes, `path` in it.
    ///
    /// # Errors
    /// A range that is none, a value that is given twice, no values.
    pub fn of(spec: &FactorSpec, read: &ReadSpec, path: &str) -> Result<Self, InputError> {
        let fail =
            |key: &str, text: String| Err(read.source.error_at(&format!("{path}{key}"), text));
        let named =
            |name: &Option<String>, CaseKeys(keys): &CaseKeys| match name.as_ref().or(keys.first())
            {
                Some(first) if unseen_fault(first).is_some() => Err(read
                    .source
                    .error_at(path, unseen_fault(first).unwrap_or_default())),
                None => Err(read.source.error_at(
                    path,
                    "a factor has a `key` of the case, or a `name` for use in `set`",
                )),
                Some(first) => Ok((first.clone(), keys.clone())),
            };
        match spec {
            FactorSpec::Values {
                name,
                key,
                values,
                unit,
            } => {
                let (name, keys) = named(name, key)?;
                if values.is_empty() {
                    return fail(".values", "a factor takes one value or more".to_owned());
                }
                let texts: Vec<&str> = values.iter().map(|v| v.get_ron().trim()).collect();
                let listed: Vec<Value> = texts.iter().map(|text| value_of(&keys, text)).collect();
                for k in 1..listed.len() {
                    if let Some(first) = (0..k).find(|&i| listed[i].equals(&listed[k])) {
                        let text = match texts[first] == texts[k] {
                            true => format!("{} is given twice", texts[k]),
                            false => {
                                format!("{} and {} are the same value", texts[first], texts[k])
                            }
                        };
                        return fail(&format!(".values.{k}"), text);
                    }
                }
                Ok(Self {
                    name,
                    keys,
                    unit: unit.clone().unwrap_or_default(),
                    kind: Kind::Listed(listed),
                })
            }
            FactorSpec::Range {
                name,
                key,
                low,
                high,
                scale,
                levels,
                unit,
            } => {
                let (name, keys) = named(name, key)?;
                let (from, to) = (*low, *high);
                let scale = match scale {
                    RangeScale::Linear => Scale::Linear { from, to },
                    RangeScale::Log => Scale::Logarithmic { from, to },
                    RangeScale::Integer if low.fract() != 0.0 || high.fract() != 0.0 => {
                        return fail(".low", "a range of whole numbers has whole ends".to_owned());
                    }
                    RangeScale::Integer => Scale::Integer {
                        from: from as i64,
                        to: to as i64,
                    },
                };
                if let Err(e) = scale.check() {
                    return fail(".low", e.to_string());
                }
                if levels.is_some_and(|n| n < 2) {
                    return fail(
                        ".levels",
                        "a range has two levels or more, its ends".to_owned(),
                    );
                }
                let kind = Kind::Range {
                    scale,
                    levels: *levels,
                };
                Ok(Self {
                    name,
                    keys,
                    unit: unit.clone().unwrap_or_default(),
                    kind,
                })
            }
            FactorSpec::Options { name, options } => {
                if options.is_empty() {
                    return fail(".options", "a factor has one option or more".to_owned());
                }
                if let Some(k) = (1..options.len())
                    .find(|&k| options[..k].iter().any(|o| o.name == options[k].name))
                {
                    let name = &options[k].name;
                    return fail(
                        &format!(".options.{k}.name"),
                        format!("`{name}` is given twice"),
                    );
                }
                let value = |o: &OptionSpec| Value {
                    label: o.name.clone(),
                    number: None,
                    sets: o.set.clone(),
                };
                let listed = options.iter().map(value).collect();
                Ok(Self {
                    name: name.clone(),
                    keys: Vec::new(),
                    unit: String::new(),
                    kind: Kind::Listed(listed),
                })
            }
        }
    }

    /// A column of a table of points: its name, or the key that it sets.
    pub fn of_column(key: &str, values: Vec<String>) -> Self {
        let keys = vec![key.to_owned()];
        let listed = values.iter().map(|text| value_of(&keys, text)).collect();
        Self {
            name: key.to_owned(),
            keys,
            unit: String::new(),
            kind: Kind::Listed(listed),
        }
    }

    /// Its levels; `None` for a range without a number of them.
    pub fn levels(&self) -> Option<Vec<Value>> {
        match &self.kind {
            Kind::Listed(values) => Some(values.clone()),
            Kind::Range { scale, levels } => {
                let numbers = scale.levels(usize::from((*levels)?));
                Some(numbers.into_iter().map(|x| self.value(x)).collect())
            }
        }
    }

    /// The value at a place from 0 to 1: of a range by its scale, with both ends; of listed values in equal parts.
    pub fn at(&self, place: f64) -> Value {
        match &self.kind {
            Kind::Listed(values) => {
                let k = (place * values.len() as f64) as usize;
                values[k.min(values.len() - 1)].clone()
            }
            Kind::Range { scale, .. } => self.value(scale.at(place)),
        }
    }

    /// The value of a table: a number of the range, a level by its label, or any value of its key.
    ///
    /// # Errors
    /// The factor does not take it.
    pub fn named(&self, text: &str) -> Result<Value, String> {
        let name = &self.name;
        let value = value_of(&self.keys, text);
        match &self.kind {
            Kind::Range { scale, .. } => match (value.number, scale) {
                (None, _) => Err(format!(
                    "`{name}` is a range of numbers, and `{text}` is none"
                )),
                (Some(x), Scale::Logarithmic { .. }) if x <= 0.0 => Err(format!(
                    "`{name}` has `scale: Log`, for which numbers are above zero, and {text} is not"
                )),
                (Some(x), Scale::Integer { .. }) if x.fract() != 0.0 => Err(format!(
                    "`{name}` is a range of whole numbers, and {text} is none"
                )),
                _ => Ok(value),
            },
            Kind::Listed(values) => {
                // Equal numbers are one level, however they are spelled.
                let known = values
                    .iter()
                    .find(|v| v.label == value.label)
                    .or_else(|| values.iter().find(|v| v.equals(&value)));
                match known {
                    Some(known) => Ok(known.clone()),
                    None if !self.keys.is_empty() => Ok(value),
                    None => {
                        let labels: Vec<&str> = values.iter().map(|v| v.label.as_str()).collect();
                        let labels = labels.join(", ");
                        Err(format!(
                            "`{name}` has no option `{text}`; there are {labels}"
                        ))
                    }
                }
            }
        }
    }

    fn value(&self, number: f64) -> Value {
        let rounded: f64 = format!("{number:.*e}", DIGITS - 1)
            .parse()
            .unwrap_or(number);
        let text = match &self.kind {
            Kind::Range {
                scale: Scale::Integer { .. },
                ..
            } => format!("{rounded:.0}"),
            _ if rounded != 0.0 && !(1e-3..1e5).contains(&rounded.abs()) => format!("{rounded:e}"),
            // A field of floats takes a number with a point.
            _ if rounded.fract() == 0.0 => format!("{rounded:.1}"),
            _ => format!("{rounded}"),
        };
        value_of(&self.keys, &text)
    }
}

/// A value of keys from its text.
fn value_of(keys: &[String], text: &str) -> Value {
    Value {
        label: text.trim_matches('"').to_owned(),
        number: text.parse().ok().filter(|x: &f64| x.is_finite()),
        sets: keys.iter().map(|key| format!("{key}={text}")).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(scale: Scale, levels: u16) -> Factor {
        Factor {
            name: "x".into(),
            keys: vec!["a".into(), "b".into()],
            unit: String::new(),
            kind: Kind::Range {
                scale,
                levels: Some(levels),
            },
        }
    }

    const LINEAR: Scale = Scale::Linear { from: 0.0, to: 1.0 };
    const LOG: Scale = Scale::Logarithmic {
        from: 1e-8,
        to: 1e-6,
    };
    const WHOLE: Scale = Scale::Integer { from: 1, to: 3 };

    #[test]
    fn levels_go_from_end_to_end_in_the_scale_of_the_range() {
        let labels = |f: &Factor| -> Vec<String> {
            f.levels().unwrap().into_iter().map(|v| v.label).collect()
        };
        assert_eq!(labels(&range(LINEAR, 3)), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(&range(LOG, 3)), ["1e-8", "1e-7", "1e-6"]);
        assert_eq!(labels(&range(WHOLE, 5)), ["1", "2", "3"]);
        let one = &range(LINEAR, 3).levels().unwrap()[1];
        assert_eq!(one.sets, ["a=0.5", "b=0.5"]);
        assert_eq!(one.number, Some(0.5));
    }

    /// Whole numbers and listed values have equal parts of the way from 0 to 1.
    #[test]
    fn places_are_shared_equally() {
        let three = range(WHOLE, 3);
        let at = |f: &Factor, x| f.at(x).label;
        assert_eq!(
            [0.0, 0.33, 0.34, 0.67, 1.0].map(|x| at(&three, x)),
            ["1", "1", "2", "3", "3"]
        );
        let listed = Factor::of_column("law", vec!["\"mac\"".into(), "\"none\"".into()]);
        assert_eq!(
            [0.0, 0.49, 0.5, 1.0].map(|x| at(&listed, x)),
            ["mac", "mac", "none", "none"]
        );
        assert_eq!(listed.at(0.0).sets, ["law=\"mac\""]);
    }
}
