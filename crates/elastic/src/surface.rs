//! A contact surface, a part of the boundary: its vertices follow the points of the mesh, and an
//! impulse at any position acts on the points of the facet there, by its shape functions.

use crate::error::BodyError;
use crate::mesh::{Mesh, place};
use fretwork_core::bodies::Nodes;
use fretwork_core::geometry::space::{Space, VectorLike};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Fraction of a facet within which a position counts as being on an edge or at a vertex, where
/// rounding decides which facet is nearest.
const AT_BORDER: f64 = 1e-9;

/// Part of a surface that is nearest to a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NearestPart {
    /// A point of the mesh.
    Point(u32),
    /// An edge (3D): the one that starts at this corner of a facet.
    Edge(usize, usize),
    /// A facet.
    Facet(usize),
}

/// Points and facets of a part of the boundary.
#[derive(Clone, Debug)]
pub struct SurfacePart {
    /// Points of the mesh, in the order of the vertices of the surface: along the chain in 2D, with
    /// the body on its right.
    pub points: Vec<u32>,
    /// The D vertices of each facet, by their index in `points`; anticlockwise seen from outside
    /// (3D).
    pub facets: Vec<[u32; 3]>,
    /// Facets at each point, and its index among the corners of each.
    about: Vec<Vec<(u32, u8)>>,
    /// Index in `points` of each point of the mesh on the surface.
    places: HashMap<u32, u32>,
    /// Whether the vertices of a chain are monotonic along its direction, so that a position on it
    /// is found by bisection.
    single_valued: bool,
    dimension: usize,
}

impl SurfacePart {
    /// A part of the boundary of a mesh.
    ///
    /// # Errors
    /// The mesh has no such part, or it is not a chain of segments with two ends (2D).
    pub fn new<S: Space>(mesh: &Mesh<S>, part: &str) -> Result<Self, BodyError> {
        let Some(facets) = mesh.part(part) else {
            let names: Vec<&str> = mesh.part_names().collect();
            return Err(BodyError::NoPart(part.to_owned(), names.join(", ")));
        };
        let facets: Vec<&[u32]> = facets.iter().map(|f| mesh.facet(*f as usize)).collect();
        if S::D == 2 {
            return Self::chain(mesh, part, &facets);
        }
        let points: BTreeSet<u32> = facets.iter().flat_map(|f| f.iter().copied()).collect();
        let points: Vec<u32> = points.into_iter().collect();
        let local = |p: u32| points.binary_search(&p).map_or(0, |k| k as u32);
        let facets: Vec<[u32; 3]> = facets
            .iter()
            .map(|f| [local(f[0]), local(f[1]), local(f[2])])
            .collect();
        Ok(Self {
            about: about(&facets, points.len(), 3),
            places: points.iter().copied().zip(0..).collect(),
            facets,
            points,
            single_valued: false,
            dimension: 3,
        })
    }

    fn chain<S: Space>(mesh: &Mesh<S>, part: &str, facets: &[&[u32]]) -> Result<Self, BodyError> {
        // Facets have the body on their left, the chain on its right.
        let next: BTreeMap<u32, u32> = facets.iter().map(|f| (f[1], f[0])).collect();
        let ends: BTreeSet<u32> = next.values().copied().collect();
        let starts: Vec<u32> = next.keys().copied().filter(|p| !ends.contains(p)).collect();
        let [start] = starts[..] else {
            let at = starts.first().or(next.keys().next());
            let at = at.map_or_else(String::new, |p| place(&mesh.points()[*p as usize]));
            return Err(BodyError::NoChain(part.to_owned(), at));
        };
        let mut points = vec![start];
        while let Some(p) = next.get(&points[points.len() - 1]) {
            points.push(*p);
        }
        if points.len() != facets.len() + 1 {
            let at = place(&mesh.points()[start as usize]);
            return Err(BodyError::NoChain(part.to_owned(), at));
        }
        let at = |k: usize| mesh.points()[points[k] as usize];
        let along = at(points.len() - 1) - at(0);
        let rises = |k: usize| (at(k + 1) - at(k)).dot(&along) > 0.0;
        let single_valued = (0..facets.len()).all(rises);
        let facets: Vec<[u32; 3]> = (0..facets.len() as u32).map(|k| [k, k + 1, 0]).collect();
        Ok(Self {
            single_valued,
            about: about(&facets, points.len(), 2),
            places: points.iter().copied().zip(0..).collect(),
            facets,
            points,
            dimension: 2,
        })
    }

