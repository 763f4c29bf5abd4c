//! The thermal nodes of the bodies of a case.

use crate::case::{BodyHeatSpec, Case, DepthSpec, HeatSpec, StoreSpec};
use crate::source::ValidationError;
use fretwork_core::heat::{
    BodyNodes, Columns, Edge, Grid, HalfSpace, ImposedHeatFlow, Node, PieceAxis, Pieces, Store,
    ThermalMaterial,
};
use fretwork_core::view::RunView;
use std::f64::consts::PI;
use std::ops::Range;

/// Default growth of the spacing with depth.
const GROWTH: f64 = 1.2;
/// Default ratio of the first spacing to the diffusion length of a step.
const FIRST: f64 = 0.3;
/// Default ratio of the depth to the diffusion length of the run.
const DEEP: f64 = 6.0;

/// Nodes of all bodies.
#[derive(Default)]
pub(super) struct Nodes {
    pub list: Vec<Node>,
    pub of_bodies: Vec<BodyNodes>,
    pub columns: Vec<Columns>,
    pub elements: Vec<Edge>,
    /// Nodes of each first body, for [`fretwork_core::heat::Heat::first_bodies`].
    pub first_bodies: Vec<(String, Range<usize>)>,
    pub imposed: Vec<ImposedHeatFlow>,
}

/// Inputs from which the nodes of bodies are made.
pub(super) struct Scene<'a> {
    pub case: &'a Case,
    pub spec: &'a HeatSpec,
    pub materials: &'a [ThermalMaterial],
    pub material: &'a [u16],
    pub simulation: &'a dyn RunView,
}

impl Nodes {
    /// Creates the nodes of the bodies of a case.
    pub fn of(
        case: &Case,
        spec: &HeatSpec,
        materials: &[ThermalMaterial],
        material: &[u16],
        simulation: &dyn RunView,
    ) -> Result<Self, ValidationError> {
        let scene = Scene {
            case,
            spec,
            materials,
            material,
            simulation,
        };
        let mut nodes = Self::default();
        let bodies = simulation.bodies();
        let of_systems = nodes.of_systems(&scene)?;
        for (body, surface) in scene.surface_of_grains().into_iter().enumerate() {
            if let Some(carrier) = bodies.carrier(body) {
                let of_system = of_systems[carrier.system as usize].clone();
                nodes.of_bodies.push(of_system);
                continue;
            }
            let driven = bodies.driven.iter().find(|d| d.body as usize == body);
            match driven {
                None => nodes.grain(&scene, body, surface),
                Some(driven) => nodes.first_body(&scene, body, &driven.name)?,
            }
        }
        for driven in bodies.driven {
            let range = nodes.of_bodies[driven.body as usize].range();
            nodes.first_bodies.push((driven.name.clone(), range));
        }
        for (system, own) in of_systems.iter().enumerate() {
            if let Some(system) = simulation.system(system).filter(|s| !s.is_grain()) {
                let name = system.name().to_owned();
                nodes.first_bodies.push((name, own.range()));
            }
        }
        Ok(nodes)
    }

    fn one(&mut self, node: Node) {
        self.of_bodies.push(BodyNodes::One(self.list.len() as u32));
        self.list.push(node);
    }

    fn grain(&mut self, scene: &Scene<'_>, body: usize, surface: f64) {
        let temperature = scene.temperature_of_grain(body);
        let mut node = Node::new(temperature, Store::Lumped(scene.capacity(body)));
        if let Some(convection) = scene.spec.convection {
            node.surroundings = convection.coefficient * surface;
            node.ambient = convection.ambient;
        }
        self.one(node);
    }

