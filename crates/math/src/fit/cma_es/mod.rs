//! The evolution strategy with covariance matrix adaptation, CMA-ES: minimisation by function
//! values alone.
//!
//! N. Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772. A generation draws lambda
//! points from a normal distribution,
//!
//! ```text
//! x_k = m + sigma y_k,   y_k = B D z_k,   C = B D^2 B^T,   z_k standard normal,
//! ```
//!
//! and moves m, sigma and C by the ranks of their values, with positive weights for the better half
//! and negative ones for the rest (figure 6 there). Only ranks matter: any increasing function of
//! the values gives the same search, so that failed runs can be ranked last.
//!
//! [`Cma::ask`] gives the points, [`Cma::tell`] takes their values. The points of a generation are
//! independent, and may run in parallel. The same seed and values give the same search, with the
//! same bits.
//!
//! **Failed runs** have no value (`None`). They are ranked last; they do not attract the
//! distribution, and repel it by their negative weights. Where fewer runs succeed than have
//! positive weights, these weights are distributed among the successes. A generation without any
//! success is drawn again with other points.
//!
//! **Noise**: the values should be means over seeds, as many as [`seeds`](super::seeds) proposes.
//! With noise the best value seen is too low by chance, and the mean of the distribution
//! ([`Cma::mean`]) is the better estimate of the minimum.
//!
//! **Limits** of the region: [`bounds`](super::bounds) maps any point into it.

mod stop;
mod strategy;

pub use stop::{Limits, Stop};

use crate::statistics::eigen;
use crate::statistics::random::normal;
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use stop::{FAILED_GENERATIONS, History};
use strategy::Strategy;
use thiserror::Error;

/// Largest ratio of the variances of two axes.
const MAX_CONDITION: f64 = 1e14;

/// Growth of an axis from the start above which a search counts as divergent.
const MAX_GROWTH: f64 = 1e4;

/// Invalid use of a search.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CmaError {
    /// The start or the settings are invalid.
    #[error("{0}")]
    Start(String),
    /// The number of values is not that of the points.
    #[error(
        "{values} values for {points} points: give one value per point of the last `ask`, none for a failed run"
    )]
    Length {
        /// Number of points of the generation.
        points: usize,
        /// Number of given values.
        values: usize,
    },
}

/// A search.
#[derive(Clone, Debug, PartialEq)]
pub struct Cma {
    population: usize,
    seed: u64,
    limits: Limits,
    largest_step: Option<f64>,
    first_step: f64,
    generation: u64,
    mean: Vec<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    path_step: Vec<f64>,
    path_covariance: Vec<f64>,
    /// Points of the current generation, in units of the step from the mean.
    pending: Vec<Vec<f64>>,
    best: Option<(Vec<f64>, f64)>,
    history: History,
}

impl Cma {
    /// Creates a search from `mean`, with the standard deviation `step` in each coordinate, and
    /// `population` points per generation (4 + 3 ln n if not given; more for a noisy function or
    /// one of many minima). The minimum should lie within two or three steps of the start; in unit
    /// coordinates a step of 0.3 suits.
    ///
    /// # Errors
    ///
    /// There are no coordinates, numbers are not finite, the step is not positive, or there are
    /// fewer than four points.
    pub fn new(
        mean: &[f64],
        step: f64,
        population: Option<usize>,
        seed: u64,
    ) -> Result<Self, CmaError> {
        let n = mean.len();
        let population = population.unwrap_or_else(|| Strategy::population(n.max(1)));
        let reason = if n == 0 {
            Some("a search needs at least one parameter".to_owned())
        } else if !mean.iter().all(|m| m.is_finite()) {
            Some(format!("the start {mean:?} must have finite numbers"))
        } else if !(step.is_finite() && step > 0.0) {
            Some(format!(
                "the first step must be positive and finite, not {step}"
            ))
        } else if population < 4 {
            Some(format!(
                "a generation of {population} points is too small: take 4 or more"
            ))
        } else {
            None
        };
        if let Some(reason) = reason {
            return Err(CmaError::Start(reason));
        }
        Ok(Self {
            population,
            seed,
            limits: Limits::default(),
            largest_step: None,
            first_step: step,
            generation: 0,
            mean: mean.to_vec(),
            step,
            covariance: DMatrix::identity(n, n),
            path_step: vec![0.0; n],
            path_covariance: vec![0.0; n],
            pending: Vec::new(),
            best: None,
            history: History::default(),
        })
    }

    /// Sets the limits at which the search ends.
    pub fn with_limits(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }

