//! Grains that spin without load.

use super::*;

fn turns<S: Space>(what: &str, grain: &str, spin: &[f64]) {
    let speed = spin.iter().map(|w| w * w).sum::<f64>().sqrt();
    let mut s = Soft {
        step: 0.05 / speed,
        elements: if S::D == 2 { 4 } else { 1 },
        grains: grain.to_owned(),
        ..Soft::default()
    }
    .build::<S>();
    let (start, before) = (all_momenta(&s).1, s.state.energy.kinetic);
    let (mut drift, mut off, mut stress) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..300 {
        go(&mut s, 1);
        drift = drift.max((s.state.energy.kinetic / before - 1.0).abs());
        off = off.max((all_momenta(&s).1 - start).norm() / start.norm());
        let mesh = mesh(&s, 0);
        stress = mesh
            .stress
            .iter()
            .flatten()
            .fold(stress, |m, x| m.max(x.abs()));
    }
    println!("{what}: stress {stress:e}, energy {drift:e}, angular momentum {off:e}");
    assert!(stress < 1e-9 && off < 1e-11, "{what}: {stress:e} {off:e}");
    assert!(drift < 1e-10, "{what}: {drift:e}");
    closes(&s, 1e-10);
}

#[test]
fn spinning_grains_have_no_stress() {
    let ball = |at: &str, spin: &str| format!("(at: {at}, radius: {R:?}, spin: {spin})");
    turns::<Dim2>(
        "disk",
        &disks("soft", &[ball("[0.0, 0.0]", "[30.0]")]),
        &[30.0],
    );
    turns::<Dim2>(
        "square",
        &square("soft", [0.0; 2], 0.02, 0.3, "spin: [30.0]"),
        &[30.0],
    );
    let spin = [10.0, 20.0, 20.0];
    turns::<Dim3>(
        "sphere",
        &disks("soft", &[ball("[0.0, 0.0, 0.0]", "[10.0, 20.0, 20.0]")]),
        &spin,
    );
    turns::<Dim3>(
        "brick",
        &cuboid(
            "soft",
            [0.0; 3],
            [0.01, 0.02, 0.03],
            "spin: [10.0, 20.0, 20.0]",
        ),
        &spin,
    );
}
