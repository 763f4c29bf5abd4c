//! Charts and pictures as PNG files: axes with units, curves, disks, polygons and spheres; the [`picture`] of a simulation.
//!
//! ```
//! use fretwork_plot::{Axis, Chart, Series, draw_panels};
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

mod canvas;
mod chart;
mod font;
mod frame;
mod furniture;
mod notice;
mod paint;
pub mod picture;
mod raster;
mod scene;
mod view;
mod zone;

pub use canvas::ReportError;
pub use chart::draw_panels;
pub use frame::{Disk, Frame, Link, LinkState, Outline};
pub use fretwork_observe::chart::{Axis, Chart, Figure, Series, Style, TableColumns, quantity};
pub use fretwork_observe::picture::Paint;
pub use notice::noted;
pub use paint::Scale;
pub use scene::{Faces, Scene, Sphere};
pub use view::View;
pub use zone::ZoneLine;
