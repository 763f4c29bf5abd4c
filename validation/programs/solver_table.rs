//! Every solver on the fretting case at three tolerances, and on every shipped case.
//!
//! `cargo run --release --example solver_table` writes `docs/dev/fretting_solvers.md` from the rows
//! in `results/solver_table`, which it first fills: a run with an existing row is not repeated.
//! Parts: `PARTS=fretting,seeds,cases`, `METHODS=auto,newton`, `TOLERANCES=1e-4,1e-6`; `BUDGET`
//! (40) is the limit on the wall time of a fretting run (s), `SHORT` (4) that of other cases.
//! `PARTS=page` only writes the page.

use fretwork::geometry::space::{Dim2, Space};
use fretwork::in_dimension;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::solve::local::solver::Method;
use fretwork::step::Simulation;
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

const FRETTING: &str = "cases/wheel_rail_rigid.ron";
/// Step and tolerance of the table, with further changes of a run.
fn sets(more: String) -> [String; 3] {
    [
        "time.step=1e-4".into(),
        "solver.tolerance=1e-4".into(),
        more,
    ]
}
/// Steps of compaction and of the first slip, with bonds formed, solved by `auto` at a tolerance of
/// 1e-4 in every run.
const SETTLE: u64 = 520;
/// Seeds for the scatter.
const SEEDS: [u64; 3] = [7, 8, 9];

type Any = Box<dyn Error>;

/// Velocity and spin of a body.
type Motion<S> = (<S as Space>::Vector, <S as Space>::Spin);

fn main() -> Result<(), Any> {
    let list = |name: &str, default: &str| -> Vec<String> {
        let text = std::env::var(name).unwrap_or_else(|_| default.to_owned());
        text.split(',').map(|s| s.trim().to_owned()).collect()
    };
    let number = |name: &str, default: f64| -> Result<f64, Any> {
        Ok(std::env::var(name).map_or(Ok(default), |s| s.parse())?)
    };
    let names: Vec<&str> = Method::ALL.iter().map(|m| m.name()).collect();
    let parts = list("PARTS", "fretting,seeds,cases");
    let tolerances = list("TOLERANCES", "1e-4,1e-6,1e-8");
    let methods: Result<Vec<Method>, String> = list("METHODS", &names.join(","))
        .iter()
        .map(|m| m.parse())
        .collect();
    let (methods, budget, short) = (methods?, number("BUDGET", 40.0)?, number("SHORT", 4.0)?);
    let rows = PathBuf::from("results/solver_table");
    std::fs::create_dir_all(&rows)?;
    let has = |part: &str| parts.iter().any(|p| p == part);
    if has("fretting") {
        for tolerance in &tolerances {
            for method in methods.iter().copied() {
                let name = format!("fretting {tolerance} {}", method.name());
                keep(&rows, &name, || fretting(tolerance, method, 7, budget))?;
            }
        }
    }
    if has("seeds") {
        for seed in SEEDS {
            let name = format!("seed {seed}");
            keep(&rows, &name, || {
                fretting("1e-4", Method::Auto, seed, 2.0 * budget)
            })?;
        }
    }
    if has("cases") {
        for case in cases()? {
            for method in methods.iter().copied() {
                let name = format!(
                    "case {} {}",
                    case.display().to_string().replace('/', ":"),
                    method.name()
                );
                keep(&rows, &name, || shipped(&case, method, short))?;
            }
        }
    }
    let text = page(&rows, budget, short)?;
    std::fs::write("docs/dev/fretting_solvers.md", text)?;
    Ok(())
}

/// Runs only if there is no row yet.
fn keep(rows: &Path, name: &str, run: impl FnOnce() -> Result<String, Any>) -> Result<(), Any> {
    let path = rows.join(name);
    if !path.exists() {
        let row = run()?;
        eprintln!("{name}: {row}");
        std::fs::write(path, row)?;
    }
    Ok(())
}

fn cases() -> Result<Vec<PathBuf>, Any> {
    let mut all = Vec::new();
    for folder in ["cases", "cases/verification"] {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|e| e == "ron") {
                all.push(path);
            }
        }
    }
    all.sort();
    Ok(all)
}

