//! Rigid motions of a body: whether supports leave it free to rotate, which small strain does not
//! permit, and its initial velocities.

use crate::element::Simplex;
use crate::freedom::Freedoms;
use crate::mesh::Mesh;
use crate::support::Support;
use fretwork_core::bodies::Dof;
use fretwork_core::geometry::space::{Space, VectorLike};
use nalgebra::DMatrix;

/// Returns whether some rigid motion with a rotation is compatible with all supports: u = t + w x
/// X, with u along a held axis zero where motion is imposed, and otherwise equal at all points of a
/// part. (A nonzero imposed motion does not matter: a part in its holder does not rotate.)
pub fn turns<S: Space>(mesh: &Mesh<S>, supports: &[Support]) -> bool {
    let d = S::D;
    let spins = if d == 2 { 1 } else { 3 };
    let held = |s: &Support| -> Vec<(usize, Dof)> {
        let axes = s.axes.iter().take(d).enumerate();
        axes.filter_map(|(k, dof)| Some((k, dof.clone()?)))
            .collect()
    };
    let common: usize = supports.iter().map(|s| held(s).len()).sum();
    let unknowns = d + spins + common;
    let points = mesh.points();
    let centre =
        points.iter().fold(S::Vector::zero(), |sum, x| sum + *x) * (1.0 / points.len() as f64);
    let size = points
        .iter()
        .map(|x| (*x - centre).norm())
        .fold(0.0, f64::max);
    let mut normal = DMatrix::<f64>::zeros(unknowns, unknowns);
    let mut next = d + spins;
    for support in supports {
        let of_part = mesh.points_of(&support.part).unwrap_or_default();
        for (axis, dof) in held(support) {
            for point in &of_part {
                let arm = (points[*point as usize] - centre) * (1.0 / size);
                let mut row = vec![0.0; unknowns];
                row[axis] = 1.0;
                for k in 0..spins {
                    let mut spin = S::Spin::zero();
                    spin[k] = 1.0;
                    row[d + k] = S::spin_velocity(&spin, &arm)[axis];
                }
                if !dof.imposes() {
                    row[next] = -1.0;
                }
                for i in 0..unknowns {
                    for j in 0..unknowns {
                        normal[(i, j)] += row[i] * row[j] / of_part.len() as f64;
                    }
                }
            }
            if dof.imposes() {
                // No common motion remains.
                normal[(next, next)] += 1.0;
            }
            next += 1;
        }
    }
    let modes = normal.symmetric_eigen();
    let most = modes.eigenvalues.iter().copied().fold(1.0, f64::max);
    (0..unknowns).any(|k| {
        let turning: f64 = (d..d + spins)
            .map(|r| modes.eigenvectors[(r, k)].powi(2))
            .sum();
        modes.eigenvalues[k] < 1e-12 * most && turning > 1e-8
    })
}

/// Returns the velocities of all coordinates of a body that moves rigidly, with a velocity of its
/// centre of mass (m/s) and an angular velocity about it (rad/s). Parts that move as one do not
/// rotate, and imposed coordinates are at rest.
pub fn velocities<S: Space>(
    mesh: &Mesh<S>,
    freedoms: &Freedoms<S>,
    velocity: &S::Vector,
    spin: &S::Spin,
) -> Vec<f64> {
    let (mut sum, mut volume) = (S::Vector::zero(), 0.0);
    for points in mesh.elements() {
        let corners = mesh.corners(points);
        let own = Simplex::<S>::new(&corners).map_or(0.0, |s| s.volume);
        volume += own;
        let all = corners.iter().fold(S::Vector::zero(), |sum, x| sum + *x);
        sum += all * (own / corners.len() as f64);
    }
    let centre = sum * (1.0 / volume);
    let held: Vec<u32> = freedoms.held.iter().map(|h| h.coordinate).collect();
    let mut out = vec![0.0; freedoms.total()];
    for (p, x) in mesh.points().iter().enumerate() {
        let turning = S::spin_velocity(spin, &(*x - centre));
        for axis in 0..S::D {
            let c = freedoms.of(p as u32, axis);
            if c < freedoms.free {
                let alone = !held.contains(&(c as u32));
                out[c] = velocity[axis] + if alone { turning[axis] } else { 0.0 };
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{block, even};
    use fretwork_core::geometry::space::{Dim2, Dim3};

    fn support(part: &str, axes: &[Option<Dof>]) -> Support {
        Support {
            part: part.to_owned(),
            axes: axes.to_vec(),
            later: Vec::new(),
        }
    }

    #[test]
    fn a_part_in_a_holder_cannot_turn() {
        let mesh = block::<Dim2>(&[even(0.0, 2.0, 2), even(0.0, 1.0, 2)]).unwrap();
        let held = |supports: &[Support]| !turns(&mesh, supports);
        assert!(!held(&[]));
        // A sliding holder prevents rotation; one along its own line does not.
        assert!(held(&[support("bottom", &[None, Some(Dof::Free)])]));
        assert!(!held(&[support("bottom", &[Some(Dof::Fixed), None])]));
        let sides = [
            support("left", &[Some(Dof::Fixed), None]),
            support("bottom", &[None, Some(Dof::Fixed)]),
        ];
        assert!(held(&sides));
        let mesh = block::<Dim3>(&[even(0.0, 1.0, 1), even(0.0, 1.0, 1), even(0.0, 1.0, 1)]);
        let mesh = mesh.unwrap();
        let up = support("bottom", &[None, None, Some(Dof::Fixed)]);
        assert!(turns(&mesh, std::slice::from_ref(&up)));
        let side = support("left", &[Some(Dof::Fixed)]);
        assert!(!turns(&mesh, &[up, side]));
    }
}
