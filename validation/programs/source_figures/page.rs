//! The page with figures and tables; its statements on agreement are computed.

use crate::charts::{QUANTITIES, WINDOW, curve, name};
use crate::process::{Step, Trace};
use crate::step::Fared;
use crate::{Run, Samples, Single};
use fretwork::solve::local::solver::Method;
use std::fmt::Write as _;

const HEAD: &str = "# The figures of Renouf's lecture, computed with Fretwork

M. Renouf's lecture on the non-smooth dynamics of divided media (2007; the method is that of Renouf and Alart, Comput.
Methods Appl. Mech. Eng. 194, 2005) compares conjugate projected gradients with Gauss-Seidel. This page has the same
figures from the cases and solvers of this program; [solvers](../solvers.md) describes the methods. The lecture gives
no sizes, tolerances or numbers, so that only its qualitative statements can be compared. This page, its numbers
and its conclusions are written by

```
cargo run --release --example source_figures
```

NLGS is plain Gauss-Seidel, without the over-relaxation that is the default of a run. Times are of one thread on a shared
machine.

";

/// The whole page.
pub fn page(singles: &[Single], quasi: &[Run], dynamic: &[Run], samples: &Samples) -> String {
    let mut out = HEAD.to_owned();
    one_step(&mut out, singles);
    out += "## Along a whole process\n\n";
    out += "The lecture shows the iterations of CPG along a quasi-static and a dynamic process, together with those of NLGS. Every\nstep starts from the impulses of the previous step; all methods have the same tolerance.\n\n";
    out += "A sweep of NLGS updates the velocities of the bodies in place. An iteration of a gradient method needs two products with W\nand an evaluation of the error, through the interface shared by all matrix methods. It therefore takes less time in total\nonly where its iterations are fewer by more than the ratio of the times of an iteration.\n\n";
    process(
        &mut out,
        "Quasi-static: [biaxial compression](../cases/biaxial.ron), 500 grains",
        "solver_quasistatic",
        "confining until 0.4 s, then compression; iterations (left) and time (right) of a step",
        quasi,
    );
    process(
        &mut out,
        "Dynamic: [collapse of a column](../cases/collapse.ron), 400 grains, steps of 0.5 ms",
        "solver_dynamic",
        "the grains fall, rest as a column, and collapse from 0.5 s on; below, kinetic energy and final surface",
        dynamic,
    );
    agreement(&mut out, samples);
    out
}

fn one_step(out: &mut String, singles: &[Single]) {
    *out += "## One step of a packing\n\n";
    *out += "The contact problem of one step in the middle of the compression of [the biaxial case](../cases/biaxial.ron) with 500\ngrains, one sample for each friction coefficient, solved from zero. The error is the one that runs use\n(`Balance`, [design](../design.md)).\n\n";
    *out += "![error against iterations](figures/solver_one_step.png)\n\n";
    *out += "Iterations to reach an error, at most 10,000; for NLGS and Anderson the error is evaluated at every tenth.\n\n";
    *out += "| μ | contacts | method | to 1e-2 | to 1e-4 | to 1e-6 | time of an iteration (µs) | over NLGS |\n|---|---|---|---|---|---|---|---|\n";
    let count = |n: Option<u32>| n.map_or("-".to_owned(), |n| n.to_string());
    for s in singles {
        let plain = s.fared.first().map_or(1.0, |f| f.each);
        for f in &s.fared {
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} | {:.0} | {:.1} |",
                s.mu,
                s.contacts,
                name(f.method),
                count(f.to(1e-2)),
                count(f.to(1e-4)),
                count(f.to(1e-6)),
                1e6 * f.each,
                f.each / plain,
            );
        }
    }
    *out += "\nA gradient method needs two products with W per iteration and evaluates the error each time; a sweep costs about one\nproduct, and the error is evaluated every ten sweeps.\n\n";
    *out += "Statements of the lecture compared with this run, in iterations to 1e-4:\n\n| the lecture |";
    for s in singles {
        let _ = write!(out, " μ = {} |", s.mu);
    }
    *out += "\n|---|";
    *out += &"---|".repeat(singles.len());
    *out += "\n";
    let claims = [
        ("CPG converges faster than NLGS", Method::Cpg, Method::Nlgs),
        (
            "CPG converges faster than the gradient without conjugation",
            Method::Cpg,
            Method::Pg,
        ),
        (
            "the diagonal preconditioner accelerates CPG",
            Method::Pcpg,
            Method::Cpg,
        ),
    ];
    for (claim, fast, slow) in claims {
        let _ = write!(out, "| {claim} |");
        for s in singles {
            let _ = write!(out, " {} |", verdict(&s.fared, fast, slow));
        }
        *out += "\n";
    }
    *out += "\n";
}

