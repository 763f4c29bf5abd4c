//! Legend of a chart: a box where no curve passes, or rows above the plot.

use super::curve::{draw_series, gradient};
use super::{Layout, Polylines};
use crate::png::canvas::{Canvas, INK, Rgb, TEXT, WHITE};
use crate::png::font::{Anchor, TextStyle, text_width};
use fretwork_observe::chart::{Chart, Style};

/// Size of a legend in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Legend {
    pub width: f32,
    height: f32,
}

/// Length of the gradient bar, line height and length of a line sample.
const BAR: f32 = 190.0;
const LINE: f32 = 40.0;
const SAMPLE: f32 = 56.0;
const PAD: f32 = 14.0;

impl Legend {
    /// The legend of a chart, if it needs one.
    pub fn of(Layout { chart, u, .. }: &Layout<'_>) -> Option<Self> {
        let em = TEXT * u;
        let labels = labels(chart);
        let (first, last) = (labels.first()?, labels.last()?);
        Some(if chart.colour_by_order && labels.len() > 1 {
            let words = text_width(first.1, em) + text_width(last.1, em);
            Self {
                width: words + (BAR + 4.0 * PAD) * u,
                height: (LINE + 2.0 * PAD) * u,
            }
        } else {
            let widest = labels.iter().map(|l| text_width(l.1, em));
            Self {
                width: widest.fold(0.0, f32::max) + (SAMPLE + 3.0 * PAD) * u,
                height: (labels.len() as f32 * LINE + 1.2 * PAD) * u,
            }
        })
    }

    /// Corner of a free area of the plot, in pixels of the picture, that no curve crosses.
    pub fn free_place(&self, curves: &[Polylines], layout: &Layout<'_>) -> Option<[f32; 2]> {
        let (plot, u) = (&layout.plot, layout.u);
        let (width, height) = (plot.width as f32, plot.height as f32);
        let gap = 20.0 * u;
        if self.width + 2.0 * gap > width || self.height + 2.0 * gap > height {
            return None;
        }
        // Cells of the plot that contain a curve; the sampling along a line is finer than a cell.
        let cell = 6.0;
        let (columns, rows) = ((width / cell) as usize + 1, (height / cell) as usize + 1);
        let mut ink = vec![false; columns * rows];
        let mut mark = |x: f32, y: f32| {
            if (0.0..width).contains(&x) && (0.0..height).contains(&y) {
                ink[(y / cell) as usize * columns + (x / cell) as usize] = true;
            }
        };
        for run in curves.iter().flatten() {
            if let [only] = run.as_slice() {
                mark(only[0], only[1]);
            }
            for pair in run.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                let steps = ((length / 4.0) as usize).clamp(1, 4000);
                for i in 0..=steps {
                    let t = i as f32 / steps as f32;
                    mark(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
                }
            }
        }
        let (far_x, far_y) = (width - self.width - gap, height - self.height - gap);
        // Candidates: the corners, then along the edges, then anywhere.
        let (half_x, half_y) = ((width - self.width) / 2.0, (height - self.height) / 2.0);
        let mut places = vec![
            [far_x, gap],
            [gap, gap],
            [far_x, far_y],
            [gap, far_y],
            [half_x, gap],
            [half_x, far_y],
            [far_x, half_y],
            [gap, half_y],
        ];
        for row in [0.25, 0.5, 0.75] {
            let columns = [0.1, 0.3, 0.5, 0.7, 0.9].iter();
            places.extend(columns.map(|c| [gap + c * (far_x - gap), gap + row * (far_y - gap)]));
        }
        let free = |[x, y]: &[f32; 2]| {
            let margin = 10.0 * u;
            let from = |v: f32| ((v - margin) / cell).max(0.0) as usize;
            let to = |v: f32, n: usize| (((v + margin) / cell) as usize).min(n - 1);
            (from(*y)..=to(y + self.height, rows)).all(|row| {
                (from(*x)..=to(x + self.width, columns)).all(|col| !ink[row * columns + col])
            })
        };
        let [x, y] = places.into_iter().find(free)?;
        Some([plot.left as f32 + x, plot.top as f32 + y])
    }

