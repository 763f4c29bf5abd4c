//! Positions, velocities and inertia of all bodies, as a structure of arrays.

use super::contactor::Carrier;
use super::drive::{Dof, Driven};
use super::path::ImposedPaths;
use super::tensor::{self, InertiaTensor};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::threads::sum;
use serde::{Deserialize, Serialize};

/// Approximate time to compute the energy of a body (ns).
const ENERGY: f64 = 5.0;

/// All bodies of a scene, grains and first bodies, as a structure of arrays. In 2D masses are per
/// metre of depth.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Bodies<S: Space> {
    /// Stable identities.
    pub id: Vec<u64>,
    /// Centres of mass (m).
    pub position: Vec<S::Vector>,
    /// Orientations.
    pub rotation: Vec<S::Rotation>,
    /// Velocities of the centres of mass (m/s).
    pub velocity: Vec<S::Vector>,
    /// Angular velocities (rad/s).
    pub spin: Vec<S::Spin>,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Moments of inertia (kg m^2); for anisotropic inertia the mean.
    pub inertia: Vec<f64>,
    /// Anisotropic inertia tensors; empty if there are none.
    pub tensors: Vec<Option<InertiaTensor<S>>>,
    /// Length that scales spins to velocities in the solver (m): the radius of a grain.
    pub length: Vec<f64>,
    /// Inverse mass along each axis; zero where the motion is imposed (1/kg).
    pub inverse_mass: Vec<S::Vector>,
    /// Inverse moment of inertia; zero where the rotation is imposed (1/(kg m^2)).
    pub inverse_inertia: Vec<f64>,
    /// The driven first bodies.
    pub driven: Vec<Driven>,
    /// Paths of the imposed motion of driven bodies, in the same order.
    pub paths: Vec<ImposedPaths<S>>,
    /// Whether each body has been removed: it then has no contacts and is not drawn.
    pub removed: Vec<bool>,
    /// Displacement of each body lost to rounding (m); empty while there is none.
    pub lost: Vec<S::Vector>,
    /// Contactor of a dynamical system that each body represents: such bodies follow their system
    /// and have no inertia of their own. Empty without systems.
    pub carriers: Vec<Option<Carrier>>,
}

impl<S: Space> Bodies<S> {
    /// Bytes per body over all arrays.
    pub const BYTES: usize = size_of::<u64>()
        + 3 * size_of::<S::Vector>()
        + size_of::<S::Rotation>()
        + size_of::<S::Spin>()
        + 4 * size_of::<f64>();

    /// Returns the name of a body in messages: a first body's name, a grain's index.
    pub fn name(&self, body: u32) -> String {
        if let Some(carrier) = self.carrier(body as usize).filter(|c| !c.grain) {
            let (system, contactor) = (carrier.system, carrier.contactor);
            return format!("contactor {contactor} of system {system}");
        }
        match self.driven.iter().find(|d| d.body == body) {
            Some(driven) => format!("body `{}`", driven.name),
            None => format!("grain {}", self.id[body as usize]),
        }
    }

    /// Returns the number of bodies.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Returns whether these are later states of the same bodies: all arrays have their length, and
    /// numbers of motion are finite.
    pub(crate) fn fits(&self, first: &Self) -> bool {
        let n = first.len();
        let columns = [
            self.id.len(),
            self.position.len(),
            self.rotation.len(),
            self.velocity.len(),
            self.spin.len(),
            self.mass.len(),
            self.inertia.len(),
            self.length.len(),
            self.inverse_mass.len(),
            self.inverse_inertia.len(),
            self.removed.len(),
        ];
        let driven = self.driven.iter().zip(&first.driven);
        let same = |(a, b): (&Driven, &Driven)| {
            a.body == b.body
                && a.dofs.len() == b.dofs.len()
                && a.dofs.iter().all(|d| d.error().is_none())
        };
        let paths = self.paths.iter().zip(&first.paths);
        let numbers = self.mass.iter().chain(&self.inertia).chain(&self.length);
        columns == [n; 11]
            && self.tensors.len() == first.tensors.len()
            && (self.lost.is_empty() || self.lost.len() == n)
            && self.carriers == first.carriers
            && [self.driven.len(), self.paths.len()] == [first.driven.len(); 2]
            && driven.into_iter().all(same)
            && paths.into_iter().all(|(a, b)| a.dofs() == b.dofs())
            && self.position.iter().all(VectorLike::is_finite)
            && self.velocity.iter().all(VectorLike::is_finite)
            && self.spin.iter().all(VectorLike::is_finite)
            && numbers.into_iter().all(|x| !x.is_nan())
    }

    /// Returns whether there are no bodies.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Adds a free body at rest; returns its index.
    pub fn add(&mut self, position: S::Vector, mass: f64, inertia: f64, length: f64) -> u32 {
        let index = self.len();
        self.id.push(index as u64);
        self.position.push(position);
        self.rotation.push(S::identity());
        self.velocity.push(S::Vector::zero());
        self.spin.push(S::Spin::zero());
        self.mass.push(mass);
        self.inertia.push(inertia);
        self.length.push(length);
        let mut inverse = S::Vector::zero();
        for k in 0..S::D {
            inverse[k] = 1.0 / mass;
        }
        self.inverse_mass.push(inverse);
        self.inverse_inertia.push(one_over(inertia));
        self.removed.push(false);
        index as u32
    }

