//! Newton's method of a step: its iterations converge quadratically, and steps without a balance
//! end with a message.

use super::*;
use crate::extremes::bench::floor;
use fretwork::bodies::SystemStep;
use nalgebra::Vector2;

/// A block that is sheared and pressed by a tenth of its modulus at once.
fn distorted(strain: Strain, theta: f64) -> Vec<f64> {
    let mesh = block::<Dim2>(&[even(0.0, 0.01, 4), even(0.0, 0.01, 4)]).unwrap();
    let force = |f: f64| Some(Dof::Force(TimeFunction::Constant(f * RUBBER.young * 0.01)));
    let supports = [
        support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support("top", &[force(0.05), force(-0.1)]),
    ];
    let mut spec = body(mesh, RUBBER, &supports);
    spec.strain = strain;
    let mut system = ElasticBody::<Dim2>::new(spec).unwrap();
    let step = SystemStep {
        time: 0.0,
        h: 1.0,
        theta,
        gravity: Vector2::zeros(),
    };
    system.begin_step(&step);
    system.advance((1.0 - theta) * step.h);
    system.linearise(&step);
    let mut changes = Vec::new();
    let mut before = system.velocity().to_vec();
    loop {
        let velocity = system.free_velocity(&step);
        system.set_contact_impulse(&vec![0.0; velocity.len()]);
        system.set_velocity(&velocity);
        let change = velocity.iter().zip(&before).map(|(a, b)| (a - b).powi(2));
        let size = velocity.iter().map(|v| v * v).sum::<f64>();
        changes.push((change.sum::<f64>() / size).sqrt());
        before = velocity;
        if !system.relinearise(&step).unwrap() {
            println!("{strain:?}, theta {theta}: changes {changes:?}");
            return changes;
        }
    }
}

#[test]
fn iterations_converge_quadratically() {
    for strain in LARGE {
        let changes = distorted(strain, 1.0);
        assert!(changes.len() < 15);
        // Once the changes are small, each is the square of the previous one times a constant of
        // the problem.
        let small: Vec<f64> = changes
            .into_iter()
            .filter(|c| (1e-11..0.1).contains(c))
            .collect();
        for pair in small.windows(2).filter(|p| p[1] > 1e-9) {
            assert!(pair[1] < 10.0 * pair[0] * pair[0], "{strain:?}: {small:?}");
        }
        assert!(distorted(strain, 0.5).len() < 50);
    }
}

#[test]
fn a_step_without_balance_ends_with_a_sentence() {
    let mut s = scene::<Dim2>(&Sketch {
        bodies: floor::<Dim2>().replace("shapes:", "position: [0.0, -1.0], shapes:"),
        ..sketch(1.0, 1.0)
    });
    let supports = [
        support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support("top", &[None, ramp(-0.011, 1.0)]),
    ];
    let mesh = block::<Dim2>(&[even(0.0, 0.01, 2), even(0.0, 0.01, 2)]).unwrap();
    let mut spec = body(mesh, RUBBER, &supports);
    spec.strain = Strain::NeoHookean;
    add(&mut s, spec);
    let error = s.step().unwrap_err();
    let said = error.to_string();
    println!("{said}");
    assert!(error.asks_for_smaller_step());
    for word in ["step 1", "`specimen`", "shorter time.step"] {
        assert!(said.contains(word), "{said}");
    }
}
