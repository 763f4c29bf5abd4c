//! Analysis of variance of a full grid: main effects and interactions of two factors.
//!
//! Fisher, Statistical Methods for Research Workers, 1925; in the notation of Montgomery, Design
//! and Analysis of Experiments, chapter 5. With the mean m_c of each combination of levels, c =
//! 1..N, each of n runs, and m_a the mean of the combinations with the level a of the factor A, of
//! l_A levels:
//!
//! ```text
//! SS_A  = n N / l_A  sum_a (m_a - m)^2                           l_A - 1 degrees of freedom
//! SS_AB = n N / (l_A l_B)  sum_ab (m_ab - m_a - m_b + m)^2       (l_A - 1)(l_B - 1)
//! SS_E  = sum over all runs (y - m_c)^2                          runs - N, the noise of the seeds
//! F_A   = (SS_A / df_A) / (SS_E / df_E)
//! ```
//!
//! The remainder of SS_total are interactions of three and more factors. Without repeated seeds
//! they replace the noise, if there are any. Combinations with different numbers of runs are
//! treated by Yates' method of unweighted means: n is the harmonic mean of the numbers.

use super::SensitivityError;
use super::points::{Noise, Points, mean, squares};
use crate::statistics::distribution::fisher_upper;

/// One line of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The factor, or the two factors of an interaction.
    pub factors: Vec<usize>,
    /// Sum of squares.
    pub squares: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Share of the variance of all runs, SS / SS_total.
    pub eta_squared: f64,
    /// Ratio of its mean square to that of the error.
    pub f: Option<f64>,
    /// Probability of such a ratio if there is no effect.
    pub p: Option<f64>,
}

/// Error with which the effects are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorTerm {
    /// The noise between seeds of a combination.
    Seeds,
    /// Interactions of three and more factors: an upper bound of the noise.
    HigherInteractions,
    /// None: there are neither repeated seeds nor three factors.
    Unknown,
}

/// The table of an analysis of variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Anova {
    /// Effects of one factor, in order, then interactions of two.
    pub effects: Vec<Effect>,
    /// Share of the variance by interactions of three and more factors.
    pub higher: f64,
    /// Share of the variance by the noise of seeds.
    pub noise_share: f64,
    /// The noise, where seeds are repeated.
    pub noise: Option<Noise>,
    /// Error with which the effects are compared.
    pub error_term: ErrorTerm,
    /// Sum of squares of all runs.
    pub total: f64,
}

/// Analyses runs of a full grid: a row has the level of each factor, from 0 to `levels` - 1,
/// repeated rows are seeds, `None` is a run that failed. A factor of one level has no line.
///
/// # Errors
///
/// Rows have different lengths, the number of outputs is wrong, a combination has no successful
/// run, or all outputs are equal.
pub fn anova(
    levels: &[usize],
    rows: &[Vec<usize>],
    outputs: &[Option<f64>],
) -> Result<Anova, SensitivityError> {
    let points = Points::gather(rows, outputs)?;
    let cells: usize = levels.iter().product();
    let known = points.rows.len();
    let fits = |row: &Vec<usize>| {
        row.len() == levels.len() && row.iter().zip(levels).all(|(l, count)| l < count)
    };
    if known != cells || !points.rows.iter().all(fits) {
        return Err(SensitivityError::Cells {
            missing: cells.saturating_sub(known),
            cells,
        });
    }
    let table = Table {
        levels,
        means: points.means(),
        points: &points,
        runs: points.runs_per_point(),
    };
    table.analyse()
}

struct Table<'a> {
    levels: &'a [usize],
    points: &'a Points<usize>,
    means: Vec<f64>,
    runs: f64,
}

