//! Grains and the walls that come with scenes.

use super::{Builder, Dimensional, Origin};
use crate::case::GrainSpec;
use crate::sample;
use crate::source::{Fault, InputError};
use fretwork_core::bodies::Driven;
use fretwork_core::geometry::shape::{Ball, Carried, HalfSpace, Surface};
use fretwork_core::geometry::space::{Space, VectorLike};

/// More grains than memory holds are a slip of the keyboard: those of a file,
pub(super) const MAX_READ: usize = 10_000_000;
/// and those that a line of the case makes.
pub(super) const MAX_MADE: usize = 2_000_000;

/// A ball to be.
pub(super) struct Seed<S: Space> {
    /// Where its centre stands (m).
    pub at: S::Vector,
    /// Radius (m).
    pub radius: f64,
    /// Material, and its density (kg/m^3).
    pub of: (u16, f64),
    /// Orientation.
    pub rotation: S::Rotation,
    /// Velocity (m/s).
    pub velocity: S::Vector,
    /// Angular velocity (rad/s).
    pub spin: S::Spin,
    /// Where the case has it.
    pub origin: Origin,
}

impl<S: Space> Seed<S> {
    /// One at rest.
    pub fn still(at: S::Vector, radius: f64, of: (u16, f64), origin: Origin) -> Self {
        Self {
            at,
            radius,
            of,
            rotation: S::identity(),
            velocity: S::Vector::zero(),
            spin: S::Spin::zero(),
            origin,
        }
    }
}

impl<S: Dimensional> Builder<'_, S> {
    pub(super) fn grains(&mut self) -> Result<(), InputError> {
        let mut found: Vec<Seed<S>> = Vec::new();
        let mut shaped = Vec::new();
        for (k, spec) in self.case.grains.iter().enumerate() {
            let here = format!("grains.{k}");
            match spec {
                GrainSpec::List { material, grains } => {
                    let of = self.material(&format!("{here}.material"), material)?;
                    for (g, grain) in grains.iter().enumerate() {
                        let here = format!("{here}.grains.{g}");
                        let at = self.vector(&format!("{here}.at"), &grain.at)?;
                        let radius = self.radius(&format!("{here}.radius"), grain.radius)?;
                        let velocity = self.vector(&format!("{here}.velocity"), &grain.velocity)?;
                        let spin = self.spin(&format!("{here}.spin"), &grain.spin)?;
                        found.push(Seed {
                            velocity,
                            spin,
                            ..Seed::still(at, radius, of, Origin::Grain(k, Some(g)))
                        });
                    }
                }
                GrainSpec::Lattice {
                    material,
                    count,
                    radius,
                    low,
                    high,
                } => {
                    let of = self.material(&format!("{here}.material"), material)?;
                    for r in [radius.0, radius.1] {
                        self.radius(&format!("{here}.radius"), r)?;
                    }
                    if radius.1 < radius.0 {
                        return Err(
                            self.fail(format!("{here}.radius"), "the smallest radius comes first")
                        );
                    }
                    for (name, corner) in [("low", low), ("high", high)] {
                        self.corner(&format!("{here}.{name}"), corner)?;
                    }
                    self.few_enough(&format!("{here}.count"), *count, MAX_MADE)?;
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
                    found.extend(list.into_iter().map(|(x, r)| {
                        let at = S::Vector::from_slice(&x);
                        Seed::still(at, r, of, Origin::Grain(k, None))
                    }));
                }
                // After the balls, which stand first in memory.
                GrainSpec::Polygons { .. }
                | GrainSpec::Arch { .. }
                | GrainSpec::Polyhedra { .. }
                | GrainSpec::Clusters { .. }
                | GrainSpec::Voronoi(_)
                | GrainSpec::BlockWall(_) => {}
                GrainSpec::Scene {
                    file,
                    material,
                    walls,
                } => {
                    let of = self.material(&format!("{here}.material"), material)?;
                    let scene = self.scene_file(&here, file)?;
                    found.extend(scene.balls.iter().map(|(x, r)| {
                        let at = S::Vector::from_slice(x);
                        Seed::still(at, *r, of, Origin::Grain(k, None))
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
                GrainSpec::Deposit(spec) => found.extend(self.deposit(k, spec)?),
                GrainSpec::Csv(spec) => found.extend(self.grains_of_csv(k, spec)?),
                GrainSpec::State(spec) => {
                    let (balls, others) = self.grains_of_run(k, spec)?;
                    found.extend(balls);
                    shaped.push(others);
                }
            }
        }
        // Neighbours in space become neighbours in memory.
        let width = 4.0 * found.iter().map(|g| g.radius).fold(0.0, f64::max);
        let cell = |x: &S::Vector| -> Vec<i64> {
            (0..S::D)
                .rev()
                .map(|k| (x[k] / width).floor() as i64)
                .collect()
        };
        if width > 0.0 {
            found.sort_by_cached_key(|g| cell(&g.at));
        }
        for seed in found {
            let (material, density) = seed.of;
            let body = self.bodies.add_ball(seed.at, seed.radius, density);
            self.origins.push(seed.origin);
            self.bodies.rotation[body as usize] = seed.rotation;
            self.bodies.velocity[body as usize] = seed.velocity;
            self.bodies.spin[body as usize] = seed.spin;
            self.shapes.balls.push(Ball {
                body,
                radius: seed.radius,
                offset: S::Vector::zero(),
                material,
            });
        }
        self.polygons()?;
        self.polyhedra()?;
        self.clusters()?;
        for others in shaped {
            self.shaped_grains(others)?;
        }
        Ok(())
    }

    pub(super) fn spin(&self, path: &str, values: &[f64]) -> Result<S::Spin, InputError> {
        if !values.is_empty() && values.len() != S::Spin::N {
            let message = format!("a spin has {} components here", S::Spin::N);
            return Err(self.fail(path, message));
        }
        if values.iter().any(|x| !x.is_finite()) {
            return Err(self.fail(path, "the components must be finite numbers"));
        }
        Ok(S::Spin::from_slice(values))
    }

    /// A corner of a box; it must be there.
    pub(super) fn corner(&self, path: &str, corner: &[f64]) -> Result<S::Vector, InputError> {
        if corner.is_empty() {
            return Err(self.source.locate(
                Fault::new(path, "a corner of the box is empty")
                    .expected(format!("{} numbers", S::D)),
            ));
        }
        self.vector(path, corner)
    }

    pub(super) fn few_enough(
        &self,
        path: &str,
        count: usize,
        most: usize,
    ) -> Result<(), InputError> {
        if count <= most {
            return Ok(());
        }
        let fault = Fault::new(path, format!("{count} grains are too many"));
        let fault = fault.expected(format!("at most {most}"));
        Err(self.source.locate(fault))
    }

    fn add_wall(&mut self, name: String, at: S::Vector, shape: Box<dyn Surface<S>>, material: u16) {
        let body = self.bodies.add(at, 1.0, 1.0, 1.0);
        let dofs = vec![fretwork_core::bodies::Dof::Fixed; S::D + S::Spin::N];
        self.bodies.drive(Driven { name, body, dofs });
        self.shapes.surfaces.push(Carried {
            body,
            offset: S::Vector::zero(),
            shape,
            material,
        });
    }
}
