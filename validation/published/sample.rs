//! Means over seeds with their intervals, and straight lines through them.

use fretwork_math::statistics::interval::Mean;

/// A number with the half-width of its 95 % interval; infinite for a mean of one seed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub mean: f64,
    pub half: f64,
}

impl Estimate {
    /// Mean over seeds, with the interval by Student's t.
    pub fn of(values: &[f64]) -> Self {
        Mean::of(values).map_or(
            Self {
                mean: f64::NAN,
                half: f64::INFINITY,
            },
            |m| Self {
                mean: m.mean,
                half: m.half_width.unwrap_or(f64::INFINITY),
            },
        )
    }

    /// A number without an error.
    pub fn certain(mean: f64) -> Self {
        Self { mean, half: 0.0 }
    }

    /// Lower end; NaN for one seed, for which a figure has no bar and a comparison no verdict.
    pub fn low(self) -> f64 {
        self.end(-1.0)
    }

    /// Upper end; NaN for one seed.
    pub fn high(self) -> f64 {
        self.end(1.0)
    }

    fn end(self, side: f64) -> f64 {
        if self.half.is_finite() {
            self.mean + side * self.half
        } else {
            f64::NAN
        }
    }

    /// Returns the number in other units.
    pub fn scaled(self, by: f64) -> Self {
        Self {
            mean: self.mean * by,
            half: self.half * by.abs(),
        }
    }

    /// Sum with an independent number.
    pub fn plus(self, other: Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            half: self.half.hypot(other.half),
        }
    }

    /// `0.284 ± 0.003`.
    pub fn text(self, digits: usize) -> String {
        if self.half.is_finite() {
            format!("{:.digits$} ± {:.digits$}", self.mean, self.half)
        } else {
            format!("{:.digits$} (one run)", self.mean)
        }
    }

    /// Formats the number in per cent of `whole`, with sign.
    pub fn percent(self, whole: f64) -> String {
        let e = self.scaled(100.0 / whole.abs());
        if e.half.is_finite() {
            format!("{:+.1} ± {:.1} %", e.mean, e.half)
        } else {
            format!("{:+.1} % (one run)", e.mean)
        }
    }
}

/// Difference of two means of independent samples, with the root of the sum of squares of their
/// half-widths.
pub fn difference(a: Estimate, b: Estimate) -> Estimate {
    a.plus(b.scaled(-1.0))
}

/// Least-squares straight line, all points with the same weight.
pub struct Line {
    pub intercept: f64,
    pub slope: f64,
    middle: f64,
    square: f64,
    /// Returns the abscissa, and the half-width of the ordinate including that of the abscissa
    /// times the slope.
    points: Vec<(f64, f64)>,
}

impl Line {
    pub fn through(points: &[(Estimate, Estimate)]) -> Self {
        let n = points.len() as f64;
        let middle = points.iter().map(|p| p.0.mean).sum::<f64>() / n;
        let height = points.iter().map(|p| p.1.mean).sum::<f64>() / n;
        let square: f64 = points.iter().map(|p| (p.0.mean - middle).powi(2)).sum();
        let product: f64 = points
            .iter()
            .map(|p| (p.0.mean - middle) * (p.1.mean - height))
            .sum();
        let slope = product / square;
        Self {
            intercept: height - slope * middle,
            slope,
            middle,
            square,
            points: points
                .iter()
                .map(|(x, y)| (x.mean, y.half.hypot(slope * x.half)))
                .collect(),
        }
    }

    pub fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }

    /// Half-width of the ordinate, by propagation of those of the points.
    pub fn half_at(&self, x: f64) -> f64 {
        let n = self.points.len() as f64;
        let weight = |x_k: f64| 1.0 / n + (x - self.middle) * (x_k - self.middle) / self.square;
        let squares = self.points.iter().map(|p| (weight(p.0) * p.1).powi(2));
        squares.sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_values_have_students_interval() {
        let e = Estimate::of(&[1.0, 2.0, 3.0]);
        // Student's t of 97.5 % for two degrees of freedom is 4.302653 (table), and s = 1.
        assert!((e.mean - 2.0).abs() < 1e-12 && (e.half - 4.302_653 / 3f64.sqrt()).abs() < 1e-5);
        assert!(Estimate::of(&[1.0]).half.is_infinite());
    }

    #[test]
    fn a_line_is_found_again_with_its_error() {
        let point = |x: f64| {
            let y = Estimate {
                mean: 1.0 + 2.0 * x,
                half: 0.3,
            };
            (Estimate::certain(x), y)
        };
        let line = Line::through(&[0.0, 1.0, 3.0].map(point));
        assert!((line.intercept - 1.0).abs() < 1e-12 && (line.slope - 2.0).abs() < 1e-12);
        // The half-width is h² (1/n + (x - x̄)²/Σ(x_k - x̄)²), of regression with equal errors:
        // x̄ = 4/3, the sum is 14/3.
        let expected = |x: f64| 0.3 * (1.0 / 3.0 + (x - 4.0 / 3.0).powi(2) * 3.0 / 14.0f64).sqrt();
        for x in [0.0, 4.0 / 3.0, 5.0] {
            assert!((line.half_at(x) - expected(x)).abs() < 1e-12);
        }
    }
}
