//! Series made of columns of the statistics.

use super::{Chart, Series, Source, quantity};
use crate::statistics::Table;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Rows of the statistics as points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rows {
    /// Horizontal value.
    pub x: Value,
    /// Vertical value.
    pub y: Value,
    /// Selection of rows.
    pub part: Part,
}

/// A value of each row: the value of a column, optionally less its first value or divided by
/// another column, times a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// Name of the column.
    pub column: String,
    /// Factor.
    pub factor: f64,
    /// Whether the value of the first row is subtracted.
    pub from_first: bool,
    /// Column to divide by; there is no point where it is not above zero.
    pub over: Option<String>,
}

impl<T: Into<String>> From<T> for Value {
    fn from(column: T) -> Self {
        Self {
            column: column.into(),
            factor: 1.0,
            from_first: false,
            over: None,
        }
    }
}

/// A part of the rows of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Part {
    /// All rows.
    All,
    /// Rows from a time on (s).
    Since(f64),
    /// A cycle from one time to another (s), with values between rows at both ends, so that it ends
    /// where the next one begins.
    Cycle([f64; 2]),
}

/// Columns of numbers by name, all of the same length.
pub trait Columns {
    /// Returns unit and values of a column; `None` if there is no such column.
    fn column(&self, name: &str) -> Option<(&str, Rc<[f64]>)>;
}

/// The columns of a table, each copied once.
#[derive(Debug)]
pub struct TableColumns<'a> {
    table: &'a Table,
    known: RefCell<HashMap<String, Rc<[f64]>>>,
}

impl<'a> TableColumns<'a> {
    /// The columns of a table whose rows were read back.
    pub fn of(table: &'a Table) -> Self {
        let known = RefCell::default();
        Self { table, known }
    }
}

impl Columns for TableColumns<'_> {
    fn column(&self, name: &str) -> Option<(&str, Rc<[f64]>)> {
        let column = self.table.columns.iter().find(|c| c.name == name)?;
        let mut known = self.known.borrow_mut();
        let values = known
            .entry(name.to_owned())
            .or_insert_with(|| self.table.column(name).into());
        Some((self.table.heading(column), values.clone()))
    }
}

impl Rows {
    /// Returns the points; `None` if a column is missing, or if the horizontal value is constant.
    fn points(&self, columns: &dyn Columns) -> Option<Vec<(f64, f64)>> {
        let (x, y) = (self.x.of(columns)?, self.y.of(columns)?);
        let first = x.iter().find(|x| x.is_finite())?;
        let (size, moved) = x
            .iter()
            .filter(|x| x.is_finite())
            .fold((0.0f64, 0.0f64), |(size, moved), x| {
                (size.max(x.abs()), moved.max((x - first).abs()))
            });
        if x.len() > 1 && moved <= 1e-9 * size {
            return None;
        }
        let all = || x.iter().copied().zip(y.iter().copied());
        let time = |from: f64| {
            let (_, time) = columns.column("time")?;
            // Times are sums of steps, so that they are compared with a tolerance.
            let slack = 1e-9 * from.abs();
            Some(time.partition_point(|t| *t < from - slack))
        };
        match self.part {
            Part::All => Some(all().collect()),
            Part::Since(from) => Some(all().skip(time(from)?).collect()),
            Part::Cycle(span) => {
                let (_, time) = columns.column("time")?;
                Some(cycle(&time, &x, &y, span)).filter(|points| points.len() > 2)
            }
        }
    }
}

impl Value {
    fn of(&self, columns: &dyn Columns) -> Option<Vec<f64>> {
        let (_, values) = columns.column(&self.column)?;
        let first = if self.from_first {
            *values.first()?
        } else {
            0.0
        };
        let shown = |v: &f64| self.factor * (v - first);
        let Some(over) = &self.over else {
            return Some(values.iter().map(shown).collect());
        };
        let (_, over) = columns.column(over)?;
        let ratio = |(v, by): (&f64, &f64)| if *by > 0.0 { shown(v) / by } else { f64::NAN };
        Some(values.iter().zip(over.iter()).map(ratio).collect())
    }
}

