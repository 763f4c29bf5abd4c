//! League table of a folder of FCLIB problems: every solver of Fretwork against the best solver of
//! another program.
//!
//! `cargo run --release --example league -- FOLDER BASELINE.csv [OUT]` solves every problem of
//! FOLDER with `auto` at 1e-4, 1e-8 and 1e-12, at most 60 s each (`LIMIT` seconds if set), and with
//! every other solver at 1e-8, at most 2 s, evaluates the error of every solution again from a
//! written file, and writes `fclib_table.md` and `figures/solvers_profile.png` to OUT (docs).
//! `ONLY=auto` omits the other solvers and the picture. BASELINE.csv holds the other program's
//! times: problem, nc, solver, tol, solved, time_s.

use fretwork::record::fclib::{self, Problem, Solution};
use fretwork::solve::local::solver::{self, Limits, Method, Outcome};
use fretwork::solve::local::{Elimination, LocalProblem, Reduction, scale_free};
use fretwork::view::{Axis, Chart, Series, draw_panels};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Times by (problem, tolerance), for each solver; `None` if not solved.
type Times = BTreeMap<(String, String), Timings>;

/// A solver's name and its time.
type Timings = Vec<(String, Option<f64>)>;

const TOLERANCES: [&str; 3] = ["1e-4", "1e-8", "1e-12"];

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [folder, baseline] = [args.first(), args.get(1)].map(|a| a.cloned());
    let (Some(folder), Some(baseline)) = (folder, baseline) else {
        return Err("give the folder of problems and the peer's table".into());
    };
    let out = PathBuf::from(args.get(2).map_or("docs", String::as_str));
    let limit: f64 = std::env::var("LIMIT")
        .ok()
        .map_or(Ok(60.0), |s| s.parse())?;
    let only = std::env::var("ONLY").ok();
    let peer = read_baseline(Path::new(&baseline))?;
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)?
        .map(|e| e.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    files.retain(|f| f.extension().is_some_and(|e| e == "hdf5"));
    files.sort();
    let mut rows = String::new();
    let mut ours: Times = Times::new();
    let mut solved = BTreeMap::<&str, u32>::new();
    let (mut false_success, mut count) = (0, 0);
    let mut doubtful = BTreeMap::<&str, u32>::new();
    for file in &files {
        let name = file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let problem = fclib::read(file)?;
        let clock = Instant::now();
        let local = reduce(&problem)?;
        let reduction = clock.elapsed().as_secs_f64();
        let global = matches!(problem, Problem::Global(_));
        count += 1;
        for tolerance in TOLERANCES {
            let key = (name.clone(), tolerance.to_owned());
            let limits = Limits {
                tolerance: tolerance.parse()?,
                scale_free: None,
                max_iterations: u32::MAX,
                seconds: limit,
            };
            for method in Method::ALL {
                let others = *method != Method::Auto;
                if others && (global || tolerance != "1e-8" || only.as_deref() == Some("auto")) {
                    continue;
                }
                let limits = Limits {
                    seconds: if others { limit.min(2.0) } else { limit },
                    ..limits
                };
                let outcome = solver::solve(&local, *method, &limits);
                let again = judge_again(&local, &outcome)?;
                if outcome.converged && again > limits.tolerance {
                    false_success += 1;
                    eprintln!(
                        "{name} {tolerance} {}: says {:e}, is {again:e}",
                        outcome.method, outcome.error
                    );
                }
                // The time of a global problem includes its reduction, as the other program's does.
                let seconds = outcome.seconds + if global { reduction } else { 0.0 };
                let time = outcome.converged.then_some(seconds);
                if *method == Method::Auto {
                    let limit = scale_free::usual_limit(limits.tolerance);
                    *doubtful.entry(tolerance).or_default() +=
                        u32::from(outcome.converged && outcome.scale_free_error > limit);
                    *solved.entry(tolerance).or_default() += u32::from(outcome.converged);
                    rows += &row(
                        &name,
                        local.mu.len(),
                        tolerance,
                        seconds,
                        &outcome,
                        peer.get(&key),
                    );
                    eprint!("{}", rows.lines().last().unwrap_or_default());
                    eprintln!();
                }
                ours.entry(key.clone())
                    .or_default()
                    .push((method.name().to_owned(), time));
            }
        }
    }
    let counts = Counts {
        solved,
        doubtful,
        problems: count,
        false_success,
    };
    let text = page(&rows, &ours, &peer, &counts, limit);
    std::fs::create_dir_all(out.join("figures"))?;
    std::fs::write(out.join("fclib_table.md"), &text)?;
    println!("{}", text.split("\n| problem").next().unwrap_or_default());
    if only.is_none() {
        profile(&ours, &peer, &out.join("figures/solvers_profile.png"))?;
    }
    Ok(())
}

