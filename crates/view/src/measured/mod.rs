//! Measured curves beside those of a run: loops, friction by cycle, and scars, from tables of text,
//! drawn in the figures of the run.

mod read;

pub use read::{MeasuredColumns, read_measured};

use crate::png::gradient;
use fretwork_observe::chart::{Chart, Figure, Series, Style};
use fretwork_scene::units::convert;

/// What a measured curve is.
#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// Tangential force against displacement.
    Loop,
    /// Q/P against displacement.
    Ratio,
    /// Friction coefficient against cycles.
    Cycles,
    /// Depth against position, of the scar of a body.
    Scar(Option<String>),
}

/// A measured curve.
#[derive(Clone, Debug)]
pub struct MeasuredCurve {
    /// Name of its file.
    pub name: String,
    kind: Kind,
    points: Vec<(f64, f64)>,
    units: [String; 2],
    depth: Option<f64>,
}

impl MeasuredCurve {
    /// Returns whether a chart of a figure shows curves of this kind.
    fn belongs(&self, figure: &str, place: usize, chart: &Chart) -> bool {
        let pure = |unit: &str| matches!(unit, "" | "1");
        match &self.kind {
            Kind::Loop => figure == Figure::LOOPS && !pure(&chart.y.unit),
            Kind::Ratio => {
                let loops = figure == Figure::LOOPS || figure == Figure::FRICTION;
                loops && pure(&chart.y.unit) && !pure(&chart.x.unit)
            }
            Kind::Cycles => figure == Figure::FRICTION && pure(&chart.x.unit),
            Kind::Scar(body) => {
                let scar = figure.strip_prefix("scar_");
                place == 0 && scar.is_some_and(|s| body.as_ref().is_none_or(|b| b == s))
            }
        }
    }

    /// What a run needs so that it has a figure for the curve.
    fn needs(&self) -> String {
        match &self.kind {
            Kind::Loop => "no loops of Q against displacement; its case needs `friction` with a motion to and fro".into(),
            Kind::Ratio => "no figure of Q/P against displacement; its case needs `friction`".into(),
            Kind::Cycles => "no figure of friction by cycle; its case needs `friction` with a motion to and fro".into(),
            Kind::Scar(None) => "no scar; its case needs a body that `wears`".into(),
            Kind::Scar(Some(body)) => format!("no scar of `{body}`; name a body that `wears`"),
        }
    }

    /// Returns the points in the units of a chart.
    fn points(&self, chart: &Chart) -> Result<Vec<(f64, f64)>, String> {
        let unit = |of: &str| match of {
            "1" => String::new(),
            other => other.to_owned(),
        };
        let (x, y) = (unit(&chart.x.unit), unit(&chart.y.unit));
        let fail = |e: fretwork_scene::units::UnitError| format!("{}: {}", self.name, e.message);
        let force = self.kind == Kind::Loop && convert(1.0, &self.units[1], &y).is_err();
        let per_depth = match self.depth.filter(|_| force && y == "N/m") {
            Some(depth) => Some(depth),
            None if force && y == "N/m" && convert(1.0, &self.units[1], "N").is_ok() => {
                return Err(format!(
                    "{}: its force is in {}, and that of the run in N/m, per metre of depth; give the length of the contact across the motion (--depth)",
                    self.name, self.units[1]
                ));
            }
            None => None,
        };
        let down = if matches!(self.kind, Kind::Scar(_)) {
            -1.0
        } else {
            1.0
        };
        let across = |v: f64| convert(v, &self.units[0], &x).map_err(fail);
        let up = |v: f64| match per_depth {
            Some(depth) => Ok(convert(v, &self.units[1], "N").map_err(fail)? / depth),
            None => convert(down * v, &self.units[1], &y).map_err(fail),
        };
        let point = |p: &(f64, f64)| Ok((across(p.0)?, up(p.1)?));
        self.points.iter().map(point).collect()
    }
}

/// Colours of measured curves on paper.
const INKS: [(u8, u8, u8); 4] = [(28, 30, 34), (150, 30, 120), (0, 110, 60), (120, 80, 40)];
/// Number of points up to which a measured curve is drawn with markers.
const MARKED: usize = 300;
/// Number of superimposed curves of the run that are kept beside a measured one.
const KEPT: usize = 4;

/// Adds measured curves to the charts of their kind.
///
/// # Errors
/// A curve has no chart, or its units are not those of the chart; in a sentence.
pub(crate) fn add(figures: &mut [Figure], curves: &[MeasuredCurve]) -> Result<(), String> {
    for (k, curve) in curves.iter().enumerate() {
        let scars: Vec<&str> = figures
            .iter()
            .filter(|f| {
                f.charts
                    .first()
                    .is_some_and(|c| curve.belongs(&f.name, 0, c))
            })
            .filter_map(|f| f.name.strip_prefix("scar_"))
            .collect();
        if curve.kind == Kind::Scar(None) && scars.len() > 1 {
            return Err(format!(
                "{}: the run has scars of {}; name its column after one of them, `depth_{}`",
                curve.name,
                scars.join(" and "),
                scars[0]
            ));
        }
        let mut drawn = false;
        for figure in figures.iter_mut() {
            let name = figure.name.clone();
            for (place, chart) in figure.charts.iter_mut().enumerate() {
                if curve.belongs(&name, place, chart) {
                    let points = curve.points(chart)?;
                    draw(chart, &curve.name, points, INKS[k % INKS.len()]);
                    drawn = true;
                }
            }
        }
        if !drawn {
            return Err(format!("{}: the run has {}", curve.name, curve.needs()));
        }
    }
    Ok(())
}

