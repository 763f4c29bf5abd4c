//! Builds a case in code: a bed of balls between first bodies. The case is written as text, read
//! again, changed by a key, and built. Nothing is stepped.
//!
//! ```sh
//! cargo run --release --example build_a_scene
//! ```

use fretwork::bodies::{Dof, TimeFunction};
use fretwork::scene::case::{BodySpec, GrainSpec, InterfaceSpec, ShapeSpec};
use fretwork::scene::{CaseBuilder, load_text};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let down = [0.0, 0.0, -1.0];
    let case = CaseBuilder::in_space("a pressed layer")
        .time(1e-5, 1e-3)
        .seed(1)
        .gravity([0.0, 0.0, -9.81])
        .periodic([Some(0.05), Some(0.05), None]) // along x and y (m)
        .material("glass", "glass_bead")
        .material("steel", "rail_steel_r260")
        .interface(
            // A contact law and its parameters; `.cohesion`, `.damage` and `.wear` would add other
            // laws.
            InterfaceSpec::new("inside", ("glass", "glass"), "coulomb", &[("mu", 0.4)])
                .cohesion("parallel-bond", &[("k_n", 1e10), ("k_t", 5e9)])
                .bonds_within(1e-4),
        )
        .interface(InterfaceSpec::new(
            "walls",
            ("glass", "steel"),
            "coulomb",
            &[("mu", 0.3)],
        ))
        .body(BodySpec::new(
            "floor",
            "steel",
            ShapeSpec::half_space([0.0, 0.0, 1.0], []),
        ))
        .body(
            BodySpec::new("lid", "steel", ShapeSpec::half_space(down, []))
                .position([0.0, 0.0, 4.01e-3])
                .mass(0.5)
                .z(Dof::Force(TimeFunction::Constant(-20.0))),
        )
        .grains(GrainSpec::lattice(
            "glass",
            144,
            (2e-3, 2e-3),
            [0.0; 3],
            [0.05, 0.05, 0.02],
        ))
        .change(|case| case.output.figures = false) // all fields of a case are public
        .case();

    // The text can also be run by the program: `fretwork run layer.ron`. Reading it gives an equal
    // case, to the last bit.
    let text = case.to_ron()?;
    let read = |sets: &[String]| load_text("layer.ron", &text, Path::new(""), sets);
    assert_eq!(read(&[])?.case, case);

    // Changes use the syntax of `--set`. Errors give line and column.
    let loaded = read(&["interfaces.inside.parameters.contact.mu=0.5".to_owned()])?;
    assert_ne!(loaded.case, case);
    let Err(error) = read(&["time.stop=1.0".to_owned()]) else {
        return Err("a key that no case has was taken".into());
    };
    println!("{error}");

    // Building the scene finds and checks the laws, and places the grains.
    let built = loaded.build(&fretwork::shipped::search_path())?;
    let (simulation, grains) = (&built.simulation, built.simulation.grains());
    println!(
        "{} bodies of {} materials",
        simulation.bodies().len(),
        built.materials.len()
    );
    assert_eq!(grains.len(), 144);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 2e-3_f64.powi(3);
    let mass: f64 = grains
        .iter()
        .map(|grain| simulation.bodies().mass[*grain])
        .sum();
    assert!((mass / (144.0 * 2500.0 * volume) - 1.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