    /// Draws the legend with its top left corner at a pixel of the picture.
    pub fn draw(&self, layout: &Layout<'_>, page: &mut Canvas, [left, top]: [f32; 2]) {
        let Layout { chart, u, .. } = layout;
        let em = TEXT * u;
        let edge: Rgb = [200, 204, 210];
        page.rect([left, top, self.width, self.height], WHITE);
        page.frame([left, top, self.width, self.height], 1.3 * u, edge);
        let labels = labels(chart);
        let ink = TextStyle::new(em, INK);
        if chart.colour_by_order && labels.len() > 1 {
            let base = top + self.height / 2.0 + 0.34 * em;
            let (first, last) = (labels[0].1, labels[labels.len() - 1].1);
            page.text(first, [left + PAD * u, base], &ink);
            let right = left + self.width - PAD * u;
            page.text(last, [right, base], &ink.anchored(Anchor::End));
            let x = left + 2.0 * PAD * u + text_width(first, em);
            let (bar, high) = ((BAR * u).round() as i32, 20.0 * u);
            let y = top + (self.height - high) / 2.0;
            for i in 0..bar {
                let at = [x.round() + i as f32, y.round(), 1.0, high.round()];
                page.rect(at, gradient(f64::from(i) / f64::from(bar.max(2) - 1)));
            }
            return;
        }
        for (rank, (index, label)) in labels.iter().enumerate() {
            let middle = top + (0.6 * PAD + (rank as f32 + 0.5) * LINE) * u;
            entry(layout, page, (*index, label), [left + PAD * u, middle]);
        }
    }
}

/// A line sample of a series and its label, from a point on the middle of the line.
fn entry(
    layout: &Layout<'_>,
    page: &mut Canvas,
    (index, label): (usize, &str),
    [from, middle]: [f32; 2],
) {
    let Layout { chart, u, .. } = *layout;
    let em = TEXT * u;
    let to = from + SAMPLE * u;
    let style = chart.series[index].style;
    let colour = layout.colour(index);
    let centre = [(from + to) / 2.0, middle];
    if style != Style::Markers {
        let plain = if style == Style::Dashed {
            style
        } else {
            Style::Line
        };
        let sample = vec![vec![[from, middle], [to, middle]]];
        draw_series(page, &sample, plain, colour, index, u);
    }
    if matches!(style, Style::Markers | Style::LineMarkers) {
        draw_series(page, &[vec![centre]], Style::Markers, colour, index, u);
    }
    let ink = TextStyle::new(em, INK);
    page.text(label, [to + PAD * u, middle + 0.34 * em], &ink);
}

/// The legend as rows above a plot that has no free area for a box.
pub(crate) struct LegendRows {
    /// Height of all rows, pixels.
    pub height: f32,
    /// Index of each series, and the position of its entry.
    entries: Vec<(usize, [f32; 2])>,
}

impl LegendRows {
    /// Arranges the entries within the width of the plot.
    pub fn of(layout: &Layout<'_>) -> Self {
        let Layout { chart, u, plot, .. } = layout;
        let width = plot.width as f32;
        if chart.colour_by_order {
            return Self {
                height: (LINE + 3.0 * PAD) * u,
                entries: Vec::new(),
            };
        }
        let (mut x, mut row, mut entries) = (0.0, 0.0, Vec::new());
        for (index, label) in labels(chart) {
            let long = text_width(label, TEXT * u) + (SAMPLE + PAD) * u;
            if x > 0.0 && x + long > width {
                (x, row) = (0.0, row + 1.0);
            }
            entries.push((index, [x, (row + 0.4) * LINE * u]));
            x += long + 2.0 * PAD * u;
        }
        let height = ((row + 1.0) * LINE + 0.5 * PAD) * u;
        Self { height, entries }
    }

    /// Draws the rows from a corner of the picture.
    pub fn draw(&self, layout: &Layout<'_>, page: &mut Canvas, [left, top]: [f32; 2]) {
        if layout.chart.colour_by_order {
            if let Some(legend) = Legend::of(layout) {
                legend.draw(layout, page, [left, top]);
            }
            return;
        }
        for (index, [x, y]) in &self.entries {
            let label = &layout.chart.series[*index].label;
            entry(layout, page, (*index, label), [left + x, top + y]);
        }
    }
}

/// Index and label of the series with a legend entry.
fn labels(chart: &Chart) -> Vec<(usize, &str)> {
    let all = chart.series.iter().map(|s| s.label.as_str()).enumerate();
    all.filter(|(_, label)| !label.is_empty()).collect()
}