/// Name of a solver in a case.
fn word(method: Method) -> String {
    format!("solver.method={method:?}")
}

/// Limit on the iterations per step of a shipped case; an iteration of Newton or the interior point
/// solver is a factorisation.
fn most(method: Method) -> u32 {
    match method {
        Method::Newton | Method::Interior => 200,
        _ => 20_000,
    }
}

/// Limit for the fretting case, whose first slips no solver brings to a tight tolerance.
fn most_in_fretting(method: Method, tolerance: &str) -> u32 {
    match method {
        Method::Newton | Method::Interior => 20,
        Method::Auto | Method::Nlgs | Method::Anderson if tolerance == "1e-4" => 20_000,
        _ => 2_000,
    }
}

/// Statistics of a run.
#[derive(Default)]
struct Tally {
    steps: u64,
    iterations: u64,
    missed: u64,
    /// Steps in which `auto` used Newton.
    newton: u64,
    worst: f64,
    seconds: f64,
    stopped: Option<String>,
}

/// Steps until a time limit or the end; `follow` is called before and after each step.
fn go<S: Space>(
    s: &mut Simulation<S>,
    steps: u64,
    budget: f64,
    mut follow: impl FnMut(&Simulation<S>, &[Motion<S>]),
) -> Tally {
    let mut tally = Tally::default();
    let clock = Instant::now();
    while tally.steps < steps && clock.elapsed().as_secs_f64() < budget {
        let bodies = s.state.bodies.driven.iter().map(|d| d.body as usize);
        let before: Vec<_> = bodies
            .map(|b| (s.state.bodies.velocity[b], s.state.bodies.spin[b]))
            .collect();
        match s.step() {
            Ok(report) => {
                tally.steps += 1;
                tally.iterations += u64::from(report.solver.iterations);
                tally.missed += u64::from(!report.solver.converged);
                tally.newton += u64::from(report.solver.used == Method::Newton);
                tally.worst = tally.worst.max(report.solver.error);
                follow(s, &before);
            }
            Err(e) => {
                tally.stopped = Some(e.to_string());
                break;
            }
        }
    }
    tally.seconds = clock.elapsed().as_secs_f64();
    tally
}

/// A row: seconds, steps, total steps, iterations per step, unconverged steps, largest error,
/// friction by cycle.
fn fretting(tolerance: &str, method: Method, seed: u64, budget: f64) -> Result<String, Any> {
    let loaded = load(Path::new(FRETTING), &sets(format!("seed={seed}")))?;
    let mut s = loaded.build_in::<Dim2>(&search_path())?;
    // Whether the laws rule the solver out.
    let asked = load(Path::new(FRETTING), &sets(word(method)))?;
    if let Err(e) = asked.build(&search_path()) {
        return Ok(format!("refused\t{e}"));
    }
    let total = (loaded.case.time.end / loaded.case.time.step).round() as u64;
    go(&mut s, SETTLE, f64::INFINITY, |_, _| {});
    (s.options.solver.method, s.options.solver.tolerance) = (method, tolerance.parse()?);
    s.options.solver.max_iterations = most_in_fretting(method, tolerance);
    let wheel = s.state.bodies.driven.iter().position(|d| d.name == "wheel");
    let wheel = wheel.ok_or("no wheel")?;
    let (start, period) = (0.05, 0.05);
    // Work and loaded path of each cycle.
    let mut cycles: BTreeMap<u32, (f64, f64, u32)> = BTreeMap::new();
    let tally = go(&mut s, total - SETTLE, budget, |s, before| {
        let at = s.state.time - start;
        if at <= 0.0 {
            return;
        }
        let theta = s.options.scheme.theta;
        let body = s.state.bodies.driven[wheel].body as usize;
        let speed = before[wheel].0.x * (1.0 - theta) + s.state.bodies.velocity[body].x * theta;
        let impulse = s.state.received[wheel].0;
        let cycle = cycles
            .entry((at / period - 1e-9).floor() as u32 + 1)
            .or_default();
        cycle.0 -= impulse.x * speed;
        cycle.1 += impulse.y * speed.abs();
        cycle.2 += 1;
    });
    let mut row = format!(
        "{:.1}\t{}\t{}\t{:.1}\t{}\t{:.1e}\t{}",
        tally.seconds,
        tally.steps,
        total - SETTLE,
        tally.iterations as f64 / tally.steps.max(1) as f64,
        tally.missed,
        tally.worst,
        tally.newton,
    );
    let whole = (period / s.options.scheme.h).round() as u32;
    let mu: Vec<String> = cycles
        .values()
        .map(|(work, path, steps)| {
            let part = if *steps < whole {
                format!(" ({:.2} of it)", f64::from(*steps) / f64::from(whole))
            } else {
                String::new()
            };
            format!("{:.4}{part}", work / path)
        })
        .collect();
    let _ = write!(
        row,
        "\t{}\t{}",
        mu.join(", "),
        tally.stopped.unwrap_or_default()
    );
    Ok(row)
}

