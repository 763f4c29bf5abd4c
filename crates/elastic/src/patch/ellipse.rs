//! Complete elliptic integrals by the arithmetic-geometric mean.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Returns K and D = (K - E)/m for the parameter m = 1 - k², for an ellipse with the axis ratio k,
/// above 0 and at most 1.
///
/// The differences that Hertz' theory needs are taken from the series of the mean (M. Abramowitz,
/// I. A. Stegun, 17.6), not as differences of K and E, which cancel in a nearly circular patch.
pub(super) fn integrals(k: f64) -> (f64, f64) {
    if k >= 1.0 {
        return (FRAC_PI_2, FRAC_PI_4);
    }
    let m = (1.0 - k) * (1.0 + k);
    let (mut mean, mut root) = (1.0, k);
    let (mut sum, mut power) = (0.5, 1.0);
    while (mean - root).abs() > 1e-16 * mean {
        let half = (mean - root) / 2.0;
        sum += power * half * half / m;
        power *= 2.0;
        (mean, root) = ((mean + root) / 2.0, (mean * root).sqrt());
        if half.abs() < 1e-9 * mean {
            break;
        }
    }
    let first = FRAC_PI_2 / mean;
    (first, first * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values are those of Abramowitz and Stegun, table 17.1.
    #[test]
    fn tabulated_values() {
        for (m, first, second) in [
            (0.1f64, 1.612_441_348_720_219, 1.530_757_636_897_763),
            (0.5, 1.854_074_677_301_372, 1.350_643_881_047_676),
            (0.9, 2.578_092_113_348_173, 1.104_774_732_704_073),
        ] {
            let (k, d) = integrals((1.0 - m).sqrt());
            assert!((k - first).abs() < 1e-13, "{m}: {k}");
            assert!((k - m * d - second).abs() < 1e-13, "{m}: {}", k - m * d);
        }
    }

    #[test]
    fn the_circle_is_the_limit() {
        let (k, d) = integrals(1.0 - 1e-9);
        assert!((k - FRAC_PI_2).abs() < 1e-8 && (d - FRAC_PI_4).abs() < 1e-8);
    }
}
