//! `results.h5`: one self-contained file, readable while it is written and after a crash, see `store`.
//!
//! ```text
//! /            attributes: program, version, case, seed, dimension
//! /case        the case as text, `--set` applied          /materials/NAME   their texts
//! /shapes      of grains that are no lone balls, see [`shapes`]
//! /plugins     kind, name, version, sha256, path          /statistics/NAME  one column each, with unit
//! /events/broken/NAME  one value a bond that broke         /events/debris/NAME  one a piece that came loose
//! /events/debris/grains  identities of their grains, piece after piece
//! /views/grains, /views/contacts, /views/bodies           temporal VTKHDF PolyData
//! /checkpoints/even, /checkpoints/odd                    what `--resume` goes on from, see [`crate::checkpoint`]
//! /VTKHDF      the grains' view, for ParaView             contacts.vtkhdf, bodies.vtkhdf: links to the others
//! ```

mod dataset;
mod declare;
mod events;
mod growth;
mod kept;
mod reader;
pub mod shapes;
pub mod state;
mod store;
mod view;

pub use kept::PreviousResults;
pub use reader::Reader;
pub use store::ResultsError;
pub use view::{Cells, Part};

use super::summary::PluginStamp;
use dataset::{Growing, Slot};
use declare::MANY;
use events::Events;
use fretwork_observe::observer::Event;
use fretwork_observe::statistics::Column;
use shapes::Shaped;
use std::path::Path;
use std::time::{Duration, Instant};
use store::Store;
use view::View;

/// What is known before the first step.
#[derive(Clone, Debug, Default)]
pub struct Header {
    /// Title of the case.
    pub case_name: String,
    /// The case.
    pub case_text: String,
    /// Material files: name and text.
    pub materials: Vec<(String, String)>,
    /// Laws.
    pub plugins: Vec<PluginStamp>,
    /// Seed.
    pub seed: u64,
    /// 2 or 3.
    pub dimension: usize,
    /// Version of the program.
    pub version: String,
    /// Columns of the statistics.
    pub statistics: Vec<Column>,
    /// Fields of grains, contacts and bodies.
    pub fields: [Vec<Column>; 3],
    /// Fields of them that are whole numbers.
    pub numbers: [Vec<Column>; 3],
    /// Columns of the bonds that break; empty where nothing bonds.
    pub broken: Vec<Column>,
    /// Columns of debris; empty without a circuit.
    pub debris: Vec<Column>,
    /// Shapes of grains that are no lone balls.
    pub shapes: Shaped,
}

/// Most rows of statistics, or events, that are held back, however short the time since the last were written.
const MAX_HELD_ROWS: usize = 8192;

/// The file is flushed no more often than this.
const PACE: Duration = Duration::from_secs(2);

/// And one that grows in place no more often than this: its flush syncs once a dataset, some 200 times. Checkpoints, which
/// flush it too, mostly come before; between them its rows are handed to the system all the same.
const PACE_IN_PLACE: Duration = Duration::from_secs(60);

/// And no more often than takes one part in so many of the time: files and disks differ.
const PART: u32 = 20;

/// The checkpoints, written in turn.
const CHECKPOINTS: [&str; 2] = ["/checkpoints/even", "/checkpoints/odd"];

/// The results file of a run; by default none, and what is appended to it is lost.
#[derive(Debug, Default)]
pub struct Results {
    store: Option<Store>,
    statistics: Vec<Growing>,
    held: Vec<Vec<f64>>,
    broken: Events,
    debris: Events,
    debris_grains: Option<Growing>,
    held_grains: Vec<f64>,
    views: Vec<View>,
    checkpoints: Vec<Slot>,
    /// When the file was flushed, and how long that took.
    flushed: Option<(Instant, Duration)>,
}

impl Results {
    /// Creates the file and writes what is known. It has another name until [`Results::publish`].
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, ResultsError> {
        let mut store = Store::create(path)?;
        for (name, text) in [
            ("program", "fretwork"),
            ("version", &header.version),
            ("case", &header.case_name),
            (
                "units",
                "SI; in two dimensions masses, forces and energies are per metre of depth",
            ),
        ] {
            store.text_attribute("/", name, text)?;
        }
        store.integer_attribute("/", "seed", &[header.seed as i64])?;
        store.integer_attribute("/", "dimension", &[header.dimension as i64])?;
        let doc = "the case as it was run, changes of the command line applied";
        store.texts("/case", &[&header.case_text], doc)?;
        store.group("/materials")?;
        for (name, text) in &header.materials {
            store.texts(&format!("/materials/{name}"), &[text], "the material file")?;
        }
        store.group("/plugins")?;
        type Get = fn(&PluginStamp) -> &str;
        let columns: [(&str, &str, Get); 5] = [
            ("kind", "kind of the law", |p| &p.kind),
            ("name", "its name", |p| &p.name),
            ("version", "its version", |p| &p.version),
            ("sha256", "SHA-256 of its library", |p| &p.sha256),
            ("path", "where its library was found", |p| &p.path),
        ];
        for (name, doc, get) in columns {
            let texts: Vec<&str> = header.plugins.iter().map(get).collect();
            if !texts.is_empty() {
                store.texts(&format!("/plugins/{name}"), &texts, doc)?;
            }
        }
        header.shapes.write(&mut store, header.dimension)?;
        store.group("/statistics")?;
        let mut statistics = Vec::new();
        for c in &header.statistics {
            statistics.push(store.growing::<f64>(
                &format!("/statistics/{}", c.name),
                1,
                (c.unit, c.doc),
                MANY,
            )?);
        }
        if !header.broken.is_empty() || !header.debris.is_empty() {
            store.group("/events")?;
        }
        let broken = Events::declare(&mut store, "/events/broken", &header.broken)?;
        let debris = Events::declare(&mut store, "/events/debris", &header.debris)?;
        let doc = "identities of the grains of all pieces, one piece after another";
        let debris_grains = match header.debris.is_empty() {
            true => None,
            false => Some(store.growing::<f64>("/events/debris/grains", 1, ("", doc), MANY)?),
        };
        store.group("/views")?;
        let bodies = if header.dimension == 2 {
            Cells::Lines
        } else {
            Cells::Polygons
        };
        let mut views = Vec::new();
        let all = header.fields.iter().zip(&header.numbers);
        let kinds = [
            ("grains", Cells::Vertices),
            ("contacts", Cells::Lines),
            ("bodies", bodies),
        ];
        for ((name, cells), (fields, numbers)) in kinds.into_iter().zip(all) {
            let path = format!("/views/{name}");
            views.push(View::declare(&mut store, &path, cells, (fields, numbers))?);
        }
        store.link("/VTKHDF", "/views/grains")?;
        store.group("/checkpoints")?;
        let doc = "a checkpoint of the run; see docs/checkpoints.md";
        let checkpoints = CHECKPOINTS.map(|path| store.slot(path, doc));
        let checkpoints = checkpoints.into_iter().collect::<Result<_, _>>()?;
        store.start()?;
        Ok(Self {
            store: Some(store),
            statistics,
            held: vec![Vec::new(); header.statistics.len()],
            broken,
            debris,
            debris_grains,
            held_grains: Vec::new(),
            views,
            checkpoints,
            flushed: Some((Instant::now(), Duration::ZERO)),
        })
    }

