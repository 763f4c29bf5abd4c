//! Factors of an experiment: each converts a number of its range, or a level, to changes of the
//! case.

mod spec;

pub use spec::FactorSpec;

use fretwork_math::design::scale::Scale;
use fretwork_scene::expression::number;
use fretwork_scene::quantity::si_quantity;

/// Label of the value of the case, where its file does not give it.
pub const AS_IN_THE_CASE: &str = "as in the case";

/// A value of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Text in tables.
    pub label: String,
    /// Number, if the level is one.
    pub number: Option<f64>,
    /// Changes of the case, `key.path=value`.
    pub sets: Vec<String>,
}

/// Number of digits of a drawn number where it is shown with others.
const SHOWN: i32 = 4;

impl Level {
    /// Returns the label, in which a number of many digits and without a unit has four.
    pub fn short(&self) -> String {
        let many = |x: &f64| self.label.len() > 7 && *x != x.trunc();
        let number = self.label.parse().ok().filter(many);
        number.map_or_else(
            || self.label.clone(),
            |x| fretwork_observe::quantity::number(x, SHOWN),
        )
    }

    /// Creates a value of some keys from its text; the number of `5 um` is in SI units.
    pub fn of(keys: &[String], text: &str) -> Self {
        let with_unit = || si_quantity(text)?.ok().map(|(value, _)| value);
        let plain = text.parse().ok().filter(|x: &f64| x.is_finite());
        Self {
            label: text.trim_matches('"').to_owned(),
            number: plain.or_else(with_unit),
            sets: keys.iter().map(|key| format!("{key}={text}")).collect(),
        }
    }

    /// Gives a unit to the plain numbers that it sets.
    pub fn in_unit(mut self, unit: &str) -> Self {
        for set in &mut self.sets {
            let value = set.split_once('=').map(|(_, value)| value.parse::<f64>());
            if value.is_some_and(|value| value.is_ok()) {
                *set += " ";
                *set += unit;
            }
        }
        self
    }

    /// A named alternative, which is no number.
    pub fn named(label: &str, sets: Vec<String>) -> Self {
        Self {
            label: label.to_owned(),
            number: None,
            sets,
        }
    }

    /// Returns whether this is the unchanged value of a case that does not give it.
    pub fn is_unknown(&self) -> bool {
        self.label == AS_IN_THE_CASE && self.number.is_none() && self.sets.is_empty()
    }

    /// Returns whether both are the same number, or without numbers the same text.
    pub fn equals(&self, other: &Self) -> bool {
        match (self.number, other.number) {
            (Some(a), Some(b)) => a == b,
            _ => self.label == other.label,
        }
    }
}

/// Values of a factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers of a range.
    Range {
        /// Ends of the range, and its scale.
        scale: Scale,
        /// Number of levels in designs of levels.
        levels: Option<u16>,
        /// SI unit that the file gives with the ends, by which the case checks their dimension;
        /// empty if it gives none.
        unit: String,
    },
    /// Listed values.
    Listed(Vec<Level>),
}

/// A factor of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Name in tables and figures.
    pub name: String,
    /// Keys that take the value of the factor; empty for named alternatives.
    pub keys: Vec<String>,
    /// SI unit, where the file gives it, since no key has one.
    pub unit: String,
    /// Values of the factor.
    pub values: Values,
}

/// Number of digits of a number of a range: more would show rounding errors in tables.
const DIGITS: usize = 10;

impl Factor {
    /// Creates a factor from a column of a table of points: its name, or the key that it sets.
    pub fn of_column(key: &str, values: Vec<String>) -> Self {
        let keys = vec![key.to_owned()];
        let listed = values.iter().map(|text| Level::of(&keys, text)).collect();
        Self {
            name: key.to_owned(),
            keys,
            unit: String::new(),
            values: Values::Listed(listed),
        }
    }

    /// Returns the levels of the factor; `None` for a range without a number of levels.
    pub fn levels(&self) -> Option<Vec<Level>> {
        match &self.values {
            Values::Listed(values) => Some(values.clone()),
            Values::Range { scale, levels, .. } => {
                let numbers = scale.levels(usize::from((*levels)?));
                Some(numbers.into_iter().map(|x| self.value(x)).collect())
            }
        }
    }

    /// Returns the value at a position from 0 to 1: for a range by its scale, with both ends; for
    /// listed values in equal parts.
    pub fn at(&self, place: f64) -> Level {
        match &self.values {
            Values::Listed(values) => {
                let k = (place * values.len() as f64) as usize;
                values[k.min(values.len() - 1)].clone()
            }
            Values::Range { scale, .. } => self.value(scale.at(place)),
        }
    }

    /// Returns the value for a text of a table: a number of the range, a level by its label, or any
    /// value of its key.
    ///
    /// # Errors
    /// The factor does not have this value.
    pub fn named(&self, text: &str) -> Result<Level, String> {
        let name = &self.name;
        let value = Level::of(&self.keys, text);
        match &self.values {
            Values::Range { scale, .. } => match (value.number, scale) {
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
            Values::Listed(values) => {
                // Equal numbers are one level, in any spelling.
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

    /// The level of a number, to ten digits.
    fn value(&self, x: f64) -> Level {
        let rounded: f64 = format!("{x:.*e}", DIGITS - 1).parse().unwrap_or(x);
        match &self.values {
            Values::Range {
                scale: Scale::Integer { .. },
                ..
            } => self.of_number(&format!("{rounded:.0}")),
            _ => self.exactly(rounded),
        }
    }

    /// Returns the level of a number, with all its digits.
    pub fn exactly(&self, x: f64) -> Level {
        // A field of floats takes a number with a point.
        match number(x) {
            text if text.contains(['.', 'e']) => self.of_number(&text),
            whole => self.of_number(&format!("{whole}.0")),
        }
    }

    /// Returns the level of a number in the unit of the range.
    fn of_number(&self, text: &str) -> Level {
        let level = Level::of(&self.keys, text);
        match &self.values {
            Values::Range { unit, .. } if !unit.is_empty() => Level {
                sets: level.sets.iter().map(|s| format!("{s} {unit}")).collect(),
                ..level
            },
            _ => level,
        }
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
            values: Values::Range {
                scale,
                levels: Some(levels),
                unit: String::new(),
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

    #[test]
    fn plain_numbers_of_a_name_take_the_unit_of_the_factor() {
        let keys = ["let.L".to_owned()];
        let sets = |text: &str| Level::of(&keys, text).in_unit("mm").sets;
        assert_eq!(sets("0.9"), ["let.L=0.9 mm"]);
        assert_eq!(sets("1 um"), ["let.L=1 um"]);
    }

    #[test]
    fn values_with_units_have_numbers_in_si() {
        let keys = vec!["a".to_owned()];
        let level = Level::of(&keys, "5 um");
        assert_eq!((level.label.as_str(), level.number), ("5 um", Some(5e-6)));
        assert_eq!(level.sets, ["a=5 um"]);
        assert!(level.equals(&Level::of(&keys, "5e-6")));
        let mut factor = range(LINEAR, 3);
        if let Values::Range { unit, .. } = &mut factor.values {
            *unit = "m".into();
        }
        let middle = factor.at(0.5);
        assert_eq!((middle.label.as_str(), middle.number), ("0.5", Some(0.5)));
        assert_eq!(middle.sets, ["a=0.5 m", "b=0.5 m"]);
    }

    /// Whole numbers and listed values have equal parts of the interval from 0 to 1.
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
