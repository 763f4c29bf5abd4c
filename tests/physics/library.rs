//! Scenes made in Rust without any file are equal to those of case files.

use crate::scene;
use fretwork::bodies::{Dof, TimeFunction};
use fretwork::geometry::space::Space;
use fretwork::scene::case::{
    BodySpec, GrainSpec, InterfaceSpec, OneGrain, OnePolyhedron, ShapeSpec,
};
use fretwork::scene::{CaseBuilder, Dim2, Dim3, InputError, load_text};
use fretwork::shipped::search_path;
use std::ops::ControlFlow;
use std::path::Path;

fn axes<S: Space>(up: f64) -> Vec<f64> {
    let mut axes = vec![0.0; S::D];
    axes[S::D - 1] = up;
    axes
}

/// A bonded layer of grains between a floor and a lid that presses and slides.
fn layer<S: Space>() -> CaseBuilder {
    // Three rows of disks with 12 to the period, or a layer of 12 by 12 balls, and their height.
    let rise = 4e-3 * 0.75f64.sqrt();
    let (count, top) = if S::D == 2 {
        (36, 4e-3 + 2.0 * rise)
    } else {
        (144, 4e-3)
    };
    let mut high = vec![0.05; S::D];
    high[S::D - 1] = 0.02;
    let mut down = axes::<S>(-1.0);
    let mut lid = BodySpec::new("lid", "steel", ShapeSpec::half_space(down.clone(), vec![]))
        .position(axes::<S>(top + 2e-6))
        .mass(1.0)
        .x(Dof::Velocity(TimeFunction::Constant(0.05)));
    let press = Dof::Force(TimeFunction::Ramp {
        from: 0.0,
        to: -50.0,
        start: 0.0,
        end: 1e-3,
    });
    lid = if S::D == 2 {
        lid.y(press)
    } else {
        lid.z(press)
    };
    down[S::D - 1] = 1.0;
    let periodic = if S::D == 2 {
        [Some(0.05), None, None]
    } else {
        [Some(0.05), Some(0.05), None]
    };
    let case = match S::D {
        2 => CaseBuilder::in_plane("a layer made in Rust"),
        _ => CaseBuilder::in_space("a layer made in Rust"),
    };
    case.time(1e-5, 2e-3)
        .seed(7)
        .gravity(axes::<S>(-9.81))
        .periodic(periodic)
        .material("steel", "rail_steel_r260")
        .own_material("powder", 3000.0, "an example")
        .interface(
            InterfaceSpec::new("inside", ("powder", "powder"), "coulomb", &[("mu", 0.4)])
                .cohesion("parallel-bond", &[("k_n", 1e10), ("k_t", 5e9)]),
        )
        .interface(InterfaceSpec::new(
            "walls",
            ("steel", "powder"),
            "coulomb",
            &[("mu", 0.3)],
        ))
        .body(BodySpec::new(
            "floor",
            "steel",
            ShapeSpec::half_space(down, vec![]),
        ))
        .body(lid)
        .grains(GrainSpec::lattice(
            "powder",
            count,
            (2e-3, 2e-3),
            vec![0.0; S::D],
            high,
        ))
}

/// Positions, velocities and impulses after some steps, bit by bit.
fn bits<S: Space>(through_text: bool) -> Vec<u64> {
    let builder = layer::<S>();
    let loaded = if through_text {
        // A material defined in code is a file here, since a text can only name it.
        let text = builder.case().to_ron().unwrap_or_else(|e| panic!("{e}"));
        let material = fretwork::scene::material::Material {
            doc: String::new(),
            class: None,
            also: Vec::new(),
            density: fretwork::scene::material::Sourced {
                value: 3000.0,
                unit: String::new(),
                range: None,
                motion: None,
                source: String::new(),
            },
            properties: Default::default(),
            laws: None,
        };
        load_text("layer.ron", &text, Path::new(""), &[])
            .and_then(|loaded| loaded.with_material("powder", &material))
    } else {
        builder.load()
    };
    let loaded = loaded.unwrap_or_else(|e| panic!("{e}"));
    let mut s = scene::simulation::<S>(&loaded);
    let mut steps = 0;
    let ended = s.run_until(1e-3, |_, report| {
        assert!(report.solver.converged);
        steps += 1;
        ControlFlow::<()>::Continue(())
    });
    assert!(matches!(ended, Ok(ControlFlow::Continue(()))), "{ended:?}");
    assert_eq!((steps, s.state.steps), (100, 100));
    let (ledger, scale) = (s.energies().residual, s.energies().scale);
    assert!(ledger.abs() < 1e-3 * scale, "{ledger:e} of {scale:e}");
    let mut out = Vec::new();
    for k in 0..s.body_count() {
        for axis in 0..S::D {
            out.push(s.positions()[k][axis].to_bits());
            out.push(s.velocities()[k][axis].to_bits());
        }
    }
    let carried = s.contacts().filter(|c| c.normal_force > 0.0).count();
    assert!(carried > 5, "{carried} contacts carry");
    out.extend(s.contacts().map(|c| c.normal_force.to_bits()));
    out
}

