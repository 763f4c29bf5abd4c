//! Draws charts of curves and of coloured cells.

mod curve;
mod field;
mod legend;
mod scale;
#[cfg(test)]
mod tests;

use crate::png::canvas::{Canvas, DrawError, INK, PAGE, Rgb, SOFT_INK, TEXT, wrapped};
use crate::png::font::{Anchor, TextStyle as Text, text_width};
pub(crate) use curve::gradient;
use curve::{draw_series, thinned};
use fretwork_observe::chart::{Chart, PALETTE, Series};
use legend::Legend;
pub(crate) use scale::{AxisScale, check_range};
use std::path::Path;

/// Width of a page of several charts in pixels: 318 per inch if it is printed 16 cm wide.
const WIDTH: u32 = 2000;
/// Ratio of height to width of a panel: in two columns, alone in a row, and with coloured cells.
const ASPECTS: [f32; 3] = [0.8, 0.6, 1.16];
/// Limit on the columns: in narrower panels text of 9 pt leaves no room for curves.
const COLUMNS: usize = 2;
const GRID: Rgb = [226, 229, 233];

/// Draws charts row by row in a number of columns (at most two) to one PNG file. Charts without
/// data are omitted; without any chart there is no file. A subtitle common to all charts is drawn
/// once, above the page. A single chart has its own size.
///
/// # Errors
/// The file cannot be written, or the range or size of a chart cannot be drawn.
pub fn draw_panels(charts: &[Chart], columns: usize, path: &Path) -> Result<(), DrawError> {
    let charts = charts.iter().filter(|c| c.has_data());
    let mut charts: Vec<Chart> = charts.map(Chart::with_lines).collect();
    let said: Vec<String> = charts.iter().map(Chart::describe).collect();
    let said = said.join("\n");
    match charts.as_slice() {
        [] => return Ok(()),
        [one] => return page(one, one.size_px.0)?.save(path, &said),
        _ => {}
    }
    let heading = common(&mut charts);
    let columns = columns.clamp(1, COLUMNS);
    let panel = WIDTH / columns as u32;
    let cells = charts.iter().any(|c| c.field.is_some());
    let aspect = ASPECTS[if cells { 2 } else { usize::from(columns == 1) }];
    let high = (panel as f32 * aspect).round() as u32;
    let u = WIDTH as f32 / PAGE;
    let lines = wrapped(&heading, 32.0 * u, WIDTH as f32 - 48.0 * u);
    let top = match lines.len() {
        0 => 0,
        n => ((18.0 + 40.0 * n as f32) * u).round() as u32,
    };
    let rows = charts.len().div_ceil(columns) as u32;
    let mut sheet = Canvas::new(WIDTH, top + high * rows)?;
    let bold = Text::new(32.0 * u, INK).bold();
    for (k, line) in lines.iter().enumerate() {
        sheet.text(line, [24.0 * u, (44.0 + 40.0 * k as f32) * u], &bold);
    }
    for (k, chart) in charts.iter_mut().enumerate() {
        chart.size_px = (panel, high);
        let letter = char::from(b'a' + (k % 26) as u8);
        chart.title = format!("({letter}) {}", chart.title);
        let (row, column) = (k / columns, k % columns);
        sheet.paste(
            &page(chart, WIDTH)?,
            column * panel as usize,
            top as usize + row * high as usize,
        );
    }
    sheet.save(path, &said)
}

/// Removes the subtitle that all charts have in common, and returns it.
fn common(charts: &mut [Chart]) -> String {
    let first = charts.first().and_then(|c| c.subtitle.clone());
    let Some(first) = first.filter(|f| charts.iter().all(|c| c.subtitle.as_ref() == Some(f)))
    else {
        return String::new();
    };
    charts.iter_mut().for_each(|c| c.subtitle = None);
    first
}

/// Polylines in pixels of the plot; a gap starts a new polyline.
type Polylines = Vec<Vec<[f32; 2]>>;

/// Rectangle in pixels of the picture.
#[derive(Clone, Copy, Debug)]
struct Plot {
    left: i32,
    top: i32,
    width: i32,
    height: i32,
}

