//! Checks that the outputs of laws are in their ranges, where physics or the plugin interface
//! defines one.

use super::kind::Kind;
use super::outputs::{Output, Range};
use serde::{Deserialize, Serialize};

impl Range {
    /// Tolerance for rounding errors: a fraction may exceed its bound, and a difference may fall
    /// below zero, by this relative amount.
    const ROUND_OFF: f64 = 1e-12;

    /// Returns the bounds, and the rounding tolerance for a column whose largest value so far is
    /// `largest`.
    fn bounds(self, largest: f64) -> ([f64; 2], f64) {
        match self {
            Self::NotNegative => ([0.0, f64::INFINITY], Self::ROUND_OFF * largest),
            Self::Share => ([0.0, 1.0], Self::ROUND_OFF),
            Self::Signed => ([-1.0, 1.0], Self::ROUND_OFF),
        }
    }

    /// Returns the first value outside the range by more than rounding, and clamps the others to
    /// the range. In most cases the extreme values of the column show that all values are inside.
    fn settle(self, column: &mut [f64], found: &ColumnRange, largest: &mut f64) -> Option<usize> {
        if self == Self::NotNegative {
            *largest = largest.max(found.most);
        }
        let ([low, high], slack) = self.bounds(*largest);
        if found.least >= low && found.most <= high {
            return None;
        }
        let beyond = |x: f64, by: f64| (x < low - by) | (x > high + by);
        let outside = column.iter().position(|x| beyond(*x, slack));
        if outside.is_none() {
            column.iter_mut().for_each(|x| *x = x.clamp(low, high));
        }
        outside
    }
}

/// Range of a column, found in one pass without branches.
#[derive(Clone, Copy, Debug)]
pub(super) struct ColumnRange {
    /// Whether all values are finite.
    pub finite: bool,
    /// Smallest value; infinity for an empty column. Meaningful only if all values are finite, as
    /// is the largest.
    least: f64,
    /// Largest value.
    most: f64,
}

impl ColumnRange {
    pub fn of(column: &[f64]) -> Self {
        const LANES: usize = 8;
        let mut lanes = (
            [0.0; LANES],
            [f64::INFINITY; LANES],
            [f64::NEG_INFINITY; LANES],
        );
        let mut see = |values: &[f64]| {
            let places = lanes.0.iter_mut().zip(&mut lanes.1).zip(&mut lanes.2);
            for (((other, least), most), x) in places.zip(values) {
                // The product is zero except for infinities and NaN, which make `other` NaN.
                *other += x * 0.0;
                *least = if *x < *least { *x } else { *least };
                *most = if *x > *most { *x } else { *most };
            }
        };
        let chunks = column.chunks_exact(LANES);
        let rest = chunks.remainder();
        chunks.for_each(&mut see);
        see(rest);
        Self {
            finite: lanes.0.iter().sum::<f64>() == 0.0,
            least: lanes.1.iter().fold(f64::INFINITY, |a, b| a.min(*b)),
            most: lanes.2.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)),
        }
    }
}

/// Largest value of each column so far, by kind of law and index of the column: the reference for
/// rounding errors. A single contact near failure has no other value to compare with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Largest(Vec<(i32, Vec<f64>)>);

impl Largest {
    fn of(&mut self, kind: i32, columns: usize) -> &mut [f64] {
        let known = self.0.iter().position(|(code, _)| *code == kind);
        let at = known.unwrap_or_else(|| {
            self.0.push((kind, Vec::new()));
            self.0.len() - 1
        });
        let values = &mut self.0[at].1;
        values.resize(values.len().max(columns), 0.0);
        values
    }

    /// Takes the larger value of the two for each column.
    pub fn raise(&mut self, other: &Self) {
        for (code, theirs) in &other.0 {
            for (ours, theirs) in self.of(*code, theirs.len()).iter_mut().zip(theirs) {
                *ours = ours.max(*theirs);
            }
        }
    }
}

/// A value outside its range.
pub(super) struct Outside {
    pub contact: usize,
    pub column: &'static str,
    pub value: f64,
    pub range: Range,
}

/// Returns the first output of a call outside its range; values beyond a bound by round-off are set
/// to the bound. Values must be finite. Tractions, moments and stored energies may have any sign. A
/// decrease of damage is no error, since the host keeps damage from decreasing.
pub(super) fn settle(
    outputs: &mut [Output<'_>],
    ranges: &[ColumnRange],
    kind: Kind,
    largest: &mut Largest,
) -> Option<Outside> {
    let largest = largest.of(kind.code(), outputs.len());
    for ((output, found), largest) in outputs.iter_mut().zip(ranges).zip(largest) {
        let Some(range) = output.range else {
            continue;
        };
        if let Some(contact) = range.settle(output.values, found, largest) {
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

    fn settle(range: Range, column: &mut [f64], largest: &mut f64) -> Option<usize> {
        let found = ColumnRange::of(column);
        assert!(found.finite);
        range.settle(column, &found, largest)
    }

    #[test]
    fn one_value_that_is_not_finite_is_found_wherever_it_is() {
        for n in 0..20 {
            let column: Vec<f64> = (0..n).map(|k| f64::MAX / f64::from(k + 1)).collect();
            assert!(ColumnRange::of(&column).finite);
            for k in 0..column.len() {
                for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut column = column.clone();
                    column[k] = wrong;
                    assert!(!ColumnRange::of(&column).finite);
                }
            }
        }
    }

    #[test]
    fn the_first_value_outside_is_found_and_round_off_is_not() {
        let settle = |range, column: &[f64]| settle(range, &mut column.to_vec(), &mut 0.0);
        let share = |column: &[f64]| settle(Range::Share, column);
        assert_eq!(share(&[0.0, 1.0, -0.0, 1.0 + 1e-15]), None);
        assert_eq!(share(&[0.5, 2.0, -3.0]), Some(1));
        assert_eq!(share(&[0.5, 0.5, -3.0]), Some(2));
        assert_eq!(settle(Range::Signed, &[-1.0, 1.0, -1.1]), Some(2));
        assert_eq!(settle(Range::NotNegative, &[1.0, -1e-11]), Some(1));
        assert_eq!(settle(Range::NotNegative, &[0.0, -1e-300]), Some(1));
    }

    /// A strength times (1 - D) is slightly negative where D exceeds 1 by one unit in the last
    /// place.
    #[test]
    fn what_round_off_leaves_below_zero_is_zero() {
        let left = 1e6 * (1.0 - (1.0 + f64::EPSILON));
        assert!(left < 0.0);
        let mut column = vec![1e6, left, 0.5];
        assert_eq!(settle(Range::NotNegative, &mut column, &mut 0.0), None);
        assert_eq!(column, [1e6, 0.0, 0.5]);
        // The reference for a single bond is its own earlier value.
        let mut largest = 0.0;
        for (value, found) in [(1e6, None), (left, None), (-1e-3, Some(0))] {
            let mut column = vec![value];
            assert_eq!(settle(Range::NotNegative, &mut column, &mut largest), found);
            assert!(found.is_some() || column[0] >= 0.0);
        }
        assert_eq!(largest, 1e6);
    }
}
