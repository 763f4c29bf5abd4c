//! Output of an observer at the end of a run: texts with file names, and figures. A higher layer
//! writes and draws them.

use crate::chart::{Chart, Figure};

/// Name of the report of a run in its folder.
pub const REPORT: &str = "report.html";

/// End of the names of pictures of figures with measured curves, `fretting_loops_measured.png`.
const MEASURED: &str = "_measured.png";

/// Returns the name of the picture of a figure with measured curves.
pub fn measured_picture(figure: &str) -> String {
    format!("{figure}{MEASURED}")
}

/// Whether a file is the picture of a figure with measured curves, of those that can have some.
pub fn is_measured_picture(name: &str) -> bool {
    let figure = name.strip_suffix(MEASURED);
    figure.is_some_and(|f| [Figure::LOOPS, Figure::FRICTION].contains(&f) || f.starts_with("scar_"))
}

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
