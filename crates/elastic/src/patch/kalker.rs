//! Kalker's coefficients: forces of small creepages on an elliptic patch without slip.

/// Kalker's coefficients of an elliptic patch with the semi-axes a along the rolling and b across
/// it, of like bodies: F_x = -G a b C11 xi, F_y = -G a b (C22 eta + sqrt(a b) C23 phi) (J. J.
/// Kalker, Three-dimensional elastic bodies in rolling contact, 1990, table E3; first in his
/// thesis, Delft 1967).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kalker {
    /// Along the rolling.
    pub c11: f64,
    /// Across it.
    pub c22: f64,
    /// Force across the rolling by spin; the moment of a creepage across it is the opposite.
    pub c23: f64,
}

/// Values for nu = 0, 1/4, 1/2.
type Row = [f64; 3];

/// C11, C22 and C23 for the ratio a/b = 0.1, 0.2, .. 1.
#[expect(
    clippy::approx_constant,
    reason = "3.14 is an entry of the table, not pi"
)]
const SHORT: [[Row; 10]; 3] = [
    [
        [2.51, 3.31, 4.85],
        [2.59, 3.37, 4.81],
        [2.68, 3.44, 4.80],
        [2.78, 3.53, 4.82],
        [2.88, 3.62, 4.83],
        [2.98, 3.72, 4.91],
        [3.09, 3.81, 4.97],
        [3.19, 3.91, 5.05],
        [3.29, 4.01, 5.12],
        [3.40, 4.12, 5.20],
    ],
    [
        [2.51, 2.52, 2.53],
        [2.59, 2.63, 2.66],
        [2.68, 2.75, 2.81],
        [2.78, 2.88, 2.98],
        [2.88, 3.01, 3.14],
        [2.98, 3.14, 3.31],
        [3.09, 3.28, 3.48],
        [3.19, 3.41, 3.65],
        [3.29, 3.54, 3.82],
        [3.40, 3.67, 3.98],
    ],
    [
        [0.334, 0.473, 0.731],
        [0.483, 0.603, 0.809],
        [0.607, 0.715, 0.889],
        [0.720, 0.823, 0.977],
        [0.827, 0.929, 1.07],
        [0.930, 1.03, 1.18],
        [1.03, 1.14, 1.29],
        [1.13, 1.25, 1.40],
        [1.23, 1.36, 1.51],
        [1.33, 1.47, 1.63],
    ],
];

/// The same for the inverse ratio b/a, of patches that are long along the rolling.
const LONG: [[Row; 10]; 3] = [
    [
        [10.7, 11.7, 12.9],
        [6.96, 7.78, 8.82],
        [5.57, 6.34, 7.34],
        [4.84, 5.57, 6.57],
        [4.37, 5.10, 6.11],
        [4.06, 4.78, 5.80],
        [3.82, 4.54, 5.58],
        [3.65, 4.36, 5.42],
        [3.51, 4.22, 5.30],
        [3.40, 4.12, 5.20],
    ],
    [
        [10.7, 12.8, 16.0],
        [6.96, 8.14, 9.79],
        [5.57, 6.40, 7.51],
        [4.84, 5.48, 6.31],
        [4.37, 4.90, 5.56],
        [4.06, 4.50, 5.04],
        [3.82, 4.21, 4.67],
        [3.65, 3.99, 4.39],
        [3.51, 3.81, 4.16],
        [3.40, 3.67, 3.98],
    ],
    [
        [12.2, 14.6, 18.0],
        [5.72, 6.63, 7.89],
        [3.79, 4.32, 5.01],
        [2.88, 3.24, 3.70],
        [2.35, 2.62, 2.96],
        [2.01, 2.23, 2.50],
        [1.76, 1.95, 2.18],
        [1.58, 1.75, 1.94],
        [1.44, 1.59, 1.77],
        [1.33, 1.47, 1.63],
    ],
];

impl Kalker {
    /// Returns the coefficients for a ratio of semi-axes, along over across, from 0.1 to 10, and
    /// Poisson's ratio from 0 to 0.5; `None` outside. They are linear between rows, and a parabola
    /// of their inverse through the three Poisson's ratios.
    pub fn new(ratio: f64, poisson: f64) -> Option<Self> {
        if !(0.0..=0.5).contains(&poisson) || !(0.1..=10.0).contains(&ratio) {
            return None;
        }
        let (tables, short_over_long) = if ratio <= 1.0 {
            (&SHORT, ratio)
        } else {
            (&LONG, 1.0 / ratio)
        };
        let [c11, c22, c23] = [0, 1, 2].map(|k| between(&tables[k], short_over_long, poisson));
        Some(Self { c11, c22, c23 })
    }
}

fn between(table: &[Row; 10], short_over_long: f64, poisson: f64) -> f64 {
    let place = (10.0 * short_over_long - 1.0).clamp(0.0, 9.0);
    let row = (place.floor() as usize).min(8);
    let part = place - row as f64;
    let compliance =
        |column: usize| 1.0 / (table[row][column] * (1.0 - part) + table[row + 1][column] * part);
    // These are Lagrange's polynomials of the nodes 0, 1/4, 1/2 in x = 4 nu.
    let x = 4.0 * poisson;
    let weights = [
        (x - 1.0) * (x - 2.0) / 2.0,
        x * (2.0 - x),
        x * (x - 1.0) / 2.0,
    ];
    let sum: f64 = weights
        .iter()
        .enumerate()
        .map(|(k, w)| w * compliance(k))
        .sum();
    1.0 / sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// For a patch that is short along the rolling (a strip) C11 tends to pi²/(4 (1 - nu)), C22 to
    /// pi²/4, Kalker's asymptotes.
    #[test]
    fn a_short_patch_tends_to_the_strip() {
        for poisson in [0.0, 0.25, 0.5] {
            let limits = [PI * PI / (4.0 * (1.0 - poisson)), PI * PI / 4.0];
            let short = Kalker::new(0.1, poisson).unwrap();
            for (got, limit) in [short.c11, short.c22].into_iter().zip(limits) {
                assert!((got / limit - 1.0).abs() < 0.03, "{poisson}: {got} {limit}");
            }
        }
        assert!(Kalker::new(0.09, 0.3).is_none() && Kalker::new(11.0, 0.3).is_none());
        assert!(Kalker::new(1.0, 0.51).is_none());
    }

    /// At nu = 0 both directions are equal; a circle is in both tables; spin couples more in a long
    /// patch.
    #[test]
    fn tables_agree_where_they_meet() {
        for ratio in [0.15, 0.5, 1.0, 2.5, 7.0] {
            let k = Kalker::new(ratio, 0.0).unwrap();
            assert!((k.c11 - k.c22).abs() < 1e-12, "{ratio}");
        }
        assert_eq!(SHORT.map(|t| t[9]), LONG.map(|t| t[9]));
        for poisson in [0.0, 0.1, 0.3, 0.5] {
            let rising = |of: fn(&Kalker) -> f64| {
                let values =
                    (1..=100).map(|k| of(&Kalker::new(0.1 * f64::from(k), poisson).unwrap()));
                values
                    .collect::<Vec<_>>()
                    .windows(2)
                    .all(|w| w[0] < w[1] + 0.05)
            };
            assert!(rising(|k| k.c22) && rising(|k| k.c23));
        }
    }
}
