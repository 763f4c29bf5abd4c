//! Event tables: columns that grow by one value per event, buffered until the file is flushed.

use super::dataset::Growing;
use super::declare::MANY;
use super::store::{ResultsError, Store};
use fretwork_observe::statistics::Column;

/// A table of events.
#[derive(Debug, Default)]
pub(super) struct Events {
    columns: Vec<Growing>,
    buffered: Vec<Vec<f64>>,
}

impl Events {
    /// Declares the columns in a group; no group is created without columns.
    pub fn declare(
        store: &mut Store,
        group: &str,
        columns: &[Column],
    ) -> Result<Self, ResultsError> {
        if columns.is_empty() {
            return Ok(Self::default());
        }
        store.group(group)?;
        let grown = columns.iter().map(|c| {
            let path = format!("{group}/{}", c.name);
            store.growing::<f64>(&path, 1, (c.unit, c.doc), MANY)
        });
        Ok(Self {
            columns: grown.collect::<Result<_, _>>()?,
            buffered: vec![Vec::new(); columns.len()],
        })
    }

    /// Buffers an event.
    pub fn hold(&mut self, row: &[f64]) {
        for (column, value) in self.buffered.iter_mut().zip(row) {
            column.push(*value);
        }
    }

    /// Number of buffered events.
    pub fn rows(&self) -> usize {
        self.buffered.first().map_or(0, Vec::len)
    }

    /// Writes the buffered events.
    pub fn write(&mut self, store: &mut Store) -> Result<(), ResultsError> {
        for (column, values) in self.columns.iter().zip(&mut self.buffered) {
            store.append(*column, values)?;
            values.clear();
        }
        Ok(())
    }
}
