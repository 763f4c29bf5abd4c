//! Deformable bodies: displacement and force of their holders, and at the end of a run their mesh
//! with displacements and stresses and the tractions on the contact surface.

use super::chart::{Axis, Chart, Series, Style};
use super::figures::contact_map;
use super::nearest_places::NearestPlaces;
use super::output::Output;
use super::picture::{Picture, PictureContent};
use super::quantity::unit::{FORCE, ONE, RADIAN, WORD};
use super::quantity::{Findings, Role, Topic};
use super::resolution::{self, Resolution};
use super::statistics::Column;
use super::tractions::{SurfaceState, loaded, signed};
use super::warning::Warning;
use crate::observer::{Observer, RunEnd};
use fretwork_core::bodies::{DeformedMesh, Holder, von_mises};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::laws::AreaRule;
use fretwork_core::view::{RunView, SystemView};
use fretwork_scene::case::Case;
use nalgebra::Vector3;
use serde::Serialize;
use std::fmt::Write as _;

/// Kinds of cells of VTK, a triangle and a tetrahedron.
const VTK_CELLS: [u8; 2] = [5, 10];

/// Columns of all holders, `BODY_PART_x` and `BODY_PART_fx`, and files of each body.
#[derive(Clone, Debug)]
pub struct Deformable {
    holders: Vec<String>,
    bodies: Vec<String>,
    /// Largest strain and rotation of each body that assumes both to be small.
    distortions: Vec<Option<[f64; 2]>>,
    /// For each body, the largest share of a force on its border.
    borders: Vec<f64>,
    /// Number of elements across the contact of each body, and whether its material passes through
    /// the surface.
    resolutions: Vec<Resolution>,
    rolls: Vec<bool>,
    /// Contacts that act on nearest positions.
    nearest: NearestPlaces,
    /// Largest strain and rotation of deformable grains, and the names of their materials.
    grains: Option<[f64; 2]>,
    materials: Vec<String>,
}

/// Strain and rotation (rad) above which a body in small strain gets a warning. The relative error
/// of its stress is about half of the strain, here one per cent, and the error of the direction of
/// its forces is the rotation, here two per cent.
const MAX_SMALL_STRAIN: f64 = 0.02;
/// Strain and rotation (rad) above which deformable grains get a warning: most of their strain is
/// at contacts. The error of the force of a disk between two plates is less than 1.5 per cent up to
/// this strain (`tests/physics/elastic/soft_strain.rs`); rotations are relative to the frame of the
/// grain.
const MAX_SMALL_STRAIN_OF_GRAINS: f64 = 0.1;

crate::described! {
    /// Largest strain of a body in small strain.
    #[derive(Clone, Debug, Serialize)]
    pub struct SmallStrain {
        /// Name of the body; none of grains.
        pub body: Option<String> => WORD,
        /// Largest principal strain of an element, by its size, at the rows of the statistics.
        pub strain: f64 => ONE,
        /// Largest rotation of an element.
        pub rotation: f64 => RADIAN,
    }
}

impl SmallStrain {
    /// Returns a warning where strain or rotation was not small.
    pub fn warning(&self) -> Option<String> {
        let (limit, who, what, remedy) = match &self.body {
            Some(name) => (
                MAX_SMALL_STRAIN,
                format!("the body `{name}` is"),
                "its elements strain",
                "give it `strain: Corotational` for large rotations, or `strain: NeoHookean` for large strains",
            ),
            None => (
                MAX_SMALL_STRAIN_OF_GRAINS,
                "grains that deform are".to_owned(),
                "elements of one strain",
                "load them less, or give their material a larger `young`",
            ),
        };
        (self.strain.max(self.rotation) > limit).then(|| {
            format!(
                "{who} computed in small strain, and {what} by up to {:.1} % and turn by up to {:.3} rad (more than \
                 {:.0} % or {limit} rad is not small); {remedy}",
                100.0 * self.strain,
                self.rotation,
                100.0 * limit
            )
        })
    }
}

/// Share of the largest force of a cell that a cell on the border may carry.
const BORDER: f64 = 0.01;

