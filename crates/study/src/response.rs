//! Response curves: the mean output, with its interval over seeds, at each value of one factor.

use crate::interval::Mean;
use serde::{Deserialize, Serialize};

/// A run of a study of one factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Value of the factor.
    pub x: f64,
    /// Seed of the run.
    pub seed: u64,
    /// Output; `None` for a run that failed.
    pub y: Option<f64>,
}

/// One point of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResponsePoint {
    /// Value of the factor.
    pub x: f64,
    /// Mean over the seeds; `None` if all runs failed.
    pub mean: Option<Mean>,
    /// Change from the point before, by the seeds that both have; `None` for the first point, or if they have no seed in common.
    /// Where runs with the same seed scatter alike its interval is narrower than those of the two points.
    pub change: Option<Mean>,
    /// Runs that failed.
    pub failed: usize,
}

/// The curve, in the order of x.
pub fn response_curve(samples: &[Sample]) -> Vec<ResponsePoint> {
    let mut sorted: Vec<Sample> = samples.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.seed.cmp(&b.seed)));
    let groups: Vec<&[Sample]> = sorted.chunk_by(|a, b| a.x == b.x).collect();
    let value = |sample: &Sample| sample.y.filter(|y| y.is_finite());
    let point = |(i, group): (usize, &&[Sample])| {
        let values: Vec<f64> = group.iter().filter_map(value).collect();
        let before: &[Sample] = if i > 0 { groups[i - 1] } else { &[] };
        let changes: Vec<f64> = group
            .iter()
            .filter_map(|s| {
                let other = before.iter().find(|o| o.seed == s.seed)?;
                Some(value(s)? - value(other)?)
            })
            .collect();
        ResponsePoint {
            x: group[0].x,
            mean: Mean::of(&values),
            change: Mean::of(&changes),
            failed: group.len() - values.len(),
        }
    };
    groups.iter().enumerate().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = 10 x + the seed: the scatter of the seeds is in the means, not in the changes.
    #[test]
    fn changes_are_free_of_what_seeds_share() {
        let mut samples = Vec::new();
        for seed in [3, 1, 2] {
            for x in [1.0, 0.0] {
                let y = Some(10.0 * x + seed as f64);
                samples.push(Sample { x, seed, y });
            }
        }
        samples.push(Sample {
            x: 1.0,
            seed: 4,
            y: None,
        });
        let curve = response_curve(&samples);
        assert_eq!(curve.iter().map(|p| p.x).collect::<Vec<_>>(), [0.0, 1.0]);
        assert_eq!(curve[0].mean.unwrap().mean, 2.0);
        assert_eq!(curve[0].mean.unwrap().scatter, Some(1.0));
        assert_eq!((curve[0].change, curve[0].failed), (None, 0));
        let change = curve[1].change.unwrap();
        assert_eq!(
            (change.mean, change.half_width, change.count),
            (10.0, Some(0.0), 3)
        );
        assert_eq!(curve[1].failed, 1);
        assert!(response_curve(&[]).is_empty());
    }
}