fn read_baseline(path: &Path) -> Result<Times, Box<dyn Error>> {
    let mut times = Times::new();
    let mut reader = csv::Reader::from_path(path)?;
    let heads = reader.headers()?.clone();
    let at = |name: &str| {
        heads
            .iter()
            .position(|h| h == name)
            .ok_or_else(|| format!("{}: no column {name}", path.display()))
    };
    let (p, s, t, ok, sec) = (
        at("problem")?,
        at("solver")?,
        at("tol")?,
        at("solved")?,
        at("time_s")?,
    );
    for record in reader.records() {
        let r = record?;
        let tolerance: f64 = r[t].parse()?;
        let name = TOLERANCES.iter().find(|x| x.parse() == Ok(tolerance));
        if let Some(name) = name {
            let time = if &r[ok] == "1" {
                r[sec].parse().ok()
            } else {
                None
            };
            times
                .entry((r[p].to_owned(), (*name).to_owned()))
                .or_default()
                .push((r[s].to_owned(), time));
        }
    }
    Ok(times)
}

fn reduce(problem: &Problem) -> Result<LocalProblem, Box<dyn Error>> {
    Ok(match problem {
        Problem::Local(local) => match &local.multipliers {
            None => local.problem.clone(),
            Some(multipliers) => Elimination::new(&local.problem, multipliers)?.local,
        },
        Problem::Global(global) => Reduction::new(&global.problem)?.local,
    })
}

/// Error of the solution as stored in a file.
fn judge_again(local: &LocalProblem, outcome: &Outcome) -> Result<f64, Box<dyn Error>> {
    let path = std::env::temp_dir().join(format!("fretwork-league-{}.hdf5", std::process::id()));
    let solution = Solution {
        r: outcome.p.clone(),
        u: outcome.u.clone(),
        v: Vec::new(),
        l: Vec::new(),
    };
    let written = Problem::Local(fclib::Local {
        problem: local.clone(),
        ..Default::default()
    });
    fclib::write_with_solution(&path, &written, &solution)?;
    let read = fclib::read_solution(&path)?.ok_or("no solution in the file written")?;
    std::fs::remove_file(&path)?;
    Ok(solver::field_error(local, &read.r))
}

