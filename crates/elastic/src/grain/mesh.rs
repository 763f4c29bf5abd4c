//! Meshes of grains: rings of triangles around the centre of a polygon, shells of tetrahedra around
//! that of a polyhedron.
//!
//! The outer ring or shell is the boundary of the grain, cut into edges of equal length; the inner
//! rings or shells are smaller copies of it, in the plane with fewer points, so that elements have
//! similar sizes.

use crate::mesh::{Mesh, MeshError};
use fretwork_core::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;

/// Difference of two positions along a ring below which they count as equal.
const ROUNDING: f64 = 1e-9;
/// Smallest number of points of a ring.
const MIN_RING_POINTS: usize = 6;

/// Returns the corners of a disk's polygon on the unit circle, anticlockwise: six for each of the
/// elements along its radius.
pub fn disk<S: Space>(elements: usize) -> Vec<S::Vector> {
    let count = 6 * elements.max(1);
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * (k as f64 / count as f64);
        S::Vector::from_slice(&[angle.cos(), angle.sin()])
    };
    (0..count).map(corner).collect()
}

/// Meshes a polygon with its corners (m) anticlockwise, with element edges of about `size` (m),
/// around an inner centre (2D).
///
/// # Errors
/// The corners enclose no area around the centre.
pub fn polygon<S: Space>(
    corners: &[S::Vector],
    centre: &S::Vector,
    size: f64,
) -> Result<Mesh<S>, MeshError> {
    let mut outer = Vec::new();
    for (k, from) in corners.iter().enumerate() {
        let side = corners[(k + 1) % corners.len()] - *from;
        let parts = (side.norm() / size).round().max(1.0);
        outer.extend((0..parts as usize).map(|i| *from + side * (i as f64 / parts)));
    }
    let radius = outer.iter().map(|p| (*p - *centre).norm()).sum::<f64>() / outer.len() as f64;
    let rings = (radius / size).round().max(1.0) as usize;
    let along = Boundary::<S>::new(&outer);
    let (mut points, mut elements) = (vec![*centre], Vec::new());
    // Positions along the boundary, from 0 to 1, and first point of the previous ring.
    let mut inner: (Vec<f64>, usize) = (Vec::new(), 0);
    for ring in 1..=rings {
        let share = ring as f64 / rings as f64;
        let first = points.len();
        let places = if ring == rings {
            points.extend(&outer);
            along.places.clone()
        } else {
            let count = (outer.len() as f64 * share).round() as usize;
            let count = count.max(MIN_RING_POINTS).min(outer.len());
            let places: Vec<f64> = (0..count).map(|k| k as f64 / count as f64).collect();
            let at = |s: &f64| *centre + (along.at(*s) - *centre) * share;
            points.extend(places.iter().map(at));
            places
        };
        let next = |k: usize, (places, first): &(Vec<f64>, usize)| first + k % places.len();
        let here = (places, first);
        let (mut i, mut j) = (0, 0);
        while ring > 1 && (i < here.0.len() || j < inner.0.len()) {
            let end = |k: usize, places: &[f64]| places.get(k + 1).copied().unwrap_or(1.0);
            let outwards = j == inner.0.len()
                || (i < here.0.len() && end(i, &here.0) <= end(j, &inner.0) + ROUNDING);
            let (a, b) = (next(i, &here), next(j, &inner));
            if outwards {
                elements.extend([a, next(i + 1, &here), b]);
                i += 1;
            } else {
                elements.extend([a, next(j + 1, &inner), b]);
                j += 1;
            }
        }
        if ring == 1 {
            for k in 0..here.0.len() {
                elements.extend([0, next(k, &here), next(k + 1, &here)]);
            }
        }
        inner = here;
    }
    let elements = elements.into_iter().map(|p| p as u32).collect();
    Mesh::new(points, elements, &BTreeMap::new())
}

/// A closed line, parametrised by length.
struct Boundary<'a, S: Space> {
    points: &'a [S::Vector],
    /// Position of each point, from 0 to 1.
    places: Vec<f64>,
}

impl<'a, S: Space> Boundary<'a, S> {
    fn new(points: &'a [S::Vector]) -> Self {
        let count = points.len();
        let lengths: Vec<f64> = (0..count)
            .map(|k| (points[(k + 1) % count] - points[k]).norm())
            .collect();
        let total: f64 = lengths.iter().sum();
        let mut sum = 0.0;
        let place = |length: &f64| {
            let here = sum / total;
            sum += length;
            here
        };
        let places = lengths.iter().map(place).collect();
        Self { points, places }
    }

