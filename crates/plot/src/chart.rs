//! Draws charts of curves.

use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::axis::Scale;
use super::canvas::{Canvas, INK, ReportError, Rgb, SOFT_INK};
use super::curve::{PALETTE, draw_series, gradient, thinned};
use super::font::{Anchor, TextStyle as Text, text_width};
use super::legend::{Legend, Rows};
use fretwork_observe::chart::{Chart, Series};

/// Width of a page in layout units. Text is 28 units high: 9 pt if the page is printed 16 cm wide.
pub(super) const PAGE: f32 = 1400.0;
/// Height of text in layout units.
pub(super) const TEXT: f32 = 28.0;

/// Polylines in pixels of the plot; a gap starts a new one.
pub(super) type Runs = Vec<Vec<[f32; 2]>>;

/// Rectangle in pixels of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plot {
    pub left: i32,
    pub top: i32,
    pub width: i32,
    pub height: i32,
}

impl Plot {
    /// Position of a point in pixels of the plot.
    fn place(&self, x: &Scale, y: &Scale, p: (f64, f64)) -> [f32; 2] {
        let across = |scale: &Scale, value: f64, length: i32| {
            let (a, b) = scale.range;
            ((scale.shown(value) - a) / (b - a) * f64::from(length)).clamp(-1e6, 1e6)
        };
        let (h, v) = (across(x, p.0, self.width), across(y, p.1, self.height));
        [h as f32, (f64::from(self.height) - v) as f32]
    }
}

/// Wraps text into lines of a width, broken at spaces.
pub(super) fn wrapped(text: &str, size: f32, room: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Draws a chart.
pub trait DrawChart {
    /// Draws the chart to a PNG file; writes no file if there is nothing to show.
    ///
    /// # Errors
    /// The file cannot be written, or the range or size of the chart cannot be drawn.
    fn draw(&self, path: &Path) -> Result<(), ReportError>;
}

impl DrawChart for Chart {
    fn draw(&self, path: &Path) -> Result<(), ReportError> {
        if !self.has_data() {
            return Ok(());
        }
        Sheet(self).page(self.size_px.0)?.save(path)
    }
}

/// A chart during layout.
pub(super) struct Sheet<'a>(pub &'a Chart);

impl std::ops::Deref for Sheet<'_> {
    type Target = Chart;

    fn deref(&self) -> &Chart {
        self.0
    }
}

