//! Fields over the cells of a rectangular grid, in a file of their own.
//!
//! ```text
//! /x, /y               middles of the cells (m)
//! /POINT/FIELD         rows along y, columns along x, with unit and doc
//! ```

use super::store::{ResultsError, Store};
use std::path::{Path, PathBuf};

/// A field: a number for each cell, row by row.
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

/// A file of fields that is being written.
#[derive(Debug)]
pub struct Maps {
    store: Store,
    columns: u64,
    path: PathBuf,
}

impl Maps {
    /// Creates the file, with the middles of the cells along x and y (m).
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, [x, y]: [&[f64]; 2]) -> Result<Self, ResultsError> {
        let axis = |name, places: &[f64], doc| (name, places.to_vec(), "m", doc);
        let axes = [
            axis("x", x, "middles of the cells along the motion"),
            axis("y", y, "middles of the cells across the motion"),
        ];
        Self::over(path, &axes)
    }

    /// Creates the file for fields over other axes, those of columns and of rows: name, places,
    /// unit and doc.
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
        })
    }

    /// Adds the fields of a point.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn point(&mut self, name: &str, fields: &[MapField]) -> Result<(), ResultsError> {
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

    /// Ends the file and gives it its name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), ResultsError> {
        self.store.start()?;
        self.store.publish(&self.path)
    }
}
