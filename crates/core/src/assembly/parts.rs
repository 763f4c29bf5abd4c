//! The parts of a scene in one dimension: bodies, shapes, wear and dynamical systems.

use super::{
    AnySystem, AnyUnion, Assembly, ConvexBody, Inertia, InitialState, MassProperties,
    MaterialDensity, Overcrowding, RecordedPiece,
};
use crate::bodies::{Bodies, Dof, Driven, DynamicalSystem, tensor};
use crate::contact::detect::LawTable;
use crate::geometry::any_shape::{AnySurface, same};
use crate::geometry::convex::Core;
use crate::geometry::periodic::Periodic;
use crate::geometry::shape::{Ball, Carried, HalfSpace, Shapes};
use crate::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike, spin_about};
use crate::laws::Interface;
use crate::step::Simulation;
use crate::view::AnySimulation;
use crate::wear::Scar;

/// The parts of a scene while it is assembled.
#[derive(Debug)]
pub struct SceneParts<S: Space> {
    /// The bodies.
    pub bodies: Bodies<S>,
    /// Shapes of the bodies.
    pub shapes: Shapes<S>,
    /// Surfaces that wear.
    scars: Vec<Scar<S>>,
    /// Bodies that are more than rigid.
    systems: Vec<Box<dyn DynamicalSystem<S>>>,
}

