//! Constant data of a body: its mesh, and the matrices assembled and factorised from it.

use crate::element::Simplex;
use crate::error::BodyError;
use crate::freedom::Freedoms;
use crate::large_strain::LargeStrain;
use crate::material::Elasticity;
use crate::matrix::{Factor, FactorSize, Sparse};
use crate::mesh::Mesh;
use crate::spec::Touching;
use crate::support::Rayleigh;
use crate::surface::SurfacePart;
use crate::touching_surface::open_surface;
use fretwork_core::bodies::{Compliance, Contactor, ContactorShape, Nodes, SystemSize};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

/// Largest number of coordinates of a surface whose compliance is kept, as far as they were
/// touched: a column has as many numbers, 160 kB.
const MAX_SURFACE: usize = 20_000;

/// Data that depend on the length of a step.
#[derive(Clone, Debug)]
pub struct StepFactor<S: Space> {
    /// Values of h and theta.
    pub of: [f64; 2],
    /// Factor of A; `None` where A is not positive definite in double precision: velocities are
    /// then not finite, and the step ends with an error.
    pub factor: Option<Factor>,
    /// Compliance of the points of the surface, column by column as they are touched; `None` where
    /// there are too many.
    pub surface: Option<Arc<Compliance<S>>>,
}

impl<S: Space> StepFactor<S> {
    pub fn solve(&self, x: &mut [f64]) {
        match &self.factor {
            Some(factor) => factor.solve(x, 1),
            None => x.fill(f64::NAN),
        }
    }
}

/// Constant data, shared by copies.
#[derive(Debug)]
pub struct BodyModel<S: Space> {
    pub name: String,
    pub mesh: Mesh<S>,
    pub material: Elasticity,
    pub damping: Rayleigh,
    pub freedoms: Freedoms<S>,
    /// Elements that follow rotations; `None` in small strain.
    pub large: Option<LargeStrain<S>>,
    pub mass: Vec<f64>,
    pub stiffness: Sparse,
    pub contactors: Vec<Contactor>,
    /// The contact surface.
    pub part: Option<SurfacePart>,
}

impl<S: Space> BodyModel<S> {
    /// The entries of a vector of coordinates at a point.
    pub fn of(&self, values: &[f64], point: u32) -> S::Vector {
        let mut out = S::Vector::zero();
        for axis in 0..S::D {
            out[axis] = values[self.freedoms.of(point, axis)];
        }
        out
    }

    /// Returns displacements less their mean along each axis, which causes no strain and would
    /// leave its rounding in K q.
    pub fn strained(&self, q: &[f64]) -> Vec<f64> {
        let (mut sum, mut count) = ([0.0; 3], [0.0; 3]);
        for (q, axis) in q.iter().zip(&self.freedoms.axis) {
            sum[usize::from(*axis)] += q;
            count[usize::from(*axis)] += 1.0;
        }
        let mean = |axis: u8| sum[usize::from(axis)] / count[usize::from(axis)];
        let axes = self.freedoms.axis.iter();
        q.iter()
            .zip(axes)
            .map(|(q, axis)| q - mean(*axis))
            .collect()
    }

    /// Returns C v in small strain; empty without damping.
    pub fn viscous(&self, v: &[f64]) -> Vec<f64> {
        let Rayleigh { mass, stiffness } = self.damping;
        let mut viscous = if stiffness > 0.0 {
            self.stiffness.times(&self.strained(v))
        } else if mass > 0.0 {
            vec![0.0; v.len()]
        } else {
            return Vec::new();
        };
        viscous.iter_mut().for_each(|f| *f *= stiffness);
        self.add_mass_damping(v, &mut viscous);
        viscous
    }

    /// Adds alpha M v.
    pub fn add_mass_damping(&self, v: &[f64], to: &mut [f64]) {
        for (c, f) in to.iter_mut().enumerate() {
            *f += self.damping.mass * self.mass[c] * v[c];
        }
    }

    pub fn form(&self, h: f64, theta: f64) -> StepFactor<S> {
        let step = h * theta;
        let free = self.freedoms.free;
        let inertia = 1.0 + step * self.damping.mass;
        let diagonal: Vec<f64> = self.mass[..free].iter().map(|m| m * inertia).collect();
        let scale = step * self.damping.stiffness + step * step;
        let a = self.stiffness.leading(free, scale, &diagonal);
        self.formed([h, theta], Factor::new(&a))
    }

