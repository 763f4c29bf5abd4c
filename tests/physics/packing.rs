//! Conjugate gradients on a step of a real packing: a biaxial compression in motion.

use fretwork::laws::SearchPath;
use fretwork::scene::{Scene, load};
use fretwork::solve::local::LocalProblem;
use fretwork::solve::local::solver::{Limits, Method, solve};
use std::path::Path;

/// The contact problems of steps in which 100 disks are compressed.
fn steps(mu: &str) -> Vec<LocalProblem> {
    let case = format!("{}/cases/biaxial.ron", env!("CARGO_MANIFEST_DIR"));
    let mut sets: Vec<String> = [
        // The alert distance by default: how the methods compare hangs on the packing.
        "detection=()",
        "grains.0.count=100",
        "grains.0.high=[0.13,0.135]",
        "bodies.right.position=[0.13,0]",
        "bodies.top.position=[0,0.135]",
    ]
    .map(str::to_owned)
    .to_vec();
    sets.push(format!("interfaces.grains.parameters.contact.mu={mu}"));
    let loaded = load(Path::new(&case), &sets).unwrap_or_else(|e| panic!("{e}"));
    let scene = loaded.build(&SearchPath::new(&[]));
    let Scene::Dim2(built) = scene.unwrap_or_else(|e| panic!("{e}")) else {
        panic!("the case is plane");
    };
    let mut s = built.simulation;
    let mut problems = Vec::new();
    for time in [0.44, 0.48, 0.52, 0.56] {
        while s.time < time {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        problems.push(s.local_problem().expect("Coulomb contacts alone"));
    }
    problems
}

/// Most iterations of a method.
const MAX_ITERATIONS: u32 = 20_000;

/// Where sliding contacts fell behind their thresholds, stick and slip alternated in every iteration and the
/// conjugate gradients were no faster than the plain ones. How much faster they are depends on the packing: the
/// preconditioned ones take less than half of the iterations of NLGS on every step that either solves, the others on half
/// of the steps at least.
#[test]
fn conjugate_gradients_are_faster_than_sweeps() {
    for mu in ["0", "0.1", "0.4"] {
        let problems = steps(mu);
        let iterations = |method: Method| {
            let limits = Limits {
                tolerance: 1e-6,
                scale_free: None,
                max_iterations: MAX_ITERATIONS,
                seconds: 60.0,
            };
            let solved = problems.iter().map(|p| solve(p, method, &limits));
            let each: Vec<u32> = solved.map(|outcome| outcome.iterations).collect();
            println!("mu {mu}, {}: {each:?}", method.name());
            each
        };
        let [nlgs, pg, cpg, pcpg] =
            [Method::Nlgs, Method::Pg, Method::Cpg, Method::Pcpg].map(iterations);
        for plain in [&nlgs, &pg] {
            let faster = cpg.iter().zip(plain).filter(|(c, p)| 2 * **c < **p);
            assert!(
                2 * faster.count() >= cpg.len(),
                "mu {mu}: {cpg:?} of {plain:?}"
            );
        }
        let mut both = pcpg.iter().zip(&nlgs);
        assert!(
            both.all(|(c, n)| 2 * c < *n || (*c == MAX_ITERATIONS && *n == MAX_ITERATIONS)),
            "mu {mu}: {pcpg:?} of {nlgs:?}"
        );
    }
}
