//! A body of finite elements, as a dynamical system. In small strain its inertia, stiffness and
//! damping are constant, so that
//!
//! ```text
//! A = M + h theta C + h^2 theta^2 K
//! ```
//!
//! is factorised once for each h and theta. M is lumped: each corner gets a (D + 1)-th of the mass
//! of an element. Contacts act on the points of a part of the boundary; the columns of the
//! compliance of these points, P A^-1 P^T, are computed once, when a point is first touched. In
//! large strain K is a tangent, and A is assembled again in each iteration of Newton's method, see
//! [`crate::large_strain`].
//!
//! Sources: T. J. R. Hughes, "The Finite Element Method" (2000), chapters 2, 3 and 7; M. Jean, "The
//! non-smooth contact dynamics method", Comput. Methods Appl. Mech. Eng. 177 (1999).

mod conduction;
mod expansion;
mod results;
mod turning;

use crate::error::BodyError;
use crate::freedom::Freedoms;
use crate::large_strain::LargeStrain;
use crate::mesh::Mesh;
use crate::model::{BodyModel, StepFactor, assemble, contactors};
use crate::newton::Iterate;
use crate::small_strain;
use crate::spec::BodySpec;
use crate::touching_surface::open_surface;
use expansion::FreeStrain;
use fretwork_core::bodies::{
    Compliance, Conduction, Contactor, ContactorShape, DeformedMesh, Dof, DynamicalSystem, Holder,
    Nodes, SystemSize, SystemStep, SystemWork, TouchingSurface, compliance_by_solving,
};
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::{Space, VectorLike, spin_about};
use std::sync::{Arc, OnceLock};

/// A body of finite elements.
#[derive(Clone, Debug)]
pub struct ElasticBody<S: Space> {
    pub(crate) model: Arc<BodyModel<S>>,
    pub(crate) formed: Option<Arc<StepFactor<S>>>,
    /// The current drive of each held coordinate.
    pub(crate) drives: Vec<Dof>,
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    /// Coordinates and velocities at the start of the step.
    pub(crate) start: [Vec<f64>; 2],
    /// K q in small strain (N): the current one, if it was computed, and that at the start of the
    /// step.
    elastic: OnceLock<Vec<f64>>,
    elastic_at_start: Vec<f64>,
    /// Number of moves since the step began: it has ended after two.
    moves: u32,
    /// Kinetic energy due to a jump of imposed velocities at the start of the step (J).
    jump: f64,
    /// Free strain due to thermal expansion.
    pub(crate) free_strain: FreeStrain<S>,
    /// Impulse of contacts on the coordinates in the step (N s).
    pub(crate) contact: Vec<f64>,
    /// State of the iterations of the step; unused in small strain.
    pub(crate) iterate: Iterate,
    /// The last step.
    step: Option<SystemStep<S>>,
}

impl<S: Space> ElasticBody<S> {
    /// A body at rest and without load.
    ///
    /// # Errors
    /// A material, a support or a contactor is invalid; [`BodyError`] lists the reasons.
    pub fn new(spec: BodySpec<Mesh<S>>) -> Result<Self, BodyError> {
        let BodySpec {
            name,
            mesh,
            material,
            strain,
            damping,
            supports,
            touching,
            surface_material,
            velocity,
            spin,
        } = spec;
        if S::D == 2 && [velocity[2], spin[0], spin[1]] != [0.0; 3] {
            return Err(BodyError::OutOfPlane(name.to_owned()));
        }
        let (velocity, spin) = (S::Vector::from_slice(&velocity), spin_about::<S>(&spin));
        material.check()?;
        let factors = [damping.mass, damping.stiffness];
        if !factors.iter().all(|f| *f >= 0.0 && f.is_finite()) {
            return Err(BodyError::Damping(damping.mass, damping.stiffness));
        }
        let freedoms = Freedoms::new(&mesh, supports)?;
        if !strain.is_finite() && crate::rigid::turns(&mesh, supports) {
            return Err(BodyError::Turns(name.to_owned()));
        }
        if !strain.is_finite() && spin != S::Spin::zero() {
            return Err(BodyError::Spins(name.to_owned()));
        }
        let (mass, stiffness) = assemble(&mesh, &material, &freedoms);
        let factor = damping.stiffness;
        let large = LargeStrain::new(strain, &material, factor, &mesh, &freedoms, &stiffness);
        let (part, contactors) = contactors(&mesh, touching, surface_material)?;
        let total = freedoms.total();
        let start = crate::rigid::velocities(&mesh, &freedoms, &velocity, &spin);
        let model = BodyModel {
            name: name.to_owned(),
            mesh,
            material,
            damping,
            freedoms,
            large,
            mass,
            stiffness,
            contactors,
            part,
        };
        let drives = model.freedoms.held.iter().map(|h| h.drive.clone());
        Ok(Self {
            drives: drives.collect(),
            model: Arc::new(model),
            formed: None,
            displacement: vec![0.0; total],
            velocity: start,
            start: [vec![0.0; total], vec![0.0; total]],
            elastic: OnceLock::new(),
            elastic_at_start: vec![0.0; total],
            moves: 0,
            jump: 0.0,
            free_strain: FreeStrain::default(),
            contact: vec![0.0; total],
            iterate: Iterate::default(),
            step: None,
        })
    }

