//! Shapes, distances and the neighbour search.
pub mod algebra;
mod boxes;
mod cells;
pub mod convex;
pub mod crossing;
pub mod drum;
pub mod facets;
pub mod grid;
pub mod height_field;
pub mod mesh;
pub mod mortar;
pub mod overlap;
pub mod periodic;
pub mod polyline;
pub mod recede;
pub mod shape;
pub mod space;
pub mod worn_mesh;
