//! Shapes that exist in one dimension only, for a case of either dimension.

use crate::case::Side;
use fretwork_core::geometry::any_shape::{AnyPart, AnySurface};
use fretwork_core::geometry::convex::polygon::Polygon;
use fretwork_core::geometry::convex::polyhedron::Polyhedron;
use fretwork_core::geometry::crossing;
use fretwork_core::geometry::height_field::HeightField;
use fretwork_core::geometry::mesh::Mesh;
use fretwork_core::geometry::polyline::{Polyline, ProfileError};
use nalgebra::{Vector2, Vector3};

/// Creates a profile from its points, left to right (m).
///
/// # Errors
/// Returns why the points are not a valid profile, or that the dimension has no profiles.
pub(super) fn profile(
    dimension: usize,
    points: Vec<(f64, f64)>,
    side: Side,
    period: Option<f64>,
) -> Result<AnySurface, String> {
    if dimension != 2 {
        return Err("a profile needs two dimensions; use a HeightField in three".to_owned());
    }
    let points = points.into_iter().map(|(x, y)| Vector2::new(x, y));
    let mut points: Vec<Vector2<f64>> = points.collect();
    if let Some((a, b, at)) = crossing::first(&points) {
        return Err(ProfileError::Crosses(a, b, at.x, at.y).to_string());
    }
    if let Some(k) = points.windows(2).position(|w| w[1].x < w[0].x) {
        return Err(format!(
            "the points of a profile must go from left to right, but point {} at x = {:e} m is left of the one before, at {:e} m",
            k + 1,
            points[k + 1].x,
            points[k].x
        ));
    }
    if side == Side::Above {
        points.reverse();
    }
    let line = Polyline::new(points, period).map_err(|e| e.to_string())?;
    Ok(AnySurface::Plane(Box::new(line)))
}

/// Creates a height field from the numbers of points along x and y, their distances and heights
/// (m), and the axes along which it is periodic.
///
/// # Errors
/// Returns why the heights are not a valid field, or that the dimension has no height fields.
pub(super) fn height_field(
    dimension: usize,
    points: (usize, usize),
    spacing: (f64, f64),
    heights: Vec<f64>,
    periodic: [bool; 2],
) -> Result<AnySurface, String> {
    if dimension != 3 {
        let message = "a height field needs three dimensions; use a Profile or RoughProfile in two";
        return Err(message.to_owned());
    }
    let spacing = [spacing.0, spacing.1];
    let field = HeightField::new(points.0, points.1, spacing, heights, periodic);
    Ok(AnySurface::Space(Box::new(
        field.map_err(|e| e.to_string())?,
    )))
}

/// A surface of triangles.
///
/// # Errors
/// The dimension has none.
pub(super) fn mesh(dimension: usize, mesh: Mesh) -> Result<AnySurface, String> {
    if dimension != 3 {
        return Err("a mesh needs three dimensions; use a Profile in two".to_owned());
    }
    Ok(AnySurface::Space(Box::new(mesh)))
}

/// A convex part from a polyhedron.
///
/// # Errors
/// The dimension has none.
pub(super) fn polyhedron(
    dimension: usize,
    core: &Polyhedron,
    rounding: f64,
) -> Result<AnyPart, String> {
    if dimension != 3 {
        return Err("polyhedra and boxes need three dimensions; use polygons in two".to_owned());
    }
    Ok(AnyPart::Space(core.part(rounding)))
}

/// A capsule: all points within a radius of a segment (m).
pub(super) fn capsule(
    dimension: usize,
    from: &Vector3<f64>,
    to: &Vector3<f64>,
    radius: f64,
) -> AnyPart {
    match dimension {
        2 => AnyPart::Plane(Polygon::segment(from.xy(), to.xy()).part(radius)),
        _ => AnyPart::Space(Polyhedron::segment(*from, *to).part(radius)),
    }
}
