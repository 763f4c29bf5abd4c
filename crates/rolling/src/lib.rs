//! The contact patch of two elastic bodies that roll, slide or fret: pressure, traction and slip
//! over a grid of cells, from numbers to numbers.
//!
//! Both bodies are half-spaces as far as their deformation goes (J. J. Kalker, Three-dimensional
//! elastic bodies in rolling contact, 1990). The axes are x along the rolling, in which material
//! enters the patch at large x and leaves it at small x, and y across it. Tractions act on the
//! first body and slip is that of the first body relative to the second one, so that traction
//! opposes slip.
//!
//! ```text
//! normal       e = h + u_z(p_n) - delta >= 0,  p_n >= 0,  p_n e = 0
//! tangential   |p| <= g,  S = 0 where |p| < g,  p = -g S/|S| otherwise
//! slip         S = w + B p    (B: displacement of a cell less that of the one before, upstream)
//! ```

pub mod below;
pub mod cells;
pub mod closed;
pub mod convolution;
pub mod creep;
pub mod curve;
mod extent;
pub mod fastsim;
pub mod fatigue;
pub mod fields;
pub mod fretting;
pub mod friction;
mod gmres;
pub mod mindlin;
pub mod motion;
pub mod normal;
pub mod passages;
pub mod patch;
pub mod polach;
pub mod profile;
pub mod pull;
pub mod response;
pub mod running;
pub mod scar;
pub mod slider;
pub mod stress;
pub mod strips;
pub mod strokes;
pub mod surfaces;
pub mod tangential;
pub mod temperature;
pub mod touching;

pub use below::Below;
pub use closed::Closed;
pub use creep::{Creep, Share};
pub use curve::Curve;
pub use fastsim::Fastsim;
pub use fields::{Field, Vector};
pub use fretting::{Amplitude, Fretting, FrettingError, Loop};
pub use friction::{Bound, Coulomb, Falling, Friction};
pub use motion::{Creepage, Motion};
pub use normal::{NormalError, Pressure, normal};
pub use passages::{Course, Drive, Passages, Wears};
pub use patch::{Estimate, Patch, PatchError, Refined, Rolling};
pub use polach::Polach;
pub use profile::Profile;
pub use scar::{Cycles, Scar};
pub use stress::Stress;
pub use strips::{Strip, Strips};
pub use strokes::{RefinedStroke, Stroke, StrokeError, Strokes};
pub use surfaces::Surfaces;
pub use tangential::{Tractions, tangential};
pub use touching::{Pair, Radius, Touching, TouchingError};
