//! `fretwork law drive`: one contact on a test bench.

mod laws;
mod output;
mod path;
mod table;

use super::super::number::positive;
use super::super::output::{answer, answer_json, inform};
use super::super::{Failure, PluginArgs, cases};
use crate::laws::bench::ROOM_TEMPERATURE;
use crate::shipped::inputs::InputKind;
use clap::Args;
use std::path::PathBuf;

pub const EXAMPLES: &str = "Examples:
  fretwork law drive mac --to 1e-5 --rate 0.045 --png mac.png
  fretwork law drive elastic-bond linear-softening --mode mixed --angle 45 --csv curve.csv
  fretwork law drive mac --mode cyclic --to 5e-7 --cycles 10
  fretwork law drive mac --mode force --to 2e5
  fretwork law drive rate-and-state --mode slide --velocities 1e-6,1e-5 --to 1e-4
  fretwork law drive holm --to 5e8
  fretwork law drive thermal-friction --mode heat --to 1500
  fretwork law drive mac --path my_path.csv        (columns time,n,t1,t2 or time,n,t)
  fretwork law drive --case cases/wheel_rail_fretting.ron --interface third_body --mode II --png bond.png";

#[derive(Args, Debug)]
#[command(allow_negative_numbers = true)]
pub struct DriveArgs {
    /// Laws to compose: a name fills every slot that has a law of this name; kind/name fills one
    /// slot
    #[arg(required_unless_present_any = ["case", "interface"], conflicts_with = "case")]
    laws: Vec<String>,
    /// Drive the laws of an interface of this case, with its parameters, on contacts of their size
    /// in the case
    #[arg(long, value_name = "FILE", value_parser = cases::input(InputKind::Case))]
    case: Option<PathBuf>,
    /// Name of the interface in the case; may be omitted if there is only one
    #[arg(long, value_name = "NAME", requires = "case")]
    interface: Option<String>,
    /// A parameter: NAME=VALUE or KIND.NAME=VALUE; with --case a value of the case: KEY.PATH=VALUE
    #[arg(long = "set", value_name = "NAME=VALUE")]
    sets: Vec<String>,
    /// I, II, mixed (at --angle), cyclic (about zero in mode II; from 0 in mode I with --angle 0),
    /// force (raised in 1 s), slide, press (pressure raised in 1 s), heat (temperature raised in 1
    /// s); press by default where a transport law is driven, otherwise I
    #[arg(long)]
    mode: Option<String>,
    /// Angle of the opening to the normal, degrees (mixed, cyclic, force)
    #[arg(long)]
    angle: Option<f64>,
    /// Largest opening (m), traction (force, Pa), sliding distance at each velocity (slide, m),
    /// pressure (press, Pa) or temperature (heat, K); by default 20 % beyond the opening at which
    /// the bond breaks or the attraction ends (cyclic: beyond its peak; force: 10 % beyond its
    /// strength; slide: 1e-5; press: 1e9; heat: 2000)
    #[arg(long)]
    to: Option<f64>,
    /// Reduced radius of the contact r1 r2/(r1 + r2) (m); by default 1e-5, with --case the median
    /// of the interface's contacts
    #[arg(long, value_parser = positive)]
    radius: Option<f64>,
    /// Speed of the opening (m/s)
    #[arg(long, default_value_t = 1e-3)]
    rate: f64,
    /// Steps of the path, of each cycle, or of each velocity
    #[arg(long, default_value_t = 2000)]
    steps: u32,
    /// Cycles (cyclic)
    #[arg(long, default_value_t = 5)]
    cycles: u32,
    /// Velocities in sequence (slide, m/s)
    #[arg(long, value_delimiter = ',', value_parser = positive)]
    velocities: Vec<f64>,
    /// Compressive pressure (Pa); by default 1e6 in slide and heat, otherwise 0
    #[arg(long)]
    pressure: Option<f64>,
    /// Temperature of both bodies (K); with heat the lowest
    #[arg(long, default_value_t = ROOM_TEMPERATURE, value_parser = positive)]
    temperature: f64,
    /// A path from a CSV file with the header time,n,t1,t2 (s, m)
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

/// Checks the numeric arguments of the path.
fn check(args: &DriveArgs) -> Result<(), Failure> {
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let wrong = [
        (
            args.to.is_some_and(|to| !positive(to)),
            "--to must be positive",
        ),
        (
            args.radius.is_some_and(|r| !positive(r)),
            "--radius must be positive",
        ),
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
    let (mut bench, title) = laws::bench(args)?;
    let transport = bench.law().transport().is_some() && !bench.law().opens();
    let mode = match &args.mode {
        Some(mode) => mode.as_str(),
        None if transport => "press",
        None => "I",
    };
    let to = path::extent(args, mode, &mut bench)?;
    let rows = if mode == "force" && args.path.is_none() {
        table::by_force(&mut bench, args, to)?
    } else {
        table::along(&mut bench, &path::path(args, mode, to)?, mode)?
    };
    if let Some(file) = &args.csv {
        output::write_csv(file, &rows)?;
    }
    if let Some(file) = &args.png {
        output::draw(file, &rows, title.clone())?;
    }
    if args.json {
        answer_json(&serde_json::to_string_pretty(&rows).unwrap_or_default())
    } else {
        if args.case.is_some() {
            inform(&title);
        }
        let thermal = bench.law().reads_temperatures();
        answer(&match thermal {
            true => output::thermal_text(&rows),
            false => output::text(&rows),
        })
    }
}
