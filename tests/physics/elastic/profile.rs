//! Blocks with a profile on a side.

use super::*;
use crate::scene;
use std::f64::consts::PI;

/// Westergaard's wave: contact covers 2 a with sin^2(pi a/L) = p/p*, p* = pi E* D/L, and the
/// pressure on the crest is 2 p/sin(pi a/L) (K. L. Johnson, "Contact Mechanics", 1985, section
/// 13.2).
#[test]
fn a_wavy_block_is_pressed_as_westergaard_says() {
    let s = &mut scene::case::<Dim2>("verification/elastic/wavy_block", &[]);
    go(s, 12);
    let (length, size) = (1e-3, 1.5625e-5);
    let mean = 3.5780e5 / length;
    let modulus = 209.92e9 / (1.0 - 0.28 * 0.28);
    let share = mean * length / (PI * modulus * 1e-6);
    let expected = length / PI * share.sqrt().asin();
    let loaded = s
        .state
        .network
        .contacts
        .iter()
        .filter(|c| c.impulse.norm() > 0.0);
    let places = loaded.map(|c| {
        let at = s.state.bodies.position[c.bodies[0] as usize] + c.arms[0];
        (at.x, c.impulse.norm() / (s.options.scheme.h * size))
    });
    let places: Vec<(f64, f64)> = places.collect();
    // A point represents half of an edge on either side.
    let half = 0.5 * size * places.len() as f64;
    println!("half-width {half:e}, expected {expected:e}");
    assert!((half - expected).abs() < size, "{half:e}, {expected:e}");
    let crest = places
        .iter()
        .find(|p| p.0.abs() < 1e-9)
        .map_or(0.0, |p| p.1);
    near(2.0 * mean / share.sqrt(), crest, 0.01);
}
