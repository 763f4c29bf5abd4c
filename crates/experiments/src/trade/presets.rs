//! Parameters that a trade varies by name: a preset derives its levels from the case's own value.
//!
//! The reference has the finest level that the budget allows for ordered parameters (step,
//! tolerance), the first level of a `--vary`, and the case's own value of the others: at equal
//! tolerance no solver is finer than another, and a correction is a choice, not a resolution.

use super::deformability::{Deformability, forms};
use super::listed::listed;
use super::ordered::{number, steps, tolerances};
use super::varied::{ParameterEffect, Varied};
use crate::Error;
use crate::factor::{AS_IN_THE_CASE, Level};
use fretwork_core::laws::Kind;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::step::Coupling;
use fretwork_scene::LoadedCase;
use fretwork_scene::case::{Case, GrainSpec};
use fretwork_scene::source::nearest;

/// Names and descriptions of the presets.
pub const PRESETS: &[(&str, &str)] = &[
    ("step", "time.step times 1/4 to 4"),
    ("tolerance", "solver.tolerance over two decades each way"),
    ("solver", "the solvers that support the case"),
    ("test_every", "iterations between convergence tests"),
    (
        "coupling",
        "damage coupling: explicit, midpoint or implicit",
    ),
    ("correction", "position correction, 0 to 0.2"),
    (
        "accuracy",
        "step and tolerance chosen by the run for 3 %, 1 %, 0.3 % and 0.1 %",
    ),
    ("grains", "half the grains of the first lattice or deposit"),
    (
        "deformability",
        "what deforms: nothing, contacts, first bodies, grains",
    ),
];

/// Whether a preset is varied by default. Not varied by default are the number of grains, which
/// changes the problem itself, the accuracy of a run that chooses its settings, and the
/// deformability, which is another model.
fn wanted_by_default(name: &str) -> bool {
    !matches!(name, "grains" | "accuracy" | "deformability")
}

/// Properties of the scene on which levels depend: its solvers, and its deformable bodies.
#[derive(Debug)]
pub struct Solving {
    /// Solvers that support the scene.
    pub methods: Vec<Method>,
    /// Tolerance of the scene.
    pub tolerance: f64,
    /// Properties from which its forms are made.
    pub deformability: Deformability,
}

/// Returns the parameters requested by name, or the default ones of the case, and those of
/// `--vary`.
///
/// # Errors
/// A name is unknown, a preset does not apply to the case, or the case rejects a key or value.
pub fn presets(
    loaded: &LoadedCase,
    solving: &Solving,
    names: &[String],
    vary: &[String],
) -> Result<Vec<Varied>, Error> {
    let mut parameters = Vec::new();
    for name in names {
        if name == "precision" {
            let text = "--setting precision: Fretwork computes and stores in f64 only, so precision cannot be varied";
            return Err(Error::Usage(text.into()));
        }
        if !PRESETS.iter().any(|p| p.0 == name) {
            return Err(unknown(name));
        }
        match preset(loaded, solving, name) {
            Ok(parameter) => parameters.push(parameter),
            Err(why) => return Err(Error::Usage(format!("--setting {name}: {why}"))),
        }
    }
    if names.is_empty() && vary.is_empty() {
        let usual = PRESETS.iter().filter(|p| wanted_by_default(p.0));
        parameters.extend(usual.filter_map(|p| preset(loaded, solving, p.0).ok()));
    }
    for argument in vary {
        parameters.push(listed(loaded, solving.tolerance, argument)?);
    }
    for (k, parameter) in parameters.iter().enumerate() {
        if parameters[..k]
            .iter()
            .any(|other| other.name == parameter.name)
        {
            let text = format!("`{}` is varied twice; name it once", parameter.name);
            return Err(Error::Usage(text));
        }
    }
    Ok(parameters)
}

fn unknown(name: &str) -> Error {
    let close = nearest(name, PRESETS.iter().map(|p| p.0));
    let help = close.map_or(String::new(), |c| format!("; did you mean `{c}`?"));
    let names: Vec<&str> = PRESETS.iter().map(|p| p.0).collect();
    Error::Usage(format!(
        "--setting {name}: there is no such setting{help} There are {}; `--vary key.path=a,b,c` varies any value of the case",
        names.join(", ")
    ))
}

