//! Figures of a finished run, from its statistics.

pub(crate) mod biaxial;
pub(crate) mod circuit;
mod error;
pub(crate) mod jump;
pub(crate) mod scars;

use self::error::{error_bar, estimated};
use crate::chart::{Axis, Chart, Series, Style, quantity};
use crate::friction::{Cycle, Cycles};
use crate::output::Output;
use crate::statistics::Table;
use crate::summary::Estimate;
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;

/// Limit on the drawn loops: the first, the last, and some in between.
const LOOPS: usize = 40;
/// Limit on the panels of force against displacement.
const DRIVES: usize = 6;

/// An axis along which a body is driven.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drive {
    /// Name of the body.
    pub body: String,
    /// Axis: 0, 1 or 2.
    pub axis: usize,
}

/// The axes along which bodies are driven, the ones of the friction test apart.
pub(crate) fn drives<S: Space>(s: &Simulation<S>, test: Option<(&str, usize)>) -> Vec<Drive> {
    let mut out = Vec::new();
    for driven in &s.state.bodies.driven {
        for (axis, dof) in driven.dofs.iter().take(S::D).enumerate() {
            if driven_along(dof) && test != Some((driven.name.as_str(), axis)) {
                out.push(Drive {
                    body: driven.name.clone(),
                    axis,
                });
            }
        }
    }
    out
}

/// Whether a motion or a varying force is imposed: the displacement under a constant load is mostly noise.
fn driven_along(dof: &Dof) -> bool {
    match dof {
        Dof::Free | Dof::Fixed => false,
        Dof::Velocity(_) | Dof::Displacement(_) | Dof::Stages(_) => true,
        Dof::Force(f) | Dof::Pressure { value: f, .. } => !matches!(f, TimeFunction::Constant(_)),
    }
}

/// Unit of forces in so many dimensions.
fn newton(dimension: usize) -> &'static str {
    if dimension == 2 { "N/m" } else { "N" }
}

/// Broken bonds and mean damage against time.
pub(crate) fn damage_ratio(title: &str, table: &Table, known: &Estimate) -> Output {
    let mut chart = damage(title, table);
    estimated(&mut chart, "damage ratio", known, "");
    Output::charts("damage_ratio.png".into(), [chart], 1)
}

/// The loops of a fretting test, and its friction coefficient.
pub(crate) fn friction_test(
    title: &str,
    table: &Table,
    cycles: &Cycles,
    known: &Estimate,
    dimension: usize,
) -> Vec<Output> {
    let mut out = Vec::new();
    if cycles.oscillates() {
        let panels = loops(title, table, cycles, newton(dimension));
        out.push(Output::charts("fretting_loops.png".into(), panels, 2));
    }
    let mut chart = friction(title, table, cycles);
    estimated(&mut chart, "friction coefficient", known, "");
    let bar = error_bar(cycles, known);
    if let (Some((_, top)), Some((_, end))) = (chart.y_range.as_mut(), bar.intervals.first()) {
        *top = top.max(1.05 * end);
    }
    chart = chart.with_unless_zero(bar);
    out.push(Output::charts(
        "friction_coefficient.png".into(),
        [chart],
        1,
    ));
    out
}

/// Forces of driven bodies against their displacements.
pub(crate) fn force_displacement(
    title: &str,
    table: &Table,
    drives: &[Drive],
    dimension: usize,
) -> Output {
    let panels = forces(title, table, drives, newton(dimension));
    Output::charts("force_displacement.png".into(), panels, 2)
}

/// The energy balance against time.
pub(crate) fn energy_balance(
    title: &str,
    table: &Table,
    known: &Estimate,
    dimension: usize,
) -> Output {
    let mut chart = energy(title, table, dimension);
    let unit = if dimension == 2 { "J/m" } else { "J" };
    estimated(&mut chart, "energy dissipated by friction", known, unit);
    Output::charts("energy.png".into(), [chart], 1)
}

/// Pairs (x, y) of two columns.
fn pairs(table: &Table, x: &str, y: &str) -> Vec<(f64, f64)> {
    table.column(x).into_iter().zip(table.column(y)).collect()
}

