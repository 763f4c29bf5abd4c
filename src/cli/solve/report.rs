//! Output of `fretwork solve`.

use super::{SolveArgs, Solved, SolverChoice};
use crate::record::fclib::Problem;
use crate::solve::local::scale_free;
use crate::solve::local::solver::Outcome;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Formula of the error, with p the contact impulses and u = W p + q.
const FORMULA: &str = "|p - proj_K(p - (u + mu |u_t| n))| / max(|q|, |p|, |u|)";

fn kind(problem: &Problem) -> &'static str {
    match problem {
        Problem::Global(g) if g.problem.equalities.is_some() => "global, with constraints",
        Problem::Global(_) => "global",
        Problem::Local(l) if l.multipliers.is_some() => "local, with multipliers",
        Problem::Local(_) => "local",
    }
}

/// Report on one file.
pub fn text(solved: &Solved, args: &SolveArgs) -> String {
    let (problem, best) = (&solved.problem, &solved.outcomes[0]);
    let mut out = format!("{}", solved.path.display());
    if let Some(title) = problem
        .info()
        .title
        .as_deref()
        .and_then(|t| t.lines().next())
    {
        let _ = write!(out, ": {title}");
    }
    out.push('\n');
    let mut line = |label: &str, value: String| {
        let _ = writeln!(out, "  {label:<12} {value}");
    };
    let contacts = problem.contacts();
    line(
        "problem",
        format!(
            "{}, dimension {}, {contacts} contacts",
            kind(problem),
            problem.dimension()
        ),
    );
    line("solver", best.method.clone());
    errors(best, args, &mut line);
    if let Some(worst) = best.worst {
        line("worst", format!("contact {worst} (counted from 0)"));
    }
    line("iterations", best.iterations.to_string());
    line(
        "time",
        format!("{} (the solve alone)", seconds(best.seconds)),
    );
    line("reading", seconds(solved.read_seconds));
    if kind(problem) != "local" {
        line(
            "reduction",
            format!("{} to the local form", seconds(solved.reduce_seconds)),
        );
    }
    if args.solver == SolverChoice::All {
        out += &table(&solved.outcomes);
    }
    if let Some(path) = &args.out {
        let _ = writeln!(out, "  solution in {}", path.display());
    }
    out.trim_end().to_owned()
}

/// Returns both errors with their definitions.
fn errors(best: &Outcome, args: &SolveArgs, line: &mut impl FnMut(&str, String)) {
    let verdict = if best.converged {
        "solved"
    } else {
        "NOT solved"
    };
    line(
        "error",
        format!("{:.3e} of {:.1e}: {verdict}", best.error, args.tolerance),
    );
    line("", format!("error = {FORMULA}"));
    if best.error <= args.tolerance && best.beside > args.tolerance {
        line(
            "",
            format!(
                "but {:.1e} in what the formula does not measure: contacts that friction alone keeps apart, or impulses that grow without bound; the problem may have no solution",
                best.beside
            ),
        );
    }
    let limit = args.scale_free_limit();
    let verdict = match (best.scale_free_error <= limit, args.scale_free_tolerance) {
        (true, _) => "met",
        (false, Some(_)) => "NOT met",
        (false, None) => "DOUBTFUL",
    };
    line(
        "scale-free",
        format!("{:.3e} of {limit:.1e}: {verdict}", best.scale_free_error),
    );
    line("", format!("error = {}", scale_free::FORMULA));
    if let Some(warning) = warning(best, args) {
        line("WARNING", warning);
    }
}

/// Returns a warning if the FCLIB error is below its limit and the scale-free error is not.
fn warning(o: &Outcome, args: &SolveArgs) -> Option<String> {
    let limit = args.scale_free_limit();
    let passes = o.error <= args.tolerance && o.beside <= args.tolerance;
    (passes && o.scale_free_error > limit).then(|| {
        format!(
            "the FCLIB error passes, the scale-free one does not: velocities have an error of {:.1e} of the largest of |u| and |q|, \
             above {limit:.1e}. The FCLIB error adds impulses to velocities, and in these units one hides the other; give \
             --scale-free-tolerance {limit:.0e} to meet both, or store W/s and s r in place of W and r, s a mean of W's diagonal",
            o.scale_free_error
        )
    })
}

