//! Many cycles of a stroke as text, tables, fields and figures.

use crate::Error;
use crate::page::section;
use crate::patch::answer::Motion;
use crate::patch::files::image_grid;
use crate::patch::fretting::cycles::History;
use crate::patch::text::add_line;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::Scar;
use fretwork_store::maps::{MapField, Maps, States};
use fretwork_view::{Axis, Block, Chart, Section, Series, Style};
use std::path::Path;

/// Number of profiles of a scar that are drawn.
const PROFILES: usize = 6;

impl History {
    /// Returns the cycles as text; forces are over this load (N).
    pub fn text(&self, load: f64) -> String {
        let (first, end) = (&self.scars[0], self.end());
        let Motion::Fretting(amplitude) = self.motion else {
            return String::new();
        };
        let mut out = format!(
            "{} cycles of {}",
            number(end.cycles, 4),
            quantity(amplitude, "m")
        );
        let mut add = |label: &str, text: String| {
            add_line(&mut out, label, &text);
        };
        let [volume, depth, force] = self.error_of_grid;
        let ratio = |scar: &Scar| number(scar.amplitude[1] / load, 4);
        add(
            "Q/P",
            format!(
                "{} at first, {} at the end +- {} by the grid, {} by the jumps",
                ratio(first),
                ratio(end),
                number(force / load, 2),
                number(end.error[1] / load, 2)
            ),
        );
        add(
            "energy of a cycle",
            format!(
                "{} at first, {} at the end",
                quantity(first.energy, "J"),
                quantity(end.energy, "J")
            ),
        );
        if end.volume > 0.0 {
            add(
                "worn",
                format!(
                    "{} mm3 +- {} by the grid, both bodies together",
                    number(1e9 * end.volume, 4),
                    number(1e9 * volume, 2)
                ),
            );
            add(
                "deepest",
                format!(
                    "{} +- {} by the grid, {} by the jumps",
                    quantity(end.deepest, "m"),
                    quantity(depth, "m"),
                    quantity(end.error[0], "m")
                ),
            );
            add(
                "debris",
                format!(
                    "{} mm3 between the bodies, {} mm3 have left; {} of the volume is missing",
                    number(1e9 * end.between, 4),
                    number(1e9 * end.ejected, 4),
                    number(end.unaccounted(), 1)
                ),
            );
            add(
                "largest pressure",
                format!(
                    "{} at first, {} at the end",
                    quantity(first.peak, "Pa"),
                    quantity(end.peak, "Pa")
                ),
            );
        }
        add("jumps", end.jumps.to_string());
        for note in &self.notes {
            add("", note.clone());
        }
        out
    }

    /// Writes the table of the cycles and the fields at the end into a folder.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, load: f64, out: &Path, number: usize) -> Result<(), Error> {
        let path = out.join(format!("cycles_{number}.csv"));
        csv::write(&self.table(load), &path, NumberFormat::Plain)?;
        self.fields(&out.join(format!("cycles_{number}.h5")))
    }

    fn table(&self, load: f64) -> Table {
        let real = |name: &str, unit: &str, of: &dyn Fn(&Scar) -> f64| {
            let values: Vec<_> = self.scars.iter().map(|s| Some(of(s))).collect();
            Column::real(name, unit, values)
        };
        Table {
            columns: vec![
                real("cycles", "1", &|s| s.cycles),
                real("force", "N", &|s| s.amplitude[1]),
                real("force_over_load", "1", &|s| s.amplitude[1] / load),
                real("displacement", "m", &|s| s.amplitude[0]),
                real("energy", "J", &|s| s.energy),
                real("stuck", "1", &|s| s.stuck),
                real("worn_volume", "m^3", &|s| s.volume),
                real("debris_volume", "m^3", &|s| s.between),
                real("ejected_volume", "m^3", &|s| s.ejected),
                real("deepest", "m", &|s| s.deepest),
                real("largest_pressure", "Pa", &|s| s.peak),
                real("area", "m^2", &|s| s.area),
            ],
        }
    }

    fn fields(&self, path: &Path) -> Result<(), Error> {
        let fail = |e: fretwork_store::results::ResultsError| Error::Failed(e.to_string());
        let grid = image_grid(&self.grid);
        let mut maps = Maps::over_cells(path, &grid).map_err(fail)?;
        let both = [&self.scars[0], self.end()];
        let field = |name, unit, doc, of: fn(&Scar) -> &[f64]| MapField {
            name,
            unit,
            doc,
            values: both.iter().flat_map(|s| of(s)).copied().collect(),
        };
        let list = [
            field("depth", "m", "depth worn off both bodies", |s| &s.depth),
            field("debris", "m", "debris, volume over area", |s| &s.debris),
            field("pressure", "Pa", "pressure", |s| &s.pressure),
        ];
        let states = States {
            values: both.map(|s| s.cycles).to_vec(),
            unit: "1",
            doc: "cycles",
        };
        maps.image(&grid, Some(&states), &list).map_err(fail)?;
        maps.finish().map_err(fail)
    }

    /// Returns the section of the page.
    pub fn section(&self, load: f64, number: usize) -> Section {
        let over = |title: &str, y: Axis, of: &dyn Fn(&Scar) -> f64| {
            let scars = self.scars.iter();
            let points = scars.map(|s| (s.cycles, of(s))).collect();
            let series = Series::new("", points).style(Style::LineMarkers);
            let chart = Chart::new(title, Axis::new("cycles", ""), y);
            Block::Figure(Box::new(chart.with(series)))
        };
        let mut blocks = vec![over(
            "friction over the cycles",
            Axis::new("force over load", ""),
            &|s| s.amplitude[1] / load,
        )];
        if self.end().volume > 0.0 {
            blocks.push(over(
                "worn volume",
                Axis::new("volume of both bodies", "mm3"),
                &|s| 1e9 * s.volume,
            ));
            blocks.push(over(
                "debris between the bodies",
                Axis::new("volume", "mm3"),
                &|s| 1e9 * s.between,
            ));
            let depth = self.profiles("scar", Axis::new("depth of both bodies", "um"), &|s, c| {
                1e6 * s.depth[c]
            });
            let pressure = self.profiles("pressure", Axis::new("pressure", "MPa"), &|s, c| {
                1e-6 * s.pressure[c]
            });
            blocks.push(Block::Figure(Box::new(depth)));
            blocks.push(Block::Figure(Box::new(pressure)));
        }
        section(format!("Cycles of point {number}"), blocks)
    }

    /// Returns profiles along the middle row at some cycles.
    fn profiles(&self, title: &str, y: Axis, of: &dyn Fn(&Scar, usize) -> f64) -> Chart {
        let grid = &self.grid;
        let row = grid.cells[1] / 2;
        let mut chart = Chart::new(title, Axis::new("along the motion", "mm"), y);
        let last = self.scars.len() - 1;
        let mut shown: Vec<usize> = (0..PROFILES).map(|k| k * last / (PROFILES - 1)).collect();
        shown.dedup();
        for scar in shown.into_iter().map(|k| &self.scars[k]) {
            let points = (0..grid.cells[0]).map(|i| {
                let cell = grid.cell([i, row]);
                (1e3 * grid.middle(cell)[0], of(scar, cell))
            });
            let label = format!("{} cycles", number(scar.cycles, 3));
            chart = chart.with(Series::new(label, points.collect()));
        }
        chart
    }
}
