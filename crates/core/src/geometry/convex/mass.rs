//! Area, centre and moment of inertia of a rounded convex polygon, composed of the polygon, a
//! rectangle on each side and a disk sector at each corner.

use nalgebra::Vector2;

type V = Vector2<f64>;

/// Mass properties at unit density and unit depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonMass {
    /// Area (m^2).
    pub area: f64,
    /// Centre of mass (m).
    pub centre: V,
    /// Second polar moment about the centre of mass (m^4).
    pub polar: f64,
}

/// Computes the mass properties of the points within `rounding` (m) of the convex polygon with
/// these corners (m), given anticlockwise. Two points are the core of a capsule.
pub fn of(points: &[V], rounding: f64) -> PolygonMass {
    // Relative to the first corner, to avoid cancellation far from the origin.
    let origin = points[0];
    let n = points.len();
    let mut sum = AreaIntegrals::default();
    for k in 0..n {
        let (a, b) = (points[k] - origin, points[(k + 1) % n] - origin);
        sum.triangle(a, b);
        if rounding > 0.0 {
            sum.rectangle(a, b, rounding);
            let before = a - (points[(k + n - 1) % n] - origin);
            sum.sector(a, before, b - a, rounding);
        }
    }
    let centre = sum.first / sum.area;
    PolygonMass {
        area: sum.area,
        centre: centre + origin,
        polar: sum.second - sum.area * centre.norm_squared(),
    }
}

#[derive(Default)]
struct AreaIntegrals {
    area: f64,
    first: V,
    second: f64,
}

impl AreaIntegrals {
    /// Adds the triangle (origin, a, b).
    fn triangle(&mut self, a: V, b: V) {
        let area = 0.5 * a.perp(&b);
        self.area += area;
        self.first += (a + b) * (area / 3.0);
        self.second += area * (a.norm_squared() + a.dot(&b) + b.norm_squared()) / 6.0;
    }

    /// Adds the rectangle of this height outside the side from a to b.
    fn rectangle(&mut self, a: V, b: V, height: f64) {
        let along = b - a;
        let length = along.norm();
        let outward = V::new(along.y, -along.x) / length;
        let centre = (a + b) * 0.5 + outward * (0.5 * height);
        let area = length * height;
        self.area += area;
        self.first += centre * area;
        let own = area * (length * length + height * height) / 12.0;
        self.second += own + area * centre.norm_squared();
    }

    /// Adds the sector at a corner between the normals of the adjacent sides.
    fn sector(&mut self, corner: V, before: V, after: V, radius: f64) {
        let mut angle = before.perp(&after).atan2(before.dot(&after));
        if angle < 0.0 {
            // For two points the direction reverses, by plus or minus pi.
            angle += std::f64::consts::TAU;
        }
        if angle == 0.0 {
            return;
        }
        let area = 0.5 * angle * radius * radius;
        // The normal of the previous side, rotated by half the angle.
        let normal = V::new(before.y, -before.x) / before.norm();
        let (s, c) = (0.5 * angle).sin_cos();
        let middle = V::new(c * normal.x - s * normal.y, s * normal.x + c * normal.y);
        let own = middle * (4.0 * radius * s / (3.0 * angle));
        self.area += area;
        self.first += (corner + own) * area;
        self.second +=
            area * (corner.norm_squared() + 2.0 * corner.dot(&own)) + 0.25 * angle * radius.powi(4);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-13 * b.abs()
    }

    #[test]
    fn a_rectangle_a_triangle_and_a_regular_hexagon() {
        let (x, y) = (5.0, -3.0);
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        let box_ = corners.map(|c| V::new(c.0 + x, c.1 + y));
        let m = of(&box_, 0.0);
        assert!(close(m.area, 2.0) && close(m.polar, 2.0 * (4.0 + 1.0) / 12.0));
        assert!((m.centre - V::new(x + 1.0, y + 0.5)).norm() < 1e-14);
        // Side s: area s^2 sqrt(3)/4, polar moment sqrt(3) s^4/48.
        let triangle = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.75f64.sqrt())];
        let m = of(&triangle.map(|c| V::new(c.0, c.1)), 0.0);
        assert!(close(m.area, 3f64.sqrt() / 4.0) && close(m.polar, 3f64.sqrt() / 48.0));
        // Circumradius R: polar moment 5 sqrt(3)/8 R^4.
        let hexagon: Vec<_> = (0..6)
            .map(|k| f64::from(k) * PI / 3.0)
            .map(|a| V::new(a.cos(), a.sin()))
            .collect();
        assert!(close(of(&hexagon, 0.0).polar, 5.0 * 3f64.sqrt() / 8.0));
    }

    #[test]
    fn a_capsule_is_a_rectangle_and_a_disk_cut_in_two() {
        let (l, r) = (3.0, 0.5);
        let m = of(&[V::new(1.0, 0.0), V::new(1.0, l)], r);
        let half = 0.5 * PI * r * r;
        // The centroid of a half disk is 4 r/(3 pi) from the cut, and its polar moment about the
        // disk's centre is r^2/2 per area.
        let c = 4.0 * r / (3.0 * PI);
        let about = half * (0.5 * r * r - c * c + (0.5 * l + c).powi(2));
        let polar = 2.0 * r * l * (l * l + 4.0 * r * r) / 12.0 + 2.0 * about;
        assert!(close(m.area, 2.0 * r * l + PI * r * r) && close(m.polar, polar));
        assert!((m.centre - V::new(1.0, 0.5 * l)).norm() < 1e-14);
    }

    #[test]
    fn a_rounded_square_is_measured_by_its_parts() {
        let (a, r) = (2.0, 0.3);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let m = of(&corners.map(|c| V::new(c.0, c.1)), r);
        let quarter = 0.25 * PI * r * r;
        let c = 4.0 * r / (3.0 * PI);
        let corner = quarter * (0.5 * r * r - 2.0 * c * c + 2.0 * (1.0 + c).powi(2));
        let side = a * r * ((a * a + r * r) / 12.0 + (1.0 + 0.5 * r).powi(2));
        assert!(close(m.area, a * a + 4.0 * a * r + PI * r * r));
        assert!(close(m.polar, a.powi(4) / 6.0 + 4.0 * side + 4.0 * corner));
        assert!(m.centre.norm() < 1e-14);
    }
}
