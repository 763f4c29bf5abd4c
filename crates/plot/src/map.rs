//! Maps of a contact in space on one page: cells seen along the normal, with axes to one scale, a legend or colour bar, and arrows.

use super::axis::Scale as AxisScale;
use super::canvas::{Canvas, INK, ReportError, Rgb, SOFT_INK, WHITE};
use super::chart::{PAGE, TEXT, wrapped};
use super::font::{Anchor, TextStyle, text_width};
use super::paint::{self, Coloured, Scale, round_top};
use super::zone::{SLIPS, STICKS, zone_entry};
use fretwork_observe::map::{Colours, Map};
use fretwork_observe::picture::Paint;
use fretwork_observe::tractions::Zone;
use std::path::Path;

/// Width of a page in pixels.
const WIDTH: u32 = 2000;
/// Columns of maps.
const COLUMNS: usize = 2;
/// Cells without a force.
const OPEN: Rgb = [231, 232, 235];
/// Length of the longest arrow, and least distance of arrows, over the side of a map.
const ARROW: f32 = 0.07;
const BETWEEN: f32 = 0.035;

/// Draws maps row by row in two columns to one PNG file; without any map there is no file.
///
/// # Errors
/// The file cannot be written.
pub fn draw_maps(maps: &[Map], path: &Path) -> Result<(), ReportError> {
    let Some(first) = maps.first() else {
        return Ok(());
    };
    let u = WIDTH as f32 / PAGE;
    let heading = first.subtitle.clone().unwrap_or_default();
    let lines = wrapped(&heading, 32.0 * u, WIDTH as f32 - 48.0 * u);
    let top = ((18.0 + 40.0 * lines.len() as f32) * u).round() as u32;
    let panel = WIDTH / COLUMNS as u32;
    let frame = Frame::of(maps, panel, u)?;
    let rows = maps.len().div_ceil(COLUMNS) as u32;
    let mut page = Canvas::new(WIDTH, top + rows * frame.size[1])?;
    let bold = TextStyle::new(32.0 * u, INK).bold();
    for (k, line) in lines.iter().enumerate() {
        page.text(line, [24.0 * u, (44.0 + 40.0 * k as f32) * u], &bold);
    }
    for (k, map) in maps.iter().enumerate() {
        let letter = char::from(b'a' + (k % 26) as u8);
        let title = format!("({letter}) {}", map.title);
        let (row, column) = (k / COLUMNS, k % COLUMNS);
        let at = [
            column * panel as usize,
            top as usize + row * frame.size[1] as usize,
        ];
        page.paste(&frame.draw(map, &title, u)?, at[0], at[1]);
    }
    page.save(path)
}

/// What all maps of a page have in common: their size, and where the field is.
struct Frame {
    /// Width and height of a panel in pixels.
    size: [u32; 2],
    left: f32,
    top: f32,
    side: f32,
    axes: [AxisScale; 2],
}

impl Frame {
    fn of(maps: &[Map], width: u32, u: f32) -> Result<Self, ReportError> {
        let [xmin, xmax, ymin, ymax] = maps[0].window;
        let fit = |k: usize, range: (f64, f64)| {
            AxisScale::fit(&maps[0].axes[k], [].into_iter(), Some(range), 5)
        };
        let axes = [fit(0, (xmin, xmax))?, fit(1, (ymin, ymax))?];
        let em = TEXT * u;
        let widths = axes[1].ticks.iter().map(|t| text_width(&t.1, em));
        let left = (widths.fold(0.0, f32::max) + 88.0 * u).round();
        let side = (width as f32 - left - 40.0 * u).round();
        let top = (76.0 * u).round();
        let height = top + side + (116.0 + 116.0) * u;
        Ok(Self {
            size: [width, height.round() as u32],
            left,
            top,
            side,
            axes,
        })
    }

    fn draw(&self, map: &Map, title: &str, u: f32) -> Result<Canvas, ReportError> {
        let mut page = Canvas::new(self.size[0], self.size[1])?;
        let room = self.size[0] as f32 - self.left - 16.0 * u;
        let size = 31.0 * u * (room / text_width(title, 31.0 * u)).min(1.0);
        let bold = TextStyle::new(size, INK).bold();
        page.text(title, [self.left, 50.0 * u], &bold);
        let top = match &map.shows {
            Colours::Zones(_) => 0.0,
            Colours::Values { values, .. } => {
                round_top(values.iter().fold(0.0, |most: f64, v| most.max(*v)))
            }
        };
        let mut field = Canvas::new(self.side as u32, self.side as u32)?;
        for (k, cell) in map.cells.iter().enumerate() {
            let points: Vec<[f32; 2]> = cell.iter().map(|p| self.place(map, *p)).collect();
            let colour = colour(&map.shows, k, top);
            field.polygon(&points, colour);
            // As wide as a pixel, so that no seam shows between neighbours.
            field.stroke(&points, true, 1.0, colour, None);
        }
        self.arrows(&mut field, map, u);
        page.paste(&field, self.left as usize, self.top as usize);
        self.furnish(&mut page, u);
        self.legend(&mut page, map, top, u)?;
        Ok(page)
    }

    /// A place in pixels of the field.
    fn place(&self, map: &Map, p: [f64; 2]) -> [f32; 2] {
        let [xmin, xmax, ymin, ymax] = map.window;
        let x = (p[0] - xmin) / (xmax - xmin);
        let y = (ymax - p[1]) / (ymax - ymin);
        [x, y].map(|share| (share * f64::from(self.side)) as f32)
    }

