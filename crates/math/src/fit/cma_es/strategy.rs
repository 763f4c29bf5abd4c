//! Weights and rates of the strategy: table 1 of Hansen's tutorial (arXiv:1604.00772), with the
//! numbers of its equations.

/// Constants of a search in n dimensions with lambda points per generation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strategy {
    /// Weight of each rank, best first; the first half positive with the sum 1, the rest negative
    /// (eq. 49 to 53).
    pub weights: Vec<f64>,
    /// Effective number of selected points mu_eff (eq. 8).
    pub effective: f64,
    /// Rate of the step size c_sigma (eq. 55).
    pub step_rate: f64,
    /// Damping d_sigma.
    pub step_damping: f64,
    /// Rate of the path of the covariance c_c (eq. 56).
    pub path_rate: f64,
    /// Rate of the rank-one update c_1 (eq. 57).
    pub rank_one: f64,
    /// Rate of the rank-mu update c_mu (eq. 58).
    pub rank_mu: f64,
    /// Expected length of a standard normal vector.
    pub expected_length: f64,
}

impl Strategy {
    pub(super) fn new(dimensions: usize, population: usize) -> Self {
        let n = dimensions as f64;
        let half = population / 2;
        let rank =
            |i: usize| libm::log((population as f64 + 1.0) / 2.0) - libm::log(i as f64 + 1.0);
        let mut weights: Vec<f64> = (0..population).map(rank).collect();
        let sum = |w: &[f64]| w.iter().sum::<f64>();
        let effective_of = |w: &[f64]| sum(w).powi(2) / w.iter().map(|v| v * v).sum::<f64>();
        let effective = effective_of(&weights[..half]);
        let effective_negative = effective_of(&weights[half..]);

        let step_rate = (effective + 2.0) / (n + effective + 5.0);
        let step_damping =
            1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + step_rate;
        let path_rate = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        let rank_one = 2.0 / ((n + 1.3).powi(2) + effective);
        let rank_mu = (1.0 - rank_one).min(
            2.0 * (0.25 + effective + 1.0 / effective - 2.0) / ((n + 2.0).powi(2) + effective),
        );

        let by_rank_one = 1.0 + rank_one / rank_mu;
        let by_effective = 1.0 + 2.0 * effective_negative / (effective + 2.0);
        let by_definiteness = (1.0 - rank_one - rank_mu) / (n * rank_mu);
        let negative = by_rank_one.min(by_effective).min(by_definiteness);
        let positive_sum = sum(&weights[..half]);
        let negative_sum: f64 = weights.iter().filter(|w| **w < 0.0).map(|w| -w).sum();
        for weight in &mut weights {
            *weight *= if *weight >= 0.0 {
                1.0 / positive_sum
            } else {
                negative / negative_sum
            };
        }
        Self {
            weights,
            effective,
            step_rate,
            step_damping,
            path_rate,
            rank_one,
            rank_mu,
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }

    /// Returns the number of points per generation: 4 + 3 ln n (eq. 48).
    pub(super) fn population(dimensions: usize) -> usize {
        4 + (3.0 * (dimensions as f64).ln()).floor() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The default population sizes of the tutorial satisfy its statements on the weights: mu_eff
    /// is about 0.3 lambda, positive weights sum to 1, negative ones to at most -1 - 2 mu_eff^- /
    /// (mu_eff + 2).
    #[test]
    fn follows_the_table() {
        for (n, population) in [(2, 6), (3, 7), (5, 8), (8, 10), (10, 10), (20, 12)] {
            assert_eq!(Strategy::population(n), population);
            let s = Strategy::new(n, population);
            let positive: f64 = s.weights.iter().filter(|w| **w > 0.0).sum();
            assert!((positive - 1.0).abs() < 1e-14);
            assert!(s.weights.is_sorted_by(|a, b| a >= b));
            let ratio = s.effective / population as f64;
            assert!((0.25..0.36).contains(&ratio), "{n}: {ratio}");
            // The update leaves a positive part of the old matrix.
            assert!(s.rank_one + s.rank_mu * s.weights.iter().sum::<f64>() < 1.0);
        }
    }
}
