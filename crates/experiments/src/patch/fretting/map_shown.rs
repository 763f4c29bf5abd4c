//! A map of fretting as text, tables, fields and figures.

use crate::Error;
use crate::page::{section, table};
use crate::patch::fretting::map::{Edges, FrettingMap, Place};
use crate::patch::text::add_line;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::Estimate;
use fretwork_store::maps::{ImageGrid, MapField, Maps};
use fretwork_view::{Axis, Block, Chart, Section, Series, Style};
use std::path::Path;

/// Names of regimes, in the order of amplitude.
const REGIMES: [&str; 5] = [
    "stick",
    "partial slip",
    "mixed",
    "gross slip",
    "reciprocating sliding",
];
/// Names of responses.
const RESPONSES: [&str; 4] = ["no damage", "cracks", "wear", "cracks and wear"];

/// Returns the cells of an image over the logarithms to base 10 of axes in equal ratios; `None`
/// where an axis has one place.
fn equal_ratios(axes: [&[f64]; 2]) -> Option<ImageGrid> {
    let step = |axis: &[f64]| match axis {
        [first, .., last] => Some((last / first).log10() / (axis.len() - 1) as f64),
        _ => None,
    };
    let size = [step(axes[0])?, step(axes[1])?];
    Some(ImageGrid {
        cells: axes.map(<[f64]>::len),
        from: [0, 1].map(|k| axes[k][0].log10() - 0.5 * size[k]),
        size,
    })
}

fn within(estimate: Estimate, unit: &str) -> String {
    let (value, error) = (
        quantity(estimate.value, unit),
        quantity(estimate.error, unit),
    );
    format!("{value} +- {error}")
}

impl FrettingMap {
    fn all(&self) -> impl Iterator<Item = &Place> {
        self.places.iter().flatten()
    }

    /// Returns how many places have each name that occurs.
    fn counts(&self, names: &[&str], of: impl Fn(&Place) -> Option<&'static str>) -> String {
        let count = |name: &str| self.all().filter(|p| of(p) == Some(name)).count();
        let parts = names.iter().map(|name| (name, count(name)));
        let parts = parts.filter(|(_, n)| *n > 0);
        let parts: Vec<String> = parts.map(|(name, n)| format!("{name} {n}")).collect();
        parts.join(", ")
    }

    /// Returns the first, the middle and the last load.
    fn some(&self) -> Vec<&Edges> {
        let n = self.edges.len();
        let mut places = vec![0, n / 2, n.saturating_sub(1)];
        places.dedup();
        places.iter().filter_map(|k| self.edges.get(*k)).collect()
    }

    /// Returns the map as text.
    pub fn text(&self) -> String {
        let ends = |list: &[f64], unit: &str| {
            let [first, last] =
                [list.first(), list.last()].map(|v| quantity(v.copied().unwrap_or_default(), unit));
            format!("{first} to {last}")
        };
        let mut out = format!(
            "map of {} x {} places: loads {}, amplitudes {}",
            self.loads.len(),
            self.amplitudes.len(),
            ends(&self.loads, "N"),
            ends(&self.amplitudes, "m")
        );
        let mut add = |label: &str, text: String| {
            add_line(&mut out, label, &text);
        };
        add(
            "grid",
            format!(
                "{} x {} cells, {} s of the processor",
                self.cells[0],
                self.cells[1],
                number(self.seconds, 3)
            ),
        );
        add("regimes", self.counts(&REGIMES, |p| Some(p.regime_name())));
        for edges in self.some() {
            let at = quantity(edges.load, "N");
            add(
                &format!("under {at}"),
                format!(
                    "stick ends at {}, gross slip begins at {}",
                    within(edges.stick, "m"),
                    within(edges.gross_slip, "m")
                ),
            );
            let [ratio, slip] = edges.at_onset.map(|x| number(x, 3));
            add(
                "",
                format!(
                    "A = {ratio} and slip ratio {slip} at the onset; A = {} at {}; to and fro from {}",
                    number(self.limits.energy_ratio, 3),
                    within(edges.energy_ratio, "m"),
                    quantity(edges.reciprocating.value, "m")
                ),
            );
            if let Some([low, high]) = edges.mixed {
                let [low, high] = [low, high].map(|v| quantity(v, "m"));
                add(
                    "",
                    format!("mixed between {low} and {high}, the onsets of the members"),
                );
            }
            if let Some([crack, wear]) = edges.damage {
                let from = |v: f64| match v.is_finite() {
                    true => format!("from {}", quantity(v, "m")),
                    false => "nowhere".to_owned(),
                };
                add(
                    "",
                    format!("cracks {}, wear that counts {}", from(crack), from(wear)),
                );
            }
        }
        if let Some(cracks) = &self.cracks {
            add("response", self.counts(&RESPONSES, |p| p.response_name()));
            add(
                "",
                format!(
                    "{} of {} by the strength of {} after {} cycles; wear counts from {}",
                    cracks.criterion,
                    cracks.body,
                    cracks.strength,
                    number(cracks.cycles, 3),
                    quantity(cracks.depth, "m")
                ),
            );
        }
        add(
            "boundaries",
            "+- by the grid, and 0.1 % by bisection".to_owned(),
        );
        for note in &self.notes {
            add("", note.clone());
        }
        out
    }

