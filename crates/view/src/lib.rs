//! Visual output of a run as PNG files and HTML pages. A chart is described once
//! ([`fretwork_observe::chart`]) and drawn by both: [`draw_panels`] makes a PNG file, [`report`]
//! and [`compare`] make pages of runs, and a [`Sheet`] is a page of sections with tables and
//! charts, for studies and fits. [`picture`] draws the scene of a simulation.
//!
//! ```text
//! figures of observers ─► figures.json ─┬─► png ─► NAME.png
//! results.h5, summary.json ─────────────┴─► html ─► report.html
//! ```
//!
//! ```
//! use fretwork_view::{Axis, Chart, Series, draw_panels};
//!
//! let points = (0..=50).map(|k| 1e-3 * f64::from(k)).map(|t| (t, 0.5 * 9.81 * t * t)).collect();
//! let chart = Chart::new("Free fall", Axis::new("time t", "s"), Axis::new("distance s", "m"))
//!     .with(Series::new("s = g t²/2", points));
//! let path = std::env::temp_dir().join(format!("fretwork-fall-{}.png", std::process::id()));
//! draw_panels(&[chart], 1, &path)?;
//! assert!(std::fs::read(&path)?.starts_with(b"\x89PNG"));
//! # std::fs::remove_file(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![deny(clippy::print_stdout, clippy::print_stderr)]

mod html;
mod measured;
mod png;

pub use fretwork_observe::chart::{Axis, Chart, Figure, Series, Style, TableColumns, quantity};
pub use fretwork_observe::picture::Paint;
pub use html::*;
pub use measured::{MeasuredColumns, MeasuredCurve, read_measured};
pub use png::*;
