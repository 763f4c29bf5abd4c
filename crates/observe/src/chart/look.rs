//! What all drawings of a chart have in common: colours of the series, and ranges of the axes.

use super::{Axis, Chart};

/// Red, green, blue.
pub type Colour = (u8, u8, u8);

/// Colours of series on white paper, for readers with colour vision deficiency: those of Okabe and
/// Ito, darker where they would not stand out from white.
pub const PALETTE: [Colour; 7] = [
    (0, 114, 178),
    (196, 78, 0),
    (0, 128, 92),
    (176, 80, 138),
    (42, 140, 192),
    (154, 106, 0),
    (74, 74, 74),
];

/// The colours of [`PALETTE`] on a dark page.
pub const DARK_PALETTE: [Colour; 7] = [
    (90, 180, 240),
    (255, 157, 87),
    (63, 208, 160),
    (231, 155, 200),
    (143, 211, 245),
    (240, 192, 80),
    (200, 200, 200),
];

/// Perceptual gradient (viridis without its yellow, which is invisible on white paper), at equal
/// distances from the first series to the last.
pub const GRADIENT: [Colour; 5] = [
    (68, 1, 84),
    (59, 82, 139),
    (33, 145, 140),
    (74, 186, 110),
    (165, 205, 50),
];

/// Share of the width of the data that a range has beyond each end.
const PAD: f64 = 0.04;
/// Data whose width is below this share of their size are constant up to rounding.
const CONSTANT: f64 = 1e-9;

/// The numbers that an axis shows at first.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisRange {
    /// Ends in the unit of the axis.
    pub ends: (f64, f64),
    /// Exponent of ten by which numbers are divided where they are shown.
    pub exponent: i32,
    /// Name of the axis with the unit of the numbers that are shown.
    pub label: String,
}

impl Axis {
    /// Whether a number has a place on the axis.
    pub fn shows(&self, value: f64) -> bool {
        value.is_finite() && (!self.log || value > 0.0)
    }

    /// Whether an axis can reach from one number to another.
    pub fn reaches(&self, (from, to): (f64, f64)) -> bool {
        self.shows(from) && self.shows(to) && from < to
    }

    /// Returns the range around values in the unit of the axis, or the requested one where the axis
    /// can have it.
    ///
    /// Ranges around values are 4 % wider at both ends, of a logarithmic axis in decades. Around a
    /// constant they reach 10 % of it to both sides, around zero 1, on a logarithmic axis a decade.
    pub fn range(
        &self,
        values: impl Iterator<Item = f64>,
        requested: Option<(f64, f64)>,
    ) -> AxisRange {
        if let Some(ends) = requested.filter(|r| self.reaches(*r)) {
            return self.range_to(ends, ends);
        }
        let (mut low, mut high) = values
            .filter(|v| self.shows(*v))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
                (a.min(v), b.max(v))
            });
        if low > high {
            (low, high) = if self.log { (0.1, 10.0) } else { (0.0, 1.0) };
        }
        let place = |v: f64| if self.log { v.log10() } else { v };
        let (a, b) = (place(low), place(high));
        let width = b - a;
        let pad = if width > CONSTANT * a.abs().max(b.abs()) {
            PAD * width
        } else if self.log || a == 0.0 {
            1.0
        } else {
            0.1 * a.abs()
        };
        let value = |v: f64| if self.log { 10f64.powf(v) } else { v };
        self.range_to((value(a - pad), value(b + pad)), (low, high))
    }

    fn range_to(&self, ends: (f64, f64), (low, high): (f64, f64)) -> AxisRange {
        let (exponent, label) = self.scaled(low.abs().max(high.abs()));
        AxisRange {
            ends,
            exponent,
            label,
        }
    }
}

impl Chart {
    /// Returns the range of the horizontal and of the vertical axis, around all that is shown. The
    /// points of lines across the chart must be known ([`Chart::with_lines`]).
    pub fn ranges(&self) -> [AxisRange; 2] {
        let points = || {
            let all = self.series.iter().flat_map(|s| &s.points);
            all.filter(|p| self.shows(p))
        };
        let intervals = self.series.iter().flat_map(|s| {
            let with = s.points.iter().zip(&s.intervals);
            with.filter(|(p, i)| self.shows(p) && i.0.is_finite() && i.1.is_finite())
                .flat_map(|(_, i)| [i.0, i.1])
        });
        let corners = |axis: usize| {
            let cells = self.field.iter().flat_map(|field| &field.cells).flatten();
            cells.map(move |corner| f64::from(corner[axis]))
        };
        let heights = points().map(|p| p.1).chain(intervals).chain(corners(1));
        let places = points().map(|p| p.0).chain(corners(0));
        [
            self.x.range(places, self.x_range),
            self.y.range(heights, self.y_range),
        ]
    }

    /// Returns the place in the palette of a series by its index.
    pub fn place_in_palette(&self, index: usize) -> usize {
        index.max(self.series[index].place) % PALETTE.len()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Series;
    use super::*;

    fn ends(axis: &Axis, values: &[f64]) -> (f64, f64) {
        axis.range(values.iter().copied(), None).ends
    }

    /// Lines have a contrast of at least 3 to 1 with white (WCAG 2.1, 1.4.11).
    #[test]
    fn colours_stand_out_from_white() {
        for (r, g, b) in PALETTE {
            let linear = [r, g, b].map(|v| match f64::from(v) / 255.0 {
                v if v <= 0.03928 => v / 12.92,
                v => ((v + 0.055) / 1.055).powf(2.4),
            });
            let luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
            assert!(1.05 / (luminance + 0.05) > 3.0, "{r} {g} {b}");
        }
    }

    #[test]
    fn ranges_reach_around_values() {
        let axis = Axis::new("q", "");
        assert_eq!(ends(&axis, &[0.0, 100.0]), (-4.0, 104.0));
        assert_eq!(ends(&axis, &[0.0, f64::NAN]), (-1.0, 1.0));
        assert_eq!(ends(&axis, &[]), (-0.04, 1.04));
        // A constant that differs by its last digits.
        let (low, high) = ends(&axis, &[3.0, 3.0 + 1e-12]);
        assert!((low - 2.7).abs() < 1e-9 && (high - 3.3).abs() < 1e-9);
        let log = axis.log();
        assert_eq!(ends(&log, &[10.0, -1.0]), (1.0, 100.0));
        let (low, high) = ends(&log, &[1e-3, 1e2]);
        assert!((low.log10() + 3.2).abs() < 1e-12 && (high.log10() - 2.2).abs() < 1e-12);
    }

    #[test]
    fn requested_ranges_are_kept_and_intervals_are_in_sight() {
        let mut chart = Chart::new("", Axis::new("x", "m"), Axis::new("y", ""));
        chart.x_range = Some((0.0, 2e-3));
        let series = Series::new("", vec![(1e-3, 1.0), (2.0, f64::NAN)]);
        let chart = chart.with(series.intervals(vec![(0.0, 2.0), (0.0, 9.0)]));
        let [x, y] = chart.ranges();
        assert_eq!(
            (x.ends, x.exponent, x.label.as_str()),
            ((0.0, 2e-3), -3, "x (mm)")
        );
        assert_eq!(y.ends, (-0.08, 2.08));
    }
}
