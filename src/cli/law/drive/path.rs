//! Path of a contact: a mode of opening, or a file.

use super::super::super::Failure;
use super::DriveArgs;
use crate::laws::LawError;
use crate::laws::bench::Bench;
use crate::laws::bench::scale::{BondScale, Mode, attraction_reach};
use crate::scene::sample::table::Table;
use std::path::Path;

/// Opening, or sliding distance, for laws without a length scale (m).
const USUAL: f64 = 1e-5;
/// Pressure (Pa) and temperature (K) up to which contacts are pressed and heated by default.
const MAX_PRESSURE: f64 = 1e9;
const MAX_TEMPERATURE: f64 = 2000.0;

/// Default extent of the path from the law's own scale: 1.2 times the opening at break (cyclic: 1.2
/// times the opening at the peak; force: 1.1 times the strength), or beyond the range of an
/// attraction.
pub(super) fn extent(args: &DriveArgs, mode: &str, bench: &mut Bench) -> Result<f64, Failure> {
    if let Some(to) = args.to {
        return Ok(to);
    }
    match mode {
        "press" => return Ok(MAX_PRESSURE),
        "heat" => return Ok(MAX_TEMPERATURE),
        "slide" => return Ok(USUAL),
        _ if args.path.is_some() => return Ok(USUAL),
        _ => {}
    }
    let failed = |e: LawError| Failure::Failed(e.to_string());
    let Some(scale) = bench.scale(args.rate).map_err(failed)? else {
        let reach = attraction_reach(bench, args.rate).map_err(failed)?;
        return Ok(reach.map_or(USUAL, |r| 1.2 * r));
    };
    let shear = match mode {
        "II" | "2" => true,
        "I" | "1" => false,
        // A mixed path uses the nearer pure mode.
        "mixed" => args.angle.unwrap_or(45.0) > 45.0,
        _ => args.angle.unwrap_or(0.0) > 45.0,
    };
    Ok(of_mode(mode, &scale, shear))
}

fn of_mode(mode: &str, scale: &BondScale, shear: bool) -> f64 {
    let Mode { peak, broken, .. } = if shear { scale.shear } else { scale.normal };
    let strength = peak.map(|p| p.0);
    let opening = peak.map(|p| p.1);
    match mode {
        // A bond that does not break is loaded up to a fixed traction.
        "force" => strength.map_or(1e6, |s| 1.1 * s),
        "cyclic" => opening.map_or(USUAL, |u| 1.2 * u),
        _ => match (broken, opening) {
            (Some(b), _) => 1.2 * b,
            (None, Some(u)) => 5.0 * u,
            (None, None) => USUAL,
        },
    }
}

/// A contact at the end of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Time (s).
    pub time: f64,
    /// Opening (m).
    pub opening: [f64; 3],
    /// Compressive pressure (Pa).
    pub pressure: f64,
    /// Temperature of both bodies (K).
    pub temperature: f64,
}

/// The contact at the ends of the steps.
pub(super) fn path(args: &DriveArgs, mode: &str, to: f64) -> Result<Vec<Point>, Failure> {
    let slides = matches!(mode, "slide" | "heat");
    let pressure = args.pressure.unwrap_or(if slides { 1e6 } else { 0.0 });
    let raised = |k: u32| f64::from(k) / f64::from(args.steps);
    let at_rest = |time, pressure, temperature| Point {
        time,
        opening: [0.0; 3],
        pressure,
        temperature,
    };
    let room = args.temperature;
    match mode {
        _ if args.path.is_some() => {}
        "press" => {
            let point = |k| at_rest(raised(k), to * raised(k), room);
            return Ok((1..=args.steps).map(point).collect());
        }
        "heat" => {
            let point = |k| at_rest(raised(k), pressure, room + (to - room) * raised(k));
            return Ok((1..=args.steps).map(point).collect());
        }
        _ => {}
    }
    let point = |(time, opening)| Point {
        time,
        opening,
        pressure,
        temperature: room,
    };
    Ok(openings(args, mode, to)?.into_iter().map(point).collect())
}

