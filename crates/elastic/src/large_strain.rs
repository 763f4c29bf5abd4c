//! Elements in large strain or rotation: their forces over a step, and their tangent.
//!
//! With the gradients F and F+ of the motion at the start and at the end of a step, the forces of
//! the step are those of
//!
//! ```text
//! P = F_theta S(C_theta)
//! F_theta = (1 - theta) F + theta F+,   C_theta = (1 - theta) F^T F + theta F+^T F+
//! ```
//!
//! on the nodes f_a = V P g_a. The strain is averaged, not the position: a rotation over the step
//! causes no strain, whatever its angle, where F_theta^T F_theta would shrink by a factor cos^2 of
//! half the angle. At theta = 1/2 the moment of these forces about any point is zero at the middle
//! of the step, so that angular momentum is conserved, and their work is that of S along the change
//! of C.
//!
//! The tangent is that of P with the derivative of the strain evaluated at F_theta in place of F+,
//! which makes it symmetric. At theta = 1 it is the exact tangent, K_t = df/dq; otherwise its error
//! is about half of (F+ - F), and iterations converge by that factor.
//!
//! Sources: J. C. Simo and N. Tarnow, "The discrete energy-momentum method", Z. Angew. Math. Phys.
//! 43 (1992); J. Bonet and R. D. Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis",
//! 2nd edition (2008), chapters 8 and 9; for tangents that are not positive J. Teran, E. Sifakis,
//! G. Irving and R. Fedkiw, "Robust quasistatic finite elements and flesh simulation" (2005).

use crate::element::{CORNERS, Simplex};
use crate::freedom::Freedoms;
use crate::material::{Elasticity, Symmetric};
use crate::matrix::{Pattern, Sparse};
use crate::mesh::{Mesh, place};
use crate::strain::{Response, Strain};
use fretwork_core::geometry::space::{Space, VectorLike};
use nalgebra::{DMatrix, Matrix3, Vector3};
use std::sync::OnceLock;

/// Motion of a step from some coordinates to others (m).
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'a> {
    /// Coordinates at the start of the step.
    pub start: &'a [f64],
    /// Coordinates at the end of the step.
    pub end: &'a [f64],
    /// Length of the step (s).
    pub h: f64,
    /// Theta.
    pub theta: f64,
    /// Free strain of each element; empty without expansion.
    pub free_strain: &'a [f64],
}

/// Internal forces of a step on each coordinate (N; N/m in 2D).
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// Forces of elasticity.
    pub elastic: Vec<f64>,
    /// Forces of damping by stiffness.
    pub viscous: Vec<f64>,
    /// Sum of the magnitudes of the contributions of elements: the scale for small forces.
    pub size: Vec<f64>,
}

/// The elements of a body in large strain or rotation.
#[derive(Debug)]
pub struct LargeStrain<S: Space> {
    strain: Strain,
    material: Elasticity,
    /// Factor beta of Rayleigh damping (s).
    damping: f64,
    simplices: Vec<Simplex<S>>,
    /// Coordinates of the corners of each element, axis by axis.
    coordinates: Vec<u32>,
    /// Indices of the entries of each element in the stiffness, row by row.
    slots: Vec<u32>,
    /// Pattern of A, once known.
    pub pattern: OnceLock<Option<Pattern>>,
}

/// Largest number of coordinates of an element.
const SIDE: usize = 3 * CORNERS;

/// A matrix between the coordinates of an element.
type Block = [f64; SIDE * SIDE];

/// An element over a step.
struct Strained {
    /// Gradient F_theta.
    gradient: Matrix3<f64>,
    response: Response,
    stress: Matrix3<f64>,
    viscous: Matrix3<f64>,
}

impl<S: Space> LargeStrain<S> {
    /// Creates the elements of a mesh; `None` in small strain.
    pub fn new(
        strain: Strain,
        material: &Elasticity,
        damping: f64,
        mesh: &Mesh<S>,
        freedoms: &Freedoms<S>,
        stiffness: &Sparse,
    ) -> Option<Self> {
        if !strain.is_finite() {
            return None;
        }
        let mut out = Self {
            strain,
            material: *material,
            damping,
            simplices: Vec::new(),
            coordinates: Vec::new(),
            slots: Vec::new(),
            pattern: OnceLock::new(),
        };
        for points in mesh.elements() {
            out.simplices.push(Simplex::new(&mesh.corners(points))?);
            let first = out.coordinates.len();
            for point in points {
                let axes = (0..S::D).map(|axis| freedoms.of(*point, axis) as u32);
                out.coordinates.extend(axes);
            }
            let own = &out.coordinates[first..];
            for row in own {
                for column in own {
                    let slot = stiffness.slot(*row as usize, *column as usize)?;
                    out.slots.push(slot as u32);
                }
            }
        }
        Some(out)
    }

