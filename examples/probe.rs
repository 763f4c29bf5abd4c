use fretwork::geometry::space::*;
use fretwork::laws::SearchPath;
use fretwork::scene::{Scene, load};
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let file = format!(
        "{}/cases/benchmarks/{}.ron",
        env!("CARGO_MANIFEST_DIR"),
        args[1]
    );
    let loaded = load(Path::new(&file), &args[3..]).unwrap_or_else(|e| panic!("{e}"));
    let steps: usize = args[2].parse().unwrap();
    match loaded
        .build(&SearchPath::new(&[]))
        .unwrap_or_else(|e| panic!("{e}"))
    {
        Scene::Plane(b) => go(b.simulation, steps),
        Scene::Solid(b) => go(b.simulation, steps),
    }
}
fn go<S: Space>(mut s: fretwork::step::Simulation<S>, steps: usize) {
    let weight: f64 = (0..s.bodies.len())
        .filter(|b| !s.bodies.immovable(*b))
        .map(|b| s.bodies.mass[b] * 9.81)
        .sum();
    for k in 0..steps {
        if k == 1 {
            if let Ok(m) = std::env::var("THEN") {
                s.solver.max_iterations = m.parse().unwrap();
            }
        }
        let r = s.step().unwrap();
        let mut f = 0.0;
        for (d, (p, _)) in s.bodies.driven.iter().zip(&s.received) {
            let _ = d;
            f -= p[S::D - 1] / s.scheme.h;
        }
        if k < 5 || k % 10 == 9 {
            println!(
                "step {k} it {} err {:.2e} carried {:.6} KE {:.3e} vmax {:.3e}",
                r.solver.iterations,
                r.solver.error,
                f / weight,
                s.energy.kinetic,
                s.bodies
                    .velocity
                    .iter()
                    .map(|v| v.norm())
                    .fold(0.0, f64::max)
            );
        }
    }
}
