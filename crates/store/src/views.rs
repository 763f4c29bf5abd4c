//! Converts the state of a simulation to the views of `results.h5`.

use super::results::state::ORIENTATION;
use super::results::{Header, Part, Results, ResultsError};
use super::shapes;
use super::summary::Summary;
use fretwork_core::contact::detect::centre;
use fretwork_core::geometry::convex::Core;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_observe::placement::{self, BondState};
use fretwork_observe::statistics::Column;
use fretwork_scene::build::Loaded;

/// References to the built scene.
#[derive(Debug)]
pub struct Made<'a, S: Space> {
    /// The simulation.
    pub simulation: &'a Simulation<S>,
    /// Material files: name and text.
    pub materials: &'a [(String, String)],
    /// Densities of the materials (kg/m^3).
    pub densities: &'a [f64],
}

/// Contents of the file before the first step.
pub fn header<S: Space>(
    loaded: &Loaded,
    built: &Made<'_, S>,
    summary: &Summary,
    statistics: &[Column],
) -> Header {
    let dimension = S::D;
    let c = Column::new;
    let axes = ["spin_x", "spin_y", "spin_z"].map(|name| c(name, "rad/s", "angular velocity"));
    let axes = if dimension == 2 { &[][..] } else { &axes };
    let turns = match (shapes::needed(built.simulation), dimension) {
        (false, _) => Vec::new(),
        (true, 2) => vec![c("angle", "rad", "orientation")],
        (true, _) => ORIENTATION
            .map(|name| c(name, "", "orientation, a unit quaternion"))
            .to_vec(),
    };
    let gone = loaded.case.circuit.iter();
    let gone = gone.map(|_| c("gone", "", "1 for grains that were removed"));
    let shear = loaded.case.output.shear.map(|_| {
        let doc =
            "local shear since the start of the second phase, or of the run; NaN on first bodies";
        c("shear", "", doc)
    });
    let joule = if dimension == 2 { "J/m" } else { "J" };
    let area = if dimension == 2 { "m" } else { "m^2" };
    let kg = if dimension == 2 { "kg/m" } else { "kg" };
    let at = ["x", "y", "z"].map(|a| c(a, "m", "position"));
    let bonds = loaded.case.interfaces.iter().any(|i| i.cohesion.is_some());
    let broken = [
        c("id", "", "number of the break, from 1"),
        c("time", "s", "end of the step in which it broke"),
        c("body_1", "", "identity of the candidate"),
        c("body_2", "", "identity of the antagonist"),
        c("interface", "", "index of the interface"),
    ];
    let broken = broken.into_iter().chain(at.clone()).chain([
        c(
            "mode_mix",
            "",
            "fraction of sliding in the work of opening and sliding: 0 mode I, 1 mode II",
        ),
        c("opening_normal", "m", "elongation at the end"),
        c("opening_tangential", "m", "norm of the tangential opening"),
        c("area", area, "area of the bond"),
        c("work", joule, "work done on the bond since it formed"),
        c("fracture", joule, "energy released by damage"),
        c("viscous", joule, "dissipated by its damping"),
        c(
            "friction",
            joule,
            "dissipated by friction at the contact while it was intact",
        ),
        c(
            "cause",
            "",
            "0 damage, 1 its bodies moved out of range or one was removed",
        ),
    ]);
    let debris = [
        c("id", "", "number of the piece, from 1"),
        c("time", "s", "time at which the account found it loose"),
        c("size", "", "grains in it"),
        c("mass", kg, "its mass"),
    ];
    let debris = debris.into_iter().chain(at).chain([
        c("first_body", "", "identity of the first body that lost it"),
        c(
            "mode_mix",
            "",
            "fraction of sliding in the work on the bonds that freed it",
        ),
        c("energy", joule, "energy released by damage of these bonds"),
        c("bonds", "", "number of these bonds"),
    ]);
    Header {
        broken: if bonds { broken.collect() } else { Vec::new() },
        debris: match loaded.case.circuit {
            Some(_) => debris.collect(),
            None => Vec::new(),
        },
        case_name: loaded.case.name.clone(),
        case_text: loaded.source.text().to_owned(),
        materials: built.materials.to_vec(),
        plugins: summary.plugins.clone(),
        seed: loaded.case.seed,
        dimension,
        shapes: shapes::of(built.simulation, built.densities),
        version: summary.version.clone(),
        statistics: statistics.to_vec(),
        fields: [
            [
                c("id", "", "identity of the body"),
                c(
                    "radius",
                    "m",
                    "radius; of other shapes that of the ball (2D: disk) of the same volume",
                ),
                c("material", "", "index of the material"),
                c("first_body", "", "1 for parts of a first body"),
                c("velocity_x", "m/s", "velocity"),
                c("velocity_y", "m/s", "velocity"),
                c("velocity_z", "m/s", "velocity"),
                c("spin", "rad/s", "angular velocity, its norm in 3D"),
                c(
                    "corners",
                    "",
                    "corners of a polygon or polyhedron, 2 of a capsule, 0 for a ball",
                ),
            ]
            .into_iter()
            .chain(axes.iter().cloned())
            .chain(turns)
            .chain(gone)
            .chain(shear)
            .collect(),
            contact_columns(dimension),
            vec![c("body", "", "identity of the body")],
        ],
        numbers: [Vec::new(), contact_numbers(), Vec::new()],
    }
}

