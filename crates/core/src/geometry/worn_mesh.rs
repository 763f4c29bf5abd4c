//! Wear of a triangulated surface that is the graph of a height over x and y: its points recede
//! along z.

use super::facets;
use super::mesh::Mesh;
use super::recede::{Recede, Vertex, VertexShares};
use super::space::Dim3;
use nalgebra::Vector3;

type V = Vector3<f64>;

/// Cosine of the angle to z below which a triangle counts as vertical.
const VERTICAL: f64 = 1e-9;

/// Heights without wear, and depths along z (m).
#[derive(Debug)]
pub(super) struct MeshWear {
    pub(super) sign: f64,
    first: Vec<f64>,
    depth: Vec<f64>,
}

impl MeshWear {
    /// Creates the worn form of an unworn surface; `None` unless all of its triangles face up, or
    /// all down.
    pub(super) fn new(points: &[V], triangles: &[[u32; 3]]) -> Option<Self> {
        let corners = triangles.iter().map(|t| t.map(|c| points[c as usize]));
        let side = corners.map(|[a, b, c]| facing(a, b, c));
        let sign = side.reduce(|a, b| if a == b { a } else { 0.0 })?;
        (sign != 0.0).then(|| Self {
            sign,
            first: points.iter().map(|p| p.z).collect(),
            depth: vec![0.0; points.len()],
        })
    }

    /// Updates the positions of points without wear, and lowers them by their depths.
    pub(super) fn lower(&mut self, points: &mut [V]) {
        for (k, point) in points.iter_mut().enumerate() {
            self.first[k] = point.z;
            point.z -= self.sign * self.depth[k];
        }
    }
}

/// Returns 1 if a triangle faces up, -1 if it faces down, and 0 if it is vertical.
pub fn facing(a: V, b: V, c: V) -> f64 {
    let normal = (b - a).cross(&(c - a));
    if normal.z.abs() <= VERTICAL * normal.norm() {
        0.0
    } else {
        normal.z.signum()
    }
}

/// Returns the squared distance of a place from a triangle (m^2), and the shape functions at its
/// nearest point.
fn nearest_weights(at: &V, [a, b, c]: [V; 3]) -> (f64, [f64; 3]) {
    let (nearest, _) = facets::nearest(*at, a, b, c);
    let normal = (b - a).cross(&(c - a));
    let part = |u: V, v: V| u.cross(&v).dot(&normal) / normal.norm_squared();
    // Rounded such that none is negative and the sum is 1.
    let first = part(b - nearest, c - nearest).clamp(0.0, 1.0);
    let second = part(c - nearest, a - nearest).clamp(0.0, 1.0 - first);
    let weights = [first, second, 1.0 - first - second];
    ((nearest - at).norm_squared(), weights)
}

impl Recede<Dim3> for Mesh {
    fn vertices(&self) -> Vec<Vertex<V>> {
        let mut tributary = vec![0.0; self.points.len()];
        for t in &self.triangles {
            let [a, b, c] = t.map(|c| self.points[c as usize]);
            // Area of the triangle seen along z (m^2).
            let area = 0.5 * (b - a).xy().perp(&(c - a).xy()).abs();
            for corner in t {
                tributary[*corner as usize] += area / 3.0;
            }
        }
        let vertex = |(k, tributary): (usize, f64)| {
            let mut at = self.points[k];
            if let Some(worn) = &self.worn {
                at.z = worn.first[k];
            }
            Vertex { at, tributary }
        };
        tributary.into_iter().enumerate().map(vertex).collect()
    }

    fn shares(&self, closest_point: &V) -> VertexShares {
        let mut best = (f64::INFINITY, u32::MAX, [0.0; 3]);
        let place: [f64; 3] = (*closest_point).into();
        for (found, apart) in self.tree.nearest_neighbor_iter_with_distance_2(place) {
            if apart > best.0 {
                break;
            }
            let (distance, weights) =
                nearest_weights(closest_point, self.facet(found.data).corners);
            // On an edge the triangle does not depend on the order of the search.
            if (distance, found.data) < (best.0, best.1) {
                best = (distance, found.data, weights);
            }
        }
        let Some(t) = self.triangles.get(best.1 as usize) else {
            return [(0, 1.0), (0, 0.0), (0, 0.0)];
        };
        [0, 1, 2].map(|k| (t[k] as usize, best.2[k]))
    }

    fn recede(&mut self, depth: &[f64], named: &[usize]) -> f64 {
        let Some(worn) = &mut self.worn else {
            return 0.0;
        };
        let mut step = 0.0f64;
        for k in named.iter().copied() {
            worn.depth[k] = depth[k];
            let next = worn.first[k] - worn.sign * depth[k];
            let height = &mut self.points[k].z;
            step = step.max((*height - next).abs());
            *height = next;
        }
        // The boxes of a surface that deforms are built again as it moves, before contacts are
        // searched.
        if !self.deforms {
            self.build_boxes();
        }
        step
    }

