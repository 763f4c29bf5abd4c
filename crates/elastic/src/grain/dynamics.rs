//! A step of a deformable grain: its frame as a rigid body, its modes as oscillators, both by the
//! theta scheme.

use super::shape::stresses;
use super::{ElasticGrain, GrainAtDetection, GrainState, ModalResponse};
use crate::material::Symmetric;
use crate::small_strain;
use crate::touching_surface::closed_surface;
use fretwork_core::bodies::{
    Contactor, ContactorMotion, DeformedMesh, DynamicalSystem, Nodes, SystemSize, SystemStep,
    SystemWork,
};
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use nalgebra::{Matrix3, Vector3};
use std::sync::{Arc, OnceLock};

impl<S: Space> ElasticGrain<S> {
    /// Returns the factor by which the rigid part of A^-1 exceeds the inverse mass and inertia.
    fn frame_over(&self) -> f64 {
        let [h, theta] = self.formed.as_ref().map_or([0.0, 1.0], |f| f.of);
        1.0 / (1.0 + h * theta * self.model.damping.mass)
    }

    /// Returns the elastic compliance of the surface for an impulse along an axis of a vertex, in
    /// the frame.
    fn column<'a>(&self, formed: &'a ModalResponse, vertex: usize, axis: usize) -> &'a [f64] {
        formed.columns[vertex * S::D + axis].get_or_init(|| {
            let (shape, scale) = (&self.model.shape, self.model.scale);
            let modes = shape.at(vertex, axis).iter().zip(&formed.over);
            shape.coordinates(modes.map(|(phi, over)| scale * scale * phi * over))
        })
    }

    /// Returns the arm of a vertex from the origin of the frame, in world axes (m); zero for the
    /// node that represents rotation.
    fn arm(&self, node: u32) -> S::Vector {
        let vertex = self.vertices.get(node as usize);
        vertex.map_or(S::Vector::zero(), |at| S::rotate(&self.state.rotation, at))
    }

    /// Returns whether a node represents the rotation of the frame; it follows the vertices.
    fn is_turning(&self, node: u32) -> bool {
        node as usize == self.vertices.len()
    }

    /// Returns the velocity of the node that represents rotation, at an angular velocity of the
    /// frame.
    fn turning_velocity(&self, spin: &S::Spin) -> S::Vector {
        let mut out = S::Vector::zero();
        for k in 0..S::Spin::N {
            out[k] = spin[k] * self.model.contactor.radius;
        }
        out
    }

    /// Returns the moment of an impulse on that node.
    fn turning_moment(&self, impulse: &S::Vector) -> S::Spin {
        let mut out = S::Spin::zero();
        for k in 0..S::Spin::N {
            out[k] = impulse[k] * self.model.contactor.radius;
        }
        out
    }

    /// Returns the velocities averaged over the step.
    fn average(&self, theta: f64) -> Vec<f64> {
        let pairs = self.start.velocity.iter().zip(&self.state.velocity);
        pairs.map(|(v, w)| v + theta * (w - v)).collect()
    }

    fn energy_of_spin(state: &GrainState<S>, inertia: &S::Tensor) -> f64 {
        let (_, spin) = Self::of_frame(&state.velocity);
        let turned = S::turned_tensor(&state.rotation, inertia);
        0.5 * spin.dot(&turned.apply(&spin))
    }
}

impl<S: Space> DynamicalSystem<S> for ElasticGrain<S> {
    fn name(&self) -> &str {
        &self.model.name
    }

    fn freedoms(&self) -> usize {
        self.state.velocity.len()
    }

    fn velocity(&self) -> &[f64] {
        &self.state.velocity
    }

    fn set_velocity(&mut self, velocity: &[f64]) {
        self.state.velocity.copy_from_slice(velocity);
        let (_, spin) = Self::of_frame(velocity);
        self.state.momentum = self.turned(&self.model.inertia).apply(&spin);
    }

    fn begin_step(&mut self, step: &SystemStep<S>) {
        self.start.clone_from(&self.state);
        let of = [step.h, step.theta];
        if self.formed.as_ref().is_none_or(|formed| formed.of != of) {
            let length = step.h * step.theta;
            let over =
                |rate: &f64| 1.0 / (1.0 + length * self.damping(*rate) + length * length * rate);
            let columns = S::D * self.vertices.len();
            self.formed = Some(Arc::new(ModalResponse {
                of,
                over: self.model.rates.iter().map(over).collect(),
                columns: (0..columns).map(|_| OnceLock::new()).collect(),
            }));
        }
    }

    fn linearise(&mut self, step: &SystemStep<S>) {
        let (_, spin) = Self::of_frame(&self.state.velocity);
        let (_, free) = Self::of_frame(&self.free_velocity(step));
        self.middle = GrainAtDetection {
            rotation: self.state.rotation,
            spin,
            free,
        };
    }