/// Float fields of contacts.
fn contact_columns(dimension: usize) -> Vec<Column> {
    let c = Column::new;
    let newton = if dimension == 2 { "N/m" } else { "N" };
    let joule = if dimension == 2 { "J/m" } else { "J" };
    let mut columns = vec![
        c("state", "", "0 contact, 1 intact bond, 2 broken bond"),
        c(
            "status",
            "",
            "0 no force, 1 stick, 2 slip (at the friction bound), 3 intact bond, 4 no force and broken bond",
        ),
        c("damage", "", "damage D; 1 where there is no bond"),
        c("gap", "m", "gap"),
        c(
            "force_normal",
            newton,
            "normal force, positive in compression",
        ),
        c("force_tangential", newton, "norm of the tangential force"),
        c(
            "force_tangential_1",
            newton,
            "tangential force on body_1 along the tangent t1; in 2D t1 is the normal rotated by +90 degrees",
        ),
    ];
    if dimension == 3 {
        columns.push(c(
            "force_tangential_2",
            newton,
            "tangential force on body_1 along t2 = normal x t1",
        ));
    }
    let normal = ["normal_x", "normal_y", "normal_z"];
    let normal = normal.map(|name| {
        c(
            name,
            "",
            "unit normal, from body_2 to body_1; a positive normal force pushes body_1 along it",
        )
    });
    columns.extend(normal.into_iter().take(dimension));
    if dimension == 3 {
        let tangent = ["tangent_1_x", "tangent_1_y", "tangent_1_z"];
        columns.extend(tangent.map(|name| c(name, "", "unit tangent t1")));
    }
    columns.extend([
        c(
            "friction_work",
            joule,
            "work of friction at this contact since it formed",
        ),
        c("opening_normal", "m", "elongation of the bond"),
        c("opening_tangential", "m", "norm of its tangential opening"),
        c("law", "", "index of the interface"),
    ]);
    columns
}

/// Integer fields of contacts.
fn contact_numbers() -> Vec<Column> {
    let c = Column::new;
    vec![
        c(
            "body_1",
            "",
            "identity of the candidate, as `id` of grains and `body` of bodies",
        ),
        c("body_2", "", "identity of the antagonist"),
    ]
}

/// Bytes per grain and per contact of a recorded state: points, cells and fields of 8 bytes.
pub fn bytes<S: Space>(s: &Simulation<S>, circuit: bool) -> [usize; 2] {
    let (plain, turns) = if S::D == 2 { (9, 1) } else { (12, 4) };
    let turns = if shapes::needed(s) { turns } else { 0 };
    let fields = plain + turns + usize::from(circuit);
    let contact = contact_columns(S::D).len() + contact_numbers().len();
    [8 * (3 + 2 + fields), 8 * (6 + 3 + contact)]
}

/// Appends the current state; `shear` is a column of the grains if the header has it.
///
/// # Errors
/// The file cannot be written.
pub fn append<S: Space>(
    results: &mut Results,
    s: &Simulation<S>,
    loaded: &Loaded,
    shear: Option<Vec<f64>>,
) -> Result<(), ResultsError> {
    let mut grains = grains(s);
    let balls = s.shapes.balls.iter().map(|b| b.body as usize);
    let pieces = s.shapes.pieces.iter().map(|p| p.body as usize);
    let of: Vec<usize> = balls.chain(pieces).collect();
    if shapes::needed(s) {
        for k in 0..if S::D == 2 { 1 } else { 4 } {
            let turns = of
                .iter()
                .map(|b| S::rotation_numbers(&s.bodies.rotation[*b])[k]);
            grains.data.push(turns.collect());
        }
    }
    if loaded.case.circuit.is_some() {
        let gone = of.iter().map(|b| f64::from(u8::from(s.bodies.removed[*b])));
        grains.data.push(gone.collect());
    }
    grains.data.extend(shear);
    results.append_views(s.time, &[grains, contacts(s), bodies(s)])
}

