//! Volume, centre and inertia tensor of a rounded convex polyhedron, composed of the polyhedron, a
//! prism on each face, a cylinder wedge along each edge and a ball sector at each corner.

use super::polyhedron::Polyhedron;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

type V = Vector3<f64>;
type M = Matrix3<f64>;

/// Mass properties at unit density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolyhedronMass {
    /// Volume (m^3).
    pub volume: f64,
    /// Centre of mass (m).
    pub centre: V,
    /// Inertia tensor about the centre of mass (m^5).
    pub inertia: M,
}

/// Computes the mass properties of the points within `rounding` (m) of a convex core; a segment
/// gives a capsule.
pub fn of(core: &Polyhedron, rounding: f64) -> PolyhedronMass {
    // Relative to the first corner, to avoid cancellation far from the origin.
    let origin = core.points()[0];
    let mut sum = VolumeIntegrals::default();
    let (topology, normals) = (core.topology(), core.normals());
    for (face, n) in topology.faces.iter().zip(normals) {
        let at = |k: usize| core.points()[face[k] as usize] - origin;
        for k in 1..face.len() - 1 {
            sum.tetrahedron(at(0), at(k), at(k + 1));
            if rounding > 0.0 {
                sum.prism([at(0), at(k), at(k + 1)], n, rounding);
            }
        }
    }
    if rounding > 0.0 {
        for (e, edge) in topology.edges.iter().enumerate() {
            let ends = core.ends(e).map(|p| p - origin);
            let arc = match edge.faces {
                Some(faces) => DirectionArc::between(faces.map(|f| normals[f as usize])),
                None => DirectionArc::full(&(ends[1] - ends[0])),
            };
            sum.wedge(ends, &arc, rounding);
        }
        for (c, about) in topology.about.iter().enumerate() {
            let corner = core.points()[c] - origin;
            let cone = if about.is_empty() {
                // An end of a segment: half a ball.
                DirectionCone::half(&(corner - (core.points()[1 - c] - origin)).normalize())
            } else {
                DirectionCone::of(
                    &about
                        .iter()
                        .map(|f| normals[*f as usize])
                        .collect::<Vec<_>>(),
                )
            };
            sum.sector(corner, &cone, rounding);
        }
    }
    let centre = sum.first / sum.volume;
    let second = sum.second - centre * centre.transpose() * sum.volume;
    PolyhedronMass {
        volume: sum.volume,
        centre: centre + origin,
        inertia: M::identity() * second.trace() - second,
    }
}

/// Integrals of 1, x and x x^T.
#[derive(Default)]
struct VolumeIntegrals {
    volume: f64,
    first: V,
    second: M,
}

fn dyad(a: &V, b: &V) -> M {
    a * b.transpose()
}

fn both(a: &V, b: &V) -> M {
    dyad(a, b) + dyad(b, a)
}

impl VolumeIntegrals {
    fn add(&mut self, volume: f64, first: V, second: M) {
        self.volume += volume;
        self.first += first;
        self.second += second;
    }

    /// Adds the tetrahedron (origin, a, b, c).
    fn tetrahedron(&mut self, a: V, b: V, c: V) {
        let volume = a.dot(&b.cross(&c)) / 6.0;
        let s = a + b + c;
        let own = dyad(&s, &s) + dyad(&a, &a) + dyad(&b, &b) + dyad(&c, &c);
        self.add(volume, s * (volume / 4.0), own * (volume / 20.0));
    }

    /// Adds the prism of this height outside a triangle.
    fn prism(&mut self, [a, b, c]: [V; 3], n: &V, height: f64) {
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        let s = a + b + c;
        let first = s * (area / 3.0);
        let own = dyad(&s, &s) + dyad(&a, &a) + dyad(&b, &b) + dyad(&c, &c);
        let h = height;
        self.add(
            area * h,
            first * h + n * (0.5 * area * h * h),
            own * (area * h / 12.0)
                + both(&first, n) * (0.5 * h * h)
                + dyad(n, n) * (area * h.powi(3) / 3.0),
        );
    }

    /// Adds the points within `radius` of an edge, between the directions of the arc.
    fn wedge(&mut self, [a, b]: [V; 2], arc: &DirectionArc, radius: f64) {
        let length = (b - a).norm();
        let along = (a + b) * (0.5 * length);
        let line = (both(&a, &b) + (dyad(&a, &a) + dyad(&b, &b)) * 2.0) * (length / 6.0);
        let area = 0.5 * arc.angle * radius * radius;
        let out = arc.first * (radius.powi(3) / 3.0);
        self.add(
            area * length,
            along * area + out * length,
            line * area + both(&along, &out) + arc.second * (length * radius.powi(4) / 4.0),
        );
    }

