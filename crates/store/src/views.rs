//! Converts the state of a simulation to the views of `results.h5`.

use super::results::{Header, Part, Results, ResultsError};
use super::summary::RunFacts;
use super::{meshes, shapes};
use fretwork_core::fields::{Field, FieldList, Fields, GrainPart, Value, orientation, removed};
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::{InDimension, Simulation};
use fretwork_observe::statistics::Column;
use fretwork_observe::{Observers, placement};
use fretwork_scene::build::Loaded;
use fretwork_scene::recorded::ShapedGrain;

/// References to the built scene.
#[derive(Debug)]
pub struct Made<'a, S: Space> {
    /// The simulation.
    pub simulation: &'a Simulation<S>,
    /// Material files: name and text.
    pub materials: &'a [(String, String)],
    /// Densities of the materials (kg/m^3).
    pub densities: &'a [f64],
    /// The grains that deform, without load, in the order of their systems.
    pub deforming: &'a [ShapedGrain],
}

/// What the file says before the first step, with the columns and tables of the observers.
pub fn header<S: Space>(
    loaded: &Loaded,
    built: &Made<'_, S>,
    run: &RunFacts,
    observers: &Observers,
) -> Header {
    let fields = fields(built.simulation, loaded.case.circuit.is_some());
    Header {
        events: observers.event_tables(),
        case_name: loaded.case.name.clone(),
        case_text: loaded.source.text().to_owned(),
        materials: built.materials.to_vec(),
        plugins: run.plugins.clone(),
        seed: loaded.case.seed,
        dimension: S::D,
        shapes: shapes::of(built.simulation, built.densities, built.deforming),
        meshes: meshes::of(&loaded.case, built.simulation),
        version: run.version.clone(),
        statistics: observers.columns(),
        fields: [
            columns(&fields.grains, Kept::Number)
                .chain(observers.grain_columns())
                .collect(),
            columns(&fields.contacts, Kept::Number).collect(),
            vec![Column::new("body", "", "identity of the body")],
        ],
        numbers: [
            columns(&fields.grains, Kept::Whole).collect(),
            columns(&fields.contacts, Kept::Whole).collect(),
            Vec::new(),
        ],
        vectors: [
            columns(&fields.grains, Kept::Vector).collect(),
            columns(&fields.contacts, Kept::Vector).collect(),
            Vec::new(),
        ],
    }
}

/// The fields of a simulation's views: those it registers, orientations where there are grains that
/// are no lone balls, and whether grains were taken out where a circuit does so.
fn fields<S: Space>(s: &Simulation<S>, circuit: bool) -> Fields<S> {
    let mut fields = s.fields.clone();
    let turns = shapes::needed(s).then(orientation).into_iter().flatten();
    let gone = circuit.then(removed);
    turns.chain(gone).for_each(|field| fields.grains.add(field));
    fields
}

/// How the values of a field are kept in the file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kept {
    Number,
    Whole,
    Vector,
}

impl Kept {
    fn of<S: Space, T>(field: &Field<S, T>) -> Self {
        match field.value {
            Value::Number(_) => Self::Number,
            Value::Whole(_) => Self::Whole,
            Value::Vector(_) => Self::Vector,
        }
    }
}

/// Columns of the fields that are kept in this way.
fn columns<S: Space, T>(fields: &FieldList<S, T>, kept: Kept) -> impl Iterator<Item = Column> {
    let listed = fields.iter().filter(move |f| Kept::of(f) == kept);
    listed.map(|f| Column::new(f.name, f.unit, f.doc))
}

/// Appends the values of all fields for one thing.
fn push_fields<S: Space, T>(part: &mut Part, fields: &FieldList<S, T>, s: &Simulation<S>, of: &T) {
    let (mut data, mut numbers) = (part.data.iter_mut(), part.numbers.iter_mut());
    let mut vectors = part.vectors.iter_mut();
    for field in fields.iter() {
        match &field.value {
            Value::Number(get) => data.next().into_iter().for_each(|c| c.push(get(s, of))),
            Value::Whole(get) => numbers.next().into_iter().for_each(|c| c.push(get(s, of))),
            Value::Vector(get) => vectors
                .next()
                .into_iter()
                .for_each(|c| c.extend(get(s, of))),
        }
    }
}

/// A part with empty columns for these fields.
fn empty<S: Space, T>(fields: &FieldList<S, T>) -> Part {
    let count = |kept: Kept| fields.iter().filter(|f| Kept::of(f) == kept).count();
    Part {
        data: vec![Vec::new(); count(Kept::Number)],
        numbers: vec![Vec::new(); count(Kept::Whole)],
        vectors: vec![Vec::new(); count(Kept::Vector)],
        ..Part::default()
    }
}