#[test]
fn scenes_made_in_rust_have_the_bits_of_their_text() {
    assert_eq!(bits::<Dim2>(false), bits::<Dim2>(true));
    assert_eq!(bits::<Dim3>(false), bits::<Dim3>(true));
}

/// A cuboid at rest on a plane: the contacts carry its weight, whatever number of them.
#[test]
fn contacts_carry_the_weight_of_a_cuboid() {
    let case = CaseBuilder::in_space("a cuboid")
        .time(1e-3, 1.0)
        .gravity([0.0, 0.0, -10.0])
        .own_material("stone", 2000.0, "an example")
        .interface(InterfaceSpec::new(
            "dry",
            ("stone", "stone"),
            "coulomb",
            &[("mu", 0.5)],
        ))
        .body(BodySpec::new(
            "floor",
            "stone",
            ShapeSpec::half_space([0.0, 0.0, 1.0], []),
        ))
        .grains(GrainSpec::polyhedra(
            "stone",
            [OnePolyhedron::cuboid([0.0, 0.0, 0.05], (0.3, 0.2, 0.1))],
        ));
    let built = case.build(&search_path()).unwrap_or_else(|e| panic!("{e}"));
    let mut s = built.simulation.into_dimension::<Dim3>().unwrap();
    // The run is stopped by the callback at the tenth step, and then continued.
    let ended = s.run_until(1.0, |now, _| {
        if now.state.steps == 10 {
            ControlFlow::Break(now.state.time)
        } else {
            ControlFlow::Continue(())
        }
    });
    assert!(matches!(ended, Ok(ControlFlow::Break(t)) if (t - 0.01).abs() < 1e-12));
    let weight = 2000.0 * 0.3 * 0.2 * 0.1 * 10.0;
    let ended = s.run_until(0.02, |now, _| {
        let (force, _) = now.contact_force_on("floor").unwrap();
        assert!((-force.z - weight).abs() < 1e-3 * weight, "{force:?}");
        let carried: f64 = now.contacts().map(|c| c.normal_force).sum();
        assert!((carried - weight).abs() < 1e-3 * weight, "{carried}");
        for contact in now.contacts() {
            assert!(contact.point.z.abs() < 1e-4 && contact.normal.z.abs() > 0.999);
        }
        ControlFlow::<()>::Continue(())
    });
    assert!(matches!(ended, Ok(ControlFlow::Continue(()))) && s.state.steps == 20);
    assert_eq!(s.contact_force_on("ceiling"), None);
}

fn refusal(builder: CaseBuilder) -> InputError {
    match builder.build(&search_path()) {
        Err(error) => error,
        Ok(_) => panic!("it is built"),
    }
}

/// Errors are reported in the sentences of case files, with the path or the name of the cause.
#[test]
fn mistakes_are_refused_in_the_sentences_of_case_files() {
    let ball = || GrainSpec::balls("powder", [OneGrain::new([0.0, 0.03], 1e-3)]);
    for (wrong, sentence) in [
        (layer::<Dim2>().time(0.0, 1.0), "must be positive, got 0"),
        (
            layer::<Dim2>().interface(InterfaceSpec::new("x", ("steel", "stel"), "coulomb", &[])),
            "the case has no material `stel`",
        ),
        (
            layer::<Dim2>().interface(InterfaceSpec::new("x", ("steel", "steel"), "colomb", &[])),
            "did you mean `coulomb`",
        ),
        (
            layer::<Dim2>().interface(InterfaceSpec::new(
                "x",
                ("steel", "steel"),
                "coulomb",
                &[("mu", -1.0)],
            )),
            "mu",
        ),
        (layer::<Dim2>().gravity([0.0, 0.0, 1.0]), "gravity"),
        (
            layer::<Dim2>().material("wood", "woood"),
            "there is no file `woood.ron`",
        ),
        (
            layer::<Dim2>().grains(GrainSpec::balls(
                "powder",
                [OneGrain::new([0.0, 0.0, 0.0], 1.0)],
            )),
            "3 components in a case of dimension 2",
        ),
        (
            layer::<Dim2>()
                .grains(ball())
                .own_material("powder", -1.0, "nowhere"),
            "a density must be positive, got -1",
        ),
    ] {
        let error = refusal(wrong);
        let said = error.to_string();
        assert!(said.contains(sentence), "{sentence}: {said}");
        assert!(error.position().is_some(), "{said}");
    }
}
