//! Declaration of the contents of the results file before the first row: groups, attributes, texts,
//! datasets.

use super::dataset::{GrowingDataset, Number, Slot};
use super::store::{ResultsError, Store};
use hdf5::types::VarLenUnicode;
use hdf5::{DatatypeMessage, H5Dataset, H5File, H5Group, H5Type};

/// Chunk size of a slot, in bytes.
const SLOT_CHUNK: usize = 1 << 15;

/// Chunk size, in rows, of a dataset with many rows per state.
pub const LONG_CHUNK: usize = 2048;
/// Chunk size, in rows, of a dataset with one row per state.
pub const SHORT_CHUNK: usize = 128;

impl Store {
    fn declared_group(&self, path: &str) -> Result<H5Group, ResultsError> {
        let file = self.declaring()?;
        self.named(group(file, path))
    }

    /// Creates a group; its parent must exist.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn group(&mut self, path: &str) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let parent = self.declared_group(parent)?;
        self.named(parent.create_group(name)).map(drop)
    }

    /// Creates another name for a group or dataset.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn link(&mut self, path: &str, target: &str) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let parent = self.declared_group(parent)?;
        self.named(parent.link(name, target))
    }

    /// Writes a text attribute of a group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn text_attribute(
        &mut self,
        group: &str,
        name: &str,
        text: &str,
    ) -> Result<(), ResultsError> {
        let group = self.declared_group(group)?;
        self.named(group.set_attr_string(name, text))
    }

    /// Writes a fixed-length ASCII attribute, as VTK requires.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn ascii_attribute(
        &mut self,
        group: &str,
        name: &str,
        text: &str,
    ) -> Result<(), ResultsError> {
        let datatype = DatatypeMessage::fixed_string(text.len() as u32);
        let group = self.declared_group(group)?;
        self.named(group.set_attr_typed(name, datatype, text.as_bytes().to_vec()))
    }

    /// Writes integers as an attribute; a single integer becomes a scalar.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn integer_attribute(
        &mut self,
        group: &str,
        name: &str,
        values: &[i64],
    ) -> Result<(), ResultsError> {
        let group = self.declared_group(group)?;
        self.named(match values {
            [one] => group.set_attr_numeric::<i64>(name, one),
            many => group.set_attr_array_numeric::<i64>(name, many),
        })
    }

    /// Writes numbers as an attribute of a group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn real_attribute(
        &mut self,
        group: &str,
        name: &str,
        values: &[f64],
    ) -> Result<(), ResultsError> {
        let group = self.declared_group(group)?;
        self.named(group.set_attr_array_numeric::<f64>(name, values))
    }

    /// Writes a dataset of texts with a description.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn texts(&mut self, path: &str, texts: &[&str], doc: &str) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let group = self.declared_group(parent)?;
        let dataset = self.named(group.write_vlen_strings(name, texts))?;
        self.named(text_attribute(&dataset, "doc", doc))
    }

    /// Writes a dataset of rows of `width` numbers with its unit and description; no dataset if
    /// there are no rows.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn numbers<T: H5Type + Number>(
        &mut self,
        path: &str,
        width: u64,
        values: &[T],
        (unit, doc): (&str, &str),
    ) -> Result<(), ResultsError> {
        let rows = values.len() / width as usize;
        let shape = match width {
            1 => vec![rows],
            _ => vec![rows, width as usize],
        };
        self.array(path, &shape, values, (unit, doc))
    }

    /// Writes a dataset of numbers of a shape with its unit and description; no dataset if there
    /// are no numbers.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn array<T: H5Type + Number>(
        &mut self,
        path: &str,
        shape: &[usize],
        values: &[T],
        (unit, doc): (&str, &str),
    ) -> Result<(), ResultsError> {
        if values.is_empty() {
            return Ok(());
        }
        let (parent, name) = split(path);
        let group = self.declared_group(parent)?;
        let made = group.new_dataset::<T>().shape(shape).create(name);
        let dataset = self.named(made)?;
        self.named(dataset.write_raw(values))?;
        self.named(describe(&dataset, unit, doc))
    }

    /// Writes a column of dimensionless numbers of one byte each, as VTK requires for the types of
    /// cells.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn small_numbers(
        &mut self,
        path: &str,
        values: &[u8],
        doc: &str,
    ) -> Result<(), ResultsError> {
        let (parent, name) = split(path);
        let group = self.declared_group(parent)?;
        let made = group.new_dataset::<u8>().shape([values.len()]).create(name);
        let dataset = self.named(made)?;
        self.named(dataset.write_raw(values))?;
        self.named(describe(&dataset, "", doc))
    }

    /// Declares a growing dataset of rows of `width` numbers (1: a plain column), with its unit and
    /// description, and its chunk size in rows ([`LONG_CHUNK`], [`SHORT_CHUNK`]).
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn growing<T: H5Type + Number>(
        &mut self,
        path: &str,
        width: u64,
        (unit, doc): (&str, &str),
        chunk: usize,
    ) -> Result<GrowingDataset, ResultsError> {
        let numbers = width as usize;
        let (shape, most, chunk) = match width {
            1 => (vec![0], vec![None], vec![chunk]),
            _ => (
                vec![0, numbers],
                vec![None, Some(numbers)],
                vec![chunk, numbers],
            ),
        };
        let (parent, name) = split(path);
        let group = self.declared_group(parent)?;
        let made = group.new_dataset::<T>().shape(shape);
        let made = made.chunk(&chunk).max_shape(&most).create(name);
        let dataset = self.named(made)?;
        self.named(describe(&dataset, unit, doc))?;
        Ok(self.add_grown(path, width, T::WHOLE))
    }

    /// Declares a slot of bytes that can be overwritten, with a description.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn slot(&mut self, path: &str, doc: &str) -> Result<Slot, ResultsError> {
        let (parent, name) = split(path);
        let group = self.declared_group(parent)?;
        let made = group.new_dataset::<u8>().shape([0]);
        let made = made.chunk(&[SLOT_CHUNK]).max_shape(&[None]).create(name);
        let dataset = self.named(made)?;
        self.named(text_attribute(&dataset, "doc", doc))?;
        Ok(self.add_slot(path))
    }
}

/// Opens a group of a file being written.
pub(super) fn group(file: &H5File, path: &str) -> hdf5::Result<H5Group> {
    let root = file.root_group();
    match path.trim_matches('/') {
        "" => Ok(root),
        path => root.group(path),
    }
}

/// Writes the attributes `unit` (`1` for pure numbers) and `doc` of a dataset.
fn describe(dataset: &H5Dataset, unit: &str, doc: &str) -> hdf5::Result<()> {
    text_attribute(dataset, "unit", if unit.is_empty() { "1" } else { unit })?;
    text_attribute(dataset, "doc", doc)
}

fn text_attribute(dataset: &H5Dataset, name: &str, text: &str) -> hdf5::Result<()> {
    let attribute = dataset.new_attr::<VarLenUnicode>().create(name)?;
    attribute.write_string(text)
}

/// Splits a path into that of the parent and the name in it.
fn split(path: &str) -> (&str, &str) {
    match path.rsplit_once('/') {
        Some(("", name)) => ("/", name),
        Some((parent, name)) => (parent, name),
        None => ("/", path),
    }
}
