//! Reader of profile tables with the columns `x` and `z`, including those that a run writes.

use super::sample::table::Table;
use super::source::InputError;
use std::path::Path;

/// Reads the points of a profile (m).
///
/// # Errors
/// Returns an error at the invalid line.
pub fn read(path: &Path) -> Result<Vec<(f64, f64)>, InputError> {
    let table = Table::read_lengths(path, &["x", "z"], &["z_first", "depth"])?;
    let (x, z) = (table.column("x"), table.column("z"));
    let points: Vec<(f64, f64)> = (0..table.len())
        .map(|row| (table.value(row, x), table.value(row, z)))
        .collect();
    if let Some(k) = points.windows(2).position(|w| w[1] == w[0]) {
        let message = "this point of the profile equals the one before it; leave one out";
        return Err(table.fail(k + 1, message));
    }
    Ok(points)
}
