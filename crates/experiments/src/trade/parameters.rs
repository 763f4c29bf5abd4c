//! Varied parameters of a study and their levels.
//!
//! A preset derives its levels from the case's own value; `--vary key=a,b,c` lists them. The reference has
//! the finest level that the budget allows for ordered parameters (step, tolerance), the first level of a
//! `--vary`, and the case's own value of the others: at equal tolerance no solver is finer than another, and
//! a correction is a choice, not a resolution.

use super::TradeError;
use super::rung::{Deformability, rungs};
use crate::load;
use fretwork_core::laws::Kind;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::step::coupling::Coupling;
use fretwork_scene::case::{Case, GrainSpec};
use fretwork_scene::source::nearest;
use fretwork_scene::{Loaded, unseen_fault};

/// A level of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Label for the report.
    pub label: String,
    /// The `--set` arguments for this level.
    pub sets: Vec<String>,
    /// Numeric value, if it has one.
    pub number: Option<f64>,
}

/// Effect of a parameter on cost and error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Time step: smaller is finer, and the cost is inversely proportional.
    Step,
    /// Tolerance: smaller is finer.
    Tolerance,
    /// Levels without an order.
    Choice,
    /// From `--vary`: the first level is that of the reference.
    Listed,
    /// Forms of the case, from the one that assumes least: the first is that of the reference, and costs are probed one by one.
    Form,
}

/// A varied parameter. Levels of a step or tolerance are ordered from the finest to the coarsest.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyParameter {
    /// Its name.
    pub name: String,
    /// Effect on cost and error.
    pub sense: Sense,
    /// Levels, at least one.
    pub levels: Vec<Level>,
    /// Index of the case's own level.
    pub own: usize,
    /// Index of the reference's level.
    pub reference: usize,
    /// Levels that are not offered, and why.
    pub left_out: Vec<(String, String)>,
}

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
        "rung",
        "what deforms: nothing, contacts, first bodies, grains",
    ),
];

/// Whether a preset is varied by default; the number of grains changes the problem itself, not only the accuracy, and a run that
/// chooses its settings is compared with them where that is asked for; another rung is another model.
fn wanted_by_default(name: &str) -> bool {
    !matches!(name, "grains" | "accuracy" | "rung")
}

/// What levels depend on beside the text of the case: how its scene is solved, and what may deform in it.
#[derive(Debug)]
pub struct Solving {
    /// The methods that serve it.
    pub methods: Vec<Method>,
    /// Its tolerance.
    pub tolerance: f64,
    /// What its forms are made from.
    pub deformability: Deformability,
}

/// The parameters requested by name, or the default ones of the case, and those of `--vary`.
///
/// # Errors
/// A name is unknown, a preset does not apply to the case, or the case rejects a key or value.
pub fn parameters(
    loaded: &Loaded,
    solving: &Solving,
    names: &[String],
    vary: &[String],
) -> Result<Vec<StudyParameter>, TradeError> {
    let mut parameters = Vec::new();
    for name in names {
        if name == "precision" {
            let text = "--knob precision: Fretwork computes and stores in f64 only, so precision cannot be varied";
            return Err(TradeError::Usage(text.into()));
        }
        if !PRESETS.iter().any(|p| p.0 == name) {
            return Err(unknown(name));
        }
        match preset(loaded, solving, name) {
            Ok(parameter) => parameters.push(parameter),
            Err(why) => return Err(TradeError::Usage(format!("--knob {name}: {why}"))),
        }
    }
    if names.is_empty() && vary.is_empty() {
        let usual = PRESETS.iter().filter(|p| wanted_by_default(p.0));
        parameters.extend(usual.filter_map(|p| preset(loaded, solving, p.0).ok()));
    }
    for argument in vary {
        parameters.push(listed(loaded, solving, argument)?);
    }
    for (k, parameter) in parameters.iter().enumerate() {
        if parameters[..k]
            .iter()
            .any(|other| other.name == parameter.name)
        {
            let text = format!("`{}` is varied twice; name it once", parameter.name);
            return Err(TradeError::Usage(text));
        }
    }
    Ok(parameters)
}

fn unknown(name: &str) -> TradeError {
    let close = nearest(name, PRESETS.iter().map(|p| p.0));
    let help = close.map_or(String::new(), |c| format!("; did you mean `{c}`?"));
    let names: Vec<&str> = PRESETS.iter().map(|p| p.0).collect();
    TradeError::Usage(format!(
        "--knob {name}: there is no such knob{help} There are {}; `--vary key.path=a,b,c` varies any value of the case",
        names.join(", ")
    ))
}

