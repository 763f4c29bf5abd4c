//! Parts of the pages of studies and fits.

use fretwork_view::{Block, Section, SheetTable};

/// A section.
pub(crate) fn section(title: impl Into<String>, blocks: Vec<Block>) -> Section {
    Section {
        title: title.into(),
        blocks,
    }
}

/// Returns a table with a sentence above it.
pub(crate) fn table<'a>(
    note: impl Into<String>,
    heads: impl IntoIterator<Item = &'a str>,
    rows: Vec<Vec<String>>,
) -> Block {
    Block::Table(SheetTable {
        note: note.into(),
        heads: heads.into_iter().map(str::to_owned).collect(),
        rows,
    })
}