/// A chart with its scales and the position of its plot; `u` is the scale of the picture.
struct Layout<'a> {
    chart: &'a Chart,
    x: AxisScale,
    y: AxisScale,
    plot: Plot,
    u: f32,
}

/// Draws a chart as part of a page whose width in pixels sets the size of text and lines.
fn page(chart: &Chart, page_width: u32) -> Result<Canvas, DrawError> {
    let (width, height) = chart.size_px;
    if width.min(height) < 200 {
        return Err(DrawError::Size { width, height });
    }
    let mut page = Canvas::new(width, height)?;
    let mut layout = Layout::new(chart, page_width as f32 / PAGE)?;
    let top = layout.plot.top as f32;

    // The legend is placed where no curve passes, otherwise in rows above the plot.
    let mut curves = layout.curves();
    let legend = Legend::of(&layout);
    let ink = [&curves[..], &[layout.all_bars()]].concat();
    let corner = legend.as_ref().and_then(|l| l.free_place(&ink, &layout));
    let mut rows = None;
    if legend.is_some() && corner.is_none() {
        let laid = legend::LegendRows::of(&layout);
        let room = (laid.height as i32).min(layout.plot.height / 2);
        layout.plot.top += room;
        layout.plot.height -= room;
        curves = layout.curves();
        rows = Some(laid);
    }

    let Plot {
        left,
        top: plot_top,
        width,
        height,
    } = layout.plot;
    layout.grid(&mut page);
    let mut field = Canvas::clear(width as u32, height as u32)?;
    layout.draw_field(&mut field);
    for (i, (series, runs)) in chart.series.iter().zip(&curves).enumerate() {
        layout.draw_intervals(&mut field, i);
        draw_series(
            &mut field,
            runs,
            series.style,
            layout.colour(i),
            i,
            layout.u,
        );
    }
    page.lay(&field, left, plot_top);
    layout.frame(&mut page);
    layout.write(&mut page);
    layout.field_legend(&mut page)?;
    if let (Some(legend), Some(corner)) = (&legend, corner) {
        legend.draw(&layout, &mut page, corner);
    }
    if let Some(rows) = &rows {
        rows.draw(&layout, &mut page, [left as f32, top]);
    }
    Ok(page)
}

impl<'a> Layout<'a> {
    fn new(chart: &'a Chart, u: f32) -> Result<Self, DrawError> {
        let em = TEXT * u;
        let (wide, high) = (chart.size_px.0 as f32, chart.size_px.1 as f32);
        let ticks_x = ((wide / em - 5.0) / 5.0) as usize;
        let ticks_y = ((high / em - 7.0) / 2.6) as usize;
        check_range(&chart.x, chart.x_range)?;
        check_range(&chart.y, chart.y_range)?;
        let [x, y] = chart.ranges();
        let x = AxisScale::new(&chart.x, x, ticks_x.clamp(2, 8));
        let y = AxisScale::new(&chart.y, y, ticks_y.clamp(2, 8));
        let widest = |scale: &AxisScale| {
            let widths = scale.ticks.iter().map(|t| text_width(&t.1, em));
            widths.fold(0.0, f32::max)
        };
        let left = widest(&y) + 88.0 * u;
        let right = (widest(&x) / 2.0 + 12.0 * u).max(36.0 * u);
        let top = header(chart, wide - left - 16.0 * u, u).1;
        let below = if chart.field.is_some() { 232.0 } else { 116.0 } * u;
        let mut plot = Plot {
            left: left as i32,
            top: top as i32,
            width: ((wide - left - right) as i32).max(20),
            height: ((high - top - below) as i32).max(20),
        };
        if chart.field.is_some() {
            // Both axes have the same scale.
            let across = |(a, b): (f64, f64)| b - a;
            let [dx, dy] = [across(x.range), across(y.range)];
            let ratio = 10f64.powi(x.exponent - y.exponent);
            let scale = (f64::from(plot.width) / (dx * ratio)).min(f64::from(plot.height) / dy);
            plot.width = (dx * ratio * scale).round() as i32;
            plot.height = (dy * scale).round() as i32;
        }
        Ok(Self {
            chart,
            x,
            y,
            plot,
            u,
        })
    }