fn table(outcomes: &[Outcome]) -> String {
    let width = outcomes
        .iter()
        .map(|o| o.method.chars().count())
        .fold(6, usize::max);
    let mut out = format!(
        "  {:<width$}  {:<6}  {:>9}  {:>10}  {:>10}  {:>10}\n",
        "solver", "solved", "error", "scale-free", "iterations", "time"
    );
    for o in outcomes {
        let solved = if o.converged { "yes" } else { "no" };
        let _ = writeln!(
            out,
            "  {:<width$}  {solved:<6}  {:>9.2e}  {:>10.2e}  {:>10}  {:>10}",
            o.method,
            o.error,
            o.scale_free_error,
            o.iterations,
            seconds(o.seconds)
        );
    }
    out
}

fn seconds(s: f64) -> String {
    format!("{s:.3e} s")
}

/// JSON object for one file.
pub fn json(solved: &Solved, args: &SolveArgs) -> Value {
    let problem = &solved.problem;
    let mut value = outcome(&solved.outcomes[0], args);
    let more = json!({
        "problem": solved.path.display().to_string(),
        "title": problem.info().title,
        "kind": kind(problem),
        "dimension": problem.dimension(),
        "contacts": problem.contacts(),
        "tolerance": args.tolerance,
        "error_formula": FORMULA,
        "scale_free_tolerance": args.scale_free_limit(),
        "scale_free_asked": args.scale_free_tolerance.is_some(),
        "scale_free_formula": scale_free::FORMULA,
        "read_seconds": solved.read_seconds,
        "reduce_seconds": solved.reduce_seconds,
        "out": args.out.as_ref().map(|p| p.display().to_string()),
        "version": env!("CARGO_PKG_VERSION"),
    });
    if let (Value::Object(into), Value::Object(more)) = (&mut value, more) {
        into.extend(more);
        if args.solver == SolverChoice::All {
            let all = solved.outcomes.iter().map(|o| outcome(o, args)).collect();
            into.insert("solvers".to_owned(), Value::Array(all));
        }
    }
    value
}

fn outcome(o: &Outcome, args: &SolveArgs) -> Value {
    json!({
        "solver": o.method,
        "solved": o.converged,
        "error": o.error,
        "error_beside": o.beside,
        "scale_free_error": o.scale_free_error,
        "scale_free_met": o.scale_free_error <= args.scale_free_limit(),
        "warning": warning(o, args),
        "worst": o.worst,
        "iterations": o.iterations,
        "seconds": o.seconds,
    })
}

/// Reason why a file is not solved.
pub fn unsolved(solved: &Solved, args: &SolveArgs) -> String {
    let best = &solved.outcomes[0];
    if best.error <= args.tolerance && best.beside > args.tolerance {
        return format!(
            "{}: the error is {:.3e}, but {:.1e} in what the formula does not measure: the problem may have no solution",
            solved.path.display(),
            best.error,
            best.beside
        );
    }
    if let Some(asked) = args.scale_free_tolerance
        && best.error <= args.tolerance
    {
        return format!(
            "{}: the FCLIB error is {:.3e}, but the scale-free one is {:.3e}, above --scale-free-tolerance {asked:e}, after {} \
             iterations and {}; raise --max-iterations or --time-limit, or try --solver all",
            solved.path.display(),
            best.error,
            best.scale_free_error,
            best.iterations,
            seconds(best.seconds)
        );
    }
    format!(
        "{}: not solved to {:e} in {} iterations and {}: the error is {:.3e}; raise --max-iterations \
         or --time-limit, or try --solver all",
        solved.path.display(),
        args.tolerance,
        best.iterations,
        seconds(best.seconds),
        best.error
    )
}
