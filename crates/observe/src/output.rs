//! Output of an observer at the end of a run: texts and charts with file names. A higher layer writes and
//! draws them.

use crate::chart::Chart;

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