    fn first_body(
        &mut self,
        scene: &Scene<'_>,
        body: usize,
        name: &str,
    ) -> Result<(), ValidationError> {
        let fixed = BodyHeatSpec::default();
        let spec = scene.spec.bodies.get(name).unwrap_or(&fixed);
        let temperature = spec.temperature.unwrap_or(scene.spec.initial);
        let first = self.list.len() as u32;
        match &spec.store {
            StoreSpec::Insulated => {
                self.of_bodies.push(BodyNodes::Insulated);
                return Ok(());
            }
            StoreSpec::Fixed => self.one(Node::new(temperature, Store::Fixed)),
            StoreSpec::Lumped { capacity } => {
                let capacity = match capacity {
                    Some(capacity) => *capacity,
                    None if scene.has_volume(body) && !scene.mass_is_given(name) => {
                        scene.capacity(body)
                    }
                    None if scene.has_volume(body) => {
                        let message = format!(
                            "the mass of `{name}` is given, which need not be that of its material; give its heat capacity too, `Lumped(capacity: 1.0)` (J/K)"
                        );
                        return Err(ValidationError::new(
                            format!("heat.bodies.{name}.store"),
                            message,
                        ));
                    }
                    None => {
                        let message = format!(
                            "`{name}` has surfaces only, so that its volume is not known; give its heat capacity, `Lumped(capacity: 1.0)` (J/K)"
                        );
                        return Err(ValidationError::new(
                            format!("heat.bodies.{name}.store"),
                            message,
                        ));
                    }
                };
                self.one(Node::new(temperature, Store::Lumped(capacity)));
            }
            StoreSpec::Mesh(_) => {
                let message = format!("`{name}` is rigid and has no mesh");
                return Err(
                    ValidationError::new(format!("heat.bodies.{name}.store"), message)
                        .expected("`Mesh()` of a body of `elastic`"),
                );
            }
            StoreSpec::HalfSpace(depth) => {
                let here = format!("heat.bodies.{name}.store");
                let pieces = scene.pieces(&here, body, depth)?;
                let grid = scene.grid(&here, body, depth)?;
                for _ in 0..pieces.count() {
                    let space = HalfSpace::new(grid.clone(), pieces.area(), temperature);
                    let store = Store::HalfSpace(Box::new(space));
                    self.list.push(Node::new(temperature, store));
                }
                let diffusivity = scene.material_of(body).conductor().diffusivity();
                self.columns.push(pieces.columns(first, diffusivity));
                self.of_bodies.push(BodyNodes::Pieces(first, pieces));
            }
        }
        let count = (self.list.len() as u32 - first).max(1);
        let share = 1.0 / f64::from(count);
        for node in first..self.list.len() as u32 {
            if let Some(face) = spec.convection {
                let node = &mut self.list[node as usize];
                node.surroundings = face.coefficient * face.area * share;
                node.ambient = face.ambient;
            }
            if spec.power != 0.0 {
                self.imposed.push(ImposedHeatFlow {
                    body: Some(body as u32),
                    node,
                    flow: spec.power * share,
                });
            }
        }
        Ok(())
    }
}

