//! Charts and pictures as PNG files: axes with units, curves, disks, polygons and spheres; the [`picture`] of a simulation and
//! the [`figures`] of a run.

#![warn(missing_docs)]
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod axis;
mod canvas;
mod chart;
mod curve;
pub mod figures;
mod font;
mod frame;
mod furniture;
mod legend;
mod notice;
mod paint;
mod panels;
pub mod picture;
mod raster;
mod scene;
mod view;

pub use canvas::ReportError;
pub use chart::DrawChart;
pub use frame::{Arrow, Disk, Frame, Link, LinkState, Outline};
pub use fretwork_observe::chart::{Axis, Chart, Series, Style, quantity};
pub use notice::noted;
pub use paint::{Paint, Scale, round_top};
pub use panels::draw_panels;
pub use scene::{Faces, Scene, Sphere};
pub use view::View;