    /// Adds a body for a contactor of a dynamical system: without inertia, where the system has it.
    /// `length` is its size (m).
    pub(super) fn add_carried(&mut self, at: S::Vector, length: f64, carrier: Carrier) -> u32 {
        let body = self.add(at, 0.0, 0.0, length);
        let b = body as usize;
        self.inverse_mass[b] = S::Vector::zero();
        self.carriers.resize(b + 1, None);
        self.carriers[b] = Some(carrier);
        body
    }

    /// Returns the contactor that a body represents, if any.
    #[inline]
    pub fn carrier(&self, body: usize) -> Option<Carrier> {
        self.carriers.get(body).copied().flatten()
    }

    /// Returns whether two bodies are contactors of one system that cannot touch each other.
    #[inline]
    pub fn belong_together(&self, a: usize, b: usize) -> bool {
        match (self.carrier(a), self.carrier(b)) {
            (Some(a), Some(b)) => a.system == b.system && !a.touches_itself,
            _ => false,
        }
    }

    /// Adds a free body at rest with an inertia tensor in its own axes (kg m^2); returns its index.
    pub fn add_shaped(
        &mut self,
        position: S::Vector,
        mass: f64,
        inertia: &S::Tensor,
        length: f64,
    ) -> u32 {
        let body = self.add(position, mass, tensor::mean::<S>(inertia), length);
        if let Some(tensor) = InertiaTensor::new(*inertia) {
            self.tensors.resize(self.len(), None);
            self.tensors[body as usize] = Some(tensor);
        }
        body
    }

    /// Returns the anisotropic inertia tensor of a body that rotates freely, if it has one.
    pub fn tensor(&self, body: usize) -> Option<&InertiaTensor<S>> {
        let tensor = self.tensors.get(body)?.as_ref()?;
        (self.inverse_inertia[body] > 0.0).then_some(tensor)
    }

    /// Returns the inverse inertia tensor in world axes; zero where the rotation is imposed (1/(kg
    /// m^2)).
    pub fn inverse_tensor(&self, body: usize) -> S::Tensor {
        match self.tensor(body) {
            Some(tensor) => tensor.inverse(&self.rotation[body]),
            None => S::Tensor::uniform(self.inverse_inertia[body]),
        }
    }

    /// Returns the angular momentum of a body at a spin (kg m^2/s).
    pub fn angular_momentum(&self, body: usize, spin: &S::Spin) -> S::Spin {
        match self.tensor(body) {
            Some(tensor) => tensor.momentum(&self.rotation[body], spin),
            None => *spin * self.inertia[body],
        }
    }

    /// Adds a homogeneous ball of a density (kg/m^3).
    pub fn add_ball(&mut self, position: S::Vector, radius: f64, density: f64) -> u32 {
        let mass = density * S::ball_volume(radius);
        self.add(
            position,
            mass,
            S::BALL_INERTIA * mass * radius * radius,
            radius,
        )
    }

    /// Returns the velocities and spins of the driven bodies, in their order.
    pub(crate) fn motion_of_driven(&self) -> Vec<(S::Vector, S::Spin)> {
        let of = |b: usize| (self.velocity[b], self.spin[b]);
        self.driven.iter().map(|d| of(d.body as usize)).collect()
    }

    /// Makes a body driven, with the drives of time zero.
    pub fn drive(&mut self, driven: Driven) {
        self.paths.push(ImposedPaths::new(driven.dofs.len()));
        self.driven.push(driven);
        self.update_constraints(self.driven.len() - 1, 0.0);
    }

    /// Activates the drives at a time for all bodies whose drives change.
    pub fn engage_stages(&mut self, time: f64) {
        for place in 0..self.driven.len() {
            let mut dofs = self.driven[place].dofs.iter();
            if dofs.any(|d| matches!(d, Dof::Stages(_))) {
                self.update_constraints(place, time);
            }
        }
    }

    /// Replaces the drive of one degree of freedom of a driven body, as active at a time.
    pub fn set_drive(&mut self, place: usize, dof: usize, drive: Dof, time: f64) {
        self.driven[place].dofs[dof] = drive;
        self.paths[place].forget(dof);
        self.update_constraints(place, time);
    }

