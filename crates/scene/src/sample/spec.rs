//! Specification of samples that are generated or read from files.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A loose random deposit in a box, without overlaps; see [`super::deposit`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepositSpec {
    /// Material.
    pub material: String,
    /// Number of grains.
    pub count: usize,
    /// Sizes of the grains.
    pub sizes: SizeSpec,
    /// Low corner of the box (m).
    pub low: Vec<f64>,
    /// High corner of the box (m).
    pub high: Vec<f64>,
}

/// Voronoi cells that fill a box side by side; see [`super::voronoi`] and [`super::voronoi_space`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VoronoiSpec {
    /// Material.
    pub material: String,
    /// Mean size of a cell (m): the square root of its area, in 3D the cube root of its volume.
    pub size: f64,
    /// Low corner of the box (m).
    pub low: Vec<f64>,
    /// High corner of the box (m).
    pub high: Vec<f64>,
    /// Lloyd iterations; more of them make the cells more uniform.
    #[serde(default)]
    pub rounds: usize,
    /// Gap between neighbours (m).
    #[serde(default)]
    pub gap: f64,
    /// Rounding radius of corners, in 3D also of edges (m).
    #[serde(default)]
    pub rounding: f64,
}

/// A wall of blocks in running bond: every second course begins and ends with half a block. In 3D
/// it extends along x and z and is one block thick.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockWallSpec {
    /// Material.
    pub material: String,
    /// Number of courses.
    pub rows: usize,
    /// Number of whole blocks in the lowest course.
    pub columns: usize,
    /// Width and height of a block (m).
    pub block: (f64, f64),
    /// Thickness of the wall along y (m), in 3D only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Width of the open joints between blocks (m).
    #[serde(default)]
    pub gap: f64,
    /// Low left (in 3D front) corner of the wall (m).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<f64>,
}

/// A distribution of sizes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum SizeSpec {
    /// Uniform density of the radius.
    Uniform {
        /// Smallest and largest radius (m).
        radius: (f64, f64),
        /// Whether the distribution is by number or by mass.
        #[serde(default)]
        by: Counted,
    },
    /// Density proportional to r^-exponent between two radii.
    PowerLaw {
        /// Exponent of the density.
        exponent: f64,
        /// Smallest and largest radius (m).
        radius: (f64, f64),
        /// Whether the distribution is by number or by mass.
        #[serde(default)]
        by: Counted,
    },
    /// A grading curve in a CSV file with the columns `size`, the sieve opening (m), which is a
    /// diameter, and `passing`, the mass fraction that passes it.
    Sieve {
        /// Path relative to the case.
        file: String,
    },
}

/// Quantity by which a distribution weights grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Counted {
    /// Number of grains.
    #[default]
    Number,
    /// Mass of grains.
    Mass,
}

/// Grains of a CSV file with the columns x, y (z in 3D), radius, and optionally velocity_x,
/// velocity_y (velocity_z) and spin (spin_x, spin_y, spin_z in 3D).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CsvSpec {
    /// Path relative to the case.
    pub file: String,
    /// Material.
    pub material: String,
}

/// Grains of a state of another run, with their velocities and spins.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpec {
    /// The run's `results.h5` or its folder, relative to the case.
    pub results: String,
    /// Material.
    pub material: String,
    /// The state to take.
    #[serde(default)]
    pub frame: FrameSpec,
}

/// A state of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum FrameSpec {
    /// The last state.
    #[default]
    Last,
    /// A state by its index, from 0.
    Number(usize),
}
