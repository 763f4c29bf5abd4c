//! A mesh with data for a sequence of states, as temporal VTKHDF UnstructuredGrid. The unloaded
//! points and the cells are stored once, and every state refers to them; only the data change. A
//! reader of the file moves the points by the field `displacement`.
//!
//! Layout: Kitware, VTKHDF file format, version 2.0, transient data with static geometry.

use super::dataset::GrowingDataset;
use super::declare::{LONG_CHUNK, SHORT_CHUNK};
use super::store::{ResultsError, Store};

/// VTK types of cells by their number of corners: line, triangle, tetrahedron.
const KINDS: [(usize, u8); 3] = [(2, 3), (3, 5), (4, 10)];

/// A mesh, and the fields that it carries.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Group of the mesh in `/views`: `meshes/NAME`, `surfaces/NAME` or `elastic_grains/NAME`.
    pub group: String,
    /// Coordinates without load, three per point (m).
    pub points: Vec<f64>,
    /// Indices of the points of all cells, one cell after another.
    pub cells: Vec<i64>,
    /// Corners per cell: 2, 3 or 4.
    pub corners: usize,
    /// Fields, in the order of their values.
    pub fields: Vec<Field>,
    /// Identity of the body of each point and of each cell in a mesh of several bodies. Empty
    /// otherwise.
    pub bodies: [Vec<i64>; 2],
}

/// A field of a mesh.
#[derive(Clone, Debug)]
pub struct Field {
    /// Name of the dataset.
    pub name: &'static str,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// Explanation in one line.
    pub doc: &'static str,
    /// Numbers per value.
    pub width: usize,
    /// Whether there is one value per cell. Otherwise there is one per point.
    pub of_cells: bool,
}

impl Mesh {
    /// Path of the group in the file.
    pub fn path(&self) -> String {
        format!("/views/{}", self.group)
    }
}

/// A mesh declared in the file, to which states are appended.
#[derive(Debug)]
pub struct MeshView {
    /// Time of each state (s).
    values: GrowingDataset,
    /// For each state: first part, number of parts, first point, first cell, first corner.
    steps: [GrowingDataset; 5],
    /// Values of each field.
    data: Vec<GrowingDataset>,
    /// For each field: the row of its first value in each state.
    data_offsets: Vec<GrowingDataset>,
    /// Offsets of data that all states share: always 0.
    shared_offsets: Vec<GrowingDataset>,
    /// Number of states.
    count: i64,
    path: String,
}