/// A row: steps, total steps, converged steps, largest error; or the reason why there are none.
fn shipped(case: &Path, method: Method, budget: f64) -> Result<String, Any> {
    let loaded = load(
        case,
        &[
            word(method),
            format!("solver.max_iterations={}", most(method)),
        ],
    )?;
    let total = (loaded.case.time.end / loaded.case.time.step - 1e-6)
        .ceil()
        .max(1.0) as u64;
    let tally = match loaded.build(&search_path()) {
        Err(e) => return Ok(format!("refused\t{e}")),
        Ok(mut built) => in_dimension!(&mut built.simulation, |s| {
            go(s, total, budget, |_, _| {})
        }),
    };
    Ok(format!(
        "{}\t{total}\t{}\t{:.1e}\t{}",
        tally.steps,
        tally.steps - tally.missed,
        tally.worst,
        tally.stopped.unwrap_or_default()
    ))
}

fn read(rows: &Path, name: &str) -> Option<Vec<String>> {
    let text = std::fs::read_to_string(rows.join(name)).ok()?;
    Some(text.split('\t').map(str::to_owned).collect())
}

/// A fraction for a table, rounded such that 98 of 100 steps is not 100 %.
fn percent(part: f64, whole: f64) -> String {
    let x = (1000.0 * part / whole).floor() / 10.0;
    format!("{x} %")
}

