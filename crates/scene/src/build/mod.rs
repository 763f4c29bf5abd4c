//! Construction of a simulation from a case.

mod another_run;
mod arch;
mod attraction;
mod blocks;
mod contents;
mod deformed;
mod elastic;
mod elastic_grains;
mod first_body;
mod grains;
mod half_space;
mod in_dimension;
mod limits;
mod load;
mod mesh_block;
mod mesh_profile;
mod polygons;
mod polyhedra;
mod samples;
mod surface;
mod union;
mod wear;

pub use load::{load, load_reader, load_text};

use super::case::Case;
use super::interfaces;
use super::material::{Material, MaterialLibrary, Sourced};
use super::methods::{SolverRequirements, SolverSupport};
use super::recorded::{Deformed, RecordReader, ShapedGrain};
use super::scene_file::{self, SceneFile};
use super::source::{InputError, Source, ValidationError};
use super::wear_coefficient::WearCoefficient;
use fretwork_core::assembly::{self, AnySystem, Assembly};
use fretwork_core::contact::detect::LawTable;
use fretwork_core::geometry::periodic::Periodic;
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::{Interface, SearchPath};
use fretwork_core::solve::{self, error::Norm};
use fretwork_core::step::{Scheme, Simulation};
use fretwork_core::view::AnySimulation;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A case file that was read and parsed.
#[derive(Clone, Debug)]
pub struct LoadedCase {
    /// The text, with `--set` applied.
    pub source: Source,
    /// The parsed case.
    pub case: Case,
    /// Path of the file.
    pub path: PathBuf,
    /// Reader of grains from the results of other runs; with `None` cases that need it are
    /// rejected.
    pub records: Option<RecordReader>,
    /// Texts of material and parameter files that the program supplies, by name.
    pub(super) own_files: BTreeMap<String, String>,
}

/// A scene ready to step.
#[derive(Debug)]
pub struct Built {
    /// The simulation.
    pub simulation: AnySimulation,
    /// Names and texts of the material files that were read.
    pub materials: Vec<(String, String)>,
    /// Densities of the materials, times `inertia_scaling` (kg/m^3).
    pub densities: Vec<f64>,
    /// Names of the first bodies, in their order.
    pub names: Vec<String>,
    /// One line of description for each sample that was generated at random or read from a file.
    pub samples: Vec<String>,
    /// The entry of the case that made each body, by body index.
    pub origins: Vec<Origin>,
    /// The deformable grains, without load, in the order of their systems.
    pub deforming: Vec<ShapedGrain>,
    /// Wear coefficients that follow from the hardness of materials.
    pub wear_coefficients: Vec<WearCoefficient>,
}

impl LoadedCase {
    /// Builds the scene.
    ///
    /// # Errors
    /// An [`InputError`] with file, line and column.
    pub fn build(&self, path: &SearchPath) -> Result<Built, InputError> {
        let library = self.material_library();
        let Materials {
            densities,
            properties,
            mut texts,
        } = self.materials(&library)?;
        let laws = interfaces::build(&self.case, &self.source, &library, &properties, path)?;
        texts.extend(laws.files);
        let periodic = Periodic {
            period: [
                self.case.periodic.x,
                self.case.periodic.y,
                self.case.periodic.z,
            ],
        };
        let mut builder = Builder {
            case: &self.case,
            source: &self.source,
            records: self.records,
            folder: self.path.parent().map(Path::to_owned).unwrap_or_default(),
            densities: densities
                .into_iter()
                .map(|(n, (k, d))| (n, (k, d * self.case.inertia_scaling)))
                .collect(),
            files: BTreeMap::new(),
            origins: Vec::new(),
            samples: Vec::new(),
            deformed: BTreeMap::new(),
            deforming: Vec::new(),
            assembly: assembly::empty(self.case.dimension as usize, periodic),
        };
        builder.grains()?;
        let grains = builder.elastic_grains(&properties)?;
        builder.first_bodies()?;
        builder.refuse_idle_wear()?;
        builder.check_elastic_names()?;
        builder.check_elastic_pairs()?;
        let mut systems = builder.elastic_bodies(&properties)?;
        systems.extend(builder.half_spaces(&properties)?);
        builder.check_elastic_points(&systems)?;
        for (grain, origin) in grains {
            systems.push(grain);
            builder.origins.push(origin);
        }
        let driven = builder.assembly.driven().iter();
        let names = driven.map(|d| d.name.clone()).collect();
        let samples = std::mem::take(&mut builder.samples);
        let origins = builder.origins.clone();
        let deforming = std::mem::take(&mut builder.deforming);
        let mut densities = vec![0.0; builder.densities.len()];
        for (k, density) in builder.densities.values() {
            densities[usize::from(*k)] = *density;
        }
        let source = builder.source;
        let mut simulation = builder.finish(laws.interfaces, laws.table, systems)?;
        let unscaled: Vec<f64> = densities
            .iter()
            .map(|d| d / self.case.inertia_scaling)
            .collect();
        crate::heat::install(&self.case, &properties, &unscaled, simulation.setup())
            .map_err(|f| source.locate(f))?;
        Ok(Built {
            simulation,
            materials: texts,
            densities,
            names,
            samples,
            origins,
            deforming,
            wear_coefficients: laws.wear_coefficients,
        })
    }

