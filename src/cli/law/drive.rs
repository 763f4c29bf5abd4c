//! `fretwork law drive`: one contact on the bench.

use super::super::number::positive;
use super::super::{Failure, PluginArgs, say, say_json};
use super::{all_used, named, values};
use crate::laws::bench::{Answer, Bench, Motion};
use crate::laws::{AreaRule, BondRule, Interface, Kind, Loaded, Plugin};
use crate::report::{Axis, Chart, Series};
use crate::scene::sample::table::Table;
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub const EXAMPLES: &str = "Examples:
  fretwork law drive mac --to 1e-5 --rate 0.045 --png mac.png
  fretwork law drive elastic-bond linear-softening --mode mixed --angle 45 --csv curve.csv
  fretwork law drive mac --mode cyclic --to 5e-7 --cycles 10
  fretwork law drive mac --mode force --to 2e5
  fretwork law drive rate-and-state --mode slide --velocities 1e-6,1e-5 --to 1e-4
  fretwork law drive mac --path my_path.csv        (columns time,n,t1,t2 or time,n,t)";

#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub struct DriveArgs {
    /// Laws to compose: a name fills every slot that has it; kind/name fills one
    #[arg(required = true)]
    laws: Vec<String>,
    /// A parameter: NAME=VALUE or KIND.NAME=VALUE
    #[arg(long = "set", value_name = "NAME=VALUE")]
    sets: Vec<String>,
    /// I, II, mixed (at --angle), cyclic (about zero in mode II; from 0 in mode I with --angle 0), force (raised in 1 s), slide
    #[arg(long, default_value = "I")]
    mode: String,
    /// Angle of the opening from the normal, degrees (mixed, cyclic, force)
    #[arg(long)]
    angle: Option<f64>,
    /// Largest opening (m), traction (force, Pa) or sliding distance at each velocity (slide, m)
    #[arg(long, default_value_t = 1e-5)]
    to: f64,
    /// Speed of the opening (m/s)
    #[arg(long, default_value_t = 1e-3)]
    rate: f64,
    /// Steps of the path, of a cycle, or of each velocity
    #[arg(long, default_value_t = 2000)]
    steps: u32,
    /// Cycles (cyclic)
    #[arg(long, default_value_t = 5)]
    cycles: u32,
    /// Velocities one after the other (slide, m/s)
    #[arg(long, value_delimiter = ',', value_parser = positive)]
    velocities: Vec<f64>,
    /// Compressive pressure (Pa); 1e6 in slide, else 0
    #[arg(long)]
    pressure: Option<f64>,
    /// A path from a CSV file with a heading: time,n,t1,t2 (s, m)
    #[arg(long)]
    path: Option<PathBuf>,
    /// Write the table to a CSV file
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Draw the curve to a PNG file
    #[arg(long)]
    png: Option<PathBuf>,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

/// A row of the table.
#[derive(Clone, Copy, Debug, Serialize)]
struct Row {
    time: f64,
    opening_n: f64,
    opening_t1: f64,
    opening_t2: f64,
    traction_n: f64,
    traction_t1: f64,
    traction_t2: f64,
    damage: f64,
    /// Work done so far (J/m^2).
    work: f64,
    stored: f64,
    friction: f64,
    tension_strength: f64,
    worn: f64,
}

/// Refuses numbers that make no path.
fn check(args: &DriveArgs) -> Result<(), Failure> {
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let wrong = [
        (!positive(args.to), "--to must be positive"),
        (!positive(args.rate), "--rate must be positive"),
        (args.steps == 0, "--steps must be at least 1"),
        (args.cycles == 0, "--cycles must be at least 1"),
        (
            u64::from(args.steps) * u64::from(args.cycles) > 100_000_000,
            "--steps times --cycles must not exceed 1e8",
        ),
        (
            args.angle.is_some_and(|a| !(0.0..=90.0).contains(&a)),
            "--angle must lie between 0 and 90 degrees",
        ),
        (
            args.pressure.is_some_and(|p| !(p.is_finite() && p >= 0.0)),
            "--pressure must not be negative",
        ),
    ];
    match wrong.iter().find(|w| w.0) {
        Some((_, what)) => Err(Failure::Usage((*what).to_owned())),
        None => Ok(()),
    }
}

pub fn drive(args: &DriveArgs) -> Result<(), Failure> {
    check(args)?;
    let mut bench = Bench::new(compose(args)?, 3, 1e-5);
    let rows = if args.mode == "force" && args.path.is_none() {
        by_force(&mut bench, args)?
    } else {
        along(&mut bench, &path(args)?, args)?
    };
    if let Some(file) = &args.csv {
        write_csv(file, &rows)?;
    }
    if let Some(file) = &args.png {
        draw(file, &rows, args)?;
    }
    if args.json {
        say_json(&serde_json::to_string_pretty(&rows).unwrap_or_default());
    } else {
        say(&text(&rows));
    }
    Ok(())
}

