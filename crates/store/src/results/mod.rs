//! `results.h5`: one self-contained file that is readable while it is written and after a crash,
//! see `store`.
//!
//! ```text
//! /            attributes: program, version, case, seed, dimension
//! /case        text of the case, `--set` applied          /materials/NAME   texts of the material files
//! /shapes      of grains other than single balls, see [`shapes`]
//! /plugins     kind, name, version, sha256, path          /statistics/NAME  one column each, with unit
//! /events/TABLE/NAME  one value per event of the observers' tables
//! /views/grains, /views/contacts, /views/bodies           temporal VTKHDF PolyData
//! /views/shapes                                           temporal VTKHDF UnstructuredGrid of the grains' parts
//! /views/meshes/NAME, /views/surfaces/NAME                temporal VTKHDF UnstructuredGrid of deformable bodies
//! /checkpoints/even, /checkpoints/odd                    states for `--resume`, see [`crate::checkpoint`]
//! /VTKHDF      the grains' view                           grains.vtkhdf and others: links to the views, for ParaView
//! ```

mod dataset;
mod declare;
mod deformed;
mod events;
mod growth;
pub mod maps;
mod mesh_view;
mod previous;
mod reader;
mod shape_view;
pub mod shapes;
pub mod state;
mod store;
mod view;

pub use mesh_view::{Field, Mesh};
pub use previous::PreviousResults;
pub use reader::Reader;
pub use store::ResultsError;
pub use view::{Cells, Part};

use super::checkpoint::Frame;
use super::folder_lock::FolderLock;
use super::summary::PluginStamp;
use dataset::{GrowingDataset, Slot};
use declare::LONG_CHUNK;
use events::Events;
use fretwork_observe::observer::{Event, EventTable};
use fretwork_observe::statistics::Column;
use mesh_view::MeshView;
use shape_view::ShapeView;
use shapes::Shaped;
use std::path::Path;
use std::time::{Duration, Instant};
use store::Store;
use view::{View, ViewColumns};

/// Content that is known before the first step.
#[derive(Clone, Debug, Default)]
pub struct Header {
    /// Title of the case.
    pub case_name: String,
    /// Text of the case.
    pub case_text: String,
    /// Material files: name and text.
    pub materials: Vec<(String, String)>,
    /// Libraries of the laws.
    pub plugins: Vec<PluginStamp>,
    /// Seed of the case.
    pub seed: u64,
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Version of the program.
    pub version: String,
    /// Columns of the statistics.
    pub statistics: Vec<Column>,
    /// Fields of grains, contacts and bodies.
    pub fields: [Vec<Column>; 3],
    /// Integer fields of grains, contacts and bodies.
    pub numbers: [Vec<Column>; 3],
    /// Vector fields of grains, contacts and bodies.
    pub vectors: [Vec<Column>; 3],
    /// Tables of events.
    pub events: Vec<EventTable>,
    /// Shapes of grains other than single balls.
    pub shapes: Shaped,
    /// Corners of each part of grains and first bodies, as many at all times.
    pub corners: Vec<usize>,
    /// Meshes and surfaces of deformable bodies.
    pub meshes: Vec<Mesh>,
}

/// Limit on buffered rows of statistics, or events, regardless of time.
const MAX_BUFFERED_ROWS: usize = 8192;

/// Minimum time between flushes of a file.
const FLUSH_INTERVAL: Duration = Duration::from_secs(2);

/// Minimum time between flushes of a file that grows in place, since each flush syncs once per
/// dataset, about 200 times. Checkpoints also flush the file, usually earlier. Between flushes,
/// rows are written without a sync.
const FLUSH_INTERVAL_IN_PLACE: Duration = Duration::from_secs(60);

/// Flushes take at most 1/`FLUSH_COST_FACTOR` of the time on any disk.
const FLUSH_COST_FACTOR: u32 = 20;

/// The two checkpoint slots, written in turn.
const CHECKPOINTS: [&str; 2] = ["/checkpoints/even", "/checkpoints/odd"];

/// Results file of a run. The default has no file, and discards what is appended.
#[derive(Debug, Default)]
pub struct Results {
    store: Option<Store>,
    statistics: Vec<GrowingDataset>,
    buffered: Vec<Vec<f64>>,
    events: Vec<Events>,
    views: Vec<View>,
    shapes: Option<ShapeView>,
    meshes: Vec<MeshView>,
    /// Names of the companion files, and the views that they link to.
    companions: Vec<[String; 2]>,
    checkpoints: Vec<Slot>,
    /// Time and duration of the last flush.
    flushed: Option<(Instant, Duration)>,
}

