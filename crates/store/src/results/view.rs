//! A view: points, lines or polygons with data for a sequence of states, as temporal VTKHDF
//! PolyData.
//!
//! Layout: Kitware, VTKHDF file format, version 2.0 (all four kinds of cells must be present).

use super::dataset::GrowingDataset;
use super::declare::{LONG_CHUNK, SHORT_CHUNK};
use super::store::{ResultsError, Store};
use fretwork_observe::statistics::Column;

/// The kinds of cells of VTK's PolyData, in order.
const KINDS: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];

/// Kind of cells of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// One vertex per point; data on points.
    Vertices,
    /// Polylines; data on cells.
    Lines,
    /// Polygons; data on cells.
    Polygons,
}

impl Cells {
    fn kind(self) -> usize {
        match self {
            Self::Vertices => 0,
            Self::Lines => 1,
            Self::Polygons => 2,
        }
    }
}

/// One state of a view.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Coordinates, three per point (m).
    pub points: Vec<f64>,
    /// Points of each cell.
    pub cells: Vec<Vec<i64>>,
    /// One column per field, one value per point (vertices) or cell.
    pub data: Vec<Vec<f64>>,
    /// Integer fields, with one value per point or cell.
    pub numbers: Vec<Vec<i64>>,
    /// Vector fields, with three numbers per point or cell.
    pub vectors: Vec<Vec<f64>>,
}

/// The fields of a view, in the order of the columns of its [`Part`]s.
#[derive(Clone, Copy, Debug)]
pub struct ViewColumns<'a> {
    /// Fields of real numbers.
    pub data: &'a [Column],
    /// Fields of integers.
    pub numbers: &'a [Column],
    /// Fields of vectors.
    pub vectors: &'a [Column],
    /// Dimension of the run.
    pub dimension: usize,
}

/// A view in the file.
#[derive(Debug)]
pub struct View {
    cells: Cells,
    points: GrowingDataset,
    number_of_points: GrowingDataset,
    numbers: [[GrowingDataset; 2]; 4],
    connectivity: [GrowingDataset; 4],
    offsets: [GrowingDataset; 4],
    data: Vec<GrowingDataset>,
    whole: Vec<GrowingDataset>,
    vectors: Vec<GrowingDataset>,
    values: GrowingDataset,
    steps: [GrowingDataset; 3],
    cell_offsets: GrowingDataset,
    connectivity_offsets: GrowingDataset,
    data_offsets: Vec<GrowingDataset>,
    count: i64,
    path: String,
}

