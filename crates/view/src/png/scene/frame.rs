//! Elements around the field of a picture: legend, scale bar, caption.

use fretwork_observe::chart::quantity;
use tiny_skia::PathBuilder;

use super::paint::{DAMAGED, SOUND};
use super::{BROKEN, CHAIN, Link, LinkState, PLAIN};
use crate::png::canvas::{Canvas, INK, TEXT, mix};
use crate::png::font::{Anchor, TextStyle, text_width};

/// Draws the legend of the link colours that are present, from a point on the middle of the line;
/// returns where the legend ends.
pub(crate) fn legend(page: &mut Canvas, links: &[Link], [left, middle]: [f32; 2], u: f32) -> f32 {
    let em = TEXT * u;
    let has = |of: fn(&LinkState) -> bool| links.iter().any(|l| of(&l.state));
    let damaged = has(|s| matches!(s, LinkState::Intact { damage } if *damage > 0.0));
    let bond = "intact bond";
    let last = if damaged { DAMAGED } else { SOUND };
    let entries = [
        (
            has(|s| matches!(s, LinkState::Intact { .. })),
            bond,
            [SOUND, last],
            7.0,
        ),
        (
            has(|s| *s == LinkState::Broken),
            "broken bond",
            [BROKEN; 2],
            7.0,
        ),
        (
            has(|s| *s == LinkState::Chain),
            "force chain",
            [CHAIN; 2],
            7.0,
        ),
        (
            has(|s| *s == LinkState::Plain),
            "contact, width by its force",
            [PLAIN; 2],
            3.0,
        ),
    ];
    let mut x = left;
    for (_, label, ends, thick) in entries.into_iter().filter(|e| e.0) {
        let length = (56.0 * u).round();
        for i in 0..length as i32 {
            let colour = mix(ends[0], ends[1], f64::from(i) / f64::from(length));
            page.rect(
                [x + i as f32, middle - thick * u / 2.0, 1.0, thick * u],
                colour,
            );
        }
        x += length + 14.0 * u;
        page.text(label, [x, middle + 0.34 * em], &TextStyle::new(em, INK));
        x = (x + text_width(label, em) + 40.0 * u).round();
    }
    x
}

/// Draws a scale bar of round length that ends at a point; `scale` in pixels per metre.
pub(crate) fn scale_bar(page: &mut Canvas, [right, middle]: [f32; 2], scale: f64, u: f32) {
    let (metres, label) = round_length(190.0 * f64::from(u) / scale);
    let length = (metres * scale) as f32;
    let (left, thick) = (right - length, 3.0 * u);
    page.rect([left, middle - thick / 2.0, length, thick], INK);
    for x in [left, right - thick] {
        page.rect([x, middle - 8.0 * u, thick, 16.0 * u], INK);
    }
    let style = TextStyle::new(TEXT * u, INK).anchored(Anchor::End);
    page.text(&label, [left - 14.0 * u, middle + 0.34 * TEXT * u], &style);
}

/// The largest of 1, 2, 5 times a power of ten not above a length in metres.
fn round_length(longest: f64) -> (f64, String) {
    let power = longest.log10().floor();
    let factor = match longest / 10f64.powf(power) {
        r if r >= 5.0 => 5.0,
        r if r >= 2.0 => 2.0,
        _ => 1.0,
    };
    let metres = factor * 10f64.powf(power);
    (metres, quantity(metres, "m", 1))
}

/// Adds a straight bar to a path. All bars have the same winding, so that crossing ones do not cut
/// holes into each other.
pub(crate) fn push_bar(path: &mut PathBuilder, a: [f32; 2], b: [f32; 2], width: f32) {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy);
    if !(length > 0.0 && length.is_finite()) {
        return;
    }
    let (nx, ny) = (-dy / length * width / 2.0, dx / length * width / 2.0);
    path.move_to(a[0] + nx, a[1] + ny);
    path.line_to(b[0] + nx, b[1] + ny);
    path.line_to(b[0] - nx, b[1] - ny);
    path.line_to(a[0] - nx, a[1] - ny);
    path.close();
}

/// Centroid of a polygon with an area.
pub(crate) fn centroid(points: &[[f32; 2]]) -> Option<[f32; 2]> {
    let (mut area, mut sum) = (0.0, [0.0, 0.0]);
    for (i, b) in points.iter().enumerate() {
        let a = points[(i + points.len() - 1) % points.len()];
        let cross = a[0] * b[1] - b[0] * a[1];
        area += 3.0 * cross;
        sum = [
            sum[0] + cross * (a[0] + b[0]),
            sum[1] + cross * (a[1] + b[1]),
        ];
    }
    (area != 0.0).then(|| [sum[0] / area, sum[1] / area])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        assert_eq!(round_length(6.3e-5).1, "50 µm");
        assert_eq!(round_length(2.1e-3).1, "2 mm");
        assert_eq!(round_length(1.0e-6).1, "1 µm");
        assert_eq!(round_length(3.0e-8).1, "20 nm");
    }
}
