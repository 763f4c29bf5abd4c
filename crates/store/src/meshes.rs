//! Converts deformable bodies to the views of `results.h5`: the mesh of each body of finite elements, and the surface of each body that
//! touches. Bodies are those that the case lists as `elastic` and `half_spaces`.

use super::results::{Field, Mesh};
use fretwork_core::bodies::DynamicalSystem;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use fretwork_observe::mesh_fields::{At, BodyState, MeshField, of_bodies, of_surfaces, triples};
use fretwork_observe::tractions::SurfaceState;
use fretwork_scene::case::Case;

/// The systems whose fields are written.
fn systems<'a, S: Space>(
    case: &'a Case,
    s: &'a Simulation<S>,
) -> impl Iterator<Item = (usize, &'a dyn DynamicalSystem<S>)> {
    let listed = move |name: &str| {
        let elastic = case.elastic.iter().map(|b| &b.name);
        let mut names = elastic.chain(case.half_spaces.iter().map(|b| &b.name));
        names.any(|n| n == name)
    };
    let all = (0..s.state.systems.len()).filter_map(|k| Some((k, s.state.systems.get(k)?)));
    all.filter(move |(_, system)| listed(system.name()))
}

/// The meshes and surfaces of the bodies of a case.
pub fn of<S: Space>(case: &Case, s: &Simulation<S>) -> Vec<Mesh> {
    let mut out = Vec::new();
    for (k, system) in systems(case, s) {
        if let Some(mesh) = system.deformed_mesh() {
            out.push(Mesh {
                group: format!("meshes/{}", system.name()),
                points: triples(&mesh.points),
                cells: mesh.elements.iter().map(|p| i64::from(*p)).collect(),
                corners: S::D + 1,
                fields: fields(&of_bodies::<S>()),
            });
        }
        if let Some(state) = SurfaceState::of(s, k) {
            out.push(Mesh {
                group: format!("surfaces/{}", system.name()),
                points: triples(&state.surface.points),
                cells: state.surface.facets.iter().map(|p| i64::from(*p)).collect(),
                corners: S::D,
                fields: fields(&of_surfaces::<S>()),
            });
        }
    }
    out
}

fn fields<T>(registered: &[MeshField<T>]) -> Vec<Field> {
    let field = |f: &MeshField<T>| Field {
        name: f.name,
        unit: f.unit,
        doc: f.doc,
        width: f.width,
        of_cells: f.at == At::Cells,
    };
    registered.iter().map(field).collect()
}

/// The values of all fields now, in the order of [`of`].
pub fn values<S: Space>(case: &Case, s: &Simulation<S>) -> Vec<Vec<Vec<f64>>> {
    let mut out = Vec::new();
    for (k, system) in systems(case, s) {
        if let Some(state) = BodyState::of(system) {
            let values = of_bodies().map(|f| (f.values)(&state));
            out.push(values.to_vec());
        }
        if let Some(state) = SurfaceState::of(s, k) {
            let values = of_surfaces().map(|f| (f.values)(&state));
            out.push(values.to_vec());
        }
    }
    out
}

/// Bytes of a recorded state of all bodies.
pub fn bytes<S: Space>(case: &Case, s: &Simulation<S>) -> usize {
    let values = values(case, s).into_iter().flatten();
    values.map(|column| 8 * column.len()).sum()
}