fn best(times: Option<&Vec<(String, Option<f64>)>>) -> Option<(String, f64)> {
    times?
        .iter()
        .filter_map(|(s, t)| t.map(|t| (s.clone(), t)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

fn row(
    name: &str,
    nc: usize,
    tolerance: &str,
    seconds: f64,
    outcome: &Outcome,
    peer: Option<&Vec<(String, Option<f64>)>>,
) -> String {
    let theirs = best(peer);
    let ratio = theirs
        .as_ref()
        .filter(|_| outcome.converged)
        .map_or("-".to_owned(), |t| format!("{:.2}", seconds / t.1));
    let theirs = match (theirs, peer) {
        (Some((s, t)), _) => format!("{t:.2e} ({s})"),
        (None, Some(_)) => "none".to_owned(),
        (None, None) => "not run".to_owned(),
    };
    format!(
        "| {name} | {nc} | {tolerance} | {} | {:.1e} | {:.1e} | {} | {:.2e} | {theirs} | {ratio} |\n",
        if outcome.converged { "yes" } else { "**no**" },
        outcome.error,
        outcome.scale_free_error,
        outcome.method.trim_start_matches("auto: "),
        seconds,
    )
}

/// Results of `auto` by tolerance.
struct Counts<'a> {
    solved: BTreeMap<&'a str, u32>,
    /// Solved, but with a scale-free error above its default limit.
    doubtful: BTreeMap<&'a str, u32>,
    problems: u32,
    false_success: u32,
}

fn page(rows: &str, ours: &Times, peer: &Times, counts: &Counts<'_>, limit: f64) -> String {
    let mut out = String::from(
        "# The league table\n\nMade by `cargo run --release --example league -- FOLDER BASELINE.csv`; see [solvers](../solvers.md) for the methods.\n\n",
    );
    let _ = writeln!(
        out,
        "At most {limit} s per solve. Solved by `auto` of {} problems: {}.",
        counts.problems,
        TOLERANCES
            .map(|t| format!("{} at {t}", counts.solved.get(t).unwrap_or(&0)))
            .join(", ")
    );
    let _ = writeln!(
        out,
        "Of those, with a scale-free error above its limit: {}.",
        TOLERANCES
            .map(|t| {
                let limit = t.parse().map_or(f64::NAN, scale_free::usual_limit);
                let doubtful = counts.doubtful.get(t).unwrap_or(&0);
                format!("{doubtful} at {t} (limit {limit:.0e})")
            })
            .join(", ")
    );
    let _ = writeln!(
        out,
        "Solutions reported as converged whose error is above the tolerance when read back: {}.\n",
        counts.false_success
    );
    for tolerance in ["1e-4", "1e-8"] {
        let (mut faster, mut of, mut worst) = (0, 0, 0.0f64);
        for ((name, t), times) in ours.iter().filter(|((_, t), _)| t == tolerance) {
            let nc_large = rows.lines().any(|l| {
                let cells: Vec<&str> = l.split('|').map(str::trim).collect();
                cells[1] == name && cells[2].parse::<usize>().is_ok_and(|n| n >= 20)
            });
            let Some(theirs) = peer.get(&(name.clone(), t.clone())) else {
                continue;
            };
            if !nc_large {
                continue;
            }
            of += 1;
            let auto = times
                .iter()
                .find(|(s, _)| s == "auto")
                .and_then(|(_, t)| *t);
            match (auto, best(Some(theirs))) {
                (Some(a), Some((_, b))) => {
                    faster += u32::from(a < b);
                    worst = worst.max(a / b);
                }
                (Some(_), None) => faster += 1,
                (None, _) => worst = f64::INFINITY,
            }
        }
        let _ = writeln!(
            out,
            "At {tolerance}, of {of} problems of 20 contacts or more: `auto` is faster than the best reference solver on {faster}; at worst it takes {worst:.2} times as long.\n"
        );
    }
    out += "| problem | contacts | tolerance | solved | error | scale-free error | chosen | time (s) | best reference (s) | ratio |\n|---|---|---|---|---|---|---|---|---|---|\n";
    out + rows
}

/// The fastest of the other program's solvers on each problem.
const BEST: &str = "peer best";

/// Performance profile (Dolan and More): fraction of problems solved within a factor of the best of
/// all solvers.
fn profile(ours: &Times, peer: &Times, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut all: BTreeMap<&(String, String), Timings> = BTreeMap::new();
    for (key, times) in ours.iter().filter(|((_, t), _)| t == "1e-8") {
        if let Some(theirs) = peer.get(key).filter(|_| times.len() > 1) {
            let mut list = times.clone();
            list.extend(theirs.iter().map(|(s, t)| (format!("peer {s}"), *t)));
            list.push((BEST.to_owned(), best(Some(theirs)).map(|(_, t)| t)));
            all.insert(key, list);
        }
    }
    // The solvers of each program that solve most; more curves would not be distinguishable.
    let mut wins = BTreeMap::<String, u32>::new();
    for (s, t) in all.values().flatten() {
        *wins.entry(s.clone()).or_default() += u32::from(t.is_some());
    }
    let mut wins: Vec<(String, u32)> = wins.into_iter().collect();
    wins.sort_by_key(|t| std::cmp::Reverse(t.1));
    let (theirs, own): (Vec<_>, Vec<_>) = wins.into_iter().partition(|t| t.0.starts_with("peer"));
    let names = own.into_iter().take(4).chain(theirs.into_iter().take(3));
    let names = names.map(|t| t.0);
    let mut chart = Chart::new(
        "Share of problems solved within a factor of the fastest",
        Axis::new("time over that of the fastest solver", "").log(),
        Axis::new("share of problems", ""),
    );
    chart.subtitle = Some(format!(
        "{} problems at 1e-8, Siconos 4.4 dashed (best: the fastest of all its solvers on each problem)",
        all.len()
    ));
    for name in names {
        let mut ratios: Vec<f64> = all
            .values()
            .filter_map(|list| {
                let least = list
                    .iter()
                    .filter_map(|(_, t)| *t)
                    .fold(f64::INFINITY, f64::min);
                list.iter()
                    .find(|(s, _)| *s == name)
                    .and_then(|(_, t)| *t)
                    .map(|t| t / least)
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        let n = all.len() as f64;
        let mut points = vec![(1.0, 0.0)];
        let mut share = 0.0;
        for r in ratios.iter().filter(|r| **r <= 1e4) {
            points.push((*r, share));
            share += 1.0 / n;
            points.push((*r, share));
        }
        points.push((1e4, share));
        let series = Series::new(name.clone(), points);
        chart = chart.with(if name.starts_with("peer") {
            series.style(fretwork::view::Style::Dashed)
        } else {
            series
        });
    }
    chart.y_range = Some((0.0, 1.02));
    draw_panels(&[chart], 1, path)?;
    Ok(())
}