/// Whether one solver converges before another, and by how much.
fn verdict(fared: &[Fared], fast: Method, slow: Method) -> String {
    let to = |m: Method| {
        fared
            .iter()
            .find(|f| f.method == m)
            .and_then(|f| f.to(1e-4))
    };
    match (to(fast), to(slow)) {
        (Some(a), Some(b)) if a < b => format!("agrees, {:.1} times", f64::from(b) / f64::from(a)),
        (Some(a), Some(b)) => format!("differs, {:.1} times slower", f64::from(a) / f64::from(b)),
        (Some(_), None) => "agrees, the other does not converge".to_owned(),
        (None, Some(_)) => "differs, does not converge".to_owned(),
        (None, None) => "neither converges".to_owned(),
    }
}

fn process(out: &mut String, title: &str, figure: &str, caption: &str, runs: &[Run]) {
    let tolerance = runs.first().map_or(0.0, |r| r.trace.tolerance);
    let steps = runs.first().map_or(0, |r| r.trace.steps.len());
    let _ = writeln!(out, "### {title}\n\n![{caption}](figures/{figure}.png)\n");
    let _ = writeln!(
        out,
        "{steps} steps at a tolerance of {tolerance:e}: {caption}. Curves are means over {WINDOW} steps.\n"
    );
    *out += "| method | iterations per step | maximum | solver time (s) | time of an iteration (µs) | steps that missed the tolerance |\n|---|---|---|---|---|---|\n";
    for Run { label, trace } in runs {
        let most = trace.steps.iter().map(|s| s.iterations).max();
        let all = trace.iterations() * trace.steps.len() as f64;
        let _ = writeln!(
            out,
            "| {label} | {:.0} | {} | {:.1} | {:.0} | {} |",
            trace.iterations(),
            most.unwrap_or(0),
            trace.seconds(),
            1e6 * trace.seconds() / all.max(1.0),
            trace.missed(),
        );
    }
    let of = |label: &str| runs.iter().find(|r| r.label == label).map(|r| &r.trace);
    *out += "\n";
    for label in ["CPG", "PCPG"] {
        if let (Some(a), Some(b)) = (of("NLGS"), of(label)) {
            let _ = writeln!(
                out,
                "{label} takes {:.2} of NLGS's iterations and {:.2} of its time.",
                b.iterations() / a.iterations(),
                b.seconds() / a.seconds()
            );
        }
    }
    *out += "\n";
}

/// Mean of a curve over the last third of the compression.
fn last_third(trace: &Trace, value: fn(&Step) -> f64) -> f64 {
    let points = curve(trace, value);
    let end = points.last().map_or(0.0, |p| p.0);
    let late = points.iter().filter(|p| p.0 > 2.0 / 3.0 * end);
    moments(&late.map(|p| p.1).collect::<Vec<_>>()).0
}

/// Mean and standard deviation of values.
fn moments(x: &[f64]) -> (f64, f64) {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let square = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    (mean, square.sqrt())
}

fn agreement(out: &mut String, samples: &Samples) {
    /// Two-sided, for three samples each: four degrees of freedom.
    const STUDENT: f64 = 2.78;
    *out += "## Macroscopic agreement on the biaxial test\n\n";
    let _ = writeln!(
        out,
        "Rigid packings are hyperstatic: many force networks carry the same load, and small differences grow, so that\ntwo runs diverge at the scale of grains. The lecture therefore compares pressure, coordination number and solid fraction (compacity), as does\nthis figure, which adds the deviator, over {} samples (seeds) for each method, confined and compressed by it alone.\n",
        samples.nlgs.len()
    );
    *out += "![pressure, coordination, compacity and deviator against axial strain](figures/solver_biaxial.png)\n\n";
    let _ = writeln!(
        out,
        "Means over the last third of the compression (axial strain to {:.2}), and their standard deviation between samples.\nCPG agrees if the difference is within the 95 % interval of random differences: {STUDENT} standard errors (Student's t, {} samples\neach).\n",
        samples
            .nlgs
            .iter()
            .filter_map(|t| t.steps.last())
            .fold(0.0, |most, s| s.test.axial_strain.max(most)),
        samples.nlgs.len()
    );
    *out += "| | NLGS | CPG | difference | in standard errors | scatter of NLGS | scatter of CPG | agreement |\n|---|---|---|---|---|---|---|---|\n";
    for (name, unit, value) in QUANTITIES {
        let [(a, sa), (b, sb)] = [&samples.nlgs, &samples.cpg]
            .map(|t| moments(&t.iter().map(|t| last_third(t, value)).collect::<Vec<_>>()));
        let error = ((sa * sa + sb * sb) / samples.nlgs.len() as f64).sqrt();
        let (factor, unit) = if unit == "Pa" {
            (1e-3, " (kPa)")
        } else {
            (1.0, "")
        };
        let figure = |x: f64| format!("{:.4}", x * factor);
        let _ = writeln!(
            out,
            "| {name}{unit} | {} | {} | {} | {} | {} | {} | {} |",
            figure(a),
            figure(b),
            figure(b - a),
            format_args!("{:.1}", (b - a) / error),
            figure(sa),
            figure(sb),
            if (b - a).abs() <= STUDENT * error {
                "yes"
            } else {
                "**no**"
            },
        );
    }
    *out += "\nThe coordination number is that of grains that carry force; the solid fraction is that in two dimensions. So few samples detect large differences only:\n`yes` means that none was detected, not that there is none.\n";
}