/// Returns the points of the rows in a time interval, with interpolated values at both ends.
fn cycle(time: &[f64], x: &[f64], y: &[f64], [from, to]: [f64; 2]) -> Vec<(f64, f64)> {
    let slack = 1e-9 * (to - from);
    let first = time.partition_point(|t| *t < from - slack);
    let end = time.partition_point(|t| *t <= to + slack);
    let between = |k: usize, t: f64| {
        let share = (t - time[k - 1]) / (time[k] - time[k - 1]);
        let of = |values: &[f64]| values[k - 1] + share * (values[k] - values[k - 1]);
        (of(x), of(y))
    };
    let mut out = Vec::with_capacity(end.saturating_sub(first) + 2);
    if first > 0 && first < time.len() && time[first] > from + slack {
        out.push(between(first, from));
    }
    if first == 0 && end > 0 && time[0] > from + slack {
        // The run starts with the cycle: from rest at zero, with the value of its first row.
        out.push((0.0, y[0]));
    }
    out.extend((first..end).map(|k| (x[k], y[k])));
    if end > first && end < time.len() && time[end - 1] < to - slack {
        out.push(between(end, to));
    }
    out
}

impl Chart {
    /// Returns the chart with the points of its series, and with the units of their columns on its
    /// axes.
    pub(super) fn resolve(&self, columns: &dyn Columns) -> Self {
        let mut chart = self.clone();
        chart.series = Vec::new();
        let mut largest = 0.0f64;
        for (place, series) in self.series.iter().enumerate() {
            let mut series = Series {
                place,
                ..series.clone()
            };
            if let Source::Rows(rows) = &series.source {
                series.points = rows.points(columns).unwrap_or_default();
                for (axis, value) in [(&mut chart.x, &rows.x), (&mut chart.y, &rows.y)] {
                    if axis.unit_of_rows
                        && let Some((unit, _)) = columns.column(&value.column)
                    {
                        axis.unit = unit.to_owned();
                    }
                }
                largest = largest.max(size(&series.points));
            }
            chart.series.push(series);
        }
        let mut stated = Vec::new();
        chart.series.retain(|s| {
            let shown = !matches!(s.source, Source::Rows(_)) || size(&s.points) > s.least * largest;
            if !shown && s.stated && largest > 0.0 {
                let share = quantity(size(&s.points) / largest, "", 2);
                stated.push(format!("{} {share} of the largest entry", s.label));
            }
            shown
        });
        for text in stated {
            let subtitle = chart.subtitle.get_or_insert_default();
            *subtitle += if subtitle.is_empty() { "" } else { "; " };
            *subtitle += &text;
        }
        chart
    }
}

/// Returns the largest magnitude of the heights of points.
fn size(points: &[(f64, f64)]) -> f64 {
    let finite = points.iter().map(|p| p.1.abs()).filter(|v| v.is_finite());
    finite.fold(0.0, f64::max)
}

/// Serializes pairs of numbers for files without NaN and infinities: these become null.
pub(super) mod pairs {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(list: &[(f64, f64)], to: S) -> Result<S::Ok, S::Error> {
        let finite = |x: f64| x.is_finite().then_some(x);
        let list: Vec<_> = list.iter().map(|p| (finite(p.0), finite(p.1))).collect();
        list.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(f64, f64)>, D::Error> {
        let list = Vec::<(Option<f64>, Option<f64>)>::deserialize(from)?;
        let number = |x: Option<f64>| x.unwrap_or(f64::NAN);
        Ok(list
            .into_iter()
            .map(|p| (number(p.0), number(p.1)))
            .collect())
    }
}

/// Serializes numbers for files without NaN and infinities: these become null.
pub(super) mod numbers {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(list: &[f64], to: S) -> Result<S::Ok, S::Error> {
        let finite = |x: &f64| x.is_finite().then_some(*x);
        let list: Vec<Option<f64>> = list.iter().map(finite).collect();
        list.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        let list = Vec::<Option<f64>>::deserialize(from)?;
        Ok(list.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Figure, Part};
    use super::*;
    use crate::statistics::Column;

