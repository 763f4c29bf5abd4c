//! Measured quantities of a case, sampled whenever a row of the statistics is written.

mod band;
mod mass;
mod profile;
mod shear;
mod slope;
mod third_body;

use super::code::CodeError;
use super::output::Output;
use super::statistics::{Column, Table};
use fretwork_core::geometry::convex::{ConvexCollider, Core};
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_scene::measures::MeasureSpec;
use std::collections::BTreeMap;
use std::fmt::Debug;

/// A measured quantity.
pub trait Measure<S: Space>: Debug {
    /// Takes the current state as the reference for deformations.
    fn begin(&mut self, _: &Simulation<S>) {}
    /// Whether [`Measure::follow`] is called after every step, with the dissipation of each contact recorded.
    fn follows(&self) -> bool {
        false
    }
    /// Processes the last step; called if [`Measure::follows`] is true.
    fn follow(&mut self, _: &Simulation<S>) {}
    /// Columns in the statistics.
    fn columns(&self) -> Vec<Column>;
    /// Values of its columns at the end of a step; also accumulates what it needs for the end of the run.
    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64>;
    /// Numeric results for the summary, by name.
    fn outcome(&self, table: &Table) -> Vec<(String, f64)>;
    /// Units of the results that are not means of a column; results not listed are pure numbers.
    fn units(&self) -> Vec<(String, &'static str)> {
        Vec::new()
    }
    /// Textual results for the summary, by name.
    fn verdict(&self, _: &Table) -> Vec<(String, String)> {
        Vec::new()
    }
    /// Force chains as sorted pairs of bodies, the lower index first, if the measure finds them.
    fn chains(&self, _: &Simulation<S>) -> Option<Vec<[u32; 2]>> {
        None
    }
    /// Serializes its state for a checkpoint; empty if it has no state.
    ///
    /// # Errors
    /// The state cannot be serialized.
    fn save(&self) -> Result<Vec<u8>, CodeError>;
    /// Restores the state from [`Measure::save`].
    ///
    /// # Errors
    /// The bytes belong to another state.
    fn restore(&mut self, from: &[u8]) -> Result<(), CodeError>;
    /// Files and figures at the end of a run with this title.
    fn outputs(&self, title: &str, table: &Table) -> Vec<Output>;
}

/// All measured quantities of a run.
#[derive(Debug)]
pub struct Measures<S: Space> {
    list: Vec<Box<dyn Measure<S>>>,
}

impl<S: Space> Measures<S> {
    /// Builds the measures of a case; its `inertia_scaling` is divided out of reported masses.
    pub fn new(specs: &[MeasureSpec], inertia_scaling: f64) -> Self {
        let make = |spec: &MeasureSpec| -> Box<dyn Measure<S>> {
            match spec.clone() {
                MeasureSpec::Mass {
                    name,
                    axis,
                    above,
                    start,
                } => Box::new(mass::Mass {
                    name,
                    axis,
                    above,
                    start,
                    inertia_scaling,
                }),
                MeasureSpec::Slope {
                    name,
                    from,
                    to,
                    start,
                } => Box::new(slope::Slope {
                    name,
                    from,
                    to,
                    start,
                }),
                MeasureSpec::Profile {
                    name,
                    axis,
                    low,
                    high,
                    bins,
                    turned,
                    start,
                } => Box::new(profile::Profile::<S>::new(
                    name, axis, &low, &high, bins, turned, start,
                )),
                MeasureSpec::Band {
                    name,
                    low,
                    high,
                    above,
                } => Box::new(band::Band::<S> {
                    name,
                    low: S::Vector::from_slice(&low),
                    high: S::Vector::from_slice(&high),
                    above,
                    strain: None,
                }),
                MeasureSpec::ThirdBody(spec) => {
                    Box::new(third_body::ThirdBody::<S>::new(spec, inertia_scaling))
                }
                MeasureSpec::Shear {
                    name,
                    low,
                    high,
                    start,
                } => Box::new(shear::Shear {
                    name,
                    low,
                    high,
                    start,
                }),
            }
        };
        Self {
            list: specs.iter().map(make).collect(),
        }
    }

    /// Takes the current state as the reference for deformations.
    pub fn begin(&mut self, s: &mut Simulation<S>) {
        if self.list.iter().any(|m| m.follows()) {
            s.network.spent.get_or_insert_default();
        }
        self.list.iter_mut().for_each(|m| m.begin(s));
    }

    /// Processes the last step.
    pub fn follow(&mut self, s: &Simulation<S>) {
        let list = self.list.iter_mut().filter(|m| m.follows());
        list.for_each(|m| m.follow(s));
    }

    /// Serializes the state of each measure, see [`Measure::save`].
    ///
    /// # Errors
    /// One of them cannot be serialized.
    pub fn save(&self) -> Result<Vec<Vec<u8>>, CodeError> {
        self.list.iter().map(|m| m.save()).collect()
    }

    /// Restores the states from [`Measures::save`].
    ///
    /// # Errors
    /// The bytes belong to other measures.
    pub fn restore(&mut self, from: &[Vec<u8>]) -> Result<(), CodeError> {
        if from.len() != self.list.len() {
            return Err(CodeError::other("measures"));
        }
        let mut pairs = self.list.iter_mut().zip(from);
        pairs.try_for_each(|(measure, bytes)| measure.restore(bytes))
    }

