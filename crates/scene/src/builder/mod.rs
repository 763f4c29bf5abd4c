//! A case made in Rust, without any file.
//!
//! A [`CaseBuilder`] fills in a [`Case`], the type into which case files are read. It can therefore
//! express everything that a file can, with the same checks and error messages.
//! [`CaseBuilder::change`] sets everything that has no method of its own.

mod body;
mod grains;
mod interface;
mod shapes;

use crate::build::{Built, LoadedCase};
use crate::case::HeatSpec;
use crate::case::{
    AccuracySpec, BodySpec, Case, GrainSpec, InterfaceSpec, PeriodicSpec, SolverSpec, TimeSpec,
};
use crate::material::{Material, Sourced};
use crate::source::InputError;
use fretwork_core::laws::SearchPath;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Builds a [`Case`] in two or three dimensions, and from it a simulation.
///
/// # Examples
/// In the example a ball rests on a plane; both have a material defined there. The laws come from
/// the search path; the crate `fretwork` has one with all shipped laws,
/// `fretwork::shipped::search_path()`.
/// ```
/// use fretwork_scene::case::{BodySpec, GrainSpec, InterfaceSpec, OneGrain, ShapeSpec};
/// use fretwork_scene::CaseBuilder;
///
/// let loaded = CaseBuilder::in_space("a ball on a plane")
///     .time(1e-4, 0.1)
///     .gravity([0.0, 0.0, -9.81])
///     .own_material("glass", 2500.0, "data sheet")
///     .interface(InterfaceSpec::new("dry", ("glass", "glass"), "coulomb", &[("mu", 0.3)]))
///     .body(BodySpec::new("floor", "glass", ShapeSpec::half_space([0.0, 0.0, 1.0], [0.0; 3])))
///     .grains(GrainSpec::balls("glass", [OneGrain::new([0.0, 0.0, 0.01], 0.01)]))
///     .load()?;
/// assert_eq!(loaded.density("glass"), Some(2500.0));
///
/// // Mistakes are the errors of case files.
/// let wrong = CaseBuilder::in_space("no step").load().map(|_| ()).unwrap_err();
/// assert!(wrong.to_string().contains("must be positive, got 0"), "{wrong}");
/// # Ok::<(), fretwork_scene::InputError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CaseBuilder {
    case: Case,
    folder: PathBuf,
    materials: BTreeMap<String, Material>,
}

impl CaseBuilder {
    /// Creates an empty case of two dimensions with a title: it still needs its [time](Self::time),
    /// materials and bodies.
    pub fn in_plane(name: impl Into<String>) -> Self {
        Self::new(name.into(), 2)
    }

    /// Creates an empty case of three dimensions with a title; see [`Self::in_plane`].
    pub fn in_space(name: impl Into<String>) -> Self {
        Self::new(name.into(), 3)
    }

    fn new(name: String, dimension: u32) -> Self {
        Self {
            case: Case {
                name,
                doc: String::new(),
                named_values: BTreeMap::new(),
                dimension,
                seed: 0,
                time: TimeSpec {
                    step: 0.0,
                    end: 0.0,
                    theta: 0.5,
                },
                gravity: Vec::new(),
                gravity_drive: None,
                elastic: Vec::new(),
                half_spaces: Vec::new(),
                elastic_grains: Vec::new(),
                phases: Vec::new(),
                inertia_scaling: 1.0,
                coupling: Default::default(),
                periodic: PeriodicSpec::default(),
                detection: Default::default(),
                solver: SolverSpec::default(),
                materials: Default::default(),
                interfaces: Vec::new(),
                pins: BTreeMap::new(),
                bodies: Vec::new(),
                grains: Vec::new(),
                heat: None,
                friction: None,
                biaxial: None,
                circuit: None,
                jump: None,
                measures: Vec::new(),
                accuracy: None,
                uncertainty: Default::default(),
                output: Default::default(),
            },
            folder: PathBuf::new(),
            materials: BTreeMap::new(),
        }
    }

