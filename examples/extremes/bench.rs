//! Scenes in a few words, runs of some steps, and verdicts.

use fretwork::geometry::space::VectorLike;
use fretwork::laws::SearchPath;
use fretwork::scene::build::Dimensional;
use fretwork::scene::load;
use fretwork::step::Simulation;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Acceleration of gravity of the rows (m/s^2).
pub const G: f64 = 9.81;

/// A scene in a few words; the rest is as in every row.
#[derive(Clone)]
pub struct Sketch {
    /// 2 or 3.
    pub dimension: u8,
    /// Step (s).
    pub step: f64,
    /// Theta of the scheme.
    pub theta: f64,
    /// Along the last axis, downwards (m/s^2).
    pub gravity: f64,
    /// Friction of the only interface.
    pub mu: f64,
    /// Further words of the interface, with a comma at the end.
    pub interface: &'static str,
    /// Further parameters of its laws, after a comma.
    pub parameters: String,
    /// Further words of the solver, with a comma at the end.
    pub solver: String,
    /// Alert distance and skin (m).
    pub detection: [f64; 2],
    /// Densities (kg/m^3) of the materials `m0`, `m1`, …
    pub densities: Vec<f64>,
    /// First bodies, in the words of a case.
    pub bodies: String,
    /// Grains, in the words of a case.
    pub grains: String,
    /// Further words of the case, with a comma at the end.
    pub more: String,
}

impl Default for Sketch {
    fn default() -> Self {
        Self {
            dimension: 2,
            step: 1e-3,
            theta: 0.5,
            gravity: G,
            mu: 0.3,
            interface: "",
            parameters: String::new(),
            solver: "tolerance: 1e-10, max_iterations: 100000,".to_owned(),
            detection: [1e-3, 1e-2],
            densities: vec![1000.0],
            bodies: String::new(),
            grains: String::new(),
            more: String::new(),
        }
    }
}

/// A floor at the height zero, of the material `m0`.
pub const FLOOR: &str =
    r#"(name: "floor", material: "m0", shapes: [HalfSpace(normal: [0.0, 1.0])]),"#;

