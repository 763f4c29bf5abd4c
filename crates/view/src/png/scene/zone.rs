//! Sticking and slipping zones along surfaces: bands over a picture, and their legend.

use super::frame::push_bar;
use crate::png::canvas::{Canvas, INK, Rgb, TEXT};
use crate::png::font::{TextStyle, text_width};
use fretwork_observe::picture;
use tiny_skia::PathBuilder;

const STICKS: Rgb = rgb(picture::STICK_COLOUR);
const SLIPS: Rgb = rgb(picture::SLIP_COLOUR);

const fn rgb((r, g, b): (u8, u8, u8)) -> Rgb {
    [r, g, b]
}

/// A part of the surface of a deformable body, with the body on its right.
#[derive(Clone, Copy, Debug)]
pub struct ZoneLine {
    /// One end, metres.
    pub a: [f64; 2],
    /// Other end, metres.
    pub b: [f64; 2],
    /// Whether this part slips. Otherwise it sticks.
    pub slips: bool,
}

/// Draws a band inside each body along its surface, with a dark rim that sets it off from any
/// colour; `point` returns the pixels of a position.
pub(crate) fn draw(
    field: &mut Canvas,
    lines: &[ZoneLine],
    point: impl Fn([f64; 2]) -> [f32; 2],
    u: f32,
) {
    let (wide, rim) = (9.0 * u, 2.0 * u);
    let mut paths: [_; 3] = std::array::from_fn(|_| PathBuilder::new());
    for line in lines {
        let (a, b) = (point(line.a), point(line.b));
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if !(length > 0.0 && length.is_finite()) {
            continue;
        }
        // The direction is to the right of the line, in pixels with y downwards.
        let (x, y) = (dx / length, dy / length);
        let shifted = |p: [f32; 2], more: f32, aside: f32| {
            [p[0] + more * x - aside * y, p[1] + more * y + aside * x]
        };
        let aside = rim + 0.5 * wide;
        // The bar is a little longer than the line, so that no seam shows.
        let bar = |path: &mut PathBuilder, more: f32, width: f32| {
            let ends = [shifted(a, -more, aside), shifted(b, more, aside)];
            push_bar(path, ends[0], ends[1], width);
        };
        bar(&mut paths[0], rim, wide + 2.0 * rim);
        bar(&mut paths[1 + usize::from(line.slips)], 0.5, wide);
    }
    for (path, colour) in paths.into_iter().zip([INK, STICKS, SLIPS]) {
        if let Some(path) = path.finish() {
            field.fill_path(&path, colour);
        }
    }
}

/// Draws the legend of the zones that are present, from a point on the middle of the line.
pub(crate) fn legend(page: &mut Canvas, lines: &[ZoneLine], [left, middle]: [f32; 2], u: f32) {
    let (em, mut x) = (TEXT * u, left);
    for (slips, label, colour) in [(false, "sticks", STICKS), (true, "slips", SLIPS)] {
        if lines.iter().any(|z| z.slips == slips) {
            x = zone_entry(page, label, colour, [x, middle], u);
            x = (x + text_width(label, em) + 40.0 * u).round();
        }
    }
}

/// Draws a sample of a zone with a rim and its label; returns where the label begins.
pub(crate) fn zone_entry(
    page: &mut Canvas,
    label: &str,
    colour: Rgb,
    [left, middle]: [f32; 2],
    u: f32,
) -> f32 {
    let (length, high, rim, em) = (56.0 * u, 14.0 * u, 2.5 * u, TEXT * u);
    page.rect(
        [left, middle - 0.5 * high - rim, length, high + 2.0 * rim],
        INK,
    );
    let inner = [left + rim, middle - 0.5 * high, length - 2.0 * rim, high];
    page.rect(inner, colour);
    let x = left + length + 14.0 * u;
    page.text(label, [x, middle + 0.34 * em], &TextStyle::new(em, INK));
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_inside_of_bodies_below_and_above_their_surface() {
        let mut field = Canvas::new(200, 100).unwrap();
        // Towards +x the body is below, towards -x above, with y upwards.
        let line = |from: f64, to: f64, slips| ZoneLine {
            a: [from, 50.0],
            b: [to, 50.0],
            slips,
        };
        let lines = [line(10.0, 90.0, false), line(190.0, 110.0, true)];
        draw(
            &mut field,
            &lines,
            |p| [p[0] as f32, 100.0 - p[1] as f32],
            1.0,
        );
        let at = |x: u32, y: u32| {
            let p = field.pixmap.pixel(x, y).unwrap();
            [p.red(), p.green(), p.blue()]
        };
        assert_eq!([at(50, 56), at(50, 44)], [STICKS, [255; 3]]);
        assert_eq!([at(150, 44), at(150, 56)], [SLIPS, [255; 3]]);
    }
}
