//! Output of an observer at the end of a run: texts with file names, and figures. A higher layer
//! writes and draws them.

use crate::chart::{Chart, Figure};

/// Name of the report of a run in its folder.
pub const REPORT: &str = "report.html";

/// An output of an observer.
#[derive(Clone, Debug)]
pub enum Output {
    /// A table as text.
    Text {
        /// Name of the file.
        file: String,
        /// Content of the file.
        text: String,
    },
    /// Charts on one page, in `NAME.png` and in the report.
    Figure(Figure),
}

impl Output {
    /// Creates a figure of charts on one page, in a number of columns.
    pub fn figure(name: impl Into<String>, charts: impl Into<Vec<Chart>>, columns: usize) -> Self {
        Self::Figure(Figure::new(name, charts, columns))
    }

    /// Creates a figure of a main result, with which a report begins.
    pub fn leading(name: impl Into<String>, charts: impl Into<Vec<Chart>>, columns: usize) -> Self {
        Self::Figure(Figure {
            leads: true,
            ..Figure::new(name, charts, columns)
        })
    }
}
