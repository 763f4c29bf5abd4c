//! From a case to a scene that steps.

use super::case::{BodySpec, Case, GrainSpec, ShapeSpec, Side};
use super::material::{Material, Shelf};
use super::methods::{Demands, Service};
use super::scene_file::{self, SceneFile};
use super::source::{Fault, InputError, Source};
use super::{interfaces, profile, sample};
use crate::bodies::{Bodies, Driven};
use crate::geometry::height_field::HeightField;
use crate::geometry::periodic::Periodic;
use crate::geometry::polyline::Polyline;
use crate::geometry::shape::{Ball, Carried, HalfSpace, Shapes, Surface};
use crate::geometry::space::{Plane, Solid, Space, VectorLike};
use crate::laws::{Interface, SearchPath};
use crate::solve;
use crate::step::{Scheme, Simulation};
use nalgebra::Vector2;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A case that was read: the text, what it says, and where it stands.
#[derive(Debug)]
pub struct Loaded {
    /// The text, `--set` applied.
    pub source: Source,
    /// What it says.
    pub case: Case,
    /// Its file.
    pub path: PathBuf,
}

/// A scene of either dimension.
#[derive(Debug)]
pub enum Scene {
    /// Two dimensions.
    Plane(Box<Built<Plane>>),
    /// Three dimensions.
    Solid(Box<Built<Solid>>),
}

/// A scene ready to step.
#[derive(Debug)]
pub struct Built<S: Space> {
    /// The stepper.
    pub simulation: Simulation<S>,
    /// Material files read: name and text.
    pub materials: Vec<(String, String)>,
    /// The body under test and the names of the driven bodies, in their order.
    pub names: Vec<String>,
}

/// Shapes that exist in one dimension only.
pub trait Dimensional: Space {
    /// A profile of points, left to right.
    ///
    /// # Errors
    /// Why it is none, or that the dimension has no profiles.
    fn profile(
        points: Vec<(f64, f64)>,
        side: Side,
        period: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String>;
    /// A height field.
    ///
    /// # Errors
    /// Why it is none, or that the dimension has no height fields.
    fn height_field(
        points: (usize, usize),
        spacing: (f64, f64),
        heights: Vec<f64>,
        periodic: [bool; 2],
    ) -> Result<Box<dyn Surface<Self>>, String>;
}

impl Dimensional for Plane {
    fn profile(
        points: Vec<(f64, f64)>,
        side: Side,
        period: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let mut points: Vec<Vector2<f64>> = points
            .into_iter()
            .map(|(x, y)| Vector2::new(x, y))
            .collect();
        if points.windows(2).any(|w| w[1].x < w[0].x) {
            return Err("the points of a profile must go from left to right".into());
        }
        if side == Side::Above {
            points.reverse();
        }
        Ok(Box::new(
            Polyline::new(points, period).map_err(|e| e.to_string())?,
        ))
    }
    fn height_field(
        _: (usize, usize),
        _: (f64, f64),
        _: Vec<f64>,
        _: [bool; 2],
    ) -> Result<Box<dyn Surface<Self>>, String> {
        Err("a height field needs three dimensions; use a Profile or RoughProfile in two".into())
    }
}

impl Dimensional for Solid {
    fn profile(
        _: Vec<(f64, f64)>,
        _: Side,
        _: Option<f64>,
    ) -> Result<Box<dyn Surface<Self>>, String> {
        Err("a profile needs two dimensions; use a HeightField in three".into())
    }
    fn height_field(
        points: (usize, usize),
        spacing: (f64, f64),
        heights: Vec<f64>,
        periodic: [bool; 2],
    ) -> Result<Box<dyn Surface<Self>>, String> {
        let field = HeightField::new(
            points.0,
            points.1,
            [spacing.0, spacing.1],
            heights,
            periodic,
        );
        Ok(Box::new(field.map_err(|e| e.to_string())?))
    }
}

/// Reads a case and applies `--set`s.
///
/// # Errors
/// At file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, InputError> {
    let mut source = Source::read(path)?;
    for set in sets {
        source.set(set)?;
    }
    let case: Case = source.parse()?;
    super::check::numbers(&case).map_err(|f| source.locate(f))?;
    Ok(Loaded {
        source,
        case,
        path: path.to_owned(),
    })
}