fn headed(heading: impl Into<String>, title: &str, x: Axis, y: Axis) -> Chart {
    let mut chart = Chart::new(heading, x, y);
    chart.subtitle = Some(title.to_owned());
    chart
}

fn damage(title: &str, table: &Table) -> Chart {
    let (x, y) = (Axis::new("time t", "s"), Axis::new("damage", ""));
    headed("Damage of the bonds", title, x, y)
        .with_unless_zero(Series::new(
            "damage ratio: broken bonds / bonds made",
            pairs(table, "time", "damage_ratio"),
        ))
        .with_unless_zero(
            Series::new("mean damage D", pairs(table, "time", "mean_damage")).style(Style::Dashed),
        )
}

/// Q against the displacement, and Q/P.
fn loops(title: &str, table: &Table, cycles: &Cycles, newton: &'static str) -> [Chart; 2] {
    let axis = || Axis::new("relative displacement δ", "m");
    let force = Axis::new("tangential force Q", newton);
    let mut q = headed("Fretting loops", title, axis(), force);
    let ratio = Axis::new("force ratio Q/P", "");
    let mut share = headed("Force ratio", title, axis(), ratio);
    let columns = ["time", "delta", "Q", "P"].map(|name| table.column(name));
    for cycle in chosen(&cycles.list, LOOPS) {
        let Some(span) = cycles.span(cycle.cycle) else {
            continue;
        };
        let points = within(&columns, span);
        if points.len() < 3 {
            continue;
        }
        let label = format!("cycle {}", cycle.cycle);
        // Both panels share one legend.
        let of = |f: &dyn Fn(&[f64; 3]) -> f64| -> Vec<(f64, f64)> {
            points.iter().map(|p| (p[0], f(p))).collect()
        };
        q = q.with(Series::new(label, of(&|p| p[1])));
        // A body that is not pressed has no ratio.
        let over = |p: &[f64; 3]| if p[2] > 0.0 { p[1] / p[2] } else { f64::NAN };
        share = share.with(Series::new("", of(&over)));
    }
    for chart in [&mut q, &mut share] {
        chart.colour_by_order = true;
    }
    [q, share]
}

/// Selects the first, the last and evenly spaced ones in between.
fn chosen(list: &[Cycle], count: usize) -> Vec<&Cycle> {
    let last = list.len().saturating_sub(1);
    let shown = list.len().min(count);
    let place = |k: usize| k * last / shown.saturating_sub(1).max(1);
    (0..shown).map(|k| &list[place(k)]).collect()
}

/// Rows of three values in a time interval, given the time column and three others; values at both ends are
/// interpolated, so that a cycle ends where the next one begins.
fn within(columns: &[Vec<f64>; 4], [from, to]: [f64; 2]) -> Vec<[f64; 3]> {
    let time = &columns[0];
    let slack = 1e-9 * (to - from);
    let first = time.partition_point(|t| *t < from - slack);
    let end = time.partition_point(|t| *t <= to + slack);
    let row = |k: usize| [1, 2, 3].map(|c: usize| columns[c][k]);
    let between = |k: usize, t: f64| {
        let share = (t - time[k - 1]) / (time[k] - time[k - 1]);
        let (a, b) = (row(k - 1), row(k));
        [0, 1, 2].map(|i: usize| a[i] + share * (b[i] - a[i]))
    };
    let mut out = Vec::with_capacity(end.saturating_sub(first) + 2);
    if first > 0 && first < time.len() && time[first] > from + slack {
        out.push(between(first, from));
    }
    if first == 0 && end > 0 && time[0] > from + slack {
        // The run starts with the cycle: from rest at zero displacement, with the force of its first row.
        let [_, q, p] = row(0);
        out.push([0.0, q, p]);
    }
    out.extend((first..end).map(row));
    if end > first && end < time.len() && time[end - 1] < to - slack {
        out.push(between(end, to));
    }
    out
}

