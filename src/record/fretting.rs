//! What the cycles of a fretting test say together: its regime, and wear against the energy that was dissipated.

use super::friction::Cycle;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A_t: from this energy ratio E_d/(4 Q delta) on, the whole contact slides. The value of an elastic sphere on a
/// flat at the end of partial slip; S. Fouvry, Ph. Kapsa, L. Vincent, "Quantification of fretting damage", Wear 200
/// (1996) 186.
pub const TRANSITION: f64 = 0.2;

/// How a contact slides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Regime {
    /// Part of it sticks in every cycle.
    #[default]
    Partial,
    /// Some cycles are of one kind, some of the other.
    Mixed,
    /// All of it slides in every cycle.
    Gross,
}

impl Regime {
    /// Of one cycle, by its energy ratio.
    pub fn of(energy_ratio: f64) -> Self {
        if energy_ratio < TRANSITION {
            Self::Partial
        } else {
            Self::Gross
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Partial => "partial slip",
            Self::Mixed => "mixed",
            Self::Gross => "gross slip",
        }
    }
}

/// A slope by least squares, with its interval of 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// The slope.
    pub value: f64,
    /// Half the width of its interval; none for two points.
    pub half_width: Option<f64>,
}

/// The outcome of a fretting test.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// Running regime over all complete cycles.
    pub regime: Regime,
    /// Energy dissipated in all complete cycles, the sum of E_d (J; J/m in 2D), also of those jumped over.
    pub energy: f64,
    /// Volume worn off first bodies in them (m^3; m^3/m).
    pub wear_volume: f64,
    /// Wear volume against cumulated energy, alpha (m^3/J); none below two cycles, or without wear.
    pub alpha: Option<Slope>,
}

impl Outcome {
    /// Of the complete cycles; none without any.
    pub fn new(cycles: &[Cycle]) -> Option<Self> {
        let complete: Vec<&Cycle> = cycles.iter().filter(|c| c.complete).collect();
        let first = complete.first()?;
        let kind = Regime::of(first.energy_ratio);
        let same = complete.iter().all(|c| Regime::of(c.energy_ratio) == kind);
        let (mut energy, mut volume) = (0.0, 0.0);
        let mut points = vec![(0.0, 0.0)];
        for c in &complete {
            energy += c.work * (1.0 + f64::from(c.jumped));
            volume += c.wear_volume;
            points.push((energy, volume));
        }
        Some(Self {
            regime: if same { kind } else { Regime::Mixed },
            energy,
            wear_volume: volume,
            alpha: if volume > 0.0 { slope(&points) } else { None },
        })
    }
}

/// The straight line through points by least squares.
fn slope(points: &[(f64, f64)]) -> Option<Slope> {
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    if xx <= 0.0 {
        return None;
    }
    let value = xy / xx;
    let rest: f64 = points
        .iter()
        .map(|p| (p.1 - y - value * (p.0 - x)).powi(2))
        .sum();
    let freedom = n - 2.0;
    let t = StudentsT::new(0.0, 1.0, freedom)
        .ok()
        .filter(|_| freedom > 0.5);
    let half_width = t.map(|t| t.inverse_cdf(0.975) * (rest / freedom / xx).sqrt());
    Some(Slope { value, half_width })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle(work: f64, wear_volume: f64, energy_ratio: f64) -> Cycle {
        Cycle {
            complete: true,
            work,
            wear_volume,
            energy_ratio,
            ..Cycle::default()
        }
    }

    #[test]
    fn regimes_follow_the_energy_ratio() {
        let of = |ratios: &[f64]| {
            let cycles: Vec<Cycle> = ratios.iter().map(|a| cycle(1.0, 0.0, *a)).collect();
            Outcome::new(&cycles).unwrap().regime
        };
        assert_eq!(of(&[0.05, 0.19]), Regime::Partial);
        assert_eq!(of(&[0.05, 0.4]), Regime::Mixed);
        assert_eq!(of(&[0.9, 0.4]), Regime::Gross);
        assert!(Outcome::new(&[]).is_none());
    }

    #[test]
    fn a_wear_law_of_the_energy_has_its_coefficient_as_slope() {
        let alpha = 2e-14;
        let works = [1.0, 0.8, 1.3, 1.1];
        let cycles: Vec<Cycle> = works.iter().map(|w| cycle(*w, alpha * w, 0.8)).collect();
        let outcome = Outcome::new(&cycles).unwrap();
        let slope = outcome.alpha.unwrap();
        assert!((slope.value / alpha - 1.0).abs() < 1e-12);
        assert!(slope.half_width.unwrap() < 1e-6 * alpha);
    }

    #[test]
    fn the_interval_of_a_slope_is_the_books() {
        // Residuals of x = 1..5, y = 1.1, 1.9, 3.2, 3.9, 5.0: slope 0.98, s^2 = 0.068/3, t(3) = 3.18245.
        let y = [1.1, 1.9, 3.2, 3.9, 5.0];
        let points: Vec<(f64, f64)> = y
            .iter()
            .enumerate()
            .map(|(k, y)| (k as f64 + 1.0, *y))
            .collect();
        let s = slope(&points).unwrap();
        assert!((s.value - 0.98).abs() < 1e-12);
        let rest: f64 = points
            .iter()
            .map(|(x, y)| (y - 3.02 - 0.98 * (x - 3.0)).powi(2))
            .sum();
        let expected = 3.182_446 * (rest / 3.0 / 10.0).sqrt();
        assert!((s.half_width.unwrap() / expected - 1.0).abs() < 1e-6);
    }
}
