//! Reading the bodies of a simulation.

use super::rows::{BodyColumns, BodyMotion};
use crate::geometry::space::{MatrixLike, Space, VectorLike, about_axes, spin_about};
use crate::step::Simulation;

/// The bodies of a run: positions, motion, mass and inertia.
///
/// Bodies are numbered as in [`BodiesView::bodies`], driven bodies as in [`BodyColumns::driven`].
pub trait BodiesView {
    /// Returns the columns of the bodies.
    fn bodies(&self) -> BodyColumns<'_>;
    /// Returns the indices of the grains that have not been removed.
    fn grains(&self) -> Vec<usize>;
    /// Returns for each body whether it is a grain that has not been removed.
    fn grain_flags(&self) -> Vec<bool>;
    /// Returns position and motion of a body.
    fn motion(&self, body: usize) -> BodyMotion;
    /// A vector in the axes of a body, turned to world axes.
    fn turned(&self, body: usize, vector: [f64; 3]) -> [f64; 3];
    /// A vector in world axes, turned to the axes of a body.
    fn turned_back(&self, body: usize, vector: [f64; 3]) -> [f64; 3];
    /// Returns the moments of inertia in the body's own axes, row by row (kg m^2); in 2D a single
    /// number.
    fn inertia_tensor(&self, body: usize) -> [f64; 9];
    /// Returns the angular momentum of a body about its centre at an angular velocity (rad/s), in
    /// world axes (kg m^2/s; kg m/s in 2D).
    fn angular_momentum(&self, body: usize, spin: [f64; 3]) -> [f64; 3];
    /// Returns the kinetic energy of a body (J; J/m in 2D).
    fn kinetic_energy(&self, body: usize) -> f64;
    /// Returns the name of a body in messages: a first body's name, a grain's identity.
    fn body_name(&self, body: u32) -> String;
    /// Returns the impulse (N s; N s/m in 2D) and its moment about the centre (N m s; N s in 2D) of
    /// the contacts on each driven body in the last step.
    fn received(&self) -> Vec<[[f64; 3]; 2]>;
    /// Returns the velocity (m/s) and angular velocity (rad/s) of each driven body at the start of
    /// the last step, after the jumps of imposed motion.
    fn started(&self) -> Vec<[[f64; 3]; 2]>;
    /// Returns the mean force (N; N/m in 2D) and the mean moment about its centre (N m; N in 2D) in
    /// the last step by the contacts on a first body; `None` for an unknown name.
    fn contact_force_on(&self, name: &str) -> Option<[[f64; 3]; 2]>;
}

impl<S: Space> BodiesView for Simulation<S> {
    fn bodies(&self) -> BodyColumns<'_> {
        let bodies = &self.state.bodies;
        BodyColumns {
            id: &bodies.id,
            position: VectorLike::column(&bodies.position),
            velocity: VectorLike::column(&bodies.velocity),
            spin: VectorLike::column(&bodies.spin),
            mass: &bodies.mass,
            inverse_mass: VectorLike::column(&bodies.inverse_mass),
            inertia: &bodies.inertia,
            inverse_inertia: &bodies.inverse_inertia,
            length: &bodies.length,
            removed: &bodies.removed,
            driven: &bodies.driven,
            carriers: &bodies.carriers,
        }
    }
    fn grains(&self) -> Vec<usize> {
        self.state.bodies.grains().collect()
    }
    fn grain_flags(&self) -> Vec<bool> {
        self.state.bodies.grain_flags()
    }
    fn motion(&self, body: usize) -> BodyMotion {
        let bodies = &self.state.bodies;
        BodyMotion {
            position: bodies.position[body].padded(),
            rotation: S::rotation_numbers(&bodies.rotation[body]),
            velocity: bodies.velocity[body].padded(),
            spin: about_axes::<S>(&bodies.spin[body]),
        }
    }
    fn turned(&self, body: usize, vector: [f64; 3]) -> [f64; 3] {
        let vector = S::Vector::from_slice(&vector);
        S::rotate(&self.state.bodies.rotation[body], &vector).padded()
    }
    fn turned_back(&self, body: usize, vector: [f64; 3]) -> [f64; 3] {
        let vector = S::Vector::from_slice(&vector);
        S::unrotate(&self.state.bodies.rotation[body], &vector).padded()
    }
    fn inertia_tensor(&self, body: usize) -> [f64; 9] {
        let bodies = &self.state.bodies;
        let uniform = S::Tensor::uniform(bodies.inertia[body]);
        let own = bodies.tensors.get(body).and_then(Option::as_ref);
        let own = own.map_or(uniform, |t| *t.own());
        let n = S::Spin::N;
        std::array::from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            if i < n && j < n { own.entry(i, j) } else { 0.0 }
        })
    }
    fn angular_momentum(&self, body: usize, spin: [f64; 3]) -> [f64; 3] {
        let bodies = &self.state.bodies;
        about_axes::<S>(&bodies.angular_momentum(body, &spin_about::<S>(&spin)))
    }
    fn kinetic_energy(&self, body: usize) -> f64 {
        self.state.bodies.energy_of(body)
    }
    fn body_name(&self, body: u32) -> String {
        self.state.bodies.name(body)
    }
    fn received(&self) -> Vec<[[f64; 3]; 2]> {
        self.state.received.iter().map(pair::<S>).collect()
    }
    fn started(&self) -> Vec<[[f64; 3]; 2]> {
        self.state.started.iter().map(pair::<S>).collect()
    }
    fn contact_force_on(&self, name: &str) -> Option<[[f64; 3]; 2]> {
        Some(pair::<S>(&self.contact_force_on(name)?))
    }
}

/// A vector and a spin in three components.
fn pair<S: Space>((vector, spin): &(S::Vector, S::Spin)) -> [[f64; 3]; 2] {
    [vector.padded(), about_axes::<S>(spin)]
}
