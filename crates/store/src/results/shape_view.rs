//! The parts of grains and first bodies as cells, as temporal VTKHDF UnstructuredGrid: one cell for
//! each point of the grains' view, whose fields are those of the points. Only the corners move, so
//! that cells are stored once, and the fields not a second time.
//!
//! Layout: Kitware, VTKHDF file format, version 2.0, with links in place of data of cells.

use super::dataset::GrowingDataset;
use super::declare::{LONG_CHUNK, SHORT_CHUNK};
use super::store::{ResultsError, Store};

/// Path of the view.
pub(super) const PATH: &str = "/views/shapes";
/// Path of the view whose fields it has.
const GRAINS: &str = "/views/grains";

/// VTK types of cells.
const VERTEX: u8 = 1;
const POLYGON: u8 = 7;
const CONVEX_POINT_SET: u8 = 41;

/// The view in the file.
#[derive(Debug)]
pub struct ShapeView {
    points: GrowingDataset,
    /// For each state: first part, number of parts, first cell, first corner.
    steps: [GrowingDataset; 4],
    first_points: GrowingDataset,
    count: i64,
}

impl ShapeView {
    /// Declares the view for parts with these numbers of corners, of a run of a dimension. The view
    /// of grains must be declared.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn declare(
        store: &mut Store,
        corners: &[usize],
        dimension: usize,
    ) -> Result<Self, ResultsError> {
        store.group(PATH)?;
        store.integer_attribute(PATH, "Version", &[2, 0])?;
        store.ascii_attribute(PATH, "Type", "UnstructuredGrid")?;
        let at = |name: &str| format!("{PATH}/{name}");
        let mut whole =
            |name: &str, values: &[i64], doc: &str| store.numbers(&at(name), 1, values, ("", doc));
        let all: usize = corners.iter().sum();
        whole("NumberOfPoints", &[all as i64], "corners of all parts")?;
        whole("NumberOfCells", &[corners.len() as i64], "parts")?;
        whole("NumberOfConnectivityIds", &[all as i64], "corners")?;
        let ids: Vec<i64> = (0..all as i64).collect();
        whole("Connectivity", &ids, "points of the corners")?;
        let mut offsets = vec![0i64];
        offsets.extend(corners.iter().scan(0, |sum, n| {
            *sum += *n as i64;
            Some(*sum)
        }));
        let doc = "where the corners of each part begin, and where those of the last end";
        whole("Offsets", &offsets, doc)?;
        let kind = |n: &usize| match (*n, dimension) {
            (1, _) => VERTEX,
            (_, 2) => POLYGON,
            _ => CONVEX_POINT_SET,
        };
        let kinds: Vec<u8> = corners.iter().map(kind).collect();
        let doc = "kind of each part: 1 point, 7 polygon, 41 convex hull of its corners";
        if !kinds.is_empty() {
            store.small_numbers(&at("Types"), &kinds, doc)?;
        }
        let doc = ("m", "coordinates");
        let points = store.growing::<f64>(&at("Points"), 3, doc, LONG_CHUNK)?;
        store.link(&at("CellData"), &format!("{GRAINS}/PointData"))?;
        store.group(&at("Steps"))?;
        store.integer_attribute(&at("Steps"), "NSteps", &[0])?;
        store.link(&at("Steps/Values"), &format!("{GRAINS}/Steps/Values"))?;
        let offsets = format!("{GRAINS}/Steps/PointDataOffsets");
        store.link(&at("Steps/CellDataOffsets"), &offsets)?;
        let mut column = |name: &str, doc: &str| {
            store.growing::<i64>(&at(&format!("Steps/{name}")), 1, ("", doc), SHORT_CHUNK)
        };
        Ok(Self {
            points,
            steps: [
                column("PartOffsets", "number of the first part of each state; 0")?,
                column("NumberOfParts", "parts of each state; 1")?,
                column("CellOffsets", "first cell of each state; 0")?,
                column("ConnectivityIdOffsets", "first corner of each state; 0")?,
            ],
            first_points: column("PointOffsets", "first point of each state")?,
            count: 0,
        })
    }

    /// Appends a state: the corners of all parts (m), three numbers each.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append(&mut self, store: &mut Store, corners: &[f64]) -> Result<(), ResultsError> {
        let first = store.rows(self.points) as i64;
        store.append(self.first_points, &[first])?;
        store.append(self.points, corners)?;
        for (column, value) in self.steps.iter().zip([0i64, 1, 0, 0]) {
            store.append(*column, &[value])?;
        }
        self.count += 1;
        store.count(&format!("{PATH}/Steps"), "NSteps", self.count);
        Ok(())
    }

    /// Continues after the states that the file already has.
    pub fn resume(&mut self, store: &mut Store) {
        self.count = store.rows(self.first_points) as i64;
        store.count(&format!("{PATH}/Steps"), "NSteps", self.count);
    }
}