    /// Gives the file its name, with what was written so far: one that stood there is replaced.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn publish(&mut self, path: &Path) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        store.publish(path)
    }

    /// Rows of each growing dataset and the CRC-32 of their bytes, with those that are held back: these are written first.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn rows(&mut self) -> Result<Vec<(u64, u32)>, ResultsError> {
        self.write_held()?;
        let store = self.store.iter();
        Ok(store
            .flat_map(|s| s.grown().iter().map(|g| (g.rows, g.sum)))
            .collect())
    }

    /// Writes a checkpoint, over the last but one; it is safe when this returns.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn checkpoint(&mut self, number: u64, bytes: &[u8]) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        let clock = Instant::now();
        // The rows that it counts must be there before it is: without its first word it is none.
        store.write(self.checkpoints[(number % 2) as usize], bytes, 8)?;
        self.flushed = Some((Instant::now(), clock.elapsed()));
        Ok(())
    }

    /// Keeps a checkpoint for the end of the file, see [`Results::finish`].
    pub fn keep(&mut self, number: u64, bytes: &[u8]) {
        if let Some(store) = &mut self.store {
            store.keep(self.checkpoints[(number % 2) as usize], bytes);
        }
    }

    /// Appends a row of statistics.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_statistics(&mut self, row: &[f64]) -> Result<(), ResultsError> {
        for (column, value) in self.held.iter_mut().zip(row) {
            column.push(*value);
        }
        self.write_in_time(self.held.first().map_or(0, Vec::len))
    }

    /// Appends an event to its table; one of a table that the file does not have is left out.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_event(&mut self, event: &Event) -> Result<(), ResultsError> {
        match event.table {
            "broken" => {
                self.broken.hold(&event.row);
                self.write_in_time(self.broken.rows())
            }
            "debris" => {
                self.debris.hold(&event.row);
                self.held_grains.extend_from_slice(&event.grains);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Flushes the file if enough time has passed; many rows are not held back until then.
    fn write_in_time(&mut self, rows: usize) -> Result<(), ResultsError> {
        if rows >= MAX_HELD_ROWS {
            self.write_held()?;
        }
        let pace = match self.store.as_ref().is_some_and(Store::grows_in_place) {
            true => PACE_IN_PLACE,
            false => PACE,
        };
        let rested = |(last, cost): (Instant, Duration)| last.elapsed() >= pace.max(cost * PART);
        let full = self.store.as_ref().is_some_and(Store::full);
        if full || self.flushed.is_none_or(rested) {
            self.flush()?;
        }
        Ok(())
    }

    /// Makes all that was appended visible and safe.
    fn flush(&mut self) -> Result<(), ResultsError> {
        self.write_held()?;
        let clock = Instant::now();
        let flushed = self.store.as_mut().map_or(Ok(()), Store::flush);
        self.flushed = Some((Instant::now(), clock.elapsed()));
        flushed
    }

    fn write_held(&mut self) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        for (column, values) in self.statistics.iter().zip(&mut self.held) {
            store.append(*column, values)?;
            values.clear();
        }
        self.broken.write(store)?;
        // Identities first: a piece that can be read has all its grains.
        if let Some(list) = &self.debris_grains {
            store.append(*list, &self.held_grains)?;
            self.held_grains.clear();
        }
        self.debris.write(store)
    }

    /// Appends a state: grains, contacts, bodies.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_views(&mut self, time: f64, parts: &[Part; 3]) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        for (view, part) in self.views.iter_mut().zip(parts) {
            view.append(store, time, part)?;
        }
        self.write_in_time(0)
    }

    /// Ends the file and writes its companions beside it.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(&mut self, folder: &Path) -> Result<(), ResultsError> {
        self.write_held()?;
        let Some(store) = self.store.take() else {
            return Ok(());
        };
        store.close()?;
        for name in ["contacts", "bodies"] {
            let path = folder.join(format!("{name}.vtkhdf"));
            store::companion(&path, "results.h5", &format!("/views/{name}"))?;
        }
        Ok(())
    }
}
