//! The valid range of a law's outputs, where physics or the plugin interface defines one.

use super::kind::{Kind, Output};
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
pub(super) struct Largest(Vec<(i32, Vec<f64>)>);

impl Largest {
    fn of(&mut self, kind: Kind, columns: usize) -> &mut [f64] {
        let known = self.0.iter().position(|(code, _)| *code == kind.code());
        let at = known.unwrap_or_else(|| {
            self.0.push((kind.code(), Vec::new()));
            self.0.len() - 1
        });
        let values = &mut self.0[at].1;
        values.resize(values.len().max(columns), 0.0);
        values
    }
}

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

/// The first column in which a call gave a value that cannot be; values beyond an end by round-off are put on it. Values are
/// finite. Tractions, moments and stored energies may have any sign; that damage falls is no error, as the host holds it up.
pub(super) fn settle(
    outputs: &mut [Output<'_>],
    kind: Kind,
    largest: &mut Largest,
) -> Option<Outside> {
    let largest = largest.of(kind, outputs.len());
    for (output, largest) in outputs.iter_mut().zip(largest) {
        let Some(range) = output.range else {
            continue;
        };
        if let Some(contact) = range.settle(output.values, largest) {
            return Some(Outside {
                contact,
                column: output.name,
                value: output.values[contact],
                range,
            });
        }
    }
    None
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