    /// Returns the current position of a point of the mesh (m).
    fn point_now(&self, point: u32) -> S::Vector {
        self.model.mesh.points()[point as usize] + self.displacement(point)
    }

    /// Returns the displacement of a point of the mesh (m).
    fn displacement(&self, point: u32) -> S::Vector {
        self.model.of(&self.displacement, point)
    }

    /// Returns v_theta, and q + h theta v_theta.
    fn average(&self, step: &SystemStep<S>) -> (Vec<f64>, Vec<f64>) {
        let [q, v] = &self.start;
        let SystemStep { h, theta, .. } = *step;
        let average: Vec<f64> = v
            .iter()
            .zip(&self.velocity)
            .map(|(v, w)| (1.0 - theta) * v + theta * w)
            .collect();
        let at = q.iter().zip(&average).map(|(q, v)| q + h * theta * v);
        let at = at.collect();
        (average, at)
    }

    /// Returns K q in small strain (N).
    fn elastic(&self) -> &[f64] {
        self.elastic.get_or_init(|| {
            let strained = self.model.strained(&self.displacement);
            self.model.stiffness.times(&strained)
        })
    }

    /// Returns K q in small strain at the start and at the end of the step (N), once it has ended.
    pub(super) fn elastic_of_step(&self) -> Option<[&[f64]; 2]> {
        let ended = self.model.large.is_none() && self.moves == 2;
        ended.then(|| [&self.elastic_at_start[..], self.elastic()])
    }

    /// Returns the time function of a drive for a step, at its theta-point.
    pub(crate) fn force(drive: &Dof, step: &SystemStep<S>) -> f64 {
        let over = drive.over(step.time, step.h);
        over.force(step.time + step.theta * step.h)
    }
}

impl<S: Space> DynamicalSystem<S> for ElasticBody<S> {
    fn name(&self) -> &str {
        &self.model.name
    }

    fn freedoms(&self) -> usize {
        self.model.freedoms.total()
    }

    fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    fn set_contact_impulse(&mut self, impulse: &[f64]) {
        self.contact.copy_from_slice(impulse);
    }

    fn set_velocity(&mut self, velocity: &[f64]) {
        self.velocity.copy_from_slice(velocity);
        self.iterate.moved();
    }

    fn begin_step(&mut self, step: &SystemStep<S>) {
        let model = Arc::clone(&self.model);
        self.jump = 0.0;
        for (c, drive) in model.freedoms.imposed(&self.drives) {
            let drive = drive.over(step.time, step.h);
            if let Some(speeds) = drive.speeds(step.time, step.h, step.theta) {
                let before = self.velocity[c];
                self.jump += 0.5 * model.mass[c] * (speeds.start.powi(2) - before.powi(2));
                self.velocity[c] = speeds.start;
            }
        }
        self.start[0].copy_from_slice(&self.displacement);
        self.start[1].copy_from_slice(&self.velocity);
        if model.large.is_none() {
            self.elastic();
            self.elastic_at_start = self.elastic.take().unwrap_or_default();
        }
        self.moves = 0;
        self.contact.fill(0.0);
        self.step = Some(*step);
        self.iterate.moved();
        let of = [step.h, step.theta];
        if model.large.is_none() && self.formed.as_ref().is_none_or(|formed| formed.of != of) {
            self.formed = Some(Arc::new(model.form(step.h, step.theta)));
        }
    }