crate::described! {
    /// Largest force on the border of the loadable part of a half-space.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub struct BorderLoad {
        /// Name of the body.
        pub body: String => WORD,
        /// Force on a cell of the border over the largest on a cell.
        pub share: f64 => ONE,
    }
}

impl BorderLoad {
    /// Returns a warning where the contact reaches the border.
    pub fn warning(&self) -> Option<String> {
        (self.share > BORDER).then(|| {
            format!(
                "the contact reaches the last cells of the half-space `{}`, which carry {:.0} % of the largest force of a cell; there are no loads \
                 beyond: let its cells extend further",
                self.body,
                100.0 * self.share
            )
        })
    }
}

impl Deformable {
    /// Observes the dynamical systems of the simulation of a case.
    pub fn of(case: &Case, run: &dyn RunView) -> Self {
        let systems = || first_bodies(run);
        let rolls = |name: &str| {
            let mut all = case.half_spaces.iter();
            all.any(|b| b.name == name && b.rolling.is_some())
        };
        let named = systems().flat_map(|system| {
            let of =
                |h: Holder| format!("{}_{}_{}", system.name(), h.part, ["x", "y", "z"][h.axis]);
            system.holders().into_iter().map(of).collect::<Vec<_>>()
        });
        Self {
            holders: named.collect(),
            bodies: systems().map(|s| s.name().to_owned()).collect(),
            distortions: systems().map(|s| s.small_strain()).collect(),
            borders: vec![0.0; systems().count()],
            resolutions: systems()
                .map(|system| Resolution::new(system.name()))
                .collect(),
            rolls: systems().map(|system| rolls(system.name())).collect(),
            nearest: NearestPlaces::default(),
            grains: strain_of_grains(run),
            materials: case
                .elastic_grains
                .iter()
                .map(|g| g.material.clone())
                .collect(),
        }
    }
}

/// Iterates over the deformable bodies other than grains; grains come last.
fn first_bodies(run: &dyn RunView) -> impl Iterator<Item = Box<dyn SystemView + '_>> {
    let systems = (0..run.system_count()).filter_map(|k| run.system(k));
    systems.take_while(|system| !system.is_grain())
}

/// Iterates over the deformable grains.
fn grains(run: &dyn RunView) -> impl Iterator<Item = Box<dyn SystemView + '_>> {
    let systems = (0..run.system_count()).filter_map(|k| run.system(k));
    systems.filter(|system| system.is_grain())
}

/// Returns the largest strain and rotation in deformable grains.
fn strain_of_grains(run: &dyn RunView) -> Option<[f64; 2]> {
    let all = grains(run).filter_map(|s| s.small_strain());
    all.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
}

/// Returns the larger of two values for strain and for rotation.
fn larger(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let (a, b) = (a?, b?);
    Some([a[0].max(b[0]), a[1].max(b[1])])
}

impl Deformable {
    /// Returns the largest strains of bodies in small strain, and loads on borders, including those
    /// of the current state.
    fn distortions(&self, run: &dyn RunView) -> (Vec<SmallStrain>, Vec<BorderLoad>) {
        let (mut strains, mut borders) = (Vec::new(), Vec::new());
        for (k, name) in self.bodies.iter().enumerate() {
            let system = run.system(k);
            let now = system.as_ref().and_then(|s| s.small_strain());
            if let Some([strain, rotation]) = larger(self.distortions[k], now) {
                strains.push(SmallStrain {
                    body: Some(name.clone()),
                    strain,
                    rotation,
                });
            }
            let now = system.as_ref().and_then(|s| s.load_at_border());
            if let Some(share) = now.map(|share| share.max(self.borders[k])) {
                borders.push(BorderLoad {
                    body: name.clone(),
                    share,
                });
            }
        }
        if let Some([strain, rotation]) = larger(self.grains, strain_of_grains(run)) {
            strains.push(SmallStrain {
                body: None,
                strain,
                rotation,
            });
        }
        (strains, borders)
    }
}

