//! Converts the state of a simulation to the views of `results.h5`.

use super::results::{Header, Part, Results, ResultsError};
use super::summary::RunFacts;
use super::{meshes, shapes};
use fretwork_core::view::{FieldInfo, FieldKind, FieldValues, GrainFields, RunView};
use fretwork_observe::Observers;
use fretwork_observe::statistics::Column;
use fretwork_scene::build::LoadedCase;
use fretwork_scene::recorded::ShapedGrain;
use nalgebra::Vector3;

/// References to the built scene.
#[derive(Debug)]
pub struct BuiltScene<'a> {
    /// The simulation.
    pub simulation: &'a dyn RunView,
    /// Material files: name and text.
    pub materials: &'a [(String, String)],
    /// Densities of the materials (kg/m^3).
    pub densities: &'a [f64],
    /// The deformable grains without load, in the order of their systems.
    pub deforming: &'a [ShapedGrain],
}

/// Content of the file before the first step, with the columns and tables of the observers.
pub fn header(
    loaded: &LoadedCase,
    built: &BuiltScene<'_>,
    run: &RunFacts,
    observers: &Observers,
) -> Header {
    let simulation = built.simulation;
    let dimension = simulation.dimension();
    let grains = simulation.grain_fields(with(simulation, loaded.case.circuit.is_some()));
    let contacts = simulation.contact_fields();
    let both = |kind| [columns(&grains, kind), columns(&contacts, kind), Vec::new()];
    let [mut of_grains, of_contacts, _] = both(FieldKind::Number);
    of_grains.extend(observers.grain_columns());
    Header {
        events: observers.event_tables(),
        case_name: loaded.case.name.clone(),
        case_text: loaded.source.written().to_owned(),
        materials: built.materials.to_vec(),
        plugins: run.plugins.clone(),
        seed: loaded.case.seed,
        dimension,
        shapes: shapes::of(simulation, built.densities, built.deforming),
        corners: simulation.grain_corners().iter().map(Vec::len).collect(),
        meshes: meshes::of(&loaded.case, simulation),
        version: run.version.clone(),
        statistics: observers.columns(),
        fields: [
            of_grains,
            of_contacts,
            vec![Column::new("body", "", "identity of the body")],
        ],
        numbers: both(FieldKind::Whole),
        vectors: {
            let [grains, contacts, _] = both(FieldKind::Vector);
            let doc = "velocity of the body at its origin";
            [grains, contacts, vec![Column::new("velocity", "m/s", doc)]]
        },
    }
}

/// Returns the fields of grains besides those that a simulation registers: orientations if there
/// are grains other than single balls, and whether a grain was removed if a circuit removes grains.
fn with(run: &dyn RunView, circuit: bool) -> GrainFields {
    GrainFields {
        orientation: shapes::needed(run),
        removed: circuit,
    }
}

/// Returns the columns of the fields of a kind.
fn columns(fields: &[FieldInfo], kind: FieldKind) -> Vec<Column> {
    let listed = fields.iter().filter(|f| f.kind == kind);
    listed.map(|f| Column::new(f.name, f.unit, f.doc)).collect()
}

/// Returns a part with the values of fields, one column each.
fn part(values: Vec<FieldValues>) -> Part {
    let mut part = Part::default();
    for column in values {
        match column {
            FieldValues::Number(all) => part.data.push(all),
            FieldValues::Whole(all) => part.numbers.push(all),
            FieldValues::Vector(all) => part.vectors.push(all),
        }
    }
    part
}

/// Returns the size in bytes of a recorded state per grain and per contact: points, cells, corners
/// and fields of 8 bytes per number.
pub fn bytes(run: &dyn RunView, circuit: bool) -> [usize; 2] {
    let width = |fields: Vec<FieldInfo>| fields.iter().map(FieldInfo::width).sum::<usize>();
    let grain = width(run.grain_fields(with(run, circuit)));
    let contact = width(run.contact_fields());
    let parts = run.grain_corners();
    let corners: usize = parts.iter().map(Vec::len).sum();
    let corners = corners.checked_div(parts.len()).unwrap_or(0);
    [8 * (3 + 2 + grain + 3 * corners), 8 * (6 + 3 + contact)]
}

/// Appends the current state of a case, with the values of the observers' columns of the grains, in
/// the order of the header.
///
/// # Errors
/// The file cannot be written.
pub fn append(
    results: &mut Results,
    run: &dyn RunView,
    loaded: &LoadedCase,
    values: Vec<Vec<f64>>,
) -> Result<(), ResultsError> {
    let mut grains = grains(run, loaded.case.circuit.is_some());
    let count = grains.cells.len();
    grains.data.extend(values.into_iter().map(|mut column| {
        column.resize(count, f64::NAN);
        column
    }));
    results.append_meshes(run.time(), &meshes::values(&loaded.case, run))?;
    let corners: Vec<f64> = run
        .grain_corners()
        .into_iter()
        .flatten()
        .flatten()
        .collect();
    let parts = [grains, contacts(run), bodies(run)];
    results.append_views(run.time(), &parts, &corners)
}

fn grains(run: &dyn RunView, circuit: bool) -> Part {
    let points = run.grain_points();
    Part {
        cells: (0..points.len() as i64).map(|k| vec![k]).collect(),
        points: points.into_iter().flatten().collect(),
        ..part(run.grain_values(with(run, circuit)))
    }
}

fn contacts(run: &dyn RunView) -> Part {
    let ends = run.contact_ends();
    let cells = (0..ends.len() as i64).map(|k| vec![2 * k, 2 * k + 1]);
    Part {
        cells: cells.collect(),
        points: ends.into_iter().flatten().flatten().collect(),
        ..part(run.contact_values(true))
    }
}

/// The surfaces and the convex parts of first bodies.
fn bodies(run: &dyn RunView) -> Part {
    let mut part = Part {
        data: vec![Vec::new()],
        vectors: vec![Vec::new()],
        ..Part::default()
    };
    let columns = run.bodies();
    let mut add = |body: u32, points: &[[f64; 3]]| {
        let first = part.points.len() as i64 / 3;
        part.points.extend(points.iter().flatten());
        part.cells
            .push((first..first + points.len() as i64).collect());
        part.data[0].push(columns.id[body as usize] as f64);
        part.vectors[0].extend(run.motion(body as usize).velocity);
    };
    for line in run.surface_outlines() {
        add(line.body, &line.points);
    }
    for (k, piece) in run.pieces().into_iter().enumerate() {
        let first = columns.driven.iter().any(|d| d.body == piece.body);
        if !first || columns.removed[piece.body as usize] {
            continue;
        }
        let centre = run.periodic().wrapped(Vector3::from(piece.centre));
        for line in run.piece_outline(k) {
            let placed = line.iter().map(|p| (centre + Vector3::from(*p)).into());
            let mut points: Vec<[f64; 3]> = placed.collect();
            // Lines need an explicit closing point, polygons do not.
            if run.dimension() == 2 {
                points.extend(points.first().copied());
            }
            add(piece.body, &points);
        }
    }
    part
}