impl Sheet<'_> {
    /// Values along the vertical axis that must be visible: points and intervals.
    fn heights(&self) -> impl Iterator<Item = f64> + '_ {
        let points = self.series.iter().flat_map(|s| &s.points);
        let ends = self.series.iter().flat_map(|s| {
            let with = s.points.iter().zip(&s.intervals);
            with.filter(|(p, i)| self.shows(p) && i.0.is_finite() && i.1.is_finite())
                .flat_map(|(_, i)| [i.0, i.1])
        });
        points.filter(|p| self.shows(p)).map(|p| p.1).chain(ends)
    }

    /// Draws the chart as part of a page whose width in pixels sets the size of text and lines.
    pub(super) fn page(&self, page_width: u32) -> Result<Canvas, ReportError> {
        let (width, height) = self.size_px;
        if width.min(height) < 200 {
            return Err(ReportError::Size { width, height });
        }
        let mut page = Canvas::new(width, height)?;
        let u = page_width as f32 / PAGE;
        let em = TEXT * u;
        let (wide, high) = (width as f32, height as f32);

        let points = || self.series.iter().flat_map(|s| &s.points);
        let ticks_x = ((wide / em - 5.0) / 5.0) as usize;
        let ticks_y = ((high / em - 7.0) / 2.6) as usize;
        let xs = points().filter(|p| self.shows(p)).map(|p| p.0);
        let x = Scale::fit(&self.x, xs, self.x_range, ticks_x.clamp(2, 8))?;
        let y = Scale::fit(&self.y, self.heights(), self.y_range, ticks_y.clamp(2, 8))?;

        let widest = |scale: &Scale| {
            let widths = scale.ticks.iter().map(|t| text_width(&t.1, em));
            widths.fold(0.0, f32::max)
        };
        let left = widest(&y) + 88.0 * u;
        let right = (widest(&x) / 2.0 + 12.0 * u).max(36.0 * u);
        let top = self.header(wide - left - 16.0 * u, u).1;
        let closest_point = 116.0 * u;
        let mut plot = Plot {
            left: left as i32,
            top: top as i32,
            width: ((wide - left - right) as i32).max(20),
            height: ((high - top - closest_point) as i32).max(20),
        };

        // The legend is placed where no curve passes, otherwise in rows above the plot.
        let mut curves = self.curves(&x, &y, &plot);
        let legend = Legend::of(self, u);
        let mut ink = curves.clone();
        ink.push(self.bars(&x, &y, &plot));
        let corner = legend.as_ref().and_then(|l| l.free_place(&ink, &plot, u));
        let mut rows = None;
        if legend.is_some() && corner.is_none() {
            let laid = Rows::of(self, plot.width as f32, u);
            let room = (laid.height as i32).min(plot.height / 2);
            (plot.top, plot.height) = (plot.top + room, plot.height - room);
            curves = self.curves(&x, &y, &plot);
            rows = Some(laid);
        }

        grid(&mut page, &plot, &x, &y, u)?;
        let mut field = Canvas::clear(plot.width as u32, plot.height as u32)?;
        for (i, (series, runs)) in self.series.iter().zip(&curves).enumerate() {
            self.draw_intervals(&mut field, i, &x, &y, &plot, u);
            draw_series(&mut field, runs, series.style, self.colour(i), i, u);
        }
        page.lay(&field, plot.left, plot.top);
        self.write(&mut page, &plot, &x, &y, u);
        if let (Some(legend), Some(corner)) = (&legend, corner) {
            legend.draw(self, &mut page, corner, u);
        }
        if let Some(rows) = &rows {
            rows.draw(self, &mut page, [plot.left as f32, top], u);
        }
        Ok(page)
    }

    /// Lines of the heading with their sizes, wrapped to a width, and the total height.
    fn header(&self, room: f32, u: f32) -> (Vec<(String, f32, bool)>, f32) {
        let mut lines = Vec::new();
        if !self.title.is_empty() {
            for line in wrapped(&self.title, 31.0 * u, room) {
                lines.push((line, 31.0 * u, true));
            }
        }
        for text in self.subtitle.iter().filter(|t| !t.is_empty()) {
            for line in wrapped(text, TEXT * u, room) {
                lines.push((line, TEXT * u, false));
            }
        }
        let height = 34.0 * u + lines.len() as f32 * 40.0 * u;
        (lines, height)
    }

    /// Error bars of a series from low to high, in pixels of the plot.
    fn bars_of(&self, series: &Series, x: &Scale, y: &Scale, plot: &Plot) -> Runs {
        let with = series.points.iter().zip(&series.intervals);
        let bars = with.map(|(p, (low, high))| {
            vec![
                plot.place(x, y, (p.0, *low)),
                plot.place(x, y, (p.0, *high)),
            ]
        });
        bars.filter(|b| b.iter().flatten().all(|v| v.is_finite()))
            .collect()
    }

    fn bars(&self, x: &Scale, y: &Scale, plot: &Plot) -> Runs {
        let all = self.series.iter();
        all.flat_map(|s| self.bars_of(s, x, y, plot)).collect()
    }

    /// Draws the error bars of a series with caps.
    fn draw_intervals(
        &self,
        field: &mut Canvas,
        series: usize,
        x: &Scale,
        y: &Scale,
        plot: &Plot,
        u: f32,
    ) {
        let colour = self.colour(series);
        for bar in self.bars_of(&self.series[series], x, y, plot) {
            field.stroke(&bar, false, 2.4 * u, colour, None);
            for [at, end] in bar {
                let cap = [[at - 10.0 * u, end], [at + 10.0 * u, end]];
                field.stroke(&cap, false, 2.4 * u, colour, None);
            }
        }
    }

    pub(super) fn colour(&self, index: usize) -> Rgb {
        match self.series[index].colour {
            Some((r, g, b)) => [r, g, b],
            None if self.colour_by_order => {
                gradient(index as f64 / (self.series.len().max(2) - 1) as f64)
            }
            None => PALETTE[index % PALETTE.len()],
        }
    }

    /// All series in pixels of the plot, thinned to the pixel resolution.
    fn curves(&self, x: &Scale, y: &Scale, plot: &Plot) -> Vec<Runs> {
        let place = |p: &(f64, f64)| plot.place(x, y, *p);
        self.series
            .iter()
            .map(|s| {
                let mut runs: Runs = vec![Vec::new()];
                for (raw, p) in s.points.iter().map(|raw| (raw, place(raw))) {
                    let finite = [raw.0, raw.1, f64::from(p[0]), f64::from(p[1])]
                        .iter()
                        .all(|v| v.is_finite());
                    match runs.last_mut() {
                        Some(run) if finite => run.push(p),
                        Some(run) if !run.is_empty() => runs.push(Vec::new()),
                        _ => {}
                    }
                }
                let many = s.points.len() > 4 * plot.width as usize;
                runs.into_iter()
                    .filter(|run| !run.is_empty())
                    .map(|run| if many { thinned(&run) } else { run })
                    .collect()
            })
            .collect()
    }

    /// Heading, tick labels and axis names.
    fn write(&self, page: &mut Canvas, plot: &Plot, x: &Scale, y: &Scale, u: f32) {
        let em = TEXT * u;
        let (left, top) = (plot.left as f32, plot.top as f32);
        let (width, height) = (plot.width as f32, plot.height as f32);
        let bottom = top + height;
        let room = page.pixmap.width() as f32 - 16.0 * u - left;
        for (k, (line, size, bold)) in self.header(room, u).0.iter().enumerate() {
            let size = size * (room / text_width(line, *size)).min(1.0);
            let style = match bold {
                true => Text::new(size, INK).bold(),
                false => Text::new(size, SOFT_INK),
            };
            page.text(line, [left, 44.0 * u + k as f32 * 40.0 * u], &style);
        }
        let on =
            |scale: &Scale, v: f64| ((v - scale.range.0) / (scale.range.1 - scale.range.0)) as f32;
        let centred = Text::new(em, INK).anchored(Anchor::Middle);
        for (v, label) in &x.ticks {
            page.text(
                label,
                [left + width * on(x, *v), bottom + 1.25 * em],
                &centred,
            );
        }
        for (v, label) in &y.ticks {
            let at = [left - 0.5 * em, bottom - height * on(y, *v) + 0.34 * em];
            page.text(label, at, &Text::new(em, INK).anchored(Anchor::End));
        }
        // A long axis name may extend beyond the plot before its size is reduced.
        let fit = |text: &str, room: f32| {
            let size = 30.0 * u;
            size * (room / text_width(text, size)).min(1.0)
        };
        let name = Text::new(fit(&x.label, width + left), INK).anchored(Anchor::Middle);
        let half = text_width(&x.label, name.size) / 2.0;
        let end = page.pixmap.width() as f32 - 10.0 * u - half;
        let at = (left + width / 2.0).min(end).max(half);
        page.text(&x.label, [at, bottom + 88.0 * u], &name);
        let high = page.pixmap.height() as f32;
        let name = Text::new(fit(&y.label, high - 20.0 * u), INK)
            .anchored(Anchor::Middle)
            .upwards();
        let half = text_width(&y.label, name.size) / 2.0;
        let at = (top + height / 2.0)
            .max(half + 8.0 * u)
            .min((high - half - 8.0 * u).max(half));
        page.text(&y.label, [42.0 * u, at], &name);
    }
}

