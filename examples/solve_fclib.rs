//! Writes a contact problem in the format of the collection FCLIB, reads it, and solves it by two
//! methods.
//!
//! ```sh
//! cargo run --release --no-default-features --features results --example solve_fclib
//! ```

use fretwork::record::fclib::{self, Problem};
use fretwork::solve::local::solver::{Limits, Method, solve};
use fretwork::solve::local::{Csr, LocalProblem};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The problem is u = W p + q in (n, t1, t2): a point mass of 0.5 kg arrives at 2 m/s downwards
    // and 3 m/s along the plane, another of 2 kg at 1 m/s and 0.2 m/s.
    let inverse_mass = [2.0, 0.5];
    let diagonal = (0..6).map(|k: u32| (k, k, inverse_mass[k as usize / 3]));
    let diagonal: Vec<_> = diagonal.collect();
    let problem = LocalProblem {
        dimension: 3,
        w: Csr::from_triplets(6, 6, &diagonal),
        q: vec![-2.0, 3.0, 0.0, -1.0, 0.0, 0.2],
        mu: vec![0.4, 0.4],
    };
    problem.check()?;

    let path = std::env::temp_dir().join(format!("fretwork-{}.hdf5", std::process::id()));
    fclib::write_local(&path, &problem, "two masses", "an example")?;
    let read = fclib::read(&path)?;
    std::fs::remove_file(&path)?;
    let Problem::Local(local) = read else {
        return Err("a local problem was written".into());
    };
    // The file has blocks of contacts in full, with zeros.
    for row in 0..6 {
        let entries = local.problem.w.row(row).filter(|(_, value)| *value != 0.0);
        assert!(entries.eq(problem.w.row(row)), "row {row} of W");
    }
    assert_eq!(
        (&local.problem.q, &local.problem.mu),
        (&problem.q, &problem.mu)
    );

    // The first mass slides: p_n = m |q_n|, p_t = mu p_n against the motion, u_t = q_t - mu |q_n|.
    // The second sticks: p = -q/w.
    for method in [Method::Nlgs, Method::Newton] {
        let limits = Limits {
            tolerance: 1e-10,
            scale_free: None,
            max_iterations: 1000,
            seconds: 10.0,
        };
        let outcome = solve(&local.problem, method, &limits);
        println!("{}: error {:.1e}", method.name(), outcome.error);
        assert!(outcome.converged);
        let expected = [1.0, -0.4, 0.0, 2.0, 0.0, -0.4];
        for (p, expected) in outcome.p.iter().zip(expected) {
            assert!((p - expected).abs() < 1e-9, "{:?}", outcome.p);
        }
        assert!((outcome.u[1] - 2.2).abs() < 1e-9, "{:?}", outcome.u);
    }
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
