//! Thermal expansion of a body of finite elements.
//!
//! A point at a temperature T has the free strain e = alpha (T - T_0), and an element the mean of
//! its points. In small strain the stress is that of the strain less the free strain,
//!
//! ```text
//! sigma = C : (epsilon - e 1),   f_a = V (3 lambda + 2 G) e grad N_a
//! ```
//!
//! with f_a the force of the free strain on a corner, and in large strain the energy is (1 + e)^3
//! W(F/(1 + e)), see [`crate::strain`]. In plane strain the depth is constant, so that a free body
//! expands by (1 + nu) e in the plane.
//!
//! The free strain changes at the start of a step, at constant displacement. The resulting increase
//! of the stored energy is the work of expansion.
//!
//! Source: B. A. Boley, J. H. Weiner, "Theory of Thermal Stresses" (1960), chapter 3.

use super::ElasticBody;
use crate::element::Simplex;
use crate::material::{Elasticity, Symmetric};
use fretwork_core::geometry::space::Space;
use std::sync::Arc;

/// Free strains of a body and derived quantities; all empty without expansion.
#[derive(Clone, Debug)]
pub(crate) struct FreeStrain<S: Space> {
    /// Free strain of each point of the mesh, or a single one for all.
    of_points: Vec<f64>,
    /// Free strain of each element.
    pub of_elements: Vec<f64>,
    /// The elements in small strain.
    simplices: Arc<Vec<Option<Simplex<S>>>>,
    /// Force on each coordinate in small strain (N; N/m in 2D).
    force: Vec<f64>,
    /// Work at each point due to the last change (J; J/m in 2D).
    pub work: Vec<f64>,
}

impl<S: Space> Default for FreeStrain<S> {
    fn default() -> Self {
        Self {
            of_points: Vec::new(),
            of_elements: Vec::new(),
            simplices: Arc::default(),
            force: Vec::new(),
            work: Vec::new(),
        }
    }
}

impl<S: Space> FreeStrain<S> {
    /// Returns the force on a coordinate (N; N/m in 2D).
    #[inline]
    pub fn force(&self, coordinate: usize) -> f64 {
        self.force.get(coordinate).copied().unwrap_or(0.0)
    }

    /// Returns the free strain of an element.
    #[inline]
    pub fn of(&self, element: usize) -> f64 {
        self.of_elements.get(element).copied().unwrap_or(0.0)
    }
}

impl<S: Space> ElasticBody<S> {
    /// Sets the free strain of each point, or a single one for all points.
    pub(super) fn take_free_strain(&mut self, of_points: &[f64]) {
        if of_points == self.free_strain.of_points {
            self.free_strain.work.fill(0.0);
            return;
        }
        self.find_simplices();
        let mesh = &self.model.mesh;
        let one = |p: u32| match of_points {
            [all] => *all,
            _ => of_points[p as usize],
        };
        let share = 1.0 / (S::D + 1) as f64;
        let mut now = Vec::new();
        let mut work = vec![0.0; mesh.points().len()];
        for (e, points) in mesh.elements().enumerate() {
            let (from, to) = (
                self.free_strain.of(e),
                share * points.iter().map(|p| one(*p)).sum::<f64>(),
            );
            now.push(to);
            if from == to {
                continue;
            }
            let gained = match &self.model.large {
                Some(large) => {
                    let [to, from] =
                        [to, from].map(|e_free| large.energy_of(e, &self.displacement, e_free));
                    to - from
                }
                None => self.energy_gained(e, points, [from, to]),
            };
            for p in points {
                work[*p as usize] += gained * share;
            }
        }
        self.free_strain.force = self.force_of(&now);
        self.free_strain.of_elements = now;
        self.free_strain.of_points = of_points.to_vec();
        self.free_strain.work = work;
    }

    /// Restores the saved free strains of the elements; returns false where they belong to another
    /// body.
    pub(super) fn restore_free_strain(&mut self, of_elements: Vec<f64>) -> bool {
        if !of_elements.is_empty() && of_elements.len() != self.model.mesh.elements().count() {
            return false;
        }
        self.find_simplices();
        self.free_strain.force = self.force_of(&of_elements);
        self.free_strain.of_elements = of_elements;
        self.free_strain.of_points.clear();
        self.free_strain.work.clear();
        true
    }

    /// Computes the elements in small strain, where this has not been done.
    fn find_simplices(&mut self) {
        if self.model.large.is_none() && self.free_strain.simplices.is_empty() {
            let mesh = &self.model.mesh;
            let simplex = |points: &[u32]| Simplex::<S>::new(&mesh.corners(points));
            self.free_strain.simplices = Arc::new(mesh.elements().map(simplex).collect());
        }
    }

    /// Returns the force of free strains of the elements on each coordinate in small strain (N; N/m
    /// in 2D).
    fn force_of(&self, free: &[f64]) -> Vec<f64> {
        if self.model.large.is_some() || free.is_empty() {
            return Vec::new();
        }
        let (mesh, freedoms) = (&self.model.mesh, &self.model.freedoms);
        let modulus = self.model.material.thermal_modulus();
        let mut force = vec![0.0; freedoms.total()];
        let elements = mesh.elements().zip(self.free_strain.simplices.iter());
        for ((points, simplex), free) in elements.zip(free) {
            let Some(simplex) = simplex else { continue };
            let pressure = simplex.volume * modulus * free;
            for (p, g) in points.iter().zip(simplex.gradients()) {
                for axis in 0..S::D {
                    force[freedoms.of(*p, axis)] += pressure * g[axis];
                }
            }
        }
        force
    }

    /// Returns the change of the stored energy of an element in small strain (J; J/m in 2D) when
    /// its free strain changes.
    fn energy_gained(&self, e: usize, points: &[u32], [from, to]: [f64; 2]) -> f64 {
        let Some((simplex, strain)) = self.strain_of(e, points) else {
            return 0.0;
        };
        let trace = strain[0] + strain[1] + strain[2];
        let modulus = self.model.material.thermal_modulus();
        // The derivative -modulus tr(epsilon - e 1) is linear in e: its value half-way is exact.
        -modulus * simplex.volume * (to - from) * (trace - 1.5 * (from + to))
    }

    /// Returns an element in small strain, and its strain.
    fn strain_of(&self, e: usize, points: &[u32]) -> Option<(&Simplex<S>, Symmetric)> {
        let simplex = self.free_strain.simplices.get(e)?.as_ref()?;
        // Displacements are relative to the first corner, so that a translation leaves no rounding.
        let first = self.displacement(points[0]);
        let moved = points.iter().map(|p| self.displacement(*p) - first);
        let strain = simplex.strain(&moved.collect::<Vec<S::Vector>>());
        Some((simplex, strain))
    }

    /// Returns the energy stored in small strain with free strains (J; J/m in 2D).
    pub(super) fn stored_with_free_strain(&self) -> f64 {
        let material = &self.model.material;
        let one = |(e, points): (usize, &[u32])| {
            let Some((simplex, strain)) = self.strain_of(e, points) else {
                return 0.0;
            };
            let left = Elasticity::less(&strain, self.free_strain.of(e));
            simplex.volume * material.energy(&left)
        };
        self.model.mesh.elements().enumerate().map(one).sum()
    }
}
