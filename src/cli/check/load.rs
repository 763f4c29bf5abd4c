//! External loads on a scene that follow from the case: sliding speed and pressure.

use crate::bodies::{Dof, TimeFunction};
use crate::record::biaxial::Biaxial;
use crate::scene::case::Case;
use crate::scene::phases::drives_of;
use crate::{AnySimulation, RunView};
use std::f64::consts::TAU;

/// Number of samples of a drive over the run.
const SAMPLES: u32 = 1000;

/// External loads on a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// Largest imposed speed (m/s), and the name of its body; `None` if nothing is moved.
    pub speed: Option<(f64, String)>,
    /// Pressure (Pa), and its origin; `None` if it cannot be determined.
    pub pressure: Option<(f64, &'static str)>,
}

impl Load {
    /// The loads of a case and its scene.
    pub fn of(case: &Case, s: &AnySimulation) -> Self {
        let test = friction_pressure(case, s).map(|p| (p, "of the friction test"));
        let biaxial = || biaxial_pressure(case, s).map(|p| (p, "of the biaxial test"));
        let servo = || servo_pressure(case).map(|p| (p, "of the servo"));
        let weight = || weight(s).map(|p| (p, "estimated from the weight of the grains"));
        Self {
            speed: speed(case),
            pressure: test.or_else(biaxial).or_else(servo).or_else(weight),
        }
    }
}

/// Returns the largest magnitude of a drive's function over the run.
fn largest(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let times = (0..=SAMPLES).map(|k| end * f64::from(k) / f64::from(SAMPLES));
    times.map(|t| f(t).abs()).fold(0.0, f64::max)
}

/// Returns the largest speed that a drive imposes; for a sine from its amplitude, which samples may
/// miss.
fn peak_speed(dof: &Dof, end: f64) -> f64 {
    let each = dof.drives().map(|drive| {
        let sampled = largest(end, |t| drive.imposed_velocity(t).unwrap_or(0.0));
        match drive {
            Dof::Velocity(TimeFunction::Sine {
                amplitude, offset, ..
            }) => sampled.max(offset.abs() + amplitude.abs()),
            Dof::Displacement(TimeFunction::Sine {
                amplitude,
                frequency,
                ..
            }) => sampled.max((TAU * frequency * amplitude).abs()),
            _ => sampled,
        }
    });
    each.fold(0.0, f64::max)
}

fn speed(case: &Case) -> Option<(f64, String)> {
    // In a friction test the imposed sliding counts, not the motion along the normal.
    let test = case.friction.as_ref();
    let slide = test.and_then(|t| fastest(case, |name, k| name == t.body && k == t.along));
    slide.or_else(|| fastest(case, |_, k| k < case.dimension as usize))
}

/// Returns the largest speed of the drives accepted by `counts`, by body and axis.
fn fastest(case: &Case, counts: impl Fn(&str, usize) -> bool) -> Option<(f64, String)> {
    let mut fastest: Option<(f64, String)> = None;
    for body in &case.bodies {
        let counts = |k: usize| counts(&body.name, k);
        for (_, dof) in drives_of(case, body).iter().filter(|(k, _)| counts(*k)) {
            let speed = peak_speed(dof, case.time.end);
            let more = fastest.as_ref().is_none_or(|f| speed > f.0);
            if speed > 0.0 && speed.is_finite() && more {
                fastest = Some((speed, body.name.clone()));
            }
        }
    }
    fastest
}

/// Returns the imposed force over the contact area of the test.
pub fn friction_pressure(case: &Case, s: &AnySimulation) -> Option<f64> {
    let test = case.friction.as_ref()?;
    let driven = s.bodies().driven_named(&test.body)?;
    let force = largest(case.time.end, |t| driven.dofs[test.normal].force(t));
    let pressure = force / friction_area(case, s)?;
    (pressure > 0.0).then_some(pressure)
}

/// Returns the contact area of a friction test that is periodic along the sliding direction (m^2; m
/// in 2D).
pub fn friction_area(case: &Case, s: &AnySimulation) -> Option<f64> {
    let test = case.friction.as_ref()?;
    let periods = s.periodic().period;
    let period = periods[test.along]?;
    Some(if s.dimension() == 2 {
        period
    } else {
        period * periods[3 - test.along - test.normal].unwrap_or(period)
    })
}

/// Returns the pressure from the lateral force on a square sample of solid fraction 0.82.
fn biaxial_pressure(case: &Case, s: &AnySimulation) -> Option<f64> {
    let spec = case.biaxial.as_ref()?;
    let test = Biaxial::new(spec, s.view())?;
    let walls = s.bodies().driven.iter();
    let walls = walls.filter(|d| d.name == spec.lateral.0 || d.name == spec.lateral.1);
    let forces = walls.flat_map(|d| &d.dofs[..s.dimension()]);
    let force = forces.map(|dof| largest(case.time.end, |t| dof.force(t)));
    let pressure = force.fold(0.0, f64::max) / (test.solid() / 0.82).sqrt();
    (pressure > 0.0 && pressure.is_finite()).then_some(pressure)
}

fn servo_pressure(case: &Case) -> Option<f64> {
    let bodies = case.bodies.iter().flat_map(|body| drives_of(case, body));
    let values = bodies.flat_map(|(_, dof)| {
        let each = dof.drives().map(|drive| match drive {
            Dof::Pressure { value, .. } => largest(case.time.end, |t| value.value(t)),
            _ => 0.0,
        });
        each.collect::<Vec<_>>()
    });
    let most = values.fold(0.0, f64::max);
    (most > 0.0).then_some(most)
}

/// Magnitude of the acceleration of gravity (m/s^2).
pub fn gravity(s: &dyn RunView) -> f64 {
    let squares = s.gravity().into_iter().map(|g| g * g);
    squares.sum::<f64>().sqrt()
}

/// Returns the weight of all grains over the base area below them.
fn weight(s: &AnySimulation) -> Option<f64> {
    let g = gravity(s.view());
    let along = s.gravity();
    let size = |k: &usize| along[*k].abs();
    let down = (0..s.dimension()).max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let (bodies, grains) = (s.bodies(), s.grains());
    let (mut mass, mut area) = (0.0, 1.0);
    for body in &grains {
        mass += bodies.mass[*body];
    }
    for k in (0..s.dimension()).filter(|k| *k != down) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for body in &grains {
            let (x, r) = (s.motion(*body).position[k], bodies.length[*body]);
            (low, high) = (low.min(x - r), high.max(x + r));
        }
        area *= s.periodic().period[k].unwrap_or(high - low);
    }
    let pressure = mass * g / area;
    (pressure > 0.0 && pressure.is_finite()).then_some(pressure)
}
