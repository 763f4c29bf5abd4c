//! Differences between several alternatives, by runs with the same seeds.
//!
//! Each pair is compared seed by seed: d_k = y_b(seed k) - y_a(seed k), with Student's test of a
//! zero mean. Of many pairs some appear to differ by chance; the probabilities are therefore
//! adjusted by Holm's method (Scand. J. Statist. 6 (1979) 65): sorted p_1 <= p_2 <= ... of m pairs,
//! the adjusted p_i is the largest of (m + 1 - j) p_j over j <= i. If pairs count as different
//! where it is below 5 %, the probability that any of them does not differ is below 5 %.

use crate::statistics::distribution::{student_quantile, student_two_sided};
use crate::statistics::interval::{CONFIDENCE, Mean};

/// Probability to detect a difference of the observed size, for [`Pair::seeds_needed`].
pub const POWER: f64 = 0.8;

/// Largest number of seeds that is proposed.
const MAX_SEEDS: usize = 100_000;

/// Two alternatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Number of the first.
    pub first: usize,
    /// Number of the second.
    pub second: usize,
    /// Second less first, over the common seeds; `None` if there are none. The interval is for this
    /// pair alone.
    pub difference: Option<Mean>,
    /// Probability of such a difference by chance, adjusted for the number of pairs; `None` below
    /// two seeds.
    pub p: Option<f64>,
    /// Whether p is below 5 %.
    pub differs: bool,
    /// Number of seeds with which a difference of the observed size would be detected with the
    /// probability [`POWER`], by the observed scatter and the level of all pairs together; `None`
    /// if no number was found, or below two seeds. For a difference that is only chance this number
    /// changes with every further seed.
    pub seeds_needed: Option<usize>,
}

/// All alternatives compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparisons {
    /// Mean of each alternative; `None` if all its runs failed.
    pub means: Vec<Option<Mean>>,
    /// All pairs, the first number below the second.
    pub pairs: Vec<Pair>,
}

impl Comparisons {
    /// Compares alternatives, with one row each of the output for each seed, with the same seeds in
    /// the same order; `None` is a failed run. Rows may be shorter than others.
    pub fn of(alternatives: &[Vec<Option<f64>>]) -> Self {
        let value = |v: &Option<f64>| v.filter(|v| v.is_finite());
        let means: Vec<Option<Mean>> = alternatives
            .iter()
            .map(|row| Mean::of(&row.iter().filter_map(value).collect::<Vec<_>>()))
            .collect();
        let count = alternatives.len();
        let mut pairs = Vec::new();
        let all = count * count.saturating_sub(1) / 2;
        for first in 0..count {
            for second in first + 1..count {
                let differences: Vec<f64> = alternatives[first]
                    .iter()
                    .zip(&alternatives[second])
                    .filter_map(|(a, b)| Some(value(b)? - value(a)?))
                    .collect();
                pairs.push(Pair::of(first, second, Mean::of(&differences), all));
            }
        }
        let adjusted = holm(&pairs.iter().map(|p| p.p).collect::<Vec<_>>());
        for (pair, p) in pairs.iter_mut().zip(adjusted) {
            pair.p = p;
            pair.differs = p.is_some_and(|p| p < 1.0 - CONFIDENCE);
        }
        Self { means, pairs }
    }
}

impl Pair {
    fn of(first: usize, second: usize, difference: Option<Mean>, pairs: usize) -> Self {
        let level = 1.0 - 0.5 * (1.0 - CONFIDENCE) / pairs as f64;
        let tested = difference.and_then(|d| Some((d, d.scatter?)));
        let error = tested.map(|(d, s)| (d, s / (d.count as f64).sqrt()));
        Self {
            first,
            second,
            difference,
            p: error.and_then(|(d, e)| match d.mean {
                // The values are equal for each seed, or differ by the same number.
                0.0 => Some(1.0),
                mean => student_two_sided(mean / e, (d.count - 1) as f64),
            }),
            differs: false,
            seeds_needed: tested.and_then(|(d, s)| seeds_needed(d.mean.abs(), s, level)),
        }
    }
}

/// The smallest n with (t_level + t_power) s / sqrt(n) <= the difference.
fn seeds_needed(difference: f64, scatter: f64, level: f64) -> Option<usize> {
    let enough = |n: usize| {
        let degrees = (n - 1) as f64;
        let quantiles = student_quantile(level, degrees)
            .zip(student_quantile(POWER, degrees))
            .map(|(a, b)| a + b);
        quantiles.is_some_and(|q| q * scatter <= difference * (n as f64).sqrt())
    };
    if difference == 0.0 || !enough(MAX_SEEDS) {
        return None;
    }
    // The condition holds for all larger n too.
    let (mut below, mut from) = (1, MAX_SEEDS);
    while from - below > 1 {
        let middle = below + (from - below) / 2;
        if enough(middle) {
            from = middle;
        } else {
            below = middle;
        }
    }
    Some(from)
}