    /// Arrows that are not too close to each other.
    fn arrows(&self, field: &mut Canvas, map: &Map, u: f32) {
        let mut drawn: Vec<[f32; 2]> = Vec::new();
        for (place, [dx, dy]) in &map.arrows {
            let at = self.place(map, *place);
            let near = |p: &[f32; 2]| (p[0] - at[0]).hypot(p[1] - at[1]) < BETWEEN * self.side;
            if drawn.iter().any(near) {
                continue;
            }
            drawn.push(at);
            let long = ARROW * self.side;
            let by = [*dx as f32 * long, -*dy as f32 * long];
            // Its middle is at the place.
            arrow(field, [at[0] - 0.5 * by[0], at[1] - 0.5 * by[1]], by, u);
        }
    }

    /// Box, ticks and names of the axes.
    fn furnish(&self, page: &mut Canvas, u: f32) {
        let Self {
            left, top, side, ..
        } = *self;
        let em = TEXT * u;
        page.frame([left, top, side, side], 2.0 * u, INK);
        let (bottom, centred) = (top + side, TextStyle::new(em, INK).anchored(Anchor::Middle));
        let [x, y] = &self.axes;
        let on = |scale: &AxisScale, v: f64| {
            side * ((v - scale.range.0) / (scale.range.1 - scale.range.0)) as f32
        };
        for (v, label) in &x.ticks {
            let at = left + on(x, *v);
            page.rect([at - u, bottom, 2.0 * u, 8.0 * u], INK);
            page.text(label, [at, bottom + 1.45 * em], &centred);
        }
        for (v, label) in &y.ticks {
            let at = bottom - on(y, *v);
            page.rect([left - 8.0 * u, at - u, 8.0 * u, 2.0 * u], INK);
            let style = TextStyle::new(em, INK).anchored(Anchor::End);
            page.text(label, [left - 0.6 * em, at + 0.34 * em], &style);
        }
        let name = TextStyle::new(30.0 * u, INK).anchored(Anchor::Middle);
        page.text(&x.label, [left + side / 2.0, bottom + 88.0 * u], &name);
        page.text(&y.label, [42.0 * u, top + side / 2.0], &name.upwards());
    }

    fn legend(&self, page: &mut Canvas, map: &Map, top: f64, u: f32) -> Result<(), ReportError> {
        let (em, row) = (TEXT * u, self.top + self.side + 142.0 * u);
        match &map.shows {
            Colours::Values { scale, .. } => {
                let scale = Scale {
                    label: scale.name.clone(),
                    unit: scale.unit.clone(),
                    top,
                    bonds: false,
                };
                paint::scale(page, &scale, [self.left - 0.5 * em, row], 250.0, u)?;
            }
            Colours::Zones(zones) => {
                let entries = [
                    (Zone::Stick, "sticks", STICKS),
                    (Zone::Slip, "slips", SLIPS),
                    (Zone::Open, "open", OPEN),
                ];
                let mut x = self.left;
                for (_, label, colour) in entries.iter().filter(|e| zones.contains(&e.0)) {
                    x = zone_entry(page, label, *colour, [x, row], u);
                    x += text_width(label, em) + 40.0 * u;
                }
                if !map.arrows.is_empty() {
                    let (row, long) = (row + 48.0 * u, ARROW * self.side);
                    arrow(page, [self.left, row], [long, 0.0], u);
                    let at = [self.left + long + 14.0 * u, row + 0.34 * em];
                    page.text(&map.arrow_label, at, &TextStyle::new(em, SOFT_INK));
                }
            }
        }
        Ok(())
    }
}

fn colour(shows: &Colours, cell: usize, top: f64) -> Rgb {
    match shows {
        Colours::Zones(zones) => match zones[cell] {
            Zone::Open => OPEN,
            Zone::Stick => STICKS,
            Zone::Slip => SLIPS,
        },
        Colours::Values { values, .. } if values[cell].is_nan() => OPEN,
        Colours::Values { values, .. } => Paint::Value(values[cell] / top).colour(0.0),
    }
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
    use super::*;
    use crate::canvas::png_size;
    use fretwork_observe::chart::Axis;

    fn map(shows: Colours) -> Map {
        let square = |x: f64| vec![[x, 0.0], [x + 1e-3, 0.0], [x + 1e-3, 2e-3], [x, 2e-3]];
        Map {
            title: "Stick and slip, flat".to_owned(),
            subtitle: Some("case".to_owned()),
            axes: ["position x", "position y"].map(|name| Axis::new(name, "m")),
            window: [0.0, 2e-3, 0.0, 2e-3],
            cells: vec![square(0.0), square(1e-3)],
            shows,
            arrows: vec![([1.5e-3, 1e-3], [1.0, 0.0])],
            arrow_label: "shear, longest 1 MPa".to_owned(),
        }
    }

    #[test]
    fn what_slips_and_what_sticks_have_their_colours() {
        let name = format!("fretwork-maps-{}.png", std::process::id());
        let path = std::env::temp_dir().join(name);
        draw_maps(&[], &path).unwrap();
        assert!(!path.exists());
        let values = Colours::Values {
            values: vec![f64::NAN, 3e6],
            scale: Axis::new("pressure", "Pa"),
        };
        let zones = Colours::Zones(vec![Zone::Stick, Zone::Slip]);
        draw_maps(&[map(zones), map(values)], &path).unwrap();
        assert_eq!(png_size(&path).0, WIDTH);
        let picture = tiny_skia::Pixmap::load_png(&path).unwrap();
        let count = |c: Rgb| {
            let same = |p: &&tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()] == c;
            picture.pixels().iter().filter(same).count()
        };
        // Each is half of a map, but for the arrow and the samples of the legend.
        let [sticks, slips] = [STICKS, SLIPS].map(|c| count(c) as f64);
        assert!(
            slips > 1e5 && (sticks / slips - 1.0).abs() < 0.05,
            "{sticks} {slips}"
        );
        std::fs::remove_file(path).unwrap();
    }
}
