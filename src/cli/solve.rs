//! `fretwork solve`: solves contact problems in FCLIB files.

mod report;

use super::Failure;
use super::number::positive;
use crate::record::fclib::{self, Problem, Solution};
use crate::solve::local::solver::{self, Limits, Method, Outcome};
use crate::solve::local::{Elimination, LocalProblem, ReduceError, Reduction, scale_free};
use clap::Args;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Instant;

#[derive(Args, Debug)]
pub struct SolveArgs {
    /// Problem files in FCLIB's HDF5 layout, local or global
    #[arg(required = true, value_name = "PROBLEM.hdf5")]
    problems: Vec<PathBuf>,
    /// The solver, or `all` for a table of all of them
    #[arg(long, value_name = "S", default_value = "auto", value_parser = parse_solver, long_help = long_help())]
    solver: SolverChoice,
    /// Error to reach: |p - proj_K(p - (u + mu |u_t| n))| / max(|q|, |p|, |u|)
    #[arg(long, value_name = "T", default_value = "1e-8", value_parser = positive)]
    tolerance: f64,
    /// Also bound the scale-free error |r| / max(|u|, |q|) in velocities: iterate until both are
    /// met, and exit with 1 if it stays above T. Without this option it is reported, with a warning
    /// above 100 times the tolerance (at least 1e-3, at most 0.1)
    #[arg(long, value_name = "T", value_parser = positive)]
    scale_free_tolerance: Option<f64>,
    /// Largest number of iterations
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u32).range(1..))]
    max_iterations: u32,
    /// Time limit for each solve (s)
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = positive)]
    time_limit: f64,
    /// Write the problem with its solution to this file, also if a limit was reached
    #[arg(long, value_name = "SOLUTION.hdf5")]
    out: Option<PathBuf>,
    /// Print JSON: an object, or an array of objects for several files
    #[arg(long)]
    json: bool,
}

/// One solver, or all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SolverChoice {
    One(Method),
    All,
}

fn parse_solver(text: &str) -> Result<SolverChoice, String> {
    if text == "all" {
        return Ok(SolverChoice::All);
    }
    let method = Method::from_str(text).map_err(|e| format!("{e}; `all` compares them"))?;
    Ok(SolverChoice::One(method))
}

fn long_help() -> String {
    let mut out = String::from("The solver:\n");
    for method in Method::ALL {
        out += &format!("  {:<12} {}\n", method.name(), method.about());
    }
    out + "  all          all solvers in a table, converged ones first, then by time"
}

impl SolveArgs {
    /// Scale-free error above which a warning is printed.
    fn scale_free_limit(&self) -> f64 {
        self.scale_free_tolerance
            .unwrap_or_else(|| scale_free::usual_limit(self.tolerance))
    }
}

/// Results for one file.
struct Solved {
    path: PathBuf,
    problem: Problem,
    read_seconds: f64,
    reduce_seconds: f64,
    /// Results of the solvers, the best first.
    outcomes: Vec<Outcome>,
}

