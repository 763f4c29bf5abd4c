//! Contact surfaces of deformable bodies.

use fretwork_core::geometry::any_shape::AnySurface;
use fretwork_core::geometry::mesh::Mesh;
use fretwork_core::geometry::polyline::Polyline;
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::{Space, VectorLike};
use nalgebra::{Vector2, Vector3};

/// Creates the surface of vertices (m) and, in space, of triangles between them; in the plane with
/// a period along x (m), where the last vertex is the image of the first.
///
/// # Errors
/// Returns why they form no surface.
pub(crate) fn open_surface<S: Space>(
    vertices: Vec<S::Vector>,
    facets: &[[u32; 3]],
    period: Option<f64>,
) -> Result<Box<dyn Surface<S>>, String> {
    made(match S::D {
        2 => {
            let line = Polyline::new(in_the_plane(&vertices), period);
            AnySurface::Plane(Box::new(line.map_err(|e| e.to_string())?))
        }
        _ => {
            let mesh = Mesh::new(in_space(&vertices), facets.to_vec());
            let mesh = mesh.map_err(|e| e.to_string())?;
            AnySurface::Space(Box::new(mesh.with_wear()))
        }
    })
}

/// Creates the closed surface around a solid, from vertices (m), in the plane clockwise, and
/// triangles between them.
///
/// # Errors
/// Returns why they form no surface.
pub(crate) fn closed_surface<S: Space>(
    vertices: Vec<S::Vector>,
    facets: &[[u32; 3]],
) -> Result<Box<dyn Surface<S>>, String> {
    made(match S::D {
        2 => {
            let line = Polyline::closed(in_the_plane(&vertices));
            AnySurface::Plane(Box::new(line.map_err(|e| e.to_string())?))
        }
        _ => {
            let mesh = Mesh::closed(in_space(&vertices), facets.to_vec());
            AnySurface::Space(Box::new(mesh.map_err(|e| e.to_string())?))
        }
    })
}

fn made<S: Space>(surface: AnySurface) -> Result<Box<dyn Surface<S>>, String> {
    let surface = surface.into_dimension();
    surface.ok_or_else(|| "the surface has another dimension".to_owned())
}

fn in_the_plane<V: VectorLike>(vertices: &[V]) -> Vec<Vector2<f64>> {
    let vertices = vertices.iter();
    vertices.map(|v| Vector2::new(v[0], v[1])).collect()
}

fn in_space<V: VectorLike>(vertices: &[V]) -> Vec<Vector3<f64>> {
    let vertices = vertices.iter();
    vertices.map(|v| Vector3::new(v[0], v[1], v[2])).collect()
}
