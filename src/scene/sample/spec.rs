//! What a case says about samples that are made or read.

use serde::Deserialize;

/// A loose random deposit in a box, without overlaps; see [`super::deposit`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepositSpec {
    /// Material.
    pub material: String,
    /// How many grains.
    pub count: usize,
    /// Their sizes.
    pub sizes: SizeSpec,
    /// Low corner of the box (m).
    pub low: Vec<f64>,
    /// High corner of the box (m).
    pub high: Vec<f64>,
}

/// A distribution of sizes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum SizeSpec {
    /// Every radius between two is as frequent.
    Uniform {
        /// Smallest and largest radius (m).
        radius: (f64, f64),
        /// Whether grains or their masses are counted.
        #[serde(default)]
        by: Counted,
    },
    /// The density falls as r^-exponent between two radii.
    PowerLaw {
        /// Exponent of the density.
        exponent: f64,
        /// Smallest and largest radius (m).
        radius: (f64, f64),
        /// Whether grains or their masses are counted.
        #[serde(default)]
        by: Counted,
    },
    /// A grading curve in a CSV file with the columns `size` (m), the opening of a sieve, which is a diameter, and
    /// `passing`, the fraction of the mass that passes it.
    Sieve {
        /// Path relative to the case.
        file: String,
    },
}

/// What a distribution counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Counted {
    /// Grains.
    #[default]
    Number,
    /// Their masses.
    Mass,
}

/// Grains of a CSV file with the columns x, y (z in 3D), radius, and where wanted velocity_x, velocity_y
/// (velocity_z) and spin (spin_x, spin_y, spin_z in 3D).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CsvSpec {
    /// Path relative to the case.
    pub file: String,
    /// Material.
    pub material: String,
}

/// Grains of a state of another run, with their velocities and spins.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateSpec {
    /// The run's `results.h5` or its folder, relative to the case.
    pub results: String,
    /// Material.
    pub material: String,
    /// Which of its states.
    #[serde(default)]
    pub frame: FrameSpec,
}

/// A state of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum FrameSpec {
    /// The last one.
    #[default]
    Last,
    /// One by its number, from 0.
    Number(usize),
}