fn grains<S: Space>(s: &Simulation<S>) -> Part {
    let axes = if S::D == 2 { 0 } else { 3 };
    let mut part = Part {
        data: vec![Vec::new(); 9 + axes],
        ..Part::default()
    };
    for ball in &s.shapes.balls {
        let at = centre(ball, &s.bodies);
        grain(
            s,
            &mut part,
            at,
            [ball.body, ball.material.into(), 0],
            ball.radius,
        );
    }
    for piece in &s.shapes.pieces {
        let at = placement::piece_centre(s, piece);
        let corners = piece.core.boundary().corners.len() as u32;
        let of = [piece.body, piece.material.into(), corners];
        grain(s, &mut part, at, of, piece.size);
    }
    part
}

/// Adds one ball, polygon or polyhedron: position, body, material, number of corners, radius (m).
fn grain<S: Space>(s: &Simulation<S>, part: &mut Part, at: S::Vector, of: [u32; 3], radius: f64) {
    let [body, material, corners] = of;
    let b = body as usize;
    part.cells.push(vec![part.points.len() as i64 / 3]);
    part.points.extend(s.shapes.periodic.wrapped(at).padded());
    let first = s.bodies.driven.iter().any(|d| d.body == body);
    let v = s.bodies.velocity[b].padded();
    let spin = if S::D == 2 {
        s.bodies.spin[b][0]
    } else {
        s.bodies.spin[b].norm()
    };
    let values = [
        s.bodies.id[b] as f64,
        radius,
        f64::from(material),
        f64::from(u8::from(first)),
        v[0],
        v[1],
        v[2],
        spin,
        f64::from(corners),
    ];
    push(part, &values);
    for (column, value) in part.data[9..].iter_mut().zip(s.bodies.spin[b].padded()) {
        column.push(value);
    }
}

fn contacts<S: Space>(s: &Simulation<S>) -> Part {
    let mut part = Part {
        data: vec![Vec::new(); contact_columns(S::D).len()],
        numbers: vec![Vec::new(); contact_numbers().len()],
        ..Part::default()
    };
    for (k, contact) in s.network.counted_contacts().enumerate() {
        let (a, b) = placement::ends(s, contact);
        let at = s.shapes.periodic.wrapped(a);
        part.points.extend(at.padded());
        part.points.extend((b - a + at).padded());
        part.cells.push(vec![2 * k as i64, 2 * k as i64 + 1]);
        let (state, damage) = match placement::bond_state(s, contact) {
            BondState::Intact { damage } => (1.0, damage),
            BondState::Broken => (2.0, 1.0),
            BondState::None => (0.0, 1.0),
        };
        let n = &contact.normal;
        let force = contact.impulse * (1.0 / s.scheme.h);
        let bond = s.network.bond(contact);
        let status = if state == 1.0 {
            3.0
        } else if contact.impulse == S::Vector::zero() {
            2.0 * state
        } else {
            1.0 + f64::from(u8::from(contact.slides))
        };
        let mut values = vec![
            state,
            status,
            damage,
            contact.gap,
            n.dot(&force),
            S::tangential(n, &force).norm(),
        ];
        let tangents = S::tangents(n);
        let along = tangents.iter().map(|t| t.dot(&force));
        values.extend(along.take(S::D - 1));
        values.extend((0..S::D).map(|k| n[k]));
        if S::D == 3 {
            values.extend(tangents[0].padded());
        }
        values.extend([
            contact.friction_work,
            bond.map_or(0.0, |b| b.opening_n),
            bond.map_or(0.0, |b| b.opening_t.norm()),
            f64::from(contact.law),
        ]);
        push(&mut part, &values);
        for (column, body) in part.numbers.iter_mut().zip(contact.bodies) {
            column.push(s.bodies.id[body as usize] as i64);
        }
    }
    part
}

fn bodies<S: Space>(s: &Simulation<S>) -> Part {
    let mut part = Part {
        data: vec![Vec::new(); 1],
        ..Part::default()
    };
    let shown = |body: u32| !s.bodies.removed[body as usize];
    for surface in s.shapes.surfaces.iter().filter(|f| shown(f.body)) {
        let b = surface.body as usize;
        for chain in surface.shape.outline() {
            let first = part.points.len() as i64 / 3;
            for p in &chain {
                let x =
                    s.bodies.position[b] + S::rotate(&s.bodies.rotation[b], &(surface.offset + *p));
                part.points.extend(x.padded());
            }
            part.cells
                .push((first..first + chain.len() as i64).collect());
            push(&mut part, &[s.bodies.id[b] as f64]);
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
            push(&mut part, &[s.bodies.id[piece.body as usize] as f64]);
        }
    }
    part
}

fn push(part: &mut Part, values: &[f64]) {
    for (column, value) in part.data.iter_mut().zip(values) {
        column.push(*value);
    }
}