    fn at(&self, s: f64) -> S::Vector {
        let k = self.places.partition_point(|place| *place <= s).max(1) - 1;
        let end = self.places.get(k + 1).copied().unwrap_or(1.0);
        let (from, to) = (self.points[k], self.points[(k + 1) % self.points.len()]);
        from + (to - from) * ((s - self.places[k]) / (end - self.places[k]))
    }
}

/// A closed surface of triangles, anticlockwise seen from outside.
#[derive(Clone, Debug)]
pub struct Triangles<S: Space> {
    /// Points of the surface (m).
    pub points: Vec<S::Vector>,
    /// Three points of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl<S: Space> Triangles<S> {
    /// The icosahedron in the unit sphere (3D).
    pub fn icosahedron() -> Self {
        let golden = f64::midpoint(1.0, 5f64.sqrt());
        let mut points: Vec<S::Vector> = Vec::with_capacity(12);
        for axis in 0..3 {
            for (one, other) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
                let mut point = [0.0; 3];
                point[(axis + 1) % 3] = one;
                point[(axis + 2) % 3] = other * golden;
                let point = S::Vector::from_slice(&point);
                points.push(point * (1.0 / point.norm()));
            }
        }
        let edge = 2.0 / (1.0 + golden * golden).sqrt();
        let near = |a: usize, b: usize| (points[a] - points[b]).norm() < 1.1 * edge;
        let mut triangles = Vec::with_capacity(20);
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if near(a, b) && near(b, c) && near(a, c) {
                        triangles.push([a as u32, b as u32, c as u32]);
                    }
                }
            }
        }
        let mut out = Self { points, triangles };
        out.turn_outwards(&S::Vector::zero());
        out
    }

    /// Orients triangles of a convex surface so that they are anticlockwise seen from outside.
    fn turn_outwards(&mut self, centre: &S::Vector) {
        for t in &mut self.triangles {
            let [a, b, c] = t.map(|p| self.points[p as usize] - *centre);
            let normal = S::moment(&(b - a), &(c - a));
            let out: f64 = (0..3).map(|k| normal[k] * a[k]).sum();
            if out < 0.0 {
                t.swap(1, 2);
            }
        }
    }

    /// Divides each triangle into `parts` squared equal ones, with common points on common edges.
    pub fn cut(&self, parts: usize) -> Self {
        let mut points = self.points.clone();
        let mut on_edges: BTreeMap<(u32, u32, usize), u32> = BTreeMap::new();
        let mut triangles = Vec::with_capacity(self.triangles.len() * parts * parts);
        for t in &self.triangles {
            let corners = t.map(|p| self.points[p as usize]);
            let mut index = BTreeMap::new();
            for i in 0..=parts {
                for j in 0..=parts - i {
                    // Weights of the corners, whose sum is `parts`.
                    let weights = [parts - i - j, i, j];
                    let mut carried = (0..3).filter(|k| weights[*k] > 0);
                    let [one, two] = [carried.next(), carried.next()];
                    let inside = carried.next().is_some();
                    let make = |points: &mut Vec<S::Vector>| {
                        let sum = |sum: S::Vector, k: usize| {
                            sum + corners[k] * (weights[k] as f64 / parts as f64)
                        };
                        points.push((0..3).fold(S::Vector::zero(), sum));
                        points.len() as u32 - 1
                    };
                    let point = match (one, two, inside) {
                        (Some(k), None, _) => t[k],
                        (Some(k), Some(l), false) => {
                            // The edge starts at the point of lower index, so that both triangles
                            // give it the same name.
                            let (k, l) = if t[k] < t[l] { (k, l) } else { (l, k) };
                            let name = (t[k], t[l], weights[k]);
                            *on_edges.entry(name).or_insert_with(|| make(&mut points))
                        }
                        _ => make(&mut points),
                    };
                    index.insert((i, j), point);
                }
            }
            for i in 0..parts {
                for j in 0..parts - i {
                    triangles.push([index[&(i, j)], index[&(i + 1, j)], index[&(i, j + 1)]]);
                    if i + j + 1 < parts {
                        let next = [
                            index[&(i + 1, j)],
                            index[&(i + 1, j + 1)],
                            index[&(i, j + 1)],
                        ];
                        triangles.push(next);
                    }
                }
            }
        }
        Self { points, triangles }
    }

    /// Moves the points of the surface to a distance of 1 from the origin.
    pub fn on_unit_sphere(mut self) -> Self {
        for p in &mut self.points {
            *p = *p * (1.0 / p.norm());
        }
        self
    }
}

