//! Faces of a rounded polyhedron for figures and files: its faces moved outwards, and the rounding
//! of edges and corners.

use super::polyhedron::Polyhedron;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, TAU};

type V = Vector3<f64>;

/// Returns polygons that are anticlockwise seen from outside (m).
pub fn of(core: &Polyhedron, rounding: f64) -> Vec<Vec<V>> {
    let (topology, normals) = (core.topology(), core.normals());
    if topology.faces.is_empty() {
        let [from, to] = core.ends(0);
        return capsule(from, to, rounding);
    }
    let mut out: Vec<Vec<V>> = (0..topology.faces.len())
        .map(|f| core.face(f).map(|p| p + normals[f] * rounding).collect())
        .collect();
    if rounding == 0.0 {
        return out;
    }
    for (e, edge) in topology.edges.iter().enumerate() {
        let Some(faces) = edge.faces else { continue };
        let [a, b] = core.ends(e);
        let [m, n] = faces.map(|f| normals[f as usize] * rounding);
        out.push(vec![b + m, a + m, a + n, b + n]);
    }
    for (c, about) in topology.about.iter().enumerate() {
        let corner = core.points()[c];
        out.push(
            about
                .iter()
                .map(|f| corner + normals[*f as usize] * rounding)
                .collect(),
        );
    }
    out
}

/// Returns rings about the axis from one end to the other.
fn capsule(from: V, to: V, radius: f64) -> Vec<Vec<V>> {
    const AROUND: usize = 16;
    const BELOW: usize = 4;
    let axis = (to - from).normalize();
    let side = super::polyhedron::across(&axis);
    let other = axis.cross(&side);
    let ring = |centre: V, height: f64, radius: f64| -> Vec<V> {
        (0..AROUND)
            .map(|k| (TAU * k as f64 / AROUND as f64).sin_cos())
            .map(|(s, c)| centre + axis * height + (side * c + other * s) * radius)
            .collect()
    };
    let cap = |k: usize| (FRAC_PI_2 * k as f64 / BELOW as f64).sin_cos();
    let mut rings: Vec<Vec<V>> = Vec::new();
    for k in 0..=BELOW {
        let (s, c) = cap(k);
        rings.push(ring(from, -c * radius, s * radius));
    }
    for k in (0..=BELOW).rev() {
        let (s, c) = cap(k);
        rings.push(ring(to, c * radius, s * radius));
    }
    let mut out = Vec::new();
    for pair in rings.windows(2) {
        for k in 0..AROUND {
            let next = (k + 1) % AROUND;
            out.push(vec![pair[0][k], pair[0][next], pair[1][next], pair[1][k]]);
        }
    }
    out
}
