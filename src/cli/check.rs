//! `fretwork check`: the features that a case uses, its size and dimensionless groups; writes no
//! files.

mod bonds;
mod brief;
mod deformable;
mod features;
mod heat;
mod inputs;
mod load;
mod springs;

use super::output::answer;
use super::{CaseArgs, Failure, observers};
use crate::bodies::Dof;
use crate::experiments::runs::trial::Trial;
use crate::geometry::space::ball_volume;
use crate::record::biaxial::Biaxial;
use crate::record::check_names;
use crate::scene::interfaces::without_interface;
use crate::scene::methods::{SolverRequirements, SolverSupport};
use crate::scene::most_steps::{may_end_earlier, most_steps};
use crate::scene::source::clean;
use crate::scene::{Built, LoadedCase, law_inputs, load, sampling};
use crate::solve::local::solver::Method;
use crate::{AnySimulation, RunView};
use clap::Args;
use features::{Features, memory};
use load::Load;
use std::fmt::Write as _;

#[derive(Args, Debug)]
pub struct CheckArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// Leave out the estimate of the run time, for which steps are timed for half a second
    #[arg(long)]
    no_timing: bool,
    /// Print the parameters of all laws: value, unit, and whether the case, a file, a material or
    /// the law's default gives it
    #[arg(long)]
    inputs: bool,
    /// Print all lines: features, methods, memory, bonds, stiffness of contacts, heat
    #[arg(long, short)]
    verbose: bool,
}

pub fn check(args: &CheckArgs) -> Result<(), Failure> {
    let loaded = load(&args.case.case, &args.case.sets)?;
    let built = loaded.build(&args.case.plugins.search()?)?;
    check_names(&loaded, &observers::all(&loaded, built.simulation.view()))?;
    let title = format!("{}: {}", loaded.path.display(), clean(&loaded.case.name));
    let lines = lines(&loaded, &built, !args.no_timing);
    let inputs = match args.inputs {
        true => inputs::lines(built.simulation.view(), &built.wear_coefficients),
        false => Vec::new(),
    };
    let inputs: String = inputs
        .iter()
        .map(|(label, text)| format!("\n{}", line_of(label, text)))
        .collect();
    if !args.verbose {
        let time = (!args.no_timing).then(|| run_time(&loaded, built));
        return answer(&(brief::text(title, &lines, time) + &inputs));
    }
    let mut out = title;
    for (label, text) in lines {
        let _ = write!(out, "\n{}", line_of(&label, &text));
    }
    if !args.inputs {
        let text = "each parameter of the laws with its origin: --inputs";
        let _ = write!(out, "\n{}", line_of("inputs", text));
    }
    out += &inputs;
    answer(&out)?;
    if !args.no_timing {
        let (label, text) = run_time(&loaded, built);
        answer(&line_of(&label, &text))?;
    }
    Ok(())
}

fn line_of(label: &str, text: &str) -> String {
    format!("  {label:<20} {text}")
}

/// A line of the answer: its label and its text. A line that continues the previous one has no
/// label.
pub type CheckLine = (String, String);

/// Estimates the time of a run from steps that are computed for half a second.
pub fn run_time(loaded: &LoadedCase, built: Built) -> CheckLine {
    let mut text = Trial::of(&loaded.case, built).text();
    if loaded.case.accuracy.is_some() {
        text += "; with time.step throughout, where the run chooses its steps";
    }
    ("run time".to_owned(), text)
}

/// Describes how a run chooses its steps for a case that requires an accuracy.
fn chosen_steps(case: &crate::scene::case::Case, s: &dyn RunView) -> String {
    let Some(accuracy) = &case.accuracy else {
        return String::new();
    };
    let largest = accuracy.largest(case.time.step);
    if s.system_count() == 0 && largest > case.time.step {
        format!(
            "; the run chooses them, in parts where finer ones change the result, and up to {largest:e} s where nothing moves"
        )
    } else {
        "; the run chooses them, in parts where finer ones change the result".to_owned()
    }
}

