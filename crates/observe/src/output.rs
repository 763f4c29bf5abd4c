//! Output of an observer at the end of a run: texts and charts with file names. A higher layer writes and
//! draws them.

use crate::chart::Chart;
use crate::map::Map;

/// An output file of an observer.
#[derive(Clone, Debug)]
pub enum Output {
    /// A table as text.
    Text {
        /// Name of the file.
        file: String,
        /// Content of the file.
        text: String,
    },
    /// Charts on one page.
    Charts {
        /// Name of the PNG file.
        file: String,
        /// The charts; those without data are omitted.
        charts: Vec<Chart>,
        /// Number of columns on the page.
        columns: usize,
    },
    /// Maps of a contact on one page, in two columns.
    Maps {
        /// Name of the PNG file.
        file: String,
        /// The maps; without any there is no file.
        maps: Vec<Map>,
    },
}

impl Output {
    /// Charts on one page, in a number of columns.
    pub fn charts(file: String, charts: impl Into<Vec<Chart>>, columns: usize) -> Self {
        Self::Charts {
            file,
            charts: charts.into(),
            columns,
        }
    }
}
