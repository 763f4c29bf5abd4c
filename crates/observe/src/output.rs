//! What an observer leaves at the end of a run: texts and charts, by the names of their files. Who writes and draws them is
//! above this layer.

use crate::chart::Chart;

/// A file that an observer asks for.
#[derive(Clone, Debug)]
pub enum Output {
    /// A table as text.
    Text {
        /// Name of the file.
        file: String,
        /// What stands in it.
        text: String,
    },
    /// Charts on one page.
    Charts {
        /// Name of the file, a PNG.
        file: String,
        /// The charts; those without data are left out.
        charts: Vec<Chart>,
        /// In so many columns.
        columns: usize,
    },
}

impl Output {
    /// Charts on one page, in so many columns.
    pub fn charts(file: String, charts: impl Into<Vec<Chart>>, columns: usize) -> Self {
        Self::Charts {
            file,
            charts: charts.into(),
            columns,
        }
    }
}
