//! Meshes of simplices: their points, elements, and boundary, of which parts have names.

use crate::element::Simplex;
use fretwork_core::geometry::space::{Space, VectorLike};
use std::collections::{BTreeMap, HashMap};

/// Smallest volume of an element as a fraction of its longest edge to the power of the dimension.
const MIN_VOLUME: f64 = 1e-9;

/// A mesh of triangles (2D) or tetrahedra (3D) of one body.
#[derive(Clone, Debug)]
pub struct Mesh<S: Space> {
    points: Vec<S::Vector>,
    /// D + 1 points of each element, of positive volume.
    elements: Vec<u32>,
    /// D points of each facet of the boundary. In 2D the body is on the left of a facet, in 3D its
    /// points are anticlockwise seen from outside.
    boundary: Vec<u32>,
    /// Facets of the boundary by the name of their part, in increasing order.
    parts: BTreeMap<String, Vec<u32>>,
}

/// Reason why points and elements do not form the mesh of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// There are no elements.
    #[error(
        "the mesh has no elements of the dimension of the scene, {0}; in 2D it needs triangles, in 3D tetrahedra"
    )]
    Empty(usize),
    /// A coordinate is not finite.
    #[error("point {0} of the mesh is not finite")]
    NotFinite(usize),
    /// A corner does not exist.
    #[error("element {0} of the mesh has point {1}, which does not exist")]
    NoPoint(usize, u32),
    /// A point without an element.
    #[error("point {0} of the mesh at {1} m belongs to no element; remove it")]
    Unused(usize, String),
    /// An element of negative volume.
    #[error(
        "element {0} of the mesh, at {1} m, is inverted: its points are in the wrong order, or the mesh folds over itself there"
    )]
    Inverted(usize, String),
    /// An element without volume.
    #[error("element {0} of the mesh, at {1} m, has no volume; make the mesh better there")]
    Flat(usize, String),
    /// A facet has more than two elements.
    #[error(
        "more than two elements share the facet at {0} m: elements of the mesh overlap there or are given twice"
    )]
    Shared(String),
    /// The mesh has more than one piece.
    #[error(
        "the mesh is in {0} pieces that no element connects, one of them with the point at {1} m; give each body a mesh of its own, or merge the points where the pieces meet"
    )]
    Unconnected(usize, String),
    /// A facet of a part is not on the boundary.
    #[error("a facet of the part `{0}`, at {1} m, is not on the boundary of the mesh")]
    Inside(String, String),
}

/// A place in a sentence.
pub(crate) fn place<V: VectorLike>(at: &V) -> String {
    let numbers: Vec<String> = (0..V::N).map(|k| format!("{:.6e}", at[k])).collect();
    format!("({})", numbers.join(", "))
}

