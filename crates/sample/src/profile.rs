//! Random rough profiles and surfaces.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Generates a periodic self-affine profile: heights (m) at `points` equidistant positions, zero
/// mean, the given root-mean-square, power spectrum |q|^(-1 - 2H) between the two wavelengths,
/// random phases.
///
/// B. N. J. Persson et al., J. Phys.: Condens. Matter 17 (2005) R1.
pub fn rough(
    points: usize,
    period: f64,
    rms: f64,
    hurst: f64,
    longest: f64,
    shortest: f64,
    seed: u64,
) -> Vec<f64> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut heights = vec![0.0; points];
    for mode in waves(points, period, longest, shortest) {
        let amplitude = (mode as f64).powf(-0.5 - hurst);
        let phase = rng.random_range(0.0..TAU);
        for (k, z) in heights.iter_mut().enumerate() {
            *z += amplitude * (TAU * mode as f64 * k as f64 / points as f64 + phase).cos();
        }
    }
    scale(&mut heights, rms);
    heights
}

/// Wave numbers of a rough profile, in waves per period.
pub fn waves(
    points: usize,
    period: f64,
    longest: f64,
    shortest: f64,
) -> std::ops::RangeInclusive<usize> {
    let low = (period / longest).ceil().max(1.0) as usize;
    let high = ((period / shortest).floor() as usize)
        .min(points / 2)
        .max(low);
    low..=high
}

/// Independent random heights (m) of the given root-mean-square and zero mean.
pub fn noise(count: usize, rms: f64, seed: u64) -> Vec<f64> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut heights: Vec<f64> = (0..count).map(|_| rng.random_range(-1.0..1.0)).collect();
    scale(&mut heights, rms);
    heights
}

fn scale(heights: &mut [f64], rms: f64) {
    let n = heights.len().max(1) as f64;
    let mean = heights.iter().sum::<f64>() / n;
    heights.iter_mut().for_each(|z| *z -= mean);
    let now = (heights.iter().map(|z| z * z).sum::<f64>() / n).sqrt();
    if now > 0.0 {
        heights.iter_mut().for_each(|z| *z *= rms / now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_the_roughness_asked_for() {
        let z = rough(256, 1e-3, 2e-6, 0.8, 1e-3, 2e-5, 5);
        let rms = (z.iter().map(|z| z * z).sum::<f64>() / 256.0).sqrt();
        assert!((rms / 2e-6 - 1.0).abs() < 1e-12 && z.iter().sum::<f64>().abs() < 1e-15);
        assert_eq!(z, rough(256, 1e-3, 2e-6, 0.8, 1e-3, 2e-5, 5));
        assert_ne!(z, rough(256, 1e-3, 2e-6, 0.8, 1e-3, 2e-5, 6));
    }
}
