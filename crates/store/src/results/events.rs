//! Event tables: columns that grow by one value per event, buffered until the file is flushed.

use super::dataset::GrowingDataset;
use super::declare::LONG_CHUNK;
use super::store::{ResultsError, Store};
use fretwork_observe::observer::{Event, EventTable};

/// A table of events, `/events/NAME`.
#[derive(Debug)]
pub(super) struct Events {
    name: &'static str,
    columns: Vec<GrowingDataset>,
    buffered: Vec<Vec<f64>>,
    /// Column with any number of values per event.
    list: Option<GrowingDataset>,
    buffered_list: Vec<f64>,
}

impl Events {
    /// Declares the columns of all tables; no group is created without tables.
    pub fn declare(
        store: &mut Store,
        tables: &[EventTable],
        dimension: usize,
    ) -> Result<Vec<Self>, ResultsError> {
        if !tables.is_empty() {
            store.group("/events")?;
        }
        let declared = tables.iter().map(|table| {
            let group = format!("/events/{}", table.name);
            store.group(&group)?;
            if let Some(list) = &table.list {
                store.text_attribute(&group, "list", &list.name)?;
            }
            let mut grown = Vec::new();
            for c in table.columns.iter().chain(&table.list) {
                let path = format!("{group}/{}", c.name);
                grown.push(store.growing::<f64>(
                    &path,
                    1,
                    (c.unit.heading(dimension), c.doc),
                    LONG_CHUNK,
                )?);
            }
            let list = table.list.as_ref().and_then(|_| grown.pop());
            Ok(Self {
                name: table.name,
                buffered: vec![Vec::new(); grown.len()],
                columns: grown,
                list,
                buffered_list: Vec::new(),
            })
        });
        declared.collect()
    }

    /// Whether this is the table of an event.
    pub fn is_of(&self, event: &Event) -> bool {
        self.name == event.table && self.columns.len() == event.row.len()
    }

    /// Buffers an event.
    pub fn hold(&mut self, event: &Event) {
        for (column, value) in self.buffered.iter_mut().zip(&event.row) {
            column.push(*value);
        }
        if self.list.is_some() {
            self.buffered_list.extend_from_slice(&event.list);
        }
    }

    /// Number of buffered events.
    pub fn rows(&self) -> usize {
        self.buffered.first().map_or(0, Vec::len)
    }

    /// Writes the buffered events: lists first, so that every readable event has all its values.
    pub fn write(&mut self, store: &mut Store) -> Result<(), ResultsError> {
        if let Some(list) = self.list {
            store.append(list, &self.buffered_list)?;
            self.buffered_list.clear();
        }
        for (column, values) in self.columns.iter().zip(&mut self.buffered) {
            store.append(*column, values)?;
            values.clear();
        }
        Ok(())
    }
}