/// Background, grid, box and ticks of the plot.
fn grid(page: &mut Canvas, plot: &Plot, x: &Scale, y: &Scale, u: f32) -> Result<(), ReportError> {
    type Area<'a> = DrawingArea<BitMapBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
    let (width, height) = (page.pixmap.width(), page.pixmap.height());
    let mut rgb = vec![255; 3 * width as usize * height as usize];
    let draw = |rgb: &mut [u8]| -> Result<(), Box<dyn std::error::Error>> {
        let root: DrawingArea<_, Shift> =
            BitMapBackend::with_buffer(rgb, (width, height)).into_drawing_area();
        let (right, bottom) = (plot.left + plot.width, plot.top + plot.height);
        let area: Area = root.apply_coord_spec(Cartesian2d::new(
            x.range.0..x.range.1,
            y.range.0..y.range.1,
            (plot.left..right, bottom..plot.top),
        ));
        let thick = |width: f32| (width * u).round().max(1.0) as u32;
        let light = RGBColor(226, 229, 233).stroke_width(thick(1.2));
        let dark = RGBColor(INK[0], INK[1], INK[2]).stroke_width(thick(2.0));
        let ((x0, x1), (y0, y1)) = (x.range, y.range);
        let vertical = x.ticks.iter().map(|t| [(t.0, y0), (t.0, y1)]);
        let across = y.ticks.iter().map(|t| [(x0, t.0), (x1, t.0)]);
        for line in vertical.chain(across) {
            area.draw(&PathElement::new(line.to_vec(), light))?;
        }
        // Ticks point inwards on the four sides, as in print.
        let (tx, ty) = (
            f64::from(9.0 * u) * (x1 - x0) / f64::from(plot.width),
            f64::from(9.0 * u) * (y1 - y0) / f64::from(plot.height),
        );
        for (t, _) in &x.ticks {
            for (from, to) in [(y0, y0 + ty), (y1, y1 - ty)] {
                area.draw(&PathElement::new(vec![(*t, from), (*t, to)], dark))?;
            }
        }
        for (t, _) in &y.ticks {
            for (from, to) in [(x0, x0 + tx), (x1, x1 - tx)] {
                area.draw(&PathElement::new(vec![(from, *t), (to, *t)], dark))?;
            }
        }
        for t in &x.minor {
            for (from, to) in [(y0, y0 + 0.5 * ty), (y1, y1 - 0.5 * ty)] {
                area.draw(&PathElement::new(vec![(*t, from), (*t, to)], dark))?;
            }
        }
        for t in &y.minor {
            for (from, to) in [(x0, x0 + 0.5 * tx), (x1, x1 - 0.5 * tx)] {
                area.draw(&PathElement::new(vec![(from, *t), (to, *t)], dark))?;
            }
        }
        let corners = vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)];
        area.draw(&PathElement::new(corners, dark))?;
        area.present()?;
        Ok(())
    };
    draw(&mut rgb).map_err(|e| ReportError::Grid(e.to_string()))?;
    let pixels = page.pixmap.data_mut().chunks_exact_mut(4);
    for (to, from) in pixels.zip(rgb.chunks_exact(3)) {
        to[..3].copy_from_slice(from);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::png_size;
    use fretwork_observe::chart::{Axis, Style};

    fn file(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("fretwork-chart-{}-{name}.png", std::process::id()))
    }

    fn chart() -> Chart {
        Chart::new(
            "Title",
            Axis::new("displacement δ", "m"),
            Axis::new("load Q", "N"),
        )
    }

    #[test]
    fn any_data_gives_a_picture_of_the_stated_size() {
        let cases = [
            ("empty", vec![]),
            ("one", vec![(1.0, 2.0)]),
            ("constant", vec![(0.0, 3.0), (1.0, 3.0)]),
            (
                "gaps",
                vec![
                    (0.0, 1.0),
                    (f64::NAN, 2.0),
                    (1.0, f64::INFINITY),
                    (2.0, 0.0),
                ],
            ),
            ("nothing-finite", vec![(f64::NAN, f64::NAN)]),
        ];
        for (name, points) in cases {
            for style in [
                Style::Line,
                Style::Dashed,
                Style::Markers,
                Style::LineMarkers,
            ] {
                let mut chart = chart().with(Series::new(name, points.clone()).style(style));
                chart.size_px = (420, 300);
                let path = file(name);
                chart.draw(&path).unwrap();
                // No file is written if there is nothing to show.
                let empty = ["empty", "nothing-finite"].contains(&name);
                assert_eq!(path.exists(), !empty, "{name}");
                if !empty {
                    assert_eq!(png_size(&path), (420, 300));
                    std::fs::remove_file(path).unwrap();
                }
            }
        }
    }

    #[test]
    fn errors_name_what_to_change() {
        let drawn = chart().with(Series::new("a", vec![(0.0, 1.0)]));
        let error = drawn.draw(Path::new("no-such-folder/a.png")).unwrap_err();
        assert!(
            error.to_string().contains("no-such-folder/a.png"),
            "{error}"
        );
        let mut upside_down = drawn;
        upside_down.x_range = Some((1.0, 0.0));
        let error = upside_down.draw(&file("range")).unwrap_err();
        assert!(error.to_string().contains("displacement δ"), "{error}");
    }

    #[test]
    fn grid_lies_where_the_labels_are_written() {
        let axis = Axis::default();
        let x = Scale::fit(&axis, [].into_iter(), Some((0.0, 1.0)), 5).unwrap();
        let y = Scale::fit(&axis, [].into_iter(), Some((0.9, 2.9)), 2).unwrap();
        let plot = Plot {
            left: 20,
            top: 10,
            width: 200,
            height: 200,
        };
        let mut page = Canvas::new(240, 240).unwrap();
        grid(&mut page, &plot, &x, &y, 0.5).unwrap();
        let grey = |row: u32| page.pixmap.pixel(50, row).unwrap().red() < 240;
        for (tick, _) in &y.ticks {
            let row = 210 - ((tick - 0.9) / 2.0 * 200.0).round() as u32;
            assert!((row - 1..=row + 1).any(grey), "no line at {tick}");
        }
    }

    #[test]
    fn gaps_split_the_line() {
        let points = vec![(0.0, 0.0), (1.0, 1.0), (f64::NAN, 0.0), (2.0, 0.0)];
        let chart = chart().with(Series::new("a", points));
        let axis = Axis::default();
        let fit = || Scale::fit(&axis, [0.0, 2.0].into_iter(), None, 5).unwrap();
        let plot = Plot {
            left: 0,
            top: 0,
            width: 100,
            height: 100,
        };
        let runs = Sheet(&chart).curves(&fit(), &fit(), &plot);
        assert_eq!(runs[0].iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
    }
}
