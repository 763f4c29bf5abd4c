//! Short scene descriptions, written once for 2D and 3D.

use fretwork::geometry::space::Space;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Acceleration of gravity of the rows (m/s^2).
pub const G: f64 = 9.81;

/// A scene description; values not given here are the same in all rows.
#[derive(Clone)]
pub struct Sketch {
    /// Step (s).
    pub step: f64,
    /// Theta of the time-stepping scheme.
    pub theta: f64,
    /// Gravity along the last axis, downwards (m/s^2).
    pub gravity: f64,
    /// Contact law of all interfaces.
    pub contact: &'static str,
    /// Friction coefficient of the only interface.
    pub mu: f64,
    /// Normal restitution of the only interface, if its law has it.
    pub restitution: Option<f64>,
    /// Further parameters of its contact law, with a leading comma.
    pub of_contact: String,
    /// Further fields of the interface, with a trailing comma.
    pub interface: &'static str,
    /// Further parameters of its laws, with a leading comma.
    pub parameters: String,
    /// Further fields of the solver, with a trailing comma.
    pub solver: String,
    /// Alert distance and skin (m).
    pub detection: [f64; 2],
    /// Densities (kg/m^3) of the materials `m0`, `m1`, …
    pub densities: Vec<f64>,
    /// Young's modulus (Pa) of all of them, with a Poisson's ratio of 0.3, where something deforms.
    pub young: Option<f64>,
    /// First bodies, as in a case.
    pub bodies: String,
    /// Grains, as in a case.
    pub grains: String,
    /// Further fields of the case, with a trailing comma.
    pub more: String,
}

impl Default for Sketch {
    fn default() -> Self {
        Self {
            step: 1e-3,
            theta: 0.5,
            gravity: G,
            contact: "coulomb",
            mu: 0.3,
            restitution: None,
            of_contact: String::new(),
            interface: "",
            parameters: String::new(),
            solver: "tolerance: 1e-10, max_iterations: 100000,".to_owned(),
            detection: [1e-3, 1e-2],
            densities: vec![1000.0],
            young: None,
            bodies: String::new(),
            grains: String::new(),
            more: String::new(),
        }
    }
}

/// A position or a direction: along x, out of plane (omitted in 2D) and upwards.
pub fn place<S: Space>(x: f64, across: f64, up: f64) -> String {
    match S::D {
        2 => format!("[{x:?}, {up:?}]"),
        _ => format!("[{x:?}, {across:?}, {up:?}]"),
    }
}

/// Name of the vertical axis.
pub fn up<S: Space>() -> &'static str {
    if S::D == 2 { "y" } else { "z" }
}

/// Area of a disk (m^2) or volume of a sphere (m^3).
pub fn volume<S: Space>(radius: f64) -> f64 {
    if S::D == 2 {
        PI * radius.powi(2)
    } else {
        4.0 / 3.0 * PI * radius.powi(3)
    }
}

/// A fixed plane of the material `m0` through the origin.
pub fn plane<S: Space>(name: &str, x: f64, across: f64, up: f64) -> String {
    let normal = place::<S>(x, across, up);
    format!("(name: \"{name}\", material: \"m0\", shapes: [HalfSpace(normal: {normal})]),")
}

/// A floor at the height zero.
pub fn floor<S: Space>() -> String {
    plane::<S>("floor", 0.0, 0.0, 1.0)
}

/// A disk or a sphere at a position.
pub fn ball(at: &str, radius: f64) -> String {
    format!("(at: {at}, radius: {radius:?})")
}

/// Disks or spheres of a material.
pub fn grains(material: &str, all: &[String]) -> String {
    format!(
        "List(material: \"{material}\", grains: [{}]),",
        all.join(", ")
    )
}

impl Sketch {
    /// Text of the case.
    fn text(&self, dimension: usize) -> String {
        let materials: Vec<usize> = (0..self.densities.len()).collect();
        let named = materials.iter().map(|k| format!("\"m{k}\": \"m{k}\""));
        let named: Vec<String> = named.collect();
        let mut interfaces = String::new();
        for a in &materials {
            for b in *a..materials.len() {
                let restitution = self.restitution;
                let restitution =
                    restitution.map_or(String::new(), |e| format!(", \"restitution_n\": {e:?}"));
                let _ = writeln!(
                    interfaces,
                    "(name: \"i{a}{b}\", between: (\"m{a}\", \"m{b}\"), contact: \"{}\", {} \
                     parameters: (contact: {{\"mu\": {:?}{restitution}{}}}{})),",
                    self.contact, self.interface, self.mu, self.of_contact, self.parameters,
                );
            }
        }
        let down = match dimension {
            2 => format!("[0.0, {:?}]", -self.gravity),
            _ => format!("[0.0, 0.0, {:?}]", -self.gravity),
        };
        format!(
            "(name: \"extreme\", dimension: {dimension}, time: (step: {:?}, end: {:?}, theta: {:?}), gravity: {down}, {} \
             solver: ({}), detection: (alert: {:?}, skin: {:?}), materials: {{{}}}, interfaces: [{interfaces}], \
             bodies: [{}], grains: [{}], output: (frames: 0, views: 0, figures: false))",
            self.step,
            1e9 * self.step,
            self.theta,
            self.more,
            self.solver,
            self.detection[0],
            self.detection[1],
            named.join(", "),
            self.bodies,
            self.grains,
        )
    }

    /// Builds the scene.
    ///
    /// # Errors
    /// The message that a user would read.
    pub fn build<S: Space>(&self) -> Result<Simulation<S>, String> {
        static SCENES: AtomicUsize = AtomicUsize::new(0);
        let number = SCENES.fetch_add(1, Ordering::Relaxed);
        let name = format!("fretwork-extremes-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let shelf = folder.join("materials");
        let io = |e: std::io::Error| e.to_string();
        std::fs::create_dir_all(&shelf).map_err(io)?;
        let elastic = self.young.map_or(String::new(), |young| {
            format!(
                ", properties: {{\"young\": (value: {young:?}, unit: \"Pa\", source: \"chosen\"), \
                 \"poisson\": (value: 0.3, unit: \"1\", source: \"chosen\")}}"
            )
        });
        for (k, density) in self.densities.iter().enumerate() {
            let text = format!(
                "(doc: \"of an extreme\", density: (value: {density:?}, unit: \"kg/m^3\", source: \"chosen\"){elastic})"
            );
            std::fs::write(shelf.join(format!("m{k}.ron")), text).map_err(io)?;
        }
        let path = folder.join("case.ron");
        std::fs::write(&path, self.text(S::D)).map_err(io)?;
        let loaded = load(&path, &[]).map_err(|e| e.to_string());
        let built = loaded.and_then(|l| l.build_in::<S>(&search_path()).map_err(|e| e.to_string()));
        let _ = std::fs::remove_dir_all(&folder);
        built
    }
}
