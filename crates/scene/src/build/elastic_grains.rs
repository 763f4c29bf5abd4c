//! Deformable grains: the grains of a material are removed from the rigid bodies and become
//! dynamical systems.

use super::{Builder, Origin};
use crate::case::ElasticGrainSpec;
use crate::material::Sourced;
use crate::measures::MeasureSpec;
use crate::source::InputError;
use fretwork_core::assembly::{self, AnySceneParts, AnySystem, SceneParts};
use fretwork_core::bodies::DynamicalSystem;
use fretwork_core::geometry::convex::{ConvexCollider, Core};
use fretwork_core::geometry::shape::Ball;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_elastic::grain::mesh::{Triangles, disk, polygon, shells};
use fretwork_elastic::{ElasticGrain, ElasticGrainSpec as Grain, Elasticity, GrainShape, Mesh};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Largest number of elements along the radius of a grain, by dimension: modes of finer meshes take
/// minutes to compute.
const MAX_ELEMENTS: [usize; 2] = [12, 5];

/// Deformable grains, with their entries in the case.
pub(super) type ElasticGrains = Vec<(AnySystem, Origin)>;

/// Deformable grains of a material in the case: path and content of the entry, elasticity, and
/// elements along the radius.
type OfMaterial<'a> = BTreeMap<u16, (String, &'a ElasticGrainSpec, Elasticity, usize)>;

/// Key of grains that share their modes: a number for their kind, and all data on which the modes
/// depend.
type ShapeKey = (usize, Vec<u64>);

/// The collision shapes of a grain.
pub(super) struct Shapes<'a, S: Space> {
    pub balls: Vec<&'a Ball<S>>,
    pub pieces: Vec<&'a ConvexCollider<S>>,
}

impl<S: Space> Shapes<'_, S> {
    /// Returns the radius of the ball of the same volume (m).
    fn radius(&self) -> f64 {
        let ball = self.balls.first().map(|ball| ball.radius);
        let piece = self.pieces.first().map(|piece| piece.size);
        ball.or(piece).unwrap_or_default()
    }

    /// Returns the radius of the ball around it (m).
    fn bound(&self) -> f64 {
        let ball = self.balls.first().map(|ball| ball.radius);
        let piece = self.pieces.first().map(|piece| piece.bound);
        ball.or(piece).unwrap_or_default()
    }
}

