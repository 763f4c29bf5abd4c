//! Sticking and slipping zones along the surfaces of deformable bodies in 2D, and half-spaces as
//! solids below their surface.

use super::images;
use crate::{Outline, ZoneLine};
use fretwork_core::view::RunView;
use fretwork_observe::tractions::{ContactZone, SurfaceState};

fn surfaces(run: &dyn RunView) -> impl Iterator<Item = (usize, SurfaceState)> {
    (0..run.system_count()).filter_map(move |k| Some((k, SurfaceState::of(run, k)?)))
}

/// Returns sticking and slipping zones along the surface of each body with contacts, from the
/// middle of one facet to that of the next.
pub(crate) fn lines(run: &dyn RunView, window: [f64; 4]) -> Vec<ZoneLine> {
    let period = run.periodic().period[0];
    let mut out = Vec::new();
    for (_, state) in surfaces(run) {
        for ends in state.surface.facets.as_chunks::<2>().0 {
            let [a, b] = ends.map(|k| state.place(k as usize));
            let middle = (a + b) * 0.5;
            for (k, from, to) in [(ends[0], a, middle), (ends[1], middle, b)] {
                let zone = state.zone[k as usize];
                if zone == ContactZone::Open {
                    continue;
                }
                let along = to - from;
                for x in images(from[0], along.norm(), window, period) {
                    out.push(ZoneLine {
                        a: [x, from[1]],
                        b: [x + along[0], to[1]],
                        slips: zone == ContactZone::Slip,
                    });
                }
            }
        }
    }
    out
}

/// Returns the solids of half-spaces over the range of their cells, from the surface to beyond the
/// window.
pub(crate) fn solids(run: &dyn RunView, window: [f64; 4]) -> Vec<Outline> {
    let depth = 2.0 * ((window[1] - window[0]) + (window[3] - window[2]));
    let mut out = Vec::new();
    for (k, state) in surfaces(run) {
        let Some(system) = run.system(k) else {
            continue;
        };
        let Some(ends) = state.surface.facets.first_chunk::<2>() else {
            continue;
        };
        if system.deformed_mesh().is_some() {
            continue;
        }
        // The body is on the right of the direction from the first point of a facet to the second.
        let [a, b] = ends.map(|k| state.place(k as usize));
        let down = if b[0] > a[0] { -depth } else { depth };
        let places = (0..state.zone.len()).map(|p| state.place(p));
        let mut points: Vec<[f64; 2]> = places.map(|p| [p[0], p[1]]).collect();
        let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else {
            continue;
        };
        points.extend([[last[0], last[1] + down], [first[0], first[1] + down]]);
        out.push(Outline {
            points,
            label: system.name().to_owned(),
            ..Outline::default()
        });
    }
    out
}