    fn advance(&mut self, time: f64) {
        let (velocity, spin) = Self::of_frame(&self.state.velocity);
        self.state.position += velocity * time;
        match &self.model.tensor {
            Some(tensor) => {
                let (rotation, spin) = tensor.free_rotation(&self.state.rotation, &spin, time);
                self.state.rotation = rotation;
                for k in 0..S::Spin::N {
                    self.state.velocity[S::D + k] = spin[k];
                }
            }
            None => {
                self.state.rotation = S::turned(&self.state.rotation, &(spin * time));
            }
        }
        let rates = Self::of_modes(&self.state.velocity);
        for (q, v) in self.state.amplitudes.iter_mut().zip(rates) {
            *q += v * time;
        }
        self.place_vertices();
    }

    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64> {
        let SystemStep { h, theta, .. } = *step;
        let over = self.frame_over();
        let brake = h * self.model.damping.mass * over;
        let (velocity, _) = Self::of_frame(&self.start.velocity);
        let velocity = velocity * (1.0 - brake) + step.gravity * (h * over);
        // Angular momentum is conserved where moments of inertia differ by axis.
        let spin = self.turned(&self.model.inverse).apply(&self.start.momentum) * (1.0 - brake);
        let mut out: Vec<f64> = (0..S::D).map(|k| velocity[k]).collect();
        out.extend((0..S::Spin::N).map(|k| spin[k]));
        let Some(formed) = &self.formed else {
            return out;
        };
        let state = self.start.amplitudes.iter();
        let state = state.zip(Self::of_modes(&self.start.velocity));
        let modes = self.model.rates.iter().zip(&formed.over).zip(state);
        out.extend(modes.map(|((rate, over), (q, v))| {
            v - h * over * (self.damping(*rate) * v + rate * (q + h * theta * v))
        }));
        out
    }

    fn solve(&self, impulse: &mut [f64]) {
        let over = self.frame_over();
        let (_, moment) = Self::of_frame(impulse);
        let spin = self.turned(&self.model.inverse).apply(&moment) * over;
        let (frame, modes) = impulse.split_at_mut(S::D + S::Spin::N);
        for (k, p) in frame.iter_mut().enumerate() {
            *p = if k < S::D {
                *p * over / self.model.mass
            } else {
                spin[k - S::D]
            };
        }
        if let Some(formed) = &self.formed {
            for (p, over) in modes.iter_mut().zip(&formed.over) {
                *p *= over;
            }
        }
    }

    fn work(&self, step: &SystemStep<S>) -> SystemWork {
        let SystemStep { h, theta, .. } = *step;
        let model = &self.model;
        let average = self.average(theta);
        let (velocity, _) = Self::of_frame(&average);
        let (before, _) = Self::of_frame(&self.start.velocity);
        let (after, _) = Self::of_frame(&self.state.velocity);
        let alpha = model.damping.mass;
        let mut work = SystemWork {
            potential: -h * model.mass * step.gravity.dot(&velocity),
            damping: h * alpha * model.mass * velocity.dot(&velocity),
            scheme: (theta - 0.5) * model.mass * (after - before).dot(&(after - before)),
            ..SystemWork::default()
        };
        // Contacts rotated the grain with its inertia at q_m.
        let GrainAtDetection {
            rotation,
            spin: spin_before,
            free: spin_free,
        } = &self.middle;
        let inertia = S::turned_tensor(rotation, &model.inertia);
        let spin_after = S::turned_tensor(rotation, &model.inverse).apply(&self.state.momentum);
        let spin = *spin_before + (spin_after - *spin_before) * theta;
        let received = inertia.apply(&(spin_after - *spin_free)) * (1.0 + h * theta * alpha);
        let braked = h * alpha * spin.dot(&inertia.apply(&spin));
        let gained = Self::energy_of_spin(&self.state, &model.inertia)
            - Self::energy_of_spin(&self.start, &model.inertia);
        work.damping += braked;
        work.scheme += received.dot(&spin) - braked - gained;
        let start = Self::of_modes(&self.start.velocity).iter();
        let modes = start.zip(Self::of_modes(&self.state.velocity));
        let modes = modes.zip(Self::of_modes(&average)).zip(&model.rates);
        for (((v, w), mean), rate) in modes {
            work.damping += h * self.damping(*rate) * mean * mean;
            work.scheme += (theta - 0.5) * ((w - v).powi(2) + h * h * rate * mean * mean);
        }
        work
    }

    fn kinetic_energy(&self) -> f64 {
        let (velocity, _) = Self::of_frame(&self.state.velocity);
        let modes = Self::of_modes(&self.state.velocity).iter();
        let modes: f64 = modes.map(|v| v * v).sum();
        0.5 * (self.model.mass * velocity.dot(&velocity) + modes)
            + Self::energy_of_spin(&self.state, &self.model.inertia)
    }

