//! Thermal expansion of a body of finite elements.
//!
//! A point at a temperature T has the free strain e = alpha (T - T_0), and an element the mean of its points. In small strain the stress is
//! that of what free strain leaves,
//!
//! ```text
//! sigma = C : (epsilon - e 1),   f_a = V (3 lambda + 2 G) e grad N_a
//! ```
//!
//! with f_a the force of the free strain on a corner, and in large strain the energy is that of F/(1 + e), see [`crate::strain`]. In
//! plane strain the depth stays, so that a free body expands by (1 + nu) e in the plane.
//!
//! The free strain changes at the start of a step, where the displacement does not. What the stored energy gains by that is the work of expansion.
//!
//! Source: B. A. Boley, J. H. Weiner, "Theory of Thermal Stresses" (1960), chapter 3.

use super::ElasticBody;
use crate::compiled::Deformable;
use crate::element::Simplex;
use crate::material::Elasticity;

/// Free strains of the elements of a body and what follows from them; all empty without expansion.
#[derive(Clone, Debug, Default)]
pub(crate) struct FreeStrain {
    /// Of each element.
    pub of_elements: Vec<f64>,
    /// Force on each coordinate in small strain (N; N/m in 2D).
    force: Vec<f64>,
    /// Work at each point by the last change (J; J/m in 2D).
    pub work: Vec<f64>,
}

impl FreeStrain {
    /// Force on a coordinate (N; N/m in 2D).
    #[inline]
    pub fn force(&self, coordinate: usize) -> f64 {
        self.force.get(coordinate).copied().unwrap_or(0.0)
    }
}

impl<S: Deformable> ElasticBody<S> {
    /// Takes the free strain of each point, or one of all points.
    pub(super) fn take_free_strain(&mut self, of_points: &[f64]) {
        let mesh = &self.model.mesh;
        let one = |p: u32| match of_points {
            [all] => *all,
            _ => of_points[p as usize],
        };
        let share = 1.0 / (S::D + 1) as f64;
        let means = mesh.elements().map(|points| {
            let sum: f64 = points.iter().map(|p| one(*p)).sum();
            sum * share
        });
        let now: Vec<f64> = means.collect();
        if now == self.free_strain.of_elements {
            self.free_strain.work.fill(0.0);
            return;
        }
        let before = std::mem::take(&mut self.free_strain.of_elements);
        let mut work = vec![0.0; mesh.points().len()];
        for (e, points) in mesh.elements().enumerate() {
            let from = before.get(e).copied().unwrap_or(0.0);
            if from == now[e] {
                continue;
            }
            let gained = match &self.model.large {
                Some(large) => {
                    let [to, from] =
                        [now[e], from].map(|free| large.energy_of(e, &self.displacement, free));
                    to - from
                }
                None => self.energy_gained(points, from, now[e]),
            };
            for p in points {
                work[*p as usize] += gained * share;
            }
        }
        self.free_strain = FreeStrain {
            force: match self.model.large {
                None => self.force_of(&now),
                Some(_) => Vec::new(),
            },
            of_elements: now,
            work,
        };
    }

    /// Takes the free strains of the elements that a body was saved with.
    pub(super) fn restore_free_strain(&mut self, of_elements: Vec<f64>) {
        self.free_strain = FreeStrain {
            force: match self.model.large {
                None => self.force_of(&of_elements),
                Some(_) => Vec::new(),
            },
            of_elements,
            work: Vec::new(),
        };
    }

    /// Force of free strains of the elements on each coordinate in small strain (N; N/m in 2D).
    fn force_of(&self, free: &[f64]) -> Vec<f64> {
        let (mesh, freedoms) = (&self.model.mesh, &self.model.freedoms);
        let modulus = self.model.material.thermal_modulus();
        let mut force = vec![0.0; freedoms.total()];
        for (points, free) in mesh.elements().zip(free) {
            let Some(simplex) = Simplex::<S>::new(&mesh.corners(points)) else {
                continue;
            };
            let pressure = simplex.volume * modulus * free;
            for (p, g) in points.iter().zip(simplex.gradients()) {
                for axis in 0..S::D {
                    force[freedoms.of(*p, axis)] += pressure * g[axis];
                }
            }
        }
        force
    }

    /// What an element in small strain stores more (J; J/m in 2D) with one free strain than with another.
    fn energy_gained(&self, points: &[u32], from: f64, to: f64) -> f64 {
        let Some((simplex, strain)) = self.strain_of(points) else {
            return 0.0;
        };
        let trace = strain[0] + strain[1] + strain[2];
        let modulus = self.model.material.thermal_modulus();
        // The derivative -modulus tr(epsilon - e 1) is linear in e: its value half-way is exact.
        -modulus * simplex.volume * (to - from) * (trace - 1.5 * (from + to))
    }

    /// An element in small strain, and its strain.
    fn strain_of(&self, points: &[u32]) -> Option<(Simplex<S>, [f64; 6])> {
        let simplex = Simplex::<S>::new(&self.model.mesh.corners(points))?;
        // Less that of the first corner: a translation leaves no rounding.
        let first = self.displacement(points[0]);
        let moved = points.iter().map(|p| self.displacement(*p) - first);
        let strain = simplex.strain(&moved.collect::<Vec<S::Vector>>());
        Some((simplex, strain))
    }

    /// Energy stored in small strain with free strains (J; J/m in 2D).
    pub(super) fn stored_with_free_strain(&self) -> f64 {
        let material = &self.model.material;
        let each = self
            .model
            .mesh
            .elements()
            .zip(&self.free_strain.of_elements);
        let one = |(points, free): (&[u32], &f64)| {
            let Some((simplex, strain)) = self.strain_of(points) else {
                return 0.0;
            };
            simplex.volume * material.energy(&Elasticity::less(&strain, *free))
        };
        each.map(one).sum()
    }
}
