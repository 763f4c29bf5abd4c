//! The valid range of a law's outputs, where physics or the plugin interface defines one.

use super::columns::Outputs;
use super::library::{Call, Kind};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Accepted range of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Not negative: strengths, stiffnesses, damping, volumes, lengths.
    NotNegative,
    /// From 0 to 1: damage, normal restitution.
    Share,
    /// From -1 to 1: tangential restitution.
    Signed,
}

impl Range {
    /// Tolerance for rounding errors: a fraction may exceed its bound, and a difference may fall below zero,
    /// by this relative amount.
    const ROUND_OFF: f64 = 1e-12;

    /// Returns the bounds, and the rounding tolerance for a column whose largest value so far is `largest`.
    fn bounds(self, largest: f64) -> ([f64; 2], f64) {
        match self {
            Self::NotNegative => ([0.0, f64::INFINITY], Self::ROUND_OFF * largest),
            Self::Share => ([0.0, 1.0], Self::ROUND_OFF),
            Self::Signed => ([-1.0, 1.0], Self::ROUND_OFF),
        }
    }

    /// Returns the first value outside the range by more than rounding, and clamps the others to it. Almost
    /// always there is none: all values are tested without branches before one is searched for.
    fn settle(self, column: &mut [f64], largest: &mut f64) -> Option<usize> {
        if self == Self::NotNegative {
            *largest = column.iter().fold(*largest, |most, x| most.max(*x));
        }
        let ([low, high], slack) = self.bounds(*largest);
        let beyond = |x: f64, by: f64| (x < low - by) | (x > high + by);
        if !column.iter().fold(false, |any, x| any | beyond(*x, 0.0)) {
            return None;
        }
        let outside = column.iter().position(|x| beyond(*x, slack));
        if outside.is_none() {
            column.iter_mut().for_each(|x| *x = x.clamp(low, high));
        }
        outside
    }
}

/// Largest value of each column so far, by kind of law and index of the column: the reference for rounding
/// errors. A single contact near failure has no other value to compare with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Largest([[f64; COLUMNS]; Kind::ALL.len()]);

/// Maximum number of columns that a law writes in a call.
const COLUMNS: usize = 8;

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotNegative => "[0, infinity)",
            Self::Share => "[0, 1]",
            Self::Signed => "[-1, 1]",
        })
    }
}

/// A value outside its range.
pub(super) struct Outside {
    pub contact: usize,
    pub column: &'static str,
    pub value: f64,
    pub range: Range,
}

impl Outputs {
    /// Returns the first column with a value outside its range in a call of this kind; values within
    /// rounding of a bound are clamped. Values must be finite. Tractions, moments and stored energies may
    /// have any sign. Decreasing damage is no error, since the host keeps the maximum.
    pub(super) fn settle(
        &mut self,
        kind: Kind,
        call: Call,
        largest: &mut Largest,
    ) -> Option<Outside> {
        let largest = &mut largest.0[kind as usize];
        let columns =
            self.ranged(kind, call)
                .into_iter()
                .zip(largest)
                .flat_map(|(column, largest)| {
                    column.map(|(name, values, range)| (name, values, range, largest))
                });
        for (column, values, range, largest) in columns {
            if let Some(contact) = range.settle(values, largest) {
                return Some(Outside {
                    contact,
                    column,
                    value: values[contact],
                    range,
                });
            }
        }
        None
    }

    /// Iterates over the columns that a call writes and that have a range.
    fn ranged(
        &mut self,
        kind: Kind,
        call: Call,
    ) -> [Option<(&'static str, &mut Vec<f64>, Range)>; COLUMNS] {
        use Range::{NotNegative, Share, Signed};
        let tension = Some((
            "out_tension_strength",
            &mut self.tension_strength,
            NotNegative,
        ));
        let shear = Some(("out_shear_cohesion", &mut self.shear_cohesion, NotNegative));
        match (kind, call) {
            (Kind::Contact, Call::Prepare) => [
                Some(("out_friction", &mut self.friction, NotNegative)),
                Some(("out_restitution_n", &mut self.restitution_n, Share)),
                Some(("out_restitution_t", &mut self.restitution_t, Signed)),
                Some(("out_rolling", &mut self.rolling, NotNegative)),
                Some(("out_spinning", &mut self.spinning, NotNegative)),
                tension,
                shear,
                None,
            ],
            (Kind::Cohesion, Call::Prepare) => [
                Some(("out_stiffness_n", &mut self.stiffness_n, NotNegative)),
                Some(("out_stiffness_t", &mut self.stiffness_t, NotNegative)),
                Some(("out_damping_n", &mut self.damping_n, NotNegative)),
                Some(("out_damping_t", &mut self.damping_t, NotNegative)),
                Some((
                    "out_stiffness_twist",
                    &mut self.stiffness_twist,
                    NotNegative,
                )),
                Some(("out_stiffness_bend", &mut self.stiffness_bend, NotNegative)),
                tension,
                shear,
            ],
            (Kind::Damage | Kind::Cohesion, Call::Commit) => {
                alone(("out_damage", &mut self.damage, Share))
            }
            (Kind::Wear, Call::Commit) => alone(("out_volume", &mut self.volume, NotNegative)),
            _ => [const { None }; COLUMNS],
        }
    }
}

fn alone<T>(column: T) -> [Option<T>; COLUMNS] {
    [Some(column), None, None, None, None, None, None, None]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_outside_is_found_and_round_off_is_not() {
        let settle = |range: Range, column: &[f64]| range.settle(&mut column.to_vec(), &mut 0.0);
        let share = |column: &[f64]| settle(Range::Share, column);
        assert_eq!(share(&[0.0, 1.0, -0.0, 1.0 + 1e-15]), None);
        assert_eq!(share(&[0.5, 2.0, -3.0]), Some(1));
        assert_eq!(share(&[0.5, 0.5, -3.0]), Some(2));
        assert_eq!(settle(Range::Signed, &[-1.0, 1.0, -1.1]), Some(2));
        assert_eq!(settle(Range::NotNegative, &[1.0, -1e-11]), Some(1));
        assert_eq!(settle(Range::NotNegative, &[0.0, -1e-300]), Some(1));
    }

    /// A strength times (1 - D), where D exceeds 1 by one unit in the last place.
    #[test]
    fn what_round_off_leaves_below_zero_is_zero() {
        let left = 1e6 * (1.0 - (1.0 + f64::EPSILON));
        assert!(left < 0.0);
        let mut column = vec![1e6, left, 0.5];
        assert_eq!(Range::NotNegative.settle(&mut column, &mut 0.0), None);
        assert_eq!(column, [1e6, 0.0, 0.5]);
        // A single bond: its own earlier value is the reference.
        let mut largest = 0.0;
        for (value, found) in [(1e6, None), (left, None), (-1e-3, Some(0))] {
            let mut column = vec![value];
            assert_eq!(Range::NotNegative.settle(&mut column, &mut largest), found);
            assert!(found.is_some() || column[0] >= 0.0);
        }
        assert_eq!(largest, 1e6);
    }
}
