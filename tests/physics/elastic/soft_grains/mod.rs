//! Deformable grains: a disk between plates, impact, spin, piles, and contacts with all other
//! shapes.
//!
//! The scenes are cases as a user writes them. Grains of `soft` deform, those of `rigid` and
//! `stone` do not.

mod adhesion;
mod bonds;
mod extremes;
mod fast;
mod found;
mod impact;
mod incline;
mod moments;
mod others;
mod period;
mod piles;
mod plates;
mod spin;

use super::*;
use fretwork::contact::StepSizeDiagnostics;
use fretwork::geometry::space::Space;
use fretwork::record::encoding::{decode, encode};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::State;
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

const NU: f64 = 0.3;
const DENSITY: f64 = 1000.0;
/// Radius of the disks and spheres (m).
const R: f64 = 0.01;
const G: f64 = 9.81;

/// A case with soft grains.
#[derive(Clone)]
struct Soft {
    step: f64,
    theta: f64,
    /// Gravity along all axes (m/s^2).
    gravity: Vec<f64>,
    young: f64,
    elements: usize,
    damping: f64,
    mu: f64,
    /// The contact law of all interfaces, and its parameters after `mu`.
    contact: (&'static str, String),
    /// Further fields of all interfaces, and further parameters of their laws.
    interface: &'static str,
    parameters: String,
    tolerance: f64,
    /// Alert distance and skin (m).
    detection: [f64; 2],
    bodies: String,
    grains: String,
    /// Further fields of the case.
    more: String,
}

impl Default for Soft {
    fn default() -> Self {
        Self {
            step: 1e-4,
            theta: 0.5,
            gravity: Vec::new(),
            young: 1e6,
            elements: 4,
            damping: 0.0,
            mu: 0.3,
            contact: ("coulomb", String::new()),
            interface: "",
            parameters: String::new(),
            tolerance: 1e-12,
            detection: [2e-4, 1e-3],
            bodies: String::new(),
            grains: String::new(),
            more: String::new(),
        }
    }
}

impl Soft {
    fn text(&self, dimension: usize) -> String {
        let mut gravity = self.gravity.clone();
        gravity.resize(dimension, 0.0);
        let names = ["rigid", "soft", "stone"];
        let mut interfaces = String::new();
        for (k, one) in names.iter().enumerate() {
            for other in &names[k..] {
                interfaces += &format!(
                    "(name: \"{one}_{other}\", between: (\"{one}\", \"{other}\"), contact: \"{}\", {} \
                     parameters: (contact: {{\"mu\": {:?}{}}}{})),\n",
                    self.contact.0, self.interface, self.mu, self.contact.1, self.parameters
                );
            }
        }
        format!(
            "(name: \"soft grains\", dimension: {dimension}, time: (step: {:?}, end: 1e3, theta: {:?}),\n\
             gravity: {gravity:?}, {}\n\
             solver: (tolerance: {:?}, norm: Velocity, max_iterations: 200000),\n\
             detection: (alert: {:?}, skin: {:?}),\n\
             materials: {{\"rigid\": \"rigid\", \"soft\": \"soft\", \"stone\": \"stone\"}},\n\
             interfaces: [{interfaces}],\n bodies: [{}],\n grains: [{}],\n\
             elastic_grains: [(material: \"soft\", elements: {}, damping: (mass: 0.0, stiffness: {:?}))],\n\
             output: (frames: 0, views: 0, figures: false))",
            self.step,
            self.theta,
            self.more,
            self.tolerance,
            self.detection[0],
            self.detection[1],
            self.bodies,
            self.grains,
            self.elements,
            self.damping,
        )
    }

    fn build<S: Space>(&self) -> Simulation<S> {
        self.build_with(NU)
    }