    /// Removes bodies whose flag is false, before anything else refers to bodies by index; returns
    /// the new index of each body.
    ///
    /// # Panics
    /// The number of flags is not the number of bodies.
    pub fn keep(&mut self, kept: &[bool]) -> Vec<Option<u32>> {
        fn filter<T>(column: &mut Vec<T>, kept: &[bool]) {
            let mut flags = kept.iter();
            column.retain(|_| flags.next().copied().unwrap_or(true));
        }
        filter(&mut self.position, kept);
        filter(&mut self.rotation, kept);
        filter(&mut self.velocity, kept);
        filter(&mut self.spin, kept);
        filter(&mut self.mass, kept);
        filter(&mut self.inertia, kept);
        filter(&mut self.tensors, kept);
        filter(&mut self.length, kept);
        filter(&mut self.inverse_mass, kept);
        filter(&mut self.inverse_inertia, kept);
        filter(&mut self.removed, kept);
        filter(&mut self.lost, kept);
        filter(&mut self.carriers, kept);
        self.id = (0..self.position.len() as u64).collect();
        let mut next = 0;
        let new = |k: &bool| {
            let at = next;
            next += u32::from(*k);
            k.then_some(at)
        };
        let moved: Vec<Option<u32>> = kept.iter().map(new).collect();
        for driven in &mut self.driven {
            driven.body = moved[driven.body as usize].unwrap_or_default();
        }
        moved
    }

    /// Removes a driven body permanently.
    pub fn remove(&mut self, place: usize) {
        let driven = &mut self.driven[place];
        self.removed[driven.body as usize] = true;
        driven.dofs.fill(Dof::Fixed);
        self.paths[place].forget_all();
        self.update_constraints(place, 0.0);
    }

    /// Removes a grain permanently; it is then at rest.
    pub fn remove_body(&mut self, body: usize) {
        self.removed[body] = true;
        (self.velocity[body], self.spin[body]) = (S::Vector::zero(), S::Spin::zero());
        self.inverse_mass[body] = S::Vector::zero();
        self.inverse_inertia[body] = 0.0;
    }

    /// Returns for each body whether it is a grain: not driven, not removed, and not carried by a
    /// system unless that is a deformable grain.
    pub fn grain_flags(&self) -> Vec<bool> {
        let mut grain: Vec<bool> = self.removed.iter().map(|g| !g).collect();
        for (grain, carrier) in grain.iter_mut().zip(&self.carriers) {
            *grain &= carrier.is_none_or(|c| c.grain);
        }
        for driven in &self.driven {
            grain[driven.body as usize] = false;
        }
        grain
    }

    /// Iterates over the grains.
    pub fn grains(&self) -> impl Iterator<Item = usize> + use<S> {
        let grain = self.grain_flags();
        (0..grain.len()).filter(move |b| grain[*b])
    }

    /// Returns the kinetic energy of a body (J).
    pub fn energy_of(&self, b: usize) -> f64 {
        let (v, w) = (&self.velocity[b], &self.spin[b]);
        0.5 * (self.mass[b] * v.dot(v) + w.dot(&self.angular_momentum(b, w)))
    }

    /// Updates inverse masses and inertias: zero for imposed degrees of freedom.
    fn update_constraints(&mut self, place: usize, time: f64) {
        let driven = &self.driven[place];
        let b = driven.body as usize;
        let imposed = |d: &Dof| d.imposed_velocity(time).is_some();
        for k in 0..S::D {
            self.inverse_mass[b][k] = if imposed(&driven.dofs[k]) {
                0.0
            } else {
                1.0 / self.mass[b]
            };
        }
        self.inverse_inertia[b] = if driven.dofs[S::D..].iter().any(imposed) {
            0.0
        } else {
            one_over(self.inertia[b])
        };
    }

    /// Returns whether contacts cannot move the body at all.
    pub fn immovable(&self, body: usize) -> bool {
        self.inverse_mass[body] == S::Vector::zero() && self.inverse_inertia[body] == 0.0
    }

    /// Returns which bodies never move: all their degrees of freedom are fixed.
    pub fn fixed_bodies(&self) -> Vec<bool> {
        let mut still = vec![false; self.len()];
        for driven in &self.driven {
            still[driven.body as usize] = driven.dofs.iter().all(|d| *d == Dof::Fixed);
        }
        still
    }

    /// Returns the kinetic energy of rigid bodies (J). Imposed degrees of freedom are included.
    pub fn kinetic_energy(&self) -> f64 {
        self.sum_kinetic_energy(false)
    }

    /// Returns [`Self::kinetic_energy`] with the same bits, on several threads if `parallel` and
    /// there are enough bodies.
    pub fn sum_kinetic_energy(&self, parallel: bool) -> f64 {
        sum(parallel, self.len(), ENERGY, |b| {
            if self.carrier(b).is_none() {
                self.energy_of(b)
            } else {
                0.0
            }
        })
    }
}

/// Returns the inverse of an inertia; zero for a body without one, which does not rotate.
fn one_over(inertia: f64) -> f64 {
    if inertia > 0.0 { 1.0 / inertia } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn balls_have_the_inertia_of_the_books() {
        let mut disks = Bodies::<Dim2>::default();
        disks.add_ball(Vector2::new(0.0, 0.0), 0.5, 2.0);
        let m = 2.0 * std::f64::consts::PI * 0.25;
        assert!((disks.mass[0] - m).abs() < 1e-15 && (disks.inertia[0] - m / 8.0).abs() < 1e-15);
        let mut spheres = Bodies::<Dim3>::default();
        spheres.add_ball(Vector3::zeros(), 0.5, 2.0);
        let m = 2.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        assert!((spheres.inertia[0] - 0.4 * m * 0.25).abs() < 1e-15);
    }
}