/// Times (s) and openings (m) at the ends of the steps.
fn openings(args: &DriveArgs, mode: &str, to: f64) -> Result<Vec<(f64, [f64; 3])>, Failure> {
    if let Some(file) = &args.path {
        return read_path(file);
    }
    let usage = |what: &str| Err(Failure::Usage(what.to_owned()));
    let n = args.steps;
    let at = |u: f64, degrees: f64| {
        let angle = degrees.to_radians();
        [u * angle.cos(), u * angle.sin(), 0.0]
    };
    let straight = |degrees: f64| {
        let fraction = move |k: u32| f64::from(k) / f64::from(n);
        let point = |k| {
            let u = to * fraction(k);
            (u / args.rate, at(u, degrees))
        };
        (1..=n).map(point).collect()
    };
    Ok(match mode {
        "I" | "1" => straight(0.0),
        "II" | "2" => straight(90.0),
        "mixed" => straight(args.angle.unwrap_or(45.0)),
        "cyclic" => {
            let degrees = args.angle.unwrap_or(0.0);
            // Mode II is symmetric about zero; a normal opening starts closed.
            let both = (degrees - 90.0).abs() < 1e-9;
            let travel = to * if both { 4.0 } else { 2.0 };
            let point = |k: u32| {
                let phase = f64::from(k) / f64::from(n);
                let within = phase.fract();
                let u = match (both, within) {
                    (false, x) if x < 0.5 => 2.0 * x,
                    (false, x) => 2.0 - 2.0 * x,
                    (true, x) if x < 0.25 => 4.0 * x,
                    (true, x) if x < 0.75 => 2.0 - 4.0 * x,
                    (true, x) => 4.0 * x - 4.0,
                };
                (phase * travel / args.rate, at(u * to, degrees))
            };
            (1..=n * args.cycles).map(point).collect()
        }
        "slide" => {
            if args.velocities.is_empty()
                || args.velocities.iter().any(|v| !(v.is_finite() && *v > 0.0))
            {
                return usage("--mode slide needs --velocities V1,V2,... in m/s, each positive");
            }
            let (mut time, mut s, mut points) = (0.0, 0.0, Vec::new());
            for v in &args.velocities {
                let step = to / f64::from(n);
                for _ in 0..n {
                    time += step / v;
                    s += step;
                    points.push((time, [0.0, s, 0.0]));
                }
            }
            points
        }
        other => {
            return usage(&format!(
                "--mode {other}: expected I, II, mixed, cyclic, force, slide, press or heat"
            ));
        }
    })
}

fn read_path(file: &Path) -> Result<Vec<(f64, [f64; 3])>, Failure> {
    let fail = |what: String| Failure::Usage(format!("{}: {what}", file.display()));
    let table = Table::read(file, &["time", "n"], &["t1", "t", "t2"])?;
    let place = |name: &str| table.column(name);
    let (Some(t1), false) = (
        place("t1").or_else(|| place("t")),
        place("t1").is_some() && place("t").is_some(),
    ) else {
        return Err(fail(
            "expected a header with the columns time, n, t1 (or t) and perhaps t2".into(),
        ));
    };
    let (time, n, t2) = (place("time"), place("n"), place("t2"));
    let mut out: Vec<(f64, [f64; 3])> = Vec::new();
    for row in 0..table.len() {
        let opening = [n, Some(t1), t2].map(|column| table.value(row, column));
        let time = table.value(row, time);
        if row == 0 && time == 0.0 {
            if opening != [0.0; 3] {
                let message = "at time 0 the bond is closed: its opening must be 0";
                return Err(table.fail(row, message).into());
            }
            continue;
        }
        if time <= out.last().map_or(0.0, |l| l.0) {
            return Err(table.fail(row, "times must rise from 0").into());
        }
        out.push((time, opening));
    }
    if out.is_empty() {
        return Err(fail("holds no step; expected rows of time,n,t1,t2".into()));
    }
    Ok(out)
}