impl<S: Space> Mesh<S> {
    /// Creates a mesh from points (m), the D + 1 points of each element one after the other, and
    /// named parts of the boundary by the D points of each of their facets, in any order.
    ///
    /// # Errors
    /// The mesh has no elements, or one of the defects that [`MeshError`] lists.
    pub fn new(
        points: Vec<S::Vector>,
        elements: Vec<u32>,
        parts: &BTreeMap<String, Vec<u32>>,
    ) -> Result<Self, MeshError> {
        let corners = S::D + 1;
        if elements.len() < corners {
            return Err(MeshError::Empty(S::D));
        }
        if let Some(k) = points.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite(k));
        }
        let mut used = vec![false; points.len()];
        for (e, element) in elements.chunks_exact(corners).enumerate() {
            for point in element {
                let Some(used) = used.get_mut(*point as usize) else {
                    return Err(MeshError::NoPoint(e, *point));
                };
                *used = true;
            }
            check_volume::<S>(&points, e, element)?;
        }
        if let Some(k) = used.iter().position(|u| !u) {
            return Err(MeshError::Unused(k, place(&points[k])));
        }
        check_connected::<S>(&points, &elements)?;
        let boundary = boundary::<S>(&points, &elements)?;
        let mut mesh = Self {
            points,
            elements,
            boundary,
            parts: BTreeMap::new(),
        };
        mesh.name_parts(parts)?;
        Ok(mesh)
    }

    fn name_parts(&mut self, parts: &BTreeMap<String, Vec<u32>>) -> Result<(), MeshError> {
        let known: HashMap<Vec<u32>, u32> = (0..self.facets())
            .map(|f| (sorted(self.facet(f)), f as u32))
            .collect();
        for (name, points) in parts {
            let mut facets = Vec::with_capacity(points.len() / S::D);
            for facet in points.chunks_exact(S::D) {
                let Some(f) = known.get(&sorted(facet)) else {
                    let at = self.points.get(facet[0] as usize);
                    let at = at.map_or_else(String::new, place);
                    return Err(MeshError::Inside(name.clone(), at));
                };
                facets.push(*f);
            }
            facets.sort_unstable();
            facets.dedup();
            self.parts.insert(name.clone(), facets);
        }
        Ok(())
    }

    /// Returns the points without load (m).
    pub fn points(&self) -> &[S::Vector] {
        &self.points
    }

    /// Iterates over the D + 1 points of each element.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.elements.chunks_exact(S::D + 1)
    }

    /// Number of facets of the boundary.
    pub fn facets(&self) -> usize {
        self.boundary.len() / S::D
    }

    /// The D points of a facet of the boundary.
    pub fn facet(&self, f: usize) -> &[u32] {
        &self.boundary[f * S::D..(f + 1) * S::D]
    }

    /// Iterates over the names of the parts of the boundary.
    pub fn part_names(&self) -> impl Iterator<Item = &str> {
        self.parts.keys().map(String::as_str)
    }

    /// Returns the facets of a part of the boundary, in increasing order.
    pub fn part(&self, name: &str) -> Option<&[u32]> {
        self.parts.get(name).map(Vec::as_slice)
    }

    /// Returns the points of a part of the boundary, in increasing order.
    pub fn points_of(&self, name: &str) -> Option<Vec<u32>> {
        let facets = self.part(name)?.iter();
        let mut points: Vec<u32> = facets
            .flat_map(|f| self.facet(*f as usize).iter().copied())
            .collect();
        points.sort_unstable();
        points.dedup();
        Some(points)
    }

    /// Returns the corners of an element or a facet (m).
    pub fn corners(&self, points: &[u32]) -> Vec<S::Vector> {
        points.iter().map(|p| self.points[*p as usize]).collect()
    }

    /// Returns the area of a facet of the boundary (m^2; length in 2D, m).
    pub fn facet_area(&self, f: usize) -> f64 {
        let corners = self.corners(self.facet(f));
        let edge = corners[1] - corners[0];
        if S::D == 2 {
            return edge.norm();
        }
        let other = corners[2] - corners[0];
        let product = edge.dot(&edge) * other.dot(&other) - edge.dot(&other).powi(2);
        0.5 * product.max(0.0).sqrt()
    }

    /// Returns the tributary length or area of each point of the mesh on a part of the boundary: a
    /// D-th of its facets there (m; m^2).
    pub fn tributary(&self, part: &str) -> Vec<f64> {
        let mut out = vec![0.0; self.points.len()];
        for f in self.part(part).unwrap_or_default() {
            let share = self.facet_area(*f as usize) / S::D as f64;
            for point in self.facet(*f as usize) {
                out[*point as usize] += share;
            }
        }
        out
    }

    /// Returns the mesh moved by a vector (m).
    #[must_use]
    pub fn moved(mut self, by: &S::Vector) -> Self {
        for point in &mut self.points {
            *point += *by;
        }
        self
    }
}

fn sorted(points: &[u32]) -> Vec<u32> {
    let mut points = points.to_vec();
    points.sort_unstable();
    points
}

fn check_volume<S: Space>(
    points: &[S::Vector],
    e: usize,
    element: &[u32],
) -> Result<(), MeshError> {
    let corners: Vec<S::Vector> = element.iter().map(|p| points[*p as usize]).collect();
    let centre = corners.iter().fold(S::Vector::zero(), |sum, x| sum + *x);
    let at = || place(&(centre * (1.0 / corners.len() as f64)));
    let mut longest = 0.0f64;
    for (k, a) in corners.iter().enumerate() {
        for b in &corners[..k] {
            longest = longest.max((*a - *b).norm());
        }
    }
    let volume = Simplex::<S>::new(&corners).map_or(0.0, |s| s.volume);
    if volume.abs() <= MIN_VOLUME * longest.powi(S::D as i32) {
        Err(MeshError::Flat(e, at()))
    } else if volume < 0.0 {
        Err(MeshError::Inverted(e, at()))
    } else {
        Ok(())
    }
}

