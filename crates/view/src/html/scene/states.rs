//! Positions of the rows of a recorded state in the views of `results.h5`.

use crate::html::folder::RunFolder;

/// Index of the first row, and number of rows.
pub(super) type Rows = (usize, usize);

/// Times of the states that are complete in the file.
pub(super) fn times(run: &RunFolder) -> Result<Vec<f64>, String> {
    let reader = &run.reader;
    if !reader.has("views/grains/Points") {
        return Ok(Vec::new());
    }
    let mut count = usize::MAX;
    for view in ["grains", "contacts", "bodies"] {
        for column in [
            "Steps/Values",
            "NumberOfPoints",
            "Steps/PointOffsets",
            "Steps/CellOffsets",
        ] {
            // In the file of a killed run, columns may differ in length by the last state.
            count = count.min(reader.rows(&format!("views/{view}/{column}"))?);
        }
    }
    reader.values("views/grains/Steps/Values", (0, count), 1)
}

/// Returns one integer of a state.
pub(super) fn whole(run: &RunFolder, name: &str, state: usize) -> Result<usize, String> {
    let value = run.reader.whole(name, (state, 1))?[0];
    usize::try_from(value).map_err(|_| format!("`{name}` holds {value}"))
}

/// Returns the rows of the points of a state of a view.
pub(super) fn points(run: &RunFolder, view: &str, state: usize) -> Result<Rows, String> {
    let at = |name: &str| whole(run, &format!("views/{view}/{name}"), state);
    Ok((at("Steps/PointOffsets")?, at("NumberOfPoints")?))
}

/// Returns the rows of the cells of a state of a view; `kind` is the name of the kind of cells and
/// its number.
pub(super) fn cells(
    run: &RunFolder,
    view: &str,
    (kind, number): (&str, usize),
    state: usize,
) -> Result<Rows, String> {
    let offsets = run
        .reader
        .values(&format!("views/{view}/Steps/CellOffsets"), (state, 1), 4)?;
    let count = whole(run, &format!("views/{view}/{kind}/NumberOfCells"), state)?;
    Ok((offsets[number] as usize, count))
}