impl Table<'_> {
    fn analyse(&self) -> Result<Anova, SensitivityError> {
        let varied: Vec<usize> = (0..self.levels.len())
            .filter(|f| self.levels[*f] > 1)
            .collect();
        let mut parts: Vec<(Vec<usize>, f64, usize)> = Vec::new();
        for &a in &varied {
            parts.push((vec![a], self.main(a), self.levels[a] - 1));
        }
        for (place, &a) in varied.iter().enumerate() {
            for &b in &varied[place + 1..] {
                let degrees = (self.levels[a] - 1) * (self.levels[b] - 1);
                parts.push((vec![a, b], self.interaction(a, b), degrees));
            }
        }
        let between = self.runs * squares(&self.means);
        let within: f64 = self.points.outputs.iter().map(|v| squares(v)).sum();
        let total = between + within;
        if total <= 0.0 {
            return Err(SensitivityError::Constant);
        }
        let explained: f64 = parts.iter().map(|p| p.1).sum();
        let higher = (between - explained).max(0.0);
        let higher_degrees = self.means.len() - 1 - parts.iter().map(|p| p.2).sum::<usize>();
        let noise = self.points.noise();
        let (error_term, error) = match noise {
            Some(noise) => (ErrorTerm::Seeds, Some((noise.variance, noise.degrees))),
            None if higher_degrees > 0 => (
                ErrorTerm::HigherInteractions,
                Some((higher / higher_degrees as f64, higher_degrees)),
            ),
            None => (ErrorTerm::Unknown, None),
        };
        let effect = |(factors, squares, degrees): (Vec<usize>, f64, usize)| {
            let f = error.map(|(variance, _)| squares / degrees as f64 / variance);
            Effect {
                factors,
                squares,
                degrees,
                eta_squared: squares / total,
                f,
                p: f.zip(error)
                    .and_then(|(f, e)| fisher_upper(f, degrees as f64, e.1 as f64)),
            }
        };
        Ok(Anova {
            effects: parts.into_iter().map(effect).collect(),
            higher: higher / total,
            noise_share: within / total,
            noise,
            error_term,
            total,
        })
    }

    /// Returns the mean of the combinations with each level of a factor.
    fn level_means(&self, factor: usize) -> Vec<f64> {
        self.means_by(self.levels[factor], |row| row[factor])
    }

    fn means_by(&self, groups: usize, group: impl Fn(&[usize]) -> usize) -> Vec<f64> {
        let mut sums = vec![0.0; groups];
        for (row, value) in self.points.rows.iter().zip(&self.means) {
            sums[group(row)] += value;
        }
        let each = self.means.len() as f64 / groups as f64;
        sums.iter().map(|s| s / each).collect()
    }

    fn main(&self, factor: usize) -> f64 {
        let each = self.means.len() as f64 / self.levels[factor] as f64;
        self.runs * each * squares(&self.level_means(factor))
    }

    fn interaction(&self, a: usize, b: usize) -> f64 {
        let (of_a, of_b) = (self.level_means(a), self.level_means(b));
        let width = self.levels[b];
        let both = self.means_by(self.levels[a] * width, |row| row[a] * width + row[b]);
        let whole = mean(&self.means);
        let squares: f64 = both
            .iter()
            .enumerate()
            .map(|(i, m)| (m - of_a[i / width] - of_b[i % width] + whole).powi(2))
            .sum();
        self.runs * self.means.len() as f64 / both.len() as f64 * squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::grid::full_factorial;
    use crate::statistics::random::normal;
    use rand::SeedableRng;

    /// The data are the life of batteries by material and temperature (Montgomery, Design and
    /// Analysis of Experiments, table 5.1), with the published analysis (table 5.5).
    #[test]
    fn battery_lives_by_montgomery() {
        let cells: [[f64; 4]; 9] = [
            [130.0, 155.0, 74.0, 180.0],
            [34.0, 40.0, 80.0, 75.0],
            [20.0, 70.0, 82.0, 58.0],
            [150.0, 188.0, 159.0, 126.0],
            [136.0, 122.0, 106.0, 115.0],
            [25.0, 70.0, 58.0, 45.0],
            [138.0, 110.0, 168.0, 160.0],
            [174.0, 120.0, 150.0, 139.0],
            [96.0, 104.0, 82.0, 60.0],
        ];
        let grid = full_factorial(&[3, 3]).unwrap();
        let (mut rows, mut outputs) = (Vec::new(), Vec::new());
        for (row, cell) in grid.iter().zip(cells) {
            for life in cell {
                rows.push(row.clone());
                outputs.push(Some(life));
            }
        }
        let table = anova(&[3, 3], &rows, &outputs).unwrap();
        let published = [
            (10683.72, 2, 7.91),
            (39118.72, 2, 28.97),
            (9613.78, 4, 3.56),
        ];
        for (effect, (squares, degrees, f)) in table.effects.iter().zip(published) {
            assert!((effect.squares - squares).abs() < 0.006, "{effect:?}");
            assert_eq!(effect.degrees, degrees);
            assert!((effect.f.unwrap() - f).abs() < 0.006, "{effect:?}");
        }
        assert!((table.total - 77646.97).abs() < 0.006);
        let noise = table.noise.unwrap();
        assert!((noise.variance - 675.21).abs() < 0.006);
        assert_eq!(noise.degrees, 27);
        assert!((table.effects[0].p.unwrap() - 0.0020).abs() < 5e-5);
        assert!((table.effects[2].p.unwrap() - 0.0186).abs() < 5e-5);
        let shares: f64 = table.effects.iter().map(|e| e.eta_squared).sum();
        assert!((shares + table.higher + table.noise_share - 1.0).abs() < 1e-12);
    }

    /// A factor without effect has p below 0.05 in 5 % of studies (standard error 0.7 % over 1000);
    /// and the shares of planted effects are found. y = a + 2 b + noise of variance 1/4, a in {0,
    /// 1}, b in {0, 1, 2}, c without effect: the variances of a and b over the grid are 1/4 and
    /// 8/3.
    #[test]
    fn noise_is_not_taken_for_an_effect() {
        let grid = full_factorial(&[2, 3, 2]).unwrap();
        let rows = [grid.clone(), grid.clone(), grid].concat();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(9);
        let (mut significant, mut of_b) = (0, 0.0);
        for _ in 0..1000 {
            let outputs: Vec<_> = rows
                .iter()
                .map(|r| Some((r[0] + 2 * r[1]) as f64 + 0.5 * normal(&mut rng)))
                .collect();
            let table = anova(&[2, 3, 2], &rows, &outputs).unwrap();
            assert_eq!(table.error_term, ErrorTerm::Seeds);
            assert!(table.effects[1].p.unwrap() < 1e-6);
            significant += usize::from(table.effects[2].p.unwrap() < 0.05);
            of_b += table.effects[1].eta_squared / 1000.0;
        }
        assert!((30..=72).contains(&significant), "{significant}");
        let truth = (8.0 / 3.0) / (0.25 + 8.0 / 3.0 + 0.25);
        assert!((of_b - truth).abs() < 0.01, "{of_b} {truth}");
    }

    /// Without repeated seeds: y = a b c, all from {-1, 1}, is an interaction of three factors
    /// alone.
    #[test]
    fn higher_interactions_take_the_place_of_noise() {
        let rows = full_factorial(&[2, 2, 2]).unwrap();
        let sign = |l: usize| 2.0 * l as f64 - 1.0;
        let outputs: Vec<_> = rows
            .iter()
            .map(|r| Some(sign(r[0]) * sign(r[1]) * sign(r[2]) + 4.0 * sign(r[1])))
            .collect();
        let table = anova(&[2, 2, 2], &rows, &outputs).unwrap();
        assert_eq!(table.error_term, ErrorTerm::HigherInteractions);
        assert!((table.higher - 1.0 / 17.0).abs() < 1e-14);
        assert!((table.effects[1].eta_squared - 16.0 / 17.0).abs() < 1e-14);
        assert!((table.effects[1].f.unwrap() - 16.0).abs() < 1e-12);
        let two = anova(
            &[2, 2],
            &full_factorial(&[2, 2]).unwrap(),
            &[1.0, 2.0, 3.0, 5.0].map(Some),
        )
        .unwrap();
        assert_eq!(two.error_term, ErrorTerm::Unknown);
        assert_eq!(two.effects[0].p, None);
        // (5 - 3 - 2 + 1) / 4 is the contrast of the interaction.
        assert!((two.effects[2].squares - 0.25).abs() < 1e-14);
    }

    #[test]
    fn an_incomplete_grid_is_refused() {
        let rows = full_factorial(&[2, 2]).unwrap();
        let error = anova(&[2, 2], &rows, &[Some(1.0), None, Some(2.0), Some(3.0)]).unwrap_err();
        assert_eq!(
            error,
            SensitivityError::Cells {
                missing: 1,
                cells: 4
            }
        );
        assert_eq!(
            anova(&[2, 2], &rows, &[Some(1.0); 4]).unwrap_err(),
            SensitivityError::Constant
        );
    }
}
