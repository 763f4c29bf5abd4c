//! Conjugate gradients on a step of a real packing: a biaxial compression in motion.

use fretwork::laws::SearchPath;
use fretwork::scene::{Scene, load};
use fretwork::solve::local::LocalProblem;
use fretwork::solve::local::solver::{Limits, Method, solve};
use std::path::Path;

/// The contact problem of a step in which 100 disks are compressed.
fn step(mu: &str) -> LocalProblem {
    let case = format!("{}/cases/biaxial.ron", env!("CARGO_MANIFEST_DIR"));
    let mut sets: Vec<String> = [
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
    let Scene::Plane(built) = scene.unwrap_or_else(|e| panic!("{e}")) else {
        panic!("the case is plane");
    };
    let mut s = built.simulation;
    while s.time < 0.5 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    s.local_problem().expect("Coulomb contacts alone")
}

/// Where sliding contacts fell behind their thresholds, stick and slip took turns in every iteration and the
/// conjugate gradients were no faster than plain ones.
#[test]
fn conjugate_gradients_are_faster_than_sweeps() {
    for mu in ["0", "0.1", "0.4"] {
        let problem = step(mu);
        let iterations = |method| {
            let limits = Limits {
                tolerance: 1e-6,
                max_iterations: 20_000,
                seconds: 60.0,
            };
            let outcome = solve(&problem, method, &limits);
            println!(
                "mu {mu}, {} contacts: {} {} {:.1e}",
                problem.mu.len(),
                method.name(),
                outcome.iterations,
                outcome.error
            );
            outcome.iterations
        };
        let [nlgs, pg, cpg, pcpg] =
            [Method::Nlgs, Method::Pg, Method::Cpg, Method::Pcpg].map(iterations);
        // How much faster hangs on the packing where friction is large.
        let least = if mu == "0.4" { 1 } else { 2 };
        assert!(
            least * cpg < nlgs && least * cpg < pg,
            "mu {mu}: {cpg} of {nlgs}"
        );
        assert!(least * pcpg < nlgs, "mu {mu}: {pcpg} of {nlgs}");
    }
}
