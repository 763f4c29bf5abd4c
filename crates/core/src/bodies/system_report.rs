//! Data of a dynamical system for results, pictures and checks: its contact surface, and its size in
//! memory.

use crate::geometry::space::Space;

/// The surface of a system that touches, as points with facets between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchingSurface<S: Space> {
    /// The node of the system at each point.
    pub nodes: Vec<u32>,
    /// Places of the points without load (m).
    pub points: Vec<S::Vector>,
    /// The D points of each facet, one after the other, by their place among the points.
    pub facets: Vec<u32>,
    /// Area (m^2; length in the plane, m) that each point stands for now. They sum up to that of
    /// the surface.
    pub areas: Vec<f64>,
}

/// Memory of a system for its solutions (bytes), and their cost, as far as known before the first
/// step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SystemSize {
    /// Unknowns of a solution.
    pub unknowns: usize,
    /// The matrix that is assembled once.
    pub matrix: usize,
    /// The factor of A, with its pattern; zero of systems without a factor.
    pub factor: usize,
    /// Compliance of the surface that is kept once all of it was touched.
    pub surface: usize,
    /// Compliance of a single point of the surface.
    pub point: usize,
    /// Floating-point operations of a factorisation, and of a solution with the factor or the table
    /// of influences.
    pub operations: [f64; 2],
    /// Whether A is factorised again in every iteration of a step.
    pub refactorised: bool,
}
