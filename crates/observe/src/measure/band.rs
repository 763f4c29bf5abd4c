//! Shear band: its angle and width from the grains in a box whose local shear exceeds a threshold.
//!
//! The grains are sorted into rows two mean diameters high. In each row the band's centre is the
//! median position of these grains, and its width is twice their interquartile range, which is
//! exact for a uniformly filled band and robust against a few stray grains. A straight line through
//! the rows gives the angle; the width across that line is the mean over the rows.

use super::{grains, line};
use crate::chart::{Axis, Chart, Series, Value};
use crate::encoding::{self, EncodingError};
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::quantity::Findings;
use crate::statistics::Column;
use crate::strain::Strain;
use fretwork_core::view::RunView;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Observer for [`fretwork_scene::measures::MeasureSpec::Band`].
#[derive(Clone, Debug)]
pub struct Band {
    pub(super) name: String,
    pub(super) low: Vector3<f64>,
    pub(super) high: Vector3<f64>,
    pub(super) above: f64,
    pub(super) strain: Option<Strain>,
}

/// Smallest number of grains in a row, and of rows in a band.
const FEWEST: (usize, usize) = (4, 3);

/// Returns the angle to the x axis, 0 to pi, and the width of the band formed by points (x,
/// height).
fn shape(points: &[(f64, f64)], low: f64, row: f64) -> Option<(f64, f64)> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (x, z) in points {
        let k = ((z - low) / row) as usize;
        if rows.len() <= k {
            rows.resize(k + 1, Vec::new());
        }
        rows[k].push(*x);
    }
    let (mut centres, mut width) = (Vec::new(), 0.0);
    for (k, row_k) in rows
        .iter_mut()
        .enumerate()
        .filter(|r| r.1.len() >= FEWEST.0)
    {
        row_k.sort_by(f64::total_cmp);
        let n = row_k.len() as f64;
        // Correction for the quartiles of n equidistant samples, which are closer together than
        // those of the population.
        let few = (n + 1.0) / (n - 1.0);
        width += 2.0 * few * (quantile(row_k, 0.75) - quantile(row_k, 0.25));
        centres.push((low + (k as f64 + 0.5) * row, quantile(row_k, 0.5)));
    }
    if centres.len() < FEWEST.1 {
        return None;
    }
    // x is a function of height, since a band may be vertical.
    let lean = line(centres.iter().copied())?;
    let angle = 1f64.atan2(lean).rem_euclid(PI);
    Some((angle, width / centres.len() as f64 * angle.sin()))
}

/// Returns an interpolated quantile of sorted, non-empty values.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let k = place as usize;
    let next = sorted[(k + 1).min(sorted.len() - 1)];
    sorted[k] + (place - k as f64) * (next - sorted[k])
}

impl Observer for Band {
    fn name(&self) -> String {
        super::name_of("band", &self.name)
    }

    fn begin(&mut self, run: &dyn RunView) {
        self.strain = Some(Strain::new(run));
    }

    fn columns(&self) -> Vec<Column> {
        let name = |part: &str| format!("{}_{part}", self.name);
        vec![
            Column::new(
                name("angle"),
                "rad",
                "angle of a shear band with the x axis",
            ),
            Column::new(name("width"), "m", "width across a shear band"),
            Column::new(name("grains"), "", "grains of a shear band"),
        ]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let Some(strain) = &self.strain else {
            return vec![f64::NAN, f64::NAN, 0.0];
        };
        let up = run.dimension() - 1;
        let grain = run.grain_flags();
        let balls = run.balls().into_iter().zip(strain.shear(run));
        let sheared = balls
            .filter(|(b, shear)| grain[b.body as usize] && *shear >= self.above)
            .map(|(b, _)| run.periodic().wrapped(Vector3::from(b.centre)))
            .filter(|x| (0..run.dimension()).all(|k| (self.low[k]..self.high[k]).contains(&x[k])));
        let points: Vec<(f64, f64)> = sheared.map(|x| (x[0], x[up])).collect();
        let all = grains(run);
        let sum: f64 = all.iter().map(|g| 2.0 * g.radius).sum();
        let (angle, width) = shape(&points, self.low[up], 2.0 * sum / all.len() as f64)
            .unwrap_or((f64::NAN, f64::NAN));
        vec![angle, width, points.len() as f64]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        // A band grows, so its last state is reported.
        for column in Observer::columns(self) {
            let last = end.table.column(&column.name).last().copied();
            let value = last.filter(|v| v.is_finite());
            found.measure(&column.name, value, column.unit, column.doc);
        }
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encoding::encode(&self.strain)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.strain = encoding::decode(from)?;
        Ok(())
    }

    fn file_names(&self) -> Vec<String> {
        vec![format!("{}.png", self.name)]
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let chart = |part: &str, y: Axis, factor: f64| {
            let value = Value {
                factor,
                ..Value::from(format!("{}_{part}", self.name))
            };
            Chart::new(format!("Shear band {}", self.name), Axis::time(), y)
                .with(Series::rows("", "time", value))
        };
        let charts = [
            chart("angle", Axis::new("angle with x", "deg"), 180.0 / PI),
            chart("width", Axis::of_rows("width"), 1.0),
        ];
        vec![Output::figure(&self.name, charts, 2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that fill a band of known angle and width, and some strays, give that angle and
    /// width.
    #[test]
    fn a_band_has_its_angle_and_width() {
        for degrees in [35.0f64, 60.0, 90.0, 120.0] {
            let (angle, width) = (degrees.to_radians(), 0.02);
            let mut points = Vec::new();
            for k in 0..40 {
                for j in 0..25 {
                    let z = 0.08 * (f64::from(k) + 0.5) / 40.0;
                    let along = width / angle.sin() * ((f64::from(j) + 0.5) / 25.0 - 0.5);
                    points.push((z / angle.tan() + along, z));
                }
            }
            points.extend((0..20).map(|k| (0.3, 0.004 * f64::from(k))));
            let (a, w) = shape(&points, 0.0, 0.008).unwrap();
            assert!(
                (a - angle).abs() < 0.02,
                "{} in place of {degrees}",
                a.to_degrees()
            );
            // The rows are a third of the width high, so a leaning band appears slightly wider in
            // them.
            assert!((w / width - 1.0).abs() < 0.12, "{w} at {degrees}");
        }
        assert!(shape(&[(0.0, 0.0); 9], 0.0, 1.0).is_none());
    }
}
