//! Deformable bodies in 2D: their elements, in grey or coloured by their von Mises stress.

use super::images;
use crate::{ColourScale, Outline, Paint};
use fretwork_core::bodies::von_mises;
use fretwork_core::view::RunView;
use fretwork_observe::chart::round_top;
use std::collections::HashMap;

/// Returns the elements in a window with their corners and stress (Pa); elements of grains only if
/// requested.
fn seen(run: &dyn RunView, window: [f64; 4], grains: bool) -> Vec<(Vec<[f64; 2]>, f64)> {
    let period = run.periodic().period[0];
    let systems = (0..run.system_count()).filter_map(|k| run.system(k));
    let systems = systems.filter(|system| grains || !system.is_grain());
    let mut out = Vec::new();
    for mesh in systems.filter_map(|system| system.deformed_mesh()) {
        let Some(first) = mesh.points.first() else {
            continue;
        };
        for image in images(first[0], f64::INFINITY, window, period) {
            let at = |p: &u32| {
                let x = mesh.points[*p as usize] + mesh.displacement[*p as usize];
                [x[0] - first[0] + image, x[1]]
            };
            for (element, stress) in mesh
                .elements
                .chunks_exact(run.dimension() + 1)
                .zip(&mesh.stress)
            {
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
    }
    out
}

/// Returns deformable grains as outlines.
pub(crate) fn grains(run: &dyn RunView, window: [f64; 4], paints: &[Paint]) -> Vec<Outline> {
    let bodies = run.bodies();
    // A grain has the colour of its points.
    let mut points: HashMap<u32, usize> = HashMap::new();
    for (k, ball) in run.balls().iter().enumerate() {
        points.entry(ball.body).or_insert(k);
    }
    let mut out = Vec::new();
    let surfaces = run.surfaces().into_iter().enumerate();
    for (k, surface) in surfaces.filter(|(_, f)| f.closed) {
        let b = surface.body as usize;
        let centre = bodies.position.at(b);
        let reach = 2.0 * bodies.length[b];
        let period = run.periodic().period[0];
        let chain: Vec<[f64; 3]> = run.surface_lines(k).concat();
        let paint = points.get(&surface.body);
        let paint = paint.map_or(Paint::Grey, |k| super::paint(paints, *k));
        for image in images(centre[0], reach, window, period) {
            let at = |p: &[f64; 3]| {
                let x = run.turned(b, *p);
                [image + x[0], centre[1] + x[1]]
            };
            out.push(Outline {
                points: chain.iter().map(at).collect(),
                shade: Some(0.25),
                paint,
                ..Outline::default()
            });
        }
    }
    out
}

/// The scale of the stress in a window; `None` where nothing is stressed.
pub(crate) fn scale(run: &dyn RunView, window: [f64; 4]) -> Option<ColourScale> {
    let most = seen(run, window, true)
        .iter()
        .map(|e| e.1)
        .fold(0.0, f64::max);
    (most > 0.0).then(|| ColourScale {
        label: "von Mises stress".to_owned(),
        unit: "Pa".to_owned(),
        top: round_top(most),
        bonds: false,
    })
}

/// The elements in a window, by stress where a scale is given.
pub(crate) fn elements(
    run: &dyn RunView,
    window: [f64; 4],
    scale: Option<&ColourScale>,
) -> Vec<Outline> {
    let paint = |stress: f64| scale.map_or(Paint::Grey, |scale| Paint::Value(stress / scale.top));
    let outline = |(points, stress): (Vec<[f64; 2]>, f64)| Outline {
        points,
        // With a colour scale, elements use the colours of its bar.
        shade: Some(if scale.is_some() { 0.0 } else { 0.5 }),
        paint: paint(stress),
        element: true,
        ..Outline::default()
    };
    seen(run, window, scale.is_some())
        .into_iter()
        .map(outline)
        .collect()
}