impl Builder<'_> {
    /// Removes the grains of deformable materials from the rigid bodies and returns them. Called
    /// after the grains and before all other bodies are added.
    pub(super) fn elastic_grains(
        &mut self,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<ElasticGrains, InputError> {
        let mut of_material: OfMaterial<'_> = BTreeMap::new();
        for (k, spec) in self.case.elastic_grains.iter().enumerate() {
            let here = format!("elastic_grains.{k}");
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            if !spec.material.chars().all(plain) {
                let message = format!(
                    "the material `{}` names files of its grains: rename it with letters, digits, `-` and `_`",
                    spec.material
                );
                return Err(self.fail(format!("{here}.material"), message));
            }
            let (elasticity, material) = self.elasticity(&here, &spec.material, properties)?;
            elasticity
                .check()
                .map_err(|why| self.fail(format!("{here}.material"), why.to_string()))?;
            let damping = spec.damping;
            for (name, x) in [("mass", damping.mass), ("stiffness", damping.stiffness)] {
                if !(x.is_finite() && x >= 0.0) {
                    let message = format!("damping must be zero or positive, got {x}");
                    return Err(self.fail(format!("{here}.damping.{name}"), message));
                }
            }
            let most = MAX_ELEMENTS[self.dimension() - 2];
            let elements = spec
                .elements
                .unwrap_or(if self.dimension() == 2 { 4 } else { 2 });
            if !(1..=most).contains(&elements) {
                let message = format!(
                    "a grain has 1 to {most} elements along its radius here, got {elements}"
                );
                return Err(self.fail(format!("{here}.elements"), message));
            }
            let entry = (here.clone(), spec, elasticity, elements);
            if of_material.insert(material, entry).is_some() {
                let message = format!(
                    "the grains of `{}` are here twice; leave one out",
                    spec.material
                );
                return Err(self.fail(format!("{here}.material"), message));
            }
        }
        if of_material.is_empty() {
            return Ok(Vec::new());
        }
        if self.case.circuit.is_some() {
            let message =
                "grains that deform do not take part in a `circuit`; take one of the two away";
            return Err(self.fail("elastic_grains", message));
        }
        let bands = self.case.measures.iter();
        if bands.map(MeasureSpec::kind).any(|kind| kind == "Band") {
            let message = "the measure `Band` does not follow grains that deform; take it away, or let the grains be rigid";
            return Err(self.fail("elastic_grains", message));
        }
        if self.case.output.shear.is_some() {
            let message = "local shear is not measured of grains that deform; take `shear` away";
            return Err(self.fail("output.shear", message));
        }
        let none = assembly::empty(self.dimension(), *self.assembly.periodic());
        let mut assembly = std::mem::replace(&mut self.assembly, none);
        let made = match assembly.parts() {
            AnySceneParts::Plane(parts) => {
                let grains = self.deform(parts, &of_material)?;
                in_any(grains, AnySystem::Plane)
            }
            AnySceneParts::Space(parts) => {
                let grains = self.deform(parts, &of_material)?;
                in_any(grains, AnySystem::Space)
            }
        };
        self.assembly = assembly;
        Ok(made)
    }

    /// Makes deformable grains from the parts of these materials, and removes the parts.
    fn deform<S: Space>(
        &mut self,
        parts: &mut SceneParts<S>,
        of_material: &OfMaterial<'_>,
    ) -> Result<GrainsIn<S>, InputError> {
        let mut shapes: Vec<Shapes<'_, S>> = Vec::new();
        shapes.resize_with(parts.bodies.len(), || Shapes {
            balls: Vec::new(),
            pieces: Vec::new(),
        });
        for ball in &parts.shapes.balls {
            shapes[ball.body as usize].balls.push(ball);
        }
        for piece in &parts.shapes.pieces {
            shapes[piece.body as usize].pieces.push(piece);
        }
        let mut known: HashMap<ShapeKey, Arc<GrainShape<S>>> = HashMap::new();
        let mut out = Vec::new();
        let mut kept = vec![true; parts.bodies.len()];
        let mut used = BTreeSet::new();
        let mut unloaded = Vec::new();
        for (b, own) in shapes.iter().enumerate() {
            let ball = own.balls.first().map(|ball| ball.material);
            let material = ball.or_else(|| own.pieces.first().map(|piece| piece.material));
            let Some((here, spec, elasticity, elements)) =
                material.and_then(|m| of_material.get(&m))
            else {
                continue;
            };
            let origin = self.origins[b];
            let shape =
                self.grain_shape(own, origin, (*elements, elasticity.poisson), &mut known)?;
            let (shape, size) = shape;
            let of = (&*shape, size, elasticity);
            let displacement = self.taken_over(parts, b as u32, here, &spec.material, of)?;
            let grain = Grain {
                name: format!("grain_{}", out.len()),
                shape,
                size,
                radius: own.radius(),
                material: *elasticity,
                damping: spec.damping,
                surface_material: material.unwrap_or_default(),
                position: parts.bodies.position[b],
                rotation: parts.bodies.rotation[b],
                velocity: parts.bodies.velocity[b],
                spin: parts.bodies.spin[b],
                displacement,
            };
            unloaded.push(self.unloaded(&parts.bodies, b, own, material.unwrap_or_default()));
            let bound = own.bound();
            for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
                let period = parts.shapes.periodic.period[k];
                if period.is_some_and(|p| p < 8.0 * bound) {
                    let message = format!(
                        "the period must be at least 4 diameters of the largest grain ({:e} m)",
                        8.0 * bound
                    );
                    return Err(self.fail(format!("periodic.{name}"), message));
                }
            }
            let system = ElasticGrain::new(grain);
            let system = system.map_err(|why| self.fail(here.as_str(), why))?;
            kept[b] = false;
            used.insert(here.clone());
            let system: Box<dyn DynamicalSystem<S>> = Box::new(system);
            out.push((system, origin));
        }
        if let Some((here, ..)) = of_material.values().find(|entry| !used.contains(&entry.0)) {
            let message = "the case has no grains of this material; give the name of theirs";
            return Err(self.fail(format!("{here}.material"), message));
        }
        parts.keep(&kept);
        let mut kept = kept.iter();
        self.origins
            .retain(|_| kept.next().copied().unwrap_or(true));
        self.deforming = unloaded;
        Ok(out)
    }

    /// Returns the shape of a grain, and the length of its unit (m).
    fn grain_shape<S: Space>(
        &self,
        own: &Shapes<'_, S>,
        origin: Origin,
        (elements, poisson): (usize, f64),
        known: &mut HashMap<ShapeKey, Arc<GrainShape<S>>>,
    ) -> Result<(Arc<GrainShape<S>>, f64), InputError> {
        let refuse = |message: &str| self.fail(origin.path(), message);
        let (key, size) = match (&own.balls[..], &own.pieces[..]) {
            ([ball], []) => ((0, vec![poisson.to_bits(), elements as u64]), ball.radius),
            ([], [piece]) if piece.rounding > 0.0 => {
                return Err(refuse(
                    "a grain that deforms has no rounded corners: set `rounding` to 0, or leave its material out of `elastic_grains`",
                ));
            }
            ([], [piece]) => {
                let mut key = vec![poisson.to_bits(), elements as u64];
                for corner in piece.core.boundary().corners {
                    key.extend((0..S::D).map(|k| corner[k].to_bits()));
                }
                ((1, key), 1.0)
            }
            _ => {
                return Err(refuse(
                    "a grain that deforms has one shape, a ball, polygon or polyhedron; leave the material of unions out of `elastic_grains`",
                ));
            }
        };
        if let Some(shape) = known.get(&key) {
            return Ok((Arc::clone(shape), size));
        }
        let mesh = match own.pieces.first() {
            None => ball_mesh(elements),
            Some(piece) => piece_mesh(piece, elements),
        };
        let shape = mesh.and_then(|mesh| GrainShape::new(mesh, poisson));
        let shape = shape.map_err(|why| refuse(&format!("this grain cannot deform: {why}")))?;
        let shape = Arc::new(shape);
        known.insert(key, Arc::clone(&shape));
        Ok((shape, size))
    }
}