/// Formats a number so that RON can read it.
fn digits(x: f64) -> String {
    // Powers of two of a decimal number have rounding noise at the end, which 12 digits remove.
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    if rounded != 0.0 && !(1e-2..1e4).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

fn number(key: &str, x: f64) -> Level {
    let label = digits(x);
    Level {
        sets: vec![format!("{key}={label}")],
        label,
        number: Some(x),
    }
}

/// Levels of a preset, or the reason why it does not apply to the case.
fn preset(loaded: &Loaded, solving: &Solving, name: &str) -> Result<StudyParameter, String> {
    let case = &loaded.case;
    let (levels, own) = match name {
        "step" => {
            let factors = [0.25, 0.5, 1.0, 2.0, 4.0];
            return Ok(steps(case, factors.map(|f| f * case.time.step).into()));
        }
        "tolerance" => {
            let own = solving.tolerance;
            let all = [-2, -1, 0, 1, 2].map(|k| own * 10f64.powi(k));
            // Iterations cannot reach a tolerance below rounding; at 0.1 the problem is hardly solved.
            let useful = |t: &f64| (1e-13..=0.1).contains(t);
            let useful = all.into_iter().filter(useful).collect();
            return Ok(tolerances(case, own, useful));
        }
        "solver" => solver_levels(case, &solving.methods)?,
        "test_every" => test_every_levels(case)?,
        "coupling" => coupling_levels(case)?,
        "accuracy" => accuracy_levels(case),
        "rung" => return rungs(case, &solving.deformability),
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
    Ok(StudyParameter {
        name: name.to_owned(),
        sense: Sense::Choice,
        levels,
        own,
        reference: own,
        left_out: Vec::new(),
    })
}

/// Levels of a choice, and the index of the case's own.
type Choices = (Vec<Level>, usize);

fn solver_levels(case: &Case, methods: &[Method]) -> Result<Choices, String> {
    if methods.len() < 2 {
        return Err("only one solver supports this case".into());
    }
    let level = |m: &Method| Level {
        label: m.name().to_owned(),
        sets: vec![format!("solver.method={m:?}")],
        number: None,
    };
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
    let level = |label: &str, set: &str| Level {
        label: label.into(),
        sets: vec![set.into()],
        number: None,
    };
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

/// The case with step and tolerance as they are, and with those that the run chooses for an accuracy.
fn accuracy_levels(case: &Case) -> Choices {
    let level = |label: &str, set: String| Level {
        label: label.into(),
        sets: vec![set],
        number: None,
    };
    let mut levels = vec![level("fixed", "accuracy=None".into())];
    let shares = ["0.03", "0.01", "0.003", "0.001"];
    levels.extend(shares.map(|share| level(share, format!("accuracy={share}"))));
    // What the case asks for may be another result, within other bounds.
    let own = if case.accuracy.is_some() {
        levels.len()
    } else {
        0
    };
    if case.accuracy.is_some() {
        levels.push(Level {
            label: "as in the case".into(),
            sets: Vec::new(),
            number: None,
        });
    }
    (levels, own)
}

/// Whether a solver iterates in sweeps, to which `test_every` applies.
fn sweeps(method: Method) -> bool {
    matches!(method, Method::Auto | Method::Nlgs | Method::Anderson)
}

/// Positive values including the case's own, from the finest up, each with the arguments of its level.
fn ordered(
    name: &str,
    sense: Sense,
    own: f64,
    mut values: Vec<f64>,
    level: impl Fn(f64) -> Level,
) -> StudyParameter {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b.abs();
    values.retain(|v| !same(*v, own));
    values.push(own);
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| same(*a, *b));
    StudyParameter {
        name: name.to_owned(),
        sense,
        own: values.iter().position(|v| *v == own).unwrap_or(0),
        reference: 0,
        left_out: Vec::new(),
        levels: values.into_iter().map(level).collect(),
    }
}

fn steps(case: &Case, values: Vec<f64>) -> StudyParameter {
    let every = case.output.every as f64 * case.time.step;
    ordered("step", Sense::Step, case.time.step, values, |h| {
        let mut level = number("time.step", h);
        // Keeps the case's interval between statistics rows in time.
        let rows = (every / h).round().max(1.0);
        if rows != case.output.every as f64 {
            level.sets.push(format!("output.every={rows}"));
        }
        level
    })
}

fn tolerances(case: &Case, own: f64, values: Vec<f64>) -> StudyParameter {
    ordered("tolerance", Sense::Tolerance, own, values, |t| {
        let mut level = number("solver.tolerance", t);
        if t < own {
            // First-order methods need proportionally more iterations in the worst case.
            let most = f64::from(case.solver.max_iterations) * own / t;
            let most = most.min(f64::from(u32::MAX)).round();
            level.sets.push(format!("solver.max_iterations={most}"));
        }
        level
    })
}

/// The first grains with a count, and that count.
fn counted(case: &Case) -> Option<(usize, usize)> {
    let count = |g: &GrainSpec| match g {
        GrainSpec::Lattice { count, .. } => Some(*count),
        GrainSpec::Deposit(spec) => Some(spec.count),
        _ => None,
    };
    let mut all = case.grains.iter().enumerate();
    all.find_map(|(k, g)| Some((k, count(g)?)))
}

/// Parses `key.path=a,b,c`: commas within brackets or quotes belong to a value.
fn listed(
    loaded: &Loaded,
    solving: &Solving,
    argument: &str,
) -> Result<StudyParameter, TradeError> {
    let form = || {
        TradeError::Usage(format!(
            "--vary {argument}: expected key.path=a,b,c with two values or more, the finest first"
        ))
    };
    let (key, values) = argument.split_once('=').ok_or_else(form)?;
    const RECORDED: [&str; 5] = ["frames", "views", "figures", "every", "checkpoint"];
    let recorded = |k: &str| {
        k.strip_prefix("output.")
            .is_some_and(|f| RECORDED.contains(&f))
    };
    if key.trim() == "seed" || recorded(key.trim()) {
        return Err(TradeError::Usage(format!(
            "--vary {}: a study sets this itself, or it changes the output files and not the computation; for more seeds give --seeds",
            key.trim()
        )));
    }
    let values = split(values);
    if key.trim().is_empty() || values.len() < 2 || values.iter().any(String::is_empty) {
        return Err(form());
    }
    let level = |value: &String| Level {
        label: value.clone(),
        sets: vec![format!("{}={value}", key.trim())],
        number: value.parse().ok(),
    };
    let mut levels: Vec<Level> = values.iter().map(level).collect();
    let before = loaded.source.sets();
    // Compares the text of the case before and after: a value that does not change it is the case's own.
    let (mut own, mut texts) = (None, Vec::new());
    for (k, level) in levels.iter().enumerate() {
        let sets: Vec<String> = before.iter().chain(&level.sets).cloned().collect();
        let text = format!("{:?}", load(&loaded.path, &sets)?.case);
        if let Some(same) = texts.iter().position(|t| *t == text) {
            return Err(TradeError::Usage(format!(
                "--vary {argument}: {} and {} are the same case; give values that differ",
                levels[same].label, level.label
            )));
        }
        if text == format!("{:?}", loaded.case) {
            own = Some(k);
        }
        texts.push(text);
    }
    // The two parameters whose numeric values have an order.
    let numbers: Vec<f64> = levels.iter().filter_map(|l| l.number).collect();
    let positive = numbers.len() == levels.len() && numbers.iter().all(|x| *x > 0.0);
    if let Some(fault) = unseen_fault(key.trim()) {
        return Err(TradeError::Usage(format!("--vary {key:?}: {fault}")));
    }
    match key.trim() {
        "time.step" if positive => return Ok(steps(&loaded.case, numbers)),
        "solver.tolerance" if positive => {
            return Ok(tolerances(&loaded.case, solving.tolerance, numbers));
        }
        _ => {}
    }
    let own = own.unwrap_or_else(|| {
        levels.push(Level {
            label: "as in the case".into(),
            sets: Vec::new(),
            number: None,
        });
        levels.len() - 1
    });
    Ok(StudyParameter {
        name: key.trim().to_owned(),
        sense: Sense::Listed,
        levels,
        own,
        reference: 0,
        left_out: Vec::new(),
    })
}

fn split(text: &str) -> Vec<String> {
    let (mut parts, mut depth, mut quoted) = (vec![String::new()], 0i32, false);
    for c in text.chars() {
        quoted ^= c == '"';
        match c {
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = parts.last_mut() {
            last.push(c);
        }
    }
    parts.iter().map(|p| p.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_in_brackets_belong_to_a_value() {
        assert_eq!(
            split("Explicit, Implicit(tolerance: 1e-6, max_iterations: 9)"),
            ["Explicit", "Implicit(tolerance: 1e-6, max_iterations: 9)"]
        );
        assert_eq!(split("\"a,b\",[1,2],3"), ["\"a,b\"", "[1,2]", "3"]);
        assert_eq!(split(""), [""]);
    }

    #[test]
    fn numbers_read_well_and_back() {
        for x in [
            2e-8 / 4.0,
            1e-4 * 2.0,
            0.05,
            20.0,
            0.0,
            1e-4 * 10f64.powi(2),
        ] {
            let text = digits(x);
            assert!(text.len() < 9, "{text}");
            let back: f64 = text.parse().unwrap();
            assert!((back - x).abs() <= 1e-11 * x.abs());
        }
    }
}