    /// Builds the simulation alone, in the dimension of the case.
    ///
    /// # Errors
    /// Creates an [`InputError`] with file, line and column; it also says where the case has
    /// another dimension.
    pub fn build_in<S: Space>(&self, path: &SearchPath) -> Result<Simulation<S>, InputError> {
        let simulation = self.build(path)?.simulation.into_dimension();
        simulation.map_err(|other| {
            let message = format!(
                "the case has {} dimensions, not {}",
                other.dimension(),
                S::D
            );
            self.source
                .locate(ValidationError::new("dimension", message))
        })
    }

    /// Returns the density of a material of the case (kg/m^3), without inertia scaling.
    pub fn density(&self, name: &str) -> Option<f64> {
        let materials = self.materials(&self.material_library()).ok()?;
        materials.densities.get(name).map(|d| d.1)
    }

    /// Returns the hardness of a material of the case: as a pressure (Pa), and as its file gives it
    /// with the name of the file. `None` without one, or on a scale that is no pressure.
    pub fn hardness(&self, name: &str) -> Option<(f64, String)> {
        let materials = self.materials(&self.material_library()).ok()?;
        let (index, _) = materials.densities.get(name)?;
        let given = materials.properties.get(usize::from(*index))?;
        let given = given.get("hardness")?;
        let value = crate::quantity::hardness_in_pascal(given.value, &given.unit)?;
        let file = self.case.materials.get(name)?;
        Some((value, format!("{} {} of {file}", given.value, given.unit)))
    }

    /// Reads the materials.
    fn materials(&self, library: &MaterialLibrary) -> Result<Materials, InputError> {
        let mut out = Materials::default();
        for (k, (name, file)) in self.case.materials.iter().enumerate() {
            let here = format!("materials.{name}");
            let source = library.read(file).map_err(|e| match e {
                Err(error) => self.source.named_at(&here, error),
                Ok(missing) => self.source.locate(
                    ValidationError::new(
                        format!("materials.{name}"),
                        format!("there is no file `{file}.ron` in {}", missing.searched),
                    )
                    .expected(format!("one of {}", missing.available))
                    .nearest(missing.nearest.as_deref()),
                ),
            })?;
            let material: Material = source.parse()?;
            let density = material.density().map_err(|f| source.locate(f))?;
            out.densities.insert(name.clone(), (k as u16, density));
            out.properties.push(material.properties);
            if !out.texts.iter().any(|t| t.0 == *file) {
                out.texts.push((file.clone(), source.text().to_owned()));
            }
        }
        Ok(out)
    }
}

