//! Evaluation of all cycles of a fretting test: sliding regime, and wear against dissipated energy.

use super::cycle::{Cycle, SlipRegime};
use super::quantity::part;
use super::quantity::unit::{ENERGY, VOLUME, WEAR_PER_ENERGY, WORD};
use fretwork_math::statistics::interval;
use serde::Serialize;

crate::described! {
    /// A ratio of sums over cycles with its 95 % confidence interval.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    pub struct CycleRatio {
        /// Worn volume over dissipated energy, of all cycles.
        pub value: f64 => WEAR_PER_ENERGY,
        /// Half-width of its interval, by the jackknife over cycles; `None` for one cycle.
        pub half_width: Option<f64> => WEAR_PER_ENERGY,
    }
}

crate::described! {
    /// Result of a fretting test.
    #[derive(Clone, Debug, Serialize)]
    pub struct FrettingOutcome {
        /// Regime over all complete cycles.
        pub regime: SlipRegime => WORD,
        /// Energy dissipated in all complete cycles, the sum of E_d, including cycles jumped over.
        pub energy: f64 => ENERGY,
        /// Volume worn off first bodies in these cycles.
        pub wear_volume: f64 => VOLUME,
        /// Slope alpha of wear volume against cumulative energy; `None` without wear. E_d is the
        /// area of the loop: if bodies also collide or move normally, the energy dissipated by
        /// friction alone is smaller.
        pub alpha: Option<CycleRatio> = part::<CycleRatio>(),
    }
}

impl FrettingOutcome {
    /// Evaluates the complete cycles; `None` if there are none.
    pub fn new(cycles: &[Cycle]) -> Option<Self> {
        let complete: Vec<&Cycle> = cycles.iter().filter(|c| c.complete).collect();
        let first = complete.first()?;
        let kind = first.regime;
        let same = complete.iter().all(|c| c.regime == kind);
        // A cycle that represents several has the fracture energy of all of them; its neighbours
        // give that of a single one.
        let single = |c: &&&Cycle| c.jumped == 0;
        let energy = |k: usize| {
            let cycle = complete[k];
            if cycle.jumped == 0 {
                return cycle.work;
            }
            let before = complete[..k].iter().rfind(single);
            let after = complete[k + 1..].iter().find(single);
            let beside: Vec<f64> = [before, after]
                .into_iter()
                .flatten()
                .map(|c| c.work)
                .collect();
            let mean = beside.iter().sum::<f64>() / beside.len().max(1) as f64;
            let one = if beside.is_empty() { cycle.work } else { mean };
            one * (1.0 + f64::from(cycle.jumped))
        };
        let represented = |k: usize| (energy(k), complete[k].wear_volume);
        let points: Vec<(f64, f64)> = (0..complete.len()).map(represented).collect();
        let energy = points.iter().map(|p| p.0).sum();
        let volume = points.iter().map(|p| p.1).sum();
        Some(Self {
            regime: if same { kind } else { SlipRegime::Mixed },
            energy,
            wear_volume: volume,
            alpha: if volume > 0.0 { slope(&points) } else { None },
        })
    }
}

/// Returns the sum of y over the sum of x for independent pairs (x, y): the slope of cumulative y
/// against cumulative x. The interval is Student's, from the jackknife's pseudo-values (B. Efron,
/// The Jackknife, the Bootstrap and Other Resampling Plans, 1982).
fn slope(points: &[(f64, f64)]) -> Option<CycleRatio> {
    let n = points.len() as f64;
    let (x, y) = points
        .iter()
        .fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    if x <= 0.0 {
        return None;
    }
    let value = y / x;
    let without: Vec<f64> = points.iter().map(|p| (y - p.1) / (x - p.0)).collect();
    let mean = without.iter().sum::<f64>() / n;
    let square: f64 = without.iter().map(|w| (w - mean).powi(2)).sum();
    let t = interval::quantile(points.len());
    let half_width = t.map(|t| t * ((n - 1.0) / n * square).sqrt());
    Some(CycleRatio { value, half_width })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    fn cycle(work: f64, wear_volume: f64, energy_ratio: f64) -> Cycle {
        Cycle {
            complete: true,
            work,
            wear_volume,
            energy_ratio,
            regime: SlipRegime::of(energy_ratio, 0.0, None),
            ..Cycle::default()
        }
    }

    #[test]
    fn regimes_follow_the_energy_ratio() {
        let of = |ratios: &[f64]| {
            let cycles: Vec<Cycle> = ratios.iter().map(|a| cycle(1.0, 0.0, *a)).collect();
            FrettingOutcome::new(&cycles).unwrap().regime
        };
        assert_eq!(of(&[0.05, 0.19]), SlipRegime::Partial);
        assert_eq!(of(&[0.05, 0.4]), SlipRegime::Mixed);
        assert_eq!(of(&[0.9, 0.4]), SlipRegime::Gross);
        assert!(FrettingOutcome::new(&[]).is_none());
    }

    #[test]
    fn a_wear_law_of_the_energy_has_its_coefficient_as_slope() {
        let alpha = 2e-14;
        let works = [1.0, 0.8, 1.3, 1.1];
        let cycles: Vec<Cycle> = works.iter().map(|w| cycle(*w, alpha * w, 0.8)).collect();
        let outcome = FrettingOutcome::new(&cycles).unwrap();
        let slope = outcome.alpha.unwrap();
        assert!((slope.value / alpha - 1.0).abs() < 1e-12);
        assert!(slope.half_width.unwrap() < 1e-6 * alpha);
    }

    #[test]
    fn the_interval_of_a_slope_covers_it_as_often_as_it_says() {
        // There are twenty cycles, with 5 % noise on the energy and 10 % on the volume.
        let mut rng = Pcg64::seed_from_u64(1);
        let mut noise = |share: f64| {
            let sum: f64 = (0..12).map(|_| rng.random_range(-0.5..0.5)).sum();
            1.0 + share * sum
        };
        let runs = 2000;
        let mut covered = 0;
        for _ in 0..runs {
            let points: Vec<(f64, f64)> =
                (0..20).map(|_| (noise(0.05), 3.0 * noise(0.1))).collect();
            let s = slope(&points).unwrap();
            covered += i32::from((s.value - 3.0).abs() <= s.half_width.unwrap());
        }
        let share = f64::from(covered) / f64::from(runs);
        assert!((0.93..0.97).contains(&share), "{share}");
        assert!(slope(&[(1.0, 2.0)]).unwrap().half_width.is_none());
    }
}
