//! Figures as data: charts of curves with their axes. A figure is described once; one back end
//! draws it as a PNG file, another in an HTML page, both from the result of [`Figure::resolve`],
//! with the same colours and ranges ([`PALETTE`], [`Chart::ranges`]); ticks are chosen by each.

mod axis;
mod field;
mod look;
mod rows;

pub use axis::{Axis, number, quantity, superscript};
pub use field::{Colours, FieldMap, round_top};
pub use look::{AxisRange, Colour, DARK_PALETTE, GRADIENT, PALETTE};
pub use rows::{Columns, Part, Rows, TableColumns, Value};

use serde::{Deserialize, Serialize};

/// Style of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Style {
    /// Continuous line.
    #[default]
    Line,
    /// Dashed line.
    Dashed,
    /// One marker per point.
    Markers,
    /// Line with markers; on long series only some points have one.
    LineMarkers,
}

/// Source of the points of a series.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Source {
    /// The points in [`Series::points`].
    #[default]
    Points,
    /// Rows of the statistics.
    Rows(Rows),
    /// A horizontal line at a height, across all other series.
    Level(f64),
    /// A vertical line at a position, from zero to above all other series.
    Place(f64),
}

/// One curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Series {
    /// Entry in the legend; empty for none.
    pub label: String,
    /// Source of the points.
    pub source: Source,
    /// Points in the units of the axes, in drawing order. A point that is not
    /// finite breaks the line.
    #[serde(with = "rows::pairs")]
    pub points: Vec<(f64, f64)>,
    /// Red, green, blue; `None` for the colour of the palette at the index of the series.
    pub colour: Option<(u8, u8, u8)>,
    /// Index in the palette, from [`Figure::resolve`]; series that are left out keep theirs.
    pub place: usize,
    /// Line or markers.
    pub style: Style,
    /// Lower and upper end of the interval at each point, in the unit of the vertical axis; empty
    /// for none. A non-finite interval is omitted.
    #[serde(with = "rows::pairs")]
    pub intervals: Vec<(f64, f64)>,
    /// Share of the largest value of the chart up to which a series of rows is left out.
    pub least: f64,
    /// Whether the share of a series that is left out is stated below the heading.
    pub stated: bool,
}

impl Series {
    /// A continuous line in the next colour of the palette.
    pub fn new(label: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self {
            label: label.into(),
            points,
            ..Self::default()
        }
    }

    /// Creates a curve of a column of the statistics over another. It is left out if it is zero
    /// throughout, or if the other column is constant.
    pub fn rows(label: impl Into<String>, x: impl Into<Value>, y: impl Into<Value>) -> Self {
        let (x, y, part) = (x.into(), y.into(), Part::All);
        Self::from_source(label, Source::Rows(Rows { x, y, part }))
    }

    /// Creates a dashed horizontal line across all other series of the chart.
    pub fn level(label: impl Into<String>, height: f64) -> Self {
        Self::from_source(label, Source::Level(height)).style(Style::Dashed)
    }

    /// Creates a dashed vertical line from zero to above all other series of the chart.
    pub fn place(label: impl Into<String>, x: f64) -> Self {
        Self::from_source(label, Source::Place(x)).style(Style::Dashed)
    }

    fn from_source(label: impl Into<String>, source: Source) -> Self {
        Self {
            label: label.into(),
            source,
            ..Self::default()
        }
    }

    /// Uses only a part of the rows.
    pub fn part(mut self, part: Part) -> Self {
        if let Source::Rows(rows) = &mut self.source {
            rows.part = part;
        }
        self
    }

    /// Sets an interval at each point, drawn as an error bar.
    pub fn intervals(mut self, intervals: Vec<(f64, f64)>) -> Self {
        self.intervals = intervals;
        self
    }

    /// Sets the colour: red, green, blue.
    pub fn coloured(mut self, red: u8, green: u8, blue: u8) -> Self {
        self.colour = Some((red, green, blue));
        self
    }

    /// Sets the style.
    pub fn style(mut self, style: Style) -> Self {
        self.style = style;
        self
    }
}

/// A chart with its axes and curves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Chart {
    /// Heading; empty for none.
    pub title: String,
    /// Second line under the heading, for the conditions of the run.
    pub subtitle: Option<String>,
    /// Explanation of the chart in one sentence; empty for none.
    pub note: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, drawn in order.
    pub series: Vec<Series>,
    /// Coloured cells below the curves, with both axes to the same scale.
    pub field: Option<FieldMap>,
    /// Horizontal range in the axis unit; `None` fits the data.
    pub x_range: Option<(f64, f64)>,
    /// Vertical range in the axis unit; `None` fits the data.
    pub y_range: Option<(f64, f64)>,
    /// Whether series are coloured along a gradient from first to last, with the gradient as
    /// legend; for superimposed cycles.
    pub colour_by_order: bool,
    /// Width and height in pixels of a chart that is drawn alone; text and line widths scale with
    /// the width.
    pub size_px: (u32, u32),
}