    /// Position of a point in pixels of the plot.
    fn place(&self, p: (f64, f64)) -> [f32; 2] {
        let (width, height) = (f64::from(self.plot.width), f64::from(self.plot.height));
        let h = (self.x.share(self.x.shown(p.0)) * width).clamp(-1e6, 1e6);
        let v = (self.y.share(self.y.shown(p.1)) * height).clamp(-1e6, 1e6);
        [h as f32, (height - v) as f32]
    }

    /// Error bars of a series from low to high, in pixels of the plot.
    fn bars(&self, series: &Series) -> Polylines {
        let with = series.points.iter().zip(&series.intervals);
        let bars =
            with.map(|(p, (low, high))| vec![self.place((p.0, *low)), self.place((p.0, *high))]);
        bars.filter(|b| b.iter().flatten().all(|v| v.is_finite()))
            .collect()
    }

    fn all_bars(&self) -> Polylines {
        let all = self.chart.series.iter();
        all.flat_map(|s| self.bars(s)).collect()
    }

    /// Draws the error bars of a series with caps.
    fn draw_intervals(&self, field: &mut Canvas, series: usize) {
        let (colour, u) = (self.colour(series), self.u);
        for bar in self.bars(&self.chart.series[series]) {
            field.stroke(&bar, false, 2.4 * u, colour, None);
            for [at, end] in bar {
                let cap = [[at - 10.0 * u, end], [at + 10.0 * u, end]];
                field.stroke(&cap, false, 2.4 * u, colour, None);
            }
        }
    }

    fn colour(&self, index: usize) -> Rgb {
        let series = &self.chart.series[index];
        match series.colour {
            Some(colour) => colour.into(),
            None if self.chart.colour_by_order => {
                gradient(index as f64 / (self.chart.series.len().max(2) - 1) as f64)
            }
            None => PALETTE[self.chart.place_in_palette(index)].into(),
        }
    }

    /// All series in pixels of the plot, thinned to the pixel resolution.
    fn curves(&self) -> Vec<Polylines> {
        let curve = |s: &Series| {
            let mut runs: Polylines = vec![Vec::new()];
            for (raw, p) in s.points.iter().map(|raw| (raw, self.place(*raw))) {
                let finite = [raw.0, raw.1, f64::from(p[0]), f64::from(p[1])]
                    .iter()
                    .all(|v| v.is_finite());
                match runs.last_mut() {
                    Some(run) if finite => run.push(p),
                    Some(run) if !run.is_empty() => runs.push(Vec::new()),
                    _ => {}
                }
            }
            let dense = s.points.len() > 4 * self.plot.width as usize;
            runs.into_iter()
                .filter(|run| !run.is_empty())
                .map(|run| if dense { thinned(&run) } else { run })
                .collect()
        };
        self.chart.series.iter().map(curve).collect()
    }

    /// Left, top, width and height of the plot in pixels of the picture.
    fn box_px(&self) -> [f32; 4] {
        let Plot {
            left,
            top,
            width,
            height,
        } = self.plot;
        [left, top, width, height].map(|x| x as f32)
    }

    /// Returns the pixel positions of the `minor` or the labelled ticks of both axes, to the right
    /// and downwards.
    fn ticks(&self, minor: bool) -> [Vec<f32>; 2] {
        let [left, top, width, height] = self.box_px();
        let places = |scale: &AxisScale| -> Vec<f64> {
            match minor {
                true => scale.minor.clone(),
                false => scale.ticks.iter().map(|t| t.0).collect(),
            }
        };
        let share = |scale: &AxisScale, v: f64| scale.share(v) as f32;
        let across = places(&self.x).into_iter();
        let down = places(&self.y).into_iter();
        [
            across.map(|v| left + width * share(&self.x, v)).collect(),
            down.map(|v| top + height * (1.0 - share(&self.y, v)))
                .collect(),
        ]
    }

