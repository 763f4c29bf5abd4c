//! Means over seeds with their intervals.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Mean over seeds, and half-width of its 95 % interval by Student's t; infinite for one seed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub mean: f64,
    pub half: f64,
}

impl Estimate {
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let half = match StudentsT::new(0.0, 1.0, n - 1.0) {
            Ok(t) if n > 1.0 => t.inverse_cdf(0.975) * (square / (n * (n - 1.0))).sqrt(),
            _ => f64::INFINITY,
        };
        Self { mean, half }
    }

    /// Lower end; NaN for one seed, for which a figure has no bar and a comparison no answer.
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

    /// `0.284 ± 0.003`.
    pub fn text(self, digits: usize) -> String {
        if self.half.is_finite() {
            format!("{:.digits$} ± {:.digits$}", self.mean, self.half)
        } else {
            format!("{:.digits$} (one run)", self.mean)
        }
    }

    /// In per cent of `whole`, with sign.
    pub fn percent(self, whole: f64) -> String {
        let by = 100.0 / whole.abs();
        if self.half.is_finite() {
            format!("{:+.1} ± {:.1} %", self.mean * by, self.half * by)
        } else {
            format!("{:+.1} % (one run)", self.mean * by)
        }
    }
}

/// Difference of two means of independent samples, with the root of the sum of squares of their half-widths.
pub fn difference(a: Estimate, b: Estimate) -> Estimate {
    Estimate {
        mean: a.mean - b.mean,
        half: a.half.hypot(b.half),
    }
}

/// Least-squares straight line through points: intercept and slope.
pub fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let square: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / square;
    (y - slope * x, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_values_have_students_interval() {
        let e = Estimate::of(&[1.0, 2.0, 3.0]);
        // t of 97.5 % for two degrees of freedom is 4.302653 (Student's table); s = 1.
        assert!((e.mean - 2.0).abs() < 1e-12 && (e.half - 4.302_653 / 3f64.sqrt()).abs() < 1e-5);
        assert!(Estimate::of(&[1.0]).half.is_infinite());
    }

    #[test]
    fn a_line_is_found_again() {
        let (a, b) = line(&[(0.0, 1.0), (1.0, 3.0), (3.0, 7.0)]);
        assert!((a - 1.0).abs() < 1e-12 && (b - 2.0).abs() < 1e-12);
    }
}
