//! Runs grouped by point: the seeds of a point give its mean and the noise.

use super::{SensitivityError, check_lengths};

/// Variance of the output between seeds of the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Variance of one run, pooled over the points.
    pub variance: f64,
    /// Degrees of freedom: number of runs less number of points.
    pub degrees: usize,
}

/// Points with the outputs of their runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Points<T> {
    /// Each point once, in the order of its first run.
    pub rows: Vec<Vec<T>>,
    /// Outputs of each point's successful runs; at least one.
    pub outputs: Vec<Vec<f64>>,
    /// Number of failed runs.
    pub failed: usize,
}

impl<T: PartialEq + Clone> Points<T> {
    /// Groups runs (`rows`, one each, the point without the seed) with their outputs. Runs with
    /// equal rows are seeds of one point; points without any output are left out.
    ///
    /// # Errors
    ///
    /// Rows have different lengths, or the number of outputs is wrong.
    pub fn gather(rows: &[Vec<T>], outputs: &[Option<f64>]) -> Result<Self, SensitivityError> {
        check_lengths(rows, outputs.len())?;
        let mut points = Self {
            rows: Vec::new(),
            outputs: Vec::new(),
            failed: 0,
        };
        for (row, output) in rows.iter().zip(outputs) {
            let Some(output) = output.filter(|v| v.is_finite()) else {
                points.failed += 1;
                continue;
            };
            match points.rows.iter().position(|r| r == row) {
                Some(known) => points.outputs[known].push(output),
                None => {
                    points.rows.push(row.clone());
                    points.outputs.push(vec![output]);
                }
            }
        }
        Ok(points)
    }

    /// Returns the mean output of each point.
    pub fn means(&self) -> Vec<f64> {
        self.outputs.iter().map(|v| mean(v)).collect()
    }

    /// The noise, if any point has several runs.
    pub fn noise(&self) -> Option<Noise> {
        let runs: usize = self.outputs.iter().map(Vec::len).sum();
        let degrees = runs - self.outputs.len();
        let squares: f64 = self.outputs.iter().map(|v| squares(v)).sum();
        (degrees > 0).then(|| Noise {
            variance: squares / degrees as f64,
            degrees,
        })
    }

    /// Returns the harmonic mean of the number of runs of a point: the noise of a point's mean has
    /// on average the variance of one run divided by it.
    pub fn runs_per_point(&self) -> f64 {
        let inverse: f64 = self.outputs.iter().map(|v| 1.0 / v.len() as f64).sum();
        self.outputs.len() as f64 / inverse
    }
}

/// Returns the mean of a list that is not empty.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the sum of the squared differences from the mean.
pub(super) fn squares(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|v| (v - centre).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_of_a_point_are_gathered() {
        let rows = [[1, 2], [1, 3], [1, 2], [4, 4], [1, 3]].map(|r| r.to_vec());
        let outputs = [Some(1.0), Some(5.0), Some(3.0), None, None];
        let points = Points::gather(&rows, &outputs).unwrap();
        assert_eq!(points.rows, [[1, 2], [1, 3]]);
        assert_eq!(points.means(), [2.0, 5.0]);
        assert_eq!(points.failed, 2);
        let noise = points.noise().unwrap();
        assert_eq!((noise.variance, noise.degrees), (2.0, 1));
        assert!((points.runs_per_point() - 4.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn errors_say_which_run() {
        let rows = vec![vec![1.0], vec![1.0, 2.0]];
        let error = Points::gather(&rows, &[None, None]).unwrap_err();
        assert!(error.to_string().contains("run 1 has 2 factors"), "{error}");
        assert!(Points::gather(&rows[..1], &[]).is_err());
    }
}