    /// Returns the coordinates of an element.
    fn coordinates(&self, e: usize) -> &[u32] {
        let each = (S::D + 1) * S::D;
        &self.coordinates[e * each..(e + 1) * each]
    }

    /// The gradient of the displacement in an element.
    fn gradient(&self, e: usize, q: &[f64]) -> Matrix3<f64> {
        let at = self.coordinates(e);
        let mut out = Matrix3::zeros();
        for (a, g) in self.simplices[e].gradients().iter().enumerate().skip(1) {
            for i in 0..S::D {
                // Displacements are relative to the first corner, so that a translation leaves no
                // rounding.
                let u = q[at[a * S::D + i] as usize] - q[at[i] as usize];
                for j in 0..S::D {
                    out[(i, j)] += u * g[j];
                }
            }
        }
        out
    }

    fn strained(&self, e: usize, step: &Stretch) -> Option<Strained> {
        let [from, to] = [step.start, step.end].map(|q| self.gradient(e, q));
        let (c, d) = (less_one(&from), less_one(&to));
        let blend = |a: &Matrix3<f64>, b: &Matrix3<f64>| a * (1.0 - step.theta) + b * step.theta;
        let free = step.free_strain.get(e).copied().unwrap_or(0.0);
        let response = Response::new(self.strain, &self.material, &blend(&c, &d), free)?;
        let mut viscous = Matrix3::zeros();
        if self.damping > 0.0 {
            viscous = self.hooke(&((d - c) * (0.5 * self.damping / step.h)));
        }
        Some(Strained {
            gradient: Matrix3::identity() + blend(&from, &to),
            stress: response.stress(),
            response,
            viscous,
        })
    }

    /// Returns Hooke's stress of a strain.
    fn hooke(&self, e: &Matrix3<f64>) -> Matrix3<f64> {
        let (lambda, shear) = (self.material.lambda(), self.material.shear());
        Matrix3::identity() * (lambda * e.trace()) + e * (2.0 * shear)
    }

    /// The internal forces of a step.
    pub fn forces(&self, step: &Stretch) -> Forces {
        let zero = vec![0.0; step.start.len()];
        let mut out = Forces {
            elastic: zero.clone(),
            viscous: zero.clone(),
            size: zero,
        };
        for (e, simplex) in self.simplices.iter().enumerate() {
            let Some(at) = self.strained(e, step) else {
                continue;
            };
            let [elastic, viscous] =
                [at.stress, at.viscous].map(|s| at.gradient * s * simplex.volume);
            let own = self.coordinates(e).chunks_exact(S::D);
            for (coordinates, g) in own.zip(simplex.gradients()) {
                let g = Vector3::from(g.padded());
                let (elastic, viscous) = (elastic * g, viscous * g);
                for (i, c) in coordinates.iter().enumerate() {
                    let c = *c as usize;
                    out.elastic[c] += elastic[i];
                    out.viscous[c] += viscous[i];
                    out.size[c] += elastic[i].abs() + viscous[i].abs();
                }
            }
        }
        out
    }

    /// Returns the tangent of a step, including that of damping over h theta, in the pattern of the
    /// stiffness.
    pub fn tangent(&self, step: &Stretch, stiffness: &Sparse) -> Sparse {
        self.sum_of_elements(step, stiffness, |_, _| {})
    }

    /// Returns the tangent without the negative part of each element.
    pub fn positive_tangent(&self, step: &Stretch, stiffness: &Sparse) -> Sparse {
        self.sum_of_elements(step, stiffness, |own, side| {
            let mut modes = DMatrix::from_row_slice(side, side, own).symmetric_eigen();
            modes.eigenvalues.apply(|l| *l = l.max(0.0));
            // The matrix is symmetric: rows are columns.
            own.copy_from_slice(modes.recompose().as_slice());
        })
    }

    /// Returns the sum of the tangents of the elements, each changed by `edit`, which receives its
    /// numbers and the number of its rows.
    fn sum_of_elements(
        &self,
        step: &Stretch,
        stiffness: &Sparse,
        edit: impl Fn(&mut [f64], usize),
    ) -> Sparse {
        let mut values = vec![0.0; stiffness.values().len()];
        let side = (S::D + 1) * S::D;
        for (e, simplex) in self.simplices.iter().enumerate() {
            let Some(at) = self.strained(e, step) else {
                continue;
            };
            let mut own = self.element_tangent(simplex, &at, step);
            let own = &mut own[..side * side];
            edit(own, side);
            let slots = &self.slots[e * side * side..(e + 1) * side * side];
            for (value, slot) in own.iter().zip(slots) {
                values[*slot as usize] += value;
            }
        }
        stiffness.with_values(values)
    }

