//! Attraction on more contacts than one batch of a law.

use crate::scene;
use fretwork::geometry::space::Dim2;

const COUNT: usize = 1300;
const RADIUS: f64 = 1e-3;

/// Each disk hangs alone below a ceiling, which attracts it by twice its weight: all stay, except
/// those whose attraction is too small.
#[test]
fn a_ceiling_holds_every_disk() {
    for (share, held) in [(2.0, true), (0.5, false)] {
        let weight = 1000.0 * std::f64::consts::PI * RADIUS * RADIUS * 9.81;
        let disks: Vec<String> = (0..COUNT)
            .map(|k| {
                let x = 3.0 * RADIUS * k as f64;
                format!("(at: [{x:e}, {:e}], radius: {RADIUS:e})", -RADIUS)
            })
            .collect();
        let text = format!(
            r#"(
    name: "ceiling", dimension: 2, time: (step: 1e-4, end: 1.0),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", cohesion: "constant-attraction",
        parameters: (contact: {{"mu": 0.3}}, cohesion: {{"force": {:e}, "range": 1e-6}}))],
    gravity: [0.0, -9.81],
    grains: [List(material: "grain", grains: [{}])],
    bodies: [(name: "ceiling", material: "grain", shapes: [HalfSpace(normal: [0.0, -1.0])])],
    output: (frames: 0, views: 0),
)"#,
            share * weight,
            disks.join(", ")
        );
        let mut s = scene::text::<Dim2>(&text);
        for _ in 0..40 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let fallen = |at: &&nalgebra::Vector2<f64>| at.y < -RADIUS - 1e-6;
        let places = &s.state.bodies.position[..COUNT];
        let fallen = places.iter().filter(fallen).count();
        assert_eq!(fallen, if held { 0 } else { COUNT }, "attraction {share}");
    }
}
