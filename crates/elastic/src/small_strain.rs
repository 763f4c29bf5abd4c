//! Validity of small strain: its elements use e = (H + H^T)/2 of the gradient H of the displacement
//! for the strain e + H^T H/2, and apply forces at unloaded positions.

use crate::element::Simplex;
use crate::mesh::Mesh;
use fretwork_core::geometry::space::{Space, VectorLike};
use nalgebra::{Matrix3, Vector3};

/// Returns the largest principal strain in an element by magnitude, and the largest rotation (rad).
pub fn largest<S: Space>(mesh: &Mesh<S>, displacement: impl Fn(u32) -> S::Vector) -> [f64; 2] {
    let (mut strain, mut rotation) = (0.0f64, 0.0f64);
    for points in mesh.elements() {
        let Some(simplex) = Simplex::<S>::new(&mesh.corners(points)) else {
            continue;
        };
        let mut h = Matrix3::zeros();
        let origin = displacement(points[0]);
        for (point, g) in points.iter().zip(simplex.gradients()).skip(1) {
            let u = Vector3::from((displacement(*point) - origin).padded());
            h += u * Vector3::from(g.padded()).transpose();
        }
        let e = (h + h.transpose()) * 0.5;
        // No principal strain is larger than the norm.
        if e.norm() > strain {
            strain = strain.max(e.symmetric_eigenvalues().amax());
        }
        let turn = h - e;
        rotation = rotation.max(Vector3::new(turn[(2, 1)], turn[(0, 2)], turn[(1, 0)]).norm());
    }
    [strain, rotation]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{block, even};
    use fretwork_core::geometry::space::Dim2;
    use nalgebra::Vector2;

    #[test]
    fn strain_and_rotation_are_told_apart() {
        let mesh = block::<Dim2>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2)]).unwrap();
        let at = |p: u32| mesh.points()[p as usize];
        let turned = |p: u32| Vector2::new(-0.03 * at(p).y, 0.03 * at(p).x);
        let [strain, rotation] = largest(&mesh, turned);
        assert!(strain < 1e-16 && (rotation - 0.03).abs() < 1e-15);
        let sheared = |p: u32| Vector2::new(0.04 * at(p).y, 0.0);
        let [strain, rotation] = largest(&mesh, sheared);
        assert!((strain - 0.02).abs() < 1e-15 && (rotation - 0.02).abs() < 1e-15);
    }
}
