//! Random numbers that are the same on all machines.

use rand::RngExt;
use rand_pcg::Pcg64;

/// Returns a standard normal variate (Box and Muller, Ann. Math. Statist. 29 (1958) 610).
pub(crate) fn normal(rng: &mut Pcg64) -> f64 {
    let (a, b): (f64, f64) = (rng.random(), rng.random());
    libm::sqrt(-2.0 * libm::log(1.0 - a)) * libm::cos(std::f64::consts::TAU * b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    /// The mean is 0, the variance 1, the fourth moment 3, with standard errors 0.002, 0.003 and
    /// 0.02 over 200,000 values (their variances are 1, 2 and 96).
    #[test]
    fn has_the_moments_of_the_normal_distribution() {
        let mut rng = Pcg64::seed_from_u64(1);
        let values: Vec<f64> = (0..200_000).map(|_| normal(&mut rng)).collect();
        let moment = |k: i32| values.iter().map(|v| v.powi(k)).sum::<f64>() / 200_000.0;
        assert!(moment(1).abs() < 0.009);
        assert!((moment(2) - 1.0).abs() < 0.013);
        assert!((moment(4) - 3.0).abs() < 0.09);
    }
}
