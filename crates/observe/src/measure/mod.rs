//! Measured quantities of a case, sampled whenever a row of the statistics is written.

mod band;
mod mass;
mod profile;
mod shear;
mod slope;
mod third_body;

use super::observer::{Observer, Observers};
use super::statistics::Table;
use crate::typed::in_dimension;
use fretwork_core::geometry::convex::{ConvexCollider, Core};
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_scene::measures::MeasureSpec;

/// Measures of these words of a case, and its `inertia_scaling`, by which the bodies' masses are
/// too large. `heated`: whether it computes heat.
pub fn measures<S: Space>(specs: &[MeasureSpec], inertia_scaling: f64, heated: bool) -> Observers {
    let mut all = Observers::default();
    for spec in specs {
        all.push(measure::<S>(spec.clone(), inertia_scaling, heated));
    }
    all
}

/// Name of a measure among the observers of a run.
fn name_of(kind: &str, name: &str) -> String {
    format!("{kind} {name}")
}

fn measure<S: Space>(spec: MeasureSpec, inertia_scaling: f64, heated: bool) -> Box<dyn Observer> {
    match spec {
        MeasureSpec::Mass {
            name,
            axis,
            above,
            start,
        } => in_dimension::<S, _>(mass::Mass {
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
        } => in_dimension::<S, _>(slope::Slope {
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
        } => in_dimension::<S, _>(profile::Profile::<S>::new(
            name, axis, &low, &high, bins, turned, start,
        )),
        MeasureSpec::Band {
            name,
            low,
            high,
            above,
        } => in_dimension::<S, _>(band::Band::<S> {
            name,
            low: S::Vector::from_slice(&low),
            high: S::Vector::from_slice(&high),
            above,
            strain: None,
        }),
        MeasureSpec::ThirdBody(spec) => in_dimension::<S, _>(third_body::ThirdBody::<S>::new(
            spec,
            inertia_scaling,
            heated,
        )),
        MeasureSpec::Shear {
            name,
            low,
            high,
            start,
        } => in_dimension::<S, _>(shear::Shear::<S>::new(name, low, high, start)),
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
        let up = S::unrotate(&s.state.bodies.rotation[self.body], &up);
        let corners = piece.core.outline(0.0).concat();
        let heights = corners.iter().map(|c| c.dot(&up));
        heights.fold(f64::NEG_INFINITY, f64::max) + piece.rounding
    }
}

/// The grains; shapes of driven bodies are excluded.
fn grains<S: Space>(s: &Simulation<S>) -> Vec<Grain<'_, S>> {
    let flags = s.state.bodies.grain_flags();
    // Points of surfaces are balls without a radius.
    let balls = s.shapes.balls.iter().filter(|b| b.radius > 0.0);
    let balls = balls.map(|b| Grain {
        at: fretwork_core::contact::detect::centre(b, &s.state.bodies),
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
    let bodies = &s.state.bodies;
    let closed = s.shapes.surfaces.iter().filter(|f| f.shape.is_closed());
    let deformable = closed.map(|f| Grain {
        at: bodies.position[f.body as usize],
        body: f.body as usize,
        radius: bodies.length[f.body as usize],
        mass: 0.0,
        piece: None,
    });
    let all = balls.chain(pieces).chain(deformable);
    let all = all.filter(|g| flags[g.body]);
    let mut all: Vec<Grain<'_, S>> = all.collect();
    let mut volumes = vec![0.0; s.state.bodies.len()];
    for g in &all {
        volumes[g.body] += S::ball_volume(g.radius);
    }
    for g in &mut all {
        let share = S::ball_volume(g.radius) / volumes[g.body];
        g.mass = s.state.bodies.mass[g.body] * share;
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
