//! Fields over two axes, in a file of their own, and as an image that VTK's reader opens.
//!
//! ```text
//! /x, /y                    places on both axes, with unit and doc
//! /GROUP/FIELD              rows along y, columns along x, with unit and doc
//! /fields/FIELD             the same of an image; of one with states, state by state
//! /states                   what a state is
//! /VTKHDF                   the image: temporal VTKHDF ImageData whose cell data are the fields
//! NAME.vtkhdf               links to it from a file beside it, for ParaView
//! ```
//!
//! Layout: Kitware, VTKHDF file format, version 2.0, image data; a state is a slice of the first
//! dimension.

use super::store::{ResultsError, Store, companion};
use std::path::{Path, PathBuf};

/// The group of an image.
const IMAGE: &str = "/VTKHDF";

/// A field: a number for each place, row by row.
#[derive(Clone, Debug)]
pub struct MapField {
    /// Name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Values.
    pub values: Vec<f64>,
}

/// Cells of an image, all of one size.
#[derive(Clone, Copy, Debug)]
pub struct ImageGrid {
    /// Number of cells along x and y.
    pub cells: [usize; 2],
    /// Corner of the first cell.
    pub from: [f64; 2],
    /// Sides of a cell.
    pub size: [f64; 2],
}

/// States of an image: their values, which ascend, and what they are.
#[derive(Clone, Debug)]
pub struct States {
    /// Values, which VTK takes as times.
    pub values: Vec<f64>,
    /// SI unit.
    pub unit: &'static str,
    /// Description.
    pub doc: &'static str,
}

/// A file of fields that is being written.
#[derive(Debug)]
pub struct Maps {
    store: Store,
    columns: u64,
    path: PathBuf,
    image: bool,
}

impl Maps {
    /// Creates the file for fields over cells, the axes of whose middles are x along the motion and
    /// y across it (m).
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn over_cells(path: &Path, grid: &ImageGrid) -> Result<Self, ResultsError> {
        let axis = |k: usize, name, doc| {
            let cells = (0..grid.cells[k]).map(|i| i as f64 + 0.5);
            let places = cells.map(|i| grid.from[k] + i * grid.size[k]);
            (name, places.collect::<Vec<f64>>(), "m", doc)
        };
        let axes = [
            axis(0, "x", "middles of the cells along the motion"),
            axis(1, "y", "middles of the cells across the motion"),
        ];
        Self::over(path, &axes)
    }

    /// Creates the file for fields over axes, those of columns and of rows: name, places, unit and
    /// doc.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn over(
        path: &Path,
        axes: &[(&str, Vec<f64>, &str, &str); 2],
    ) -> Result<Self, ResultsError> {
        let mut store = Store::create(&path.with_extension("h5.part"))?;
        for (name, places, unit, doc) in axes {
            store.numbers(&format!("/{name}"), 1, places, (unit, doc))?;
        }
        Ok(Self {
            store,
            columns: axes[0].1.len() as u64,
            path: path.to_owned(),
            image: false,
        })
    }

    /// Adds a group of fields.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn group(&mut self, name: &str, fields: &[MapField]) -> Result<(), ResultsError> {
        let group = format!("/{name}");
        self.store.group(&group)?;
        for field in fields {
            let path = format!("{group}/{}", field.name);
            let about = (field.unit, field.doc);
            self.store
                .numbers(&path, self.columns, &field.values, about)?;
        }
        Ok(())
    }

    /// Writes the fields as an image; those of an image with states have the values of one state
    /// after another.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn image(
        &mut self,
        grid: &ImageGrid,
        states: Option<&States>,
        fields: &[MapField],
    ) -> Result<(), ResultsError> {
        let store = &mut self.store;
        let [columns, rows] = grid.cells;
        let inside = |name: &str| format!("{IMAGE}/{name}");
        store.group(IMAGE)?;
        store.integer_attribute(IMAGE, "Version", &[2, 0])?;
        store.ascii_attribute(IMAGE, "Type", "ImageData")?;
        let extent = [0, columns as i64, 0, rows as i64, 0, 0];
        store.integer_attribute(IMAGE, "WholeExtent", &extent)?;
        let in_plane = |[x, y]: [f64; 2], z: f64| [x, y, z];
        store.real_attribute(IMAGE, "Origin", &in_plane(grid.from, 0.0))?;
        // VTK asks for a thickness above 0 of an image of one layer, too.
        let thick = grid.size[0].min(grid.size[1]);
        store.real_attribute(IMAGE, "Spacing", &in_plane(grid.size, thick))?;
        let straight = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        store.real_attribute(IMAGE, "Direction", &straight)?;
        store.group(&inside("CellData"))?;
        let shape = match states {
            Some(states) => vec![states.values.len(), rows, columns],
            None => vec![rows, columns],
        };
        for field in fields {
            let path = inside(&format!("CellData/{}", field.name));
            store.array(&path, &shape, &field.values, (field.unit, field.doc))?;
        }
        if let Some(states) = states {
            let steps = inside("Steps");
            store.group(&steps)?;
            store.integer_attribute(&steps, "NSteps", &[states.values.len() as i64])?;
            let about = (states.unit, states.doc);
            store.numbers(&inside("Steps/Values"), 1, &states.values, about)?;
            store.link("/states", &inside("Steps/Values"))?;
        }
        store.link("/fields", &inside("CellData"))?;
        self.image = true;
        Ok(())
    }

    /// Ends the file and gives it its name, and the one that links to its image.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self) -> Result<(), ResultsError> {
        self.store.start()?;
        self.store.publish(&self.path)?;
        match self.path.file_name().filter(|_| self.image) {
            Some(name) => {
                let beside = self.path.with_extension("vtkhdf");
                companion(&beside, &name.to_string_lossy(), IMAGE)
            }
            None => Ok(()),
        }
    }
}