/// Returns whether a figure has measured curves.
pub(crate) fn is_in(figure: &Figure) -> bool {
    let series = figure.charts.iter().flat_map(|c| &c.series);
    series.into_iter().any(|s| s.label.starts_with(MEASURED))
}

/// Beginning of the label of a measured curve.
const MEASURED: &str = "measured: ";

fn draw(chart: &mut Chart, name: &str, points: Vec<(f64, f64)>, ink: (u8, u8, u8)) {
    by_colour(chart);
    let finite = |x: &f64| x.is_finite();
    for (range, of) in [
        (
            &mut chart.x_range,
            points
                .iter()
                .map(|p| p.0)
                .filter(finite)
                .collect::<Vec<_>>(),
        ),
        (
            &mut chart.y_range,
            points.iter().map(|p| p.1).filter(finite).collect(),
        ),
    ] {
        if let Some((low, high)) = range {
            *low = of.iter().copied().fold(*low, f64::min);
            *high = of.iter().map(|v| 1.05 * v).fold(*high, f64::max);
        }
    }
    let style = if points.len() > MARKED {
        Style::Line
    } else {
        Style::Markers
    };
    let (red, green, blue) = ink;
    let series = Series::new(format!("{MEASURED}{name}"), points).style(style);
    chart.series.push(series.coloured(red, green, blue));
}

/// Gives superimposed curves the colours of their gradient as their own, and keeps a few of them,
/// so that a legend has room for other curves.
fn by_colour(chart: &mut Chart) {
    if !chart.colour_by_order {
        return;
    }
    let all = std::mem::take(&mut chart.series);
    let (last, kept) = (all.len().saturating_sub(1), all.len().min(KEPT));
    for k in 0..kept {
        let place = k * last / (kept - 1).max(1);
        let series = all[place].clone();
        let share = place as f64 / last.max(1) as f64;
        let [red, green, blue] = gradient(share);
        chart.series.push(series.coloured(red, green, blue));
    }
    chart.colour_by_order = false;
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_observe::chart::Axis;

    fn curve(kind: Kind, units: [&str; 2], points: &[(f64, f64)]) -> MeasuredCurve {
        MeasuredCurve {
            name: "m.csv".into(),
            kind,
            points: points.to_vec(),
            units: units.map(str::to_owned),
            depth: None,
        }
    }

    fn scar(body: &str) -> Figure {
        let axes = [Axis::new("position x", "m"), Axis::new("-depth", "m")];
        let [x, y] = axes;
        let depth = Chart::new("scar", x.clone(), y).with(Series::new("", vec![(0.0, -1e-6)]));
        let profile = Chart::new("profile", x, Axis::new("height z", "m"));
        Figure::new(format!("scar_{body}"), [depth, profile], 2)
    }

    #[test]
    fn depths_are_drawn_downwards_in_the_scar_of_their_body() {
        let measured = |body: Option<&str>| {
            let kind = Kind::Scar(body.map(str::to_owned));
            curve(kind, ["mm", "um"], &[(1.0, 2.0)])
        };
        let mut one = [scar("flat")];
        add(&mut one, &[measured(None)]).unwrap();
        assert_eq!(one[0].charts[0].series[1].points, [(1e-3, -2e-6)]);
        assert!(one[0].charts[1].series.is_empty() && is_in(&one[0]));
        let mut two = [scar("flat"), scar("ball")];
        let refused = add(&mut two, &[measured(None)]).unwrap_err();
        assert!(refused.contains("`depth_flat`"), "{refused}");
        add(&mut two, &[measured(Some("ball"))]).unwrap();
        assert!(!is_in(&two[0]) && is_in(&two[1]));
        let refused = add(&mut two, &[measured(Some("pin"))]).unwrap_err();
        assert!(refused.contains("no scar of `pin`"), "{refused}");
    }

    #[test]
    fn loops_keep_their_colours_beside_a_measured_one() {
        let mut chart = Chart::new("loops", Axis::new("δ", "m"), Axis::new("Q", "N/m"));
        for k in 1..=40 {
            let points = vec![(0.0, f64::from(k))];
            chart.series.push(Series::new(format!("cycle {k}"), points));
        }
        chart.colour_by_order = true;
        chart.y_range = Some((0.0, 50.0));
        let mut figures = [Figure::new(Figure::LOOPS, [chart], 2)];
        let newtons = curve(Kind::Loop, ["um", "N"], &[(1.0, 1.0)]);
        assert!(
            add(&mut figures, std::slice::from_ref(&newtons))
                .unwrap_err()
                .contains("--depth")
        );
        let depth = Some(0.01);
        add(&mut figures, &[MeasuredCurve { depth, ..newtons }]).unwrap();
        let chart = &figures[0].charts[0];
        let labels: Vec<&str> = chart.series.iter().map(|s| s.label.as_str()).collect();
        assert_eq!(chart.series.len(), KEPT + 1);
        assert_eq!((labels[0], labels[KEPT - 1]), ("cycle 1", "cycle 40"));
        assert!(!chart.colour_by_order);
        assert!(chart.series.iter().all(|s| s.colour.is_some()));
        assert_eq!(chart.series[KEPT].points, [(1e-6, 100.0)]);
        assert!((chart.y_range.unwrap().1 - 105.0).abs() < 1e-9);
    }
}
