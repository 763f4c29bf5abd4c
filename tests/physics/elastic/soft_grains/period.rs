//! Grains that touch across the period.

use super::*;

/// Two grains that meet at a place, or half of a period away from it, have equal forces and
/// velocities.
#[test]
fn grains_meet_across_the_period() {
    let pairs: [(&str, [&str; 2]); 4] = [
        ("disks", ["disk soft", "disk soft"]),
        ("rigid disk", ["disk soft", "disk stone"]),
        ("rigid corner", ["square soft", "corner stone"]),
        ("squares", ["square soft", "square soft"]),
    ];
    for (what, pair) in pairs {
        for order in [[0, 1], [1, 0]] {
            let found = [0.0, 0.1].map(|shift: f64| {
                let wrap = |x: f64| {
                    if x + shift < -0.1 {
                        x + shift + 0.2
                    } else if x + shift > 0.1 {
                        x + shift - 0.2
                    } else {
                        x + shift
                    }
                };
                let mut grains = String::new();
                for k in order {
                    let side = [-1.0, 1.0][k];
                    let (kind, material) = pair[k].split_once(' ').unwrap();
                    let at = [wrap(side * 1.01 * R), 0.001 * side];
                    let v = [-0.3 * side, 0.0];
                    grains += &match kind {
                        "disk" => disks(material, &[ball_at(&at, &v)]),
                        "square" => square(material, at, 2.0 * R, 0.0, &format!("velocity: {v:?}")),
                        _ => square(
                            material,
                            at,
                            2f64.sqrt() * R,
                            PI / 4.0,
                            &format!("velocity: {v:?}"),
                        ),
                    };
                }
                let mut s = Soft {
                    more: "periodic: (x: 0.2),".to_owned(),
                    grains,
                    ..Soft::default()
                }
                .build::<Dim2>();
                let mut pressed = 0.0f64;
                for _ in 0..150 {
                    go(&mut s, 1);
                    let normal = s
                        .state
                        .network
                        .contacts
                        .iter()
                        .map(|c| c.impulse.dot(&c.normal));
                    pressed = pressed.max(normal.sum());
                }
                (pressed, velocity_of(&s, 0))
            });
            println!("{what} {order:?}: {found:?}");
            assert!(found[0].0 > 0.0);
            for other in &found[1..] {
                near(found[0].0, other.0, 1e-7);
                assert!((other.1 - found[0].1).norm() < 1e-7, "{what}");
            }
        }
    }
}