    fn table(names: &[(&str, &'static str)], rows: Vec<f64>) -> Table {
        let columns = names
            .iter()
            .map(|(name, unit)| Column::new(*name, *unit, ""));
        let mut table = Table::new(columns.collect(), 3);
        table.rows = rows;
        table
    }

    /// Returns rows of a circle in (delta, Q), at an interval `every`, for cycles of one second.
    fn circle(every: f64, end: f64) -> Table {
        let count = (end / every).round() as usize;
        let row = |k: usize| {
            let t = every * k as f64;
            let a = std::f64::consts::TAU * t;
            [t, a.cos(), a.sin()]
        };
        let names = [("time", "s"), ("delta", "m"), ("Q", "N")];
        table(&names, (1..=count).flat_map(row).collect())
    }

    fn resolved(chart: Chart, table: &Table) -> Option<Chart> {
        let figure = Figure::new("figure", [chart], 1);
        figure.resolve(&TableColumns::of(table)).charts.pop()
    }

    #[test]
    fn a_whole_cycle_ends_where_it_began() {
        // Some intervals divide the cycle, and one does not.
        for every in [0.01, 0.03, 0.007] {
            let table = circle(every, 3.5);
            let points = |span| {
                let series = Series::rows("", "delta", "Q").part(Part::Cycle(span));
                let chart = Chart::new("", Axis::of_rows("x"), Axis::of_rows("y")).with(series);
                resolved(chart, &table).unwrap().series[0].points.clone()
            };
            let whole = points([1.0, 2.0]);
            let (a, b) = (whole[0], whole[whole.len() - 1]);
            let gap = (a.0 - b.0).hypot(a.1 - b.1);
            assert!(gap < 1e-2, "{gap} with a row every {every} s");
            assert!((a.0 - 1.0).abs() < 5e-3 && a.1.abs() < 5e-3, "{a:?}");
            let longest = whole
                .windows(2)
                .map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1));
            assert!(longest.fold(0.0, f64::max) < 1.1 * std::f64::consts::TAU * every);
            // The first cycle starts before the first row, from rest.
            assert_eq!(points([0.0, 1.0])[0].0, 0.0);
            // The existing part of an incomplete cycle.
            assert!(points([3.0, 4.0]).len() >= (0.45 / every) as usize);
        }
    }

    #[test]
    fn columns_have_their_units_and_lines_cross_what_is_drawn() {
        let chart = || {
            Chart::new("", Axis::of_rows("x"), Axis::of_rows("y"))
                .with(Series::level("mean", 0.5))
                .with(Series::rows("a", "delta", "Q").part(Part::Since(0.25)))
                .with(Series::rows("none", "delta", "P"))
        };
        let drawn = resolved(chart(), &circle(0.01, 1.0)).unwrap().with_lines();
        assert_eq!((drawn.x.unit.as_str(), drawn.y.unit.as_str()), ("m", "N"));
        let labels: Vec<_> = drawn
            .series
            .iter()
            .map(|s| (s.label.as_str(), s.place))
            .collect();
        assert_eq!(labels, [("mean", 0), ("a", 1)]);
        let [(low, at), (high, end)] = drawn.series[0].points[..] else {
            panic!("{:?}", drawn.series[0]);
        };
        assert!((low + 1.0).abs() < 1e-9 && (high - 1.0).abs() < 1e-9 && at == 0.5 && end == 0.5);
        assert_eq!(drawn.series[1].points.len(), 76);
        // Without a curve there is no chart for a line across it.
        assert_eq!(resolved(chart(), &table(&[("time", "s")], vec![])), None);
    }

    #[test]
    fn what_is_not_a_number_comes_back_from_a_file() {
        let nan = f64::NAN;
        let mut series = Series::new("a", vec![(0.1 + 0.2, 1.0), (nan, 2.0)]);
        series.intervals = vec![(0.0, f64::INFINITY)];
        let chart = Chart::new("", Axis::time(), Axis::cycles()).with(series);
        let text = serde_json::to_string(&chart).unwrap();
        let back: Chart = serde_json::from_str(&text).unwrap();
        assert_eq!(back.series[0].points[0], (0.1 + 0.2, 1.0));
        assert!(back.series[0].points[1].0.is_nan() && back.series[0].intervals[0].1.is_nan());
    }
}
