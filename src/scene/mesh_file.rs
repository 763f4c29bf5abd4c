//! Triangles from STL and OBJ files.

use nalgebra::Vector3;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;

type V = Vector3<f64>;

/// Points in the unit of the file, each once, and triangles of them.
///
/// # Errors
/// The file cannot be read, is none of the two formats or holds no triangles.
pub fn read(path: &Path) -> Result<(Vec<V>, Vec<[u32; 3]>), String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let shown = path.display();
    let mut soup = Vec::new();
    match extension.as_deref() {
        Some("stl") => {
            let file = File::open(path).map_err(|e| format!("cannot open {shown}: {e}"))?;
            let mesh = stl_io::read_stl(&mut BufReader::new(file));
            let mesh = mesh.map_err(|e| match e.kind() {
                ErrorKind::UnexpectedEof => format!(
                    "{shown} ends before its last triangle: it was cut short; copy or export it again"
                ),
                _ => format!("{shown} is no STL file: {e}"),
            })?;
            for face in &mesh.faces {
                let corner = |k: usize| {
                    let [x, y, z] = mesh.vertices[face.vertices[k]].0;
                    V::new(x.into(), y.into(), z.into())
                };
                soup.push([corner(0), corner(1), corner(2)]);
            }
        }
        Some("obj") => {
            let options = tobj::LoadOptions {
                triangulate: true,
                ignore_points: true,
                ignore_lines: true,
                ..tobj::LoadOptions::default()
            };
            File::open(path).map_err(|e| format!("cannot open {shown}: {e}"))?;
            let (models, _) = tobj::load_obj(path, &options).map_err(|e| match e {
                tobj::LoadError::FaceVertexOutOfBounds => format!(
                    "a face of {shown} names a vertex that it does not have; export it again"
                ),
                _ => format!("{shown} is no OBJ file: {e}"),
            })?;
            for mesh in models.iter().map(|m| &m.mesh) {
                let corner = |k: u32| V::from_row_slice(&mesh.positions[3 * k as usize..][..3]);
                let triangles = mesh.indices.chunks_exact(3);
                soup.extend(triangles.map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]));
            }
        }
        _ => return Err(format!("{shown} is neither an .stl nor an .obj file")),
    }
    if soup.is_empty() {
        return Err(format!("{shown} holds no triangles"));
    }
    Ok(joined(&soup))
}

/// Corners at the same place become one point; what has no area is left out.
fn joined(soup: &[[V; 3]]) -> (Vec<V>, Vec<[u32; 3]>) {
    let mut points: Vec<V> = Vec::new();
    let mut known = HashMap::new();
    let mut name = |p: &V| {
        // Zero has two signs.
        let bits = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
        *known.entry(bits).or_insert_with(|| {
            points.push(*p);
            points.len() as u32 - 1
        })
    };
    let triangles: Vec<[u32; 3]> = soup
        .iter()
        .map(|t| [name(&t[0]), name(&t[1]), name(&t[2])])
        .collect();
    let thick = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    (points, triangles.into_iter().filter(thick).collect())
}