/// Friction coefficient by cycle; for a one-way motion, against the path.
fn friction(title: &str, table: &Table, cycles: &Cycles) -> Chart {
    let mu = Axis::new("friction coefficient µ", "");
    if !cycles.oscillates() {
        let x = Axis::new("relative displacement δ", "m");
        let times = table.column("time").into_iter();
        let points = times.zip(pairs(table, "delta", "mu"));
        // What is before the friction is looked at belongs to a compaction.
        let rounding = 1e-9 * cycles.start().abs();
        let points = points.filter(|(time, _)| *time >= cycles.start() - rounding);
        let points: Vec<(f64, f64)> = points.map(|(_, point)| point).collect();
        let moves = points.iter().any(|p| p.0 != 0.0);
        let chart = headed("Friction coefficient against displacement", title, x, mu);
        let ends = [points.first(), points.last()].map(|p| p.map_or(0.0, |p| p.0));
        let means = cycles.last().map(|c| c.friction_coefficient);
        if !moves {
            return chart;
        }
        let chart = chart.with_unless_zero(Series::new("|Q|/P", points));
        return match means {
            Some(mean) if chart.has_data() => {
                let label = format!("mean over the second half, {mean:.3}");
                let line = vec![(ends[0], mean), (ends[1], mean)];
                chart.with(Series::new(label, line).style(Style::Dashed))
            }
            _ => chart,
        };
    }
    let list = |f: &dyn Fn(&Cycle) -> f64| -> Vec<(f64, f64)> {
        let complete = cycles.list.iter().filter(|c| c.complete);
        complete.map(|c| (f64::from(c.cycle), f(c))).collect()
    };
    let peak = |c: &Cycle| c.tangential_amplitude / c.normal_force;
    let x = Axis::new("cycle number N", "").whole();
    let mut chart = headed("Friction coefficient by cycle", title, x, mu)
        .with_unless_zero(
            Series::new("from forces", list(&|c| c.friction_coefficient)).style(Style::LineMarkers),
        )
        .with_unless_zero(
            Series::new(
                "from dissipated energy",
                list(&|c| c.friction_from_dissipation),
            )
            .style(Style::Markers),
        )
        .with_unless_zero(Series::new("peak Q*/P", list(&peak)).style(Style::Dashed));
    let all = chart.series.iter().flat_map(|s| &s.points).map(|p| p.1);
    let highest = all.filter(|y| y.is_finite()).fold(0.0, f64::max);
    if highest > 0.0 {
        chart.y_range = Some((0.0, 1.15 * highest));
    }
    chart
}

/// Driving force of each body against its displacement.
fn forces(title: &str, table: &Table, drives: &[Drive], newton: &'static str) -> Vec<Chart> {
    let mut charts = Vec::new();
    for Drive { body, axis } in drives {
        let a = ["x", "y", "z"][*axis];
        let at = table.column(&format!("{body}_{a}"));
        let force = table.column(&format!("{body}_f{a}"));
        let Some(start) = at.first().copied() else {
            continue;
        };
        let size = at.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let moved = at.iter().fold(0.0f64, |m, x| m.max((x - start).abs()));
        if moved <= 1e-9 * size || moved.is_nan() || force.iter().all(|f| *f == 0.0) {
            continue;
        }
        let x = Axis::new(format!("displacement u_{a}"), "m");
        let y = Axis::new(format!("force F_{a}"), newton);
        let heading = format!("Force that drives {body} along {a}");
        // In equilibrium the contact force is opposite to the driving force.
        let points = at.iter().zip(&force).map(|(x, f)| (x - start, -f));
        charts.push(headed(heading, title, x, y).with(Series::new("", points.collect())));
        if charts.len() == DRIVES {
            break;
        }
    }
    charts
}

/// Ledger entry: column, label, colour, and whether it is stored or supplied rather than dissipated.
type Entry = (&'static str, &'static str, (u8, u8, u8), bool);
const ENTRIES: [Entry; 14] = [
    ("external_work", "external work W", (28, 30, 34), false),
    ("expansion", "thermal expansion", (110, 110, 30), false),
    ("friction", "friction E_d", (213, 94, 0), false),
    ("fracture", "fracture of bonds", (190, 30, 45), false),
    ("viscous", "damping", (204, 121, 167), false),
    ("impact", "impacts", (0, 158, 115), false),
    ("adhesion", "adhesion", (120, 80, 40), false),
    ("scheme", "time integration", (130, 130, 200), false),
    ("correction", "position correction", (200, 140, 0), true),
    ("elastic", "elastic energy", (0, 114, 178), true),
    (
        "carried",
        "energy carried by removed bodies",
        (90, 150, 90),
        true,
    ),
    ("potential", "potential energy", (90, 90, 160), true),
    ("kinetic", "kinetic energy", (86, 160, 215), true),
    ("residual", "residual", (150, 150, 150), true),
];
/// Entries below this fraction of the largest would coincide with the axis and are omitted.
const NEGLIGIBLE: f64 = 1e-3;
/// A residual below this fraction of the largest entry is rounding, and reported as such.
const ROUNDING: f64 = 1e-9;

