//! Specification of the grains in a case.

use super::shapes::ShapeSpec;
use crate::sample::spec::{BlockWallSpec, CsvSpec, DepositSpec, StateSpec, VoronoiSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grains.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum GrainSpec {
    /// Balls, one by one.
    List {
        /// Material.
        material: String,
        /// Balls.
        grains: Vec<OneGrain>,
    },
    /// A hexagonal (2D) or cubic (3D) lattice without overlaps, radii drawn uniformly between two
    /// and shuffled by the seed. Fills the box from its low corner up.
    Lattice {
        /// Material.
        material: String,
        /// Largest number of grains.
        count: usize,
        /// Smallest and largest radius (m).
        radius: (f64, f64),
        /// Low corner of the box (m).
        low: Vec<f64>,
        /// High corner of the box (m).
        high: Vec<f64>,
    },
    /// Convex polygons, one by one (2D).
    Polygons {
        /// Material.
        material: String,
        /// Polygons.
        grains: Vec<OnePolygon>,
    },
    /// Convex polyhedra, one by one (3D).
    Polyhedra {
        /// Material.
        material: String,
        /// Polyhedra.
        grains: Vec<OnePolyhedron>,
    },
    /// Rigid unions of balls and convex shapes, one by one.
    Clusters {
        /// Material.
        material: String,
        /// Clusters.
        grains: Vec<OneCluster>,
    },
    /// Voussoirs of an arch with radial joints, from right to left (2D).
    Arch {
        /// Material.
        material: String,
        /// Number of blocks.
        blocks: usize,
        /// Radius of the centre line (m).
        radius: f64,
        /// Thickness (m).
        thickness: f64,
        /// Centre of the circle (m).
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        centre: Vec<f64>,
        /// Angle of the whole arch (rad), symmetric about the vertical; half a circle by default.
        #[serde(default = "half_circle")]
        span: f64,
        /// Whether a block has the mass of a ring sector or straight edges between its joints.
        #[serde(default)]
        edges: Edges,
    },
    /// Voronoi cells that fill a box (2D).
    Voronoi(VoronoiSpec),
    /// A wall of blocks in running bond (2D).
    BlockWall(BlockWallSpec),
    /// The free balls of a scene file, and its fixed walls as half-spaces of material `walls`.
    Scene {
        /// Path relative to the case.
        file: String,
        /// Material of the grains.
        material: String,
        /// Material of the walls.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        walls: Option<String>,
    },
    /// A loose random deposit in a box.
    Deposit(DepositSpec),
    /// The grains of a table.
    Csv(CsvSpec),
    /// The grains of a state of another run.
    State(StateSpec),
}

/// One grain.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneGrain {
    /// Centre (m).
    pub at: Vec<f64>,
    /// Radius (m).
    pub radius: f64,
    /// Velocity (m/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
    /// Angular velocity (rad/s): one number in 2D, three in 3D.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin: Vec<f64>,
}

fn one() -> f64 {
    1.0
}

fn half_circle() -> f64 {
    std::f64::consts::PI
}

/// The edges of a voussoir between its joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Edges {
    /// Arcs: mass and centre are those of a ring sector. The block makes contact at its joints
    /// only.
    #[default]
    Curved,
    /// Chords.
    Straight,
}

/// One polygon: its corners, or a regular one.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnePolygon {
    /// Position of the origin of its corners (m).
    pub at: Vec<f64>,
    /// Corners (m), anticlockwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<(f64, f64)>,
    /// Number of sides and circumscribed radius (m) of a regular polygon, instead of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regular: Option<(usize, f64)>,
    /// Rounding radius of the corners (m).
    #[serde(default)]
    pub rounding: f64,
    /// Angle by which the corners are rotated about their origin (rad).
    #[serde(default)]
    pub angle: f64,
    /// Velocity of its centre of mass (m/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
    /// Angular velocity (rad/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin: Vec<f64>,
}

/// One polyhedron: a cuboid, the hull of its corners, or the hull of a mesh.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnePolyhedron {
    /// Position of the origin of its corners (m); for a cuboid its centre.
    pub at: Vec<f64>,
    /// Corners (m), in any order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<(f64, f64, f64)>,
    /// Lengths of the edges of a cuboid (m), instead of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<(f64, f64, f64)>,
    /// An STL or OBJ file, relative to the case, whose hull is used instead of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Factor on the lengths in the file.
    #[serde(default = "one")]
    pub scale: f64,
    /// Rotation vector (rad) by which the corners are rotated about their origin.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turned: Vec<f64>,
    /// Rounding radius of the edges (m).
    #[serde(default)]
    pub rounding: f64,
    /// Velocity of its centre of mass (m/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
    /// Angular velocity (rad/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin: Vec<f64>,
}

/// One rigid union.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneCluster {
    /// Position of the origin of its shapes (m).
    pub at: Vec<f64>,
    /// Balls and convex shapes; overlaps count twice in the mass.
    pub shapes: Vec<ShapeSpec>,
    /// Velocity of its centre of mass (m/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
    /// Angular velocity (rad/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin: Vec<f64>,
}