/// Returns what `fretwork check --verbose` prints about a case below its title, except the [run
/// time](run_time). Deformable bodies are timed if `timed`.
pub fn lines(loaded: &LoadedCase, built: &Built, timed: bool) -> Vec<CheckLine> {
    let (case, simulation) = (&loaded.case, &built.simulation);
    let s = simulation.view();
    let mut out = Vec::new();
    let mut line = |label: &str, value: String| out.push((label.to_owned(), value));
    let steps = most_steps(case);
    line("dimension", s.dimension().to_string());
    line(
        "steps",
        format!(
            "{}{steps} of {:e} s, theta {}{}",
            if may_end_earlier(case) {
                "at most "
            } else {
                ""
            },
            case.time.step,
            case.time.theta,
            chosen_steps(case, s)
        ),
    );
    let largest = bodies(s, timed, &mut line);
    let solver = &s.options().solver;
    line(
        "solver",
        format!(
            "{} ({}), tolerance {:e}, at most {} iterations, tested every {}",
            solver.method.name(),
            solver.method.about(),
            solver.tolerance,
            solver.max_iterations,
            solver.test_every
        ),
    );
    methods(s, &mut line);
    line("error", solver.norm.formula().into());
    interfaces(s, &mut line);
    for w in &built.wear_coefficients {
        line(
            "wear coefficient",
            format!("{}, {}: {}", w.interface, w.law, w.derivation),
        );
    }
    for pair in without_interface(case, s) {
        line("no interface", pair);
    }
    let [grain, contact] = memory(s);
    line("memory a grain", grain);
    line("memory a contact", contact);
    for sample in &built.samples {
        line("sample", sample.clone());
    }
    let Features { on, off } = Features::of(case, simulation);
    for (k, text) in on.into_iter().enumerate() {
        line(if k == 0 { "on" } else { "" }, text);
    }
    line("off", off.join(", "));
    for drive in sampling::unresolved(case) {
        let heading = if drive.aliased {
            "ALIASED DRIVE"
        } else {
            "COARSE DRIVE"
        };
        line(heading, drive.text);
    }
    for text in law_inputs::undecided(case, s) {
        line("LAW DEFAULT", text);
    }
    for text in law_inputs::unmeasured(case, s) {
        line("NO WEAR RATE", text);
    }
    let load = Load::of(case, simulation);
    groups(loaded, simulation, largest, &mut line);
    biaxial_groups(loaded, simulation, &mut line);
    for (label, text) in heat::lines(case, simulation, &load) {
        line(&label, text);
    }
    for (label, text) in springs::lines(case, s, &load) {
        line(label, text);
    }
    for (label, text) in bonds::lines(case, s, &load) {
        line(label, text);
    }
    out
}

/// Adds the grains, first bodies, deformable bodies (with times if `timed`) and contacts; returns
/// the largest radius of a grain (m).
fn bodies(s: &dyn RunView, timed: bool, line: &mut impl FnMut(&str, String)) -> f64 {
    let range = |radii: &mut dyn Iterator<Item = f64>| {
        let start = (0, f64::INFINITY, 0.0f64);
        radii.fold(start, |(n, l, h), r| (n + 1, l.min(r), h.max(r)))
    };
    // Points of deformable bodies are balls without a radius.
    let radii = s.balls().into_iter().map(|b| b.radius);
    let (balls, low, high) = range(&mut radii.filter(|r| *r > 0.0));
    if balls > 0 {
        let text = format!("{balls}, radius {low:.3e} to {high:.3e} m");
        line("balls", text);
    }
    let (pieces, least, most) = range(&mut s.pieces().into_iter().map(|p| p.size));
    if pieces > 0 {
        let text =
            format!("{pieces}, {least:.3e} to {most:.3e} m, radius of the ball of the same volume");
        line("convex pieces", text);
    }
    let driven = s.bodies().driven.iter();
    let names: Vec<&str> = driven.map(|d| d.name.as_str()).collect();
    line(
        "first bodies",
        format!(
            "{} ({}), {} surfaces",
            names.len(),
            names.join(", "),
            s.surfaces().len()
        ),
    );
    for (label, text) in deformable::lines(s, timed) {
        line(label, text);
    }
    line("contacts at start", s.contact_count().to_string());
    high.max(most)
}

fn interfaces(s: &dyn RunView, line: &mut impl FnMut(&str, String)) {
    for law in s.laws() {
        let laws: Vec<String> = law
            .loaded()
            .map(|l| format!("{} {}", l.plugin.kind, l.plugin.name))
            .collect();
        line(
            "interface",
            format!(
                "{}: {}; bonds {:?}; {} internal variables",
                law.name,
                laws.join(", "),
                law.bonds,
                law.variables()
            ),
        );
    }
}

/// Describes which solvers support the case, and why the others do not. A case whose own solver
/// does not support it is rejected earlier.
fn methods(simulation: &dyn RunView, line: &mut impl FnMut(&str, String)) {
    let requirements = SolverRequirements::of(simulation);
    let (mut can, mut reasons) = (Vec::new(), Vec::new());
    for method in Method::ALL.iter().copied() {
        match requirements.support(method) {
            SolverSupport::Serves => can.push(method.name().to_owned()),
            SolverSupport::May(reason) => {
                can.push(format!("{}?", method.name()));
                reasons.push(format!("{} {reason}", method.name()));
            }
            SolverSupport::Refuses(reason) => {
                reasons.push(format!("not {}, {reason}", method.name()))
            }
        }
    }
    let chosen = simulation.options().solver.method;
    let served = match requirements.support(chosen) {
        SolverSupport::Serves => "supports this case".to_owned(),
        SolverSupport::May(reason) | SolverSupport::Refuses(reason) => reason,
    };
    line("method", format!("{} {served}", chosen.name()));
    line("methods", can.join(", "));
    for reason in reasons {
        line("", reason);
    }
}

