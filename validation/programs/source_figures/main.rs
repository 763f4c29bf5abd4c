//! Figures of Renouf's lecture on projected gradients (2007; after Renouf and Alart, Comput.
//! Methods Appl. Mech. Eng. 194, 2005), from runs of Fretwork: error against iteration for one step
//! of a packing, iterations and time along a quasi-static and a dynamic process, and macroscopic
//! agreement in a biaxial test.
//!
//! `cargo run --release --example source_figures -- [OUT]`, from the root of the project, writes to
//! OUT (docs) `solver_figures.md` and `figures/solver_*.png`.

mod charts;
mod page;
mod process;
mod step;

use fretwork::record::fclib;
use fretwork::solve::local::solver::Method;
use process::Trace;
use std::error::Error;
use std::path::{Path, PathBuf};
use step::Fared;

const BIAXIAL: &str = "cases/biaxial.ron";
const COLLAPSE: &str = "cases/collapse.ron";
/// Twice the step of the case, with more iterations in a step: solvers are compared.
const COARSE: &str = "time.step=5e-4";

/// Smaller sample of the biaxial case; its walls are closer, so that 0.8 s give the same strain.
/// The alert distance is the default, with which the published figures were made.
const SMALLER: [&str; 6] = [
    "detection=()",
    "grains.0.count=500",
    "grains.0.high=[0.26,0.265]",
    "bodies.right.position=[0.26,0]",
    "bodies.top.position=[0,0.265]",
    "time.end=0.8",
];

/// One step, at one friction coefficient.
struct Single {
    mu: f64,
    contacts: usize,
    fared: Vec<Fared>,
}

/// A run and its label.
struct Run {
    label: &'static str,
    trace: Trace,
}

/// The biaxial test by NLGS and by CPG, the same samples in the same order.
struct Samples<'a> {
    nlgs: Vec<&'a Trace>,
    cpg: Vec<&'a Trace>,
}

impl<'a> Samples<'a> {
    fn new(first: &'a [Run], others: &'a [Run]) -> Self {
        let of = |label: &str| {
            let all = first.iter().chain(others);
            all.filter(|r| r.label == label).map(|r| &r.trace).collect()
        };
        Self {
            nlgs: of("NLGS"),
            cpg: of("CPG"),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "docs".into()));
    let figures = out.join("figures");
    std::fs::create_dir_all(&figures)?;

    let singles: Vec<Single> = [0.0, 0.1, 0.4]
        .into_iter()
        .map(single)
        .collect::<Result<_, _>>()?;
    charts::one_step(&singles, &figures.join("solver_one_step.png"))?;

    let ways = [
        ("NLGS", "Nlgs", "1"),
        ("CPG", "Cpg", "1"),
        ("PCPG", "Pcpg", "1"),
        ("auto", "Auto", "1.45"),
    ];
    let smaller: Vec<String> = SMALLER.map(str::to_owned).to_vec();
    let all = |case: &str, sets: &[String]| -> Result<Vec<Run>, Box<dyn Error>> {
        let run = |(label, method, relaxation): (&'static str, &str, &str)| {
            run(case, sets, label, method, relaxation)
        };
        ways.into_iter().map(run).collect()
    };
    let quasi = all(BIAXIAL, &smaller)?;
    charts::quasi_static(&quasi, &figures.join("solver_quasistatic.png"))?;
    let dynamic = all(COLLAPSE, &[COARSE.to_owned()])?;
    charts::dynamic(&dynamic, &figures.join("solver_dynamic.png"))?;

    // Samples of other seeds, by both solvers, since agreement is judged against the scatter of
    // samples.
    let mut others = Vec::new();
    for seed in ["seed=12", "seed=13"] {
        let sets = [smaller.clone(), vec![seed.into()]].concat();
        for (label, method, relaxation) in &ways[..2] {
            others.push(run(BIAXIAL, &sets, label, method, relaxation)?);
        }
    }
    let samples = Samples::new(&quasi, &others);
    charts::biaxial(&samples, &figures.join("solver_biaxial.png"))?;

    let text = page::page(&singles, &quasi, &dynamic, &samples);
    std::fs::write(out.join("solver_figures.md"), text)?;
    Ok(())
}

/// Takes the contact problem of one step of the compression, writes and reads it as a file, and
/// solves it.
fn single(mu: f64) -> Result<Single, Box<dyn Error>> {
    /// In the middle of the compression (s).
    const WHEN: f64 = 0.6;
    const MAX_SWEEPS: u32 = 10_000;
    let mut sets: Vec<String> = SMALLER.map(str::to_owned).to_vec();
    sets.push(format!("interfaces.grains.parameters.contact.mu={mu:?}"));
    let trace = process::run(Path::new(BIAXIAL), &sets, Some(WHEN))?;
    let problem = trace
        .last
        .ok_or("the step has another law than Coulomb's")?;
    let path = std::env::temp_dir().join(format!("fretwork-figures-{}.hdf5", std::process::id()));
    let local = fclib::Local {
        problem,
        ..Default::default()
    };
    fclib::write(&path, &fclib::Problem::Local(local))?;
    let read = fclib::read(&path)?;
    std::fs::remove_file(&path)?;
    let fclib::Problem::Local(local) = read else {
        return Err("the file written holds another problem".into());
    };
    let methods = [
        Method::Nlgs,
        Method::Pg,
        Method::Cpg,
        Method::Pcpg,
        Method::Anderson,
    ];
    let fared: Vec<Fared> = methods
        .iter()
        .map(|m| step::solve(&local.problem, *m, MAX_SWEEPS))
        .collect();
    eprintln!("one step at mu = {mu}: {} contacts", local.problem.mu.len());
    Ok(Single {
        mu,
        contacts: local.problem.mu.len(),
        fared,
    })
}

/// Runs a case to its end with a solver.
fn run(
    case: &str,
    sets: &[String],
    label: &'static str,
    method: &str,
    relaxation: &str,
) -> Result<Run, Box<dyn Error>> {
    let mut sets = sets.to_vec();
    sets.push(format!("solver.method={method}"));
    sets.push(format!("solver.relaxation={relaxation}"));
    let trace = process::run(Path::new(case), &sets, None)?;
    eprintln!(
        "{case} by {label}: {:.1} s in the solver, {:.0} iterations a step, {} steps not converged",
        trace.seconds(),
        trace.iterations(),
        trace.missed()
    );
    Ok(Run { label, trace })
}