    fn set_free_strain(&mut self, of_points: &[f64]) {
        self.take_free_strain(of_points);
        self.iterate.moved();
    }

    fn expands(&self) -> bool {
        true
    }

    fn expansion_work(&self) -> &[f64] {
        &self.free_strain.work
    }

    fn linearise(&mut self, step: &SystemStep<S>) {
        if self.model.large.is_some() {
            self.begin_iterations(step);
        }
    }

    fn relinearise(&mut self, step: &SystemStep<S>) -> Result<bool, String> {
        self.iterate(step)
    }

    fn linearisations(&self) -> u32 {
        self.iterate.count()
    }

    fn advance(&mut self, time: f64) {
        for (q, v) in self.displacement.iter_mut().zip(&self.velocity) {
            *q += v * time;
        }
        self.elastic.take();
        self.moves += 1;
    }

    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64> {
        let model = &self.model;
        if model.large.is_some() {
            return self.free_velocity_at_iterate(step);
        }
        let SystemStep { time, h, theta, .. } = *step;
        let [q, v] = &self.start;
        let mut end = v.clone();
        for (c, drive) in model.freedoms.imposed(&self.drives) {
            let drive = drive.over(time, h);
            if let Some(speeds) = drive.speeds(time, h, theta) {
                end[c] = speeds.end;
            }
        }
        // With imposed coordinates at their final velocity, the correction of the others is A^-1
        // times the remaining forces.
        let pairs = v.iter().zip(&end);
        let average: Vec<f64> = pairs.map(|(v, w)| v + theta * (w - v)).collect();
        let at: Vec<f64> = q
            .iter()
            .zip(&average)
            .map(|(q, v)| q + h * theta * v)
            .collect();
        let elastic = model.stiffness.times(&model.strained(&at));
        let free = model.freedoms.free;
        let mut impulse: Vec<f64> = (0..free)
            .map(|c| {
                let gravity = step.gravity[usize::from(model.freedoms.axis[c])];
                h * (model.mass[c] * gravity - elastic[c] + self.free_strain.force(c))
            })
            .collect();
        for (p, f) in impulse.iter_mut().zip(model.viscous(&average)) {
            *p -= h * f;
        }
        for (c, drive) in model.freedoms.forces(&self.drives) {
            impulse[c] += h * Self::force(drive, step);
        }
        if let Some(formed) = &self.formed {
            formed.solve(&mut impulse);
        }
        for (v, dv) in end.iter_mut().zip(&impulse) {
            *v += dv;
        }
        end
    }

    fn solve(&self, impulse: &mut [f64]) {
        let (free, imposed) = impulse.split_at_mut(self.model.freedoms.free);
        if let Some(formed) = &self.formed {
            formed.solve(free);
        }
        imposed.fill(0.0);
    }