impl Scene<'_> {
    pub fn material_of(&self, body: usize) -> &ThermalMaterial {
        &self.materials[usize::from(self.material[body])]
    }

    /// Returns the initial temperature of a grain (K).
    pub fn temperature_of_grain(&self, body: usize) -> f64 {
        let mut names = self.case.materials.keys();
        let name = names.nth(usize::from(self.material[body]));
        let given = name.and_then(|n| self.spec.grains.get(n));
        given.copied().unwrap_or(self.spec.initial)
    }

    /// Returns the heat capacity of a body with a volume (J/K; J/(K m) in 2D), without inertia
    /// scaling.
    fn capacity(&self, body: usize) -> f64 {
        let mass = self.simulation.bodies().mass[body] / self.case.inertia_scaling;
        mass * self.material_of(body).heat_capacity
    }

    fn mass_is_given(&self, name: &str) -> bool {
        let mut bodies = self.case.bodies.iter();
        bodies.any(|b| b.name == name && b.mass.is_some())
    }

    fn has_volume(&self, body: usize) -> bool {
        let balls = self.simulation.balls().into_iter().map(|b| b.body);
        let pieces = self.simulation.pieces().into_iter().map(|p| p.body);
        balls.chain(pieces).any(|b| b as usize == body)
    }

    /// Returns the surface of each grain (m^2; circumference in 2D, m); for shapes other than balls
    /// that of the ball of the same volume.
    fn surface_of_grains(&self) -> Vec<f64> {
        let s = self.simulation;
        let mut surface = vec![0.0; s.bodies().len()];
        let balls = s.balls().into_iter().map(|b| (b.body, b.radius));
        let pieces = s.pieces().into_iter().map(|p| (p.body, p.size));
        for (body, radius) in balls.chain(pieces) {
            surface[body as usize] += match s.dimension() {
                2 => 2.0 * PI * radius,
                _ => 4.0 * PI * radius * radius,
            };
        }
        surface
    }

    /// The strips or rectangles of the surface of a body.
    fn pieces(
        &self,
        here: &str,
        body: usize,
        depth: &DepthSpec,
    ) -> Result<Pieces, ValidationError> {
        let dimension = self.simulation.dimension();
        let given = [depth.x, depth.y, depth.z];
        let axes: Vec<usize> = (0..3).filter(|k| given[*k].is_some()).collect();
        if axes.len() != dimension - 1 || axes.iter().any(|k| *k >= dimension) {
            let message = format!(
                "the surface is divided along {} of the case",
                match dimension {
                    2 => "one axis",
                    _ => "two axes",
                }
            );
            let example = match dimension {
                2 => "`HalfSpace(x: 40)`",
                _ => "`HalfSpace(x: 40, y: 10)`",
            };
            return Err(ValidationError::new(here, message).expected(example));
        }
        if !depth.over.is_empty() && depth.over.len() != axes.len() {
            let message = format!(
                "`over` has {} ranges for {} axes",
                depth.over.len(),
                axes.len()
            );
            return Err(ValidationError::new(here, message)
                .expected("a range (low, high) for each axis along which the surface is divided"));
        }
        let mut out = Vec::new();
        for (k, axis) in axes.into_iter().enumerate() {
            let count = given[axis].unwrap_or(1);
            if count == 0 {
                let message = "the number of pieces must be at least 1";
                return Err(ValidationError::new(here, message));
            }
            if let Some((low, high)) = depth.over.get(k).copied() {
                if !(low < high && (high - low).is_finite()) {
                    let message = format!("the range from {low} to {high} m is empty");
                    return Err(ValidationError::new(here, message));
                }
                let length = high - low;
                let period = self.simulation.periodic().period[axis];
                if let Some(period) = period.filter(|p| (p - length).abs() > 1e-9 * length) {
                    let message = format!(
                        "the case is periodic along {} with {period} m, and the range is {length} m long",
                        ["x", "y", "z"][axis]
                    );
                    return Err(ValidationError::new(here, message)
                        .expected("a range as long as the period, or no `over`"));
                }
                out.push(PieceAxis {
                    axis,
                    low,
                    length,
                    count,
                    periodic: period.is_some(),
                });
                continue;
            }
            out.push(self.strips(here, body, axis, count)?);
        }
        Ok(Pieces { axes: out })
    }

    /// Returns strips along an axis over the period, or over the extent of the surfaces of the
    /// body.
    fn strips(
        &self,
        here: &str,
        body: usize,
        axis: usize,
        count: u32,
    ) -> Result<PieceAxis, ValidationError> {
        let s = self.simulation;
        if let Some(length) = s.periodic().period[axis] {
            return Ok(PieceAxis {
                axis,
                low: -0.5 * length,
                length,
                count,
                periodic: true,
            });
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut see = |x: f64| (low, high) = (low.min(x), high.max(x));
        for (k, surface) in s.surfaces().into_iter().enumerate() {
            if surface.body as usize != body {
                continue;
            }
            if surface.flat.is_some() {
                let message = "a plane has no ends; say over which part of it the pieces are";
                return Err(ValidationError::new(here, message).expected(
                    "`over: [(-1e-3, 1e-3)]` (m), or a period of the case along the axis",
                ));
            }
            for point in s.surface_lines(k).into_iter().flatten() {
                see(point[axis] + surface.offset[axis]);
            }
        }
        let of_body = |of: u32| of as usize == body;
        for ball in s.balls().iter().filter(|b| of_body(b.body)) {
            see(ball.offset[axis] - ball.radius);
            see(ball.offset[axis] + ball.radius);
        }
        let pieces = s.pieces().into_iter().enumerate();
        for (k, piece) in pieces.filter(|(_, p)| of_body(p.body)) {
            for corner in s.piece_core(k).0 {
                see(piece.offset[axis] + corner[axis]);
            }
        }
        if low < high && (high - low).is_finite() {
            return Ok(PieceAxis {
                axis,
                low,
                length: high - low,
                count,
                periodic: false,
            });
        }
        let message = format!(
            "the surface has no extent along {}; make the case periodic along it, or choose another axis",
            ["x", "y", "z"][axis]
        );
        Err(ValidationError::new(here, message))
    }

    /// The grid over the depth.
    fn grid(&self, here: &str, body: usize, depth: &DepthSpec) -> Result<Grid, ValidationError> {
        let conductor = self.material_of(body).conductor();
        let time = &self.case.time;
        let reach = |t: f64| (conductor.diffusivity() * self.spec.clock * t).sqrt();
        let step = time.step * self.spec.every as f64;
        let spacing = depth.spacing.unwrap_or(FIRST * reach(step));
        let total = depth.depth.unwrap_or(DEEP * reach(time.end)).max(spacing);
        let growth = depth.growth.unwrap_or(GROWTH);
        let points = (1.0 + (growth - 1.0) * total / spacing).ln() / growth.ln().max(1e-9);
        if points.min(total / spacing) > 1e4 {
            let message = format!(
                "a grid from {spacing:e} m to a depth of {total:e} m has more than 10,000 points; give a larger `spacing` or `growth`"
            );
            return Err(ValidationError::new(here, message));
        }
        Grid::graded(
            conductor.conductivity,
            conductor.capacity,
            spacing,
            growth,
            total,
        )
        .map_err(|e| ValidationError::new(here, e.to_string()))
    }
}
