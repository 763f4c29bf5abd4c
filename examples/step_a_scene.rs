//! Makes a scene in code and steps it: a slider on two balls is pressed down and pulled along a
//! plane against friction.
//!
//! ```sh
//! cargo run --release --example step_a_scene
//! ```
//! In two dimensions forces, masses and energies are per metre of depth.

use fretwork::bodies::{Dof, TimeFunction};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{BodySpec, InterfaceSpec, ShapeSpec};
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // This is the type into which case files are read, with the same checks and messages.
    let feet = [([0.0, 0.0], 0.01), ([0.05, 0.0], 0.01)];
    let case = CaseBuilder::in_plane("a slider on a plane")
        .time(1e-4, 0.05)
        .material("steel", "rail_steel_r260") // of the materials that come with the library
        .own_material("polymer", 1100.0, "data sheet") // kg/m^3
        .interface(InterfaceSpec::new(
            "dry",
            ("steel", "polymer"),
            "coulomb",
            &[("mu", 0.3)],
        ))
        .body(BodySpec::new(
            "floor",
            "steel",
            ShapeSpec::half_space([0.0, 1.0], [0.0, 0.0]),
        ))
        .body(
            BodySpec::new("slider", "polymer", ShapeSpec::balls(feet))
                .position([0.0, 0.01])
                .x(Dof::Velocity(TimeFunction::Constant(0.1)))
                .y(Dof::Force(TimeFunction::Constant(-100.0))),
        );
    let mut simulation = case.build(&fretwork::shipped::search_path())?.simulation;

    // The simulation steps to the end, or until the callback breaks: here after 2 mm of sliding.
    let slider = simulation
        .bodies()
        .driven_named("slider")
        .ok_or("no slider")?
        .body as usize;
    let start = simulation.motion(slider).position[0];
    let mut friction = Vec::new();
    let end = simulation.run_until(0.05, |now, report| {
        assert!(report.solver.converged);
        friction.extend(
            now.contact_force_on("slider")
                .map(|[force, _moment]| -force[0]),
        );
        if now.motion(slider).position[0] - start >= 2e-3 {
            return ControlFlow::Break("slid far enough");
        }
        ControlFlow::Continue(())
    })?;
    assert_eq!(end, ControlFlow::Break("slid far enough"));

    // Coulomb friction is 0.3 x 100 N, shared by two contacts.
    let last = friction.last().ok_or("no step")?;
    println!("friction force {last:.6} N/m");
    assert!((last - 30.0).abs() < 1e-6 * 30.0);
    let mut carried = 0.0;
    simulation.visit_contacts(&mut |contact| carried += contact.normal_force);
    assert!((carried - 100.0).abs() < 1e-6 * 100.0);

    // The energy ledger has the energy that friction dissipated, and the residual.
    let energy = simulation.energies();
    println!("work of friction {:.6} J/m", energy.friction);
    assert!(energy.friction > 0.0 && energy.residual.abs() < 1e-9 * energy.scale);
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