    /// Columns of all measures, in the order of the case.
    pub fn columns(&self) -> Vec<Column> {
        self.list.iter().flat_map(|m| m.columns()).collect()
    }

    /// Values of [`Measures::columns`].
    pub fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        self.list.iter_mut().flat_map(|m| m.sample(s)).collect()
    }

    /// Numeric results for the summary.
    pub fn outcome(&self, table: &Table) -> BTreeMap<String, f64> {
        self.list.iter().flat_map(|m| m.outcome(table)).collect()
    }

    /// Units of the numeric results, by name.
    pub fn units(&self) -> BTreeMap<String, &'static str> {
        let columns = self.columns().into_iter().map(|c| (c.name, c.unit));
        let others = self.list.iter().flat_map(|m| m.units());
        columns
            .chain(others)
            .filter(|(_, unit)| !unit.is_empty())
            .collect()
    }

    /// Textual results for the summary.
    pub fn verdict(&self, table: &Table) -> BTreeMap<String, String> {
        self.list.iter().flat_map(|m| m.verdict(table)).collect()
    }

    /// Force chains of the first measure that finds them.
    pub fn chains(&self, s: &Simulation<S>) -> Option<Vec<[u32; 2]>> {
        self.list.iter().find_map(|m| m.chains(s))
    }

    /// Files and figures of all measures.
    pub fn outputs(&self, title: &str, table: &Table) -> Vec<Output> {
        let outputs = self.list.iter().map(|m| m.outputs(title, table));
        outputs.flatten().collect()
    }
}

/// A grain, or one shape of a grain with several.
struct Grain<'a, S: Space> {
    /// Centre, wrapped into the period that begins at zero (m).
    at: S::Vector,
    /// Index of the body.
    body: usize,
    /// Radius of the ball (2D: disk) of the same volume (m).
    radius: f64,
    /// Its share of the body's mass, by volume (kg; kg/m in 2D).
    mass: f64,
    /// Its convex part, unless it is a ball.
    piece: Option<&'a ConvexCollider<S>>,
}

impl<S: Space> Grain<'_, S> {
    /// Height of its highest point above its centre (m).
    fn rise(&self, s: &Simulation<S>) -> f64 {
        let Some(piece) = self.piece else {
            return self.radius;
        };
        let mut up = S::Vector::zero();
        up[S::D - 1] = 1.0;
        let up = S::unrotate(&s.bodies.rotation[self.body], &up);
        let corners = piece.core.outline(0.0).concat();
        let heights = corners.iter().map(|c| c.dot(&up));
        heights.fold(f64::NEG_INFINITY, f64::max) + piece.rounding
    }
}

/// The grains; shapes of driven bodies are excluded.
fn grains<S: Space>(s: &Simulation<S>) -> Vec<Grain<'_, S>> {
    let flags = s.bodies.grain_flags();
    let balls = s.shapes.balls.iter().map(|b| Grain {
        at: fretwork_core::contact::detect::centre(b, &s.bodies),
        body: b.body as usize,
        radius: b.radius,
        mass: 0.0,
        piece: None,
    });
    let pieces = s.shapes.pieces.iter().map(|p| Grain {
        at: crate::placement::piece_centre(s, p),
        body: p.body as usize,
        radius: p.size,
        mass: 0.0,
        piece: Some(p),
    });
    let all = balls.chain(pieces).filter(|g| flags[g.body]);
    let mut all: Vec<Grain<'_, S>> = all.collect();
    let mut volumes = vec![0.0; s.bodies.len()];
    for g in &all {
        volumes[g.body] += S::ball_volume(g.radius);
    }
    for g in &mut all {
        let share = S::ball_volume(g.radius) / volumes[g.body];
        g.mass = s.bodies.mass[g.body] * share;
        g.at = s.shapes.periodic.wrapped(g.at);
    }
    all
}

/// (time, value) of a column after a time.
fn since(table: &Table, column: &str, start: f64) -> Vec<(f64, f64)> {
    let pairs = table.column("time").into_iter().zip(table.column(column));
    pairs
        .filter(|(t, v)| *t >= start && v.is_finite())
        .collect()
}

/// Mean of the values; `None` for no points.
fn mean(points: &[(f64, f64)]) -> Option<f64> {
    (!points.is_empty()).then(|| points.iter().map(|p| p.1).sum::<f64>() / points.len() as f64)
}

/// Slope of the least-squares line through points; `None` for fewer than two distinct abscissae.
fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let n = points.clone().count() as f64;
    let (x, y) = points
        .clone()
        .fold((0.0, 0.0), |(a, b), p| (a + p.0, b + p.1));
    let (x, y) = (x / n, y / n);
    let (xx, xy) = points.fold((0.0, 0.0), |(a, b), p| {
        (a + (p.0 - x) * (p.0 - x), b + (p.0 - x) * (p.1 - y))
    });
    (xx > 0.0).then(|| xy / xx)
}
