//! Reader of triangle meshes in STL and OBJ files.

use super::source::read_bytes;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::io::{Cursor, ErrorKind};
use std::path::Path;

type V = Vector3<f64>;

/// Limit on the size of a mesh file, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Reads the distinct points, in the unit of the file, and the triangles between them.
///
/// # Errors
/// The file cannot be read, has neither format, or does not contain the number of triangles in its
/// header.
pub fn read(path: &Path) -> Result<(Vec<V>, Vec<[u32; 3]>), String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let shown = path.display();
    let bytes = || read_bytes(path, MAX_BYTES).map_err(|e| e.in_a_sentence());
    let mut soup = Vec::new();
    match extension.as_deref() {
        Some("stl") => {
            let bytes = bytes()?;
            for solid in solids(&bytes).map_err(|why| format!("{shown} {why}"))? {
                triangles(solid, &mut soup).map_err(|why| format!("{shown} {why}"))?;
            }
        }
        Some("obj") => {
            let options = tobj::LoadOptions {
                triangulate: true,
                ignore_points: true,
                ignore_lines: true,
                ..tobj::LoadOptions::default()
            };
            // Material files named by an OBJ file are not opened.
            let no_colours = |_: &Path| Ok((Vec::new(), Default::default()));
            let read = tobj::load_obj_buf(&mut Cursor::new(bytes()?), &options, no_colours);
            let (models, _) = read.map_err(|e| match e {
                tobj::LoadError::FaceVertexOutOfBounds => format!(
                    "a face of {shown} names a vertex that it does not have; export it again"
                ),
                _ => format!("{shown} is no OBJ file: {e}"),
            })?;
            for mesh in models.iter().map(|m| &m.mesh) {
                let corner = |k: u32| {
                    let at = mesh.positions.get(3 * k as usize..)?.get(..3)?;
                    Some(V::from_row_slice(at))
                };
                for t in mesh.indices.chunks_exact(3) {
                    let corners = (corner(t[0]), corner(t[1]), corner(t[2]));
                    let (Some(a), Some(b), Some(c)) = corners else {
                        return Err(format!(
                            "a face of {shown} names a vertex that it does not have; export it again"
                        ));
                    };
                    soup.push([a, b, c]);
                }
            }
        }
        _ => return Err(format!("{shown} is neither an .stl nor an .obj file")),
    }
    if soup.is_empty() {
        return Err(format!("{shown} holds no triangles"));
    }
    Ok(joined(&soup))
}

/// Length of the header of a binary STL file, and of each triangle, in bytes.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Splits an STL file into its solids, each as a file: one for a binary file, any number for a text
/// file.
fn solids(bytes: &[u8]) -> Result<Vec<Vec<u8>>, String> {
    let announced = bytes.get(HEADER - 4..HEADER).map(|count| {
        let count: [u8; 4] = [count[0], count[1], count[2], count[3]];
        u32::from_le_bytes(count) as usize
    });
    let whole = |count: usize| count.saturating_mul(TRIANGLE).saturating_add(HEADER);
    // A binary file may begin with "solid" too; its length distinguishes it.
    let binary = announced.is_some_and(|count| whole(count) == bytes.len());
    let text = bytes.starts_with(b"solid") && bytes.get(5).is_none_or(u8::is_ascii_whitespace);
    if text && !binary {
        return texts(bytes);
    }
    let Some(count) = announced else {
        return Err("is no STL file: it is shorter than the header of one".into());
    };
    let held = (bytes.len() - HEADER) / TRIANGLE;
    if bytes.len() < whole(count) {
        return Err(format!(
            "ends before its last triangle: it was cut short; copy or export it again (it announces {count} triangles \
             and holds {held})"
        ));
    }
    if bytes.len() > whole(count) {
        return Err(format!(
            "announces {count} triangles, and {} bytes follow them, room for {} more: its count is wrong, export it \
             again",
            bytes.len() - whole(count),
            held - count
        ));
    }
    // The header is blanked so that the parser does not take the file for text.
    let mut plain = bytes.to_vec();
    plain[0] = b' ';
    Ok(vec![plain])
}

/// Splits the solids of an STL text file.
fn texts(bytes: &[u8]) -> Result<Vec<Vec<u8>>, String> {
    let first_word = |line: &[u8]| {
        let words = line.split(u8::is_ascii_whitespace);
        words.filter(|w| !w.is_empty()).map(<[u8]>::to_vec).next()
    };
    let mut solids: Vec<Vec<u8>> = Vec::new();
    let mut open = false;
    for (k, line) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
        let word = first_word(line);
        match (open, word.as_deref()) {
            (false, None) => {}
            (false, Some(b"solid")) => {
                open = true;
                // The parser requires a name.
                solids.push(b"solid mesh\n".to_vec());
            }
            (false, Some(_)) => {
                return Err(format!(
                    "has text after its `endsolid`, in line {}: remove it, or begin another `solid` there",
                    k + 1
                ));
            }
            (true, word) => {
                if let Some(solid) = solids.last_mut() {
                    solid.extend_from_slice(line);
                }
                open = word != Some(b"endsolid");
            }
        }
    }
    Ok(solids)
}

fn triangles(solid: Vec<u8>, soup: &mut Vec<[V; 3]>) -> Result<(), String> {
    let mut bytes = Cursor::new(solid);
    let read = stl_io::create_stl_reader(&mut bytes).and_then(|faces| {
        for face in faces {
            let corners = face?.vertices.map(|v| {
                let [x, y, z] = v.0;
                V::new(x.into(), y.into(), z.into())
            });
            soup.push(corners);
        }
        Ok(())
    });
    read.map_err(|e| match e.kind() {
        ErrorKind::UnexpectedEof => {
            "ends before its last triangle: it was cut short; copy or export it again".to_owned()
        }
        _ => format!("is no STL file: {e}"),
    })
}

/// Merges corners at the same position and drops triangles without area.
fn joined(soup: &[[V; 3]]) -> (Vec<V>, Vec<[u32; 3]>) {
    let mut points: Vec<V> = Vec::new();
    let mut known = HashMap::new();
    let mut name = |p: &V| {
        // Adding zero turns -0.0 into 0.0.
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
