//! Reads the deformation of grains in a recorded state, from the meshes of their materials.

use super::reader::Reader;
use fretwork_scene::recorded::Deformed;
use std::collections::{BTreeSet, HashMap};

/// Group of the meshes of deformable grains.
const ROOT: &str = "views/elastic_grains";

/// Reads the deformation of all deformable grains in the state with the index `frame`, by the
/// identity of the grain.
///
/// # Errors
/// The file is damaged; the text says where.
pub(super) fn read(reader: &Reader, frame: usize) -> Result<HashMap<u64, Deformed>, String> {
    let mut out = HashMap::new();
    for material in reader.groups_in(ROOT) {
        of_material(reader, &format!("{ROOT}/{material}"), frame, &mut out)?;
    }
    Ok(out)
}

/// Adds the grains of one material, whose mesh is in `group`.
fn of_material(
    reader: &Reader,
    group: &str,
    frame: usize,
    out: &mut HashMap<u64, Deformed>,
) -> Result<(), String> {
    let bodies = |place: &str| {
        let name = format!("{group}/{place}Data/body");
        let count = reader.rows(&name)?;
        reader.whole(&name, (0, count))
    };
    let (of_points, of_cells) = (bodies("Point")?, bodies("Cell")?);
    let (points, cells) = (of_points.len(), of_cells.len());
    let places = reader.numbers(&format!("{group}/Points"), (0, points), 3)?;
    let field = |name: &str| {
        let rows = (frame * points, points);
        reader.numbers(&format!("{group}/PointData/{name}"), rows, 3)
    };
    let (moved, deformation, velocity) = (
        field("displacement")?,
        field("deformation")?,
        field("velocity")?,
    );
    let von_mises = reader.numbers(
        &format!("{group}/CellData/von_mises"),
        (frame * cells, cells),
        1,
    )?;
    let triple = |of: &[f64], k: usize| [of[3 * k], of[3 * k + 1], of[3 * k + 2]];
    for (k, body) in of_points.iter().enumerate() {
        let (from, way) = (triple(&places, k), triple(&moved, k));
        let grain: &mut Deformed = out.entry(*body as u64).or_default();
        grain.places.push(std::array::from_fn(|a| from[a] + way[a]));
        grain.deformation.push(triple(&deformation, k));
        grain.velocity.push(triple(&velocity, k));
    }
    for (body, stress) in of_cells.iter().zip(von_mises) {
        let grain = out.entry(*body as u64).or_default();
        grain.von_mises.push(stress);
    }
    Ok(())
}

impl Reader {
    /// Returns the names of the groups directly in a group.
    pub fn groups_in(&self, group: &str) -> BTreeSet<String> {
        let inside = self.names().filter_map(|n| {
            let rest = n.strip_prefix(group)?.strip_prefix('/')?;
            Some(rest.split('/').next()?.to_owned())
        });
        inside.collect()
    }
}