/// Data from the material files of a case.
#[derive(Default)]
struct Materials {
    /// Index in the order of the case and density (kg/m^3), by name.
    densities: BTreeMap<String, (u16, f64)>,
    /// Further properties, in the order of the case.
    properties: Vec<BTreeMap<String, Sourced>>,
    /// Names and texts of the files.
    texts: Vec<(String, String)>,
}

struct Builder<'a> {
    records: Option<RecordReader>,
    case: &'a Case,
    source: &'a Source,
    folder: PathBuf,
    densities: BTreeMap<String, (u16, f64)>,
    files: BTreeMap<String, SceneFile>,
    /// Bodies and shapes so far.
    assembly: Box<dyn Assembly>,
    /// The entry of the case that made each body: an index in `grains`, an index in its list, or an
    /// index in `bodies`.
    origins: Vec<Origin>,
    /// Descriptions of the samples, for [`Built::samples`].
    samples: Vec<String>,
    /// Grains that were deformed in a state of another run, by body, with their identity in that
    /// state.
    deformed: BTreeMap<u32, (u64, Deformed)>,
    /// Deformable grains, for [`Built::deforming`].
    deforming: Vec<ShapedGrain>,
}

/// The entry of the case that made a body.
#[derive(Clone, Copy, Debug)]
pub enum Origin {
    /// Index in `grains`, and index in its list if it has one.
    Grain(usize, Option<usize>),
    /// Index in `bodies`.
    Body(usize),
    /// Index in `elastic`.
    Elastic(usize),
    /// Index in `half_spaces`.
    HalfSpace(usize),
}

impl Origin {
    /// Returns the dotted path of the entry.
    pub fn path(self) -> String {
        match self {
            Self::Grain(k, None) => format!("grains.{k}"),
            Self::Grain(k, Some(g)) => format!("grains.{k}.grains.{g}"),
            Self::Body(k) => format!("bodies.{k}"),
            Self::Elastic(k) => format!("elastic.{k}"),
            Self::HalfSpace(k) => format!("half_spaces.{k}"),
        }
    }
}