fn page(rows: &Path, budget: f64, short: f64) -> Result<String, Any> {
    let mut out = format!(
        "# Every method in a run

Made by `cargo run --release --example solver_table`; for the methods see [solvers](../solvers.md).

## The fretting case

`{FRETTING}` with a step of 1e-4 s, one thread. The first {SETTLE} of 2,000 steps (compaction, formation of the bonds, the first slip) are
the same in every run, by `auto` at 1e-4; then the method and the tolerance of the row are used, and time is measured. A run has a limit of
wall time, by default {budget:.0} s, tested between steps; if it was exceeded, the row gives the completed fraction, and
from 1 % on the total time is extrapolated. The first steps of the slip are the hardest. A step may take 2,000 iterations (20 of `newton` and `interior`, which
factorise; 20,000 of `auto`, `nlgs` and `anderson` at 1e-4): steps that have not reached the tolerance by then are
counted, and the run continues. The machine was shared: times vary by a factor of two.

| tolerance | method | time of the run (s) | ms per step | iterations per step | not converged | friction by cycle |
|---|---|---|---|---|---|---|
"
    );
    for tolerance in ["1e-4", "1e-6", "1e-8"] {
        for method in Method::ALL {
            let name = method.name();
            let Some(row) = read(rows, &format!("fretting {tolerance} {name}")) else {
                continue;
            };
            if row[0] == "refused" {
                let _ = writeln!(
                    out,
                    "| {tolerance} | {name} | refused: {} | | | | |",
                    row[1]
                );
                continue;
            }
            let (seconds, steps, all): (f64, f64, f64) =
                (row[0].parse()?, row[1].parse()?, row[2].parse()?);
            let time = if !row[8].is_empty() {
                format!("stopped at step {steps}: {}", row[8])
            } else if steps < 0.01 * all {
                // The first steps of slip are the hardest, so they are not extrapolated.
                format!("{steps} steps done in {seconds:.0} s")
            } else if steps < all {
                format!(
                    "{:.0} (extrapolated; {} done in {seconds:.0} s)",
                    seconds / steps.max(1.0) * all,
                    percent(steps, all)
                )
            } else {
                format!("{seconds:.1}")
            };
            let newton: f64 = row[6].parse()?;
            let newton = if *method == Method::Auto && newton > 0.0 {
                format!(", newton ended {newton} steps")
            } else {
                String::new()
            };
            let _ = writeln!(
                out,
                "| {tolerance} | {name}{newton} | {time} | {:.1} | {} | {} of {steps}, error at most {} | {} |",
                1e3 * seconds / steps.max(1.0),
                row[3],
                row[4],
                row[5],
                row[7]
            );
        }
    }
    out += "
In the first steps of the slip no method reaches 1e-6 or 1e-8, not even with fifty times as many sweeps:
[why](solver_logs.md#the-first-slip-of-the-fretting-case). `nlgs-symmetric`, the gradients, `newton` and `interior` treat a
bond and its contact as two blocks of unknowns, while the sweeps over bodies solve both at once:
[cost of this](../solvers/hyperstatic.md#bonds-as-unknowns-of-their-own).
";
    out += "\nThe case is chaotic: another order of the same sums leads to other rearrangements. The resulting scatter, by `auto` at 1e-4 with other samples:\n\n| seed | friction by cycle | time (s) |\n|---|---|---|\n";
    for seed in SEEDS {
        if let Some(row) = read(rows, &format!("seed {seed}")) {
            let _ = writeln!(out, "| {seed} | {} | {} |", row[7], row[0]);
        }
    }
    let _ = write!(
        out,
        "
## Every shipped case

Each case is run to its end or for {short:.0} s, at its own tolerance. The table gives the percentage of steps that converged and, in brackets, the completed percentage
of the run if it is not complete. At most 20,000 iterations per step, 200 of `newton` and `interior`.

| case |"
    );
    for method in Method::ALL {
        let _ = write!(out, " {} |", method.name());
    }
    out += "\n|---|";
    out += &"---|".repeat(Method::ALL.len());
    let mut reasons: Vec<String> = Vec::new();
    for case in cases()? {
        let _ = write!(out, "\n| {} |", case.with_extension("").display());
        for method in Method::ALL {
            let place = case.display().to_string().replace('/', ":");
            let Some(row) = read(rows, &format!("case {place} {}", method.name())) else {
                out += " |";
                continue;
            };
            let cell = if row[0] == "refused" {
                note(&mut reasons, &row[1])
            } else {
                let (steps, all, fine): (f64, f64, f64) =
                    (row[0].parse()?, row[1].parse()?, row[2].parse()?);
                let part = if steps < all {
                    format!(" ({})", percent(steps, all))
                } else {
                    String::new()
                };
                let end = if row[4].is_empty() {
                    String::new()
                } else {
                    format!(", stopped {}", note(&mut reasons, &row[4]))
                };
                format!("{}{part}{end}", percent(fine, steps.max(1.0)))
            };
            let _ = write!(out, " {cell} |");
        }
    }
    out += "\n\n";
    for (k, reason) in reasons.iter().enumerate() {
        let _ = writeln!(out, "({}) {reason}\n", k + 1);
    }
    Ok(out.trim_end().to_owned() + "\n")
}

/// Number of a footnote; the name of the interface is not part of it.
fn note(reasons: &mut Vec<String>, text: &str) -> String {
    let text = text
        .split_once("`: ")
        .map_or(text, |t| t.1)
        .lines()
        .next()
        .unwrap_or_default();
    let at = reasons.iter().position(|r| r == text).unwrap_or_else(|| {
        reasons.push(text.to_owned());
        reasons.len() - 1
    });
    format!("({})", at + 1)
}