    /// Draws lines across the plot at the ticks.
    fn grid(&self, page: &mut Canvas) {
        let [left, top, width, height] = self.box_px();
        let thick = (1.2 * self.u).round().max(1.0);
        let [across, down] = self.ticks(false);
        for x in across {
            page.rect([(x - 0.5 * thick).round(), top, thick, height], GRID);
        }
        for y in down {
            page.rect([left, (y - 0.5 * thick).round(), width, thick], GRID);
        }
    }

    /// Draws the box of the plot, with ticks inwards on its four sides, as in print.
    fn frame(&self, page: &mut Canvas) {
        let [left, top, width, height] = self.box_px();
        let thick = (2.0 * self.u).round().max(1.0);
        for (minor, long) in [(false, 9.0 * self.u), (true, 4.5 * self.u)] {
            let [across, down] = self.ticks(minor);
            for x in across.iter().map(|x| (x - 0.5 * thick).round()) {
                page.rect([x, top, thick, long], INK);
                page.rect([x, top + height - long, thick, long], INK);
            }
            for y in down.iter().map(|y| (y - 0.5 * thick).round()) {
                page.rect([left, y, long, thick], INK);
                page.rect([left + width - long, y, long, thick], INK);
            }
        }
        page.frame([left, top, width, height], thick, INK);
    }

    /// Writes heading, tick labels and axis names.
    fn write(&self, page: &mut Canvas) {
        let (em, u) = (TEXT * self.u, self.u);
        let [left, top, width, height] = self.box_px();
        let (wide, high) = (page.pixmap.width() as f32, page.pixmap.height() as f32);
        let bottom = top + height;
        let room = wide - 16.0 * u - left;
        for (k, (line, size, bold)) in header(self.chart, room, u).0.iter().enumerate() {
            let size = size * (room / text_width(line, *size)).min(1.0);
            let style = match bold {
                true => Text::new(size, INK).bold(),
                false => Text::new(size, SOFT_INK),
            };
            page.text(line, [left, 44.0 * u + k as f32 * 40.0 * u], &style);
        }
        let centred = Text::new(em, INK).anchored(Anchor::Middle);
        let ends = Text::new(em, INK).anchored(Anchor::End);
        let [across, down] = self.ticks(false);
        for (x, (_, label)) in across.into_iter().zip(&self.x.ticks) {
            page.text(label, [x, bottom + 1.25 * em], &centred);
        }
        for (y, (_, label)) in down.into_iter().zip(&self.y.ticks) {
            page.text(label, [left - 0.5 * em, y + 0.34 * em], &ends);
        }
        // A long axis name may extend beyond the plot before its size is reduced.
        let fit = |text: &str, room: f32| {
            let size = 30.0 * u;
            let size = size * (room / text_width(text, size)).min(1.0);
            Text::new(size, INK).anchored(Anchor::Middle)
        };
        let (x, y) = (&self.x.label, &self.y.label);
        let name = fit(x, width + left);
        let half = text_width(x, name.size) / 2.0;
        let at = (left + width / 2.0).min(wide - 10.0 * u - half).max(half);
        page.text(x, [at, bottom + 88.0 * u], &name);
        let name = fit(y, high - 20.0 * u).upwards();
        let half = text_width(y, name.size) / 2.0;
        let at = (top + height / 2.0)
            .max(half + 8.0 * u)
            .min((high - half - 8.0 * u).max(half));
        page.text(y, [42.0 * u, at], &name);
    }
}

/// Returns the lines of the heading with their sizes and whether they are bold, wrapped to a width,
/// and their total height.
fn header(chart: &Chart, room: f32, u: f32) -> (Vec<(String, f32, bool)>, f32) {
    let title = (chart.title.as_str(), 31.0 * u, true);
    let subtitle = chart.subtitle.as_deref().unwrap_or_default();
    let texts = [title, (subtitle, TEXT * u, false)].into_iter();
    let lines: Vec<_> = texts
        .flat_map(|(text, size, bold)| {
            let lines = wrapped(text, size, room).into_iter();
            lines.map(move |line| (line, size, bold))
        })
        .collect();
    let height = 34.0 * u + lines.len() as f32 * 40.0 * u;
    (lines, height)
}