impl View {
    /// Declares a view in its own group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn declare(
        store: &mut Store,
        path: &str,
        cells: Cells,
        columns: ViewColumns<'_>,
    ) -> Result<Self, ResultsError> {
        store.group(path)?;
        store.integer_attribute(path, "Version", &[2, 0])?;
        store.ascii_attribute(path, "Type", "PolyData")?;
        let place = if cells == Cells::Vertices {
            "PointData"
        } else {
            "CellData"
        };
        store.group(&format!("{path}/{place}"))?;
        store.group(&format!("{path}/Steps"))?;
        store.group(&format!("{path}/Steps/{place}Offsets"))?;
        store.integer_attribute(&format!("{path}/Steps"), "NSteps", &[0])?;
        let doc = "points of each state";
        let number_of_points = declare_whole(store, path, "NumberOfPoints", (1, SHORT_CHUNK), doc)?;
        let all = declare_cells(store, path, cells)?;
        let doc = "number of the first part of each state";
        let parts = declare_whole(store, path, "Steps/PartOffsets", (1, SHORT_CHUNK), doc)?;
        let doc = "parts of each state; 1";
        let number = declare_whole(store, path, "Steps/NumberOfParts", (1, SHORT_CHUNK), doc)?;
        let doc = "first point of each state";
        let first_points = declare_whole(store, path, "Steps/PointOffsets", (1, SHORT_CHUNK), doc)?;
        let doc = "first cell of each state, by kind: vertices, lines, polygons, strips";
        let cell_offsets = declare_whole(store, path, "Steps/CellOffsets", (4, SHORT_CHUNK), doc)?;
        let doc = "first corner of each state, by kind: vertices, lines, polygons, strips";
        let name = "Steps/ConnectivityIdOffsets";
        let connectivity_offsets = declare_whole(store, path, name, (4, SHORT_CHUNK), doc)?;
        let doc = ("s", "time of the state");
        let values = store.growing::<f64>(&format!("{path}/Steps/Values"), 1, doc, SHORT_CHUNK)?;
        let doc = ("m", "coordinates");
        let points = store.growing::<f64>(&format!("{path}/Points"), 3, doc, LONG_CHUNK)?;
        let mut data_offsets = Vec::new();
        let [data, whole, vectors] = [
            (columns.data, 1, false),
            (columns.numbers, 1, true),
            (columns.vectors, 3, false),
        ]
        .map(|(fields, width, whole)| {
            let mut declare = |field: &Column| {
                let name = format!("{path}/{place}/{}", field.name);
                let doc = (field.unit.heading(columns.dimension), field.doc);
                let values = match whole {
                    true => store.growing::<i64>(&name, width, doc, LONG_CHUNK)?,
                    false => store.growing::<f64>(&name, width, doc, LONG_CHUNK)?,
                };
                let name = format!("Steps/{place}Offsets/{}", field.name);
                let doc = "first value of each state";
                data_offsets.push(declare_whole(store, path, &name, (1, SHORT_CHUNK), doc)?);
                Ok(values)
            };
            let fields = fields.iter().map(&mut declare);
            fields.collect::<Result<Vec<_>, ResultsError>>()
        });
        let (data, whole, vectors) = (data?, whole?, vectors?);
        Ok(Self {
            cells,
            points,
            number_of_points,
            numbers: all.map(|n| [n[0], n[1]]),
            connectivity: all.map(|n| n[3]),
            offsets: all.map(|n| n[2]),
            data,
            whole,
            vectors,
            values,
            steps: [parts, number, first_points],
            cell_offsets,
            connectivity_offsets,
            data_offsets,
            count: 0,
            path: path.to_owned(),
        })
    }

    /// Appends a state.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append(
        &mut self,
        store: &mut Store,
        time: f64,
        part: &Part,
    ) -> Result<(), ResultsError> {
        // The offsets of this part are taken before anything is appended.
        let first_cells: Vec<i64> = (0..4)
            .map(|k| store.rows(self.offsets[k]) as i64 - self.count)
            .collect();
        let first_ids: Vec<i64> = (0..4)
            .map(|k| store.rows(self.connectivity[k]) as i64)
            .collect();
        let first_point = store.rows(self.points) as i64;
        let columns = self.data.iter().chain(&self.whole).chain(&self.vectors);
        for (column, offsets) in columns.zip(&self.data_offsets) {
            let first = store.rows(*column) as i64;
            store.append(*offsets, &[first])?;
        }
        let numbers = self.data.iter().zip(&part.data);
        for (column, values) in numbers.chain(self.vectors.iter().zip(&part.vectors)) {
            store.append(*column, values)?;
        }
        for (column, values) in self.whole.iter().zip(&part.numbers) {
            store.append(*column, values)?;
        }
        store.append(self.points, &part.points)?;
        store.append(self.number_of_points, &[part.points.len() as i64 / 3])?;
        for kind in 0..4 {
            let mine = kind == self.cells.kind();
            let (mut ids, mut offsets) = (Vec::new(), vec![0i64]);
            if mine {
                for cell in &part.cells {
                    ids.extend_from_slice(cell);
                    offsets.push(ids.len() as i64);
                }
            }
            store.append(self.numbers[kind][0], &[offsets.len() as i64 - 1])?;
            store.append(self.numbers[kind][1], &[ids.len() as i64])?;
            store.append(self.offsets[kind], &offsets)?;
            store.append(self.connectivity[kind], &ids)?;
        }
        let [parts, number, points] = self.steps;
        store.append(parts, &[self.count])?;
        store.append(number, &[1i64])?;
        store.append(points, &[first_point])?;
        store.append(self.cell_offsets, &first_cells)?;
        store.append(self.connectivity_offsets, &first_ids)?;
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

/// Declares a dataset of integers of a view, with its width and chunk size.
fn declare_whole(
    store: &mut Store,
    path: &str,
    name: &str,
    (width, chunk): (u64, usize),
    doc: &str,
) -> Result<GrowingDataset, ResultsError> {
    store.growing::<i64>(&format!("{path}/{name}"), width, ("", doc), chunk)
}

/// Declares all four kinds of cells: numbers of cells and corners, offsets, connectivity of each.
fn declare_cells(
    store: &mut Store,
    path: &str,
    cells: Cells,
) -> Result<[[GrowingDataset; 4]; 4], ResultsError> {
    let mut kinds = Vec::new();
    for kind in KINDS {
        store.group(&format!("{path}/{kind}"))?;
        let used = KINDS[cells.kind()] == kind;
        let many = if used { LONG_CHUNK } else { SHORT_CHUNK };
        let mut column = |name: &str, chunk: usize, doc: &str| {
            declare_whole(store, path, &format!("{kind}/{name}"), (1, chunk), doc)
        };
        let doc = "corners of all cells of each state";
        let bounds = "where the corners of each cell begin, and where those of the last end";
        let corners = "points of the corners, counted in their state from 0";
        kinds.push([
            column("NumberOfCells", SHORT_CHUNK, "cells of each state")?,
            column("NumberOfConnectivityIds", SHORT_CHUNK, doc)?,
            column("Offsets", many, bounds)?,
            column("Connectivity", many, corners)?,
        ]);
    }
    Ok([kinds[0], kinds[1], kinds[2], kinds[3]])
}
