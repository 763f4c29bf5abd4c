//! Runs `cases/verification/` and compares with closed forms.
//!
//! `cargo test --release --test physics verification -- --nocapture` prints the table: case,
//! quantity, expected, obtained, tolerance. Every expected value is a formula written here.

mod bonds;
mod deformable;
mod drives;
mod dynamics;
mod energy;
mod laws;
mod sinks;
mod solvers;
mod stages;
mod thermal;

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

/// Acceleration of gravity in the cases (m/s^2).
const G: f64 = 9.81;

/// The table.
#[derive(Default)]
struct Table {
    failed: Vec<String>,
}

impl Table {
    /// Compares with a relative tolerance, or with an absolute one if zero is expected.
    fn compare(
        &mut self,
        case: &str,
        quantity: &str,
        expected: f64,
        obtained: f64,
        tolerance: f64,
    ) {
        let scale = if expected == 0.0 { 1.0 } else { expected.abs() };
        let fine = (obtained - expected).abs() <= tolerance * scale;
        let line = format!(
            "{case:<24} {quantity:<40} {expected:>15.8e} {obtained:>15.8e} {tolerance:>8.0e} {}",
            if fine { "ok" } else { "FAILED" }
        );
        println!("{line}");
        if !fine {
            self.failed.push(line);
        }
    }

    /// Checks that a residual is zero, given as a fraction.
    fn closes(&mut self, case: &str, quantity: &str, off: f64, tolerance: f64) {
        self.compare(case, quantity, 0.0, off, tolerance);
    }
}

fn scene<S: Space>(case: &str, sets: &[&str]) -> Simulation<S> {
    scene::case(&format!("verification/{case}"), sets)
}

fn plane(case: &str, sets: &[&str]) -> Simulation<Dim2> {
    scene(case, sets)
}

fn solid(case: &str, sets: &[&str]) -> Simulation<Dim3> {
    scene(case, sets)
}

/// Steps until a time and calls `seen` after each step.
fn until<S: Space>(s: &mut Simulation<S>, end: f64, mut seen: impl FnMut(&Simulation<S>)) {
    while s.state.time < end - 0.5 * s.options.scheme.h {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(
            report.solver.converged,
            "step {} did not converge: {:?}",
            s.state.steps, report.solver
        );
        seen(s);
    }
}

#[test]
fn closed_forms_are_met() {
    let mut table = Table::default();
    println!(
        "case                     quantity                                        expected        obtained      tol"
    );
    dynamics::all(&mut table);
    bonds::all(&mut table);
    energy::all(&mut table);
    sinks::all(&mut table);
    solvers::all(&mut table);
    laws::all(&mut table);
    stages::all(&mut table);
    deformable::all(&mut table);
    thermal::all(&mut table);
    assert!(table.failed.is_empty(), "\n{}", table.failed.join("\n"));
}