pub fn solve(args: &SolveArgs) -> Result<(), Failure> {
    if let Some(out) = &args.out {
        check_out(out, &args.problems)?;
    }
    let (mut wrong, mut unsolved, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for path in &args.problems {
        match solve_file(path, args) {
            Ok(solved) => {
                if !solved.outcomes[0].converged {
                    unsolved.push(report::unsolved(&solved, args));
                }
                if args.json {
                    all.push(report::json(&solved, args));
                } else {
                    super::output::answer(&report::text(&solved, args))?;
                }
            }
            // The remaining files are still solved; this one determines the exit code.
            Err(Failure::Usage(message)) => wrong.push(message),
            Err(other) => return Err(other),
        }
    }
    if args.json && !all.is_empty() {
        let value = match (args.problems.len(), all.pop()) {
            (1, Some(only)) => only,
            (_, last) => {
                all.extend(last);
                all.into()
            }
        };
        super::output::answer_json(&serde_json::to_string_pretty(&value).unwrap_or_default())?;
    }
    let joined = |lines: &[String]| lines.join("\nerror: ");
    if !wrong.is_empty() {
        wrong.extend(unsolved);
        return Err(Failure::Usage(joined(&wrong)));
    }
    if !unsolved.is_empty() {
        return Err(Failure::Failed(joined(&unsolved)));
    }
    Ok(())
}

/// Checks that the solution can be written before any time is spent.
fn check_out(out: &Path, problems: &[PathBuf]) -> Result<(), Failure> {
    let refuse = |reason: &str| Err(Failure::Usage(format!("--out {}: {reason}", out.display())));
    if problems.len() > 1 {
        return refuse("it holds the solution of one problem, and several are given");
    }
    let same =
        |p: &PathBuf| matches!((p.canonicalize(), out.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if problems.iter().any(same) {
        return refuse("this is the problem itself; choose another file");
    }
    if out.is_dir() || out.file_name().is_none() {
        return refuse("a file is expected, not a folder");
    }
    if let Ok(there) = std::fs::symlink_metadata(out) {
        if !there.is_file() {
            return refuse("this is not a plain file; give the name of one, or of a new one");
        }
        if there.permissions().readonly() {
            return refuse(
                "this file may not be written; choose another, or change its permissions",
            );
        }
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    if !folder.as_os_str().is_empty() && !folder.is_dir() {
        return refuse("there is no such folder");
    }
    Ok(())
}

/// A problem in local form, with the map back to its original form.
enum Form<'a> {
    AsGiven(&'a LocalProblem),
    Reduced(Reduction),
    Eliminated(Elimination),
}

impl<'a> Form<'a> {
    fn of(problem: &'a Problem) -> Result<Self, ReduceError> {
        match problem {
            Problem::Global(g) => Reduction::new(&g.problem).map(Self::Reduced),
            Problem::Local(l) => match &l.multipliers {
                Some(m) => Elimination::new(&l.problem, m).map(Self::Eliminated),
                None => Ok(Self::AsGiven(&l.problem)),
            },
        }
    }

    fn local(&self) -> &LocalProblem {
        match self {
            Self::Reduced(r) => &r.local,
            Self::Eliminated(e) => &e.local,
            Self::AsGiven(local) => local,
        }
    }

    fn solution(&self, problem: &Problem, outcome: &Outcome) -> Solution {
        let (v, l) = match (self, problem) {
            (Self::Reduced(form), Problem::Global(g)) => form.velocities(&g.problem, &outcome.p),
            (Self::Eliminated(form), Problem::Local(l)) => {
                let l = l
                    .multipliers
                    .as_ref()
                    .map(|m| form.multipliers(m, &outcome.p));
                (Vec::new(), l.unwrap_or_default())
            }
            _ => (Vec::new(), Vec::new()),
        };
        Solution {
            v,
            l,
            u: outcome.u.clone(),
            r: outcome.p.clone(),
        }
    }
}

fn solve_file(path: &Path, args: &SolveArgs) -> Result<Solved, Failure> {
    let start = Instant::now();
    let problem = fclib::read(path).map_err(|e| Failure::Usage(e.to_string()))?;
    let read_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let form =
        Form::of(&problem).map_err(|e| Failure::Usage(format!("{}: {e}", path.display())))?;
    let reduce_seconds = start.elapsed().as_secs_f64();
    let local = form.local();
    let limits = Limits {
        tolerance: args.tolerance,
        scale_free: args.scale_free_tolerance,
        max_iterations: args.max_iterations,
        seconds: args.time_limit,
    };
    let run = |method| solver::solve(local, method, &limits);
    let mut outcomes: Vec<Outcome> = match args.solver {
        SolverChoice::One(method) => vec![run(method)],
        SolverChoice::All => Method::ALL.iter().copied().map(run).collect(),
    };
    // Solvers that reached the tolerance come first, by time; the others follow by accuracy.
    outcomes.sort_by(|a, b| {
        let by = |o: &Outcome| if o.converged { o.seconds } else { o.error };
        (b.converged.cmp(&a.converged)).then(by(a).total_cmp(&by(b)))
    });
    if let Some(out) = &args.out {
        let solution = form.solution(&problem, &outcomes[0]);
        fclib::write_with_solution(out, &problem, &solution)
            .map_err(|e| Failure::Failed(e.to_string()))?;
    }
    drop(form);
    Ok(Solved {
        path: path.to_owned(),
        problem,
        read_seconds,
        reduce_seconds,
        outcomes,
    })
}
