//! Charts and pictures as PNG files.

mod canvas;
mod chart;
mod font;
mod notice;
pub mod picture;
mod scene;

pub use canvas::DrawError;
pub use chart::draw_panels;
pub(crate) use chart::gradient;
pub use notice::noted;
pub use scene::paint::ColourScale;
pub use scene::solid::{Faces, SolidScene, Sphere};
pub use scene::view::View;
pub use scene::zone::ZoneLine;
pub use scene::{Disk, Frame, Link, LinkState, Outline};