impl Builder<'_> {
    fn fail(&self, path: impl Into<String>, message: impl Into<String>) -> InputError {
        self.source.locate(ValidationError::new(path, message))
    }

    fn material(&self, path: &str, name: &str) -> Result<(u16, f64), InputError> {
        self.densities.get(name).copied().ok_or_else(|| {
            let names: Vec<&str> = self.densities.keys().map(String::as_str).collect();
            self.source.locate(
                ValidationError::new(path, format!("the case has no material `{name}`"))
                    .expected_name(names.iter().copied(), "materials")
                    .nearest(super::source::nearest(name, names.iter().copied())),
            )
        })
    }

    fn dimension(&self) -> usize {
        self.case.dimension as usize
    }

    /// Returns a vector of the case, zero where it is omitted; in the plane its third component is
    /// zero.
    fn vector(&self, path: &str, values: &[f64]) -> Result<Vector3<f64>, InputError> {
        if values.is_empty() {
            return Ok(Vector3::zeros());
        }
        if values.len() != self.dimension() {
            let message = format!(
                "{} components in a case of dimension {}",
                values.len(),
                self.dimension()
            );
            return Err(self.source.locate(
                ValidationError::new(path, message)
                    .expected(format!("{} numbers", self.dimension())),
            ));
        }
        if values.iter().any(|x| !x.is_finite()) {
            return Err(self.fail(path, "the components must be finite numbers"));
        }
        Ok(components(values))
    }

    fn radius(&self, path: &str, radius: f64) -> Result<f64, InputError> {
        if radius.is_finite() && radius > 0.0 {
            return Ok(radius);
        }
        Err(self.source.locate(ValidationError::new(
            path,
            format!("a radius must be positive, got {radius}"),
        )))
    }

    fn scene_file(&mut self, here: &str, file: &str) -> Result<SceneFile, InputError> {
        if let Some(scene) = self.files.get(file) {
            return Ok(scene.clone());
        }
        let read = scene_file::read(&self.folder.join(file), self.dimension());
        let scene = read.map_err(|e| self.source.named_at(&format!("{here}.file"), e))?;
        self.files.insert(file.to_owned(), scene.clone());
        Ok(scene)
    }

    fn finish(
        mut self,
        laws: Vec<Interface>,
        table: LawTable,
        systems: Vec<AnySystem>,
    ) -> Result<AnySimulation, InputError> {
        let case = self.case;
        let points = systems.iter().flat_map(|s| s.contactors());
        let radii = self.assembly.radii();
        let smallest = radii.iter().copied().chain(points.map(|c| c.radius));
        let smallest = smallest.fold(f64::INFINITY, f64::min);
        let smallest = if smallest.is_finite() { smallest } else { 1.0 };
        let needed = case.interfaces.iter().filter_map(|i| i.bonds_within);
        let needed = needed.fold(0.05 * smallest, f64::max);
        let alert = attraction::alert(self.source, case, &laws, needed)?;
        let skin = case.detection.skin.unwrap_or(0.3 * smallest);
        let largest = radii.iter().copied().fold(0.0, f64::max);
        if largest > 0.0 && alert > 10.0 * largest {
            let message = format!(
                "an alert distance of {alert} m is more than ten times the largest radius ({largest} m): all pairs would be \
                 contacts; the default is 0.05 of the smallest"
            );
            return Err(self.fail("detection.alert", message));
        }
        self.refuse_wide_skin(alert, skin, largest)?;
        self.refuse_overcrowding(alert, skin, &table)?;
        let gravity = self.vector("gravity", &case.gravity)?;
        self.refuse_small_period(alert + skin)?;
        let wears = self.deformable_wear()?;
        let source = self.source;
        for system in systems {
            self.assembly.add_system(system);
        }
        let (mut built, surfaces) = self.assembly.into_simulation(laws, table, alert, skin);
        // Grains come last and do not recede.
        for (wears, surface) in wears.into_iter().zip(surfaces) {
            if let (Some(wears), Some(surface)) = (wears, surface) {
                let scar = wears.add_scar(built.setup(), surface);
                scar.map_err(|f| source.locate(f))?;
            }
        }
        let simulation = built.setup();
        let support = SolverRequirements::of(simulation).support(case.solver.method);
        if let SolverSupport::Refuses(reason) = support {
            return Err(source.locate(ValidationError::new("solver.method", reason)));
        }
        simulation.set_gravity(gravity.into(), None);
        super::phases::install(case, simulation).map_err(|f| source.locate(f))?;
        let springs = simulation.laws().iter().all(Interface::compliant);
        let by_heat = springs && !simulation.laws().is_empty() && case.solver.tolerance.is_none();
        let options = simulation.options_mut();
        options.correction = case.solver.correction;
        options.projection = case.solver.projection;
        options.coupling = case.coupling;
        options.scheme = Scheme {
            h: case.time.step,
            theta: case.time.theta,
        };
        // A scene of springs can be slow, so that its error is measured by the heat of slip, unless
        // the case has its own tolerance.
        let norm = case
            .solver
            .norm
            .unwrap_or(if by_heat { Norm::Power } else { Norm::Balance });
        let tolerance = case.solver.tolerance;
        options.solver = solve::SolverOptions {
            tolerance: tolerance.unwrap_or(norm.default_tolerance()),
            norm,
            max_iterations: case.solver.max_iterations,
            test_every: case.solver.test_every,
            relaxation: case.solver.relaxation,
            accelerated: true,
            method: case.solver.method,
            parallel: false,
        };
        super::magnitudes::check(simulation, &self.origins, case.time.end)
            .map_err(|f| source.locate(f))?;
        super::deep::points(simulation, &self.origins).map_err(|f| source.locate(f))?;
        super::check::overlaps(simulation, smallest, &self.origins)
            .map_err(|f| source.locate(f))?;
        simulation.set_in_motion();
        Ok(built)
    }
}

/// A vector of three components, zero where the case gives none.
fn components(values: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|k, _| values.get(k).copied().unwrap_or_default())
}
