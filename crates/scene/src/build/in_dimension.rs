//! Shapes that exist in one dimension alone, for a case of either.

use crate::case::Side;
use fretwork_core::geometry::any_shape::{AnyPart, AnySurface};
use fretwork_core::geometry::convex::ConvexPart;
use fretwork_core::geometry::convex::polygon::Polygon;
use fretwork_core::geometry::convex::polyhedron::Polyhedron;
use fretwork_core::geometry::crossing;
use fretwork_core::geometry::height_field::HeightField;
use fretwork_core::geometry::mesh::Mesh;
use fretwork_core::geometry::polyline::{Polyline, ProfileError};
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::Space;
use nalgebra::{Vector2, Vector3};

/// A surface in the dimension of the case.
type Made<S> = Result<Box<dyn Surface<S>>, String>;

/// Makes a profile from its points, left to right (m).
///
/// # Errors
/// The reason why the points are not a valid profile, or that the dimension has no profiles.
pub(super) fn profile<S: Space>(
    points: Vec<(f64, f64)>,
    side: Side,
    period: Option<f64>,
) -> Made<S> {
    let other = || "a profile needs two dimensions; use a HeightField in three".to_owned();
    if S::D != 2 {
        return Err(other());
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
    let surface = AnySurface::Plane(Box::new(line));
    surface.into_dimension().ok_or_else(other)
}

/// Makes a height field of so many points along x and y, their distances and heights (m), and along
/// which axes it repeats.
///
/// # Errors
/// The reason why the heights are not a valid field, or that the dimension has no height fields.
pub(super) fn height_field<S: Space>(
    points: (usize, usize),
    spacing: (f64, f64),
    heights: Vec<f64>,
    periodic: [bool; 2],
) -> Made<S> {
    let other =
        || "a height field needs three dimensions; use a Profile or RoughProfile in two".to_owned();
    if S::D != 3 {
        return Err(other());
    }
    let spacing = [spacing.0, spacing.1];
    let field = HeightField::new(points.0, points.1, spacing, heights, periodic);
    let surface = AnySurface::Space(Box::new(field.map_err(|e| e.to_string())?));
    surface.into_dimension().ok_or_else(other)
}

/// A surface of triangles.
///
/// # Errors
/// The dimension has none.
pub(super) fn mesh<S: Space>(mesh: Mesh) -> Made<S> {
    let surface = AnySurface::Space(Box::new(mesh)).into_dimension();
    surface.ok_or_else(|| "a mesh needs three dimensions; use a Profile in two".to_owned())
}

/// A convex part from a polygon.
///
/// # Errors
/// The dimension has none.
pub(super) fn polygon<S: Space>(core: &Polygon, rounding: f64) -> Result<ConvexPart<S>, String> {
    let part = AnyPart::Plane(core.part(rounding)).into_dimension();
    part.ok_or_else(|| "polygons and arches need two dimensions; use polyhedra in three".to_owned())
}

/// A convex part from a polyhedron.
///
/// # Errors
/// The dimension has none.
pub(super) fn polyhedron<S: Space>(
    core: &Polyhedron,
    rounding: f64,
) -> Result<ConvexPart<S>, String> {
    let part = AnyPart::Space(core.part(rounding)).into_dimension();
    part.ok_or_else(|| "polyhedra and boxes need three dimensions; use polygons in two".to_owned())
}

/// A capsule: all points within a radius of a segment (m).
///
/// # Errors
/// None: there are capsules in both dimensions.
pub(super) fn capsule<S: Space>(
    from: &S::Vector,
    to: &S::Vector,
    radius: f64,
) -> Result<ConvexPart<S>, String> {
    let part = match S::D {
        2 => {
            let [from, to] = [from, to].map(|v| Vector2::new(v[0], v[1]));
            AnyPart::Plane(Polygon::segment(from, to).part(radius))
        }
        _ => {
            let [from, to] = [from, to].map(|v| Vector3::new(v[0], v[1], v[2]));
            AnyPart::Space(Polyhedron::segment(from, to).part(radius))
        }
    };
    let part = part.into_dimension();
    part.ok_or_else(|| "a capsule has the dimension of the case".to_owned())
}