    /// Builds the scene with materials of this Poisson's ratio.
    fn build_with<S: Space>(&self, nu: f64) -> Simulation<S> {
        static SCENES: AtomicUsize = AtomicUsize::new(0);
        let number = SCENES.fetch_add(1, Ordering::Relaxed);
        let name = format!("fretwork-soft-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let shelf = folder.join("materials");
        std::fs::create_dir_all(&shelf).unwrap();
        for name in ["rigid", "soft", "stone"] {
            let text = format!(
                "(doc: \"chosen\", density: (value: {DENSITY:?}, unit: \"kg/m^3\", source: \"chosen\"), properties: {{\
                 \"young\": (value: {:?}, unit: \"Pa\", source: \"chosen\"), \"poisson\": (value: {nu:?}, source: \"chosen\")}})",
                self.young
            );
            std::fs::write(shelf.join(format!("{name}.ron")), text).unwrap();
        }
        let path = folder.join("case.ron");
        std::fs::write(&path, self.text(S::D)).unwrap();
        let loaded = load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
        let built = loaded.build_in::<S>(&search_path());
        let _ = std::fs::remove_dir_all(&folder);
        built.unwrap_or_else(|e| panic!("{e}"))
    }
}

fn down(dimension: usize) -> Vec<f64> {
    let mut out = vec![0.0; dimension];
    out[dimension - 1] = -G;
    out
}

fn disks(material: &str, all: &[String]) -> String {
    format!(
        "List(material: \"{material}\", grains: [{}]),",
        all.join(", ")
    )
}

fn ball_at(at: &[f64], velocity: &[f64]) -> String {
    format!("(at: {at:?}, radius: {R:?}, velocity: {velocity:?})")
}

/// A square with this side (m) about a point.
fn square(material: &str, at: [f64; 2], side: f64, angle: f64, more: &str) -> String {
    let h = 0.5 * side;
    format!(
        "Polygons(material: \"{material}\", grains: [(at: {at:?}, angle: {angle:?}, \
         points: [({:?}, {:?}), ({h:?}, {:?}), ({h:?}, {h:?}), ({:?}, {h:?})], {more})]),",
        -h, -h, -h, -h
    )
}

fn cuboid(material: &str, at: [f64; 3], size: [f64; 3], more: &str) -> String {
    let [a, b, c] = size;
    format!(
        "Polyhedra(material: \"{material}\", grains: [(at: {at:?}, size: ({a:?}, {b:?}, {c:?}), {more})]),"
    )
}

fn wall(name: &str, normal: &[f64], at: &[f64], more: &str) -> String {
    format!(
        "(name: \"{name}\", material: \"rigid\", shapes: [HalfSpace(normal: {normal:?})], position: {at:?}, {more}),"
    )
}

/// Momentum, and angular momentum about the origin, of one grain, with its moment of inertia from
/// the mesh without load.
fn momenta<S: Space>(s: &Simulation<S>, system: usize) -> (S::Vector, S::Spin) {
    let grain = s.state.systems.get(system).unwrap();
    let mesh = grain.deformed_mesh().unwrap();
    let body = s.state.systems.bodies(system)[0] as usize;
    let centre = s.state.bodies.position[body];
    let velocity = S::Vector::from_slice(&grain.velocity()[..S::D]);
    let spin = S::Spin::from_slice(&grain.velocity()[S::D..S::D + S::Spin::N]);
    let (mut linear, mut angular) = (S::Vector::zero(), S::Spin::zero());
    for element in mesh.elements.chunks_exact(S::D + 1) {
        let corners: Vec<S::Vector> = element.iter().map(|p| mesh.points[*p as usize]).collect();
        let volume = fretwork::elastic::element::Simplex::<S>::new(&corners).unwrap();
        let share = DENSITY * volume.volume / (S::D + 1) as f64;
        for x in corners {
            let v = velocity + S::spin_velocity(&spin, &(x - centre));
            linear += v * share;
            angular += S::moment(&x, &(v * share));
        }
    }
    (linear, angular)
}

fn all_momenta<S: Space>(s: &Simulation<S>) -> (S::Vector, S::Spin) {
    let mut out = (S::Vector::zero(), S::Spin::zero());
    for k in 0..s.state.systems.len() {
        let (linear, angular) = momenta(s, k);
        out.0 += linear;
        out.1 += angular;
    }
    out
}

fn energy<S: Space>(s: &Simulation<S>) -> f64 {
    let e = &s.state.energy;
    e.kinetic + e.potential + e.elastic
}

fn place_of<S: Space>(s: &Simulation<S>, system: usize) -> S::Vector {
    s.state.bodies.position[s.state.systems.bodies(system)[0] as usize]
}

fn velocity_of<S: Space>(s: &Simulation<S>, system: usize) -> S::Vector {
    S::Vector::from_slice(&s.state.systems.get(system).unwrap().velocity()[..S::D])
}

/// Force of the contacts of a body in the last step along an axis on the others (N; N/m in 2D).
fn force_on_others<S: Space>(s: &Simulation<S>, body: usize, axis: usize) -> f64 {
    let contacts = s.state.network.contacts.iter();
    let sum: f64 = contacts
        .map(|c| {
            let of = |k: usize| f64::from(u8::from(c.bodies[k] as usize == body));
            c.impulse[axis] * (of(1) - of(0))
        })
        .sum();
    sum / s.options.scheme.h
}

fn deepest<S: Space>(s: &Simulation<S>) -> f64 {
    let contacts = s.state.network.contacts.iter();
    contacts.fold(0.0, |most: f64, c| most.max(-c.gap))
}

/// All numbers of the state.
fn bits<S: Space>(s: &Simulation<S>) -> Vec<u8> {
    encode(&s.state).unwrap()
}
