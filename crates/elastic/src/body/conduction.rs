//! Conduction of heat in a body of finite elements.

use crate::element::Simplex;
use crate::mesh::Mesh;
use fretwork_core::bodies::Conduction;
use fretwork_core::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;

/// Returns volumes and conductances of a mesh without load.
pub fn conduction<S: Space>(mesh: &Mesh<S>) -> Conduction {
    let mut volumes = vec![0.0; mesh.points().len()];
    let mut edges: BTreeMap<[u32; 2], f64> = BTreeMap::new();
    for points in mesh.elements() {
        let Some(simplex) = Simplex::<S>::new(&mesh.corners(points)) else {
            continue;
        };
        let gradients = simplex.gradients();
        for (a, p) in points.iter().enumerate() {
            volumes[*p as usize] += simplex.volume / (S::D + 1) as f64;
            for (b, q) in points.iter().enumerate().skip(a + 1) {
                let along = -simplex.volume * gradients[a].dot(&gradients[b]);
                *edges.entry([*p.min(q), *p.max(q)]).or_default() += along;
            }
        }
    }
    let part = |name: &str| {
        let areas = mesh.tributary(name).into_iter().zip(0..);
        let there = areas.filter(|(area, _)| *area > 0.0);
        (name.to_owned(), there.map(|(area, p)| (p, area)).collect())
    };
    Conduction {
        volumes,
        edges: edges.into_iter().collect(),
        parts: mesh.part_names().map(part).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    /// Returns the heat flow into each point for temperatures given by a function.
    fn inflow<S: Space>(mesh: &Mesh<S>, of: impl Fn(&S::Vector) -> f64) -> (Conduction, Vec<f64>) {
        let found = conduction(mesh);
        let t: Vec<f64> = mesh.points().iter().map(of).collect();
        let mut flow = vec![0.0; t.len()];
        for (points, factor) in &found.edges {
            let [a, b] = points.map(|p| p as usize);
            let through = factor * (t[b] - t[a]);
            flow[a] += through;
            flow[b] -= through;
        }
        (found, flow)
    }

    /// Patch test: with a temperature that is linear in space an inner point is in balance, also
    /// for obtuse elements, and the flow through a face is k times the gradient times its area.
    #[test]
    fn a_linear_temperature_is_kept() {
        let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0], [0.4, 0.2]];
        let elements = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let parts = BTreeMap::from([("right".to_owned(), vec![1, 2])]);
        let mesh = Mesh::<Dim2>::new(
            points.map(Vector2::from).to_vec(),
            elements.concat(),
            &parts,
        )
        .unwrap();
        let (found, flow) = inflow(&mesh, |x| 300.0 + 2.0 * x.x);
        assert!(found.edges.iter().any(|(_, factor)| *factor < 0.0));
        assert!(flow[4].abs() < 1e-12, "{flow:?}");
        // Heat flows from right to left, out of the points of the right face.
        assert!((flow[1] + flow[2] + 2.0).abs() < 1e-12, "{flow:?}");
        assert!((found.volumes.iter().sum::<f64>() - 3.0).abs() < 1e-12);
        assert_eq!(
            found.parts,
            [("right".to_owned(), vec![(1, 0.5), (2, 0.5)])]
        );
    }

    #[test]
    fn a_linear_temperature_is_kept_in_space() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.2, 0.3, 0.15],
        ];
        let elements = [[0, 1, 2, 4], [0, 3, 1, 4], [0, 2, 3, 4], [1, 3, 2, 4]];
        let mesh = Mesh::<Dim3>::new(
            points.map(Vector3::from).to_vec(),
            elements.concat(),
            &BTreeMap::new(),
        )
        .unwrap();
        let (found, flow) = inflow(&mesh, |x| x.x - 2.0 * x.y + 0.5 * x.z);
        assert!(flow[4].abs() < 1e-12, "{flow:?}");
        assert!((found.volumes.iter().sum::<f64>() - 1.0 / 6.0).abs() < 1e-12);
    }
}
