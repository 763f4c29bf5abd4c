//! Charts of curves as data: loops, histories, stacked cycles. A higher layer draws them.

mod axis;

pub use axis::{Axis, number, quantity, superscript};

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// One curve.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Entry in the legend; empty for none.
    pub label: String,
    /// Points in the units of the axes, in drawing order. A point that is not
    /// finite breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Red, green, blue; `None` takes the next colour of the palette.
    pub colour: Option<(u8, u8, u8)>,
    /// Line or markers.
    pub style: Style,
    /// Lower and upper end of the interval at each point, in the unit of the vertical axis; empty for none. A
    /// non-finite interval is omitted.
    pub intervals: Vec<(f64, f64)>,
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
#[derive(Clone, Debug)]
pub struct Chart {
    /// Heading; empty for none.
    pub title: String,
    /// Second line under the heading, for the conditions of the run.
    pub subtitle: Option<String>,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, drawn in order.
    pub series: Vec<Series>,
    /// Horizontal range in the axis unit; `None` fits the data.
    pub x_range: Option<(f64, f64)>,
    /// Vertical range in the axis unit; `None` fits the data.
    pub y_range: Option<(f64, f64)>,
    /// Colours the series along a gradient from first to last, with the gradient as legend; for superimposed
    /// cycles.
    pub colour_by_order: bool,
    /// Width and height in pixels; text and line widths scale with the page width.
    pub size_px: (u32, u32),
}

impl Chart {
    /// An empty chart of 1400 by 950 pixels.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            subtitle: None,
            x,
            y,
            series: Vec::new(),
            x_range: None,
            y_range: None,
            colour_by_order: false,
            size_px: (1400, 950),
        }
    }

    /// Adds a curve.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a curve, unless it is zero throughout or has no finite point.
    pub fn with_unless_zero(self, series: Series) -> Self {
        let shown = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite() && p.1 != 0.0;
        if series.points.iter().any(shown) {
            self.with(series)
        } else {
            self
        }
    }

    /// Whether any point can be shown.
    pub fn has_data(&self) -> bool {
        self.series
            .iter()
            .any(|s| s.points.iter().any(|p| self.shows(p)))
    }

    /// Whether a point can be shown on both axes.
    pub fn shows(&self, p: &(f64, f64)) -> bool {
        let on = |axis: &Axis, v: f64| v.is_finite() && (!axis.log || v > 0.0);
        on(&self.x, p.0) && on(&self.y, p.1)
    }
}