impl Results {
    /// Creates the file under a temporary name, which it keeps until [`Results::publish`], and
    /// writes the header.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, ResultsError> {
        let mut store = Store::create(path)?;
        write_origin(&mut store, header)?;
        header.shapes.write(&mut store, header.dimension)?;
        store.group("/statistics")?;
        let mut statistics = Vec::new();
        for c in &header.statistics {
            let path = format!("/statistics/{}", c.name);
            statistics.push(store.growing::<f64>(
                &path,
                1,
                (c.unit.heading(header.dimension), c.doc),
                LONG_CHUNK,
            )?);
        }
        let events = Events::declare(&mut store, &header.events, header.dimension)?;
        let views = declare_views(&mut store, header)?;
        let shapes = (!header.corners.is_empty())
            .then(|| ShapeView::declare(&mut store, &header.corners, header.dimension))
            .transpose()?;
        let meshes = declare_meshes(&mut store, &header.meshes)?;
        store.link("/VTKHDF", "/views/grains")?;
        store.group("/checkpoints")?;
        let doc = "a checkpoint of the run; see docs/checkpoints.md";
        let checkpoints = CHECKPOINTS.map(|path| store.slot(path, doc));
        let checkpoints = checkpoints.into_iter().collect::<Result<_, _>>()?;
        store.start()?;
        Ok(Self {
            store: Some(store),
            statistics,
            buffered: vec![Vec::new(); header.statistics.len()],
            events,
            views,
            companions: companions(&header.meshes, shapes.is_some()),
            shapes,
            meshes,
            checkpoints,
            flushed: Some((Instant::now(), Duration::ZERO)),
        })
    }

    /// Sets the lock, with which every write first checks that the folder is still owned.
    pub fn owned_by(&mut self, lock: FolderLock) {
        if let Some(store) = &mut self.store {
            store.owned_by(lock);
        }
    }

    /// Renames the file to its final name, with all rows so far; an existing file is replaced.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn publish(&mut self, path: &Path) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        store.publish(path)
    }

    /// Writes buffered rows, and returns the number of rows of each growing dataset and the CRC-32
    /// of their bytes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn rows(&mut self) -> Result<Vec<(u64, u32)>, ResultsError> {
        self.write_buffered()?;
        let store = self.store.iter();
        Ok(store
            .flat_map(|s| s.grown().iter().map(|g| (g.rows, g.sum)))
            .collect())
    }

    /// Writes a checkpoint over the older of the two; it is synced to disk on return.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn checkpoint(&mut self, number: u64, bytes: &[u8]) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        let clock = Instant::now();
        // The rows that the checkpoint counts must be written first. Until its first word is
        // written, the checkpoint is invalid.
        let slot = self.checkpoints[(number % 2) as usize];
        store.write(slot, bytes, Frame::SEAL)?;
        self.flushed = Some((Instant::now(), clock.elapsed()));
        Ok(())
    }

    /// Stores a checkpoint to be written at the end of the file, see [`Results::finish`].
    pub fn set_final_checkpoint(&mut self, number: u64, bytes: &[u8]) {
        if let Some(store) = &mut self.store {
            store.buffer_slot(self.checkpoints[(number % 2) as usize], bytes);
        }
    }

    /// Writes a last state of the run, which the end of the file follows: in a file that grows in
    /// place at once, since its other checkpoint is overwritten at the end.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn keep_state(&mut self, number: u64, bytes: &[u8]) -> Result<(), ResultsError> {
        if self.store.as_ref().is_some_and(Store::grows_in_place) {
            return self.checkpoint(number, bytes);
        }
        self.set_final_checkpoint(number, bytes);
        Ok(())
    }

    /// Appends a row of statistics.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_statistics(&mut self, row: &[f64]) -> Result<(), ResultsError> {
        for (column, value) in self.buffered.iter_mut().zip(row) {
            column.push(*value);
        }
        self.flush_if_due(self.buffered.first().map_or(0, Vec::len))
    }

    /// Appends an event to its table.
    ///
    /// # Errors
    /// The file cannot be written, or it has no such table: [`Observer::event_tables`] did not
    /// declare it with this number of columns.
    ///
    /// [`Observer::event_tables`]: fretwork_observe::Observer::event_tables
    pub fn append_event(&mut self, event: &Event) -> Result<(), ResultsError> {
        if self.store.is_none() {
            return Ok(());
        }
        let Some(table) = self.events.iter_mut().find(|t| t.is_of(event)) else {
            return Err(ResultsError::UnknownEvent {
                table: event.table,
                columns: event.row.len(),
            });
        };
        table.hold(event);
        let rows = table.rows();
        self.flush_if_due(rows)
    }

    /// Flushes the file if enough time has passed, or if many rows are buffered.
    fn flush_if_due(&mut self, rows: usize) -> Result<(), ResultsError> {
        if rows >= MAX_BUFFERED_ROWS {
            self.write_buffered()?;
        }
        let interval = match self.store.as_ref().is_some_and(Store::grows_in_place) {
            true => FLUSH_INTERVAL_IN_PLACE,
            false => FLUSH_INTERVAL,
        };
        let rested = |(last, cost): (Instant, Duration)| {
            last.elapsed() >= interval.max(cost * FLUSH_COST_FACTOR)
        };
        let full = self.store.as_ref().is_some_and(Store::full);
        if full || self.flushed.is_none_or(rested) {
            self.flush()?;
        }
        Ok(())
    }

    /// Makes all appended rows visible to readers and syncs them to disk.
    fn flush(&mut self) -> Result<(), ResultsError> {
        self.write_buffered()?;
        let clock = Instant::now();
        let flushed = self.store.as_mut().map_or(Ok(()), Store::flush);
        self.flushed = Some((Instant::now(), clock.elapsed()));
        flushed
    }

    fn write_buffered(&mut self) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        for (column, values) in self.statistics.iter().zip(&mut self.buffered) {
            store.append(*column, values)?;
            values.clear();
        }
        self.events
            .iter_mut()
            .try_for_each(|table| table.write(store))
    }

    /// Appends one state of all meshes: the values of each field of each mesh. Must be called
    /// before [`Results::append_views`].
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_meshes(
        &mut self,
        time: f64,
        values: &[Vec<Vec<f64>>],
    ) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        let mut pairs = self.meshes.iter_mut().zip(values);
        pairs.try_for_each(|(mesh, values)| mesh.append(store, time, values))
    }

    /// Appends a state: grains, contacts, bodies, and the corners of the parts of grains and first
    /// bodies (m), three numbers each.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append_views(
        &mut self,
        time: f64,
        parts: &[Part; 3],
        corners: &[f64],
    ) -> Result<(), ResultsError> {
        let Some(store) = &mut self.store else {
            return Ok(());
        };
        for (view, part) in self.views.iter_mut().zip(parts) {
            view.append(store, time, part)?;
        }
        if let Some(shapes) = &mut self.shapes {
            shapes.append(store, corners)?;
        }
        self.flush_if_due(0)
    }

    /// Completes the file and writes its companion files.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(&mut self, folder: &Path) -> Result<(), ResultsError> {
        self.write_buffered()?;
        let Some(store) = self.store.take() else {
            return Ok(());
        };
        store.close()?;
        for [name, view] in &self.companions {
            store::companion(&folder.join(name), "results.h5", view)?;
        }
        Ok(())
    }
}

