//! Time-averaged profiles of solid fraction, velocity, spin and, where heat is computed,
//! temperature in the slices of a box.
//!
//! A grain counts in the slice of its centre; velocities and temperatures are mass-weighted.

use super::grains;
use crate::chart::{Axis, Chart, Series, Style};
use crate::encoding::{self, EncodingError};
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::statistics::Column;
use fretwork_core::geometry::space::{VectorLike, ball_volume};
use fretwork_core::view::RunView;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Observer for [`fretwork_scene::measures::MeasureSpec::Profile`].
#[derive(Clone, Debug)]
pub struct Profile {
    /// Number of dimensions.
    dimension: usize,
    name: String,
    axis: usize,
    low: Vector3<f64>,
    high: Vector3<f64>,
    turned: f64,
    start: f64,
    samples: u64,
    /// Whether grains have temperatures.
    heated: bool,
    slices: Vec<Slice>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Slice {
    mass: f64,
    volume: f64,
    momentum: Vector3<f64>,
    /// Sum of mass times spin: about z in 2D, its norm in 3D.
    spin: f64,
    /// Sum of mass times temperature (kg K).
    temperature: f64,
}

impl Profile {
    pub(super) fn new(
        dimension: usize,
        name: String,
        axis: usize,
        [low, high]: [&[f64]; 2],
        bins: usize,
        turned: f64,
        start: f64,
    ) -> Self {
        let empty = Slice {
            mass: 0.0,
            volume: 0.0,
            momentum: Vector3::zeros(),
            spin: 0.0,
            temperature: 0.0,
        };
        Self {
            dimension,
            name,
            axis,
            low: VectorLike::from_slice(low),
            high: VectorLike::from_slice(high),
            turned,
            start,
            samples: 0,
            heated: false,
            slices: vec![empty; bins],
        }
    }

    /// Returns the components of a vector along the axes of the box.
    fn turned(&self, v: &Vector3<f64>) -> Vector3<f64> {
        let (sin, cos) = self.turned.sin_cos();
        let mut out = *v;
        (out[0], out[1]) = (cos * v[0] + sin * v[1], cos * v[1] - sin * v[0]);
        out
    }

    /// Returns position, solid fraction, velocity and spin of each slice; NaN velocities where
    /// there was no grain.
    fn rows(&self) -> Vec<Vec<f64>> {
        let wide = (self.high[self.axis] - self.low[self.axis]) / self.slices.len() as f64;
        let section: f64 = (0..self.dimension)
            .filter(|k| *k != self.axis)
            .map(|k| self.high[k] - self.low[k])
            .product();
        let rows = self.slices.iter().enumerate().map(|(k, slice)| {
            let whole = wide * section * self.samples.max(1) as f64;
            let mut row = vec![
                self.low[self.axis] + (k as f64 + 0.5) * wide,
                slice.volume / whole,
            ];
            row.extend((0..self.dimension).map(|k| slice.momentum[k] / slice.mass));
            row.push(slice.spin / slice.mass);
            if self.heated {
                row.push(slice.temperature / slice.mass);
            }
            row
        });
        rows.collect()
    }

    fn header(&self) -> Vec<String> {
        let axes = ["x", "y", "z"];
        let mut out = vec![
            format!("{} [m]", axes[self.axis]),
            "solid_fraction".to_owned(),
        ];
        out.extend(
            axes.iter()
                .take(self.dimension)
                .map(|a| format!("velocity_{a} [m/s]")),
        );
        out.push("spin [rad/s]".to_owned());
        if self.heated {
            out.push("temperature [K]".to_owned());
        }
        out
    }
}

impl Observer for Profile {
    fn name(&self) -> String {
        super::name_of("profile", &self.name)
    }

    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        if run.time() < self.start {
            return Vec::new();
        }
        self.samples += 1;
        self.heated = run.heat().is_some();
        let bins = self.slices.len() as f64;
        let bodies = run.bodies();
        for g in grains(run) {
            let x = self.turned(&g.at);
            if !(0..self.dimension).all(|k| (self.low[k]..self.high[k]).contains(&x[k])) {
                continue;
            }
            let (low, high) = (self.low[self.axis], self.high[self.axis]);
            let place = ((x[self.axis] - low) / (high - low) * bins) as usize;
            let velocity = self.turned(&bodies.velocity.at(g.body).into());
            let Some(slice) = self.slices.get_mut(place) else {
                continue;
            };
            let mass = g.mass;
            let spin = Vector3::from(bodies.spin.at(g.body));
            slice.mass += mass;
            slice.volume += ball_volume(self.dimension, g.radius);
            slice.momentum += velocity * mass;
            slice.spin += mass
                * if self.dimension == 2 {
                    spin[2]
                } else {
                    spin.norm()
                };
            slice.temperature += mass * run.temperature(g.body).unwrap_or_default();
        }
        Vec::new()
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encoding::encode(&(self.samples, self.heated, &self.slices))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        (self.samples, self.heated, self.slices) = encoding::decode(from)?;
        Ok(())
    }

    fn file_names(&self) -> Vec<String> {
        [".csv", ".png"]
            .map(|end| format!("{}{end}", self.name))
            .to_vec()
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let rows = self.rows();
        let mut text = self.header().join(",") + "\n";
        for row in &rows {
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:e}")).collect();
            text += &(numbers.join(",") + "\n");
        }
        let axis = ["position x", "position y", "position z"][self.axis];
        let series = |k: usize| -> Vec<(f64, f64)> {
            let points = rows.iter().map(|r| (r[0], r[k]));
            points.filter(|p| p.1.is_finite()).collect()
        };
        let chart = |heading: &str, unit: &'static str, y: &str| {
            Chart::new(heading, Axis::new(axis, "m"), Axis::new(y, unit))
        };
        let mut velocity = chart("Velocity", "m/s", "mean velocity v");
        for (k, a) in ["v_x", "v_y", "v_z"]
            .iter()
            .enumerate()
            .take(self.dimension)
        {
            velocity =
                velocity.with_unless_zero(Series::new(*a, series(2 + k)).style(Style::LineMarkers));
        }
        let solid = chart("Solid fraction", "", "solid fraction φ")
            .with_unless_zero(Series::new(String::new(), series(1)).style(Style::LineMarkers));
        let spin = chart("Rotation", "rad/s", "mean angular velocity ω").with_unless_zero(
            Series::new(String::new(), series(2 + self.dimension)).style(Style::LineMarkers),
        );
        let mut panels = vec![velocity, solid, spin];
        if self.heated {
            let temperature = chart("Temperature", "K", "mean temperature T");
            let of_grains = Series::new(String::new(), series(3 + self.dimension));
            panels.push(temperature.with(of_grains.style(Style::LineMarkers)));
        }
        let file = format!("{}.csv", self.name);
        vec![
            Output::Text { file, text },
            Output::figure(&self.name, panels, 2),
        ]
    }
}
