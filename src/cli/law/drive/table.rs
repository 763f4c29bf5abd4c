//! Response of the laws along a path, row by row.

use super::super::super::Failure;
use super::super::super::output::report;
use super::DriveArgs;
use super::path::Point;
use crate::laws::bench::{Bench, BenchMotion, BenchOutputs, ROOM_TEMPERATURE};
use serde::Serialize;

/// A row of the table.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Row {
    pub time: f64,
    pub opening_n: f64,
    pub opening_t1: f64,
    pub opening_t2: f64,
    pub traction_n: f64,
    pub traction_t1: f64,
    pub traction_t2: f64,
    pub damage: f64,
    /// Cumulative work (J/m^2).
    pub work: f64,
    pub stored: f64,
    pub friction: f64,
    pub tension_strength: f64,
    pub worn: f64,
    /// Pressure (Pa) and temperature (K) of the contact.
    pub pressure: f64,
    pub temperature: f64,
    /// Thermal (W/K) and electrical (S) conductance.
    pub conductance: f64,
    pub electric_conductance: f64,
}

pub(super) fn along(bench: &mut Bench, points: &[Point], mode: &str) -> Result<Vec<Row>, Failure> {
    let mut state = [bench.fresh()];
    let mut rows = vec![Row::start(bench)];
    let failed = |e: crate::laws::LawError| Failure::Failed(e.to_string());
    if !bench.law().opens() && !matches!(mode, "press" | "heat") {
        // Capillary bridges and necks form in contact, so the path begins in contact.
        let touch = BenchMotion {
            pressure: 1e6,
            temperatures: [points.first().map_or(ROOM_TEMPERATURE, |p| p.temperature); 2],
            ..BenchMotion::default()
        };
        let h = points.first().map_or(1.0, |p| p.time);
        let a = bench.step(&mut state, &[touch], h).map_err(failed)?[0];
        (rows[0].friction, rows[0].tension_strength) = (a.mu, a.strength[0]);
        state[0].time = 0.0;
    }
    for point in points {
        let Point { time, opening, .. } = point;
        let motion = BenchMotion {
            opening: *opening,
            gap: opening[0],
            pressure: point.pressure,
            temperatures: [point.temperature; 2],
            ..BenchMotion::default()
        };
        let last = rows[rows.len() - 1];
        let h = time - last.time;
        if !(h.is_finite() && h > 0.0) {
            return Err(Failure::Usage(format!(
                "the path has a step of {h} s; change --rate, --to or --steps"
            )));
        }
        let answer = bench
            .step(&mut state, &[motion], h)
            .map_err(|e| Failure::Failed(e.to_string()))?;
        let row = last.next(*time, opening, &answer[0]);
        rows.push(Row {
            pressure: point.pressure,
            temperature: point.temperature,
            ..row
        });
    }
    Ok(rows)
}

/// Increases the traction to the target; the bond has failed if no opening carries more.
pub(super) fn by_force(bench: &mut Bench, args: &DriveArgs, to: f64) -> Result<Vec<Row>, Failure> {
    let mut state = [bench.fresh()];
    let mut rows = vec![Row::start(bench)];
    let angle = args.angle.unwrap_or(0.0).to_radians();
    let at = |u: f64| [u * angle.cos(), u * angle.sin(), 0.0];
    let h = 1.0 / f64::from(args.steps.max(1));
    let mut u = 0.0;
    for k in 1..=args.steps {
        let target = to * f64::from(k) * h;
        let carried = |bench: &mut Bench, u: f64| -> Result<f64, Failure> {
            let mut probe = state.clone();
            let motion = BenchMotion {
                opening: at(u),
                gap: at(u)[0],
                temperatures: [args.temperature; 2],
                ..BenchMotion::default()
            };
            let a = bench
                .step(&mut probe, &[motion], h)
                .map_err(|e| Failure::Failed(e.to_string()))?[0];
            Ok(a.traction[0] * angle.cos() + a.traction[1] * angle.sin())
        };
        // Search outwards from the previous opening for the first one that carries the target.
        let (mut low, mut high, mut step) = (u, u, 1e-13f64.max(1e-3 * u));
        let mut found = false;
        while high < 1.0 {
            (low, high) = (high, high + step);
            if carried(bench, high)? >= target {
                found = true;
                break;
            }
            step *= 1.05;
        }
        if !found {
            let last = rows[rows.len() - 1];
            report(&format!(
                "the bond does not carry {target:.6e} Pa: it failed between {:.6e} and {target:.6e} Pa",
                last.traction_n.hypot(last.traction_t1)
            ));
            break;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if carried(bench, middle)? >= target {
                high = middle;
            } else {
                low = middle;
            }
        }
        u = high;
        let motion = BenchMotion {
            opening: at(u),
            gap: at(u)[0],
            temperatures: [args.temperature; 2],
            ..BenchMotion::default()
        };
        let answer = bench
            .step(&mut state, &[motion], h)
            .map_err(|e| Failure::Failed(e.to_string()))?;
        let last = rows[rows.len() - 1];
        rows.push(last.next(f64::from(k) * h, &at(u), &answer[0]));
    }
    Ok(rows)
}

impl Row {
    fn start(bench: &Bench) -> Self {
        Self {
            time: 0.0,
            opening_n: 0.0,
            opening_t1: 0.0,
            opening_t2: 0.0,
            traction_n: 0.0,
            traction_t1: 0.0,
            traction_t2: 0.0,
            damage: bench.fresh().damage,
            work: 0.0,
            stored: 0.0,
            friction: 0.0,
            tension_strength: 0.0,
            worn: 0.0,
            pressure: 0.0,
            temperature: ROOM_TEMPERATURE,
            conductance: 0.0,
            electric_conductance: 0.0,
        }
    }

    fn next(&self, time: f64, opening: &[f64; 3], a: &BenchOutputs) -> Self {
        let before = [self.opening_n, self.opening_t1, self.opening_t2];
        let carried = [self.traction_n, self.traction_t1, self.traction_t2];
        let work: f64 = (0..3)
            .map(|k| 0.5 * (carried[k] + a.traction[k]) * (opening[k] - before[k]))
            .sum();
        Self {
            time,
            opening_n: opening[0],
            opening_t1: opening[1],
            opening_t2: opening[2],
            traction_n: a.traction[0],
            traction_t1: a.traction[1],
            traction_t2: a.traction[2],
            damage: a.damage,
            work: self.work + work,
            stored: a.stored,
            friction: a.mu,
            tension_strength: a.strength[0],
            worn: self.worn + a.worn,
            pressure: self.pressure,
            temperature: self.temperature,
            conductance: a.conductance[0],
            electric_conductance: a.conductance[1],
        }
    }

    pub fn opening(&self) -> f64 {
        self.opening_n.hypot(self.opening_t1).hypot(self.opening_t2)
    }

    /// The traction along the opening.
    pub fn along(&self) -> f64 {
        let u = self.opening();
        let dot = self.traction_n * self.opening_n
            + self.traction_t1 * self.opening_t1
            + self.traction_t2 * self.opening_t2;
        if u > 0.0 { dot / u } else { 0.0 }
    }
}
