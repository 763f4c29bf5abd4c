//! Bodies with faces seen along an axis, among spheres.

use super::canvas::{Canvas, Rgb};
use super::frame::Disk;
use super::paint::Paint;
use super::sphere::{View, sphere_disk};

/// A thing of a frame in space.
#[derive(Clone, Debug)]
pub enum Solid {
    /// A sphere.
    Sphere(Disk),
    /// The faces of a convex body that are seen.
    Faces(Vec<Face>),
}

/// A face as it is seen.
#[derive(Clone, Debug)]
pub struct Face {
    /// Corners (m).
    pub points: Vec<[f64; 2]>,
    /// Grey of the material, see [`Disk::shade`].
    pub shade: f64,
    /// How much light falls on it, 0 to 1.
    pub light: f64,
}

/// A convex body in space: its faces against the clock seen from outside, and its shade.
pub type Body = (Vec<Vec<[f64; 3]>>, f64);

/// All bodies and spheres `(centre, radius, paint)`, the farthest first. Far ones are darker, to show the depth of
/// the bed.
pub fn project(spheres: &[([f64; 3], f64, Paint)], bodies: &[Body], view: &View) -> Vec<Solid> {
    let mut seen: Vec<(Solid, f64)> = spheres
        .iter()
        .map(|&(centre, radius, paint)| sphere_disk(centre, radius, paint, view))
        .map(|(disk, depth)| (Solid::Sphere(disk), depth))
        .collect();
    for (faces, shade) in bodies {
        let corners = faces.iter().flatten();
        let (sum, count) = corners.fold((0.0, 0.0), |(s, n), p| (s + view.project(*p).1, n + 1.0));
        if count > 0.0 {
            seen.push((Solid::Faces(self::faces(faces, *shade, view)), sum / count));
        }
    }
    seen.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (far, near) = match (seen.first(), seen.last()) {
        (Some(first), Some(last)) => (first.1, last.1),
        _ => return Vec::new(),
    };
    let span = if near > far { near - far } else { 1.0 };
    let darker = |shade: f64, depth: f64| shade + (1.0 - shade) * (near - depth) / span * 0.8;
    for (solid, depth) in &mut seen {
        match solid {
            Solid::Sphere(disk) => disk.shade = darker(disk.shade, *depth),
            Solid::Faces(faces) => {
                for face in faces {
                    face.shade = darker(face.shade, *depth);
                }
            }
        }
    }
    seen.into_iter().map(|s| s.0).collect()
}

/// The faces that look towards the viewer.
pub fn faces(faces: &[Vec<[f64; 3]>], shade: f64, view: &View) -> Vec<Face> {
    let seen = faces.iter().filter_map(|corners| {
        let points: Vec<[f64; 2]> = corners.iter().map(|p| view.project(*p).0).collect();
        let area = |k: usize| {
            let (p, q) = (points[k], points[(k + 1) % points.len()]);
            p[0] * q[1] - p[1] * q[0]
        };
        let twice: f64 = (0..points.len()).map(area).sum();
        (twice > 0.0).then(|| Face {
            light: light(corners, view),
            points,
            shade,
        })
    });
    seen.collect()
}

/// Light from the left above, in front of the picture, as on spheres.
fn light(corners: &[[f64; 3]], view: &View) -> f64 {
    const LIGHT: [f64; 3] = [-0.45, 0.6, 0.661];
    let at = |k: usize| {
        let ([x, y], z) = view.project(corners[k % corners.len()]);
        [x, y, z]
    };
    let mut normal = [0.0; 3];
    for k in 0..corners.len() {
        let (p, q) = (at(k), at(k + 1));
        for (i, n) in normal.iter_mut().enumerate() {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            *n += p[j] * q[l] - p[l] * q[j];
        }
    }
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let dot: f64 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
    if length > 0.0 {
        (dot / length).max(0.0)
    } else {
        0.0
    }
}

/// Paints one face, its corners in pixels.
pub(super) fn paint(field: &mut Canvas, corners: &[[f32; 2]], light: f64, base: Rgb, edge: f32) {
    let tone = |c: u8, by: f64| (f64::from(c) * by).min(255.0) as u8;
    let by = 0.45 + 0.6 * light;
    field.polygon(corners, base.map(|c| tone(c, by)));
    field.stroke(corners, true, edge, base.map(|c| tone(c, 0.6 * by)), None);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube at a place.
    fn cube(x: f64, y: f64) -> Vec<Vec<[f64; 3]>> {
        let core = crate::geometry::convex::polyhedron::Polyhedron::cuboid([1.0; 3]);
        let at = nalgebra::Vector3::new(x, y, 0.0);
        (0..6)
            .map(|f| core.face(f).map(|p| (p + at).into()).collect())
            .collect()
    }

    #[test]
    fn of_a_cube_three_faces_are_seen_and_the_top_is_lit() {
        let view = View::new(0.6, 0.4);
        let seen = faces(&cube(0.0, 0.0), 0.3, &view);
        assert_eq!(seen.len(), 3);
        let straight = faces(&cube(0.0, 0.0), 0.3, &View::new(0.0, 0.0));
        assert_eq!(straight.len(), 1);
        assert!((straight[0].light - 0.661).abs() < 1e-12);
    }

    #[test]
    fn near_bodies_come_last_among_spheres() {
        let spheres = [([0.0, 0.0, 0.0], 1.0, Paint::Grey)];
        let bodies = [(cube(0.0, -3.0), 0.0), (cube(0.0, 3.0), 0.0)];
        let seen = project(&spheres, &bodies, &View::new(0.0, 0.0));
        assert!(matches!(seen[1], Solid::Sphere(_)) && seen.len() == 3);
        let (Solid::Faces(far), Solid::Faces(near)) = (&seen[0], &seen[2]) else {
            panic!("{seen:?}");
        };
        assert!(far[0].shade > near[0].shade);
    }
}