    fn work(&self, step: &SystemStep<S>) -> SystemWork {
        let model = &self.model;
        let SystemStep { h, theta, .. } = *step;
        let (average, _) = self.average(step);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (viscous, scheme) = match &model.large {
            Some(large) => {
                let [elastic, viscous] = self.internal_of_step(large, step, &average);
                let free = &self.free_strain.of_elements;
                let stored = self.stored_energy() - large.energy(&self.start[0], free);
                (viscous, h * dot(&elastic, &average) - stored)
            }
            None => {
                let viscous = model.viscous(&average);
                let stored = match self.elastic_of_step() {
                    Some([start, end]) => {
                        let pairs = end.iter().zip(start).zip(&average);
                        h * pairs.map(|((e, s), v)| (e - s) * v).sum::<f64>()
                    }
                    None => h * h * model.stiffness.form(&model.strained(&average)),
                };
                (viscous, (theta - 0.5) * stored)
            }
        };
        let mut work = SystemWork {
            damping: if viscous.is_empty() {
                0.0
            } else {
                h * dot(&viscous, &average)
            },
            scheme,
            external: self.jump,
            expansion: self.free_strain.work.iter().sum(),
            ..SystemWork::default()
        };
        for (c, m) in model.mass.iter().enumerate() {
            let gravity = step.gravity[usize::from(model.freedoms.axis[c])];
            let change = self.velocity[c] - self.start[1][c];
            work.potential -= h * m * gravity * average[c];
            work.scheme += (theta - 0.5) * m * change * change;
        }
        for (c, drive) in model.freedoms.forces(&self.drives) {
            work.external += h * Self::force(drive, step) * average[c];
        }
        if model.freedoms.free < model.freedoms.total() {
            let moved = &average[model.freedoms.free..];
            work.external += h * dot(&self.reactions(step), moved);
        }
        work
    }

    fn kinetic_energy(&self) -> f64 {
        let terms = self.model.mass.iter().zip(&self.velocity);
        0.5 * terms.map(|(m, v)| m * v * v).sum::<f64>()
    }

    fn stored_energy(&self) -> f64 {
        if let Some(large) = &self.model.large {
            return large.energy(&self.displacement, &self.free_strain.of_elements);
        }
        if !self.free_strain.of_elements.is_empty() {
            return self.stored_with_free_strain();
        }
        let strained = self.model.strained(&self.displacement);
        let pairs = strained.iter().zip(self.elastic());
        0.5 * pairs.map(|(q, f)| q * f).sum::<f64>()
    }

    fn mass(&self) -> f64 {
        // Each coordinate along the first axis counts once.
        let axes = self.model.freedoms.axis.iter();
        let along = axes.zip(&self.model.mass).filter(|(axis, _)| **axis == 0);
        along.map(|(_, m)| m).sum()
    }

    fn length(&self) -> f64 {
        let points = self.model.mesh.points();
        let extent = |k: usize| {
            let at = points.iter().map(|p| p[k]);
            at.clone().fold(f64::NEG_INFINITY, f64::max) - at.fold(f64::INFINITY, f64::min)
        };
        0.5 * (0..S::D).map(extent).fold(0.0, f64::max)
    }

    fn is_driven(&self) -> bool {
        let mut imposed = self.model.freedoms.imposed(&self.drives);
        imposed.any(|(_, drive)| !matches!(drive, Dof::Fixed))
    }

    fn drive_mut(&mut self, part: &str, axis: usize) -> Option<&mut Dof> {
        let held = self.model.freedoms.find(part, axis)?;
        self.drives.get_mut(held)
    }

