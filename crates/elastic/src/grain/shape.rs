//! Data shared by grains of one shape: their mesh, and its vibration modes.
//!
//! The modes of a free mesh, K phi = lambda M phi, turn its elastic motion into uncoupled
//! oscillators: a step of any length needs no factor, and grains of one shape and different sizes,
//! stiffnesses and densities have the same modes.

use crate::element::Simplex;
use crate::freedom::Freedoms;
use crate::material::Elasticity;
use crate::mesh::Mesh;
use crate::model::assemble;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use nalgebra::DMatrix;
use std::collections::{BTreeMap, BTreeSet};

/// The shape of grains with their mesh, about its centre of mass, and its modes at unit density and
/// unit Young's modulus.
#[derive(Debug)]
pub struct GrainShape<S: Space> {
    mesh: Mesh<S>,
    /// Boundary points of the mesh, in the order of the vertices of the surface: clockwise in the
    /// plane.
    vertices: Vec<u32>,
    /// The D vertices of each facet; outside is where they are anticlockwise (3D).
    facets: Vec<[u32; 3]>,
    volume: f64,
    inertia: S::Tensor,
    /// Squares of the angular frequencies, lambda, in increasing order, without rigid motions.
    rates: Vec<f64>,
    /// Displacements of each mode: of all points in the order of the mesh, axis by axis.
    modes: Vec<f64>,
    /// Displacements of the vertices only: by mode, and by axis of a vertex over all modes.
    by_mode: Vec<f64>,
    by_vertex: Vec<f64>,
}

impl<S: Space> GrainShape<S> {
    /// Creates the shape from a mesh, with Poisson's ratio of the material.
    ///
    /// # Errors
    /// A part of a sentence where the mesh is no grain.
    pub fn new(mesh: Mesh<S>, poisson: f64) -> Result<Self, String> {
        let unit = Elasticity {
            young: 1.0,
            poisson,
            density: 1.0,
        };
        let freedoms = Freedoms::new(&mesh, &[]).map_err(|e| e.to_string())?;
        let (mass, stiffness) = assemble(&mesh, &unit, &freedoms);
        let (d, total) = (S::D, freedoms.total());
        let of_point = |p: usize| mass[freedoms.of(p as u32, 0)];
        let volume: f64 = (0..mesh.points().len()).map(of_point).sum();
        let centre = mesh.points().iter().enumerate();
        let centre = centre.fold(S::Vector::zero(), |sum, (p, x)| sum + *x * of_point(p));
        let mesh = mesh.moved(&(centre * (-1.0 / volume)));
        let mut inertia = S::Tensor::uniform(0.0);
        for (p, x) in mesh.points().iter().enumerate() {
            inertia = inertia + S::steiner(x).scaled(of_point(p));
        }
        // The matrix is M^-1/2 K M^-1/2.
        let mut scaled = DMatrix::<f64>::zeros(total, total);
        for i in 0..total {
            for (j, k) in stiffness.row(i) {
                scaled[(i, j)] = k / (mass[i] * mass[j]).sqrt();
            }
        }
        let eigen = scaled.symmetric_eigen();
        let mut order: Vec<usize> = (0..total).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let rigid = d + S::Spin::N;
        let (vertices, facets) = boundary(&mesh)?;
        let kept = &order[rigid.min(total)..];
        let mut modes = Vec::with_capacity(kept.len() * total);
        for k in kept {
            for point in 0..mesh.points().len() {
                for axis in 0..d {
                    let c = freedoms.of(point as u32, axis);
                    modes.push(eigen.eigenvectors[(c, *k)] / mass[c].sqrt());
                }
            }
        }
        let count = kept.len();
        let of_vertices = d * vertices.len();
        let mut by_mode = Vec::with_capacity(count * of_vertices);
        let mut by_vertex = vec![0.0; count * of_vertices];
        for k in 0..count {
            for (v, p) in vertices.iter().enumerate() {
                for axis in 0..d {
                    let u = modes[k * total + *p as usize * d + axis];
                    by_mode.push(u);
                    by_vertex[(v * d + axis) * count + k] = u;
                }
            }
        }
        Ok(Self {
            rates: kept.iter().map(|k| eigen.eigenvalues[*k]).collect(),
            mesh,
            vertices,
            facets,
            volume,
            inertia,
            modes,
            by_mode,
            by_vertex,
        })
    }

    /// Returns the mesh, about its centre of mass.
    pub fn mesh(&self) -> &Mesh<S> {
        &self.mesh
    }

