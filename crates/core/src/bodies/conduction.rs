//! Conduction of heat in the mesh of a dynamical system.

/// Linear elements for heat, the capacity of each lumped at its points. With the conductivity k
/// (W/(m K)) and the volumetric heat capacity rho c (J/(m^3 K)), the capacity of point a and the
/// conductance between points a and b are
///
/// ```text
/// C_a = rho c V_a,    G_ab = -k sum_e V_e grad N_a . grad N_b
/// ```
///
/// Source: T. J. R. Hughes, "The Finite Element Method" (2000), chapters 2 and 8.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conduction {
    /// V_a, the tributary volume of each point (m^3; m^2 in 2D).
    pub volumes: Vec<f64>,
    /// Pairs of points and G_ab/k (m; a pure number in 2D); negative opposite an obtuse
    /// angle.
    pub edges: Vec<([u32; 2], f64)>,
    /// Named parts of the boundary: points with their tributary areas (m^2; m in 2D).
    pub parts: Vec<(String, Vec<(u32, f64)>)>,
}
