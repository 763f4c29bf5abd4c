//! Converts deformable bodies to the views of `results.h5`: the mesh of each finite element body,
//! the surface of each body with contacts, and one mesh per material for its deformable grains. The
//! bodies are those that the case lists as `elastic` and `half_spaces`.

use super::results::{Field, Mesh};
use fretwork_core::view::{RunView, SystemView};
use fretwork_observe::mesh_fields::{
    BodyState, FieldLocation, GrainsState, MeshField, of_bodies, of_grains, of_surfaces, triples,
};
use fretwork_observe::tractions::SurfaceState;
use fretwork_scene::case::Case;
use std::collections::BTreeMap;

/// The systems whose fields are written.
fn systems<'a>(
    case: &'a Case,
    run: &'a dyn RunView,
) -> impl Iterator<Item = (usize, Box<dyn SystemView + 'a>)> {
    let listed = move |name: &str| {
        let elastic = case.elastic.iter().map(|b| &b.name);
        let mut names = elastic.chain(case.half_spaces.iter().map(|b| &b.name));
        names.any(|n| n == name)
    };
    let all = (0..run.system_count()).filter_map(move |k| Some((k, run.system(k)?)));
    all.filter(move |(_, system)| listed(system.name()))
}

/// The deformable grains by the name of their material, as indices of their systems.
fn grains<'a>(case: &'a Case, run: &dyn RunView) -> Vec<(&'a str, Vec<usize>)> {
    let mut of_material: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
    for k in 0..run.system_count() {
        let system = run.system(k).filter(|s| s.is_grain());
        if let Some(contactor) = system.and_then(|s| s.contactors().into_iter().next()) {
            of_material.entry(contactor.material).or_default().push(k);
        }
    }
    let named = of_material.into_iter().filter_map(|(material, systems)| {
        let name = case.materials.keys().nth(usize::from(material))?;
        Some((name.as_str(), systems))
    });
    named.collect()
}

/// The meshes and surfaces of the bodies of a case, and its deformable grains.
pub fn of(case: &Case, run: &dyn RunView) -> Vec<Mesh> {
    let mut out = Vec::new();
    for (k, system) in systems(case, run) {
        if let Some(mesh) = system.deformed_mesh() {
            out.push(Mesh {
                group: format!("meshes/{}", system.name()),
                points: triples(&mesh.points),
                cells: mesh.elements.iter().map(|p| i64::from(*p)).collect(),
                corners: run.dimension() + 1,
                fields: fields(&of_bodies()),
                ..Mesh::default()
            });
        }
        if let Some(state) = SurfaceState::of(run, k) {
            out.push(Mesh {
                group: format!("surfaces/{}", system.name()),
                points: triples(&state.surface.points),
                cells: state.surface.facets.iter().map(|p| i64::from(*p)).collect(),
                corners: run.dimension(),
                fields: fields(&of_surfaces(run.dimension())),
                ..Mesh::default()
            });
        }
    }
    for (material, systems) in grains(case, run) {
        let state = GrainsState::of(run, &systems);
        out.push(Mesh {
            group: format!("elastic_grains/{material}"),
            points: triples(state.start()),
            cells: state.elements().iter().map(|p| i64::from(*p)).collect(),
            corners: run.dimension() + 1,
            fields: fields(&of_grains()),
            bodies: state.bodies().clone(),
        });
    }
    out
}

fn fields<T>(registered: &[MeshField<T>]) -> Vec<Field> {
    let field = |f: &MeshField<T>| Field {
        name: f.name,
        unit: f.unit,
        doc: f.doc,
        width: f.width,
        of_cells: f.at == FieldLocation::Cells,
    };
    registered.iter().map(field).collect()
}

/// The values of all fields now, in the order of [`of`].
pub fn values(case: &Case, run: &dyn RunView) -> Vec<Vec<Vec<f64>>> {
    let mut out = Vec::new();
    for (k, system) in systems(case, run) {
        if let Some(state) = BodyState::of(&*system) {
            let values = of_bodies().map(|f| (f.values)(&state));
            out.push(values.to_vec());
        }
        if let Some(state) = SurfaceState::of(run, k) {
            let values = of_surfaces(run.dimension()).map(|f| (f.values)(&state));
            out.push(values.to_vec());
        }
    }
    for (_, systems) in grains(case, run) {
        let state = GrainsState::of(run, &systems);
        out.push(of_grains().map(|f| (f.values)(&state)).to_vec());
    }
    out
}

/// Size in bytes of a recorded state of all bodies.
pub fn bytes(case: &Case, run: &dyn RunView) -> usize {
    let values = values(case, run).into_iter().flatten();
    values.map(|column| 8 * column.len()).sum()
}