    /// Returns the positions of the vertices of the surface without load.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = S::Vector> {
        self.vertices
            .iter()
            .map(|p| self.mesh.points()[*p as usize])
    }

    /// Returns the D vertices of each facet of the surface.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.facets
    }

    /// Returns the volume (area in the plane), which is the mass at unit density.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns the moments of inertia at unit density.
    pub fn inertia(&self) -> &S::Tensor {
        &self.inertia
    }

    /// Returns the squares of the angular frequencies at unit density and unit Young's modulus.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Returns the lumped mass of each point of the mesh, at unit density.
    pub fn masses(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.mesh.points().len()];
        for points in self.mesh.elements() {
            let simplex = Simplex::<S>::new(&self.mesh.corners(points));
            let share = simplex.map_or(0.0, |s| s.volume) / points.len() as f64;
            points.iter().for_each(|p| out[*p as usize] += share);
        }
        out
    }

    /// Returns the tributary length or area of each vertex, along the outward normals of its
    /// facets.
    pub fn tributary(&self) -> Vec<S::Vector> {
        let at: Vec<S::Vector> = self.vertices().collect();
        let mut out = vec![S::Vector::zero(); at.len()];
        for facet in &self.facets {
            let [a, b, c] = facet.map(|v| at[v as usize]);
            let (along, moment) = (b - a, S::moment(&(b - a), &(c - a)));
            // In the plane facets are clockwise.
            let area = match S::D {
                2 => S::Vector::from_slice(&[-along[1], along[0]]),
                _ => S::Vector::from_slice(&[moment[0], moment[1], moment[2]]) * 0.5,
            };
            for v in facet.iter().take(S::D) {
                out[*v as usize] += area * (1.0 / S::D as f64);
            }
        }
        out
    }

    /// Returns the displacements of all points for amplitudes of the modes.
    pub fn displacements(&self, amplitudes: &[f64]) -> Vec<S::Vector> {
        sum::<S>(&self.modes, amplitudes, self.mesh.points().len())
    }

    /// Returns the amplitudes of the modes for displacements of all points of the mesh: the inverse
    /// of [`Self::displacements`], without any rigid motion. Modes are orthogonal with the masses
    /// of the points.
    pub fn amplitudes(&self, displacements: &[S::Vector]) -> Vec<f64> {
        let masses = self.masses();
        let weighed: Vec<f64> = displacements
            .iter()
            .zip(&masses)
            .flat_map(|(u, m)| (0..S::D).map(move |axis| m * u[axis]))
            .collect();
        let modes = self.modes.chunks_exact(weighed.len().max(1));
        let along = |mode: &[f64]| mode.iter().zip(&weighed).map(|(phi, u)| phi * u).sum();
        modes.map(along).collect()
    }

    /// Returns the displacements of the vertices.
    pub fn of_vertices(&self, amplitudes: &[f64]) -> Vec<S::Vector> {
        sum::<S>(&self.by_mode, amplitudes, self.vertices.len())
    }

    /// The modes at an axis of a vertex.
    pub fn at(&self, vertex: usize, axis: usize) -> &[f64] {
        let count = self.rates.len();
        let from = (vertex * S::D + axis) * count;
        &self.by_vertex[from..from + count]
    }

    /// Returns the displacements of all axes of the vertices for amplitudes of the modes, vertex by
    /// vertex.
    pub fn coordinates(&self, amplitudes: impl Iterator<Item = f64>) -> Vec<f64> {
        let rows = S::D * self.vertices.len();
        let mut out = vec![0.0; rows];
        for (mode, a) in self.by_mode.chunks_exact(rows).zip(amplitudes) {
            for (u, m) in out.iter_mut().zip(mode) {
                *u += a * m;
            }
        }
        out
    }
}

/// The sum of modes of `points` points.
fn sum<S: Space>(modes: &[f64], amplitudes: &[f64], points: usize) -> Vec<S::Vector> {
    let mut out = vec![0.0; S::D * points];
    for (mode, a) in modes.chunks_exact(S::D * points).zip(amplitudes) {
        for (u, m) in out.iter_mut().zip(mode) {
            *u += a * m;
        }
    }
    out.chunks_exact(S::D).map(S::Vector::from_slice).collect()
}

/// Returns the points of the boundary, in the plane clockwise along it, and its facets by their
/// indices among these.
fn boundary<S: Space>(mesh: &Mesh<S>) -> Result<(Vec<u32>, Vec<[u32; 3]>), String> {
    let facets: Vec<&[u32]> = (0..mesh.facets()).map(|f| mesh.facet(f)).collect();
    if S::D == 2 {
        // Facets have the body on their left.
        let next: BTreeMap<u32, u32> = facets.iter().map(|f| (f[1], f[0])).collect();
        let first = next.keys().next().copied().unwrap_or_default();
        let mut points = vec![first];
        while let Some(p) = next.get(&points[points.len() - 1]) {
            if *p == first {
                break;
            }
            points.push(*p);
        }
        let count = points.len() as u32;
        if count as usize != facets.len() {
            return Err("the boundary of its mesh is not one closed line".to_owned());
        }
        let chain = (0..count).map(|k| [k, (k + 1) % count, k]);
        return Ok((points, chain.collect()));
    }
    let points: BTreeSet<u32> = facets.iter().flat_map(|f| f.iter().copied()).collect();
    let points: Vec<u32> = points.into_iter().collect();
    let local = |p: u32| points.binary_search(&p).map_or(0, |k| k as u32);
    let facets = facets
        .iter()
        .map(|f| [local(f[0]), local(f[1]), local(f[2])]);
    let facets = facets.collect();
    Ok((points, facets))
}

