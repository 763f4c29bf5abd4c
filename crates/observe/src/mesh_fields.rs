//! Fields of deformable bodies in `results.h5`, each registered once with its name, unit and a line
//! of explanation: inside a body of finite elements, and on the contact surface of every deformable
//! body.

use super::tractions::{ContactZone, SurfaceState, signed};
use fretwork_core::bodies::{DeformedMesh, von_mises};
use fretwork_core::unit::AREA;
use fretwork_core::view::{RunView, SystemView};
use nalgebra::Vector3;

/// Location of the values of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldLocation {
    /// Points of the mesh.
    Points,
    /// Elements of the mesh.
    Cells,
}

/// A field on a mesh; `T` is the source of its values.
#[derive(Clone, Copy, Debug)]
pub struct MeshField<T> {
    /// Name: a-z, 0-9 and _.
    pub name: &'static str,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// Explanation in one line.
    pub doc: &'static str,
    /// Location of the values: points or elements.
    pub at: FieldLocation,
    /// Number of components per value.
    pub width: usize,
    /// Function that returns all values, one after the other.
    pub values: fn(&T) -> Vec<f64>,
}

/// Current state of a body with a mesh.
#[derive(Clone, Debug)]
pub struct BodyState {
    mesh: DeformedMesh<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
}

impl BodyState {
    /// Returns mesh and velocities of a system; `None` if it has no mesh.
    pub fn of(system: &dyn SystemView) -> Option<Self> {
        let mesh = system.deformed_mesh()?;
        let mut velocity = system.mesh_velocity();
        velocity.resize(mesh.points.len(), Vector3::zeros());
        Some(Self { mesh, velocity })
    }

    /// The deformed mesh.
    pub fn mesh(&self) -> &DeformedMesh<Vector3<f64>> {
        &self.mesh
    }
}

/// The current state of several deformable grains, joined to one mesh.
#[derive(Clone, Debug, Default)]
pub struct GrainsState {
    mesh: DeformedMesh<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    /// Points at the start of the run, without load (m).
    start: Vec<Vector3<f64>>,
    /// Displacement of each point since the start of the run (m).
    travel: Vec<Vector3<f64>>,
    /// Identity of the body of each point, and of each element.
    bodies: [Vec<i64>; 2],
}

impl GrainsState {
    /// Joins the systems with these indices, without those that have no mesh. Grains that have left
    /// the periodic cell are shown at their image inside it.
    pub fn of(run: &dyn RunView, systems: &[usize]) -> Self {
        let mut out = Self::default();
        for k in systems {
            let (Some(system), [body, ..]) = (run.system(*k), run.bodies_of_system(*k)) else {
                continue;
            };
            let (Some(mesh), at) = (
                system.deformed_mesh(),
                Vector3::from(run.bodies().position.at(*body as usize)),
            ) else {
                continue;
            };
            let shift = run.periodic().wrapped(at) - at;
            let (start, now) = (system.mesh_at_start(), &mesh.points);
            let moved = now.iter().zip(&mesh.displacement).zip(&start);
            out.travel
                .extend(moved.map(|((x, u), start)| *x + shift + *u - *start));
            out.start.extend(start);
            out.velocity.extend(system.mesh_velocity());
            let first = out.mesh.points.len() as u32;
            let id = run.bodies().id[*body as usize] as i64;
            let cells = mesh.elements.len() / (run.dimension() + 1);
            for (ids, count) in out.bodies.iter_mut().zip([mesh.points.len(), cells]) {
                ids.resize(ids.len() + count, id);
            }
            let elements = mesh.elements.iter().map(|p| first + p);
            out.mesh.elements.extend(elements);
            out.mesh.points.extend(mesh.points);
            out.mesh.displacement.extend(mesh.displacement);
            out.mesh.stress.extend(mesh.stress);
        }
        out
    }

    /// Returns the points at the start of the run, without load (m).
    pub fn start(&self) -> &[Vector3<f64>] {
        &self.start
    }

    /// Returns the D + 1 points of each element, one after the other.
    pub fn elements(&self) -> &[u32] {
        &self.mesh.elements
    }

    /// Returns the identities of the bodies, by point and by element.
    pub fn bodies(&self) -> &[Vec<i64>; 2] {
        &self.bodies
    }
}

/// Returns the components of vectors, three numbers per vector.
pub fn triples(vectors: &[Vector3<f64>]) -> Vec<f64> {
    vectors.iter().flatten().copied().collect()
}

/// A deformable mesh, with the velocities of its points.
trait Meshed {
    fn mesh(&self) -> &DeformedMesh<Vector3<f64>>;
    fn velocity(&self) -> &[Vector3<f64>];
}

impl Meshed for BodyState {
    fn mesh(&self) -> &DeformedMesh<Vector3<f64>> {
        &self.mesh
    }
    fn velocity(&self) -> &[Vector3<f64>] {
        &self.velocity
    }
}

impl Meshed for GrainsState {
    fn mesh(&self) -> &DeformedMesh<Vector3<f64>> {
        &self.mesh
    }
    fn velocity(&self) -> &[Vector3<f64>] {
        &self.velocity
    }
}

