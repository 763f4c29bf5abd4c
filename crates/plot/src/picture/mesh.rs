//! Deformable bodies in the plane: their elements, in grey or by their von Mises stress.

use crate::{Outline, Paint, Scale, round_top};
use fretwork_core::bodies::von_mises;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;

/// Elements in a window with their corners and stress (Pa).
fn seen<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Vec<(Vec<[f64; 2]>, f64)> {
    let systems = (0..s.state.systems.len()).filter_map(|k| s.state.systems.get(k));
    let mut out = Vec::new();
    for mesh in systems.filter_map(|system| system.deformed_mesh()) {
        let at = |p: &u32| {
            let x = mesh.points[*p as usize] + mesh.displacement[*p as usize];
            [x[0], x[1]]
        };
        for (element, stress) in mesh.elements.chunks_exact(S::D + 1).zip(&mesh.stress) {
            let corners: Vec<[f64; 2]> = element.iter().map(at).collect();
            let inside = (0..2).all(|k| {
                corners.iter().any(|c| c[k] > window[2 * k])
                    && corners.iter().any(|c| c[k] < window[2 * k + 1])
            });
            if inside {
                out.push((corners, von_mises(stress)));
            }
        }
    }
    out
}

/// The scale of the stress in a window; none where nothing is stressed.
pub(super) fn scale<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Option<Scale> {
    let most = seen(s, window).iter().map(|e| e.1).fold(0.0, f64::max);
    (most > 0.0).then(|| Scale {
        label: "von Mises stress".to_owned(),
        unit: "Pa".to_owned(),
        top: round_top(most),
        bonds: false,
    })
}

/// The elements in a window, by stress where a scale is given.
pub(super) fn elements<S: Space>(
    s: &Simulation<S>,
    window: [f64; 4],
    scale: Option<&Scale>,
) -> Vec<Outline> {
    let paint = |stress: f64| scale.map_or(Paint::Grey, |scale| Paint::Value(stress / scale.top));
    let outline = |(points, stress): (Vec<[f64; 2]>, f64)| Outline {
        points,
        label: String::new(),
        // Colours of a scale are those of its bar.
        shade: Some(if scale.is_some() { 0.0 } else { 0.5 }),
        paint: paint(stress),
        element: true,
    };
    seen(s, window).into_iter().map(outline).collect()
}