/// Writes where the results come from: program, case, materials, plugins.
fn write_origin(store: &mut Store, header: &Header) -> Result<(), ResultsError> {
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
    let links: Vec<String> = header.plugins.iter().map(|p| p.links.join("\n")).collect();
    if links.iter().any(|l| !l.is_empty()) {
        let texts: Vec<&str> = links.iter().map(String::as_str).collect();
        let doc = "libraries that it links to and that are not the system's, one a line: path and SHA-256";
        store.texts("/plugins/links", &texts, doc)?;
    }
    Ok(())
}

/// Declares the meshes of deformable bodies; no group is created without them.
fn declare_meshes(store: &mut Store, meshes: &[Mesh]) -> Result<Vec<MeshView>, ResultsError> {
    for group in ["meshes", "surfaces", "elastic_grains"] {
        let inside = |m: &Mesh| m.group.split('/').next() == Some(group);
        if meshes.iter().any(inside) {
            store.group(&format!("/views/{group}"))?;
        }
    }
    let declared = meshes.iter().map(|mesh| MeshView::declare(store, mesh));
    declared.collect()
}

/// Names of the files that link to the views, for ParaView, with these views.
fn companions(meshes: &[Mesh], shapes: bool) -> Vec<[String; 2]> {
    let always = ["grains", "contacts", "bodies"].map(str::to_owned);
    let shapes = shapes.then(|| "shapes".to_owned());
    let of_meshes = meshes.iter().map(|mesh| mesh.group.clone());
    let names = always.into_iter().chain(shapes).chain(of_meshes);
    names
        .map(|group| {
            let name = group.replacen("meshes/", "mesh_", 1);
            let name = name.replacen("surfaces/", "surface_", 1);
            let name = name.replacen("elastic_grains/", "elastic_grains_", 1);
            [format!("{name}.vtkhdf"), format!("/views/{group}")]
        })
        .collect()
}

/// Declares the views of grains, contacts and bodies.
fn declare_views(store: &mut Store, header: &Header) -> Result<Vec<View>, ResultsError> {
    store.group("/views")?;
    let bodies = if header.dimension == 2 {
        Cells::Lines
    } else {
        Cells::Polygons
    };
    let kinds = [
        ("grains", Cells::Vertices),
        ("contacts", Cells::Lines),
        ("bodies", bodies),
    ];
    let mut views = Vec::new();
    for (k, (name, cells)) in kinds.into_iter().enumerate() {
        let columns = ViewColumns {
            data: &header.fields[k],
            numbers: &header.numbers[k],
            vectors: &header.vectors[k],
            dimension: header.dimension,
        };
        let path = format!("/views/{name}");
        views.push(View::declare(store, &path, cells, columns)?);
    }
    Ok(views)
}
