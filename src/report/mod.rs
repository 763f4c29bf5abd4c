mod axis;
mod canvas;
mod chart;
mod curve;
mod font;
mod frame;
mod furniture;
mod legend;
mod paint;
mod panels;
mod sphere;

pub use axis::Axis;
pub use canvas::ReportError;
pub use chart::{Chart, Series, Style};
pub use frame::{Arrow, Disk, Frame, Link, LinkState, Outline};
pub use paint::{Paint, Scale};
pub use panels::draw_panels;
pub use sphere::{View, project_spheres, sphere_disk};
