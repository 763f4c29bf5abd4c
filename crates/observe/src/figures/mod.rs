//! Figures of a run: charts of its statistics and of data in observers.

pub(crate) mod biaxial;
pub(crate) mod circuit;
pub(crate) mod contact_map;
mod error;
pub(crate) mod jump;
pub(crate) mod scars;

use self::error::{error_bar, estimated};
use crate::chart::{Axis, Chart, Figure, Part, Series, Style, Value};
use crate::cycle::Cycle;
use crate::friction::Cycles;
use crate::output::Output;
use crate::summary::Estimate;
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_core::view::RunView;

/// Limit on the drawn loops: the first, the last, and some in between.
const LOOPS: usize = 40;

/// An axis along which a body is driven.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drive {
    /// Name of the body.
    pub body: String,
    /// Axis: 0, 1 or 2.
    pub axis: usize,
}

/// Returns the axes along which bodies are driven, except those of the friction test.
pub(crate) fn drives(run: &dyn RunView, test: Option<(&str, usize)>) -> Vec<Drive> {
    let mut out = Vec::new();
    for driven in run.bodies().driven {
        for (axis, dof) in driven.dofs.iter().take(run.dimension()).enumerate() {
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

/// Returns whether a motion or a varying force is imposed: the displacement under a constant load
/// is mostly noise.
fn driven_along(dof: &Dof) -> bool {
    match dof {
        Dof::Free | Dof::Fixed => false,
        Dof::Velocity(_) | Dof::Displacement(_) | Dof::Stages(_) => true,
        Dof::Force(f) | Dof::Pressure { value: f, .. } => !matches!(f, TimeFunction::Constant(_)),
    }
}

/// Returns a chart of columns of the statistics over time, with their labels.
pub(crate) fn history<C: AsRef<str>>(
    heading: impl Into<String>,
    y: Axis,
    series: &[(&str, C)],
) -> Chart {
    let line = |(label, column): &(&str, C)| Series::rows(*label, "time", column.as_ref());
    Chart::new(heading, Axis::time(), y).with_all(series.iter().map(line))
}

/// Returns a chart of broken bonds and mean damage against time.
pub(crate) fn damage_ratio(known: &Estimate) -> Output {
    let mut chart = Chart::new("Damage of the bonds", Axis::time(), Axis::new("damage", ""))
        .note("Broken bonds over bonds made, and the mean damage of all bonds.")
        .with(Series::rows(
            "damage ratio: broken bonds / bonds made",
            "time",
            "damage_ratio",
        ))
        .with(Series::rows("mean damage D", "time", "mean_damage").style(Style::Dashed));
    estimated(&mut chart, "damage ratio", known, "");
    Output::figure("damage_ratio", [chart], 1)
}

/// Returns the loops of a fretting test, its friction coefficient, and the forces on the tested
/// body over time.
pub(crate) fn friction_test(cycles: &Cycles, known: &Estimate) -> Vec<Output> {
    let mut out = Vec::new();
    if cycles.oscillates() {
        out.push(Output::leading(Figure::LOOPS, loops(cycles), 2));
    }
    let mut chart = friction(cycles);
    estimated(&mut chart, "friction coefficient", known, "");
    let bar = error_bar(cycles, known);
    if let (Some((_, top)), Some((_, end))) = (chart.y_range.as_mut(), bar.intervals.first()) {
        *top = top.max(1.05 * end);
    }
    chart = chart.with_unless_zero(bar);
    out.push(Output::leading(Figure::FRICTION, [chart], 1));
    let forces = [("tangential force Q", "Q"), ("normal force P", "P")];
    let over_time = [
        history("Friction over time", Axis::new("|Q|/P", ""), &[("", "mu")])
            .note("Ratio of tangential to normal force, row by row."),
        history("Forces on the tested body", Axis::of_rows("force"), &forces),
    ];
    out.push(Output::figure("friction_history", over_time, 2));
    out
}

/// Returns charts of Q and Q/P against the displacement.
fn loops(cycles: &Cycles) -> [Chart; 2] {
    let known: Vec<u32> = match cycles.list.as_slice() {
        // Before any motion all cycles are listed.
        [] => (1..=cycles.total()).collect(),
        list => list.iter().map(|c| c.cycle).collect(),
    };
    let chart = |heading, name, y: Value, labelled: bool| {
        let mut chart = Chart::new(
            heading,
            Axis::of_rows("relative displacement δ"),
            Axis {
                unit_of_rows: y.over.is_none(),
                ..Axis::new(name, "")
            },
        );
        for number in chosen(&known, LOOPS) {
            let Some(span) = cycles.span(number) else {
                continue;
            };
            // Both panels share one legend.
            let label = match labelled {
                true => format!("cycle {number}"),
                false => String::new(),
            };
            let series = Series::rows(label, "delta", y.clone());
            chart.series.push(series.part(Part::Cycle(span)));
        }
        chart.colour_by_order = true;
        chart
    };
    // A body without normal force has no ratio.
    let ratio = Value {
        over: Some("P".to_owned()),
        ..Value::from("Q")
    };
    let force = Value::from("Q");
    let loops = chart("Fretting loops", "tangential force Q", force, true).note(
        "The area of a loop is the energy of its cycle; rounded corners after a reversal are elastic shear.",
    );
    [loops, chart("Force ratio", "force ratio Q/P", ratio, false)]
}

/// Selects the first, the last and evenly spaced ones in between.
fn chosen(list: &[u32], count: usize) -> Vec<u32> {
    let last = list.len().saturating_sub(1);
    let shown = list.len().min(count);
    let place = |k: usize| k * last / shown.saturating_sub(1).max(1);
    (0..shown).map(|k| list[place(k)]).collect()
}

/// Returns a chart of the friction coefficient by cycle; for a one-way motion, against the path.
fn friction(cycles: &Cycles) -> Chart {
    let mu = Axis::new("friction coefficient µ", "");
    if !cycles.oscillates() {
        // Rows before the start of the test belong to a compaction.
        let since = Part::Since(cycles.start());
        let x = Axis::of_rows("relative displacement δ");
        let mean = cycles.last().and_then(|c| c.friction_coefficient);
        return Chart::new("Friction coefficient against displacement", x, mu)
            .note("Ratio of tangential to normal force over the path.")
            .with(Series::rows("|Q|/P", "delta", "mu").part(since))
            .with_all(mean.map(|mean| {
                let label = format!("mean over the second half, {mean:.3}");
                Series::level(label, mean)
            }));
    }
    let list = |f: &dyn Fn(&Cycle) -> Option<f64>| -> Vec<(f64, f64)> {
        let complete = cycles.list.iter().filter(|c| c.complete);
        let point = |c: &Cycle| Some((f64::from(c.cycle), f(c)?));
        complete.filter_map(point).collect()
    };
    let mut chart = Chart::new("Friction coefficient by cycle", Axis::cycles(), mu)
        .note("Sliding: |Q|/P while the contact slides, none in partial slip. Energetic: work of Q over P times the path, the elastic part included.")
        .with_unless_zero(
            Series::new("sliding", list(&|c| c.friction_coefficient)).style(Style::LineMarkers),
        )
        .with_unless_zero(Series::new("peak Q*/P", list(&Cycle::peak_ratio)).style(Style::Dashed))
        .with_unless_zero(
            Series::new("energetic", list(&|c| Some(c.energetic_coefficient)))
                .style(Style::Dashed),
        )
        .with_unless_zero(
            Series::new(
                "energetic, from the ledger",
                list(&|c| Some(c.friction_from_dissipation)),
            )
            .style(Style::Markers),
        );
    let all = chart.series.iter().flat_map(|s| &s.points).map(|p| p.1);
    let highest = all.filter(|y| y.is_finite()).fold(0.0, f64::max);
    if highest > 0.0 {
        chart.y_range = Some((0.0, 1.15 * highest));
    }
    chart
}

/// Returns charts of the driving force of each body against its displacement.
pub(crate) fn force_displacement(drives: &[Drive]) -> Output {
    let chart = |Drive { body, axis }: &Drive| {
        let a = ["x", "y", "z"][*axis];
        let travel = Value {
            from_first: true,
            ..Value::from(format!("{body}_{a}"))
        };
        // In equilibrium the contact force is opposite to the driving force.
        let force = Value {
            factor: -1.0,
            ..Value::from(format!("{body}_f{a}"))
        };
        let x = Axis::of_rows(format!("displacement u_{a}"));
        let y = Axis::of_rows(format!("force F_{a}"));
        Chart::new(format!("Force that drives {body} along {a}"), x, y)
            .with(Series::rows("", travel, force))
    };
    Output::figure(
        "force_displacement",
        drives.iter().map(chart).collect::<Vec<_>>(),
        2,
    )
}

/// Fraction of the largest entry below which an entry is omitted, since it would coincide with the
/// axis.
const NEGLIGIBLE: f64 = 1e-3;
/// Fraction of the largest entry below which a residual is rounding, and reported as such.
const ROUNDING: f64 = 1e-9;
/// Entries that are current values, drawn dashed, instead of sums since the start.
const HELD: [&str; 6] = [
    "kinetic",
    "potential",
    "elastic",
    "correction",
    "carried",
    "residual",
];
/// Colours of the entries in their order.
const COLOURS: [(u8, u8, u8); 15] = [
    (86, 160, 215),
    (90, 90, 160),
    (0, 114, 178),
    (190, 30, 45),
    (213, 94, 0),
    (0, 158, 115),
    (120, 80, 40),
    (204, 121, 167),
    (200, 140, 0),
    (130, 130, 200),
    (90, 150, 90),
    (110, 110, 30),
    (28, 30, 34),
    (60, 60, 60),
    (150, 150, 150),
];

/// Returns a chart of the entries of the energy ledger against time, by the names of their columns.
pub(crate) fn energy_balance(
    entries: impl Iterator<Item = &'static str>,
    known: &Estimate,
    joule: &'static str,
) -> Output {
    let (x, y) = (Axis::time(), Axis::of_rows("energy"));
    let mut chart = Chart::new("Energy balance", x, y)
        .note("Entries of the energy ledger above a thousandth of the largest, by their columns.");
    // The entries at the start do not change.
    let drawn = entries
        .zip(COLOURS)
        .filter(|(name, _)| *name != "initial_kinetic");
    for (name, colour) in drawn {
        let style = [Style::Line, Style::Dashed][usize::from(HELD.contains(&name))];
        let mut series = Series::rows(name.replace('_', " "), "time", name).style(style);
        series.colour = Some(colour);
        series.stated = name == "residual";
        series.least = if series.stated { ROUNDING } else { NEGLIGIBLE };
        chart.series.push(series);
    }
    estimated(&mut chart, "energy dissipated by friction", known, joule);
    Output::figure("energy", [chart], 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::TableColumns;
    use crate::statistics::{Column, Table};

    fn table(names: &[&str], rows: Vec<f64>) -> Table {
        let mut table = Table::new(names.iter().map(|n| Column::new(*n, "", "")).collect(), 3);
        table.rows = rows;
        table
    }

    /// Returns the figures that are not empty.
    fn resolved(outputs: Vec<Output>, table: &Table) -> Vec<Figure> {
        let figure = |output| match output {
            Output::Figure(figure) => Some(figure.resolve(&TableColumns::of(table))),
            Output::Text { .. } => None,
        };
        let figures = outputs.into_iter().filter_map(figure);
        figures.filter(|f| !f.charts.is_empty()).collect()
    }

    #[test]
    fn loops_have_a_series_for_each_cycle_and_the_ratio_is_over_p() {
        let row = |k: u32| {
            let t = 0.01 * f64::from(k);
            let a = std::f64::consts::TAU * t;
            [t, a.cos(), a.sin(), 2.0]
        };
        let rows = (1..=300).flat_map(row).collect();
        let table = table(&["time", "delta", "Q", "P"], rows);
        let mut cycles = Cycles::new(0.0, Some(1.0), 3.0);
        let drawn = |cycles: &Cycles| {
            let loops = Output::figure("loops", loops(cycles), 2);
            resolved(vec![loops], &table).pop().unwrap().charts
        };
        // Before any motion all future cycles are listed.
        let before = drawn(&cycles);
        let list = (1..=3).map(|cycle| Cycle {
            cycle,
            complete: true,
            ..Cycle::default()
        });
        cycles.list = list.collect();
        let after = drawn(&cycles);
        assert_eq!(before, after);
        let [q, share] = &after[..] else {
            panic!("{} charts", after.len());
        };
        assert_eq!((q.series.len(), share.series.len()), (3, 3));
        for (a, b) in q.series.iter().zip(&share.series) {
            for (p, r) in a.points.iter().zip(&b.points) {
                assert!((p.1 - 2.0 * r.1).abs() < 1e-12);
            }
        }
        let all: Vec<u32> = (1..=1000).collect();
        let numbers = chosen(&all, 40);
        assert_eq!((numbers.len(), numbers[0], numbers[39]), (40, 1, 1000));
        assert_eq!(chosen(&all[..1], 40).len(), 1);
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

    const ENTRIES: [&str; 5] = [
        "external_work",
        "friction",
        "correction",
        "impact",
        "residual",
    ];

    #[test]
    fn constant_zero_entries_are_left_out_and_rounding_is_said() {
        let names = [&["time"][..], &ENTRIES].concat();
        let rows = vec![
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            1.0, 2.0, 1.5, -0.5, 0.0, 3e-16,
        ];
        let energy = energy_balance(ENTRIES.into_iter(), &Estimate::default(), "J");
        let mut figures = resolved(vec![energy], &table(&names, rows));
        let chart = figures[0].charts.pop().unwrap();
        let labels: Vec<&str> = chart.series.iter().map(|s| s.label.as_str()).collect();
        assert_eq!(labels, ["external work", "friction", "correction"]);
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
        let none = Estimate::default();
        let shown = |table: &Table, cycles: Option<&Cycles>| -> Vec<String> {
            let entries = ["external_work", "kinetic"].into_iter();
            let mut all = vec![
                damage_ratio(&none),
                force_displacement(&lid),
                energy_balance(entries, &none, "J"),
            ];
            all.extend(cycles.map_or(Vec::new(), |c| friction_test(c, &none)));
            let figures = resolved(all, table).into_iter();
            figures.map(|f| f.name).collect()
        };
        let cycles = Cycles::new(0.0, None, 4.0);
        assert_eq!(shown(&table(&names, still), Some(&cycles)), [""; 0]);
        let moved = (0..5).flat_map(|k| [f64::from(k), 1., 0., 0., 0., 0., 0., f64::from(k), 7.]);
        let files = shown(&table(&names, moved.collect()), None);
        assert_eq!(files, ["force_displacement", "energy"]);
    }

    #[test]
    fn friction_is_drawn_from_its_start_on() {
        let rows = (0..5).flat_map(|k| [f64::from(k), f64::from(k), 0.3]);
        let table = table(&["time", "delta", "mu"], rows.collect());
        let points = |start: f64| {
            let chart = friction(&Cycles::new(start, None, 4.0));
            let figures = resolved(vec![Output::figure("", [chart], 1)], &table);
            figures[0].charts[0].series[0].points.clone()
        };
        assert_eq!(points(0.0).len(), 5);
        assert_eq!(points(2.0), [(2.0, 0.3), (3.0, 0.3), (4.0, 0.3)]);
    }
}