impl Sketch {
    /// The text of its case.
    fn text(&self) -> String {
        let materials: Vec<usize> = (0..self.densities.len()).collect();
        let named = materials.iter().map(|k| format!("\"m{k}\": \"m{k}\""));
        let named: Vec<String> = named.collect();
        let mut interfaces = String::new();
        for a in &materials {
            for b in *a..materials.len() {
                let _ = writeln!(
                    interfaces,
                    "(name: \"i{a}{b}\", between: (\"m{a}\", \"m{b}\"), contact: \"coulomb\", {} \
                     parameters: (contact: {{\"mu\": {:?}}}{})),",
                    self.interface, self.mu, self.parameters,
                );
            }
        }
        let down = match self.dimension {
            2 => format!("[0.0, {:?}]", -self.gravity),
            _ => format!("[0.0, 0.0, {:?}]", -self.gravity),
        };
        format!(
            "(name: \"extreme\", dimension: {}, time: (step: {:?}, end: {:?}, theta: {:?}), gravity: {down}, {} \
             solver: ({}), detection: (alert: {:?}, skin: {:?}), materials: {{{}}}, interfaces: [{interfaces}], \
             bodies: [{}], grains: [{}], output: (frames: 0, views: 0, figures: false))",
            self.dimension,
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
    /// The sentence that a user would read.
    pub fn build<S: Dimensional>(&self) -> Result<Simulation<S>, String> {
        static SCENES: AtomicUsize = AtomicUsize::new(0);
        let number = SCENES.fetch_add(1, Ordering::Relaxed);
        let name = format!("fretwork-extremes-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let shelf = folder.join("materials");
        let io = |e: std::io::Error| e.to_string();
        std::fs::create_dir_all(&shelf).map_err(io)?;
        for (k, density) in self.densities.iter().enumerate() {
            let text = format!(
                "(doc: \"of an extreme\", density: (value: {density:?}, unit: \"kg/m^3\", source: \"chosen\"))"
            );
            std::fs::write(shelf.join(format!("m{k}.ron")), text).map_err(io)?;
        }
        let path = folder.join("case.ron");
        std::fs::write(&path, self.text()).map_err(io)?;
        let loaded = load(&path, &[]).map_err(|e| e.to_string());
        let built = loaded.and_then(|l| {
            l.build_in::<S>(&SearchPath::new(&[]))
                .map_err(|e| e.to_string())
        });
        let _ = std::fs::remove_dir_all(&folder);
        Ok(built?.simulation)
    }
}

/// What became of a scene.
pub enum Verdict {
    /// The criterion is met.
    Held,
    /// It is not, and the program said why.
    Told(String),
    /// It is not, and nothing was said.
    Broken(String),
}

/// A row of the table.
pub struct Row {
    /// The value of the extreme.
    pub value: String,
    /// The figures that were found.
    pub found: String,
    /// What became of it.
    pub verdict: Verdict,
}

/// Rows of one kind.
pub struct Group {
    /// Its name.
    pub name: &'static str,
    /// What must hold.
    pub criterion: &'static str,
    /// Runs them.
    pub run: fn() -> Vec<Row>,
    /// Whether it takes seconds at most, so that the tests run it too.
    pub quick: bool,
}

/// A row whose scene could not be built: told, in the words of the refusal.
pub fn refused(value: String, words: &str) -> Row {
    let first = words.lines().next().unwrap_or_default();
    let sentence = first.split_once("error: ").map_or(first, |(_, s)| s);
    Row {
        value,
        found: "refused".to_owned(),
        verdict: Verdict::Told(sentence.to_owned()),
    }
}

/// What was told during some steps.
#[derive(Default)]
pub struct Ran {
    /// Steps done.
    pub steps: u64,
    /// Steps that did not converge, and the largest error of one.
    pub unconverged: (u64, f64),
    /// The sentence with which the run stopped.
    pub stopped: Option<String>,
    /// Most sweeps in a step.
    pub iterations: u32,
    /// Largest kinetic energy (J/m).
    pub liveliest: f64,
}

/// Steps on, `steps` times.
pub fn go<S: Dimensional>(s: &mut Simulation<S>, steps: u64) -> Ran {
    watch(s, steps, |_| ())
}

/// The same, with a look at the state after each step.
pub fn watch<S: Dimensional>(
    s: &mut Simulation<S>,
    steps: u64,
    mut look: impl FnMut(&Simulation<S>),
) -> Ran {
    let mut ran = Ran::default();
    for _ in 0..steps {
        match s.step() {
            Ok(report) => {
                ran.steps += 1;
                ran.iterations = ran.iterations.max(report.solver.iterations);
                if !report.solver.converged {
                    ran.unconverged.0 += 1;
                    ran.unconverged.1 = ran.unconverged.1.max(report.solver.error);
                }
                ran.liveliest = ran.liveliest.max(s.energy.kinetic);
                look(s);
            }
            Err(e) => {
                ran.stopped = Some(e.to_string());
                break;
            }
        }
    }
    ran
}

impl Ran {
    /// The verdict: held where the criterion is met and all is finite, told where the program gave a cause. A ledger
    /// that does not close is never excused.
    pub fn verdict<S: Dimensional>(&self, s: &Simulation<S>, met: bool) -> Verdict {
        let finite = s.bodies.position.iter().all(VectorLike::is_finite)
            && s.bodies.velocity.iter().all(VectorLike::is_finite)
            && s.energy.relative_residual() < 1e-6;
        let mut told: Vec<String> = self.stopped.iter().cloned().collect();
        if self.unconverged.0 > 0 {
            told.push(format!(
                "{} of {} steps not converged, error at most {:.1e}",
                self.unconverged.0, self.steps, self.unconverged.1
            ));
        }
        told.extend(s.network.haste.warning());
        if met && finite {
            Verdict::Held
        } else if finite && !told.is_empty() {
            Verdict::Told(told.join("; "))
        } else {
            Verdict::Broken(format!(
                "finite, ledger closed: {finite}; {}",
                told.join("; ")
            ))
        }
    }
}

/// Deepest overlap of the contacts at hand, in parts of their radius.
pub fn overlap<S: Dimensional>(s: &Simulation<S>) -> f64 {
    let deep = s.network.contacts.iter().map(|c| -c.gap / c.radius);
    deep.fold(0.0, f64::max)
}

/// The force along the last axis that a first body bears in the last step (N/m; N).
pub fn carried<S: Dimensional>(s: &Simulation<S>, name: &str) -> f64 {
    let driven = s.bodies.driven.iter().position(|d| d.name == name);
    driven.map_or(f64::NAN, |d| -s.received[d].0[S::D - 1] / s.scheme.h)
}
