//! Charts and pictures as PNG files: axes with units, curves, disks, polygons and spheres. It knows nothing of physics: who
//! calls it says what is drawn where.

#![warn(missing_docs)]
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod axis;
mod canvas;
mod chart;
mod curve;
mod font;
mod frame;
mod furniture;
mod legend;
mod notice;
mod paint;
mod panels;
mod raster;
mod scene;
mod view;

pub use axis::{Axis, quantity};
pub use canvas::ReportError;
pub use chart::{Chart, Series, Style};
pub use frame::{Arrow, Disk, Frame, Link, LinkState, Outline};
pub use notice::noted;
pub use paint::{Paint, Scale, round_top};
pub use panels::draw_panels;
pub use scene::{Faces, Scene, Sphere};
pub use view::View;