    /// Adds the points within `radius` of a corner, between the directions of the cone.
    fn sector(&mut self, corner: V, cone: &DirectionCone, radius: f64) {
        let volume = cone.angle * radius.powi(3) / 3.0;
        let out = cone.first * (radius.powi(4) / 4.0);
        self.add(
            volume,
            corner * volume + out,
            dyad(&corner, &corner) * volume
                + both(&corner, &out)
                + cone.second * (radius.powi(5) / 5.0),
        );
    }
}

/// Integrals of 1, u and u u^T over the unit vectors of an arc.
struct DirectionArc {
    angle: f64,
    first: V,
    second: M,
}

impl DirectionArc {
    fn between([a, b]: [V; 2]) -> Self {
        let angle = a.cross(&b).norm().atan2(a.dot(&b));
        let middle = (a + b).normalize();
        let across = (b - a).try_normalize(0.0).unwrap_or_else(V::zeros);
        let s = angle.sin();
        Self {
            angle,
            first: middle * (2.0 * (0.5 * angle).sin()),
            second: dyad(&middle, &middle) * (0.5 * (angle + s))
                + dyad(&across, &across) * (0.5 * (angle - s)),
        }
    }

    /// Integrates over all directions perpendicular to an axis.
    fn full(axis: &V) -> Self {
        let t = axis.normalize();
        Self {
            angle: 2.0 * PI,
            first: V::zeros(),
            second: (M::identity() - dyad(&t, &t)) * PI,
        }
    }
}

/// Integrals of 1, u and u u^T over the unit vectors of a convex cone.
struct DirectionCone {
    angle: f64,
    first: V,
    second: M,
}

impl DirectionCone {
    /// Integrates over the cone of unit vectors given anticlockwise.
    ///
    /// The solid angle follows van Oosterom and Strackee (1983); the others follow from Stokes'
    /// theorem on the arcs, whose planes have the normals m: int u = sum angle m/2, and, since u
    /// u^T - 1/3 is a spherical harmonic of degree 2, int (u u^T - 1/3) = sum (m N^T + N m^T)/6
    /// with N = int u over the arc.
    fn of(normals: &[V]) -> Self {
        let a = &normals[0];
        let mut angle = 0.0;
        for pair in normals[1..].windows(2) {
            let (b, c) = (&pair[0], &pair[1]);
            let det = a.dot(&b.cross(c));
            angle += 2.0 * det.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        }
        let (mut first, mut second) = (V::zeros(), M::identity() * (angle / 3.0));
        for (k, a) in normals.iter().enumerate() {
            let b = &normals[(k + 1) % normals.len()];
            let arc = DirectionArc::between([*a, *b]);
            let Some(m) = a.cross(b).try_normalize(0.0) else {
                continue;
            };
            first += m * (0.5 * arc.angle);
            second += both(&m, &arc.first) / 6.0;
        }
        Self {
            angle,
            first,
            second,
        }
    }