    /// Returns memory and cost of its solutions.
    pub fn size(&self) -> SystemSize {
        let free = self.freedoms.free;
        let a = self.stiffness.leading(free, 1.0, &self.mass);
        let factor = FactorSize::of(&a).unwrap_or_default();
        let points = self.part.as_ref().map_or(0, |part| part.points.len());
        let coordinates = S::D * points;
        let column = if coordinates <= MAX_SURFACE {
            coordinates * S::D * size_of::<f64>()
        } else {
            0
        };
        let large = self.large.is_some();
        SystemSize {
            unknowns: free,
            // In large strain the tangent is kept in addition to the stiffness.
            matrix: self.stiffness.bytes() * (1 + usize::from(large)),
            factor: factor.bytes,
            surface: points * column,
            point: column,
            operations: [factor.factorise, factor.solve],
            refactorised: large,
        }
    }

    /// Creates the data of a step with a factor of A.
    pub fn formed(&self, of: [f64; 2], factor: Option<Factor>) -> StepFactor<S> {
        let points = self.part.as_ref().map(|part| &part.points);
        let points = points.filter(|points| S::D * points.len() <= MAX_SURFACE);
        let surface = points.map(|points| Arc::new(Compliance::new(points.clone())));
        StepFactor {
            of,
            factor,
            surface,
        }
    }

    /// Computes the column of the compliance for a surface point, by its index in the list of the
    /// kept compliance: the response of all surface points to an impulse on it.
    pub fn column<'a>(&self, formed: &'a StepFactor<S>, at: usize) -> &'a [f64] {
        let Some(surface) = &formed.surface else {
            return &[];
        };
        surface.column_or(at, |axis| {
            let mut response = vec![0.0; self.freedoms.free];
            let c = self.freedoms.of(surface.nodes()[at], axis);
            if c < self.freedoms.free {
                response[c] = 1.0;
                formed.solve(&mut response);
            }
            move |seen| {
                let mut velocity = S::Vector::zero();
                for k in 0..S::D {
                    let c = self.freedoms.of(surface.nodes()[seen], k);
                    velocity[k] = response.get(c).copied().unwrap_or(0.0);
                }
                velocity
            }
        })
    }
}

/// Returns the contact surface of a mesh, and its contactors.
pub fn contactors<S: Space>(
    mesh: &Mesh<S>,
    touching: Touching,
    material: u16,
) -> Result<(Option<SurfacePart>, Vec<Contactor>), BodyError> {
    let name = match touching {
        Touching::Nothing => return Ok((None, Vec::new())),
        Touching::Points(name) | Touching::Surface(name) => name,
    };
    let tributary = mesh.tributary(name);
    let size = |p: u32| match S::D {
        2 => 0.5 * tributary[p as usize],
        _ => (tributary[p as usize] / std::f64::consts::PI).sqrt(),
    };
    let contactor = |p: u32, shape| Contactor {
        nodes: Nodes::one(p),
        radius: size(p),
        shape,
        material,
    };
    let part = SurfacePart::new(mesh, name)?;
    match touching {
        Touching::Nothing => Ok((None, Vec::new())),
        Touching::Points(_) => {
            let points = part.points.iter();
            let all = points.map(|p| contactor(*p, ContactorShape::Point));
            let all = all.collect();
            Ok((Some(part), all))
        }
        Touching::Surface(_) => {
            let vertices = mesh.corners(&part.points);
            if let Err(why) = open_surface::<S>(vertices, &part.facets, None) {
                return Err(BodyError::NoSurface(name.to_owned(), why));
            }
            let one = contactor(part.origin(), ContactorShape::Surface);
            Ok((Some(part), vec![one]))
        }
    }
}

/// Returns the lumped mass of each coordinate (kg), and the stiffness.
pub fn assemble<S: Space>(
    mesh: &Mesh<S>,
    material: &Elasticity,
    freedoms: &Freedoms<S>,
) -> (Vec<f64>, Sparse) {
    let mut mass = vec![0.0; freedoms.total()];
    let mut entries = Vec::new();
    for points in mesh.elements() {
        let Some(simplex) = Simplex::<S>::new(&mesh.corners(points)) else {
            continue;
        };
        let share = material.density * simplex.volume / (S::D + 1) as f64;
        for (a, p) in points.iter().enumerate() {
            for axis in 0..S::D {
                mass[freedoms.of(*p, axis)] += share;
            }
            for (b, q) in points.iter().enumerate() {
                let block = simplex.stiffness(material, a, b);
                for i in 0..S::D {
                    for j in 0..S::D {
                        let at = (freedoms.of(*p, i), freedoms.of(*q, j));
                        entries.push((at.0, at.1, block.entry(i, j)));
                    }
                }
            }
        }
    }
    let stiffness = Sparse::from_entries(freedoms.total(), entries.into_iter());
    (mass, stiffness)
}
