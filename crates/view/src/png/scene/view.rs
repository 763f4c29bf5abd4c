//! Viewing direction of 3D pictures.

/// Direction of an orthographic view.
#[derive(Clone, Copy, Debug)]
pub struct View {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
}

impl View {
    /// View with z upwards; the viewer is at `azimuth` radians from the negative y axis,
    /// counterclockwise seen from above, and `elevation` radians above the horizontal.
    /// `View::new(0.0, 0.0)` shows x to the right and z upwards.
    pub fn new(azimuth: f64, elevation: f64) -> Self {
        let ((sa, ca), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
        Self {
            right: [ca, sa, 0.0],
            up: [-sa * se, ca * se, ce],
            towards: [sa * ce, -ca * ce, se],
        }
    }

    /// Projected position of a point, and its coordinate towards the viewer, in the length unit of
    /// the point (m).
    pub fn project(&self, point: [f64; 3]) -> ([f64; 2], f64) {
        let dot = |a: &[f64; 3]| a[0] * point[0] + a[1] * point[1] + a[2] * point[2];
        ([dot(&self.right), dot(&self.up)], dot(&self.towards))
    }
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