/// Meshes the inside of a convex surface, in shells around an inner centre (3D).
///
/// # Errors
/// The surface does not enclose the centre.
pub fn shells<S: Space>(
    surface: &Triangles<S>,
    centre: &S::Vector,
    shells: usize,
) -> Result<Mesh<S>, MeshError> {
    let count = surface.points.len();
    let mut points = vec![*centre];
    for shell in 1..=shells.max(1) {
        let share = shell as f64 / shells.max(1) as f64;
        let at = |p: &S::Vector| *centre + (*p - *centre) * share;
        points.extend(surface.points.iter().map(at));
    }
    let mut elements: Vec<[u32; 4]> = Vec::new();
    for t in &surface.triangles {
        let mut t = *t;
        t.sort_unstable();
        let at = |shell: usize, k: usize| (1 + shell * count) as u32 + t[k];
        elements.push([0, at(0, 0), at(0, 1), at(0, 2)]);
        for shell in 1..shells {
            // Sides of prisms are divided from the inner point of lower index, in both prisms that
            // share one.
            let (i, o) = (shell - 1, shell);
            elements.push([at(i, 0), at(i, 1), at(i, 2), at(o, 2)]);
            elements.push([at(i, 0), at(i, 1), at(o, 1), at(o, 2)]);
            elements.push([at(i, 0), at(o, 0), at(o, 1), at(o, 2)]);
        }
    }
    for e in &mut elements {
        let [a, b, c, d] = e.map(|p| points[p as usize]);
        let area = S::moment(&(b - a), &(c - a));
        let volume: f64 = (0..3).map(|k| area[k] * (d - a)[k]).sum();
        if volume < 0.0 {
            e.swap(0, 1);
        }
    }
    let elements = elements.into_iter().flatten().collect();
    Mesh::new(points, elements, &BTreeMap::new())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Simplex;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    fn volumes<S: Space>(mesh: &Mesh<S>) -> Vec<f64> {
        let volume = |e| Simplex::<S>::new(&mesh.corners(e)).unwrap().volume;
        mesh.elements().map(volume).collect()
    }

    #[test]
    fn a_disk_is_its_polygon_of_elements_that_are_alike() {
        for elements in [1, 2, 4, 7] {
            let corners = disk::<Dim2>(elements);
            let mesh = polygon::<Dim2>(&corners, &Vector2::zeros(), 1.0 / elements as f64).unwrap();
            let n = 6.0 * elements as f64;
            let area = 0.5 * n * (std::f64::consts::TAU / n).sin();
            let found = volumes(&mesh);
            assert!((found.iter().sum::<f64>() - area).abs() < 1e-12);
            assert_eq!(found.len(), 6 * elements * elements);
            assert_eq!(mesh.facets(), 6 * elements);
            let least = found.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(least > 0.4 * area / found.len() as f64, "{least}");
        }
    }

    #[test]
    fn polygons_are_filled() {
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.5, 1.0], [0.0, 2.0]].map(Vector2::from);
        let centre = Vector2::new(1.5, 0.8);
        for size in [5.0, 0.7, 0.2] {
            let mesh = polygon::<Dim2>(&corners, &centre, size).unwrap();
            // The area follows from the shoelace formula.
            let found: f64 = volumes(&mesh).iter().sum();
            assert!((found - 5.0).abs() < 1e-12, "{found}");
        }
    }

    #[test]
    fn spheres_and_blocks_are_filled() {
        let surface = Triangles::<Dim3>::icosahedron();
        assert_eq!((surface.points.len(), surface.triangles.len()), (12, 20));
        let surface = surface.cut(3).on_unit_sphere();
        assert_eq!((surface.points.len(), surface.triangles.len()), (92, 180));
        let mesh = shells(&surface, &Vector3::zeros(), 3).unwrap();
        let found: f64 = volumes(&mesh).iter().sum();
        let sphere = 4.0 / 3.0 * std::f64::consts::PI;
        assert!(found < sphere && found > 0.9 * sphere, "{found}");
        assert_eq!(mesh.facets(), 180);
    }
}
