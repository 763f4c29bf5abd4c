//! Tables of points (time (s), value), linear between them and constant outside.

/// Points (time (s), value), sorted by time.
pub(super) type TimePoints = [(f64, f64)];

/// Returns the tolerance for equal times (s), computed by sums and differences of numbers of this
/// size.
pub(super) fn rounding(t: f64) -> f64 {
    16.0 * f64::EPSILON * t.abs()
}

/// Returns the points inside (t, t + h), without those that coincide with an end up to rounding.
pub(super) fn inside(points: &TimePoints, t: f64, h: f64) -> &TimePoints {
    let eps = rounding(t + h);
    let first = points.partition_point(|p| p.0 <= t + eps);
    let last = points.partition_point(|p| p.0 < t + h - eps);
    points.get(first..last).unwrap_or_default()
}

/// Returns the value at a time: linear between points, constant outside.
pub(super) fn value(points: &TimePoints, t: f64) -> f64 {
    let k = points.partition_point(|p| p.0 <= t);
    if k == 0 {
        points.first().map_or(0.0, |p| p.1)
    } else if k == points.len() {
        points[k - 1].1
    } else {
        let ((t0, x0), (t1, x1)) = (points[k - 1], points[k]);
        x0 + (x1 - x0) * (t - t0) / (t1 - t0)
    }
}

/// Returns the slope at a time; at a point of the table, that on its left.
pub(super) fn slope(points: &TimePoints, t: f64) -> f64 {
    slope_to(points, points.partition_point(|p| p.0 < t))
}

/// Returns the slope at a time; at a point of the table, that on its right.
pub(super) fn slope_after(points: &TimePoints, t: f64) -> f64 {
    slope_to(points, points.partition_point(|p| p.0 <= t))
}

/// Returns the slope of the segment that ends at point `k`; zero outside the table.
fn slope_to(points: &TimePoints, k: usize) -> f64 {
    if k == 0 || k == points.len() {
        return 0.0;
    }
    (points[k].1 - points[k - 1].1) / (points[k].0 - points[k - 1].0)
}

/// Returns the integral of the value from one time to a later one, exactly.
pub(super) fn integral(points: &TimePoints, from: f64, to: f64) -> f64 {
    let first = points.partition_point(|p| p.0 <= from);
    let last = points.partition_point(|p| p.0 < to);
    let corners = points.get(first..last).unwrap_or_default();
    let ends = [(from, value(points, from)), (to, value(points, to))];
    let (mut sum, mut before) = (0.0, ends[0]);
    for now in corners.iter().chain(&ends[1..]) {
        sum += 0.5 * (before.1 + now.1) * (now.0 - before.0);
        before = *now;
    }
    sum
}