impl Loaded {
    /// Builds the scene.
    ///
    /// # Errors
    /// At file, line and column.
    pub fn build(&self, path: &SearchPath) -> Result<Scene, InputError> {
        if self.case.dimension == 2 {
            Ok(Scene::Plane(Box::new(self.build_in::<Plane>(path)?)))
        } else {
            Ok(Scene::Solid(Box::new(self.build_in::<Solid>(path)?)))
        }
    }

    /// Builds the scene in a dimension that must be the case's.
    ///
    /// # Errors
    /// At file, line and column.
    pub fn build_in<S: Dimensional>(&self, path: &SearchPath) -> Result<Built<S>, InputError> {
        let shelf = Shelf::beside(&self.path);
        let (densities, mut materials) = self.materials(&shelf)?;
        let laws = interfaces::build(&self.case, &self.source, &shelf, path)?;
        materials.extend(laws.files);
        let mut builder = Builder::<S> {
            case: &self.case,
            source: &self.source,
            folder: self.path.parent().map(Path::to_owned).unwrap_or_default(),
            densities: densities
                .into_iter()
                .map(|(n, (k, d))| (n, (k, d * self.case.inertia_scaling)))
                .collect(),
            files: BTreeMap::new(),
            origins: Vec::new(),
            bodies: Bodies::default(),
            shapes: Shapes {
                balls: Vec::new(),
                surfaces: Vec::new(),
                periodic: Periodic {
                    period: [
                        self.case.periodic.x,
                        self.case.periodic.y,
                        self.case.periodic.z,
                    ],
                },
            },
        };
        builder.grains()?;
        builder.first_bodies()?;
        let names = builder
            .bodies
            .driven
            .iter()
            .map(|d| d.name.clone())
            .collect();
        let simulation = builder.finish(laws.interfaces, laws.table)?;
        Ok(Built {
            simulation,
            materials,
            names,
        })
    }

    /// Density of a material of the case (kg/m^3), without any scaling of inertia.
    pub fn density(&self, name: &str) -> Option<f64> {
        let (densities, _) = self.materials(&Shelf::beside(&self.path)).ok()?;
        densities.get(name).map(|d| d.1)
    }

    /// Densities by material, and the texts of the files.
    #[allow(clippy::type_complexity)]
    fn materials(
        &self,
        shelf: &Shelf,
    ) -> Result<(BTreeMap<String, (u16, f64)>, Vec<(String, String)>), InputError> {
        let (mut densities, mut texts) = (BTreeMap::new(), Vec::new());
        for (k, (name, file)) in self.case.materials.iter().enumerate() {
            let source = shelf.read(file).map_err(|e| match e {
                Err(error) => error,
                Ok(missing) => self.source.locate(
                    Fault::new(
                        format!("materials.{name}"),
                        format!("there is no file `{file}.ron` in materials/"),
                    )
                    .expected(format!("one of {}", missing.available))
                    .nearest(missing.nearest.as_deref()),
                ),
            })?;
            let material: Material = source.parse()?;
            let density = material.density.value;
            if !(density.is_finite() && density > 0.0) {
                return Err(source.error_at(
                    "density.value",
                    format!("a density must be positive, got {density}"),
                ));
            }
            densities.insert(name.clone(), (k as u16, density));
            if !texts.iter().any(|t: &(String, String)| t.0 == *file) {
                texts.push((file.clone(), source.text().to_owned()));
            }
        }
        Ok((densities, texts))
    }
}

