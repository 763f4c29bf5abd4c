//! Quadrature over the overlap of two segments of a line, or of two triangles of a plane, exact for
//! quadratic functions.

/// A position in the coordinates along a contact (m); in the plane, where that is a line, the
/// second coordinate is zero.
pub type TangentialPoint = [f64; 2];

/// Maximum number of corners of the overlap of two triangles; clipping by a side adds one.
const CORNERS: usize = 9;

/// Returns twice the area of a triangle, positive where its corners are anticlockwise (m^2).
fn twice_area(a: TangentialPoint, b: TangentialPoint, c: TangentialPoint) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns the length of a segment (m), positive where it goes up, or the area of a triangle (m^2),
/// positive where it is anticlockwise.
pub fn signed_size(corners: &[TangentialPoint]) -> f64 {
    match corners {
        [a, b] => b[0] - a[0],
        [a, b, c] => 0.5 * twice_area(*a, *b, *c),
        _ => 0.0,
    }
}

/// Returns the shape functions of a segment or triangle at a position; that of the third corner is
/// zero on a segment.
pub fn shape_functions(corners: &[TangentialPoint], at: TangentialPoint) -> [f64; 3] {
    match corners {
        [a, b] => {
            let s = (at[0] - a[0]) / (b[0] - a[0]);
            [1.0 - s, s, 0.0]
        }
        [a, b, c] => {
            let all = twice_area(*a, *b, *c);
            let (second, third) = (twice_area(*a, at, *c) / all, twice_area(*a, *b, at) / all);
            [1.0 - second - third, second, third]
        }
        _ => [0.0; 3],
    }
}

/// Calls a function with positions and weights (m or m^2) whose sum over a quadratic function is
/// its integral over the overlap of two segments or two triangles of any orientations.
pub fn integrate(
    one: &[TangentialPoint],
    other: &[TangentialPoint],
    mut call: impl FnMut(TangentialPoint, f64),
) {
    match (one, other) {
        ([a, b], [c, d]) => {
            let from = a[0].min(b[0]).max(c[0].min(d[0]));
            let to = a[0].max(b[0]).min(c[0].max(d[0]));
            if to > from {
                // Simpson's rule.
                let sixth = (to - from) / 6.0;
                call([from, 0.0], sixth);
                call([0.5 * (from + to), 0.0], 4.0 * sixth);
                call([to, 0.0], sixth);
            }
        }
        ([a, b, c], [d, e, f]) => {
            let (polygon, count) = common([*a, *b, *c], [*d, *e, *f]);
            let middle =
                |p: TangentialPoint, q: TangentialPoint| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            for k in 2..count {
                let [p, q, r] = [polygon[0], polygon[k - 1], polygon[k]];
                let third = 0.5 * twice_area(p, q, r).abs() / 3.0;
                if third > 0.0 {
                    call(middle(p, q), third);
                    call(middle(q, r), third);
                    call(middle(r, p), third);
                }
            }
        }
        _ => {}
    }
}

/// Returns the convex polygon that two triangles have in common, and the number of its corners.
///
/// Source: I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", Commun. ACM 17 (1974)
/// 32.
fn common(
    one: [TangentialPoint; 3],
    other: [TangentialPoint; 3],
) -> ([TangentialPoint; CORNERS], usize) {
    let [a, b, c] = one;
    let sides = match twice_area(a, b, c) > 0.0 {
        true => [[a, b], [b, c], [c, a]],
        false => [[a, c], [c, b], [b, a]],
    };
    let mut polygon = [[0.0; 2]; CORNERS];
    polygon[..3].copy_from_slice(&other);
    let mut count = 3;
    for [from, to] in sides {
        let before = polygon;
        let inside: [f64; CORNERS] = std::array::from_fn(|k| twice_area(from, to, before[k]));
        let corners = count;
        count = 0;
        for k in 0..corners {
            let next = (k + 1) % corners;
            let (here, there) = (inside[k], inside[next]);
            if here >= 0.0 {
                polygon[count] = before[k];
                count += 1;
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let s = here / (here - there);
                let (p, q) = (before[k], before[next]);
                polygon[count] = [p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])];
                count += 1;
            }
        }
    }
    (polygon, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the integrals of 1, x and y^2 over the overlap.
    fn integrals(one: &[TangentialPoint], other: &[TangentialPoint]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        integrate(one, other, |at, weight| {
            sum[0] += weight;
            sum[1] += weight * at[0];
            sum[2] += weight * at[1] * at[1];
        });
        sum
    }

    #[test]
    fn triangles_that_cross() {
        let whole = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let inner = [[0.1, 0.1], [0.1, 0.3], [0.4, 0.1]];
        // A square of side 1/2 and two cut corners of it.
        let cut = [[0.5, 0.5], [-2.0, 0.5], [0.5, -2.0]];
        let expected = [0.25, 0.0625, 1.0 / 48.0];
        for (other, expected) in [(&cut, expected), (&whole, [0.5, 1.0 / 6.0, 1.0 / 12.0])] {
            for one in [whole, [whole[0], whole[2], whole[1]]] {
                for found in [integrals(&one, other), integrals(other, &one)] {
                    for (found, expected) in found.iter().zip(expected) {
                        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
                    }
                }
            }
        }
        assert!((integrals(&whole, &inner)[0] - 0.03).abs() < 1e-16);
        let apart = [[0.6, 0.6], [1.0, 0.6], [1.0, 1.0]];
        assert_eq!(integrals(&whole, &apart), [0.0; 3]);
    }

    /// A hexagon: every side of one cuts the other.
    #[test]
    fn a_star_of_two_triangles() {
        let at = |k: f64| {
            let angle = std::f64::consts::TAU * k / 12.0;
            [angle.cos(), angle.sin()]
        };
        let (one, other) = ([at(0.0), at(4.0), at(8.0)], [at(2.0), at(6.0), at(10.0)]);
        let found = integrals(&one, &other);
        assert!((found[0] - 0.5 * 3.0f64.sqrt()).abs() < 1e-15 && found[1].abs() < 1e-15);
    }

    #[test]
    fn segments_and_their_shape_functions() {
        let found = integrals(&[[2.0, 0.0], [0.0, 0.0]], &[[1.0, 0.0], [5.0, 0.0]]);
        assert!((found[0] - 1.0).abs() < 1e-15 && (found[1] - 1.5).abs() < 1e-15);
        let corners = [[0.1, 0.2], [1.1, 0.0], [0.3, 0.9]];
        let shares = [0.2, 0.5, 0.3];
        let mut at = [0.0; 2];
        for (corner, share) in corners.iter().zip(shares) {
            at[0] += share * corner[0];
            at[1] += share * corner[1];
        }
        for (found, expected) in shape_functions(&corners, at).iter().zip(shares) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
