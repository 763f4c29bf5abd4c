//! Curves in pixels: colours, thinning, lines and markers.

use crate::png::canvas::{Canvas, Rgb, WHITE, along};
use fretwork_observe::chart::{GRADIENT, Style};

/// Returns the colour at a share of the gradient.
pub(crate) fn gradient(t: f64) -> Rgb {
    along(&GRADIENT.map(Rgb::from), t)
}

/// Keeps the first, lowest, highest and last point of each pass through a pixel column.
pub(crate) fn thinned(run: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let mut kept = Vec::new();
    for stay in run.chunk_by(|a, b| a[0].floor() == b[0].floor()) {
        let mut keep = [0, 0, 0, stay.len() - 1];
        for (i, p) in stay.iter().enumerate() {
            if p[1] < stay[keep[1]][1] {
                keep[1] = i;
            }
            if p[1] > stay[keep[2]][1] {
                keep[2] = i;
            }
        }
        keep.sort_unstable();
        let mut before = usize::MAX;
        for i in keep {
            if i != before {
                kept.push(stay[i]);
            }
            before = i;
        }
    }
    kept
}

/// Draws the lines of one series; `shape` is the index of the marker, `u` the scale of the picture.
pub(crate) fn draw_series(
    field: &mut Canvas,
    runs: &[Vec<[f32; 2]>],
    style: Style,
    colour: Rgb,
    shape: usize,
    u: f32,
) {
    let dash = (style == Style::Dashed).then_some([14.0 * u, 9.0 * u]);
    if style != Style::Markers {
        for run in runs {
            field.stroke(run, false, 3.2 * u, colour, dash);
        }
    }
    if matches!(style, Style::Markers | Style::LineMarkers) {
        // Overlapping markers are drawn once: scattered ones by cell, those along a line by
        // distance.
        let total: usize = runs.iter().map(Vec::len).sum();
        let scattered = style == Style::Markers;
        let crowded = total > if scattered { 4000 } else { 60 };
        let mut seen = std::collections::HashSet::new();
        let mut last: Option<[f32; 2]> = None;
        for p in runs.iter().flatten() {
            let cell = [0, 1].map(|i| (p[i] / (2.0 * u)).floor() as i64);
            let far = |q: [f32; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) > 70.0 * u;
            let fresh = if scattered {
                seen.insert(cell)
            } else {
                last.is_none_or(far)
            };
            if !crowded || fresh {
                marker(field, *p, shape, colour, 8.0 * u);
                last = Some(*p);
            }
        }
    }
}

/// A marker with a white rim; its shape follows the index of the series.
fn marker(field: &mut Canvas, [x, y]: [f32; 2], shape: usize, colour: Rgb, radius: f32) {
    for (r, colour) in [(1.28 * radius, WHITE), (radius, colour)] {
        let corners = match shape % 4 {
            0 => {
                field.circle([x, y], r, colour);
                continue;
            }
            1 => 4,
            2 => 3,
            _ => 5,
        };
        let turn = if corners == 4 { 0.5 } else { 0.0 };
        let points: Vec<_> = (0..corners)
            .map(|i| {
                let a = std::f32::consts::TAU * (i as f32 + turn) / corners as f32;
                [x + 1.2 * r * a.sin(), y - 1.2 * r * a.cos()]
            })
            .collect();
        field.polygon(&points, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_points_are_thinned_to_columns() {
        let run: Vec<_> = (0..1_000_000)
            .map(|i| {
                [
                    i as f32 * 1e-3,
                    if i == 500_500 { 9.0 } else { (i % 7) as f32 },
                ]
            })
            .collect();
        let kept = thinned(&run);
        assert!(kept.len() <= 4000, "{}", kept.len());
        assert!(kept.iter().any(|p| p[1] == 9.0), "the peak is lost");
        assert_eq!((kept.first(), kept.last()), (run.first(), run.last()));
    }
}