struct Builder<'a, S: Space> {
    case: &'a Case,
    source: &'a Source,
    folder: PathBuf,
    densities: BTreeMap<String, (u16, f64)>,
    files: BTreeMap<String, SceneFile>,
    bodies: Bodies<S>,
    shapes: Shapes<S>,
    /// Where the case writes each body: the place in `grains`, in that list, or in `bodies`.
    origins: Vec<Origin>,
}

/// The place of a body in the case.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// Of one of `grains`, and which of its list where it has one.
    Grain(usize, Option<usize>),
    /// One of `bodies`.
    Body(usize),
}

impl Origin {
    /// Its dotted path.
    pub fn path(self) -> String {
        match self {
            Self::Grain(k, None) => format!("grains.{k}"),
            Self::Grain(k, Some(g)) => format!("grains.{k}.grains.{g}"),
            Self::Body(k) => format!("bodies.{k}"),
        }
    }
}

/// A grain to be: place, radius, material, density, velocity, spin, and where the case has it.
type Seed<S> = (
    <S as Space>::Vector,
    f64,
    u16,
    f64,
    <S as Space>::Vector,
    <S as Space>::Spin,
    Origin,
);

/// A surface and its offset in the frame of its body.
type Placed<S> = (<S as Space>::Vector, Box<dyn Surface<S>>);

/// More grains than memory holds are a slip of the keyboard.
const MOST_GRAINS: usize = 10_000_000;

