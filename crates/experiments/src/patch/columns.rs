//! Columns of numbers of the tables that the file of a patch names.

use fretwork_scene::measured::MeasuredTable;
use fretwork_scene::source::{InputError, Source};
use fretwork_scene::units;

/// Returns the numbers of a column in a unit, of a table whose file stands at a path. Its heading
/// has its unit, but for pure numbers.
///
/// # Errors
/// There is no such column, or no such unit in its heading.
pub(super) fn column(
    source: &Source,
    path: &str,
    table: &MeasuredTable,
    (name, wanted): (&str, &str),
) -> Result<Vec<f64>, InputError> {
    let column = table.required(name).map_err(|e| source.named_at(path, e))?;
    let unit = &table.headings[column].unit;
    if unit.is_empty() && !wanted.is_empty() {
        let why = format!(
            "the heading `{name}` has no unit: write it as `{name} [mm]`, in the unit of its numbers"
        );
        return Err(source.error_at(path, why));
    }
    let converted = |v: f64| units::convert(v, unit, wanted);
    let values = table.values(column)?.into_iter().map(converted);
    let values: Result<Vec<f64>, _> = values.collect();
    values.map_err(|e| source.error_at(path, format!("column `{name}`: {}", e.message)))
}