    fn node_position(&self, node: u32) -> S::Vector {
        match self.facet_spin(node) {
            Some(spin) => spin.middle(|p| self.point_now(p)),
            None => self.point_now(node),
        }
    }

    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector {
        match self.facet_spin(node) {
            Some(spin) => spin.velocity(|p| self.model.of(velocity, p)),
            None => self.model.of(velocity, node),
        }
    }

    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]) {
        let mut add = |(point, p): (u32, S::Vector)| {
            for axis in 0..S::D {
                generalised[self.model.freedoms.of(point, axis)] += p[axis];
            }
        };
        match self.facet_spin(node) {
            Some(spin) => {
                let forces = spin.forces(turning::moment::<S>(impulse, spin.length));
                forces.for_each(add);
            }
            None => add((node, *impulse)),
        }
    }

    fn contactors(&self) -> Vec<Contactor> {
        self.model.contactors.clone()
    }

    fn contact_nodes(&self, contactor: &Contactor, arm: &S::Vector) -> Nodes {
        match &self.model.part {
            Some(part) if contactor.shape == ContactorShape::Surface => {
                let at = self.point_now(part.origin()) + *arm;
                part.nodes::<S>(&at, |p| self.point_now(p))
            }
            _ => contactor.nodes.clone(),
        }
    }

    fn turning_node(&self, contactor: &Contactor, arm: &S::Vector) -> Option<(u32, f64)> {
        self.turning(contactor, arm)
    }

    fn facets_at(&self, contactor: usize) -> Vec<([S::Vector; 3], usize)> {
        let part = self.model.part.as_ref();
        let of = self.model.contactors.get(contactor);
        let part = part.filter(|_| of.is_some_and(|c| c.shape == ContactorShape::Point));
        let found = part.into_iter().flat_map(|p| p.facets_at(contactor));
        let now = found.map(|(points, place)| (points.map(|p| self.point_now(p)), place));
        now.collect()
    }

    fn vertex_nodes(&self, contactor: &Contactor, weights: &[(u32, f64)]) -> Option<Nodes> {
        let part = self.model.part.as_ref()?;
        if contactor.shape != ContactorShape::Surface {
            return None;
        }
        part.of_vertices(weights)
    }

    fn surface(&self, contactor: &Contactor) -> Option<Box<dyn Surface<S>>> {
        let part = self.model.part.as_ref()?;
        if contactor.shape != ContactorShape::Surface {
            return None;
        }
        open_surface(self.surface_vertices(contactor), &part.facets, None).ok()
    }

    fn surface_vertices(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        let Some(part) = &self.model.part else {
            return Vec::new();
        };
        let origin = self.point_now(part.origin());
        let points = part.points.iter();
        points.map(|p| self.point_now(*p) - origin).collect()
    }

    fn compliance(&self, nodes: &[u32]) -> Vec<S::Matrix> {
        let found = match self.kept_compliance(nodes) {
            Some(kept) => turning::blocks_of_points::<S>(&kept, nodes),
            None => self.compliance_with_turning(nodes),
        };
        found.unwrap_or_else(|| compliance_by_solving(self, nodes))
    }

    fn kept_compliance(&self, touched: &[u32]) -> Option<Arc<Compliance<S>>> {
        let formed = self.formed.as_ref()?;
        let kept = formed.surface.as_ref()?;
        for node in touched {
            self.model.column(formed, kept.place(*node)?);
        }
        Some(Arc::clone(kept))
    }

    fn kept_nodes(&self) -> Option<usize> {
        let kept = self.formed.as_ref()?.surface.as_ref()?;
        Some(kept.nodes().len())
    }

    fn holders(&self) -> Vec<Holder> {
        self.held_parts()
    }

    fn deformed_mesh(&self) -> Option<DeformedMesh<S::Vector>> {
        Some(self.mesh_now())
    }

    fn conduction(&self) -> Option<Conduction> {
        Some(conduction::conduction(&self.model.mesh))
    }

    fn mesh_velocity(&self) -> Vec<S::Vector> {
        let all = 0..self.model.mesh.points().len() as u32;
        all.map(|p| self.model.of(&self.velocity, p)).collect()
    }

    fn touching_surface(&self) -> Option<TouchingSurface<S::Vector>> {
        self.surface_part()
    }

    fn size(&self) -> Option<SystemSize> {
        Some(self.model.size())
    }

    fn small_strain(&self) -> Option<[f64; 2]> {
        let model = &self.model;
        let largest = || small_strain::largest(&model.mesh, |p| self.displacement(p));
        model.large.is_none().then(largest)
    }

    fn save(&self) -> Vec<u8> {
        let free = &self.free_strain.of_elements;
        postcard::to_stdvec(&(&self.displacement, &self.velocity, free)).unwrap_or_default()
    }

    fn restore(&mut self, saved: &[u8]) -> bool {
        let read: Result<(Vec<f64>, Vec<f64>, Vec<f64>), _> = postcard::from_bytes(saved);
        let total = self.model.freedoms.total();
        match read {
            Ok((q, v, free))
                if [&q, &v]
                    .iter()
                    .all(|x| x.len() == total && x.iter().all(|x| x.is_finite())) =>
            {
                if !self.restore_free_strain(free) {
                    return false;
                }
                self.start = [q.clone(), v.clone()];
                self.elastic.take();
                self.moves = 0;
                (self.displacement, self.velocity) = (q, v);
                true
            }
            _ => false,
        }
    }

    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>> {
        Box::new(self.clone())
    }
}