    /// The time step and the end of the run (s).
    #[must_use]
    pub fn time(mut self, step: f64, end: f64) -> Self {
        (self.case.time.step, self.case.time.end) = (step, end);
        self
    }

    /// Lets the run choose step and tolerance for an accuracy: the relative change of friction that
    /// they may cause.
    #[must_use]
    pub fn accuracy(mut self, accuracy: AccuracySpec) -> Self {
        self.case.accuracy = Some(accuracy);
        self
    }

    /// Computes heat, and electric current if there is a circuit.
    #[must_use]
    pub fn heat(mut self, heat: HeatSpec) -> Self {
        self.case.heat = Some(heat);
        self
    }

    /// Sets the acceleration of gravity (m/s^2), one number per axis; none by default.
    #[must_use]
    pub fn gravity(mut self, gravity: impl Into<Vec<f64>>) -> Self {
        self.case.gravity = gravity.into();
        self
    }

    /// Sets the lengths of the periodic cell along x, y and z (m); not periodic by default.
    #[must_use]
    pub fn periodic(mut self, [x, y, z]: [Option<f64>; 3]) -> Self {
        self.case.periodic = PeriodicSpec { x, y, z };
        self
    }

    /// Sets the seed of all random numbers; 0 by default.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.case.seed = seed;
        self
    }

    /// Sets the options of the solver.
    #[must_use]
    pub fn solver(mut self, solver: SolverSpec) -> Self {
        self.case.solver = solver;
        self
    }

    /// Adds a material from the file `FILE.ron` in a folder `materials`, or from the built-in ones,
    /// such as `rail_steel_r260`.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>, file: impl Into<String>) -> Self {
        self.case.materials.insert(name.into(), file.into());
        self
    }

    /// Adds a material by its density (kg/m^3) and the source of that number.
    #[must_use]
    pub fn own_material(
        mut self,
        name: impl Into<String>,
        density: f64,
        source: impl Into<String>,
    ) -> Self {
        let name = name.into();
        let material = Material {
            doc: name.clone(),
            class: None,
            also: Vec::new(),
            density: Sourced {
                value: density,
                unit: "kg/m^3".to_owned(),
                range: None,
                motion: None,
                source: source.into(),
            },
            properties: BTreeMap::new(),
            laws: None,
        };
        self.materials.insert(name.clone(), material);
        self.case.materials.insert(name.clone(), name);
        self
    }

    /// The laws between two materials.
    #[must_use]
    pub fn interface(mut self, interface: InterfaceSpec) -> Self {
        self.case.interfaces.push(interface);
        self
    }

    /// A first body.
    #[must_use]
    pub fn body(mut self, body: BodySpec) -> Self {
        self.case.bodies.push(body);
        self
    }

    /// Adds grains.
    #[must_use]
    pub fn grains(mut self, grains: GrainSpec) -> Self {
        self.case.grains.push(grains);
        self
    }

    /// Changes any other part of the case: phases, measures, detection, output.
    #[must_use]
    pub fn change(mut self, change: impl FnOnce(&mut Case)) -> Self {
        change(&mut self.case);
        self
    }

    /// Sets the folder to which paths of files in the case are relative; the working folder by
    /// default.
    #[must_use]
    pub fn folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }

    /// Returns the case without checks. It names materials of [`own_material`](Self::own_material)
    /// as files.
    pub fn case(&self) -> Case {
        self.case.clone()
    }

    /// Checks the case, as if it had been read from a file.
    ///
    /// # Errors
    /// The errors of [`LoadedCase::from_case`].
    pub fn load(self) -> Result<LoadedCase, InputError> {
        let mut loaded = LoadedCase::from_case(self.case, &self.folder)?;
        for (name, material) in &self.materials {
            loaded = loaded.with_material(name, material)?;
        }
        Ok(loaded)
    }

    /// Checks the case and builds its simulation with the laws of a search path.
    ///
    /// # Errors
    /// Returns the errors of a case file with the same content: laws and materials that are not
    /// found, parameters out of range, bodies that overlap.
    pub fn build(self, laws: &SearchPath) -> Result<Built, InputError> {
        self.load()?.build(laws)
    }
}