    /// The tangent of an element, row by row.
    fn element_tangent(&self, simplex: &Simplex<S>, at: &Strained, step: &Stretch) -> Block {
        let side = (S::D + 1) * S::D;
        let mut out = [0.0; SIDE * SIDE];
        let mut gradients = [Vector3::zeros(); CORNERS];
        for (to, g) in gradients.iter_mut().zip(simplex.gradients()) {
            *to = Vector3::from(g.padded());
        }
        let gradients = &gradients[..=S::D];
        let stress = at.stress + at.viscous;
        let rate = self.damping / (step.h * step.theta);
        for (b, g) in gradients.iter().enumerate() {
            let geometric = stress * g;
            for k in 0..S::D {
                // dF = e_k g^T, so that F^T dF is the k-th row of F as a column times g^T.
                let half = at.gradient.row(k).transpose() * g.transpose();
                let dc = half + half.transpose();
                let mut change = at.response.change(&dc);
                if rate > 0.0 {
                    change += self.hooke(&(dc * (0.5 * rate)));
                }
                let material = at.gradient * change;
                // One triangle is computed: the other differs by rounding.
                let column = b * S::D + k;
                for (a, arm) in gradients.iter().enumerate().take(b + 1) {
                    let mut force = material * arm;
                    force[k] += geometric.dot(arm);
                    for i in 0..S::D {
                        let row = a * S::D + i;
                        if row <= column {
                            let value = force[i] * simplex.volume;
                            out[row * side + column] = value;
                            out[column * side + row] = value;
                        }
                    }
                }
            }
        }
        out
    }

    /// Returns the energy stored at coordinates with free strains of the elements, or none (J; J/m
    /// in 2D).
    pub fn energy(&self, q: &[f64], free_strain: &[f64]) -> f64 {
        let free = |e: usize| free_strain.get(e).copied().unwrap_or(0.0);
        (0..self.simplices.len())
            .map(|e| self.energy_of(e, q, free(e)))
            .sum()
    }

    /// Returns the energy stored in an element (J; J/m in 2D).
    pub fn energy_of(&self, e: usize, q: &[f64], free_strain: f64) -> f64 {
        let c = less_one(&self.gradient(e, q));
        let response = Response::new(self.strain, &self.material, &c, free_strain);
        response.map_or(0.0, |r| r.energy() * self.simplices[e].volume)
    }

    /// Returns the Cauchy stress in each element at coordinates (Pa), F S F^T/J; in plane strain
    /// including the stress along the depth.
    pub fn stresses(&self, q: &[f64], free_strain: &[f64]) -> Vec<Symmetric> {
        let one = |e: usize| {
            let h = self.gradient(e, q);
            let free = free_strain.get(e).copied().unwrap_or(0.0);
            let response = Response::new(self.strain, &self.material, &less_one(&h), free);
            let f = Matrix3::identity() + h;
            let s = response.map_or_else(Matrix3::zeros, |r| r.stress());
            let s = f * s * f.transpose() / f.determinant();
            [
                s[(0, 0)],
                s[(1, 1)],
                s[(2, 2)],
                s[(1, 2)],
                s[(0, 2)],
                s[(0, 1)],
            ]
        };
        (0..self.simplices.len()).map(one).collect()
    }

    /// Returns the unloaded position of an element that is inverted at coordinates, J <= 0.
    pub fn inverted(&self, mesh: &Mesh<S>, q: &[f64]) -> Option<String> {
        let volume = |e: usize| (Matrix3::identity() + self.gradient(e, q)).determinant();
        // This also finds NaN.
        let e = (0..self.simplices.len()).find(|e| volume(*e).is_nan() || volume(*e) <= 0.0)?;
        let points = mesh.elements().nth(e)?;
        let corners = mesh.corners(points);
        let sum = corners.iter().fold(S::Vector::zero(), |sum, x| sum + *x);
        Some(place(&(sum * (1.0 / corners.len() as f64))))
    }
}

/// Returns C - 1 for a gradient of the displacement.
fn less_one(h: &Matrix3<f64>) -> Matrix3<f64> {
    h + h.transpose() + h.transpose() * h
}

#[cfg(test)]
mod tests;
