//! Deformable bodies and grains, and surfaces with contacts: triangles or lines with fields at
//! points and elements. Of tetrahedra only the outer faces are shown.

use super::range::{FieldInfo, Ranges};
use super::{Note, Places, place, push_points};
use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};

/// Groups of the views with meshes.
const GROUPS: [&str; 3] = ["meshes", "elastic_grains", "surfaces"];

/// A field with its number of components.
struct MeshField {
    field: FieldInfo,
    width: usize,
    of_cells: bool,
}

struct Mesh {
    path: String,
    points: Vec<f64>,
    /// Points that are shown, elements as indices into these points, and the cell of each element.
    used: Vec<usize>,
    elements: Vec<usize>,
    corners: usize,
    cells: Vec<usize>,
    counts: [usize; 2],
    fields: Vec<MeshField>,
}

/// The meshes of a run.
#[derive(Default)]
pub(super) struct Meshes {
    meshes: Vec<Mesh>,
    grains: HashSet<u64>,
}

impl Meshes {
    /// Reads what all states have in common.
    pub fn find(run: &RunFolder) -> Result<Self, String> {
        let mut out = Self::default();
        for group in GROUPS {
            for name in run.reader.groups_in(&format!("views/{group}")) {
                out.meshes
                    .extend(mesh(run, &format!("views/{group}/{name}"))?);
            }
        }
        for mesh in &out.meshes {
            let name = format!("{}/PointData/body", mesh.path);
            if run.reader.has(&name) {
                let ids = run.reader.values(&name, (0, mesh.counts[0]), 1)?;
                out.grains.extend(ids.into_iter().map(|id| id as u64));
            }
        }
        Ok(out)
    }

    /// Identities of the grains that are meshes.
    pub fn grains(&self) -> HashSet<u64> {
        self.grains.clone()
    }

    /// The meshes and their fields for the page.
    pub fn head(&self, ranges: &Ranges) -> Value {
        let mesh = |(k, mesh): (usize, &Mesh)| {
            let group = format!("mesh{k}");
            let parts = |f: &MeshField| {
                let parts = f.parts().into_iter().filter_map(|(name, _)| {
                    let mut head = ranges.head(&group, &name, &f.field)?;
                    head["cells"] = json!(f.of_cells);
                    Some(head)
                });
                parts.collect::<Vec<_>>()
            };
            let fields: Vec<Value> = mesh.fields.iter().flat_map(parts).collect();
            let name = mesh.path.trim_start_matches("views/");
            json!({"name": name, "corners": mesh.corners, "fields": fields})
        };
        self.meshes.iter().enumerate().map(mesh).collect()
    }

    /// Adds the arrays of a state; returns the places of the points of surfaces.
    pub fn read(
        &self,
        run: &RunFolder,
        state: usize,
        dimension: usize,
        arrays: &mut Arrays,
        note: &mut Note<'_>,
    ) -> Result<Places, String> {
        let mut places = Places::new();
        for (k, mesh) in self.meshes.iter().enumerate() {
            let name = format!("mesh{k}");
            let pick = |values: &[f64], width: usize, rows: &[usize]| -> Vec<f64> {
                let row = |p: &usize| values[width * p..width * (p + 1)].iter().copied();
                rows.iter().flat_map(row).collect()
            };
            push_points(arrays, &name, &pick(&mesh.points, 3, &mesh.used), dimension);
            let elements: Vec<f64> = mesh.elements.iter().map(|p| *p as f64).collect();
            arrays.push(format!("{name}.element"), NumberType::U32, &elements);
            for field in &mesh.fields {
                let place_of = if field.of_cells {
                    "CellData"
                } else {
                    "PointData"
                };
                let count = mesh.counts[usize::from(field.of_cells)];
                let path = format!("{}/{place_of}/{}", mesh.path, field.field.name);
                let values = run
                    .reader
                    .values(&path, (state * count, count), field.width)?;
                let rows = if field.of_cells {
                    &mesh.cells
                } else {
                    &mesh.used
                };
                if field.field.name == "displacement" {
                    let moved = pick(&values, field.width, rows);
                    push_points(arrays, &format!("{name}.move"), &moved, dimension);
                    for (from, way) in mesh
                        .points
                        .as_chunks::<3>()
                        .0
                        .iter()
                        .zip(values.as_chunks::<3>().0)
                    {
                        places.insert(place(std::array::from_fn(|a| from[a] + way[a])));
                    }
                }
                for (part, get) in field.parts() {
                    let value = |p: &usize| get.of(&values[field.width * p..field.width * (p + 1)]);
                    let values: Vec<f64> = rows.iter().map(value).collect();
                    note(&name, &part, &values);
                    arrays.push(format!("{name}:{part}"), NumberType::U16, &values);
                }
            }
        }
        Ok(places)
    }
}