fn compose(args: &DriveArgs) -> Result<Interface, Failure> {
    let path = args.plugins.search()?;
    let mut slots: [Option<Plugin>; 4] = [None, None, None, None];
    let place = |kind: Kind| Kind::ALL.iter().position(|k| *k == kind).unwrap_or(0);
    for name in &args.laws {
        for plugin in named(&path, name)? {
            let slot = &mut slots[place(plugin.kind)];
            if let Some(other) = slot {
                return Err(Failure::Usage(format!(
                    "`{}` and `{}` are both {} laws; an interface has one of each kind",
                    other.name, plugin.name, plugin.kind
                )));
            }
            *slot = Some(plugin);
        }
    }
    if slots[0].is_none() {
        slots[0] = Some(path.find(Kind::Contact, "frictionless")?);
    }
    let mut used = vec![false; args.sets.len()];
    let mut loaded = Vec::new();
    for plugin in slots {
        loaded.push(match plugin {
            None => None,
            Some(plugin) => Some(Loaded {
                parameters: values(&plugin, &args.sets, &mut used)?,
                plugin: Arc::new(plugin),
                first_variable: 0,
            }),
        });
    }
    let laws: Vec<&Plugin> = loaded.iter().flatten().map(|l| &*l.plugin).collect();
    all_used(&args.sets, &used, &laws)?;
    let mut next = loaded.into_iter();
    let mut slot = || next.next().flatten();
    let Some(contact) = slot() else {
        return Err(Failure::Usage("there is no contact law".into()));
    };
    let law = Interface {
        name: "bench".into(),
        contact,
        cohesion: slot(),
        damage: slot(),
        wear: slot(),
        bonds: BondRule::Start,
        healing: None,
        area: AreaRule::default(),
    };
    Ok(law.compose()?)
}