/// Returns the stress in each element of a mesh for displacements of its points (Pa).
pub fn stresses<S: Space>(
    mesh: &Mesh<S>,
    material: &Elasticity,
    displacements: &[S::Vector],
) -> Vec<[f64; 6]> {
    let stress = |points: &[u32]| {
        let of_points: Vec<S::Vector> = points.iter().map(|p| displacements[*p as usize]).collect();
        let simplex = Simplex::<S>::new(&mesh.corners(points));
        simplex.map_or([0.0; 6], |s| s.stress(material, &of_points))
    };
    mesh.elements().map(stress).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grain::mesh::{Triangles, disk, polygon, shells};
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    /// Free vibration of a disk in plane strain: the lowest mode deforms the circle to an ellipse.
    /// A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, art. 200; for n = 2 the
    /// frequency equation in Bessel functions is solved here by bisection.
    #[test]
    fn a_disk_vibrates_as_love_says() {
        let nu: f64 = 0.3;
        let shear = 0.5 / (1.0 + nu);
        let lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let bessel = |n: i32, x: f64| {
            // J_n(x) = 1/pi int_0^pi cos(n t - x sin t) dt, spectrally accurate by the trapezium.
            let parts = 200;
            let f = |k: i32| {
                let t = std::f64::consts::PI * f64::from(k) / f64::from(parts);
                (f64::from(n) * t - x * t.sin()).cos()
            };
            let inner: f64 = (1..parts).map(f).sum();
            (inner + 0.5 * (f(0) + f(parts))) / f64::from(parts)
        };
        // Displacements u = grad phi + rot psi with phi = J_2(h r) cos 2 t, psi = J_2(k r) sin 2 t;
        // tractions at r = 1 vanish: sigma_rr/G: (2 n(n-1)... written with J_n and its derivative,
        // x J_n' = n J_n - x J_(n+1).
        let frequency = |w: f64| {
            let (h, k) = (w / (lambda + 2.0 * shear).sqrt(), w / shear.sqrt());
            let n = 2.0;
            let (jh, jk) = (bessel(2, h), bessel(2, k));
            let dh = n * jh - h * bessel(3, h);
            let dk = n * jk - k * bessel(3, k);
            let a = (n * n - 0.5 * k * k) * jh - dh;
            let b = n * (dk - jk);
            let c = n * (dh - jh);
            let e = (n * n - 0.5 * k * k) * jk - dk;
            a * e - b * c
        };
        let (mut low, mut high) = (0.5, 1.8);
        assert!(frequency(low) * frequency(high) < 0.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if frequency(low) * frequency(middle) <= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let mut errors = Vec::new();
        for elements in [4, 8] {
            let corners = disk::<Dim2>(elements);
            let mesh = polygon::<Dim2>(&corners, &Vector2::zeros(), 1.0 / elements as f64).unwrap();
            let shape = GrainShape::new(mesh, nu).unwrap();
            // The two lowest modes have the same frequency.
            assert!((shape.rates()[1] / shape.rates()[0] - 1.0).abs() < 1e-6);
            errors.push(shape.rates()[0].sqrt() / low - 1.0);
        }
        println!("lowest frequency {low}, errors {errors:?}");
        assert!(
            errors[1].abs() < 0.02 && errors[1].abs() < 0.35 * errors[0].abs(),
            "{errors:?}"
        );
    }

    /// Modes have no linear and no angular momentum.
    #[test]
    fn modes_are_orthogonal_to_rigid_motions() {
        let surface = Triangles::<Dim3>::icosahedron().cut(2).on_unit_sphere();
        let mesh = shells(&surface, &Vector3::zeros(), 2).unwrap();
        let shape = GrainShape::new(mesh, 0.3).unwrap();
        assert!(shape.rates()[0] > 0.1);
        let sphere = 8.0 / 15.0 * std::f64::consts::PI;
        let inertia = shape.inertia();
        // Tetrahedra divide prisms in one of two ways, which breaks the symmetry.
        assert!((inertia[(0, 0)] / inertia[(2, 2)] - 1.0).abs() < 0.02);
        // Lumped masses lie farther out, and chords within the sphere.
        assert!((inertia[(0, 0)] / sphere - 1.0).abs() < 0.25);
        let count = shape.rates().len();
        let amplitudes: Vec<f64> = (0..count).map(|k| (1.0 + k as f64).sin()).collect();
        let moved = shape.displacements(&amplitudes);
        let mass = shape.masses();
        let (mut shift, mut turn) = (Vector3::zeros(), Vector3::zeros());
        for ((x, u), m) in shape.mesh().points().iter().zip(&moved).zip(&mass) {
            shift += u * *m;
            turn += x.cross(u) * *m;
        }
        let size: f64 = moved.iter().zip(&mass).map(|(u, m)| u.norm() * m).sum();
        assert!(shift.norm() < 1e-12 * size && turn.norm() < 1e-12 * size);
    }
}