    /// Returns the point of the mesh that carries the frame of the surface: one in its middle.
    pub fn origin(&self) -> u32 {
        self.points[self.points.len() / 2]
    }

    /// Returns the facets at a point, given by its index in `points`: the points of each facet, and
    /// the index of the point among them. For a chain the third point is not used.
    pub fn facets_at(&self, k: usize) -> impl Iterator<Item = ([u32; 3], usize)> + '_ {
        let facets = self.about.get(k).into_iter().flatten();
        facets.map(|(facet, place)| {
            let points = self.facets[*facet as usize].map(|v| self.points[v as usize]);
            (points, usize::from(*place))
        })
    }

    /// The nodes of a weighted sum of vertices; `None` without vertices.
    pub fn of_vertices(&self, weights: &[(u32, f64)]) -> Option<Nodes> {
        let terms = weights.iter().map(|(k, w)| (self.points[*k as usize], *w));
        Nodes::sum(&terms.collect::<Vec<_>>())
    }

    /// Returns the nodes of a position on the surface, by the shape functions of its facet.
    /// `position` gives the current position of a point of the mesh (m).
    pub fn nodes<S: Space>(&self, at: &S::Vector, position: impl Fn(u32) -> S::Vector) -> Nodes {
        let vertex = |k: u32| self.points[k as usize];
        let (facet, weights) = self.nearest::<S>(at, position);
        let corners = self.facets[facet].iter().zip(weights).take(self.dimension);
        let terms: Vec<(u32, f64)> = corners.map(|(k, w)| (vertex(*k), w)).collect();
        Nodes::on_facet(&terms).unwrap_or_else(|| Nodes::one(vertex(0)))
    }

    /// Returns the points of the mesh at the corners of a facet, of which the first D are used.
    pub fn corners(&self, facet: usize) -> [u32; 3] {
        self.facets[facet].map(|k| self.points[k as usize])
    }

    /// The facets at a point of the mesh, by their places in `facets`.
    pub fn facets_around(&self, point: u32) -> impl Iterator<Item = usize> + '_ {
        let at = self.places.get(&point);
        let facets = at.and_then(|k| self.about.get(*k as usize));
        facets
            .into_iter()
            .flatten()
            .map(|(facet, _)| *facet as usize)
    }

    /// Returns the facets at an edge, which starts at a corner of a facet (3D).
    pub fn facets_beside(&self, facet: usize, corner: usize) -> impl Iterator<Item = usize> + '_ {
        let of = self.facets[facet];
        let [from, to] = [of[corner], of[(corner + 1) % 3]];
        let facets = self.about[from as usize].iter().map(|(f, _)| *f as usize);
        facets.filter(move |f| self.facets[*f].contains(&to))
    }

    /// Returns the part of the surface nearest to a position. `position` gives the current position
    /// of a point of the mesh (m).
    pub fn nearest_part<S: Space>(
        &self,
        at: &S::Vector,
        position: impl Fn(u32) -> S::Vector,
    ) -> NearestPart {
        let (facet, weights) = self.nearest::<S>(at, position);
        let corners = &weights[..self.dimension];
        if let Some(corner) = corners.iter().position(|w| *w >= 1.0 - AT_BORDER) {
            let vertex = self.facets[facet][corner];
            return NearestPart::Point(self.points[vertex as usize]);
        }
        // The edge that starts at the next corner is opposite to this one.
        let opposite = corners.iter().position(|w| *w <= AT_BORDER);
        match opposite {
            Some(corner) => NearestPart::Edge(facet, (corner + 1) % 3),
            None => NearestPart::Facet(facet),
        }
    }

    /// Returns the facet nearest to a position, the first of equally near ones, with the weights of
    /// its corners at the nearest point. `position` gives the current position of a point of the
    /// mesh (m).
    pub fn nearest<S: Space>(
        &self,
        at: &S::Vector,
        position: impl Fn(u32) -> S::Vector,
    ) -> (usize, [f64; 3]) {
        let corners = |f: usize| self.corners(f).map(&position);
        let found = if self.dimension == 2 {
            let off = |f: usize| on_facet::<S>(at, &corners(f));
            self.nearest_segment::<S>(at, &position, off)
        } else {
            let off = |f: usize| on_facet::<S>(at, &corners(f));
            (0..self.facets.len())
                .map(|f| (f, off(f)))
                .min_by(|a, b| a.1.0.total_cmp(&b.1.0))
                .map(|(f, (_, weights))| (f, weights))
        };
        found.unwrap_or((0, [1.0, 0.0, 0.0]))
    }

    /// Returns the tributary area of each point (m^2; length in the plane, m): an equal share of
    /// each facet at it.
    pub fn areas<S: Space>(&self, position: impl Fn(u32) -> S::Vector) -> Vec<f64> {
        let mut out = vec![0.0; self.points.len()];
        for facet in &self.facets {
            let [a, b, c] = facet.map(|k| position(self.points[k as usize]));
            let (u, v) = (b - a, c - a);
            let area = match self.dimension {
                2 => u.norm(),
                _ => 0.5 * (u.dot(&u) * v.dot(&v) - u.dot(&v).powi(2)).max(0.0).sqrt(),
            };
            for k in &facet[..self.dimension] {
                out[*k as usize] += area / self.dimension as f64;
            }
        }
        out
    }

    /// Returns the segment of a chain nearest to a position, with its weights.
    fn nearest_segment<S: Space>(
        &self,
        at: &S::Vector,
        position: impl Fn(u32) -> S::Vector,
        off: impl Fn(usize) -> (f64, [f64; 3]),
    ) -> Option<(usize, [f64; 3])> {
        let last = self.facets.len() - 1;
        if !self.single_valued {
            let all = (0..=last).map(|f| (f, off(f)));
            let nearest = all.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
            return Some((nearest.0, nearest.1.1));
        }
        let start = position(self.points[0]);
        let along = position(self.points[last + 1]) - start;
        let there = (*at - start).dot(&along);
        let passed = self
            .points
            .partition_point(|p| (position(*p) - start).dot(&along) <= there);
        let mut f = passed.clamp(1, last + 1) - 1;
        let mut here = off(f);
        // A steep neighbour may be nearer than the segment above or below the place.
        loop {
            let around = [f.checked_sub(1), (f < last).then_some(f + 1)];
            let better = around.into_iter().flatten().map(|g| (g, off(g)));
            match better.min_by(|a, b| a.1.0.total_cmp(&b.1.0)) {
                Some((g, nearer)) if nearer.0 < here.0 => (f, here) = (g, nearer),
                _ => return Some((f, here.1)),
            }
        }
    }
}