/// Pressure and inertial number of a biaxial test, for a square sample.
fn biaxial_groups(loaded: &LoadedCase, s: &AnySimulation, line: &mut impl FnMut(&str, String)) {
    let case = &loaded.case;
    let Some((spec, test)) = case
        .biaxial
        .as_ref()
        .and_then(|spec| Some((spec, Biaxial::new(spec, s.view())?)))
    else {
        return;
    };
    // The strain is taken from the start of the test to its end, over all walls: at least one of
    // them is driven.
    let largest = |names: &(String, String), f: &dyn Fn(&Dof, f64) -> f64| {
        let walls = s.bodies().driven.iter();
        let walls = walls.filter(|d| d.name == names.0 || d.name == names.1);
        walls
            .flat_map(|d| &d.dofs[..s.dimension()])
            .flat_map(|dof| {
                (0..=1000).map(move |k| {
                    let part = f64::from(k) / 1000.0;
                    f(dof, spec.start + (case.time.end - spec.start) * part).abs()
                })
            })
            .fold(0.0, f64::max)
    };
    let speed = largest(&spec.axial, &|d, t| d.imposed_velocity(t).unwrap_or(0.0));
    let force = largest(&spec.lateral, &Dof::force);
    let side = (test.solid() / 0.82).sqrt();
    if !(side > 0.0 && force > 0.0) {
        return;
    }
    let pressure = force / side;
    line(
        "biaxial test",
        format!("about {side:.2e} m wide at a compacity of 0.82, under {pressure:.3e} Pa"),
    );
    let rate = speed / side;
    let inertial = rate * (test.grain_mass(s.view()) / pressure).sqrt();
    line(
        "inertial number",
        format!(
            "{inertial:.2e} at a strain rate of {rate:.2e} /s, {:.1e} of strain a step (quasi-static below about 1e-3)",
            rate * case.time.step
        ),
    );
}

/// Dimensionless groups of a friction test.
fn groups(
    loaded: &LoadedCase,
    s: &AnySimulation,
    largest: f64,
    line: &mut impl FnMut(&str, String),
) {
    let (case, bodies) = (&loaded.case, s.bodies());
    let Some(test) = &case.friction else { return };
    let Some(driven) = bodies.driven_named(&test.body) else {
        return;
    };
    let samples = |f: &dyn Fn(f64) -> f64| {
        (0..=1000)
            .map(|k| f(case.time.end * f64::from(k) / 1000.0).abs())
            .fold(0.0, f64::max)
    };
    let speed = samples(&|t| driven.dofs[test.along].imposed_velocity(t).unwrap_or(0.0));
    let step = speed * case.time.step;
    line(
        "fastest slide",
        format!(
            "{speed:.3e} m/s, {step:.2e} m a step ({:.2e} of the largest radius)",
            step / largest
        ),
    );
    let Some((area, pressure)) = load::friction_area(case, s).zip(load::friction_pressure(case, s))
    else {
        return;
    };
    line("pressure", format!("{pressure:.3e} Pa"));
    let mut flags = vec![false; bodies.len()];
    s.grains().into_iter().for_each(|grain| flags[grain] = true);
    // A convex part has the radius of the ball of equal volume.
    let balls = s.balls().into_iter().map(|b| (b.body, b.radius));
    let pieces = s.pieces().into_iter().map(|p| (p.body, p.size));
    let volume: f64 = balls
        .chain(pieces)
        .filter(|(body, _)| flags[*body as usize])
        .map(|(_, radius)| ball_volume(s.dimension(), radius))
        .sum();
    let masses = bodies.mass.iter().zip(&flags);
    let mass: f64 = masses.filter(|(_, grain)| **grain).map(|(m, _)| m).sum();
    if volume > 0.0 {
        let density = mass / volume;
        // Solid fraction of random packings of disks and spheres, slightly below random close
        // packing.
        let solid = if s.dimension() == 2 { 0.8 } else { 0.6 };
        let thickness = volume / solid / area;
        let inertial = speed / thickness * 2.0 * largest * (density / pressure).sqrt();
        line(
            "layer",
            format!("about {thickness:.2e} m thick at a solid fraction of {solid}"),
        );
        line(
            "inertial number",
            format!(
                "{inertial:.2e} with inertia scaled by {:e} (friction rises by about 1.1 times this, da Cruz 2005)",
                case.inertia_scaling
            ),
        );
    }
}