fn energy(title: &str, table: &Table, dimension: usize) -> Chart {
    let unit = if dimension == 2 { "J/m" } else { "J" };
    let (x, y) = (Axis::new("time t", "s"), Axis::new("energy", unit));
    let mut chart = headed("Energy balance", title, x, y);
    let size = |points: &[(f64, f64)]| {
        let finite = points.iter().map(|p| p.1.abs()).filter(|v| v.is_finite());
        finite.fold(0.0, f64::max)
    };
    let all = ENTRIES.map(|e| (e, pairs(table, "time", e.0)));
    let largest = all.iter().map(|(_, p)| size(p)).fold(0.0, f64::max);
    for ((name, label, colour, dashed), points) in all {
        let most = size(&points);
        if name == "residual" && largest > 0.0 && most <= ROUNDING * largest {
            let share = quantity(most / largest, "", 2);
            chart.subtitle = Some(format!("{title}; residual {share} of the largest entry"));
        }
        let least = if name == "residual" {
            ROUNDING
        } else {
            NEGLIGIBLE
        };
        if most <= least * largest {
            continue;
        }
        let style = if dashed { Style::Dashed } else { Style::Line };
        let mut series = Series::new(label, points).style(style);
        series.colour = Some(colour);
        chart = chart.with(series);
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Column;

    fn table(names: &[&str], rows: Vec<f64>) -> Table {
        let mut table = Table::new(names.iter().map(|n| Column::new(*n, "", "")).collect());
        table.rows = rows;
        table
    }

    /// Rows of a circle in (delta, Q) with P = 2, at an interval `every`, for cycles of one second.
    fn circle(every: f64, end: f64) -> Table {
        let count = (end / every).round() as usize;
        let row = |k: usize| {
            let t = every * k as f64;
            let a = std::f64::consts::TAU * t;
            [t, a.cos(), a.sin(), 2.0]
        };
        table(
            &["time", "delta", "Q", "P"],
            (1..=count).flat_map(row).collect(),
        )
    }

    #[test]
    fn a_whole_cycle_ends_where_it_began() {
        // Intervals that divide the cycle, and one that does not.
        for every in [0.01, 0.03, 0.007] {
            let table = circle(every, 3.5);
            let columns = ["time", "delta", "Q", "P"].map(|n| table.column(n));
            let points = within(&columns, [1.0, 2.0]);
            let (a, b) = (points[0], points[points.len() - 1]);
            let gap = (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!(gap < 1e-2, "{gap} with a row every {every} s");
            assert!((a[0] - 1.0).abs() < 5e-3 && a[1].abs() < 5e-3, "{a:?}");
            let longest = points
                .windows(2)
                .map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]));
            assert!(longest.fold(0.0, f64::max) < 1.1 * std::f64::consts::TAU * every);
            // The first cycle starts before the first row, from rest.
            assert_eq!(within(&columns, [0.0, 1.0])[0][0], 0.0);
            // The existing part of an incomplete cycle.
            assert!(within(&columns, [3.0, 4.0]).len() >= (0.45 / every) as usize);
        }
    }

    #[test]
    fn loops_have_a_series_for_each_cycle_and_the_ratio_is_over_p() {
        let table = circle(0.01, 3.0);
        let mut cycles = Cycles::new(0.0, Some(1.0), 3.0);
        let list = (1..=3).map(|cycle| Cycle {
            cycle,
            complete: true,
            ..Cycle::default()
        });
        cycles.list = list.collect();
        let [q, share] = loops("case", &table, &cycles, "N");
        assert_eq!((q.series.len(), share.series.len()), (3, 3));
        for (a, b) in q.series.iter().zip(&share.series) {
            for (p, r) in a.points.iter().zip(&b.points) {
                assert!((p.1 - 2.0 * r.1).abs() < 1e-12);
            }
        }
        let many: Vec<Cycle> = (1..=1000)
            .map(|cycle| Cycle {
                cycle,
                ..Cycle::default()
            })
            .collect();
        let numbers: Vec<u32> = chosen(&many, 40).iter().map(|c| c.cycle).collect();
        assert_eq!((numbers.len(), numbers[0], numbers[39]), (40, 1, 1000));
        assert_eq!(chosen(&many[..1], 40).len(), 1);
    }

    #[test]
    fn a_constant_load_is_no_motion_to_plot_against() {
        use TimeFunction::{Constant, Table};
        let rises = Table(vec![(0.0, 0.0), (1.0, -9.0)]);
        assert!(driven_along(&Dof::Velocity(Constant(0.1))));
        assert!(driven_along(&Dof::Force(rises)));
        assert!(!driven_along(&Dof::Force(Constant(-9.0))));
        assert!(!driven_along(&Dof::Fixed));
    }

    #[test]
    fn constant_zero_entries_are_left_out_and_rounding_is_said() {
        let names = [
            "time",
            "external_work",
            "friction",
            "correction",
            "impact",
            "residual",
        ];
        let rows = vec![
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            1.0, 2.0, 1.5, -0.5, 0.0, 3e-16,
        ];
        let chart = energy("case", &table(&names, rows), 2);
        let labels: Vec<&str> = chart.series.iter().map(|s| s.label.as_str()).collect();
        assert_eq!(
            labels,
            ["external work W", "friction E_d", "position correction"]
        );
        let said = chart.subtitle.unwrap();
        assert!(said.contains("residual 1.5×10⁻¹⁶ of"), "{said}");
    }

    #[test]
    fn what_has_nothing_to_show_has_no_data() {
        let names = [
            "time",
            "external_work",
            "kinetic",
            "delta",
            "Q",
            "P",
            "mu",
            "lid_x",
            "lid_fx",
        ];
        let still: Vec<f64> = (0..5)
            .flat_map(|k| [f64::from(k), 0., 0., 0., 0., 0., 0., 1., 7.])
            .collect();
        let lid = [Drive {
            body: "lid".to_owned(),
            axis: 0,
        }];
        let shown = |table: &Table, cycles: Option<&Cycles>| -> Vec<String> {
            let mut all = vec![
                damage_ratio("case", table, &Estimate::default()),
                force_displacement("case", table, &lid, 2),
                energy_balance("case", table, &Estimate::default(), 2),
            ];
            all.extend(cycles.map_or(Vec::new(), |c| {
                friction_test("case", table, c, &Estimate::default(), 2)
            }));
            let file = |output: Output| match output {
                Output::Charts { file, charts, .. } if charts.iter().any(Chart::has_data) => {
                    Some(file)
                }
                _ => None,
            };
            all.into_iter().filter_map(file).collect()
        };
        let cycles = Cycles::new(0.0, None, 4.0);
        assert_eq!(shown(&table(&names, still), Some(&cycles)), [""; 0]);
        let moved = (0..5).flat_map(|k| [f64::from(k), 1., 0., 0., 0., 0., 0., f64::from(k), 7.]);
        let files = shown(&table(&names, moved.collect()), None);
        assert_eq!(files, ["force_displacement.png", "energy.png"]);
    }

    #[test]
    fn friction_is_drawn_from_its_start_on() {
        let rows = (0..5).flat_map(|k| [f64::from(k), f64::from(k), 0.3]);
        let table = table(&["time", "delta", "mu"], rows.collect());
        let points = |start: f64| {
            let chart = friction("case", &table, &Cycles::new(start, None, 4.0));
            chart.series[0].points.clone()
        };
        assert_eq!(points(0.0).len(), 5);
        assert_eq!(points(2.0), [(2.0, 0.3), (3.0, 0.3), (4.0, 0.3)]);
    }
}
