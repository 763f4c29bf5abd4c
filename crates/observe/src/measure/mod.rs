//! Measured quantities of a case, sampled whenever a row of the statistics is written.

mod ball;
mod band;
mod mass;
mod profile;
mod shear;
mod slope;
mod third_body;

pub(crate) use self::third_body::ThirdBody;
use super::observer::{Observer, Observers};
use super::statistics::Table;
use fretwork_core::geometry::space::{VectorLike, ball_volume};
use fretwork_core::view::RunView;
use fretwork_scene::measures::MeasureSpec;
use nalgebra::Vector3;

/// Adds the measures of these kinds of the case of a run; the masses of its bodies are too large by
/// `inertia_scaling`.
pub fn measures(specs: &[MeasureSpec], inertia_scaling: f64, run: &dyn RunView) -> Observers {
    let mut all = Observers::default();
    for spec in specs {
        all.push(measure(spec.clone(), inertia_scaling, run));
    }
    all
}

/// Returns the name of a measure among the observers of a run.
fn name_of(kind: &str, name: &str) -> String {
    format!("{kind} {name}")
}

fn measure(spec: MeasureSpec, inertia_scaling: f64, run: &dyn RunView) -> Box<dyn Observer> {
    match spec {
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
        } => Box::new(profile::Profile::new(
            run.dimension(),
            name,
            axis,
            [&low, &high],
            bins,
            turned,
            start,
        )),
        MeasureSpec::Band {
            name,
            low,
            high,
            above,
        } => Box::new(band::Band {
            name,
            low: VectorLike::from_slice(&low),
            high: VectorLike::from_slice(&high),
            above,
            strain: None,
        }),
        MeasureSpec::ThirdBody(spec) => Box::new(ThirdBody::new(spec, inertia_scaling, run)),
        MeasureSpec::Shear {
            name,
            low,
            high,
            start,
        } => Box::new(shear::Shear::new(run.dimension(), name, [low, high], start)),
    }
}

/// A grain, or one shape of a grain with several.
struct Grain {
    /// Centre, wrapped into the period that begins at zero (m).
    at: Vector3<f64>,
    /// Index of the body.
    body: usize,
    /// Radius of the ball (2D: disk) of the same volume (m).
    radius: f64,
    /// Share of the body's mass, by volume (kg; kg/m in 2D).
    mass: f64,
    /// Index of its convex piece and the rounding of that piece (m), unless it is a ball.
    piece: Option<(usize, f64)>,
}

impl Grain {
    /// Returns the height of the highest point above the centre (m).
    fn rise(&self, run: &dyn RunView) -> f64 {
        let Some((piece, rounding)) = self.piece else {
            return self.radius;
        };
        let mut up = [0.0; 3];
        up[run.dimension() - 1] = 1.0;
        let up = Vector3::from(run.turned_back(self.body, up));
        let (corners, _) = run.piece_core(piece);
        let heights = corners.iter().map(|c| Vector3::from(*c).dot(&up));
        heights.fold(f64::NEG_INFINITY, f64::max) + rounding
    }
}

/// The grains; shapes of driven bodies are excluded.
fn grains(run: &dyn RunView) -> Vec<Grain> {
    let (flags, bodies) = (run.grain_flags(), run.bodies());
    let grain = |at: [f64; 3], body: u32, radius, piece| Grain {
        at: at.into(),
        body: body as usize,
        radius,
        mass: 0.0,
        piece,
    };
    // Points of surfaces are balls of radius zero.
    let balls = run.balls().into_iter().filter(|b| b.radius > 0.0);
    let balls = balls.map(|b| grain(b.centre, b.body, b.radius, None));
    let pieces = run.pieces().into_iter().enumerate();
    let pieces = pieces.map(|(k, p)| grain(p.centre, p.body, p.size, Some((k, p.rounding))));
    let closed = run.surfaces().into_iter().filter(|f| f.closed);
    let deformable = closed.map(|f| {
        let b = f.body as usize;
        grain(bodies.position.at(b), f.body, bodies.length[b], None)
    });
    let all = balls.chain(pieces).chain(deformable);
    let mut all: Vec<Grain> = all.filter(|g| flags[g.body]).collect();
    let volume = |radius: f64| ball_volume(run.dimension(), radius);
    let mut volumes = vec![0.0; bodies.len()];
    for g in &all {
        volumes[g.body] += volume(g.radius);
    }
    for g in &mut all {
        let share = volume(g.radius) / volumes[g.body];
        g.mass = bodies.mass[g.body] * share;
        g.at = run.periodic().wrapped(g.at);
    }
    all
}

/// Returns (time, value) of a column after a time.
fn since(table: &Table, column: &str, start: f64) -> Vec<(f64, f64)> {
    let pairs = table.column("time").into_iter().zip(table.column(column));
    pairs
        .filter(|(t, v)| *t >= start && v.is_finite())
        .collect()
}

/// Returns the mean of the values; `None` for no points.
fn mean(points: &[(f64, f64)]) -> Option<f64> {
    (!points.is_empty()).then(|| points.iter().map(|p| p.1).sum::<f64>() / points.len() as f64)
}

/// Returns the slope of the least-squares line through points; `None` for fewer than two distinct
/// abscissae.
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