/// Returns the fields that bodies of finite elements and deformable grains have in common.
fn of_meshes<T: Meshed>() -> [MeshField<T>; 3] {
    [
        MeshField {
            name: "velocity",
            unit: "m/s",
            doc: "velocity",
            at: FieldLocation::Points,
            width: 3,
            values: |b| triples(b.velocity()),
        },
        MeshField {
            name: "stress",
            unit: "Pa",
            doc: STRESS,
            at: FieldLocation::Cells,
            width: 6,
            values: |b| in_vtk_order(&b.mesh().stress),
        },
        MeshField {
            name: "von_mises",
            unit: "Pa",
            doc: "von Mises stress",
            at: FieldLocation::Cells,
            width: 1,
            values: |b| b.mesh().stress.iter().map(von_mises).collect(),
        },
    ]
}

/// Returns the fields inside a body of finite elements.
pub fn of_bodies() -> [MeshField<BodyState>; 4] {
    let [velocity, stress, von_mises] = of_meshes();
    let displacement = MeshField {
        name: "displacement",
        unit: "m",
        doc: "displacement from the place without load",
        at: FieldLocation::Points,
        width: 3,
        values: |b: &BodyState| triples(&b.mesh.displacement),
    };
    [displacement, velocity, stress, von_mises]
}

/// Returns the fields inside deformable grains.
pub fn of_grains() -> [MeshField<GrainsState>; 5] {
    let [velocity, stress, von_mises] = of_meshes();
    let displacement = MeshField {
        name: "displacement",
        unit: "m",
        doc: "way of the point since the start of the run, with the motion of the grain",
        at: FieldLocation::Points,
        width: 3,
        values: |g: &GrainsState| triples(&g.travel),
    };
    let deformation = MeshField {
        name: "deformation",
        unit: "m",
        doc: "displacement of the point against the frame that moves with the grain, in world axes",
        at: FieldLocation::Points,
        width: 3,
        values: |g: &GrainsState| triples(&g.mesh.displacement),
    };
    [displacement, deformation, velocity, stress, von_mises]
}

/// Explanation of the field of stress: the order of its components.
const STRESS: &str =
    "stress (Cauchy): XX, YY, ZZ, XY, YZ, XZ; in plane strain ZZ is along the depth";

/// Reorders stresses xx, yy, zz, yz, xz, xy (Pa) to VTK's order xx, yy, zz, xy, yz, xz.
fn in_vtk_order(stress: &[[f64; 6]]) -> Vec<f64> {
    let order = |[xx, yy, zz, yz, xz, xy]: &[f64; 6]| [*xx, *yy, *zz, *xy, *yz, *xz];
    stress.iter().flat_map(order).collect()
}

/// Returns the fields on a contact surface.
pub fn of_surfaces(dimension: usize) -> [MeshField<SurfaceState>; 8] {
    [
        MeshField {
            name: "displacement",
            unit: "m",
            doc: "displacement from the place without load",
            at: FieldLocation::Points,
            width: 3,
            values: |s| triples(&s.displacement),
        },
        MeshField {
            name: "traction",
            unit: "Pa",
            doc: "force of contacts on the body over the area of the point",
            at: FieldLocation::Points,
            width: 3,
            values: |s| triples(&s.traction),
        },
        MeshField {
            name: "pressure",
            unit: "Pa",
            doc: "part of the traction along the normals of contacts, positive in compression",
            at: FieldLocation::Points,
            width: 1,
            values: |s| s.pressure.clone(),
        },
        MeshField {
            name: "shear",
            unit: "Pa",
            doc: "part of the traction along the surface; in 2D positive along +x",
            at: FieldLocation::Points,
            width: 1,
            values: |s| s.shear.clone(),
        },
        MeshField {
            name: "area",
            unit: AREA.symbol(dimension),
            doc: "area (length in 2D) that the point stands for: pressure times area sums up to the force",
            at: FieldLocation::Points,
            width: 1,
            values: |s| s.surface.areas.clone(),
        },
        MeshField {
            name: "status",
            unit: "",
            doc: "0 no force (less than a tenth of that of one contact), 1 stick, 2 slip",
            at: FieldLocation::Points,
            width: 1,
            values: |s| s.zone.iter().copied().map(ContactZone::status).collect(),
        },
        MeshField {
            name: "facet_pressure",
            unit: "Pa",
            doc: "mean of the pressure of the points of each facet",
            at: FieldLocation::Cells,
            width: 1,
            values: |s| s.facets().iter().map(|f| f.pressure).collect(),
        },
        MeshField {
            name: "facet_shear",
            unit: "Pa",
            doc: "size of the mean traction along the surface of the points of each facet; in 2D positive along +x",
            at: FieldLocation::Cells,
            width: 1,
            values: |s| {
                s.facets()
                    .iter()
                    .map(|f| signed(s.dimension, &f.tangential))
                    .collect()
            },
        },
    ]
}