    /// Integrates over the half space of directions about one.
    fn half(direction: &V) -> Self {
        Self {
            angle: 2.0 * PI,
            first: direction * PI,
            second: M::identity() * (2.0 * PI / 3.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: &M, known: &M) -> bool {
        (found - known).norm() <= 1e-12 * known.norm()
    }

    #[test]
    fn a_cuboid_and_a_tetrahedron_anywhere() {
        let (x, y, z) = (2.0, 3.0, 5.0);
        let far = V::new(70.0, -30.0, 20.0);
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(V::new(0.3, -0.8, 0.5));
        let cuboid = Polyhedron::cuboid([x, y, z]);
        let points: Vec<V> = cuboid.points().iter().map(|p| turn * p + far).collect();
        let m = of(&Polyhedron::new(&points).unwrap(), 0.0);
        let r = turn.to_rotation_matrix();
        let about = V::new(y * y + z * z, x * x + z * z, x * x + y * y) * (x * y * z / 12.0);
        assert!((m.volume - x * y * z).abs() < 1e-11 && (m.centre - far).norm() < 1e-11);
        assert!(
            (m.inertia - r * M::from_diagonal(&about) * r.transpose()).norm()
                < 1e-10 * about.norm()
        );
        // Regular, side s: V = s^3/(6 sqrt 2), I = V s^2/20.
        let points = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        let m = of(&Polyhedron::new(&points.map(V::from)).unwrap(), 0.0);
        let (volume, side) = (8.0 / 3.0, 8f64.sqrt());
        assert!((m.volume - volume).abs() < 1e-13);
        assert!(close(
            &m.inertia,
            &(M::identity() * (volume * side * side / 20.0))
        ));
    }

    #[test]
    fn a_capsule_is_a_cylinder_and_a_ball_cut_in_two() {
        let (l, r) = (3.0, 0.5);
        let m = of(
            &Polyhedron::segment(V::new(4.0, 1.0, 0.0), V::new(4.0, 1.0, l)),
            r,
        );
        let (rod, half) = (PI * r * r * l, 2.0 / 3.0 * PI * r.powi(3));
        // The centroid of a half ball is 3 r/8 from the cut, and its moment is 2/5 r^2 per volume
        // about the ball's centre.
        let c = 0.375 * r;
        let own = half * (0.4 * r * r - c * c + (0.5 * l + c).powi(2));
        let across = rod * (r * r / 4.0 + l * l / 12.0) + 2.0 * own;
        let along = 0.5 * rod * r * r + 2.0 * half * 0.4 * r * r;
        let known = M::from_diagonal(&V::new(across, across, along));
        assert!((m.volume - rod - 2.0 * half).abs() < 1e-13);
        assert!((m.centre - V::new(4.0, 1.0, 0.5 * l)).norm() < 1e-13);
        assert!(close(&m.inertia, &known));
    }

    #[test]
    fn a_rounded_cuboid_is_measured_by_its_parts() {
        // By symmetry only the second moments along the axes are nonzero: core, slabs, quarter
        // cylinders, eighths of a ball.
        let (size, r) = ([1.0, 2.0, 3.0], 0.4);
        let m = of(&Polyhedron::cuboid(size), r);
        let volume: f64 = size.iter().product();
        let [x, y, z] = size;
        let area = 2.0 * (x * y + y * z + z * x);
        let steiner = volume + area * r + PI * (x + y + z) * r * r + 4.0 / 3.0 * PI * r.powi(3);
        assert!((m.volume - steiner).abs() < 1e-12 && m.centre.norm() < 1e-12);
        let second = |k: usize| {
            let (a, b, c) = (size[k], size[(k + 1) % 3], size[(k + 2) % 3]);
            let h = 0.5 * a;
            let long = a.powi(3) / 12.0;
            let beyond = ((h + r).powi(3) - h.powi(3)) / 3.0;
            let core = b * c * long;
            let slabs = 2.0 * b * c * beyond + 2.0 * (b + c) * r * long;
            let rods_along = PI * r * r * long;
            // Four quarter disks at height h: area PI r^2/4, centre 4r/(3 PI), second moment PI
            // r^4/16.
            let quarter =
                PI * r * r / 4.0 * h * h + 2.0 * h * r.powi(3) / 3.0 + PI * r.powi(4) / 16.0;
            let rods = 4.0 * (b + c) * quarter;
            let eighth = PI * r.powi(3) / 6.0;
            let balls = 8.0 * (eighth * (h * h + 2.0 * h * 0.375 * r) + eighth * r * r / 5.0);
            core + slabs + rods_along + rods + balls
        };
        let s = [second(0), second(1), second(2)];
        let known = M::from_diagonal(&V::new(s[1] + s[2], s[0] + s[2], s[0] + s[1]));
        assert!(close(&m.inertia, &known), "{} {known}", m.inertia);
    }

    #[test]
    fn a_rounded_tetrahedron_far_inside_its_ball_is_that_ball() {
        let points = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        let (small, r) = (1e-7, 1.0);
        let m = of(
            &Polyhedron::new(&points.map(|p| V::from(p) * small)).unwrap(),
            r,
        );
        let ball = 4.0 / 3.0 * PI;
        assert!((m.volume - ball).abs() < 1e-5);
        assert!((m.inertia - M::identity() * (0.4 * ball)).norm() < 1e-5);
        // Steiner's formula to the second order: V + S r + (sum of L angle/2) r^2 + 4/3 PI r^3.
        let (side, r) = (8f64.sqrt(), 0.3);
        let m = of(&Polyhedron::new(&points.map(V::from)).unwrap(), r);
        let turn = PI - (1.0f64 / 3.0).acos();
        let steiner = 8.0 / 3.0
            + 3f64.sqrt() * side * side * r
            + 6.0 * side * 0.5 * turn * r * r
            + ball * r.powi(3);
        assert!((m.volume - steiner).abs() < 1e-12);
    }
}
