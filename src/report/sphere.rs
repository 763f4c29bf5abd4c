//! Spheres seen along an axis: three-dimensional grains as disks of a frame.

use super::canvas::{Canvas, Rgb};
use super::frame::Disk;
use super::paint::Paint;

/// Direction of an orthographic view.
#[derive(Clone, Copy, Debug)]
pub struct View {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
}

impl View {
    /// View with z upwards; the viewer stands at `azimuth` radians from the
    /// negative y axis, counterclockwise seen from above, and `elevation`
    /// radians above the horizontal. `View::new(0.0, 0.0)` shows x to the
    /// right and z upwards.
    pub fn new(azimuth: f64, elevation: f64) -> Self {
        let ((sa, ca), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
        Self {
            right: [ca, sa, 0.0],
            up: [-sa * se, ca * se, ce],
            towards: [sa * ce, -ca * ce, se],
        }
    }

    /// Position in the picture of a point in space, and its distance towards
    /// the viewer, in the length unit of the point (metres).
    pub fn project(&self, point: [f64; 3]) -> ([f64; 2], f64) {
        let dot = |a: &[f64; 3]| a[0] * point[0] + a[1] * point[1] + a[2] * point[2];
        ([dot(&self.right), dot(&self.up)], dot(&self.towards))
    }
}

/// The disk that shows one sphere, and its distance towards the viewer.
/// Centre and radius in metres, and what its colour says.
pub fn sphere_disk(centre: [f64; 3], radius: f64, paint: Paint, view: &View) -> (Disk, f64) {
    let (centre, depth) = view.project(centre);
    let disk = Disk {
        centre,
        radius,
        angle: 0.0,
        shade: SPHERE,
        paint,
    };
    (disk, depth)
}

/// Shade of the nearest sphere.
const SPHERE: f64 = 0.3;

/// Paints one lit sphere, centre and radius in pixels.
pub(super) fn paint_sphere(field: &mut Canvas, at: [f32; 2], radius: f32, base: Rgb) {
    // Light from the left above, in front of the picture; unit length.
    const LIGHT: [f32; 3] = [-0.45, -0.6, 0.661];
    let base = base.map(f32::from);
    field.disk(at, radius, |[dx, dy], _| {
        let (nx, ny) = (dx / radius, dy / radius);
        let nz = (1.0 - nx * nx - ny * ny).max(0.0).sqrt();
        let facing = (LIGHT[0] * nx + LIGHT[1] * ny + LIGHT[2] * nz).max(0.0);
        // The rim falls off as well, so that like spheres stand apart.
        let light = (0.42 + 0.62 * facing) * (0.62 + 0.38 * nz.sqrt());
        let gleam = 50.0 * facing.powi(24);
        base.map(|c| (light * c + gleam).min(255.0))
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn front_view_shows_x_and_z() {
        let (p, depth) = View::new(0.0, 0.0).project([1.0, 2.0, 3.0]);
        assert!((p[0] - 1.0).abs() + (p[1] - 3.0).abs() + (depth + 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_directions_of_a_view_are_orthonormal() {
        let v = View::new(0.7, 0.4);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        assert!((dot(v.up, v.up) - 1.0).abs() < 1e-12);
        let skew = [
            dot(v.right, v.up),
            dot(v.up, v.towards),
            dot(v.right, v.towards),
        ];
        assert!(skew.iter().all(|d| d.abs() < 1e-12));
    }
}
