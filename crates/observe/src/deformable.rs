//! Deformable bodies: displacement and force of what holds them, and at the end of a run their mesh with displacements and stresses
//! and the tractions along what touches.

use super::observer::{Observer, RunEnd};
use super::output::Output;
use super::statistics::Column;
use fretwork_core::bodies::DeformedMesh;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use std::fmt::Write as _;

/// Kinds of cells of VTK, a triangle and a tetrahedron.
const VTK_CELLS: [u8; 2] = [5, 10];

/// The columns of all holders, `BODY_PART_x` and `BODY_PART_fx`, and files of each body.
#[derive(Clone, Debug)]
pub struct Deformable {
    holders: Vec<String>,
    bodies: Vec<String>,
}

impl Deformable {
    /// Of the dynamical systems of a simulation.
    pub fn of<S: Space>(s: &Simulation<S>) -> Self {
        let systems = || (0..s.state.systems.len()).filter_map(|k| s.state.systems.get(k));
        let named = systems().flat_map(|system| {
            let holders = system.holders().into_iter();
            holders.map(|h| format!("{}_{}_{}", system.name(), h.part, ["x", "y", "z"][h.axis]))
        });
        Self {
            holders: named.collect(),
            bodies: systems().map(|s| s.name().to_owned()).collect(),
        }
    }
}

impl<S: Space> Observer<S> for Deformable {
    fn name(&self) -> String {
        "deformable bodies".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let newton = if S::D == 2 { "N/m" } else { "N" };
        let of = |name: &String| {
            let at = name.len() - 1;
            let force = format!("{}f{}", &name[..at], &name[at..]);
            [
                Column::new(name.clone(), "m", "displacement of the held part"),
                Column::new(force, newton, "force of its holder on the part"),
            ]
        };
        self.holders.iter().flat_map(of).collect()
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let systems = (0..s.state.systems.len()).filter_map(|k| s.state.systems.get(k));
        let holders = systems.flat_map(|system| system.holders());
        holders.flat_map(|h| [h.displacement, h.force]).collect()
    }

    fn files(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let mut out = Vec::new();
        for (k, name) in self.bodies.iter().enumerate() {
            let Some(system) = end.simulation.state.systems.get(k) else {
                continue;
            };
            if let Some(mesh) = system.deformed_mesh() {
                out.push(Output::Text {
                    file: format!("{name}.vtk"),
                    text: vtk(name, &mesh),
                });
                out.push(Output::Text {
                    file: format!("{name}_tractions.csv"),
                    text: tractions(end.simulation, k),
                });
            }
        }
        out
    }

    fn file_names(&self) -> Vec<String> {
        let of = |name: &String| [format!("{name}.vtk"), format!("{name}_tractions.csv")];
        self.bodies.iter().flat_map(of).collect()
    }
}

/// The von Mises stress of a stress tensor xx, yy, zz, yz, xz, xy (Pa).
fn von_mises(stress: &[f64; 6]) -> f64 {
    let [x, y, z, yz, xz, xy] = *stress;
    let normal = (x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2);
    (0.5 * normal + 3.0 * (yz * yz + xz * xz + xy * xy)).sqrt()
}

