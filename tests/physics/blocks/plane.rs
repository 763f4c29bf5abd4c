//! Polygons: sizes and areas of samples, the law's closed form over a face.

use super::face::opens_by_its_law;
use super::{scene, step};
use fretwork::contact::Key;
use fretwork::geometry::convex::Core;
use fretwork::geometry::space::Dim2;
use fretwork::step::Simulation;
use nalgebra::Vector2;
use std::collections::HashMap;

/// Corners of a piece at its position (m).
fn corners(s: &Simulation<Dim2>, piece: usize) -> Vec<Vector2<f64>> {
    let piece = &s.shapes.pieces[piece];
    let b = piece.body as usize;
    let core = piece.core.turned(&s.state.bodies.rotation[b]);
    let at = s.state.bodies.position[b] + piece.offset;
    core.outline(0.0).concat().iter().map(|c| c + at).collect()
}

/// Length of the common part of the boundaries of two polygons that touch (m).
fn common(a: &[Vector2<f64>], b: &[Vector2<f64>]) -> f64 {
    let mut sum = 0.0;
    for i in 0..a.len() {
        let (from, to) = (a[i], a[(i + 1) % a.len()]);
        let along = (to - from).normalize();
        for j in 0..b.len() {
            let (p, q) = (b[(j + 1) % b.len()] - from, b[j] - from);
            if along.perp(&p).abs().max(along.perp(&q).abs()) < 1e-9 {
                let high = along.dot(&q).min((to - from).norm());
                sum += (high - along.dot(&p).max(0.0)).max(0.0);
            }
        }
    }
    sum
}

#[test]
fn a_wall_in_running_bond() {
    let s = scene::<Dim2>("block_wall", &[]);
    assert_eq!(s.shapes.pieces.len(), 22);
    let density = s.state.bodies.mass[0] / 0.02;
    let mass: f64 = (0..22).map(|b| s.state.bodies.mass[b]).sum();
    assert!((mass / (density * 0.8 * 0.5) - 1.0).abs() < 1e-14);
    let open = ["grains.0.gap=0.01", "grains.0.at=[0.3, 0.2]"];
    let s = scene::<Dim2>("block_wall", &open);
    for k in 0..22 {
        let points = corners(&s, k);
        let of = |axis: usize| points.iter().map(move |p| p[axis]);
        let (low, high) = (of(0).fold(9.0, f64::min), of(0).fold(-9.0, f64::max));
        assert!(low > 0.3 - 1e-12 && high < 0.3 + 0.83 + 1e-12);
        // The second course begins with half a block, whose joint is over the middle of the first
        // block.
        if k == 4 {
            assert!((0.5 * (high + 0.005 + low - 0.005) - 0.3475).abs() < 1e-12);
            assert!((high + 0.005 - 0.4).abs() < 1e-12);
            assert!((of(1).fold(9.0, f64::min) - 0.31).abs() < 1e-12);
        }
    }
}

#[test]
fn neighbours_are_bonded_over_their_sides_and_nothing_else_is() {
    for rounds in ["grains.0.rounds=0", "grains.0.rounds=5"] {
        let mut s = scene::<Dim2>("verification/voronoi_plate", &[rounds]);
        let area: f64 = s.state.bodies.mass[..150].iter().sum();
        let density = scene::<Dim2>("block_wall", &[]).state.bodies.mass[0] / 0.02;
        assert!((area / (density * 0.06) - 1.0).abs() < 1e-13);
        step(&mut s);
        let mut held: HashMap<(u32, u32), f64> = HashMap::new();
        for c in &s.state.network.contacts {
            if s.state.network.bond(c).is_some_and(|b| b.intact()) {
                *held.entry(c.key.pair()).or_default() += c.radius;
            }
        }
        let outlines: Vec<_> = (0..s.shapes.pieces.len()).map(|k| corners(&s, k)).collect();
        let (mut sides, mut missing) = (0, 0.0);
        for i in 0..outlines.len() {
            for j in i + 1..outlines.len() {
                let length = common(&outlines[i], &outlines[j]);
                let name = (i as u32 | Key::PIECE, j as u32 | Key::PIECE);
                let bonded = held
                    .remove(&name)
                    .or_else(|| held.remove(&(name.1, name.0)));
                match bonded {
                    Some(found) => assert!((found - length).abs() < 1e-9, "{found} {length}"),
                    None => missing += length,
                }
                sides += usize::from(length > 0.0);
            }
        }
        assert!(held.is_empty() && sides > 400, "{held:?} {sides}");
        // Sides shorter than the tolerance of detection have no bond.
        assert!(missing < 1e-5, "{missing:e}");
    }
}

#[test]
fn a_face_opens_by_its_law_over_its_whole_length() {
    opens_by_its_law::<Dim2>("verification/bonded_face", 2, 0.5, 2e-15);
}
