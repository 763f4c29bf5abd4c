//! Every method in a run is compared with a closed form if there is one, otherwise with plain
//! Gauss-Seidel.

use super::{G, Table, scene};
use crate::scene::loaded;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::shipped::search_path;
use fretwork::solve::local::solver::Method;
use fretwork::step::Simulation;

const ALL: [&str; 10] = [
    "Auto",
    "Nlgs",
    "NlgsSymmetric",
    "Anderson",
    "Pg",
    "Cpg",
    "Pcpg",
    "Apgd",
    "Newton",
    "Interior",
];

pub fn all(table: &mut Table) {
    column(table);
    dragged(table);
    thrown(table);
    // The bonds bend and twist, which requires compliance and moments.
    alike::<Dim3>(
        table,
        "beam_3d",
        &["time.end=0.2"],
        &["Auto", "Anderson", "Newton", "Apgd", "Cpg", "Interior"],
    );
    // Friction against rotation is bounded by another unknown.
    alike::<Dim3>(
        table,
        "rolling_stop_sphere",
        &["time.end=0.02"],
        &["Auto", "Anderson", "Apgd", "Pcpg"],
    );
    // Impacts: contacts with a gap rebound when they close, and carry nothing before.
    alike::<Dim2>(table, "cradle_touching", &[], &ALL);
    // The bonds act in tension only, with friction.
    alike::<Dim2>(
        table,
        "pulled_friction",
        &[],
        &["Auto", "Anderson", "Newton", "Apgd", "Interior"],
    );
    refused();
}

/// The floor of a column carries its weight with every method.
fn column(table: &mut Table) {
    for method in ALL {
        let set = format!("solver.method={method}");
        let mut s: Simulation<Dim2> = scene("column", &[&set]);
        for _ in 0..2 {
            let report = s.step().unwrap_or_else(|e| panic!("{method}: {e}"));
            assert!(report.solver.converged, "{method}: {:?}", report.solver);
        }
        let movable = (0..s.state.bodies.len()).filter(|b| !s.state.bodies.immovable(*b));
        let weight: f64 = movable.map(|b| s.state.bodies.mass[b] * G).sum();
        let carried = -s.state.received[0].0.y / s.options.scheme.h;
        let quantity = format!("weight on the floor by {method}");
        table.compare("column", &quantity, weight, carried, 1e-9);
    }
}

/// A block that is dragged at a given velocity and free to rise has a friction of mu times its
/// weight, although no impulse changes its slip.
fn dragged(table: &mut Table) {
    for method in ALL {
        let mut s: Simulation<Dim2> = scene(
            "slide_to_stop",
            &[
                &format!("solver.method={method}"),
                "bodies.block.dofs.x=Velocity(Constant(1.0))",
                "solver.tolerance=1e-9",
            ],
        );
        for _ in 0..20 {
            let report = s.step().unwrap_or_else(|e| panic!("{method}: {e}"));
            assert!(report.solver.converged, "{method}: {:?}", report.solver);
        }
        let floor = s.state.received[0].0 * (1.0 / s.options.scheme.h);
        let weight = s.state.bodies.mass[s.state.bodies.driven[1].body as usize] * G;
        let quantity = format!("weight of the block by {method}");
        table.compare("dragged", &quantity, weight, -floor.y, 1e-5);
        let quantity = format!("its friction by {method}");
        table.compare("dragged", &quantity, 0.3 * weight, floor.x, 1e-5);
    }
}

/// A ball thrown obliquely on a floor of very large friction does not sink in. It rolls immediately
/// at v_x/(1 + 1/k), k = 1/2 for a disk, and the floor receives its normal momentum. Before the
/// ball arrives the floor receives none.
fn thrown(table: &mut Table) {
    for mu in ["0.3", "1e4", "1e7"] {
        for method in ALL {
            let mut s: Simulation<Dim2> = scene(
                "bouncing_ball",
                &[
                    &format!("solver.method={method}"),
                    &format!("interfaces.grain.parameters.contact.mu={mu}"),
                    "interfaces.grain.parameters.contact.restitution_n=0.0",
                    "grains.0.grains.0.at=[0.0,0.10015]",
                    "grains.0.grains.0.velocity=[0.1,-1.0]",
                    "solver.norm=Balance",
                    "solver.tolerance=1e-6",
                    "gravity=[0,0]",
                ],
            );
            let ball = (0..s.state.bodies.len())
                .find(|b| !s.state.bodies.immovable(*b))
                .expect("there is a ball");
            let mut taken = 0.0;
            for _ in 0..4 {
                let report = s.step().unwrap_or_else(|e| panic!("{method}: {e}"));
                assert!(
                    report.solver.converged,
                    "mu {mu}, {method}: {:?}",
                    report.solver
                );
                taken -= s.state.received[0].0.y;
            }
            let m = s.state.bodies.mass[ball];
            let quantity = format!("normal impulse over m v, mu {mu}, {method}");
            // The remaining gap is closed within the step.
            table.compare("thrown", &quantity, 1.0, taken / m, 1e-3);
            let quantity = format!("velocity along the floor, mu {mu}, {method}");
            table.compare(
                "thrown",
                &quantity,
                0.1 / 1.5,
                s.state.bodies.velocity[ball].x,
                1e-3,
            );
        }
    }
}

/// Compares the displacements at the end of a case by plain Gauss-Seidel and by other methods.
fn alike<S: Space>(table: &mut Table, case: &str, sets: &[&str], methods: &[&str]) {
    let end = |method: &str| {
        let set = format!("solver.method={method}");
        let mut all = vec![set.as_str()];
        all.extend(sets);
        let loaded = loaded(&format!("verification/{case}"), &all);
        let steps = (loaded.case.time.end / loaded.case.time.step).round() as u64;
        let mut s: Simulation<S> = scene(case, &all);
        let start = s.state.bodies.position.clone();
        for _ in 0..steps {
            let report = s.step().unwrap_or_else(|e| panic!("{method}: {e}"));
            assert!(
                report.solver.converged,
                "{case}, {method}: {:?}",
                report.solver
            );
        }
        let moved = s.state.bodies.position.iter().zip(&start);
        moved.map(|(a, b)| *a - *b).collect::<Vec<S::Vector>>()
    };
    let norm = |v: &[S::Vector]| v.iter().map(|v| v.dot(v)).sum::<f64>().sqrt();
    let reference = end("Nlgs");
    for method in methods {
        let off: Vec<S::Vector> = end(method)
            .iter()
            .zip(&reference)
            .map(|(a, b)| *a - *b)
            .collect();
        let quantity = format!("displacements, {method} less Nlgs");
        table.compare(case, &quantity, 0.0, norm(&off) / norm(&reference), 1e-6);
    }
}

/// A problem that a method cannot solve is rejected with the reason: before the run if the laws
/// show it, otherwise at the first step that needs it.
fn refused() {
    for (case, method, word) in [
        ("rolling_stop_sphere", "Newton", "rotation"),
        ("rolling_stop_disk", "Interior", "rotation"),
    ] {
        let method = format!("solver.method={method}");
        let error = loaded(&format!("verification/{case}"), &[method])
            .build(&search_path())
            .expect_err("is refused")
            .to_string();
        assert!(error.contains(word), "{error}");
    }

    let mut s: Simulation<Dim3> = scene("rolling_stop_sphere", &[]);
    s.options.solver.method = Method::Newton;
    let error = s.step().expect_err("is refused").to_string();
    assert!(error.contains("rotation"), "{error}");
}
