//! Conjugate gradients on a step of a packing during biaxial compression.

use crate::scene;
use fretwork::geometry::space::Dim2;
use fretwork::solve::local::LocalProblem;
use fretwork::solve::local::solver::{Limits, Method, solve};

/// Contact problems of steps in which 100 disks are compressed, by the seed of the sample.
fn steps(mu: &str, seed: u64) -> Vec<LocalProblem> {
    let mut sets: Vec<String> = [
        // The alert distance is the default, since the comparison of the methods depends on the
        // packing.
        "detection=()",
        "grains.0.count=100",
        "grains.0.high=[0.13,0.135]",
        "bodies.right.position=[0.13,0]",
        "bodies.top.position=[0,0.135]",
    ]
    .map(str::to_owned)
    .to_vec();
    sets.push(format!("interfaces.grains.parameters.contact.mu={mu}"));
    sets.push(format!("seed={seed}"));
    let loaded = scene::loaded("biaxial", &sets);
    let mut s = scene::simulation::<Dim2>(&loaded);
    let mut problems = Vec::new();
    for time in [0.44, 0.48, 0.52, 0.56] {
        while s.state.time < time {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        problems.push(s.local_problem().expect("Coulomb contacts alone"));
    }
    problems
}

/// If sliding contacts fell behind their thresholds, stick and slip alternated in every iteration,
/// and conjugate gradients were no faster than plain gradients. The median over several steps is
/// compared, since any of the methods may stagnate in a single step.
#[test]
fn conjugate_gradients_are_faster_than_sweeps() {
    for mu in ["0", "0.1", "0.4"] {
        are_faster(mu, &[11]);
    }
}

/// The largest friction, over several samples.
#[test]
#[ignore = "nightly: six samples; one is in conjugate_gradients_are_faster_than_sweeps"]
fn conjugate_gradients_are_faster_over_samples() {
    are_faster("0.4", &[11, 1, 2, 3, 4, 5]);
}

/// Conjugate gradients need at most half as many iterations as either of the other methods, in the
/// median of the problems.
fn are_faster(mu: &str, seeds: &[u64]) {
    let problems: Vec<LocalProblem> = seeds.iter().flat_map(|seed| steps(mu, *seed)).collect();
    let iterations = |method: Method| {
        let limits = Limits {
            tolerance: 1e-6,
            scale_free: None,
            max_iterations: 20_000,
            seconds: 60.0,
        };
        let solved = problems.iter().map(|p| solve(p, method, &limits));
        let each: Vec<u32> = solved.map(|outcome| outcome.iterations).collect();
        println!("mu {mu}, {}: {each:?}", method.name());
        each
    };
    let [nlgs, pg, cpg, pcpg] =
        [Method::Nlgs, Method::Pg, Method::Cpg, Method::Pcpg].map(iterations);
    for (of, over) in [(&cpg, &nlgs), (&cpg, &pg), (&pcpg, &nlgs)] {
        let ratios = of.iter().zip(over);
        let mut ratios: Vec<f64> = ratios.map(|(a, b)| f64::from(*a) / f64::from(*b)).collect();
        ratios.sort_by(f64::total_cmp);
        let middle = ratios.len() / 2;
        let median = 0.5 * (ratios[middle] + ratios[(ratios.len() - 1) / 2]);
        assert!(median < 0.5, "mu {mu}: {median} in {ratios:?}");
    }
}
