//! Mean output at each level of each factor.

use super::SensitivityError;
use super::points::{Noise, Points, mean};
use crate::distribution::student_quantile;
use crate::interval::{CONFIDENCE, Mean};
use serde::{Deserialize, Serialize};

/// What is known of one level of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelMean {
    /// Number of the level.
    pub level: usize,
    /// Mean over the combinations with this level, each by the mean of its seeds, so that all count the same.
    pub mean: f64,
    /// Standard deviation over these combinations: what the other factors do; `None` for one combination.
    pub scatter: Option<f64>,
    /// Half-width of the interval of 95 % for other combinations drawn at random; `None` for one combination.
    pub half_width: Option<f64>,
    /// Half-width of the interval of 95 % for the same combinations with other seeds; `None` without repeated seeds.
    pub noise_half_width: Option<f64>,
    /// Runs that succeeded.
    pub runs: usize,
}

/// The main effect of a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MainEffect {
    /// Its levels, in order.
    pub levels: Vec<LevelMean>,
    /// Largest less smallest mean.
    pub range: f64,
}

/// The main effects of all factors, from runs whose row has the level of each factor. Seeds of a combination are repeated rows;
/// `None` is a run that failed. The design need not be complete, but where levels occur with different levels of the other
/// factors their means differ for that reason too.
///
/// # Errors
///
/// Rows of unequal length, another number of outputs, or no run that succeeded.
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
    let noise = points.noise();
    Ok((0..first.len())
        .map(|f| effect(&points, f, noise))
        .collect())
}

fn effect(points: &Points<usize>, factor: usize, noise: Option<Noise>) -> MainEffect {
    let mut names: Vec<usize> = points.rows.iter().map(|r| r[factor]).collect();
    names.sort_unstable();
    names.dedup();
    let levels: Vec<LevelMean> = names
        .into_iter()
        .map(|level| level_mean(points, factor, level, noise))
        .collect();
    let most = levels.iter().map(|l| l.mean).fold(f64::MIN, f64::max);
    let least = levels.iter().map(|l| l.mean).fold(f64::MAX, f64::min);
    MainEffect {
        levels,
        range: most - least,
    }
}

fn level_mean(
    points: &Points<usize>,
    factor: usize,
    level: usize,
    noise: Option<Noise>,
) -> LevelMean {
    let chosen: Vec<&Vec<f64>> = points
        .rows
        .iter()
        .zip(&points.outputs)
        .filter_map(|(row, values)| (row[factor] == level).then_some(values))
        .collect();
    let means: Vec<f64> = chosen.iter().map(|v| mean(v)).collect();
    let over = Mean::of(&means);
    let count = means.len() as f64;
    // Variance of a mean of means of different numbers of runs.
    let share: f64 = chosen.iter().map(|v| 1.0 / v.len() as f64).sum::<f64>() / (count * count);
    let by_noise = |noise: Noise| {
        let t = student_quantile(0.5 + 0.5 * CONFIDENCE, noise.degrees as f64)?;
        Some(t * (noise.variance * share).sqrt())
    };
    LevelMean {
        level,
        mean: mean(&means),
        scatter: over.and_then(|m| m.scatter),
        half_width: over.and_then(|m| m.half_width),
        noise_half_width: noise.and_then(by_noise),
        runs: chosen.iter().map(|v| v.len()).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::grid::full_factorial;
    use crate::random::normal;
    use rand::SeedableRng;

    /// y = 10 a + b without noise: the means of a are 10 a + 1, those of b are 5 + b.
    #[test]
    fn additive_effects_by_hand() {
        let rows = full_factorial(&[2, 3]).unwrap();
        let outputs: Vec<_> = rows
            .iter()
            .map(|r| Some((10 * r[0] + r[1]) as f64))
            .collect();
        let effects = main_effects(&rows, &outputs).unwrap();
        let means = |f: usize| effects[f].levels.iter().map(|l| l.mean).collect::<Vec<_>>();
        assert_eq!(means(0), [1.0, 11.0]);
        assert_eq!(means(1), [5.0, 6.0, 7.0]);
        assert_eq!((effects[0].range, effects[1].range), (10.0, 2.0));
        assert_eq!(effects[0].levels[0].scatter, Some(1.0));
        assert_eq!(effects[0].levels[0].noise_half_width, None);
    }

    /// Intervals for other seeds hold the mean without noise in 95 of 100 studies (standard error 0.7 % over 1000).
    #[test]
    fn noise_intervals_hold_the_truth() {
        let grid = full_factorial(&[2, 3]).unwrap();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(4);
        let held = (0..1000)
            .filter(|_| {
                let mut rows: Vec<Vec<usize>> = [grid.clone(), grid.clone(), grid.clone()].concat();
                rows.pop();
                let outputs: Vec<_> = rows
                    .iter()
                    .map(|r| Some((r[0] * r[1]) as f64 + 0.5 * normal(&mut rng)))
                    .collect();
                let level = main_effects(&rows, &outputs).unwrap()[0].levels[1];
                (level.mean - 1.0).abs() <= level.noise_half_width.unwrap()
            })
            .count();
        assert!((930..=970).contains(&held), "{held}");
    }

    #[test]
    fn failed_runs_are_left_out() {
        let rows = full_factorial(&[2, 2]).unwrap();
        let outputs = [Some(1.0), None, Some(2.0), Some(4.0)];
        let effects = main_effects(&rows, &outputs).unwrap();
        assert_eq!(effects[0].levels[0].mean, 1.0);
        assert_eq!(effects[0].levels[0].half_width, None);
        assert_eq!(effects[0].levels[0].runs, 1);
        assert!(main_effects(&rows, &[None; 4]).is_err());
    }
}