impl<S: Dimensional> Builder<'_, S> {
    fn fail(&self, path: impl Into<String>, message: impl Into<String>) -> InputError {
        self.source.locate(Fault::new(path, message))
    }

    fn material(&self, path: &str, name: &str) -> Result<(u16, f64), InputError> {
        self.densities.get(name).copied().ok_or_else(|| {
            let names: Vec<&str> = self.densities.keys().map(String::as_str).collect();
            self.source.locate(
                Fault::new(path, format!("the case has no material `{name}`"))
                    .expected(format!("one of {}", names.join(", ")))
                    .nearest(super::source::nearest(name, names.iter().copied())),
            )
        })
    }

    fn vector(&self, path: &str, values: &[f64]) -> Result<S::Vector, InputError> {
        if values.is_empty() {
            return Ok(S::Vector::null());
        }
        if values.len() != S::D {
            let message = format!(
                "{} components in a case of dimension {}",
                values.len(),
                S::D
            );
            return Err(self
                .source
                .locate(Fault::new(path, message).expected(format!("{} numbers", S::D))));
        }
        if values.iter().any(|x| !x.is_finite()) {
            return Err(self.fail(path, "the components must be finite numbers"));
        }
        Ok(S::Vector::from_slice(values))
    }

    fn radius(&self, path: &str, radius: f64) -> Result<f64, InputError> {
        if radius.is_finite() && radius > 0.0 {
            return Ok(radius);
        }
        Err(self.source.locate(Fault::new(
            path,
            format!("a radius must be positive, got {radius}"),
        )))
    }

    fn scene_file(&mut self, file: &str) -> Result<SceneFile, InputError> {
        if let Some(scene) = self.files.get(file) {
            return Ok(scene.clone());
        }
        let scene = scene_file::read(&self.folder.join(file), S::D)?;
        self.files.insert(file.to_owned(), scene.clone());
        Ok(scene)
    }

    fn grains(&mut self) -> Result<(), InputError> {
        let mut found: Vec<Seed<S>> = Vec::new();
        for (k, spec) in self.case.grains.iter().enumerate() {
            let here = format!("grains.{k}");
            match spec {
                GrainSpec::List { material, grains } => {
                    let (m, density) = self.material(&format!("{here}.material"), material)?;
                    for (g, grain) in grains.iter().enumerate() {
                        let here = format!("{here}.grains.{g}");
                        let at = self.vector(&format!("{here}.at"), &grain.at)?;
                        let radius = self.radius(&format!("{here}.radius"), grain.radius)?;
                        let velocity = self.vector(&format!("{here}.velocity"), &grain.velocity)?;
                        if !grain.spin.is_empty() && grain.spin.len() != S::Spin::N {
                            return Err(self.fail(
                                format!("{here}.spin"),
                                format!("a spin has {} components here", S::Spin::N),
                            ));
                        }
                        if grain.spin.iter().any(|x| !x.is_finite()) {
                            return Err(self.fail(
                                format!("{here}.spin"),
                                "the components must be finite numbers",
                            ));
                        }
                        found.push((
                            at,
                            radius,
                            m,
                            density,
                            velocity,
                            S::Spin::from_slice(&grain.spin),
                            Origin::Grain(k, Some(g)),
                        ));
                    }
                }
                GrainSpec::Lattice {
                    material,
                    count,
                    radius,
                    low,
                    high,
                } => {
                    let (m, density) = self.material(&format!("{here}.material"), material)?;
                    for r in [radius.0, radius.1] {
                        self.radius(&format!("{here}.radius"), r)?;
                    }
                    if radius.1 < radius.0 {
                        return Err(
                            self.fail(format!("{here}.radius"), "the smallest radius comes first")
                        );
                    }
                    for (name, corner) in [("low", low), ("high", high)] {
                        let path = format!("{here}.{name}");
                        self.vector(&path, corner)?;
                        if corner.is_empty() {
                            return Err(self.source.locate(
                                Fault::new(path, "a corner of the box is empty")
                                    .expected(format!("{} numbers", S::D)),
                            ));
                        }
                    }
                    if *count > MOST_GRAINS {
                        return Err(self.source.locate(
                            Fault::new(
                                format!("{here}.count"),
                                format!("{count} grains are too many"),
                            )
                            .expected(format!("at most {MOST_GRAINS}")),
                        ));
                    }
                    let periodic = self.shapes.periodic.period[0].is_some();
                    let list =
                        sample::lattice(S::D, periodic, *count, *radius, low, high, self.case.seed);
                    if list.len() < *count {
                        let message =
                            format!("only {} of {count} grains fit into the box", list.len());
                        return Err(self.source.locate(
                            Fault::new(format!("{here}.count"), message)
                                .expected("a larger box, smaller grains or fewer"),
                        ));
                    }
                    let none = (S::Vector::null(), S::Spin::null());
                    found.extend(list.into_iter().map(|(x, r)| {
                        let at = S::Vector::from_slice(&x);
                        (at, r, m, density, none.0, none.1, Origin::Grain(k, None))
                    }));
                }
                GrainSpec::Scene {
                    file,
                    material,
                    walls,
                } => {
                    let (m, density) = self.material(&format!("{here}.material"), material)?;
                    let scene = self.scene_file(file)?;
                    let none = (S::Vector::null(), S::Spin::null());
                    found.extend(scene.balls.iter().map(|(x, r)| {
                        let at = S::Vector::from_slice(x);
                        (at, *r, m, density, none.0, none.1, Origin::Grain(k, None))
                    }));
                    if let Some(walls) = walls {
                        let (m, _) = self.material(&format!("{here}.walls"), walls)?;
                        for (w, wall) in scene.walls.iter().enumerate() {
                            let shape = HalfSpace {
                                normal: S::Vector::from_slice(&wall.normal),
                                shown: 1.0,
                            };
                            self.add_wall(
                                format!("wall_{w}"),
                                S::Vector::from_slice(&wall.at),
                                Box::new(shape),
                                m,
                            );
                            self.origins.push(Origin::Grain(k, None));
                        }
                    }
                }
            }
        }
        // Neighbours in space become neighbours in memory.
        let width = 4.0 * found.iter().map(|g| g.1).fold(0.0, f64::max);
        let cell = |x: &S::Vector| -> Vec<i64> {
            (0..S::D)
                .rev()
                .map(|k| (x[k] / width).floor() as i64)
                .collect()
        };
        if width > 0.0 {
            found.sort_by_cached_key(|g| cell(&g.0));
        }
        for (at, radius, material, density, velocity, spin, origin) in found {
            let body = self.bodies.add_ball(at, radius, density);
            self.origins.push(origin);
            self.bodies.velocity[body as usize] = velocity;
            self.bodies.spin[body as usize] = spin;
            self.shapes.balls.push(Ball {
                body,
                radius,
                offset: S::Vector::null(),
                material,
            });
        }
        Ok(())
    }

    fn add_wall(&mut self, name: String, at: S::Vector, shape: Box<dyn Surface<S>>, material: u16) {
        let body = self.bodies.add(at, 1.0, 1.0, 1.0);
        let dofs = vec![crate::bodies::Dof::Fixed; S::D + S::Spin::N];
        self.bodies.drive(Driven { name, body, dofs });
        self.shapes.surfaces.push(Carried {
            body,
            offset: S::Vector::null(),
            shape,
            material,
        });
    }

    fn first_bodies(&mut self) -> Result<(), InputError> {
        for (k, spec) in self.case.bodies.iter().enumerate() {
            self.first_body(&format!("bodies.{k}"), spec)?;
            self.origins.push(Origin::Body(k));
        }
        Ok(())
    }

    fn first_body(&mut self, here: &str, spec: &BodySpec) -> Result<(), InputError> {
        let (material, density) = self.material(&format!("{here}.material"), &spec.material)?;
        let position = self.vector(&format!("{here}.position"), &spec.position)?;
        let mut balls: Vec<(S::Vector, f64)> = Vec::new();
        let mut surfaces: Vec<Placed<S>> = Vec::new();
        for (s, shape) in spec.shapes.iter().enumerate() {
            let here = format!("{here}.shapes.{s}");
            match shape {
                ShapeSpec::Balls(list) => {
                    for (x, r) in list {
                        balls.push((self.vector(&here, x)?, self.radius(&here, *r)?));
                    }
                }
                ShapeSpec::Cluster { file, name } => {
                    let scene = self.scene_file(file)?;
                    let cluster = scene.clusters.iter().find(|c| c.0 == *name);
                    let names = || scene.clusters.iter().map(|c| c.0.as_str());
                    let Some(cluster) = cluster else {
                        return Err(self.source.locate(
                            Fault::new(
                                format!("{here}.name"),
                                format!("the scene has no cluster `{name}`"),
                            )
                            .expected(format!("one of {}", names().collect::<Vec<_>>().join(", ")))
                            .nearest(super::source::nearest(name, names())),
                        ));
                    };
                    balls.extend(
                        cluster
                            .1
                            .iter()
                            .map(|(x, r)| (S::Vector::from_slice(x), *r)),
                    );
                }
                other => surfaces.push(self.surface(&here, other)?),
            }
        }
        if balls.is_empty() && surfaces.is_empty() {
            return Err(self.fail(
                format!("{here}.shapes"),
                "a first body needs at least one shape",
            ));
        }
        // A body made of balls has its frame at their centre of mass.
        let weight: f64 = balls.iter().map(|b| S::ball_volume(b.1)).sum();
        let mut centre = S::Vector::null();
        if weight > 0.0 && surfaces.is_empty() {
            for (x, r) in &balls {
                centre += *x * (S::ball_volume(*r) / weight);
            }
        }
        let inertia: f64 = balls
            .iter()
            .map(|(x, r)| {
                let d = *x - centre;
                density * S::ball_volume(*r) * (S::BALL_INERTIA * r * r + d.dot(&d))
            })
            .sum();
        let dofs = spec.ordered(S::D);
        self.check_dofs(here, spec, weight > 0.0)?;
        let mass = spec
            .mass
            .unwrap_or(if weight > 0.0 { density * weight } else { 1.0 });
        let inertia = spec
            .inertia
            .unwrap_or(if inertia > 0.0 { inertia } else { 1.0 });
        let only = if surfaces.is_empty() && balls.len() == 1 {
            balls[0].1
        } else {
            0.0
        };
        let length = if only > 0.0 {
            only
        } else {
            (inertia / mass).sqrt()
        };
        let body = self.bodies.add(position + centre, mass, inertia, length);
        self.bodies.drive(Driven {
            name: spec.name.clone(),
            body,
            dofs,
        });
        for (x, radius) in balls {
            let offset = if only > 0.0 {
                S::Vector::null()
            } else {
                x - centre
            };
            self.shapes.balls.push(Ball {
                body,
                radius,
                offset,
                material,
            });
        }
        for (offset, shape) in surfaces {
            self.shapes.surfaces.push(Carried {
                body,
                offset,
                shape,
                material,
            });
        }
        Ok(())
    }

    fn check_dofs(&self, here: &str, spec: &BodySpec, has_mass: bool) -> Result<(), InputError> {
        let dofs = spec.ordered(S::D);
        let moves = crate::bodies::Dof::yields;
        if dofs.iter().any(moves) && spec.mass.is_none() && !has_mass {
            return Err(self.fail(
                here,
                format!(
                    "the body `{}` moves under forces, so it needs a `mass`",
                    spec.name
                ),
            ));
        }
        if dofs[S::D..].iter().any(moves) {
            if S::D == 3 {
                return Err(self.fail(format!("{here}.dofs"), "a first body cannot turn freely in three dimensions yet; fix or drive rx, ry and rz"));
            }
            if spec.inertia.is_none() && !has_mass {
                return Err(self.fail(
                    here,
                    format!(
                        "the body `{}` turns under moments, so it needs an `inertia`",
                        spec.name
                    ),
                ));
            }
        }
        Ok(())
    }

    fn surface(&self, here: &str, shape: &ShapeSpec) -> Result<Placed<S>, InputError> {
        let period = self.shapes.periodic.period[0];
        let null = S::Vector::null();
        let bad = |message: String| self.fail(here, message);
        match shape {
            ShapeSpec::HalfSpace { normal, at } => {
                let n = self.vector(&format!("{here}.normal"), normal)?;
                if n.norm() == 0.0 {
                    return Err(self.fail(format!("{here}.normal"), "a normal must not be null"));
                }
                let at = self.vector(&format!("{here}.at"), at)?;
                let shown = period.map_or(1.0, |p| 0.5 * p);
                Ok((
                    at,
                    Box::new(HalfSpace {
                        normal: n * (1.0 / n.norm()),
                        shown,
                    }),
                ))
            }
            ShapeSpec::Profile { points, side } => {
                // A chain that spans the period repeats.
                let spans = |p: f64| {
                    points.len() > 1
                        && ((points[points.len() - 1].0 - points[0].0) / p - 1.0).abs() < 1e-9
                };
                let period = period.filter(|p| spans(*p));
                Ok((
                    null,
                    S::profile(points.clone(), *side, period).map_err(bad)?,
                ))
            }
            ShapeSpec::RoughProfile {
                points,
                rms,
                hurst,
                longest,
                shortest,
                height,
                side,
            } => {
                let Some(period) = period else {
                    return Err(bad("a rough profile needs a periodic x".into()));
                };
                let valid = *points >= 3
                    && *rms >= 0.0
                    && *shortest > 0.0
                    && longest.is_none_or(|l| l > 0.0)
                    && rms.is_finite()
                    && hurst.is_finite();
                if !valid || *points > 10_000_000 {
                    return Err(bad(
                        "a rough profile needs 3 to 10,000,000 points, rms >= 0, shortest > 0 and longest > 0".into(),
                    ));
                }
                // Rail and wheel must not be each other's image.
                let salt = here
                    .bytes()
                    .fold(17u64, |h, b| h.wrapping_mul(31).wrapping_add(u64::from(b)));
                let longest = longest.unwrap_or(period);
                let z = profile::rough(
                    *points,
                    period,
                    *rms,
                    *hurst,
                    longest,
                    *shortest,
                    self.case.seed ^ salt,
                );
                let x = |k: usize| period * k as f64 / *points as f64;
                let mut chain: Vec<(f64, f64)> = z
                    .iter()
                    .enumerate()
                    .map(|(k, z)| (x(k), height + z))
                    .collect();
                chain.push((period, chain[0].1));
                Ok((null, S::profile(chain, *side, Some(period)).map_err(bad)?))
            }
            ShapeSpec::HeightField {
                points,
                spacing,
                heights,
                rms,
            } => {
                let count = points.0.saturating_mul(points.1);
                if count > 10_000_000 {
                    return Err(bad("a height field has at most 10,000,000 points".into()));
                }
                let heights = match rms {
                    Some(rms) => profile::noise(count, *rms, self.case.seed ^ 0x5eed),
                    None => heights.clone(),
                };
                let p = self.shapes.periodic.period;
                let fits = |axis: usize, n: usize, s: f64| {
                    p[axis].is_some_and(|p| (n as f64 * s / p - 1.0).abs() < 1e-9)
                };
                let periodic = [fits(0, points.0, spacing.0), fits(1, points.1, spacing.1)];
                Ok((
                    null,
                    S::height_field(*points, *spacing, heights, periodic).map_err(bad)?,
                ))
            }
            ShapeSpec::Balls(_) | ShapeSpec::Cluster { .. } => {
                Err(bad("balls are not a surface".into()))
            }
        }
    }

    fn finish(
        self,
        laws: Vec<Interface>,
        table: crate::contact::detect::LawTable,
    ) -> Result<Simulation<S>, InputError> {
        let case = self.case;
        let smallest = self
            .shapes
            .balls
            .iter()
            .map(|b| b.radius)
            .fold(f64::INFINITY, f64::min);
        let smallest = if smallest.is_finite() { smallest } else { 1.0 };
        let alert = case.detection.alert.unwrap_or(0.05 * smallest);
        let skin = case.detection.skin.unwrap_or(0.3 * smallest);
        let gravity = self.vector("gravity", &case.gravity)?;
        self.refuse_small_period(alert + skin)?;
        let (source, mut simulation) = (
            self.source,
            Simulation::new(self.bodies, self.shapes, laws, table, alert, skin),
        );
        let service = Demands::of(&simulation).service(case.solver.method);
        if let Service::Refuses(reason) = service {
            return Err(self.source.locate(Fault::new("solver.method", reason)));
        }
        simulation.gravity = gravity;
        simulation.correction = case.solver.correction;
        simulation.coupling = case.coupling;
        simulation.scheme = Scheme {
            h: case.time.step,
            theta: case.time.theta,
        };
        simulation.solver = solve::Options {
            tolerance: case.solver.tolerance,
            norm: case.solver.norm,
            max_iterations: case.solver.max_iterations,
            test_every: case.solver.test_every,
            relaxation: case.solver.relaxation,
            accelerated: true,
            method: case.solver.method,
            parallel: false,
        };
        super::check::overlaps(&mut simulation, smallest, &self.origins)
            .map_err(|f| source.locate(f))?;
        Ok(simulation)
    }

    /// Two balls must not touch each other twice around a period.
    fn refuse_small_period(&self, reach: f64) -> Result<(), InputError> {
        let widest = self
            .shapes
            .balls
            .iter()
            .map(|b| b.radius)
            .fold(0.0, f64::max);
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let period = self.shapes.periodic.period[k];
            if period.is_some_and(|p| 2.0 * (2.0 * widest + reach) > p) && reach > 2.0 * widest {
                let message = format!(
                    "with the skin, grains see each other {reach:e} m apart, which reaches twice around the period `periodic.{name}`; make it smaller"
                );
                return Err(self.fail("detection.alert".to_owned(), message));
            }
            if period.is_some_and(|p| p < 8.0 * widest) {
                let message = format!(
                    "the period must be at least 4 diameters of the largest grain ({:e} m)",
                    8.0 * widest
                );
                return Err(self.fail(format!("periodic.{name}"), message));
            }
        }
        Ok(())
    }
}