    fn sign(&self) -> f64 {
        self.worn.as_ref().map_or(1.0, |worn| worn.sign)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shape::Surface;

    /// Returns triangles of a plate of 5 by 4 points of unequal spacing, with heights, that faces
    /// up or down.
    fn plate(up: bool) -> (Vec<V>, Vec<[u32; 3]>) {
        let point = |k: u32| {
            let (x, y) = (f64::from(k % 5), f64::from(k / 5));
            V::new(x + 0.05 * x * x, 0.7 * y, 0.1 * f64::from(k * k % 7))
        };
        let cells = (0..12).map(|c| c % 4 + 5 * (c / 4));
        let mut triangles: Vec<[u32; 3]> = cells
            .flat_map(|k| [[k, k + 1, k + 6], [k, k + 6, k + 5]])
            .collect();
        if !up {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        ((0..20).map(point).collect(), triangles)
    }

    fn worn_plate(up: bool) -> Mesh {
        let (points, triangles) = plate(up);
        Mesh::new(points, triangles).unwrap().with_wear()
    }

    /// Returns the volume between the triangles and z = 0, negative where they face down.
    fn volume(mesh: &Mesh) -> f64 {
        let prism = |t: &Vec<V>| {
            let area = 0.5 * (t[1] - t[0]).cross(&(t[2] - t[0])).z;
            area * (t[0].z + t[1].z + t[2].z) / 3.0
        };
        mesh.outline().iter().map(prism).sum()
    }

    /// The place on the surface above x and y, by the triangles.
    fn on(mesh: &Mesh, x: f64, y: f64) -> V {
        let holds = |t: &Vec<V>| {
            let [a, b, c] = [t[0], t[1], t[2]].map(|p| V::new(p.x, p.y, 0.0));
            let (off, w) = nearest_weights(&V::new(x, y, 0.0), [a, b, c]);
            (off < 1e-24).then(|| t[0] * w[0] + t[1] * w[1] + t[2] * w[2])
        };
        mesh.outline().iter().find_map(holds).unwrap()
    }

    #[test]
    fn the_removed_volume_is_the_sum_of_the_worn_volumes() {
        for up in [true, false] {
            let mut mesh = worn_plate(up);
            let (before, vertices) = (volume(&mesh), mesh.vertices());
            let mut depth = vec![0.0; vertices.len()];
            let mut worn = 0.0;
            for k in 0..50 {
                let t = f64::from(k);
                let at = on(
                    &mesh,
                    4.79 * (0.5 + 0.5 * t.sin()),
                    2.09 * (0.5 + 0.5 * (1.7 * t).cos()),
                );
                let shares = mesh.shares(&at);
                let place: V = shares.iter().map(|(k, part)| mesh.points[*k] * *part).sum();
                assert!((place - at).norm() < 1e-12, "{place} {at}");
                for (vertex, part) in shares {
                    assert!((0.0..=1.0).contains(&part));
                    depth[vertex] += 1e-3 * part / vertices[vertex].tributary;
                }
                worn += 1e-3;
                let all: Vec<usize> = (0..depth.len()).collect();
                mesh.recede(&depth, &all);
            }
            let removed = before - volume(&mesh);
            assert!((removed / worn - 1.0).abs() < 1e-12, "{removed} {worn}");
        }
    }

    #[test]
    fn the_depth_remains_while_the_surface_deforms() {
        let mut mesh = worn_plate(true);
        let mut depth = vec![0.0; 20];
        depth[7] = 0.4;
        mesh.recede(&depth, &[7]);
        let first = mesh.vertices();
        let moved: Vec<V> = plate(true).0.iter().map(|p| p * 1.01).collect();
        mesh.move_vertices(&moved);
        assert_eq!(mesh.points[7], moved[7] - V::new(0.0, 0.0, 0.4));
        assert_eq!(mesh.points[8], moved[8]);
        // Wear is measured from the unworn position of the surface.
        mesh.recede(&[0.5; 20], &[7]);
        assert_eq!(mesh.points[7], moved[7] - V::new(0.0, 0.0, 0.5));
        mesh.move_vertices(&plate(true).0);
        for (a, b) in mesh.vertices().iter().zip(&first) {
            assert_eq!(a.at, b.at);
        }
        // Contacts are found at the current position of the surface.
        let mut out = Vec::new();
        let at = mesh.points[7] + V::new(0.0, 0.0, 1e-3);
        mesh.closest_points(&at, 0.01, &mut out);
        assert!(!out.is_empty());
    }

    #[test]
    fn walls_and_overhangs_do_not_recede() {
        let (points, triangles) = plate(true);
        // A surface of a rigid body, without wear, does not recede.
        assert!(
            Mesh::new(points.clone(), triangles.clone())
                .unwrap()
                .receding()
                .is_none()
        );
        let of = |change: &dyn Fn(&mut V)| {
            let mut points = points.clone();
            points.iter_mut().for_each(change);
            Mesh::new(points, triangles.clone()).unwrap().with_wear()
        };
        assert!(of(&|_| ()).receding().is_some());
        let upright = of(&|p| *p = V::new(p.x, 0.0, p.y));
        assert!(upright.receding().is_none());
        let bent_back = of(&|p| {
            if p.x > 3.0 {
                *p = V::new(6.0 - p.x, p.y, 2.0 * p.x);
            }
        });
        assert!(bent_back.receding().is_none());
    }
}
