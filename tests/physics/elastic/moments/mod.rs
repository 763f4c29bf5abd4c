//! Laws that resist rotation on deformable first bodies: a contactor rotates as its facet does, and
//! a half-space does not rotate.

mod bonds;
mod compliance;
mod free;
mod rolling;

use super::*;
use fretwork::elastic::half_space::{
    CellGrid, Cells, FilledSide, HalfSpace, HalfSpaceSpec, Profile, Reach,
};

const G: f64 = 9.81;
/// Radius of the disks and spheres, of 1000 kg/m^3 (m).
const R: f64 = 0.01;

/// A case with grains of radius R with positions, velocities and spins, and a plane far below.
struct Rolling {
    step: f64,
    theta: f64,
    contact: &'static str,
    of_contact: String,
    interface: &'static str,
    parameters: String,
    mu: f64,
    /// Gravity (m/s^2), downwards.
    gravity: f64,
    grains: String,
    tolerance: f64,
}

impl Default for Rolling {
    fn default() -> Self {
        Self {
            step: 1e-4,
            theta: 1.0,
            contact: "rolling-friction",
            of_contact: String::new(),
            interface: "",
            parameters: String::new(),
            mu: 1.0,
            gravity: G,
            grains: String::new(),
            tolerance: 1e-9,
        }
    }
}

impl Rolling {
    /// Builds the case above the ground, which is added to it, or above a plane of its own.
    fn build<S: Space>(&self, rigid: bool) -> Simulation<S> {
        let level = if rigid { 0.0 } else { -1.0 };
        let (normal, at) = match S::D {
            2 => ("[0.0, 1.0]".to_owned(), format!("[0.0, {level:?}]")),
            _ => (
                "[0.0, 0.0, 1.0]".to_owned(),
                format!("[0.0, 0.0, {level:?}]"),
            ),
        };
        scene::<S>(&Sketch {
            contact: self.contact,
            of_contact: self.of_contact.clone(),
            interface: self.interface,
            parameters: self.parameters.clone(),
            mu: self.mu,
            gravity: self.gravity,
            bodies: format!(
                "(name: \"plane\", material: \"m0\", shapes: [HalfSpace(normal: {normal})], position: {at}),"
            ),
            grains: format!("List(material: \"m0\", grains: [{}]),", self.grains),
            solver: format!(
                "tolerance: {:?}, norm: Velocity, max_iterations: 100000,",
                self.tolerance
            ),
            ..sketch(self.step, self.theta)
        })
    }
}

/// The friction lengths of a contact law (m).
fn lengths(rolling: f64, spinning: f64) -> String {
    format!(
        ", \"rolling\": {rolling:?}, \"rolling_factor\": 0.0, \"spinning\": {spinning:?}, \"spinning_factor\": 0.0"
    )
}

fn grain(at: &[f64], velocity: &[f64], spin: &[f64]) -> String {
    format!("(at: {at:?}, radius: {R:?}, velocity: {velocity:?}, spin: {spin:?})")
}

/// Material of this modulus (Pa) and 1000 kg/m^3.
fn soft(young: f64) -> Elasticity {
    Elasticity { young, ..RUBBER }
}

/// Ground below the height zero, from -0.02 to 0.02 m along each side.
#[derive(Clone, Copy, Debug)]
enum Ground {
    /// A plane that does not deform.
    Rigid,
    /// A block with this number of cells along its length, held below, which touches by its surface
    /// or by its points.
    Block(Strain, usize, Touching<'static>),
    /// A half-space of this number of cells, which touches by its surface or by its points.
    HalfSpace(usize, Cells),
}

const BLOCK: Ground = Ground::Block(Strain::Small, 16, Touching::Surface("top"));

impl Ground {
    /// Builds a case on this ground, of a modulus (Pa).
    fn under<S: Space>(self, case: &Rolling, young: f64) -> Simulation<S> {
        let mut s = case.build::<S>(matches!(self, Self::Rigid));
        let fixed = vec![Dof::Fixed; S::D];
        match self {
            Self::Rigid => (),
            Self::Block(strain, n, touching) => {
                let mut lines = vec![even(-0.02, 0.02, n); S::D - 1];
                lines.push(even(-0.01, 0.0, n / 4));
                let mesh = block::<S>(&lines).unwrap();
                let axes: Vec<Option<Dof>> = fixed.into_iter().map(Some).collect();
                let held = [support("bottom", &axes)];
                let mut spec = body(mesh, soft(young), &held);
                (spec.strain, spec.touching) = (strain, touching);
                add(&mut s, spec);
            }
            Self::HalfSpace(n, touching) => {
                let size = 0.04 / n as f64;
                let system = HalfSpace::<S>::new(HalfSpaceSpec {
                    name: "ground",
                    material: soft(young),
                    fills: FilledSide::Below,
                    position: [0.0; 3],
                    grid: CellGrid {
                        from: [-0.02; 2],
                        size: [size; 2],
                        cells: [n, if S::D == 2 { 1 } else { n }],
                    },
                    repeats: false,
                    reach: Reach::Infinite(if S::D == 2 { 0.1 } else { f64::INFINITY }),
                    profile: Profile::Flat,
                    mass: 0.0,
                    axes: &fixed,
                    rolling: None,
                    touching,
                    surface_material: 0,
                });
                s.add_system(Box::new(system.unwrap_or_else(|e| panic!("{e}"))));
            }
        }
        s
    }
}

/// The grain.
fn ball<S: Space>(s: &Simulation<S>) -> usize {
    s.state.bodies.grains().next().unwrap()
}

fn velocity<S: Space>(s: &Simulation<S>) -> S::Vector {
    s.state.bodies.velocity[ball(s)]
}

fn spin<S: Space>(s: &Simulation<S>) -> S::Spin {
    s.state.bodies.spin[ball(s)]
}