/// Bytes per grain and per contact of a recorded state: points, cells and fields, 8 bytes a number.
pub fn bytes<S: Space>(s: &Simulation<S>, circuit: bool) -> [usize; 2] {
    let fields = fields(s, circuit);
    let grain: usize = fields.grains.iter().map(Field::width).sum();
    let contact: usize = fields.contacts.iter().map(Field::width).sum();
    [8 * (3 + 2 + grain), 8 * (6 + 3 + contact)]
}

/// Appends the current state of a case, with the values of the observers' columns of the grains, in
/// the order of the header.
///
/// # Errors
/// The file cannot be written.
pub fn append<S: Space>(
    results: &mut Results,
    s: &Simulation<S>,
    loaded: &Loaded,
    values: Vec<Vec<f64>>,
) -> Result<(), ResultsError> {
    append_known(results, InDimension::of(s), loaded, values)
}

// Without a type parameter it is compiled in this crate, and not in the program, which is not
// optimised (`Cargo.toml`).
fn append_known(
    results: &mut Results,
    s: InDimension<'_>,
    loaded: &Loaded,
    values: Vec<Vec<f64>>,
) -> Result<(), ResultsError> {
    match s {
        InDimension::Dim2(s) => append_in(results, s, loaded, values),
        InDimension::Dim3(s) => append_in(results, s, loaded, values),
    }
}

fn append_in<S: Space>(
    results: &mut Results,
    s: &Simulation<S>,
    loaded: &Loaded,
    values: Vec<Vec<f64>>,
) -> Result<(), ResultsError> {
    let fields = fields(s, loaded.case.circuit.is_some());
    let mut grains = grains(s, &fields);
    let count = grains.cells.len();
    grains.data.extend(values.into_iter().map(|mut column| {
        column.resize(count, f64::NAN);
        column
    }));
    results.append_meshes(s.state.time, &meshes::values(&loaded.case, s))?;
    results.append_views(s.state.time, &[grains, contacts(s, &fields), bodies(s)])
}

fn grains<S: Space>(s: &Simulation<S>, fields: &Fields<S>) -> Part {
    let mut part = empty(&fields.grains);
    for grain in GrainPart::all(s) {
        part.cells.push(vec![part.points.len() as i64 / 3]);
        let at = s.shapes.periodic.wrapped(grain.centre);
        part.points.extend(at.padded());
        push_fields(&mut part, &fields.grains, s, &grain);
    }
    part
}

fn contacts<S: Space>(s: &Simulation<S>, fields: &Fields<S>) -> Part {
    let mut part = empty(&fields.contacts);
    for (k, contact) in s.state.network.counted_contacts().enumerate() {
        let (a, b) = placement::ends(s, contact);
        let at = s.shapes.periodic.wrapped(a);
        part.points.extend(at.padded());
        part.points.extend((b - a + at).padded());
        part.cells.push(vec![2 * k as i64, 2 * k as i64 + 1]);
        push_fields(&mut part, &fields.contacts, s, contact);
    }
    part
}

fn bodies<S: Space>(s: &Simulation<S>) -> Part {
    let mut part = Part {
        data: vec![Vec::new(); 1],
        ..Part::default()
    };
    let shown = |body: u32| !s.state.bodies.removed[body as usize];
    for surface in s.shapes.surfaces.iter().filter(|f| shown(f.body)) {
        let b = surface.body as usize;
        for chain in surface.shape.outline() {
            let first = part.points.len() as i64 / 3;
            for p in &chain {
                let x = s.state.bodies.position[b]
                    + S::rotate(&s.state.bodies.rotation[b], &(surface.offset + *p));
                part.points.extend(x.padded());
            }
            part.cells
                .push((first..first + chain.len() as i64).collect());
            push(&mut part, &[s.state.bodies.id[b] as f64]);
        }
    }
    for piece in &s.shapes.pieces {
        for mut corners in placement::piece_outline(s, piece) {
            // Lines need an explicit closing point, polygons do not.
            if S::D == 2 {
                corners.extend(corners.first().copied());
            }
            let first = part.points.len() as i64 / 3;
            part.points
                .extend(corners.iter().flat_map(VectorLike::padded));
            part.cells
                .push((first..first + corners.len() as i64).collect());
            push(&mut part, &[s.state.bodies.id[piece.body as usize] as f64]);
        }
    }
    part
}

fn push(part: &mut Part, values: &[f64]) {
    for (column, value) in part.data.iter_mut().zip(values) {
        column.push(*value);
    }
}