impl MeshView {
    /// Declares a mesh in its own group, and writes its points and cells.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn declare(store: &mut Store, mesh: &Mesh) -> Result<Self, ResultsError> {
        let path = mesh.path();
        store.group(&path)?;
        store.integer_attribute(&path, "Version", &[2, 0])?;
        store.ascii_attribute(&path, "Type", "UnstructuredGrid")?;
        write_topology(store, &path, mesh)?;
        for group in [
            "PointData",
            "CellData",
            "Steps",
            "Steps/PointDataOffsets",
            "Steps/CellDataOffsets",
        ] {
            store.group(&format!("{path}/{group}"))?;
        }
        store.integer_attribute(&format!("{path}/Steps"), "NSteps", &[0])?;
        let doc = ("s", "time of the state");
        let values = store.growing::<f64>(&format!("{path}/Steps/Values"), 1, doc, SHORT_CHUNK)?;
        let mut whole = |name: &str, doc: &str| {
            store.growing::<i64>(&format!("{path}/Steps/{name}"), 1, ("", doc), SHORT_CHUNK)
        };
        let steps = [
            whole("PartOffsets", "number of the first part of each state; 0")?,
            whole("NumberOfParts", "parts of each state; 1")?,
            whole("PointOffsets", "first point of each state; 0")?,
            whole("CellOffsets", "first cell of each state; 0")?,
            whole("ConnectivityIdOffsets", "first corner of each state; 0")?,
        ];
        let (mut data, mut data_offsets) = (Vec::new(), Vec::new());
        for field in &mesh.fields {
            let place = if field.of_cells {
                "CellData"
            } else {
                "PointData"
            };
            let name = format!("{path}/{place}/{}", field.name);
            let doc = (field.unit, field.doc);
            data.push(store.growing::<f64>(&name, field.width as u64, doc, LONG_CHUNK)?);
            let name = format!("{path}/Steps/{place}Offsets/{}", field.name);
            let doc = ("", "first value of each state");
            data_offsets.push(store.growing::<i64>(&name, 1, doc, SHORT_CHUNK)?);
        }
        let mut shared_offsets = Vec::new();
        for (place, ids) in ["PointData", "CellData"].into_iter().zip(&mesh.bodies) {
            if ids.is_empty() {
                continue;
            }
            let doc = ("", "identity of the body, the same in all states");
            store.numbers(&format!("{path}/{place}/body"), 1, ids, doc)?;
            let name = format!("{path}/Steps/{place}Offsets/body");
            let doc = ("", "first value of each state; 0");
            shared_offsets.push(store.growing::<i64>(&name, 1, doc, SHORT_CHUNK)?);
        }
        Ok(Self {
            values,
            steps,
            data,
            data_offsets,
            shared_offsets,
            count: 0,
            path,
        })
    }

    /// Appends a state: its time (s) and the values of each field.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append(
        &mut self,
        store: &mut Store,
        time: f64,
        values: &[Vec<f64>],
    ) -> Result<(), ResultsError> {
        let columns = self.data.iter().zip(&self.data_offsets);
        for ((column, offsets), values) in columns.zip(values) {
            let first = store.rows(*column) as i64;
            store.append(*offsets, &[first])?;
            store.append(*column, values)?;
        }
        for offsets in &self.shared_offsets {
            store.append(*offsets, &[0i64])?;
        }
        for (column, value) in self.steps.iter().zip([0i64, 1, 0, 0, 0]) {
            store.append(*column, &[value])?;
        }
        store.append(self.values, &[time])?;
        self.count += 1;
        store.count(&self.steps_path(), "NSteps", self.count);
        Ok(())
    }

    /// Continues after the states that the file already has.
    pub fn resume(&mut self, store: &mut Store) {
        self.count = store.rows(self.values) as i64;
        store.count(&self.steps_path(), "NSteps", self.count);
    }

    fn steps_path(&self) -> String {
        format!("{}/Steps", self.path)
    }
}

/// Writes the points and cells, which all states share.
fn write_topology(store: &mut Store, path: &str, mesh: &Mesh) -> Result<(), ResultsError> {
    let cells = mesh.cells.len() / mesh.corners;
    let mut whole = |name: &str, values: &[i64], doc: &str| {
        store.numbers(&format!("{path}/{name}"), 1, values, ("", doc))
    };
    let points = [mesh.points.len() as i64 / 3];
    whole("NumberOfPoints", &points, "points of the mesh")?;
    whole("NumberOfCells", &[cells as i64], "its cells")?;
    let doc = "corners of all cells";
    whole("NumberOfConnectivityIds", &[mesh.cells.len() as i64], doc)?;
    let doc = "points of the corners, counted from 0";
    whole("Connectivity", &mesh.cells, doc)?;
    let offsets: Vec<i64> = (0..=cells).map(|k| (k * mesh.corners) as i64).collect();
    let doc = "where the corners of each cell begin, and where those of the last end";
    whole("Offsets", &offsets, doc)?;
    let kind = KINDS.iter().find(|(corners, _)| *corners == mesh.corners);
    let kind = kind.map_or(0, |(_, kind)| *kind);
    let doc = "kind of each cell: 3 line, 5 triangle, 10 tetrahedron";
    store.small_numbers(&format!("{path}/Types"), &vec![kind; cells], doc)?;
    let doc = ("m", "coordinates without load");
    store.numbers(&format!("{path}/Points"), 3, &mesh.points, doc)
}