impl Observer for Deformable {
    fn name(&self) -> String {
        "deformable bodies".to_owned()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let flat = end.simulation.dimension() == 2;
        let mut charts = Vec::new();
        for (k, name) in self.bodies.iter().enumerate().filter(|_| flat) {
            charts.push(traction_chart(end.simulation, k, name));
        }
        for name in &self.holders {
            let (x, y) = (Axis::of_rows("displacement"), Axis::of_rows("force"));
            let title = format!("Force of the holder against displacement, {name}");
            let series = Series::rows("", name, force(name));
            charts.push(Chart::new(title, x, y).with(series));
        }
        let mut out = vec![Output::leading("deformable", charts, 2)];
        for (k, name) in self.bodies.iter().enumerate().filter(|_| !flat) {
            if let Some(state) = SurfaceState::of(end.simulation, k) {
                let maps = contact_map::charts(name, &state, has_tractions(end.simulation, k));
                out.push(Output::leading(format!("{name}_slip"), maps, 2));
            }
        }
        out
    }

    fn columns(&self) -> Vec<Column> {
        let of = |name: &String| {
            [
                Column::new(name.clone(), "m", "displacement of the held part"),
                Column::new(force(name), FORCE, "force of its holder on the part"),
            ]
        };
        self.holders.iter().flat_map(of).collect()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let systems = || first_bodies(run);
        self.nearest = self.nearest.and(NearestPlaces::of(run));
        self.grains = larger(self.grains, strain_of_grains(run));
        for (most, system) in self.distortions.iter_mut().zip(systems()) {
            *most = larger(*most, system.small_strain());
        }
        for (k, resolution) in self.resolutions.iter_mut().enumerate() {
            resolution.add(run, k, &self.rolls, run.energies().friction);
        }
        for (most, system) in self.borders.iter_mut().zip(systems()) {
            *most = system.load_at_border().unwrap_or(0.0).max(*most);
        }
        let holders = systems().flat_map(|system| system.holders());
        holders.flat_map(|h| [h.displacement, h.force]).collect()
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        if run.dimension() == 2 {
            return vec![Picture {
                name: "stress",
                shows: PictureContent::Stress,
            }];
        }
        let systems = self.bodies.iter().enumerate();
        // The maps show stick and slip, and the pressure.
        let maps = systems.flat_map(|(k, name)| {
            let state = SurfaceState::of(run, k);
            let maps = state.map(|state| contact_map::charts(name, &state, has_tractions(run, k)));
            maps.into_iter().flatten().take(2)
        });
        vec![Picture {
            name: "slip",
            shows: PictureContent::Charts(maps.collect()),
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec!["stress", "slip"]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        found.begin(Topic::Run, Role::Diagnostic);
        let (strains, borders) = self.distortions(end.simulation);
        if !strains.is_empty() {
            found.parts::<SmallStrain>("small_strain", &strains, "");
        }
        if !borders.is_empty() {
            found.parts::<BorderLoad>("border_loads", &borders, "");
        }
        let strains = strains.iter().filter_map(SmallStrain::warning);
        found.warn(strains.map(|text| Warning::serious("NOT SMALL STRAIN", text)));
        let borders = borders.iter().filter_map(BorderLoad::warning);
        found.warn(borders.map(|text| Warning::serious("LOAD AT BORDER", text)));
        let touch = self.resolutions.iter().filter(|r| r.across > 0.0);
        resolution::report(touch.cloned().collect(), found);
        if self.nearest.contacts > 0 {
            found.part("nearest_places", &self.nearest, "");
            let text = self.nearest.warning();
            found.warn(text.map(|text| Warning::note("NEAREST PLACES", text)));
        }
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        let nearest = self.nearest.state();
        let resolutions: Vec<_> = self.resolutions.iter().map(Resolution::state).collect();
        let kept = (&self.distortions, &self.borders, self.grains, nearest);
        encode(&(kept, resolutions))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        let (nearest, resolutions): (_, Vec<resolution::ResolutionState>);
        (
            (self.distortions, self.borders, self.grains, nearest),
            resolutions,
        ) = decode(from)?;
        for (own, state) in self.resolutions.iter_mut().zip(resolutions) {
            own.restore(state);
        }
        self.nearest = NearestPlaces::from_state(nearest);
        Ok(())
    }

    fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let dimension = end.simulation.dimension();
        let mut out = Vec::new();
        for (k, name) in self.bodies.iter().enumerate() {
            let Some(system) = end.simulation.system(k) else {
                continue;
            };
            if let Some(mesh) = system.deformed_mesh() {
                out.push(Output::Text {
                    file: format!("{name}.vtk"),
                    text: vtk(name, &mesh, dimension),
                });
            }
            out.push(Output::Text {
                file: format!("{name}_tractions.csv"),
                text: traction_table(end.simulation, k),
            });
        }
        if self.grains.is_some() {
            out.push(Output::Text {
                file: GRAINS.to_owned(),
                text: vtk("grains", &all_grains(end.simulation), dimension),
            });
        }
        out
    }

    fn file_names(&self) -> Vec<String> {
        // The program creates links to the results; without these names they would remain after the
        // bodies.
        let of = |name: &String| {
            [
                format!("{name}.vtk"),
                format!("{name}_tractions.csv"),
                format!("{name}_slip.png"),
                format!("mesh_{name}.vtkhdf"),
                format!("surface_{name}.vtkhdf"),
            ]
        };
        let grains = self.grains.map(|_| GRAINS.to_owned());
        let figure = ["deformable.png".to_owned()];
        let links = self.materials.iter();
        let links = links.map(|name| format!("elastic_grains_{name}.vtkhdf"));
        let of_bodies = self.bodies.iter().flat_map(of);
        of_bodies.chain(grains).chain(links).chain(figure).collect()
    }
}

/// File of the meshes of grains.
const GRAINS: &str = "elastic_grains.vtk";

/// Returns the meshes of all deformable grains as one mesh.
fn all_grains(run: &dyn RunView) -> DeformedMesh<Vector3<f64>> {
    let mut out = DeformedMesh::default();
    for mesh in grains(run).filter_map(|s| s.deformed_mesh()) {
        let first = out.points.len() as u32;
        out.points.extend(mesh.points);
        out.displacement.extend(mesh.displacement);
        out.elements.extend(mesh.elements.iter().map(|p| first + p));
        out.boundary.extend(mesh.boundary.iter().map(|p| first + p));
        out.stress.extend(mesh.stress);
    }
    out
}

/// Returns the name of the column of the force of a holder, from that of its displacement.
fn force(name: &str) -> String {
    let axis = name.len() - 1;
    format!("{}f{}", &name[..axis], &name[axis..])
}

/// Returns a mesh as an unstructured grid in VTK's legacy text format, with the current positions
/// of points.
///
/// Source: Kitware, "VTK file formats", simple legacy formats, version 3.0.
fn vtk(name: &str, mesh: &DeformedMesh<Vector3<f64>>, dimension: usize) -> String {
    let mut out = format!("# vtk DataFile Version 3.0\n{name}\nASCII\nDATASET UNSTRUCTURED_GRID\n");
    let corners = dimension + 1;
    let cells = mesh.elements.len() / corners;
    let triple = |out: &mut String, v: &Vector3<f64>| {
        let [x, y, z] = (*v).into();
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
        let _ = writeln!(out, "{}", VTK_CELLS[dimension - 2]);
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

/// A contact of a deformable body over the last step.
#[derive(Clone, Copy, Debug)]
struct Traction {
    /// Position (m).
    place: Vector3<f64>,
    /// Force on the body (N; N/m in 2D).
    force: Vector3<f64>,
    /// Part of the force along the normal, positive in compression, and along the surface: in the
    /// plane positive along +x.
    parts: [f64; 2],
    /// Tributary length (m) or area (m^2) of the point of the surface; `None` where unknown.
    area: Option<f64>,
    slips: bool,
}

/// The loaded contacts of a system, along x.
fn tractions(run: &dyn RunView, system: usize) -> Vec<Traction> {
    let (bodies, balls) = (run.bodies(), run.balls());
    let even = has_tractions(run, system);
    let mut out: Vec<Traction> = Vec::new();
    for acting in loaded(run, system) {
        let (contact, side) = (acting.contact, acting.side);
        let point = contact.key.ball().and_then(|k| balls.get(k));
        let point = point.filter(|ball| ball.radius == 0.0 && side == 0);
        out.push(Traction {
            place: Vector3::from(bodies.position.at(contact.bodies[side] as usize))
                + Vector3::from(contact.arms[side]),
            force: acting.force,
            parts: [acting.normal, signed(run.dimension(), &acting.along)],
            area: point
                .filter(|_| even)
                .map(|_| AreaRule::default().area(run.dimension(), contact.radius)),
            slips: contact.slides,
        });
    }
    out.sort_by(|a, b| a.place[0].total_cmp(&b.place[0]));
    out
}

/// Returns whether forces of points over their tributary areas are tractions. (In space the points
/// of a block have alternately more and fewer elements.)
fn has_tractions(run: &dyn RunView, system: usize) -> bool {
    let system = run.system(system);
    run.dimension() == 2 || system.is_some_and(|s| s.has_equal_points())
}

/// Returns the contacts of a system as a table, with pressure and shear where a surface touches by
/// its points.
fn traction_table(run: &dyn RunView, system: usize) -> String {
    let axes = &["x", "y", "z"][..run.dimension()];
    let newton = FORCE.symbol(run.dimension());
    let mut out: Vec<String> = axes.iter().map(|a| format!("{a} [m]")).collect();
    out.extend(axes.iter().map(|a| format!("force_{a} [{newton}]")));
    out.extend(["normal_force", "tangential_force"].map(|n| format!("{n} [{newton}]")));
    let even = has_tractions(run, system);
    if even {
        out.extend(["pressure [Pa]", "shear [Pa]"].map(str::to_owned));
    }
    out.push("slips".to_owned());
    let mut out = out.join(",");
    out.push('\n');
    for traction in tractions(run, system) {
        let mut row: Vec<f64> = (0..run.dimension()).map(|a| traction.place[a]).collect();
        row.extend((0..run.dimension()).map(|a| traction.force[a]));
        row.extend(traction.parts);
        if even {
            row.extend(match traction.area {
                Some(area) => traction.parts.map(|f| f / area),
                None => [f64::NAN; 2],
            });
        }
        let row: Vec<String> = row.iter().map(|x| format!("{x:e}")).collect();
        let _ = writeln!(out, "{},{}", row.join(","), u8::from(traction.slips));
    }
    out
}

/// Returns a chart of pressure and shear along a surface that touches by points (2D), and of its
/// slip.
fn traction_chart(run: &dyn RunView, system: usize, name: &str) -> Chart {
    let along = Axis::new("position x", "m");
    let mut chart = Chart::new(
        format!("Tractions along {name}"),
        along,
        Axis::new("traction", "Pa"),
    );
    let found = tractions(run, system);
    let curve = |which: usize, slipping: bool| {
        let at = |t: &Traction| {
            let shown = !slipping || t.slips;
            let value = t.parts[which] / t.area?;
            shown.then_some((t.place[0], value))
        };
        found.iter().filter_map(at).collect()
    };
    chart = chart
        .with(Series::new("pressure p", curve(0, false)))
        .with(Series::new("shear traction q", curve(1, false)))
        .with(Series::new("q where it slips", curve(1, true)).style(Style::Markers));
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_that_strain_or_are_loaded_at_their_border_are_told() {
        let strained = |body: &str, strain, rotation| SmallStrain {
            body: Some(body.to_owned()),
            strain,
            rotation,
        };
        let text = strained("bent", 1e-3, 0.3).warning().unwrap();
        assert!(text.contains("`bent`") && text.contains("strain: Corotational"));
        assert_eq!(strained("stiff", 1e-3, 1e-3).warning(), None);
        let loaded = |share| BorderLoad {
            body: "wide".to_owned(),
            share,
        };
        assert!(loaded(0.5).warning().unwrap().contains("`wide`"));
        assert_eq!(loaded(1e-3).warning(), None);
    }
}
