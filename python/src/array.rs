//! Memory that is exposed to NumPy through its array interface.
//!
//! A column of a simulation is shown without a copy while nothing changes it. Before a step the
//! simulation hands the memory of each column that Python still holds over to its array, and
//! continues with a copy: an array never changes, and never dangles.

use crate::simulation::Simulation;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::any::Any;
use std::sync::Mutex;

/// Owner of the memory of an array.
enum Owner {
    /// The simulation, whose column it is.
    Simulation { _it: Py<Simulation> },
    /// The array itself.
    Itself { _memory: Box<dyn Any + Send> },
}

/// Numbers in memory, for `numpy.asarray`.
#[pyclass(module = "fretwork._fretwork", frozen, weakref)]
pub(crate) struct Array {
    at: usize,
    shape: Vec<usize>,
    kind: &'static str,
    owner: Mutex<Owner>,
}

/// A number that arrays can hold.
pub(crate) trait Number: Copy + Send + 'static {
    /// Type code in the array interface.
    const KIND: &'static str;
}

impl Number for f64 {
    const KIND: &'static str = if cfg!(target_endian = "big") {
        ">f8"
    } else {
        "<f8"
    };
}

impl Number for u64 {
    const KIND: &'static str = if cfg!(target_endian = "big") {
        ">u8"
    } else {
        "<u8"
    };
}

impl Number for i64 {
    const KIND: &'static str = if cfg!(target_endian = "big") {
        ">i8"
    } else {
        "<i8"
    };
}

impl Number for bool {
    const KIND: &'static str = "|b1";
}

impl Array {
    /// Returns an array with its own memory, of `width` numbers per row; one-dimensional if `width`
    /// is 0.
    pub(crate) fn own<T: Number>(numbers: Vec<T>, width: usize) -> Self {
        Self {
            at: numbers.as_ptr() as usize,
            shape: shape(numbers.len(), width),
            kind: T::KIND,
            owner: Mutex::new(Owner::Itself {
                _memory: Box::new(numbers),
            }),
        }
    }

    /// Returns an array on a column of a simulation, whose elements must consist of exactly `width`
    /// numbers each.
    pub(crate) fn shown<T, N: Number>(column: &[T], width: usize, of: Py<Simulation>) -> Self {
        debug_assert_eq!(size_of::<T>(), width.max(1) * size_of::<N>());
        Self {
            at: column.as_ptr() as usize,
            shape: shape(column.len() * width.max(1), width),
            kind: N::KIND,
            owner: Mutex::new(Owner::Simulation { _it: of }),
        }
    }

    /// Gives the array the memory that it shows. Must be called with the column itself: moving a
    /// vector leaves its numbers in place.
    pub(crate) fn hand_over(&self, memory: Box<dyn Any + Send>) {
        let mut owner = self.owner.lock().unwrap_or_else(|e| e.into_inner());
        *owner = Owner::Itself { _memory: memory };
    }
}

fn shape(numbers: usize, width: usize) -> Vec<usize> {
    match width {
        0 => vec![numbers],
        width => vec![numbers / width, width],
    }
}

#[pymethods]
impl Array {
    /// The array interface: read-only, in C order.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let result = PyDict::new(py);
        result.set_item("version", 3)?;
        result.set_item("typestr", self.kind)?;
        result.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        result.set_item("data", (self.at, true))?;
        Ok(result)
    }
}