impl Chart {
    /// An empty chart of 1400 by 950 pixels.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            size_px: (1400, 950),
            ..Self::default()
        }
    }

    /// Sets the explanation.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Puts a text before the line under the heading.
    pub fn head(&mut self, text: &str) {
        let before = self.subtitle.take().filter(|t| !t.is_empty());
        self.subtitle = Some(before.map_or(text.to_owned(), |t| format!("{text}; {t}")));
    }

    /// Adds a curve.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds curves.
    pub fn with_all(mut self, series: impl IntoIterator<Item = Series>) -> Self {
        self.series.extend(series);
        self
    }

    /// Adds a curve of points, unless it is zero throughout or has no finite point.
    pub fn with_unless_zero(self, series: Series) -> Self {
        let shown = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite() && p.1 != 0.0;
        if series.points.iter().any(shown) {
            self.with(series)
        } else {
            self
        }
    }

    /// Describes the chart in a line of text: title, axes with their units, and series.
    pub fn describe(&self) -> String {
        let axis = |a: &Axis| match (a.unit.as_str(), a.log) {
            ("", false) => a.name.clone(),
            ("", true) => format!("{} (logarithmic)", a.name),
            (unit, false) => format!("{} ({unit})", a.name),
            (unit, true) => format!("{} ({unit}, logarithmic)", a.name),
        };
        let labels = self.series.iter().map(|s| s.label.as_str());
        let labels: Vec<&str> = labels.filter(|l| !l.is_empty()).collect();
        let of = if labels.is_empty() { "" } else { ": " };
        format!(
            "{}; {} over {}{of}{}",
            self.title,
            axis(&self.y),
            axis(&self.x),
            labels.join(", ")
        )
    }

    /// Returns the chart for drawing, with the points of the lines across the other series; without
    /// other series there are no lines.
    pub fn with_lines(&self) -> Self {
        let line = |s: &&Series| matches!(s.source, Source::Level(_) | Source::Place(_));
        let others = self.series.iter().filter(|s| !line(s));
        let shown = others.flat_map(|s| &s.points).filter(|p| self.shows(p));
        let around = shown.fold(None, |range: Option<[f64; 3]>, (x, y)| {
            let [low, high, top] = range.unwrap_or([*x, *x, *y]);
            Some([low.min(*x), high.max(*x), top.max(*y)])
        });
        let mut chart = self.clone();
        if around.is_none() {
            chart.series.retain(|s| !line(&s));
        }
        for series in &mut chart.series {
            series.points = match (&series.source, around) {
                (Source::Level(y), Some([low, high, _])) => vec![(low, *y), (high, *y)],
                (Source::Place(x), Some([.., top])) => vec![(*x, 0.0), (*x, 1.05 * top)],
                _ => continue,
            };
        }
        chart
    }

    /// Whether any point or cell can be shown.
    pub fn has_data(&self) -> bool {
        let points = |s: &Series| s.points.iter().any(|p| self.shows(p));
        self.field.as_ref().is_some_and(|f| !f.cells.is_empty()) || self.series.iter().any(points)
    }

    /// Returns whether a point can be shown on both axes.
    pub fn shows(&self, p: &(f64, f64)) -> bool {
        self.x.shows(p.0) && self.y.shows(p.1)
    }
}

/// Limit on the charts of a figure.
const MAX_CHARTS: usize = 12;

/// Charts on one page.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Figure {
    /// Name of the figure, and of its PNG file without `.png`.
    pub name: String,
    /// Common subject of all charts; empty for none.
    pub heading: String,
    /// The charts, row by row.
    pub charts: Vec<Chart>,
    /// Number of columns on the page.
    pub columns: usize,
    /// Whether it shows a main result: a report begins with these figures.
    pub leads: bool,
}

impl Figure {
    /// Name of the file in the folder of a run with its figures as data, a list in JSON.
    pub const FILE: &str = "figures.json";

    /// Name of the figure of the loops of a friction test.
    pub const LOOPS: &str = "fretting_loops";
    /// Name of the figure of friction by cycle, or against the displacement.
    pub const FRICTION: &str = "friction_coefficient";

    /// Creates a figure of charts on one page, in a number of columns.
    pub fn new(name: impl Into<String>, charts: impl Into<Vec<Chart>>, columns: usize) -> Self {
        Self {
            name: name.into(),
            heading: String::new(),
            charts: charts.into(),
            columns,
            leads: false,
        }
    }

    /// Returns the figure with the points of all series, from the statistics of a run; charts
    /// without data, and those beyond the twelfth, are left out.
    pub fn resolve(&self, columns: &dyn Columns) -> Self {
        let charts = self.charts.iter().map(|c| c.resolve(columns));
        Self {
            charts: charts.filter(Chart::has_data).take(MAX_CHARTS).collect(),
            name: self.name.clone(),
            heading: self.heading.clone(),
            columns: self.columns,
            leads: self.leads,
        }
    }

    /// Returns the charts, each with the heading of the figure in the line under its own.
    pub fn headed(&self) -> Vec<Chart> {
        let mut charts = self.charts.clone();
        charts.iter_mut().for_each(|c| c.head(&self.heading));
        charts
    }
}
