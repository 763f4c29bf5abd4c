//! Coloured cells of a chart with arrows over them, and their legend or colour bar.

use super::Layout;
use crate::png::canvas::{Canvas, DrawError, INK, Rgb, SOFT_INK, TEXT, WHITE};
use crate::png::font::{TextStyle, text_width};
use crate::png::scene::paint::{ColourScale, Coloured, colour_bar};
use crate::png::scene::zone::zone_entry;
use fretwork_observe::chart::{Colours, FieldMap};
use fretwork_observe::picture::{OPEN_COLOUR, Paint};

/// Length of the longest arrow, and least distance between arrows, relative to the side of a plot.
const ARROW: f32 = 0.07;
const BETWEEN: f32 = 0.035;

impl Layout<'_> {
    /// Draws the cells and the arrows, which keep a distance from each other.
    pub fn draw_field(&self, page: &mut Canvas) {
        let Some(field) = &self.chart.field else {
            return;
        };
        let (top, side) = (field.top(), self.plot.width as f32);
        let place = |[x, y]: [f32; 2]| self.place((x.into(), y.into()));
        for (k, cell) in field.cells.iter().enumerate() {
            let points: Vec<[f32; 2]> = cell.iter().map(|p| place(*p)).collect();
            let colour = colour(field, k, top);
            page.polygon(&points, colour);
            // The outline is one pixel wide, so that no seam shows between neighbours.
            page.stroke(&points, true, 1.0, colour, None);
        }
        let mut drawn: Vec<[f32; 2]> = Vec::new();
        for (from, [dx, dy]) in &field.arrows {
            let at = place(*from);
            let near = |p: &[f32; 2]| (p[0] - at[0]).hypot(p[1] - at[1]) < BETWEEN * side;
            if drawn.iter().any(near) {
                continue;
            }
            drawn.push(at);
            let by = [dx * ARROW * side, -dy * ARROW * side];
            // The middle of an arrow is at its point.
            let tail = [at[0] - 0.5 * by[0], at[1] - 0.5 * by[1]];
            arrow(page, tail, by, self.u);
        }
    }

    /// Draws the meaning of the colours and the arrows below the axis.
    pub fn field_legend(&self, page: &mut Canvas) -> Result<(), DrawError> {
        let Some(field) = &self.chart.field else {
            return Ok(());
        };
        let (u, em) = (self.u, TEXT * self.u);
        let [left, top, width, height] = self.box_px();
        let row = top + height + 142.0 * u;
        if let Colours::Values { scale, .. } = &field.colours {
            let scale = ColourScale {
                label: scale.name.clone(),
                unit: scale.unit.clone(),
                top: field.top(),
                bonds: false,
            };
            colour_bar(page, &scale, [left - 0.5 * em, row], 250.0, u)?;
        }
        let mut x = left;
        for (label, (r, g, b)) in field.classes() {
            x = zone_entry(page, label, [*r, *g, *b], [x, row], u);
            x += text_width(label, em) + 40.0 * u;
        }
        if !field.arrows.is_empty() {
            let (row, long) = (row + 48.0 * u, ARROW * width);
            arrow(page, [left, row], [long, 0.0], u);
            let at = [left + long + 14.0 * u, row + 0.34 * em];
            page.text(&field.arrow_label, at, &TextStyle::new(em, SOFT_INK));
        }
        Ok(())
    }
}

/// Colour of a cell, for values up to `top`.
fn colour(field: &FieldMap, cell: usize, top: f64) -> Rgb {
    let (r, g, b) = match &field.colours {
        Colours::Classes { classes, of } => classes[of[cell]].1,
        Colours::Values { values, .. } if values[cell].is_nan() => OPEN_COLOUR,
        Colours::Values { values, .. } => return Paint::Value(values[cell] / top).colour(0.0),
    };
    [r, g, b]
}

/// A small arrow with a white rim, from a place by a distance in pixels.
fn arrow(field: &mut Canvas, from: [f32; 2], [dx, dy]: [f32; 2], u: f32) {
    let length = dx.hypot(dy);
    if !(length > 5.0 * u && length.is_finite()) {
        return;
    }
    let (x, y) = (dx / length, dy / length);
    let head = (13.0 * u).min(0.6 * length);
    let at = |along: f32, aside: f32| {
        [
            from[0] + along * x - aside * y,
            from[1] + along * y + aside * x,
        ]
    };
    let neck = length - head;
    let tip = [at(length, 0.0), at(neck, 0.4 * head), at(neck, -0.4 * head)];
    field.stroke(&[from, at(neck, 0.0)], false, 6.0 * u, WHITE, None);
    field.stroke(&tip, true, 3.0 * u, WHITE, None);
    field.stroke(&[from, at(neck, 0.0)], false, 2.6 * u, INK, None);
    field.polygon(&tip, INK);
}

#[cfg(test)]
mod tests {
    use super::super::{WIDTH, draw_panels};
    use super::*;
    use crate::png::canvas::png_size;
    use fretwork_observe::chart::{Axis, Chart};
    use fretwork_observe::picture::{SLIP_COLOUR, STICK_COLOUR};

    fn chart(colours: Colours) -> Chart {
        let square = |x: f32| vec![[x, 0.0], [x + 1e-3, 0.0], [x + 1e-3, 2e-3], [x, 2e-3]];
        let [x, y] = ["position x", "position y"].map(|name| Axis::new(name, "m"));
        let mut chart = Chart::new("Stick and slip, flat", x, y);
        chart.subtitle = Some("case".to_owned());
        (chart.x_range, chart.y_range) = (Some((0.0, 2e-3)), Some((0.0, 2e-3)));
        chart.field = Some(FieldMap {
            cells: vec![square(0.0), square(1e-3)],
            colours,
            arrows: vec![([1.5e-3, 1e-3], [1.0, 0.0])],
            arrow_label: "shear, longest 1 MPa".to_owned(),
        });
        chart
    }

    #[test]
    fn cells_of_two_classes_have_their_colours() {
        let name = format!("fretwork-cells-{}.png", std::process::id());
        let path = std::env::temp_dir().join(name);
        let values = Colours::Values {
            values: vec![f64::NAN, 3e6],
            scale: Axis::new("pressure", "Pa"),
        };
        let classes = [("sticks", STICK_COLOUR), ("slips", SLIP_COLOUR)];
        let zones = Colours::Classes {
            classes: classes
                .map(|(name, colour)| (name.to_owned(), colour))
                .to_vec(),
            of: vec![0, 1],
        };
        draw_panels(&[chart(zones), chart(values)], 2, &path).unwrap();
        assert_eq!(png_size(&path).0, WIDTH);
        let picture = tiny_skia::Pixmap::load_png(&path).unwrap();
        let count = |(r, g, b)| {
            let pixels = picture.pixels().iter();
            let same = pixels.filter(|p| [p.red(), p.green(), p.blue()] == [r, g, b]);
            same.count()
        };
        // Each zone takes half of the plot, except for the arrow and the samples of the legend.
        let [sticks, slips] = [STICK_COLOUR, SLIP_COLOUR].map(|c| count(c) as f64);
        assert!(
            slips > 1e5 && (sticks / slips - 1.0).abs() < 0.05,
            "{sticks} {slips}"
        );
        std::fs::remove_file(path).unwrap();
    }
}