/// A number of a value of a field.
#[derive(Clone, Copy)]
enum Part {
    Size,
    At(usize),
}

impl Part {
    fn of(self, value: &[f64]) -> f64 {
        match self {
            Self::Size => value.iter().map(|x| x * x).sum::<f64>().sqrt(),
            Self::At(k) => value[k],
        }
    }
}

impl MeshField {
    /// Returns the values that are shown of a field: its value, the magnitude of a vector, the
    /// components of a tensor.
    fn parts(&self) -> Vec<(String, Part)> {
        let named = |k: usize, of: &str| (format!("{} {of}", self.field.name), Part::At(k));
        match self.width {
            1 => vec![(self.field.name.clone(), Part::At(0))],
            6 => ["xx", "yy", "zz", "xy", "yz", "xz"]
                .into_iter()
                .enumerate()
                .map(|(k, n)| named(k, n))
                .collect(),
            _ => vec![(format!("{} (size)", self.field.name), Part::Size)],
        }
    }
}

fn mesh(run: &RunFolder, path: &str) -> Result<Option<Mesh>, String> {
    let reader = &run.reader;
    let all = |name: &str, width: usize| {
        let name = format!("{path}/{name}");
        reader.values(&name, (0, reader.rows(&name)?), width)
    };
    if !reader.has(&format!("{path}/Points")) {
        return Ok(None);
    }
    let points = all("Points", 3)?;
    let cells: Vec<usize> = all("Connectivity", 1)?
        .into_iter()
        .map(|p| p as usize)
        .collect();
    let offsets = all("Offsets", 1)?;
    let count = offsets.len().saturating_sub(1);
    let corners = cells.len().checked_div(count).unwrap_or(3);
    if cells.iter().any(|p| 3 * p >= points.len()) || corners == 0 {
        return Err(format!("`{path}` holds elements without points"));
    }
    let (elements, owners) = match corners {
        4 => outside(&cells),
        _ => (cells, (0..count).collect()),
    };
    let mut fields = Vec::new();
    for (place, of_cells) in [("PointData", false), ("CellData", true)] {
        let group = format!("{path}/{place}");
        for name in reader.datasets_in(&group).filter(|n| *n != "body") {
            fields.push(MeshField {
                width: reader.width(&format!("{group}/{name}"))?,
                field: FieldInfo::read(run, &group, name),
                of_cells,
            });
        }
    }
    let mut used = elements.clone();
    used.sort_unstable();
    used.dedup();
    let elements = elements
        .into_iter()
        .filter_map(|p| used.binary_search(&p).ok())
        .collect();
    Ok(Some(Mesh {
        used,
        path: path.to_owned(),
        counts: [points.len() / 3, count],
        points,
        corners: corners.min(3),
        elements,
        cells: owners,
        fields,
    }))
}

/// Returns the faces that belong to only one tetrahedron, with outward orientation, and their
/// tetrahedra.
fn outside(cells: &[usize]) -> (Vec<usize>, Vec<usize>) {
    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut seen: HashMap<[usize; 3], usize> = HashMap::new();
    let faces = |cell: &[usize]| FACES.map(|f| f.map(|k| cell[k]));
    let key = |mut face: [usize; 3]| {
        face.sort_unstable();
        face
    };
    for cell in cells.chunks_exact(4) {
        for face in faces(cell) {
            *seen.entry(key(face)).or_default() += 1;
        }
    }
    let (mut elements, mut owners) = (Vec::new(), Vec::new());
    for (owner, cell) in cells.chunks_exact(4).enumerate() {
        for face in faces(cell).into_iter().filter(|f| seen[&key(*f)] == 1) {
            elements.extend(face);
            owners.push(owner);
        }
    }
    (elements, owners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_between_two_tetrahedra_is_inside() {
        let (elements, owners) = outside(&[0, 1, 2, 3, 1, 2, 3, 4]);
        assert_eq!(owners, [0, 0, 0, 1, 1, 1]);
        let inner = |face: &[usize]| {
            let mut face = face.to_vec();
            face.sort_unstable();
            face == [1, 2, 3]
        };
        assert!(!elements.chunks(3).any(inner));
    }
}