/// The parts of a scene of either dimension.
#[derive(Debug)]
pub enum AnySceneParts<'a> {
    /// In two dimensions.
    Plane(&'a mut SceneParts<Dim2>),
    /// In three dimensions.
    Space(&'a mut SceneParts<Dim3>),
}

/// Rotates a vector by a rotation given in numbers; `None` if these are not a rotation.
pub(super) fn turned<S: Space>(rotation: &[f64; 4], v: [f64; 3]) -> Option<[f64; 3]> {
    let rotation = S::rotation_from(rotation)?;
    Some(S::rotate(&rotation, &S::Vector::from_slice(&v)).padded())
}

/// Returns a half-space with this outward normal, drawn over a distance `shown` (m).
pub(super) fn half_space(dimension: usize, normal: [f64; 3], shown: f64) -> AnySurface {
    match dimension {
        2 => AnySurface::Plane(Box::new(plane::<Dim2>(normal, shown))),
        _ => AnySurface::Space(Box::new(plane::<Dim3>(normal, shown))),
    }
}

fn plane<S: Space>(normal: [f64; 3], shown: f64) -> HalfSpace<S> {
    HalfSpace {
        normal: S::Vector::from_slice(&normal),
        shown,
    }
}

impl<S: Space> SceneParts<S> {
    /// Creates a scene without bodies, in a periodic cell.
    pub fn new(periodic: Periodic) -> Self {
        Self {
            bodies: Bodies::default(),
            shapes: Shapes {
                balls: Vec::new(),
                pieces: Vec::new(),
                surfaces: Vec::new(),
                periodic,
            },
            scars: Vec::new(),
            systems: Vec::new(),
        }
    }

    fn set_motion(&mut self, body: u32, start: &InitialState) {
        self.bodies.velocity[body as usize] = S::Vector::from_slice(&start.velocity);
        self.bodies.spin[body as usize] = spin_about::<S>(&start.spin);
    }

    /// Removes the bodies whose flag is false, with their shapes. Called before wear and dynamical
    /// systems are added, which are not renumbered.
    pub fn keep(&mut self, kept: &[bool]) {
        let moved = self.bodies.keep(kept);
        let at = |body: &mut u32| match moved[*body as usize] {
            Some(new) => {
                *body = new;
                true
            }
            None => false,
        };
        self.shapes.balls.retain_mut(|ball| at(&mut ball.body));
        self.shapes.pieces.retain_mut(|piece| at(&mut piece.body));
        self.shapes
            .surfaces
            .retain_mut(|surface| at(&mut surface.body));
    }
}

impl<S: Space> Assembly for SceneParts<S> {
    fn dimension(&self) -> usize {
        S::D
    }
    fn periodic(&self) -> &Periodic {
        &self.shapes.periodic
    }
    fn body_count(&self) -> usize {
        self.bodies.len()
    }
    fn driven(&self) -> &[Driven] {
        &self.bodies.driven
    }
    fn radii(&self) -> Vec<f64> {
        self.all_radii()
    }
    fn has_loose_shapes(&self) -> bool {
        let carried = |b: u32| self.bodies.driven.iter().any(|d| d.body == b);
        self.shapes.balls.iter().any(|b| !carried(b.body))
            || self.shapes.pieces.iter().any(|p| !carried(p.body))
    }
    fn thinnest_grain(&self) -> f64 {
        let grain = self.bodies.grain_flags();
        let balls = self.shapes.balls.iter().map(|b| (b.body, b.radius));
        let pieces = self.shapes.pieces.iter().map(|p| {
            let (distance, _) = p.core.outward(&S::Vector::zero());
            (p.body, (-distance).max(0.0) + p.rounding)
        });
        let of_grains = balls.chain(pieces).filter(|(b, _)| grain[*b as usize]);
        of_grains
            .map(|(_, radius)| radius)
            .fold(f64::INFINITY, f64::min)
    }
    fn surface_count(&self) -> usize {
        self.shapes.surfaces.len()
    }
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>> {
        let lines = self.shapes.surfaces[surface].shape.outline().into_iter();
        lines
            .map(|line| line.iter().map(VectorLike::padded).collect())
            .collect()
    }
    fn worn_names(&self) -> Vec<&str> {
        self.scars.iter().map(|s| s.name.as_str()).collect()
    }

    fn add_ball(
        &mut self,
        radius: f64,
        (material, density): MaterialDensity,
        start: &InitialState,
    ) -> u32 {
        let at = S::Vector::from_slice(&start.position);
        let body = self.bodies.add_ball(at, radius, density);
        let rotation = start.rotation.and_then(|r| S::rotation_from(&r));
        self.bodies.rotation[body as usize] = rotation.unwrap_or(S::identity());
        self.set_motion(body, start);
        self.shapes.balls.push(Ball {
            body,
            radius,
            offset: S::Vector::zero(),
            material,
            area: S::Vector::zero(),
        });
        body
    }

    fn add_wall(&mut self, name: String, at: [f64; 3], normal: [f64; 3], material: u16) {
        let at = S::Vector::from_slice(&at);
        let body = self.bodies.add(at, 1.0, 1.0, 1.0);
        let dofs = vec![Dof::Fixed; S::D + S::Spin::N];
        self.bodies.drive(Driven { name, body, dofs });
        self.shapes.surfaces.push(Carried {
            body,
            offset: S::Vector::zero(),
            shape: Box::new(plane::<S>(normal, 1.0)),
            material,
        });
    }

    fn add_union(
        &mut self,
        union: AnyUnion,
        mass_properties: MassProperties,
        material: u16,
        start: &InitialState,
    ) -> u32 {
        let Some(union) = union.into_dimension::<S>() else {
            unreachable!("the union has the dimension of the scene");
        };
        let centre = union.centre();
        let (volume, own) = (union.volume(), union.inertia(&centre));
        let only = union.only_ball();
        let (mass, inertia, length) = match mass_properties {
            MassProperties::Grain(density) => {
                let length = only.unwrap_or((tensor::mean::<S>(&own) / volume).sqrt());
                (density * volume, own.scaled(density), length)
            }
            MassProperties::First(mass, inertia) => {
                let inertia = match inertia {
                    Inertia::Uniform(inertia) => S::Tensor::uniform(inertia),
                    Inertia::Mean(density) => S::Tensor::uniform(tensor::mean::<S>(&own) * density),
                    Inertia::OfShapes(density) => own.scaled(density),
                };
                let gyration = (tensor::mean::<S>(&inertia) / mass).sqrt();
                let length = only.filter(|radius| *radius > 0.0).unwrap_or(gyration);
                (mass, inertia, length)
            }
        };
        let position = S::Vector::from_slice(&start.position) + centre;
        let body = self.bodies.add_shaped(position, mass, &inertia, length);
        self.set_motion(body, start);
        let balls = union.balls.into_iter().map(|(x, radius)| Ball {
            body,
            radius,
            offset: match only {
                Some(_) => S::Vector::zero(),
                None => x - centre,
            },
            material,
            area: S::Vector::zero(),
        });
        self.shapes.balls.extend(balls);
        for part in union.parts {
            let offset = part.centre - centre;
            self.shapes
                .pieces
                .push(part.carried(body, offset, material));
        }
        let carried = |(offset, shape)| Carried {
            body,
            offset,
            shape,
            material,
        };
        let surfaces = union.surfaces.into_iter().map(carried);
        self.shapes.surfaces.extend(surfaces);
        body
    }

    fn add_block(&mut self, block: ConvexBody, (material, density): MaterialDensity) -> u32 {
        let Some(part) = block.part.into_dimension::<S>() else {
            unreachable!("the part has the dimension of the scene");
        };
        let inertia = block.inertia.map_or(part.inertia, S::Tensor::uniform);
        let length = (tensor::mean::<S>(&inertia) / block.volume).sqrt();
        let (mass, inertia) = (density * block.volume, inertia.scaled(density));
        let at = S::Vector::from_slice(&block.start.position);
        let body = self.bodies.add_shaped(at, mass, &inertia, length);
        self.set_motion(body, &block.start);
        let piece = part.carried(body, S::Vector::from_slice(&block.offset), material);
        self.shapes.pieces.push(piece);
        body
    }

    fn add_weighed(
        &mut self,
        mass: f64,
        inertia: &[f64; 9],
        factor: f64,
        length: f64,
        start: &InitialState,
    ) -> Result<u32, String> {
        let n = S::Spin::N;
        let entry = |i: usize, j: usize| inertia[3 * i + j];
        let at = S::Vector::from_slice(&start.position);
        if !at.is_finite() {
            return Err("its position, mass or inertia is not a valid number".to_owned());
        }
        let alike =
            (0..n).all(|i| (0..n).all(|j| entry(i, j) == if i == j { entry(0, 0) } else { 0.0 }));
        let body = if alike {
            self.bodies.add(at, mass, entry(0, 0) * factor, length)
        } else {
            let mut axes = [S::Spin::zero(); 3];
            for (i, axis) in axes.iter_mut().enumerate().take(n) {
                axis[i] = 1.0;
            }
            let mut inertia = S::Tensor::uniform(0.0);
            for i in 0..n {
                for j in 0..n {
                    inertia = inertia + S::Tensor::dyad(&axes[i], &axes[j]).scaled(entry(i, j));
                }
            }
            self.bodies
                .add_shaped(at, mass, &inertia.scaled(factor), length)
        };
        if let Some(numbers) = &start.rotation {
            let rotation = S::rotation_from(numbers);
            self.bodies.rotation[body as usize] =
                rotation.ok_or_else(|| "its orientation is not a rotation".to_owned())?;
        }
        self.set_motion(body, start);
        Ok(body)
    }

    fn carry_ball(
        &mut self,
        body: u32,
        offset: [f64; 3],
        radius: f64,
        material: u16,
    ) -> Result<(), String> {
        let offset = S::Vector::from_slice(&offset);
        if !(radius.is_finite() && radius > 0.0 && offset.is_finite()) {
            return Err(format!("a ball of it has the radius {radius}"));
        }
        self.shapes.balls.push(Ball {
            body,
            radius,
            offset,
            material,
            area: S::Vector::zero(),
        });
        Ok(())
    }

    fn carry_piece(
        &mut self,
        body: u32,
        piece: RecordedPiece,
        material: u16,
    ) -> Result<(), String> {
        self.shapes.pieces.push(piece.carried(body, material)?);
        Ok(())
    }

    fn drive(&mut self, driven: Driven) {
        self.bodies.drive(driven);
    }

    fn add_scar(&mut self, surface: usize, name: String, thickness: f64, every: u64) -> bool {
        let carried = &self.shapes.surfaces[surface];
        let scar = Scar::new(name, surface, carried, thickness, every);
        let wears = scar.is_some();
        self.scars.extend(scar);
        wears
    }

    fn add_system(&mut self, system: AnySystem) {
        let system = match system {
            AnySystem::Plane(system) => same(system),
            AnySystem::Space(system) => same(system),
        };
        match system {
            Some(system) => self.systems.push(system),
            None => unreachable!("the system has the dimension of the scene"),
        }
    }

    fn most_pairs(&self, reach: f64) -> f64 {
        self.pairs_of_bodies(reach)
    }

    fn overcrowding(
        &self,
        reach: f64,
        most: &dyn Fn(usize) -> usize,
        table: &LawTable,
    ) -> Option<Overcrowding> {
        self.find_overcrowding(reach, most, table)
    }

    fn parts(&mut self) -> AnySceneParts<'_> {
        let parts: &mut dyn std::any::Any = self;
        if parts.is::<SceneParts<Dim2>>() {
            return match parts.downcast_mut() {
                Some(plane) => AnySceneParts::Plane(plane),
                None => unreachable!("it is of this type"),
            };
        }
        match parts.downcast_mut() {
            Some(space) => AnySceneParts::Space(space),
            None => unreachable!("there are two and three dimensions"),
        }
    }

    fn into_simulation(
        self: Box<Self>,
        laws: Vec<Interface>,
        table: LawTable,
        alert: f64,
        skin: f64,
    ) -> (AnySimulation, Vec<Option<usize>>) {
        let parts = *self;
        let (bodies, shapes) = (parts.bodies, parts.shapes);
        let mut simulation = Simulation::new(bodies, shapes, laws, table, alert, skin);
        let mut added = Vec::with_capacity(parts.systems.len());
        for system in parts.systems {
            let surface = simulation.shapes.surfaces.len();
            simulation.add_system(system);
            added.push((simulation.shapes.surfaces.len() > surface).then_some(surface));
        }
        for scar in parts.scars {
            simulation.follow_wear(scar);
        }
        (simulation.into(), added)
    }
}
