//! Number of seeds for a point of a search.
//!
//! A search uses the order of its points, so that the differences between points must exceed the
//! noise of their means. As in UH-CMA-ES (Hansen, Niederberger, Guzzella, Koumoutsakos, IEEE Trans.
//! Evol. Comput. 13 (2009) 180) the number of runs per point grows by 1.5 while the order is
//! uncertain, and falls slowly while it is certain. There the measure is the change of ranks when
//! some points are run again; here all points of a generation have the same seeds, so that the
//! analysis of variance by points and seeds measures it without further runs:
//!
//! ```text
//! reliability = 1 - MS_noise / MS_points,
//! ```
//!
//! the share of the variance of the points' means that is not noise. An effect of a seed that is
//! common to all points does not count. Each generation should have other seeds: with the same ones
//! throughout, the search finds the minimum of these seeds.

/// Reliability below which more seeds are used.
const UNCERTAIN: f64 = 0.5;

/// Reliability above which fewer seeds are used.
const CERTAIN: f64 = 0.8;

/// Factor for more seeds, and its fourth root for fewer (the paper's choice).
const GROWTH: f64 = 1.5;

/// Number of uncertain generations with the largest number of seeds after which the search can make
/// no further progress.
const EXHAUSTED: usize = 5;

/// The number of seeds per point, adapted after each generation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeedsPerPoint {
    smallest: usize,
    largest: usize,
    now: f64,
    uncertain: usize,
}

impl SeedsPerPoint {
    /// Creates the number from `smallest`, with which it starts, to `largest` seeds; if both are
    /// equal, it does not change. With one seed the noise is unknown, so that the smallest number
    /// should be two or more, except for a model without randomness. Numbers in the wrong order are
    /// exchanged, zero is replaced by one.
    pub fn new(smallest: usize, largest: usize) -> Self {
        let smallest = smallest.max(1);
        Self {
            smallest,
            largest: largest.max(smallest),
            now: smallest as f64,
            uncertain: 0,
        }
    }

    /// Returns the number of seeds for each point of the next generation.
    pub fn count(&self) -> usize {
        (self.now.round() as usize).clamp(self.smallest, self.largest)
    }

    /// Adds the values of a generation: one row per point, with the value for each seed, with the
    /// same seeds in the same order. Points with a failed run (`None`) are left out. Returns the
    /// reliability; `None` with one seed or fewer than three complete points, and the number then
    /// does not change.
    pub fn update(&mut self, values: &[Vec<Option<f64>>]) -> Option<f64> {
        let reliability = reliability(values)?;
        if reliability < UNCERTAIN {
            self.uncertain = if self.count() == self.largest {
                self.uncertain + 1
            } else {
                0
            };
            self.now = (self.now * GROWTH).min(self.largest as f64);
        } else {
            self.uncertain = 0;
            if reliability > CERTAIN {
                self.now = (self.now / GROWTH.sqrt().sqrt()).max(self.smallest as f64);
            }
        }
        Some(reliability)
    }

    /// Returns whether the points of the last generations differ by no more than their noise, with
    /// the largest number of seeds: the search has reached the resolution of these seeds.
    pub fn exhausted(&self) -> bool {
        self.uncertain >= EXHAUSTED
    }
}

/// Returns the share of the variance of the points' means that is not noise, from 0 to 1.
fn reliability(values: &[Vec<Option<f64>>]) -> Option<f64> {
    let rows: Vec<Vec<f64>> = values
        .iter()
        .filter_map(|row| row.iter().map(|v| v.filter(|v| v.is_finite())).collect())
        .collect();
    let seeds = rows.first()?.len();
    if rows.len() < 3 || seeds < 2 || rows.iter().any(|r| r.len() != seeds) {
        return None;
    }
    let (k, r) = (rows.len() as f64, seeds as f64);
    let of_points: Vec<f64> = rows.iter().map(|row| row.iter().sum::<f64>() / r).collect();
    let of_seeds: Vec<f64> = (0..seeds)
        .map(|j| rows.iter().map(|row| row[j]).sum::<f64>() / k)
        .collect();
    let mean = of_points.iter().sum::<f64>() / k;
    let between: f64 = of_points.iter().map(|m| (m - mean).powi(2)).sum::<f64>() * r / (k - 1.0);
    let residual = |row: &Vec<f64>, m: &f64| -> f64 {
        row.iter()
            .zip(&of_seeds)
            .map(|(v, s)| (v - m - s + mean).powi(2))
            .sum()
    };
    let noise: f64 = rows
        .iter()
        .zip(&of_points)
        .map(|(row, m)| residual(row, m))
        .sum();
    let noise = noise / ((k - 1.0) * (r - 1.0));
    if between <= 0.0 {
        return Some(0.0);
    }
    Some((1.0 - noise / between).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::normal;
    use rand::SeedableRng;

    /// Points differ with variance 1, with noise of variance 4 in 4 seeds, and a large common part
    /// of each seed: half of the variance of means is noise.
    #[test]
    fn reliability_is_the_share_without_noise() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(2);
        let shared: Vec<f64> = (0..4).map(|_| 100.0 * normal(&mut rng)).collect();
        let values: Vec<Vec<Option<f64>>> = (0..4000)
            .map(|_| {
                let point = normal(&mut rng);
                shared
                    .iter()
                    .map(|s| Some(s + point + 2.0 * normal(&mut rng)))
                    .collect()
            })
            .collect();
        let found = reliability(&values).unwrap();
        assert!((found - 0.5).abs() < 0.03, "{found}");
    }

    #[test]
    fn more_seeds_while_uncertain_fewer_while_certain() {
        let mut seeds = SeedsPerPoint::new(2, 8);
        let noise = [[0.0, 1.0], [1.0, 0.0], [0.5, 0.5]].map(|r| r.map(Some).to_vec());
        let clear = [[0.0, 0.1], [5.0, 5.0], [9.0, 9.0]].map(|r| r.map(Some).to_vec());
        let mut counts = vec![seeds.count()];
        for _ in 0..5 {
            assert_eq!(seeds.update(&noise), Some(0.0));
            counts.push(seeds.count());
        }
        assert_eq!(counts, [2, 3, 5, 7, 8, 8]);
        assert!(!seeds.exhausted());
        for _ in 0..4 {
            seeds.update(&noise);
        }
        assert!(seeds.exhausted());
        for _ in 0..30 {
            assert!(seeds.update(&clear).unwrap() > 0.99);
        }
        assert_eq!((seeds.count(), seeds.exhausted()), (2, false));
    }

    #[test]
    fn one_seed_or_failures_say_nothing() {
        let mut seeds = SeedsPerPoint::new(1, 9);
        assert_eq!(
            seeds.update(&[vec![Some(1.0)], vec![Some(2.0)], vec![Some(3.0)]]),
            None
        );
        assert_eq!(
            seeds.update(&[vec![None, Some(1.0)], vec![Some(1.0), None]]),
            None
        );
        assert_eq!(seeds.count(), 1);
    }
}
