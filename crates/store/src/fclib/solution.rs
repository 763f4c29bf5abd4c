//! The group `/solution` of a file.

use super::source::Source;
use super::write::{complete, put};
use super::{FclibError, Problem};
use std::path::Path;

/// Solution of a problem, with the names of the layout. The sizes are those of the problem: n
/// degrees of freedom, p constraints, and m components of all contacts (2 or 3 per contact).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// Velocities of the degrees of freedom (n); global problems only.
    pub v: Vec<f64>,
    /// Multipliers of the constraints (p); empty without constraints.
    pub l: Vec<f64>,
    /// Relative velocities of the contacts (m).
    pub u: Vec<f64>,
    /// Impulses of the contacts (m).
    pub r: Vec<f64>,
}

/// Writes a file with a problem and its solution: v only for a global problem, l only with
/// constraints.
///
/// # Errors
/// The file cannot be written, or a size exceeds the 32 bits of the layout.
pub fn write_with_solution(
    path: &Path,
    problem: &Problem,
    solution: &Solution,
) -> Result<(), FclibError> {
    complete(path, |file| {
        put(file, problem)?;
        file.group("/solution")?;
        if let Problem::Global(_) = problem {
            file.reals("/solution/v", &solution.v)?;
        }
        if !solution.l.is_empty() {
            file.reals("/solution/l", &solution.l)?;
        }
        file.reals("/solution/u", &solution.u)?;
        file.reals("/solution/r", &solution.r)
    })
}

/// Reads the solution of a file, if the file has the group; missing vectors are empty. Many files
/// have a group that was never filled, which reads as zeros.
///
/// # Errors
/// The file or the group is damaged.
pub fn read_solution(path: &Path) -> Result<Option<Solution>, FclibError> {
    let source = Source::open(path)?;
    if !source.has_group("/solution") {
        return Ok(None);
    }
    let part = |name: &str| {
        let place = format!("/solution/{name}");
        if source.has(&place) {
            source.reals(&place)
        } else {
            Ok(Vec::new())
        }
    };
    Ok(Some(Solution {
        v: part("v")?,
        l: part("l")?,
        u: part("u")?,
        r: part("r")?,
    }))
}
