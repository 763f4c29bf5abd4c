//! Shapes, distances and the search for neighbours.
pub mod convex;
pub mod drum;
pub mod grid;
pub mod height_field;
pub mod periodic;
pub mod polyline;
pub mod shape;
pub mod space;
