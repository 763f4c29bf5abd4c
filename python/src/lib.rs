//! The compiled part of the Python package `fretwork`.
//!
//! It exposes cases, simulations, runs and laws to Python in plain types: numbers, texts, JSON and
//! memory for NumPy. The classes that users see are in `fretwork/`.

mod array;
mod case;
mod columns;
mod command_line;
mod contact_patch;
mod errors;
mod infinity;
mod law;
mod material;
mod new_case;
mod observer;
mod patch;
mod paths;
mod report;
mod run;
mod search;
mod shipped;
mod simulation;
mod stepper;
mod workers;

use pyo3::prelude::*;

#[pymodule]
fn _fretwork(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<array::Array>()?;
    module.add_class::<case::Case>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(run::default_folder, module)?)?;
    module.add_function(wrap_pyfunction!(report::report, module)?)?;
    module.add_function(wrap_pyfunction!(report::compare, module)?)?;
    module.add_function(wrap_pyfunction!(contact_patch::contact_patch, module)?)?;
    module.add_function(wrap_pyfunction!(material::material, module)?)?;
    module.add_function(wrap_pyfunction!(material::materials, module)?)?;
    module.add_function(wrap_pyfunction!(new_case::new_case, module)?)?;
    module.add_function(wrap_pyfunction!(patch::patch, module)?)?;
    module.add_function(wrap_pyfunction!(shipped::copy_shipped, module)?)?;
    module.add_function(wrap_pyfunction!(command_line::declare, module)?)?;
    module.add_function(wrap_pyfunction!(command_line::command_line, module)?)?;
    law::add(module)
}