/// Returns for each vertex its facets, of D corners, and its index among these.
fn about(facets: &[[u32; 3]], vertices: usize, dimension: usize) -> Vec<Vec<(u32, u8)>> {
    let mut out = vec![Vec::new(); vertices];
    for (f, facet) in facets.iter().enumerate() {
        for (place, vertex) in facet[..dimension].iter().enumerate() {
            out[*vertex as usize].push((f as u32, place as u8));
        }
    }
    out
}

/// Returns the distance of a position from a facet (m), of which the first D corners are used, and
/// the weights of its corners at the nearest point, clamped to the facet.
pub fn on_facet<S: Space>(at: &S::Vector, corners: &[S::Vector; 3]) -> (f64, [f64; 3]) {
    if S::D > 2 {
        return on_triangle(at, corners);
    }
    let [a, b, _] = *corners;
    let (edge, arm) = (b - a, *at - a);
    let s = (arm.dot(&edge) / edge.dot(&edge)).clamp(0.0, 1.0);
    ((arm - edge * s).norm(), [1.0 - s, s, 0.0])
}

/// Returns the distance of a position from a triangle (m), and the weights of its corners at the
/// nearest point of its plane, clamped to the triangle.
fn on_triangle<V: VectorLike>(at: &V, corners: &[V; 3]) -> (f64, [f64; 3]) {
    let [a, b, c] = *corners;
    let (u, v, arm) = (b - a, c - a, *at - a);
    let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
    let (ru, rv) = (arm.dot(&u), arm.dot(&v));
    let determinant = uu * vv - uv * uv;
    let s = ((vv * ru - uv * rv) / determinant).max(0.0);
    let t = ((uu * rv - uv * ru) / determinant).max(0.0);
    let over = (s + t).max(1.0);
    let (s, t) = (s / over, t / over);
    ((arm - u * s - v * t).norm(), [1.0 - s - t, s, t])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{block, even};
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn a_top_goes_to_the_right() {
        let mesh = block::<Dim2>(&[even(0.0, 4.0, 4), even(0.0, 1.0, 2)]).unwrap();
        let part = SurfacePart::new(&mesh, "top").unwrap();
        let x: Vec<f64> = part
            .points
            .iter()
            .map(|p| mesh.points()[*p as usize].x)
            .collect();
        assert_eq!(x, [0.0, 1.0, 2.0, 3.0, 4.0]);
        let position = |p: u32| mesh.points()[p as usize];
        let nodes = part.nodes::<Dim2>(&Vector2::new(2.25, 1.01), position);
        let found: Vec<(u32, f64)> = nodes.terms().collect();
        assert_eq!(found, [(part.points[2], 0.75), (part.points[3], 0.25)]);
        let error = SurfacePart::new(&mesh, "side").unwrap_err().to_string();
        assert!(error.contains("bottom, left, right, top"), "{error}");
    }

    #[test]
    fn a_place_on_a_triangle_is_the_sum_of_its_corners() {
        let sides = [even(0.0, 1.0, 3), even(0.0, 1.0, 3), even(0.0, 1.0, 1)];
        let mesh = block::<Dim3>(&sides).unwrap();
        let part = SurfacePart::new(&mesh, "top").unwrap();
        let position = |p: u32| mesh.points()[p as usize];
        for at in [[0.4, 0.7, 1.0], [0.01, 0.99, 1.0], [1.0, 1.0, 1.0]] {
            let at = Vector3::from(at);
            let terms = part.nodes::<Dim3>(&at, position);
            let sum = terms
                .terms()
                .fold(Vector3::zeros(), |s, (p, w)| s + position(p) * w);
            assert!((sum - at).norm() < 1e-14, "{at}: {sum}");
        }
        let area: f64 = part.areas::<Dim3>(position).iter().sum();
        assert!((area - 1.0).abs() < 1e-14, "{area}");
    }

    /// At a vertex or an edge rounding does not choose one of the facets.
    #[test]
    fn a_vertex_and_an_edge_are_none_of_one_facet() {
        let sides = [even(0.0, 1.0, 3), even(0.0, 1.0, 3), even(0.0, 1.0, 1)];
        let mesh = block::<Dim3>(&sides).unwrap();
        let part = SurfacePart::new(&mesh, "top").unwrap();
        let position = |p: u32| mesh.points()[p as usize];
        let of = |at: Vector3<f64>| part.nearest_part::<Dim3>(&at, position);
        let facet = part.corners(4).map(position);
        let [a, b, c] = facet;
        assert_eq!(of(a), NearestPart::Point(part.corners(4)[0]));
        assert_eq!(of((a + b + c) / 3.0), NearestPart::Facet(4));
        for (corner, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            let rounding = Vector3::new(1e-15, -2e-15, 1e-15);
            let NearestPart::Edge(found, place) = of(from * 0.3 + to * 0.7 + rounding) else {
                panic!("{from} {to}");
            };
            let mut beside: Vec<usize> = part.facets_beside(found, place).collect();
            beside.sort_unstable();
            let mut expected: Vec<usize> = part.facets_beside(4, corner).collect();
            expected.sort_unstable();
            assert!(expected.len() <= 2 && expected.contains(&4));
            assert_eq!(beside, expected);
        }
    }
}