/// Elements are connected where they share a point.
fn check_connected<S: Space>(points: &[S::Vector], elements: &[u32]) -> Result<(), MeshError> {
    let mut parent: Vec<usize> = (0..points.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    for element in elements.chunks_exact(S::D + 1) {
        let first = root(&mut parent, element[0] as usize);
        for point in &element[1..] {
            let other = root(&mut parent, *point as usize);
            parent[other] = first;
        }
    }
    let first = root(&mut parent, 0);
    let roots: Vec<usize> = (0..points.len()).filter(|k| parent[*k] == *k).collect();
    match roots.iter().find(|r| **r != first) {
        Some(other) => Err(MeshError::Unconnected(roots.len(), place(&points[*other]))),
        None => Ok(()),
    }
}

/// Returns the facets that belong to one element only, in the order of the elements.
fn boundary<S: Space>(points: &[S::Vector], elements: &[u32]) -> Result<Vec<u32>, MeshError> {
    let corners = S::D + 1;
    let mut count: HashMap<Vec<u32>, u32> = HashMap::new();
    // The facet opposite to each corner follows. The facets of a positively oriented element are
    // anticlockwise seen from outside after an even permutation.
    let facet = |element: &[u32], opposite: usize| {
        let mut facet: Vec<u32> = (0..corners)
            .filter(|k| *k != opposite)
            .map(|k| element[k])
            .collect();
        // In 2D the edges are (1, 2), (0, 2), (0, 1), of which the second is reversed. In 3D the
        // facets opposite to corners 1 and 3 are reversed.
        if (S::D == 2 && opposite == 1) || (S::D == 3 && opposite % 2 == 1) {
            facet.swap(0, 1);
        }
        facet
    };
    for element in elements.chunks_exact(corners) {
        for opposite in 0..corners {
            let facet = facet(element, opposite);
            let of = count.entry(sorted(&facet)).or_default();
            *of += 1;
            if *of > 2 {
                return Err(MeshError::Shared(place(&points[facet[0] as usize])));
            }
        }
    }
    let mut out = Vec::new();
    for element in elements.chunks_exact(corners) {
        for opposite in 0..corners {
            let facet = facet(element, opposite);
            if count[&sorted(&facet)] == 1 {
                out.extend(facet);
            }
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    fn square() -> (Vec<Vector2<f64>>, Vec<u32>) {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        (points.map(Vector2::from).to_vec(), vec![0, 1, 2, 0, 2, 3])
    }

    fn error(points: Vec<Vector2<f64>>, elements: Vec<u32>) -> String {
        let built = Mesh::<Dim2>::new(points, elements, &BTreeMap::new());
        built.unwrap_err().to_string()
    }

    #[test]
    fn the_boundary_has_the_body_on_its_left() {
        let (points, elements) = square();
        let parts = BTreeMap::from([("top".to_owned(), vec![3, 2])]);
        let mesh = Mesh::<Dim2>::new(points, elements, &parts).unwrap();
        assert_eq!(mesh.facets(), 4);
        let turn: f64 = (0..4)
            .map(|f| {
                let [a, b] = [0, 1].map(|k| mesh.points()[mesh.facet(f)[k] as usize]);
                a.perp(&b)
            })
            .sum();
        // By Green's formula this is twice the area if the body is on the left.
        assert_eq!(turn, 2.0);
        assert_eq!(mesh.points_of("top").unwrap(), [2, 3]);
        assert_eq!(mesh.tributary("top"), [0.0, 0.0, 0.5, 0.5]);
    }

    /// The volume follows by Gauss's formula from facets that are anticlockwise seen from outside.
    #[test]
    fn facets_in_space_are_seen_from_outside() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
        ];
        let points = points.map(Vector3::from).to_vec();
        let mesh = Mesh::<Dim3>::new(points, vec![0, 1, 2, 3, 1, 2, 3, 4], &BTreeMap::new());
        let mesh = mesh.unwrap();
        assert_eq!(mesh.facets(), 6);
        let parts = (0..6).map(|f| {
            let c = mesh.corners(mesh.facet(f));
            c[0].dot(&c[1].cross(&c[2])) / 6.0
        });
        let volume: f64 = mesh
            .elements()
            .map(|e| Simplex::<Dim3>::new(&mesh.corners(e)).unwrap().volume)
            .sum();
        assert!((parts.sum::<f64>() - volume).abs() < 1e-15 && volume > 0.0);
    }

    #[test]
    fn what_is_no_mesh_says_where() {
        let (points, elements) = square();
        assert!(error(points.clone(), vec![0, 2, 1, 0, 2, 3]).contains("element 0"));
        assert!(error(points.clone(), vec![0, 1, 2, 0, 2, 9]).contains("point 9"));
        assert!(error(points.clone(), vec![0, 1, 2]).contains("point 3"));
        assert!(error(points.clone(), vec![]).contains("triangles"));
        let mut flat = points.clone();
        flat[3] = Vector2::new(0.5, 0.5);
        assert!(error(flat, elements.clone()).contains("no volume"));
        let mut twice = elements.clone();
        twice.extend([0, 1, 2]);
        let mut more = elements.clone();
        more.extend([0, 2, 3]);
        more.extend([0, 1, 2]);
        assert!(error(points.clone(), more).contains("more than two"));
        let mut apart = points.clone();
        apart.extend([[5.0, 0.0], [6.0, 0.0], [5.0, 1.0]].map(Vector2::from));
        let mut pieces = elements.clone();
        pieces.extend([4, 5, 6]);
        assert!(error(apart, pieces).contains("2 pieces"));
        let inside = BTreeMap::from([("middle".to_owned(), vec![0, 2])]);
        let built = Mesh::<Dim2>::new(points, elements, &inside);
        assert!(built.unwrap_err().to_string().contains("`middle`"));
    }
}