/// Returns Holm's adjusted probabilities; pairs without one are not counted.
fn holm(probabilities: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut known: Vec<(usize, f64)> = probabilities
        .iter()
        .enumerate()
        .filter_map(|(i, p)| Some((i, (*p)?)))
        .collect();
    known.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut adjusted = vec![None; probabilities.len()];
    let mut largest: f64 = 0.0;
    for (place, (i, p)) in known.iter().enumerate() {
        largest = largest.max((known.len() - place) as f64 * p).min(1.0);
        adjusted[*i] = Some(largest);
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::normal;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    /// The values follow from the definition: 4 x 0.005, 3 x 0.01, 2 x 0.03, and for 0.04 the
    /// largest so far.
    #[test]
    fn holms_adjustment() {
        let adjusted = holm(&[Some(0.01), Some(0.04), None, Some(0.03), Some(0.005)]);
        let expected = [Some(0.03), Some(0.06), None, Some(0.06), Some(0.02)];
        for (found, expected) in adjusted.iter().zip(expected) {
            assert_eq!(found.is_some(), expected.is_some());
            assert!((found.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-15);
        }
    }

    /// Returns outputs of some alternatives: a common part of each seed, a shift, and noise.
    fn draw(shifts: &[f64], seeds: usize, noise: f64, rng: &mut Pcg64) -> Vec<Vec<Option<f64>>> {
        let common: Vec<f64> = (0..seeds).map(|_| 3.0 * normal(rng)).collect();
        shifts
            .iter()
            .map(|shift| {
                let output = |c: &f64| Some(c + shift + noise * normal(rng));
                common.iter().map(output).collect()
            })
            .collect()
    }

    /// In 1000 comparisons of five equal alternatives fewer than 5 % find any difference (Holm's
    /// bound; standard error 0.7 %).
    #[test]
    fn equals_seldom_seem_to_differ() {
        let mut rng = Pcg64::seed_from_u64(11);
        let mut wrong = 0;
        for _ in 0..1000 {
            let result = Comparisons::of(&draw(&[0.0; 5], 8, 1.0, &mut rng));
            assert_eq!(result.pairs.len(), 10);
            wrong += usize::from(result.pairs.iter().any(|p| p.differs));
        }
        assert!((10..=70).contains(&wrong), "{wrong}");
    }

    /// The common part of the seeds is 3, the difference 1 and the noise 0.2: only paired
    /// differences detect it. The proposed number of seeds detects it in 80 % (one pair; standard
    /// error 1.3 % over 1000, and t quantiles approximate the noncentral distribution).
    #[test]
    fn pairs_find_what_means_hide() {
        let mut rng = Pcg64::seed_from_u64(12);
        let result = Comparisons::of(&draw(&[1.0, 0.0, 0.0], 6, 0.2, &mut rng));
        // The pairs 0-1, 0-2 and 1-2.
        let differ: Vec<bool> = result.pairs.iter().map(|p| p.differs).collect();
        assert_eq!(differ, [true, true, false]);
        let [a, b] = [0, 1].map(|i| result.means[i].unwrap());
        assert!((a.mean - b.mean).abs() < a.half_width.unwrap());

        // The scatter of a difference is sqrt(2).
        let seeds = seeds_needed(1.0, 2f64.sqrt(), 0.975).unwrap();
        let found = (0..1000)
            .filter(|_| Comparisons::of(&draw(&[0.0, 1.0], seeds, 1.0, &mut rng)).pairs[0].differs)
            .count();
        assert!((760..=850).contains(&found), "{seeds} seeds: {found}");
    }

    #[test]
    fn failed_runs_and_certain_differences() {
        let rows = vec![
            vec![Some(1.0), Some(2.0), None],
            vec![Some(2.0), Some(3.0), Some(9.0)],
            vec![Some(1.0), Some(2.0)],
            vec![None, None, None],
        ];
        let result = Comparisons::of(&rows);
        let [certain, equal, _, _, unknown, _] = result.pairs.as_slice() else {
            panic!("{result:?}")
        };
        assert_eq!(
            (certain.p, certain.differs, certain.seeds_needed),
            (Some(0.0), true, Some(2))
        );
        assert_eq!(certain.difference.unwrap().mean, 1.0);
        assert_eq!(
            (equal.p, equal.differs, equal.seeds_needed),
            (Some(1.0), false, None)
        );
        assert_eq!((unknown.first, unknown.second, unknown.p), (1, 3, None));
        assert!(Comparisons::of(&[]).pairs.is_empty());
    }
}