/// Times at the ends of the steps (s) and openings there.
fn path(args: &DriveArgs) -> Result<Vec<(f64, [f64; 3])>, Failure> {
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
            let u = args.to * fraction(k);
            (u / args.rate, at(u, degrees))
        };
        (1..=n).map(point).collect()
    };
    Ok(match args.mode.as_str() {
        "I" | "1" => straight(0.0),
        "II" | "2" => straight(90.0),
        "mixed" => straight(args.angle.unwrap_or(45.0)),
        "cyclic" => {
            let degrees = args.angle.unwrap_or(0.0);
            // Mode II goes to both sides; a normal opening goes from closed to open.
            let both = (degrees - 90.0).abs() < 1e-9;
            let travel = args.to * if both { 4.0 } else { 2.0 };
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
                (phase * travel / args.rate, at(u * args.to, degrees))
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
                let step = args.to / f64::from(n);
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
                "--mode {other}: expected I, II, mixed, cyclic, force or slide"
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
            "expected a heading with the columns time, n, t1 (or t) and perhaps t2".into(),
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

fn along(
    bench: &mut Bench,
    points: &[(f64, [f64; 3])],
    args: &DriveArgs,
) -> Result<Vec<Row>, Failure> {
    let mut state = [bench.fresh()];
    let mut rows = vec![Row::start(bench)];
    let failed = |e: crate::laws::LawError| Failure::Failed(e.to_string());
    if !bench.law().opens() {
        // Bridges and necks form in contact: the path begins there.
        let touch = Motion {
            pressure: 1e6,
            ..Motion::default()
        };
        let h = points.first().map_or(1.0, |p| p.0);
        let a = bench.step(&mut state, &[touch], h).map_err(failed)?[0];
        (rows[0].friction, rows[0].tension_strength) = (a.mu, a.strength[0]);
        state[0].time = 0.0;
    }
    for (time, opening) in points {
        let motion = Motion {
            opening: *opening,
            gap: opening[0],
            pressure: args
                .pressure
                .unwrap_or(if args.mode == "slide" { 1e6 } else { 0.0 }),
            ..Motion::default()
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
        rows.push(last.next(*time, opening, &answer[0]));
    }
    Ok(rows)
}

/// Raises the traction to the target; where no opening carries more, the bond has failed.
fn by_force(bench: &mut Bench, args: &DriveArgs) -> Result<Vec<Row>, Failure> {
    let mut state = [bench.fresh()];
    let mut rows = vec![Row::start(bench)];
    let angle = args.angle.unwrap_or(0.0).to_radians();
    let at = |u: f64| [u * angle.cos(), u * angle.sin(), 0.0];
    let h = 1.0 / f64::from(args.steps.max(1));
    let mut u = 0.0;
    for k in 1..=args.steps {
        let target = args.to * f64::from(k) * h;
        let carried = |bench: &mut Bench, u: f64| -> Result<f64, Failure> {
            let mut probe = state.clone();
            let motion = Motion {
                opening: at(u),
                gap: at(u)[0],
                ..Motion::default()
            };
            let a = bench
                .step(&mut probe, &[motion], h)
                .map_err(|e| Failure::Failed(e.to_string()))?[0];
            Ok(a.traction[0] * angle.cos() + a.traction[1] * angle.sin())
        };
        // The first opening that carries the target, found outwards from the last.
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
            eprintln!(
                "the bond does not carry {target:.6e} Pa: it failed between {:.6e} and {target:.6e} Pa",
                last.traction_n.hypot(last.traction_t1)
            );
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
        let motion = Motion {
            opening: at(u),
            gap: at(u)[0],
            ..Motion::default()
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
        }
    }

    fn next(&self, time: f64, opening: &[f64; 3], a: &Answer) -> Self {
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
        }
    }

    fn opening(&self) -> f64 {
        self.opening_n.hypot(self.opening_t1).hypot(self.opening_t2)
    }

    /// The traction along the opening.
    fn along(&self) -> f64 {
        let u = self.opening();
        let dot = self.traction_n * self.opening_n
            + self.traction_t1 * self.opening_t1
            + self.traction_t2 * self.opening_t2;
        if u > 0.0 { dot / u } else { 0.0 }
    }
}

fn write_csv(file: &Path, rows: &[Row]) -> Result<(), Failure> {
    let fail = |e: csv::Error| Failure::Failed(format!("cannot write {}: {e}", file.display()));
    let mut writer = csv::Writer::from_path(file).map_err(fail)?;
    for row in rows {
        writer.serialize(row).map_err(fail)?;
    }
    writer.flush().map_err(|e| fail(e.into()))
}

fn draw(file: &Path, rows: &[Row], args: &DriveArgs) -> Result<(), Failure> {
    let fail = |e: crate::report::ReportError| Failure::Failed(e.to_string());
    let points = |x: &dyn Fn(&Row) -> f64, y: &dyn Fn(&Row) -> f64| {
        rows.iter().map(|r| (x(r), y(r))).collect::<Vec<_>>()
    };
    let title = args.laws.join(" + ");
    let carries = rows
        .iter()
        .any(|r| r.traction_n != 0.0 || r.traction_t1 != 0.0);
    if !carries && rows.iter().any(|r| r.tension_strength > 0.0) {
        let chart = Chart::new(
            title,
            Axis::new("gap", "m"),
            Axis::new("attraction over the area", "Pa"),
        )
        .with(Series::new(
            "attraction",
            points(&|r| r.opening_n, &|r| r.tension_strength),
        ));
        return chart.draw(file).map_err(fail);
    }
    if !carries {
        let chart = Chart::new(
            title,
            Axis::new("sliding distance", "m"),
            Axis::new("friction coefficient", ""),
        )
        .with(Series::new("mu", points(&Row::opening, &|r| r.friction)));
        return chart.draw(file).map_err(fail);
    }
    // Signed along the first direction that opens, so that cycles are loops.
    let sign = |r: &Row| if r.opening_t1 < 0.0 { -1.0 } else { 1.0 };
    let signed = |r: &Row| sign(r) * r.opening();
    Chart::new(
        title.clone(),
        Axis::new("opening", "m"),
        Axis::new("traction", "Pa"),
    )
    .with(Series::new(
        "traction along the opening",
        points(&signed, &|r| sign(r) * r.along()),
    ))
    .draw(file)
    .map_err(fail)?;
    let mut name = file.file_stem().unwrap_or_default().to_os_string();
    name.push("_damage.png");
    Chart::new(title, Axis::new("opening", "m"), Axis::new("damage", ""))
        .with(Series::new("D", points(&signed, &|r| r.damage)))
        .draw(&file.with_file_name(name))
        .map_err(fail)
}

/// Some twenty rows, and what the whole path came to.
fn text(rows: &[Row]) -> String {
    let mut out = format!(
        "{:>11} {:>12} {:>12} {:>13} {:>13} {:>9} {:>12} {:>12} {:>8} {:>13}\n",
        "time s",
        "opening_n m",
        "opening_t m",
        "traction_n Pa",
        "traction_t Pa",
        "damage",
        "work J/m2",
        "stored J/m2",
        "mu",
        "attraction Pa"
    );
    let every = rows.len().div_ceil(20).max(1);
    for (k, r) in rows.iter().enumerate() {
        if k % every != 0 && k + 1 != rows.len() {
            continue;
        }
        out += &format!(
            "{:>11.4e} {:>12.4e} {:>12.4e} {:>13.6e} {:>13.6e} {:>9.6} {:>12.6e} {:>12.6e} {:>8.5} {:>13.6e}\n",
            r.time,
            r.opening_n,
            r.opening_t1,
            r.traction_n,
            r.traction_t1,
            r.damage,
            r.work,
            r.stored,
            r.friction,
            r.tension_strength
        );
    }
    let peak = rows.iter().map(|r| r.along().abs()).fold(0.0, f64::max);
    let Some(last) = rows.last() else {
        return out;
    };
    let strongest = rows.iter().map(|r| r.tension_strength).fold(0.0, f64::max);
    if peak > 0.0 {
        out += &format!(
            "peak traction {:.6e} Pa, area under the curve {:.6e} J/m2, dissipated {:.6e} J/m2, damage {:.6}",
            peak,
            last.work,
            last.work - last.stored,
            last.damage
        );
    } else {
        out += &format!("friction at the end {:.6}", last.friction);
    }
    if strongest > 0.0 {
        out += &format!(", attraction at most {strongest:.6e} Pa");
    }
    if last.worn > 0.0 {
        out += &format!(", worn {:.6e} m3", last.worn);
    }
    out
}