/// Returns the levels of a preset, or the reason why it does not apply to the case.
fn preset(loaded: &LoadedCase, solving: &Solving, name: &str) -> Result<Varied, String> {
    let case = &loaded.case;
    let (levels, own) = match name {
        "step" => {
            let factors = [0.25, 0.5, 1.0, 2.0, 4.0];
            return Ok(steps(case, factors.map(|f| f * case.time.step).into()));
        }
        "tolerance" => {
            let own = solving.tolerance;
            let all = [-2, -1, 0, 1, 2].map(|k| own * 10f64.powi(k));
            // Iterations cannot reach a tolerance below rounding; at 0.1 the problem is hardly
            // solved.
            let useful = |t: &f64| (1e-13..=0.1).contains(t);
            let useful = all.into_iter().filter(useful).collect();
            return Ok(tolerances(case, own, useful));
        }
        "solver" => solver_levels(case, &solving.methods)?,
        "test_every" => test_every_levels(case)?,
        "coupling" => coupling_levels(case)?,
        "accuracy" => accuracy_levels(case),
        "deformability" => return forms(case, &solving.deformability),
        "correction" => {
            let own = case.solver.correction;
            let mut all = vec![0.0, 0.05, 0.2, own];
            all.sort_by(f64::total_cmp);
            all.dedup();
            let place = all.iter().position(|c| *c == own).unwrap_or(0);
            let level = |c: &f64| number("solver.correction", *c);
            (all.iter().map(level).collect(), place)
        }
        _ => {
            let (k, count) = counted(case).ok_or(
                "no lattice or deposit says how many grains there are; vary the size of the sample with --vary",
            )?;
            let key = format!("grains.{k}.count");
            let counts = [count, count.div_ceil(2)];
            (counts.map(|n| number(&key, n as f64)).into(), 0)
        }
    };
    Ok(Varied {
        reference: own,
        ..Varied::new(name, ParameterEffect::Choice, levels, Some(own))
    })
}

/// Levels without an order, and the index of the case's own.
type Choices = (Vec<Level>, usize);

fn solver_levels(case: &Case, methods: &[Method]) -> Result<Choices, String> {
    if methods.len() < 2 {
        return Err("only one solver supports this case".into());
    }
    let level = |m: &Method| Level::named(m.name(), vec![format!("solver.method={m:?}")]);
    let own = methods.iter().position(|m| *m == case.solver.method);
    Ok((methods.iter().map(level).collect(), own.unwrap_or(0)))
}

fn test_every_levels(case: &Case) -> Result<Choices, String> {
    if !sweeps(case.solver.method) {
        return Err(format!(
            "the solver of the case, {}, does not iterate in sweeps between tests",
            case.solver.method.name()
        ));
    }
    let own = case.solver.test_every.max(1);
    let mut all = vec![(own / 4).max(1), own, own.saturating_mul(4)];
    all.dedup();
    let place = all.iter().position(|n| *n == own).unwrap_or(0);
    let level = |n: &u32| number("solver.test_every", f64::from(*n));
    Ok((all.iter().map(level).collect(), place))
}

fn coupling_levels(case: &Case) -> Result<Choices, String> {
    let mut interfaces = case.interfaces.iter();
    if !interfaces.any(|i| i.law(Kind::DAMAGE).is_some()) {
        return Err("the case has no damage law, whose coupling could be varied".into());
    }
    let level = |label: &str, set: &str| Level::named(label, vec![set.to_owned()]);
    let implicit = "coupling=Implicit(tolerance: 1e-6, max_iterations: 50)";
    let levels = vec![
        level("explicit", "coupling=Explicit"),
        level("midpoint", "coupling=Midpoint"),
        level("implicit", implicit),
    ];
    let own = match case.coupling {
        Coupling::Explicit => 0,
        Coupling::Midpoint => 1,
        Coupling::Implicit { .. } => 2,
    };
    Ok((levels, own))
}

/// Returns the case with its step and tolerance, and with those that the run chooses for an
/// accuracy.
fn accuracy_levels(case: &Case) -> Choices {
    let level = |label: &str, set: String| Level::named(label, vec![set]);
    let mut levels = vec![level("fixed", "accuracy=None".into())];
    let shares = ["0.03", "0.01", "0.003", "0.001"];
    levels.extend(shares.map(|share| level(share, format!("accuracy={share}"))));
    // The case may request another result, within other bounds.
    let own = case.accuracy.as_ref().map_or(0, |_| levels.len());
    if case.accuracy.is_some() {
        levels.push(Level::named(AS_IN_THE_CASE, Vec::new()));
    }
    (levels, own)
}

/// Whether a solver iterates in sweeps, to which `test_every` applies.
fn sweeps(method: Method) -> bool {
    matches!(method, Method::Auto | Method::Nlgs | Method::Anderson)
}

/// Returns the first grains with a count, and that count.
fn counted(case: &Case) -> Option<(usize, usize)> {
    let count = |g: &GrainSpec| match g {
        GrainSpec::Lattice { count, .. } => Some(*count),
        GrainSpec::Deposit(spec) => Some(spec.count),
        _ => None,
    };
    let mut all = case.grains.iter().enumerate();
    all.find_map(|(k, g)| Some((k, count(g)?)))
}