/// Deformable grains in their dimension, with their entries in the case.
type GrainsIn<S> = Vec<(Box<dyn DynamicalSystem<S>>, Origin)>;

fn in_any<S: Space>(
    grains: GrainsIn<S>,
    any: fn(Box<dyn DynamicalSystem<S>>) -> AnySystem,
) -> ElasticGrains {
    let grains = grains.into_iter();
    grains
        .map(|(system, origin)| (any(system), origin))
        .collect()
}

/// The mesh of a ball of unit radius.
fn ball_mesh<S: Space>(elements: usize) -> Result<Mesh<S>, String> {
    let centre = S::Vector::zero();
    let mesh = match S::D {
        2 => polygon::<S>(&disk::<S>(elements), &centre, 1.0 / elements as f64),
        _ => {
            let surface = Triangles::<S>::icosahedron();
            shells::<S>(&surface.cut(elements).on_unit_sphere(), &centre, elements)
        }
    };
    mesh.map_err(|e| e.to_string())
}

/// Returns the mesh of a convex part about its centre (m).
fn piece_mesh<S: Space>(piece: &ConvexCollider<S>, elements: usize) -> Result<Mesh<S>, String> {
    let boundary = piece.core.boundary();
    if boundary.corners.len() <= S::D {
        return Err("it encloses no volume".to_owned());
    }
    let size = piece.size / elements as f64;
    let centre = S::Vector::zero();
    if S::D == 2 {
        return polygon::<S>(&boundary.corners, &centre, size).map_err(|e| e.to_string());
    }
    let mut triangles = Vec::new();
    for face in &boundary.faces {
        let fan = face.windows(2).skip(1);
        triangles.extend(fan.map(|w| [face[0], w[0], w[1]]));
    }
    let points = boundary.corners;
    let longest = triangles.iter().flat_map(|t: &[u32; 3]| {
        let at = t.map(|p| points[p as usize]);
        [
            (at[1] - at[0]).norm(),
            (at[2] - at[1]).norm(),
            (at[0] - at[2]).norm(),
        ]
    });
    let longest = longest.fold(0.0, f64::max);
    // Edges of a face of a cube are as long as 1.6 radii of the ball with its volume.
    let parts = (longest / (1.6 * size)).round().max(1.0) as usize;
    let surface = Triangles { points, triangles }.cut(parts);
    shells::<S>(&surface, &centre, elements).map_err(|e| e.to_string())
}
