mod axis;
mod canvas;
mod chart;
mod curve;
mod font;
mod frame;
mod furniture;
mod legend;
mod panels;
mod solid;
mod sphere;

pub use axis::Axis;
pub use canvas::ReportError;
pub use chart::{Chart, Series, Style};
pub use frame::{Arrow, Disk, Frame, Link, LinkState, Outline};
pub use panels::draw_panels;
pub use solid::{Body, Face, Solid, faces, project};
pub use sphere::{View, sphere_disk};
