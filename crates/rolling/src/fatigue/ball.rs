//! The smallest ball that holds points, by recursion over those on its surface (E. Welzl, New
//! Results and New Trends in Computer Science, LNCS 555, 1991).

/// A ball in D dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const D: usize> {
    /// Middle.
    pub middle: [f64; D],
    /// Radius, negative if the ball holds nothing.
    pub radius: f64,
}

/// Part of the size of the points within which one counts as inside.
const INSIDE: f64 = 1e-10;

/// Returns the smallest ball that holds all points.
pub fn smallest<const D: usize>(points: &[[f64; D]]) -> Ball<D> {
    let mut points = points.to_vec();
    let size = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let all = points.len();
    about(
        &mut points,
        all,
        &mut Vec::with_capacity(D + 1),
        INSIDE * size,
    )
}

/// Returns the smallest ball of the first points with some others on its surface.
fn about<const D: usize>(
    points: &mut [[f64; D]],
    first: usize,
    surface: &mut Vec<[f64; D]>,
    within: f64,
) -> Ball<D> {
    let mut ball = through(surface);
    if surface.len() > D {
        return ball;
    }
    for k in 0..first {
        let point = points[k];
        if distance(&point, &ball.middle) > ball.radius + within {
            surface.push(point);
            ball = about(points, k, surface, within);
            surface.pop();
            points[..=k].rotate_right(1);
        }
    }
    ball
}

/// Returns the smallest ball through points: its middle is a combination of their distances q from
/// the first of them, with 2 q_i . middle = q_i².
fn through<const D: usize>(points: &[[f64; D]]) -> Ball<D> {
    let Some(first) = points.first() else {
        return Ball {
            middle: [0.0; D],
            radius: -1.0,
        };
    };
    let n = points.len() - 1;
    let away = |k: usize| -> [f64; D] { std::array::from_fn(|c| points[k + 1][c] - first[c]) };
    let dot = |a: &[f64; D], b: &[f64; D]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let q = away(i);
            let products = (0..n).map(|j| 2.0 * dot(&q, &away(j)));
            products.chain([dot(&q, &q)]).collect()
        })
        .collect();
    let factors = eliminated(&mut rows);
    let middle =
        std::array::from_fn(|c| first[c] + (0..n).map(|k| factors[k] * away(k)[c]).sum::<f64>());
    Ball {
        radius: distance(first, &middle),
        middle,
    }
}

/// Solves equations of a symmetric matrix with the right-hand side as last column, where rows that
/// depend on others are left out.
fn eliminated(rows: &mut [Vec<f64>]) -> Vec<f64> {
    let n = rows.len();
    let size = (0..n).map(|k| rows[k][k]).fold(0.0, f64::max);
    let mut used = vec![false; n];
    for k in 0..n {
        let pivot = rows[k].clone();
        used[k] = pivot[k] > 1e-12 * size;
        if !used[k] {
            continue;
        }
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / pivot[k];
            debug_assert!(i < n);
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(r, p)| *r -= factor * p);
        }
    }
    (0..n)
        .map(|k| {
            if used[k] {
                rows[k][n] / rows[k][k]
            } else {
                0.0
            }
        })
        .collect()
}

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_simplex_has_the_ball_through_its_corners() {
        // Corners of the unit cube on the axes, and the origin: radius sqrt(5)/2.
        let corners: [[f64; 5]; 6] =
            std::array::from_fn(|k| std::array::from_fn(|c| if c == k { 1.0 } else { 0.0 }));
        let ball = smallest(&corners);
        // The origin lies inside the ball through the five others, whose radius is sqrt(4/5).
        assert!((ball.radius - 0.8f64.sqrt()).abs() < 1e-12, "{ball:?}");
        assert!(ball.middle.iter().all(|c| (c - 0.2).abs() < 1e-12));
    }

    #[test]
    fn lines_circles_and_single_points_have_their_balls() {
        let line: Vec<[f64; 5]> = (0..=20)
            .map(|k| {
                let t = f64::from(k) / 10.0 - 1.0;
                [3.0 * t + 1.0, -4.0 * t, 0.0, 2.0, 12.0 * t]
            })
            .collect();
        let ball = smallest(&line);
        assert!((ball.radius - 13.0).abs() < 1e-9, "{ball:?}");
        assert!((ball.middle[0] - 1.0).abs() < 1e-9 && (ball.middle[3] - 2.0).abs() < 1e-9);
        let ellipse: Vec<[f64; 5]> = (0..64)
            .map(|k| {
                let t = f64::from(k) * std::f64::consts::TAU / 64.0;
                [1.0, 2.0 * t.cos(), 0.0, 5.0 * t.sin(), 0.0]
            })
            .collect();
        assert!((smallest(&ellipse).radius - 5.0).abs() < 1e-9);
        assert_eq!(smallest(&[[7.0; 5]]).radius, 0.0);
        assert!(smallest::<5>(&[]).radius < 0.0);
    }

    /// No point lies outside, and at least two lie on the surface.
    #[test]
    fn a_cloud_lies_in_its_ball() {
        let mut seed = 1u64;
        let mut next = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / f64::from(1u32 << 31) - 0.5
        };
        for _ in 0..20 {
            let cloud: Vec<[f64; 5]> = (0..60).map(|_| std::array::from_fn(|_| next())).collect();
            let ball = smallest(&cloud);
            let far = |p: &[f64; 5]| distance(p, &ball.middle) - ball.radius;
            assert!(cloud.iter().all(|p| far(p) < 1e-8));
            assert!(cloud.iter().filter(|p| far(p).abs() < 1e-8).count() >= 2);
            // A smaller ball about a middle nearby does not hold them.
            for k in 0..5 {
                for by in [-1e-3, 1e-3] {
                    let mut middle = ball.middle;
                    middle[k] += by;
                    let most = cloud
                        .iter()
                        .map(|p| distance(p, &middle))
                        .fold(0.0, f64::max);
                    assert!(most > ball.radius - 1e-9);
                }
            }
        }
    }
}
