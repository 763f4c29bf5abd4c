//! A block on a slope.

use super::*;

/// A block on a slope of the angle phi sticks for tan phi < mu, and otherwise slides with g (sin
/// phi - mu cos phi) (Coulomb).
#[test]
fn a_block_on_an_incline() {
    for young in [1e6, 1e8, 1e10, 1e12] {
        for (tan, slides) in [(0.28f64, false), (0.32, true), (0.6, true)] {
            let phi = tan.atan();
            let mut s = Soft {
                step: 2e-4,
                theta: 1.0,
                young,
                elements: 2,
                gravity: vec![G * phi.sin(), -G * phi.cos()],
                bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], ""),
                grains: square("soft", [0.0, 0.01], 0.02, 0.0, ""),
                tolerance: 1e-10,
                ..Soft::default()
            }
            .build::<Dim2>();
            go(&mut s, 200);
            let v0 = velocity_of(&s, 0).x;
            go(&mut s, 200);
            let found = (velocity_of(&s, 0).x - v0) / (200.0 * 2e-4);
            let expected = if slides {
                G * (phi.sin() - 0.3 * phi.cos())
            } else {
                0.0
            };
            println!("E {young:e}, tan {tan}: {found} of {expected} m/s^2");
            assert!(
                (found - expected).abs() < 1e-6 * G,
                "{young:e} {tan}: {found} {expected}"
            );
            assert!(place_of(&s, 0).y > 0.0099);
            closes(&s, 1e-9);
        }
    }
}