/// A mesh as an unstructured grid in VTK's legacy text format, points where they are now.
///
/// Source: Kitware, "VTK file formats", simple legacy formats, version 3.0.
fn vtk<S: Space>(name: &str, mesh: &DeformedMesh<S>) -> String {
    let mut out = format!("# vtk DataFile Version 3.0\n{name}\nASCII\nDATASET UNSTRUCTURED_GRID\n");
    let corners = S::D + 1;
    let cells = mesh.elements.len() / corners;
    let triple = |out: &mut String, v: &S::Vector| {
        let [x, y, z] = v.padded();
        let _ = writeln!(out, "{x:e} {y:e} {z:e}");
    };
    let _ = writeln!(out, "POINTS {} double", mesh.points.len());
    for (point, displacement) in mesh.points.iter().zip(&mesh.displacement) {
        triple(&mut out, &(*point + *displacement));
    }
    let _ = writeln!(out, "CELLS {cells} {}", cells * (corners + 1));
    for element in mesh.elements.chunks_exact(corners) {
        let _ = write!(out, "{corners}");
        for point in element {
            let _ = write!(out, " {point}");
        }
        out.push('\n');
    }
    let _ = writeln!(out, "CELL_TYPES {cells}");
    for _ in 0..cells {
        let _ = writeln!(out, "{}", VTK_CELLS[S::D - 2]);
    }
    let _ = writeln!(
        out,
        "POINT_DATA {}\nVECTORS displacement double",
        mesh.points.len()
    );
    for displacement in &mesh.displacement {
        triple(&mut out, displacement);
    }
    let _ = writeln!(out, "CELL_DATA {cells}\nTENSORS stress double");
    for [x, y, z, yz, xz, xy] in &mesh.stress {
        let _ = writeln!(
            out,
            "{x:e} {xy:e} {xz:e}\n{xy:e} {y:e} {yz:e}\n{xz:e} {yz:e} {z:e}\n"
        );
    }
    let _ = writeln!(out, "SCALARS von_mises double 1\nLOOKUP_TABLE default");
    for stress in &mesh.stress {
        let _ = writeln!(out, "{:e}", von_mises(stress));
    }
    out
}

/// The contacts of a system over the last step: place, impulse over the step along the normal and along the surface, on the system,
/// and whether they slip. Along a surface that touches by its points also pressure and shear, over what each point stands for.
fn tractions<S: Space>(s: &Simulation<S>, system: usize) -> String {
    let axes = &["x", "y", "z"][..S::D];
    let newton = if S::D == 2 { "N/m" } else { "N" };
    let mut out: Vec<String> = axes.iter().map(|a| format!("{a} (m)")).collect();
    out.extend(axes.iter().map(|a| format!("force_{a} ({newton})")));
    out.extend(["normal_force", "tangential_force"].map(|n| format!("{n} ({newton})")));
    out.extend(["pressure (Pa)", "shear (Pa)", "slips"].map(str::to_owned));
    let mut out = out.join(",");
    out.push('\n');
    let bodies = &s.state.bodies;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for contact in &s.state.network.contacts {
        let side = contact.bodies.iter().position(|b| {
            let carrier = bodies.carrier(*b as usize);
            carrier.is_some_and(|c| c.system as usize == system)
        });
        let Some(side) = side.filter(|_| contact.impulse != S::Vector::zero()) else {
            continue;
        };
        let body = contact.bodies[side] as usize;
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let force = contact.impulse * (sign / s.options.scheme.h);
        let place = bodies.position[body] + contact.arms[side];
        let normal = contact.impulse.dot(&contact.normal) / s.options.scheme.h;
        let tangential = contact.impulse - contact.normal * contact.impulse.dot(&contact.normal);
        let tangential = tangential.norm() / s.options.scheme.h;
        // What a point of the surface stands for; of another contact there is none.
        let ball = s.shapes.balls.get(contact.key.candidate as usize);
        let point = ball.filter(|b| b.radius == 0.0).map(|_| match S::D {
            2 => 2.0 * contact.radius,
            _ => std::f64::consts::PI * contact.radius.powi(2),
        });
        let mut row: Vec<f64> = (0..S::D).map(|a| place[a]).collect();
        row.extend((0..S::D).map(|a| force[a]));
        row.extend([normal, tangential]);
        row.extend(point.map_or([f64::NAN; 2], |area| [normal / area, tangential / area]));
        row.push(f64::from(u8::from(contact.slides)));
        rows.push(row);
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for row in rows {
        let row: Vec<String> = row.iter().map(|x| format!("{x:e}")).collect();
        out.push_str(&row.join(","));
        out.push('\n');
    }
    out
}