    /// Limits the step of the search to `largest` (1 for unit coordinates, since a wider
    /// distribution covers the region several times).
    pub fn with_largest_step(mut self, largest: f64) -> Self {
        self.largest_step = Some(largest);
        self
    }

    /// Returns the points of this generation. Until [`tell`](Self::tell) receives their values the
    /// points are the same.
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.pending.is_empty() {
            let n = self.mean.len();
            let (variances, axes) = eigen::eigen(&self.covariance);
            let mut rng = self.generator();
            for _ in 0..self.population {
                let z: Vec<f64> = variances
                    .iter()
                    .map(|v| v.max(0.0).sqrt() * normal(&mut rng))
                    .collect();
                self.pending.push(
                    (0..n)
                        .map(|i| (0..n).map(|j| axes[(i, j)] * z[j]).sum())
                        .collect(),
                );
            }
        }
        self.pending.iter().map(|y| self.at(y)).collect()
    }

    /// Returns the generator of this generation, from seed and number, so that no other state must
    /// be stored.
    fn generator(&self) -> Pcg64 {
        // The odd number is 2^64 over the golden ratio, as in the generator SplitMix64: no two
        // generations of a search share a seed.
        Pcg64::seed_from_u64(self.seed ^ (self.generation + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn at(&self, y: &[f64]) -> Vec<f64> {
        let place = |(m, y): (&f64, &f64)| m + self.step * y;
        self.mean.iter().zip(y).map(place).collect()
    }

    /// Receives the values of the points of the last [`ask`](Self::ask), in their order; `None`, or
    /// a value that is not finite, is a failed run.
    ///
    /// # Errors
    ///
    /// The number of values is not that of the points.
    pub fn tell(&mut self, values: &[Option<f64>]) -> Result<(), CmaError> {
        if values.len() != self.pending.len() {
            return Err(CmaError::Length {
                points: self.pending.len(),
                values: values.len(),
            });
        }
        let value = |k: &usize| values[*k].filter(|v| v.is_finite());
        let (mut ranked, failed): (Vec<usize>, Vec<usize>) =
            (0..values.len()).partition(|k| value(k).is_some());
        ranked.sort_by(|a, b| {
            value(a)
                .partial_cmp(&value(b))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let sorted: Vec<f64> = ranked.iter().filter_map(value).collect();
        self.history.record(&sorted);
        if let (Some(k), Some(lowest)) = (ranked.first(), sorted.first()) {
            if self.best.as_ref().is_none_or(|b| *lowest < b.1) {
                self.best = Some((self.at(&self.pending[*k]), *lowest));
            }
            let successes = ranked.len();
            ranked.extend(failed);
            self.update(&ranked, successes);
        }
        self.pending.clear();
        self.generation += 1;
        Ok(())
    }

    /// Moves the distribution: `order` has the numbers of the points from the best to the worst,
    /// failed runs last.
    fn update(&mut self, ranked: &[usize], successes: usize) {
        let n = self.mean.len();
        let strategy = Strategy::new(n, self.population);
        let (weights, effective) = shared_among(&strategy.weights, successes);
        let points: Vec<&Vec<f64>> = ranked.iter().map(|k| &self.pending[*k]).collect();

        // This is the weighted mean of the better points, and the same in uncorrelated coordinates.
        let mean_step: Vec<f64> = (0..n)
            .map(|i| {
                let better = weights.iter().zip(&points).filter(|(w, _)| **w > 0.0);
                better.map(|(w, y)| w * y[i]).sum()
            })
            .collect();
        let (variances, axes) = eigen::eigen(&self.covariance);
        let whitened = |y: &[f64]| -> Vec<f64> {
            let along = |j: usize| -> f64 { (0..n).map(|i| axes[(i, j)] * y[i]).sum() };
            let scaled: Vec<f64> = (0..n)
                .map(|j| along(j) / variances[j].max(f64::MIN_POSITIVE).sqrt())
                .collect();
            (0..n)
                .map(|i| (0..n).map(|j| axes[(i, j)] * scaled[j]).sum())
                .collect()
        };
        for (m, y) in self.mean.iter_mut().zip(&mean_step) {
            *m += self.step * y;
        }

        let rate = strategy.step_rate;
        let gain = (rate * (2.0 - rate) * effective).sqrt();
        for (p, y) in self.path_step.iter_mut().zip(whitened(&mean_step)) {
            *p = (1.0 - rate) * *p + gain * y;
        }
        let length = self.path_step.iter().map(|p| p * p).sum::<f64>().sqrt();
        let relative = length / strategy.expected_length;
        // The powers of this library have the same bits everywhere.
        let settled = 1.0 - libm::pow(1.0 - rate, 2.0 * (self.generation + 1) as f64);
        let moves_on = relative < (1.4 + 2.0 / (n as f64 + 1.0)) * settled.sqrt();

        let rate = strategy.path_rate;
        let gain = if moves_on {
            (rate * (2.0 - rate) * effective).sqrt()
        } else {
            0.0
        };
        for (p, y) in self.path_covariance.iter_mut().zip(&mean_step) {
            *p = (1.0 - rate) * *p + gain * y;
        }
        let (one, mu) = (strategy.rank_one, strategy.rank_mu);
        let lost = if moves_on {
            0.0
        } else {
            one * rate * (2.0 - rate)
        };
        let kept = 1.0 + lost - one - mu * weights.iter().sum::<f64>();
        let scaled: Vec<f64> = weights
            .iter()
            .zip(&points)
            .map(|(w, y)| match *w < 0.0 {
                // A point far out does not make the matrix indefinite.
                true => {
                    w * n as f64
                        / whitened(y)
                            .iter()
                            .map(|z| z * z)
                            .sum::<f64>()
                            .max(f64::MIN_POSITIVE)
                }
                false => *w,
            })
            .collect();
        for i in 0..n {
            for j in 0..=i {
                let rank_mu: f64 = scaled
                    .iter()
                    .zip(&points)
                    .map(|(w, y)| w * y[i] * y[j])
                    .sum();
                let entry = kept * self.covariance[(i, j)]
                    + one * self.path_covariance[i] * self.path_covariance[j]
                    + mu * rank_mu;
                self.covariance[(i, j)] = entry;
                self.covariance[(j, i)] = entry;
            }
        }
        let change = strategy.step_rate / strategy.step_damping * (relative - 1.0);
        self.step *= libm::exp(change.min(1.0));
        if let Some(largest) = self.largest_step {
            self.step = self.step.min(largest);
        }
    }

    /// Whether the search has ended, and why.
    pub fn stop(&self) -> Option<Stop> {
        let n = self.mean.len();
        let deviations = self.deviations();
        let (variances, _) = eigen::eigen(&self.covariance);
        let widest = variances.iter().copied().fold(0.0, f64::max);
        let narrowest = variances.iter().copied().fold(f64::MAX, f64::min);
        let path = |i: usize| (self.step * self.path_covariance[i]).abs();
        if self.history.failed >= FAILED_GENERATIONS {
            Some(Stop::Failures(self.history.failed))
        } else if (0..n).all(|i| deviations[i] < self.limits.step && path(i) < self.limits.step) {
            Some(Stop::Step)
        } else if self.history.flat(n, self.population, self.limits.value) {
            Some(Stop::Value)
        } else if self.step * widest.sqrt() > MAX_GROWTH * self.first_step {
            Some(Stop::Diverges)
        } else if narrowest * MAX_CONDITION < widest {
            Some(Stop::Condition)
        } else if self.without_effect(&deviations) {
            Some(Stop::Step)
        } else if self.history.stagnates(n, self.population) {
            Some(Stop::Stagnation)
        } else {
            None
        }
    }

    /// Whether a fifth of a standard deviation no longer changes the mean.
    fn without_effect(&self, deviations: &[f64]) -> bool {
        self.mean
            .iter()
            .zip(deviations)
            .any(|(m, d)| *m == m + 0.2 * d)
    }

    /// Returns the mean of the distribution: the estimate of the minimum.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    fn deviations(&self) -> Vec<f64> {
        (0..self.mean.len())
            .map(|i| self.step * self.covariance[(i, i)].max(0.0).sqrt())
            .collect()
    }

    /// Returns the best point that was evaluated, with its value.
    pub fn best(&self) -> Option<(&[f64], f64)> {
        self.best.as_ref().map(|(x, v)| (x.as_slice(), *v))
    }
}

/// Returns the weights if only the first `successes` points may have positive ones, and the
/// effective number of these points.
fn shared_among(weights: &[f64], successes: usize) -> (Vec<f64>, f64) {
    let mut weights = weights.to_vec();
    for weight in weights.iter_mut().skip(successes) {
        *weight = weight.min(0.0);
    }
    let positive = || weights.iter().copied().filter(|w| *w > 0.0);
    let sum: f64 = positive().sum();
    let effective = sum * sum / positive().map(|w| w * w).sum::<f64>();
    for weight in weights.iter_mut().filter(|w| **w > 0.0) {
        *weight /= sum;
    }
    (weights, effective)
}

#[cfg(test)]
mod tests;