    /// Writes `map.csv`, `map_boundaries.csv` and `map.h5` into a folder.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, out: &Path) -> Result<(), Error> {
        csv::write(&self.table(), &out.join("map.csv"), NumberFormat::Plain)?;
        let path = out.join("map_boundaries.csv");
        csv::write(&self.boundaries(), &path, NumberFormat::Plain)?;
        self.fields(&out.join("map.h5"))
    }

    fn table(&self) -> Table {
        let real = |name: &str, unit: &str, of: &dyn Fn(&Place) -> Option<f64>| {
            Column::real(name, unit, self.all().map(of).collect::<Vec<_>>())
        };
        let names = self.all().map(|p| p.regime_name().to_owned());
        let mut columns = vec![
            real("load", "N", &|p| Some(p.conditions.load)),
            real("amplitude", "m", &|p| Some(p.conditions.amplitude[0])),
            Column::text("regime", names.collect::<Vec<_>>()),
            real("force", "N", &|p| Some(p.conditions.amplitude[1])),
            real("force_over_load", "1", &|p| Some(p.conditions.adhesion())),
            real("energy", "J", &|p| Some(p.conditions.energy)),
            real("A", "1", &|p| Some(p.conditions.energy_ratio())),
            real("slip_ratio", "1", &|p| Some(p.conditions.slip_ratio)),
            real("stuck", "1", &|p| Some(p.conditions.stuck)),
        ];
        if !self.notes.is_empty() {
            columns.push(real("outside_table", "1", &|p| {
                Some(f64::from(u8::from(p.outside)))
            }));
        }
        for (body, part) in &self.bodies {
            let volume = format!("worn_volume_{body}");
            columns.push(real(&volume, "m^3", &|p| Some(part * p.conditions.worn[0])));
            let depth = format!("worn_depth_{body}");
            columns.push(real(&depth, "m", &|p| Some(part * p.conditions.worn[1])));
        }
        if self.cracks.is_some() {
            columns.push(real("crack_index", "1", &|p| p.crack));
            columns.push(real("worn_after_all_cycles", "m", &|p| p.worn));
            let names = self
                .all()
                .map(|p| p.response_name().unwrap_or("").to_owned());
            columns.push(Column::text("response", names.collect::<Vec<_>>()));
        }
        Table { columns }
    }

    fn boundaries(&self) -> Table {
        let edges = || self.edges.iter();
        let mut columns = vec![Column::real("load", "N", edges().map(|e| Some(e.load)))];
        let mut add = |name: &str, of: fn(&Edges) -> Estimate| {
            columns.push(Column::real(name, "m", edges().map(|e| Some(of(e).value))));
            let error = format!("{name}_error_of_grid");
            columns.push(Column::real(error, "m", edges().map(|e| Some(of(e).error))));
        };
        add("stick_ends", |e| e.stick);
        add("gross_slip_begins", |e| e.gross_slip);
        add("energy_ratio_reached", |e| e.energy_ratio);
        add("reciprocating_begins", |e| e.reciprocating);
        let onset = |k: usize| edges().map(move |e| Some(e.at_onset[k]));
        columns.push(Column::real("A_at_onset", "1", onset(0)));
        columns.push(Column::real("slip_ratio_at_onset", "1", onset(1)));
        let finite = |v: f64| v.is_finite().then_some(v);
        if edges().any(|e| e.mixed.is_some()) {
            for (k, name) in ["mixed_begins", "mixed_ends"].into_iter().enumerate() {
                let of = edges().map(|e| e.mixed.map(|m| m[k]));
                columns.push(Column::real(name, "m", of));
            }
        }
        if edges().any(|e| e.damage.is_some()) {
            for (k, name) in ["cracks_begin", "wear_begins"].into_iter().enumerate() {
                let of = edges().map(|e| e.damage.and_then(|m| finite(m[k])));
                columns.push(Column::real(name, "m", of));
            }
        }
        Table { columns }
    }

    fn fields(&self, path: &Path) -> Result<(), Error> {
        let fail = |e: fretwork_store::results::ResultsError| Error::Failed(e.to_string());
        let (amplitudes, loads) = (self.amplitudes.clone(), self.loads.clone());
        let axes = [
            ("amplitude", amplitudes, "m", "amplitudes of displacement"),
            ("load", loads, "N", "loads"),
        ];
        let mut maps = Maps::over(path, &axes).map_err(fail)?;
        let field = |name, unit, doc, of: &dyn Fn(&Place) -> f64| MapField {
            name,
            unit,
            doc,
            values: self.all().map(of).collect(),
        };
        let class = |names: &[&str], name: Option<&str>| {
            let place = names.iter().position(|n| Some(*n) == name);
            place.map_or(f64::NAN, |k| k as f64)
        };
        let mut list = vec![
            field(
                "regime",
                "1",
                "0 stick, 1 partial slip, 2 mixed, 3 gross slip, 4 reciprocating sliding",
                &|p| class(&REGIMES, Some(p.regime_name())),
            ),
            field("force", "N", "amplitude of the force", &|p| {
                p.conditions.amplitude[1]
            }),
            field("energy", "J", "energy of slip in a cycle", &|p| {
                p.conditions.energy
            }),
            field("A", "1", "energy over 4 Q delta", &|p| {
                p.conditions.energy_ratio()
            }),
            field("slip_ratio", "1", "opening over amplitude", &|p| {
                p.conditions.slip_ratio
            }),
            field("stuck", "1", "share that never slips", &|p| {
                p.conditions.stuck
            }),
            field(
                "worn_volume",
                "m^3",
                "worn off both bodies in a cycle",
                &|p| p.conditions.worn[0],
            ),
            field("worn_depth", "m", "largest depth in a cycle", &|p| {
                p.conditions.worn[1]
            }),
        ];
        if self.cracks.is_some() {
            list.push(field("crack_index", "1", "cracks from 1 on", &|p| {
                p.crack.unwrap_or(f64::NAN)
            }));
            list.push(field(
                "response",
                "1",
                "0 no damage, 1 cracks, 2 wear, 3 cracks and wear",
                &|p| class(&RESPONSES, p.response_name()),
            ));
        }
        match equal_ratios([&self.amplitudes, &self.loads]) {
            Some(grid) => maps.image(&grid, None, &list).map_err(fail)?,
            None => maps.group("fields", &list).map_err(fail)?,
        }
        maps.finish().map_err(fail)
    }

    /// Returns the sections of the page.
    pub fn sections(&self) -> Vec<Section> {
        let mut running = self.chart("running conditions", &REGIMES, |p| Some(p.regime_name()));
        let mut boundary = |label: &str, of: &dyn Fn(&Edges) -> f64| {
            running = std::mem::take(&mut running).with(self.line(label, of));
        };
        boundary("end of stick", &|e| e.stick.value);
        boundary("onset of gross slip", &|e| e.gross_slip.value);
        boundary("onset of sliding to and fro", &|e| e.reciprocating.value);
        let ring = number(100.0 * self.limits.ring, 2);
        running = running.note(format!(
            "Stick ends where {ring} % of the patch slips, gross slip begins where nothing sticks, and sliding to and fro where the amplitude is half of the width of the patch."
        ));
        let mut blocks = vec![Block::Figure(Box::new(running)), self.rows()];
        let first = self.amplitudes.len();
        let energy = Chart::new(
            "energy of a cycle",
            Axis::new("amplitude", "um").log(),
            Axis::new("energy of slip", "J").log(),
        );
        let some: Vec<f64> = self.some().iter().map(|e| e.load).collect();
        let rows = self.places.iter().filter(|row| {
            let load = row.first().map(|p| p.conditions.load);
            load.is_some_and(|l| some.contains(&l))
        });
        let series = rows.filter(|_| first > 1).map(|row| {
            let points = row.iter().filter(|p| p.conditions.energy > 0.0);
            let points = points.map(|p| (1e6 * p.conditions.amplitude[0], p.conditions.energy));
            let load = row.first().map_or(0.0, |p| p.conditions.load);
            Series::new(quantity(load, "N"), points.collect())
        });
        blocks.push(Block::Figure(Box::new(energy.with_all(series))));
        let mut out = vec![section("Map of running conditions", blocks)];
        if self.cracks.is_some() {
            let mut response = self.chart("response of the material", &RESPONSES, |p| {
                p.response_name()
            });
            response = response
                .with(self.line("cracks from here on", &|e| {
                    e.damage.map_or(f64::NAN, |d| d[0])
                }))
                .with(self.line("wear counts from here on", &|e| {
                    e.damage.map_or(f64::NAN, |d| d[1])
                }));
            out.push(section(
                "Map of the response of the material",
                vec![Block::Figure(Box::new(response))],
            ));
        }
        out
    }

    /// Returns a chart of the places by their names.
    fn chart(
        &self,
        title: &str,
        names: &[&str],
        of: impl Fn(&Place) -> Option<&'static str>,
    ) -> Chart {
        let mut chart = Chart::new(
            title,
            Axis::new("amplitude of displacement", "um").log(),
            Axis::new("load", "N").log(),
        );
        for name in names {
            let here = self.all().filter(|p| of(p) == Some(*name));
            let points = here.map(|p| (1e6 * p.conditions.amplitude[0], p.conditions.load));
            let points: Vec<(f64, f64)> = points.collect();
            if !points.is_empty() {
                chart = chart.with(Series::new(*name, points).style(Style::Markers));
            }
        }
        let [low, high] = [self.amplitudes.first(), self.amplitudes.last()]
            .map(|v| 1e6 * v.copied().unwrap_or(1.0));
        chart.x_range = Some((low / 1.1, 1.1 * high));
        chart
    }

    fn line(&self, label: &str, of: &dyn Fn(&Edges) -> f64) -> Series {
        let points = self.edges.iter().map(|e| (1e6 * of(e), e.load));
        let points = points.filter(|(x, _)| x.is_finite()).collect();
        Series::new(label, points)
    }

    /// Returns the boundaries as a table of the page.
    fn rows(&self) -> Block {
        let rows = self.edges.iter().map(|e| {
            let mut row = vec![quantity(e.load, "N")];
            row.extend([e.stick, e.gross_slip, e.reciprocating].map(|b| within(b, "m")));
            row.extend(e.at_onset.map(|x| number(x, 3)));
            row
        });
        table(
            "Boundaries of the regimes, with their error by the grid, and A and slip ratio at the onset of gross slip",
            [
                "load",
                "stick ends",
                "gross slip begins",
                "to and fro from",
                "A",
                "slip ratio",
            ],
            rows.collect(),
        )
    }
}