    fn stored_energy(&self) -> f64 {
        let modes = self.state.amplitudes.iter().zip(&self.model.rates);
        0.5 * modes.map(|(q, rate)| rate * q * q).sum::<f64>()
    }

    fn mass(&self) -> f64 {
        self.model.mass
    }

    fn length(&self) -> f64 {
        self.model.contactor.radius
    }

    fn is_grain(&self) -> bool {
        true
    }

    fn node_position(&self, node: u32) -> S::Vector {
        self.state.position + self.arm(node)
    }

    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector {
        let (frame, spin) = Self::of_frame(velocity);
        if self.is_turning(node) {
            return self.turning_velocity(&spin);
        }
        let mut own = S::Vector::zero();
        for axis in 0..S::D {
            let modes = self.model.shape.at(node as usize, axis).iter();
            let modes = modes.zip(Self::of_modes(velocity));
            own[axis] = self.model.scale * modes.map(|(phi, v)| phi * v).sum::<f64>();
        }
        frame + S::spin_velocity(&spin, &self.arm(node)) + S::rotate(&self.state.rotation, &own)
    }

    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]) {
        if self.is_turning(node) {
            let moment = self.turning_moment(impulse);
            for k in 0..S::Spin::N {
                generalised[S::D + k] += moment[k];
            }
            return;
        }
        let moment = S::moment(&self.arm(node), impulse);
        let own = S::unrotate(&self.state.rotation, impulse) * self.model.scale;
        let (frame, modes) = generalised.split_at_mut(S::D + S::Spin::N);
        for (k, p) in frame.iter_mut().enumerate() {
            *p += if k < S::D {
                impulse[k]
            } else {
                moment[k - S::D]
            };
        }
        for axis in 0..S::D {
            let phi = self.model.shape.at(node as usize, axis);
            for (p, phi) in modes.iter_mut().zip(phi) {
                *p += phi * own[axis];
            }
        }
    }

    fn contactors(&self) -> Vec<Contactor> {
        vec![self.model.contactor.clone()]
    }

    fn contact_nodes(&self, _contactor: &Contactor, arm: &S::Vector) -> Nodes {
        self.nodes_at(&S::unrotate(&self.state.rotation, arm))
    }

    fn turning_node(&self, contactor: &Contactor, _arm: &S::Vector) -> Option<(u32, f64)> {
        Some((self.vertices.len() as u32, contactor.radius))
    }

    fn surface(&self, _contactor: &Contactor) -> Option<Box<dyn Surface<S>>> {
        closed_surface(self.vertices.clone(), self.model.shape.facets()).ok()
    }

    fn surface_vertices(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        self.vertices.clone()
    }

    fn point_areas(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        let unit = self.model.size.powi(S::D as i32 - 1);
        let areas = self.model.shape.tributary().into_iter();
        areas.map(|area| area * unit).collect()
    }

    fn contactor_velocity(&self, _contactor: &Contactor, velocity: &[f64]) -> (S::Vector, S::Spin) {
        Self::of_frame(velocity)
    }

    fn contactor_motion(&self, contactor: &Contactor) -> ContactorMotion<S> {
        let (velocity, spin) = self.contactor_velocity(contactor, &self.state.velocity);
        ContactorMotion {
            position: self.state.position,
            rotation: self.state.rotation,
            velocity,
            spin,
        }
    }

    fn compliance(&self, nodes: &[u32]) -> Vec<S::Matrix> {
        let count = nodes.len();
        let mut out = vec![S::Matrix::uniform(0.0); count * count];
        let Some(formed) = &self.formed else {
            return out;
        };
        let over = self.frame_over();
        let inverse = self.turned(&self.model.inverse).scaled(over);
        let mut units = [S::Vector::zero(); 3];
        for (axis, unit) in units.iter_mut().enumerate().take(S::D) {
            unit[axis] = 1.0;
        }
        let arms: Vec<S::Vector> = nodes.iter().map(|n| self.arm(*n)).collect();
        // The axes of the frame in the world, in which elastic columns are kept.
        let own = units.map(|unit| S::rotate(&self.state.rotation, &unit));
        for (of, node) in nodes.iter().enumerate() {
            for axis in 0..S::D {
                let unit = &units[axis];
                let turns = self.is_turning(*node);
                let moment = match turns {
                    true => self.turning_moment(unit),
                    false => S::moment(&arms[of], unit),
                };
                let spin = inverse.apply(&moment);
                let column = match turns {
                    true => &[][..],
                    false => self.column(formed, *node as usize, axis),
                };
                for (row, seen) in nodes.iter().enumerate() {
                    let block = &mut out[row * count + of];
                    if self.is_turning(*seen) {
                        let turning = self.turning_velocity(&spin);
                        *block = *block + S::Matrix::dyad(&turning, unit);
                        continue;
                    }
                    let rigid = S::spin_velocity(&spin, &arms[row]);
                    if turns {
                        *block = *block + S::Matrix::dyad(&rigid, unit);
                        continue;
                    }
                    let rigid = *unit * (over / self.model.mass) + rigid;
                    let from = *seen as usize * S::D;
                    let response = S::Vector::from_slice(&column[from..from + S::D]);
                    let elastic = S::rotate(&self.state.rotation, &response);
                    *block = *block
                        + S::Matrix::dyad(&rigid, unit)
                        + S::Matrix::dyad(&elastic, &own[axis]);
                }
            }
        }
        out
    }

    fn deformed_mesh(&self) -> Option<DeformedMesh<S::Vector>> {
        let (model, rotation) = (&self.model, &self.state.rotation);
        let mesh = model.shape.mesh();
        let displacements = self.displacements();
        let turned = displacements.iter().map(|u| S::rotate(rotation, u));
        let at = |x: &S::Vector| self.state.position + S::rotate(rotation, &(*x * model.size));
        // The strain equals that of the mesh of unit size with displacements in the same unit.
        let small: Vec<S::Vector> = displacements
            .iter()
            .map(|u| *u * (1.0 / model.size))
            .collect();
        let stress = stresses(mesh, &model.material, &small);
        Some(DeformedMesh {
            points: mesh.points().iter().map(at).collect(),
            displacement: turned.collect(),
            elements: mesh.elements().flatten().copied().collect(),
            boundary: (0..mesh.facets())
                .flat_map(|f| mesh.facet(f).iter().copied())
                .collect(),
            stress: stress
                .iter()
                .map(|s| turned_stress::<S>(rotation, s))
                .collect(),
        })
    }

    fn mesh_velocity(&self) -> Vec<S::Vector> {
        let (model, rotation) = (&self.model, &self.state.rotation);
        let (velocity, spin) = Self::of_frame(&self.state.velocity);
        let rates = model
            .shape
            .displacements(Self::of_modes(&self.state.velocity));
        let points = model.shape.mesh().points().iter().zip(self.displacements());
        let moves = points.zip(rates).map(|((x, u), rate)| {
            let arm = S::rotate(rotation, &(*x * model.size + u));
            velocity + S::spin_velocity(&spin, &arm) + S::rotate(rotation, &(rate * model.scale))
        });
        moves.collect()
    }

    fn mesh_at_start(&self) -> Vec<S::Vector> {
        let (at, rotation) = &self.model.origin;
        let points = self.model.shape.mesh().points().iter();
        let placed = points.map(|x| *at + S::rotate(rotation, &(*x * self.model.size)));
        placed.collect()
    }

    fn small_strain(&self) -> Option<[f64; 2]> {
        let displacements = self.displacements();
        let over = 1.0 / self.model.size;
        let of = |p: u32| displacements[p as usize] * over;
        Some(small_strain::largest(self.model.shape.mesh(), of))
    }

    fn size(&self) -> Option<SystemSize> {
        let (unknowns, points) = (self.state.velocity.len(), self.vertices.len());
        let point = S::D * S::D * points * size_of::<f64>();
        Some(SystemSize {
            unknowns,
            matrix: self.model.rates.len() * size_of::<f64>(),
            factor: 0,
            surface: points * point,
            point,
            operations: [0.0, 2.0 * unknowns as f64],
            refactorised: false,
        })
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.state).unwrap_or_default()
    }

    fn restore(&mut self, saved: &[u8]) -> bool {
        match postcard::from_bytes::<GrainState<S>>(saved) {
            Ok(state)
                if state.amplitudes.len() == self.state.amplitudes.len()
                    && state.velocity.len() == self.state.velocity.len() =>
            {
                self.start.clone_from(&state);
                self.state = state;
                self.place_vertices();
                true
            }
            _ => false,
        }
    }

    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>> {
        Box::new(self.clone())
    }
}

/// A stress of the frame in world axes.
fn turned_stress<S: Space>(rotation: &S::Rotation, s: &Symmetric) -> Symmetric {
    let mut axes = Matrix3::identity();
    for k in 0..S::D {
        let mut unit = S::Vector::zero();
        unit[k] = 1.0;
        axes.set_column(k, &Vector3::from(S::rotate(rotation, &unit).padded()));
    }
    let own = Matrix3::new(s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2]);
    let t = axes * own * axes.transpose();
    [
        t[(0, 0)],
        t[(1, 1)],
        t[(2, 2)],
        t[(1, 2)],
        t[(0, 2)],
        t[(0, 1)],
    ]
}
