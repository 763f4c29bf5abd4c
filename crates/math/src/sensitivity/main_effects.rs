//! Change of the mean output over the levels of each factor.

use super::SensitivityError;
use super::points::{Points, mean};

/// The main effect of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct MainEffect {
    /// Mean over the combinations with each level, in the order of the levels. Each combination
    /// contributes the mean of its seeds, so that all have the same weight.
    pub means: Vec<f64>,
    /// Largest less smallest mean.
    pub range: f64,
}

/// Returns the main effects of all factors, from runs whose row has the level of each factor. Seeds
/// of a combination are repeated rows; `None` is a failed run. The design need not be complete, but
/// where levels occur with different levels of the other factors, their means differ for that
/// reason too.
///
/// # Errors
///
/// Rows have different lengths, the number of outputs is wrong, or no run succeeded.
pub fn main_effects(
    rows: &[Vec<usize>],
    outputs: &[Option<f64>],
) -> Result<Vec<MainEffect>, SensitivityError> {
    let points = Points::gather(rows, outputs)?;
    let Some(first) = points.rows.first() else {
        return Err(SensitivityError::Few {
            what: "runs",
            complete: 0,
            needed: 1,
        });
    };
    Ok((0..first.len()).map(|f| effect(&points, f)).collect())
}

fn effect(points: &Points<usize>, factor: usize) -> MainEffect {
    let mut levels: Vec<usize> = points.rows.iter().map(|r| r[factor]).collect();
    levels.sort_unstable();
    levels.dedup();
    let of_level = |level: usize| {
        let runs = points.rows.iter().zip(&points.outputs);
        let own = runs.filter(|(row, _)| row[factor] == level);
        mean(&own.map(|(_, values)| mean(values)).collect::<Vec<_>>())
    };
    let means: Vec<f64> = levels.into_iter().map(of_level).collect();
    let most = means.iter().copied().fold(f64::MIN, f64::max);
    let least = means.iter().copied().fold(f64::MAX, f64::min);
    MainEffect {
        range: most - least,
        means,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::grid::full_factorial;

    /// y = 10 a + b without noise: the means of a are 10 a + 1, those of b are 5 + b.
    #[test]
    fn additive_effects_by_hand() {
        let rows = full_factorial(&[2, 3]).unwrap();
        let outputs: Vec<_> = rows
            .iter()
            .map(|r| Some((10 * r[0] + r[1]) as f64))
            .collect();
        let effects = main_effects(&rows, &outputs).unwrap();
        assert_eq!(effects[0].means, [1.0, 11.0]);
        assert_eq!(effects[1].means, [5.0, 6.0, 7.0]);
        assert_eq!((effects[0].range, effects[1].range), (10.0, 2.0));
    }

    #[test]
    fn failed_runs_are_left_out() {
        let rows = full_factorial(&[2, 2]).unwrap();
        let outputs = [Some(1.0), None, Some(2.0), Some(4.0)];
        let effects = main_effects(&rows, &outputs).unwrap();
        assert_eq!(effects[0].means, [1.0, 3.0]);
        assert!(main_effects(&rows, &[None; 4]).is_err());
    }
}
