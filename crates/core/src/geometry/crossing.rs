//! Self-intersections of a chain of segments.

use nalgebra::Vector2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

type V = Vector2<f64>;

/// Returns the first two segments of a chain that intersect other than at a shared point, as the
/// indices of their start points, and the position (m). A chain monotonic in x has none.
pub fn first(points: &[V]) -> Option<(usize, usize, V)> {
    let steady = |sign: f64| points.windows(2).all(|w| sign * (w[1].x - w[0].x) > 0.0);
    if steady(1.0) || steady(-1.0) {
        return None;
    }
    let hold = |w: &[V]| Rectangle::from_corners([w[0].x, w[0].y], [w[1].x, w[1].y]);
    let boxes = points.windows(2).enumerate();
    let tree = RTree::bulk_load(
        boxes
            .map(|(k, w)| GeomWithData::new(hold(w), k))
            .collect::<Vec<_>>(),
    );
    let mut found: Option<(usize, usize, V)> = None;
    for (k, w) in points.windows(2).enumerate() {
        let window = AABB::from_corners([w[0].x, w[0].y], [w[1].x, w[1].y]);
        for other in tree.locate_in_envelope_intersecting(window) {
            let j = other.data;
            if j <= k || found.is_some_and(|f| (f.0, f.1) <= (k, j)) {
                continue;
            }
            let at = if j == k + 1 {
                folds(w[0], w[1], points[j + 1])
            } else {
                intersection([w[0], w[1]], [points[j], points[j + 1]])
            };
            if let Some(at) = at {
                found = Some((k, j, at));
            }
        }
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Returns whether a chain reverses direction at b.
fn folds(a: V, b: V, c: V) -> Option<V> {
    let (to, on) = (b - a, c - b);
    let back = to.perp(&on) == 0.0 && to.dot(&on) < 0.0;
    back.then_some(b)
}

/// Returns the intersection of two segments.
fn intersection([a, b]: [V; 2], [c, d]: [V; 2]) -> Option<V> {
    let (u, v, w) = (b - a, d - c, c - a);
    let cross = u.perp(&v);
    if cross == 0.0 {
        if u.perp(&w) != 0.0 {
            return None;
        }
        // Collinear: an end of one lies on the other.
        let on = |p: &V| (0.0..=1.0).contains(&((p - a).dot(&u) / u.norm_squared()));
        return [c, d].into_iter().find(on);
    }
    let (s, t) = (w.perp(&v) / cross, w.perp(&u) / cross);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a + u * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(points: &[[f64; 2]]) -> Option<(usize, usize, V)> {
        let points: Vec<V> = points.iter().map(|p| V::from(*p)).collect();
        first(&points)
    }

    #[test]
    fn a_loop_crosses_and_an_overhang_does_not() {
        let (k, j, at) =
            chain(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, -1.0]]).unwrap();
        assert_eq!((k, j, at), (0, 3, V::new(1.0, 0.0)));
        assert_eq!(
            chain(&[[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [3.0, 1.0]]),
            None
        );
    }

    #[test]
    fn going_back_on_the_same_line_is_a_crossing() {
        let (k, j, _) = chain(&[[0.0, 0.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5]]).unwrap();
        assert_eq!((k, j), (0, 1));
        assert_eq!(
            chain(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]),
            None
        );
    }
}
