//! Grains that are too fast for the step.

use super::*;

fn reports(of: &StepSizeDiagnostics) -> bool {
    of.late + of.passed + of.unwatched_steps + of.held_back > 0
}

/// A grain thrown at a thin wall or at another grain meets it, or the run reports that it may not
/// have.
#[test]
fn fast_grains_do_not_pass_silently() {
    let plate = "(name: \"plate\", material: \"rigid\", shapes: [Polygon(points: [(0.0, -0.1), (0.002, -0.1), (0.002, 0.1), (0.0, 0.1)])]),";
    for speed in [1.0, 100.0] {
        for (what, bodies, other) in [
            ("plate", plate, String::new()),
            ("soft disk", "", disks("soft", &[ball_at(&[0.0, 0.0], &[])])),
            (
                "soft square",
                "",
                square("soft", [0.0, 0.0], 2.0 * R, 0.0, ""),
            ),
            (
                "rigid disk",
                "",
                disks("stone", &[ball_at(&[0.0, 0.0], &[])]),
            ),
        ] {
            for shot in [
                disks(
                    "soft",
                    &[ball_at(&[-0.15, 0.003], &[speed * 2.0 * R / 1e-4, 0.0])],
                ),
                square(
                    "soft",
                    [-0.15, 0.003],
                    2.0 * R,
                    0.1,
                    &format!("velocity: [{:?}, 0.0]", speed * 2.0 * R / 1e-4),
                ),
            ] {
                let mut s = Soft {
                    young: 1e9,
                    bodies: bodies.to_owned(),
                    grains: shot.clone() + &other,
                    tolerance: 1e-6,
                    ..Soft::default()
                }
                .build::<Dim2>();
                let fastest = |s: &Simulation<Dim2>| {
                    (0..s.state.systems.len()).fold(0.0f64, |m, k| m.max(velocity_of(s, k).x))
                };
                let start = fastest(&s);
                let mut failed = false;
                for _ in 0..(20.0 / speed) as usize + 20 {
                    failed |= s.step().is_err();
                }
                let v = fastest(&s);
                let met = (v / start - 1.0).abs() > 1e-3;
                let reported = reports(&s.state.network.step_size);
                println!(
                    "{speed} diameters a step at a {what}: v {}, {met}, reported {reported}, failed {failed}",
                    v / start
                );
                assert!(met || reported || failed, "{what} {speed}");
            }
        }
    }
}
