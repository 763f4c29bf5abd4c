//! The place on a chain of segments that a point of another chain faces on average over the segments at the point: the mortar method with
//! dual shape functions. Contacts of points with their nearest place alone do not carry a uniform pressure from one mesh to another that
//! does not match; with these weights they do.
//!
//! With the coordinate t along the contact and the dual function psi of the point, which is 2 - 3 s on the segment to a neighbour at
//! s = 1, and the shape function phi_k of a vertex of the other chain,
//!
//! ```text
//! w_k = int psi phi_k dt / int psi dt        gap = n . (x - sum_k w_k x_k)
//! ```
//!
//! psi is orthogonal to the shape functions of all other points of its chain, so that the contact acts on its point alone. The weights sum
//! to 1, and sum w_k t_k is the t of the point. They may be negative.
//!
//! Source: B. I. Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989; S. Hueeber and B. I. Wohlmuth, Comput. Methods Appl. Mech. Eng. 194 (2005)
//! 3147.

/// Coordinates along a contact of a point of one chain and of its neighbours (m), one or two, on either side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Of the point.
    pub at: f64,
    /// Of the neighbours before and after it.
    pub neighbours: [Option<f64>; 2],
}

/// Most vertices that a point is weighed over.
const MOST: usize = 64;
/// Share of a segment by which the end of one chain may lie beyond that of the other and still be taken for it.
const BEYOND: f64 = 1e-6;
/// Weights of rounding.
const NONE: f64 = 1e-9;

impl Footprint {
    /// From where to where it reaches.
    fn reach(&self) -> [f64; 2] {
        let ends = self.neighbours.map(|t| t.unwrap_or(self.at));
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }

    /// Whether its neighbours are on either side of it.
    fn straddles(&self) -> bool {
        match self.neighbours {
            [None, None] => false,
            [Some(a), Some(b)] => (a - self.at) * (b - self.at) < 0.0,
            [Some(t), None] | [None, Some(t)] => t != self.at,
        }
    }

    /// The vertices of a chain that it faces and their weights, which sum to 1. `along` has the coordinate of vertex `k` (m), of `count`
    /// vertices, and rises with k; `near` is a segment close to the point. None where the chain does not cover it or turns back.
    pub fn weights(
        &self,
        count: usize,
        near: usize,
        along: impl Fn(usize) -> f64,
    ) -> Option<Vec<(u32, f64)>> {
        if count < 2 || !self.straddles() {
            return None;
        }
        let [low, high] = self.reach();
        let last = count - 2;
        let mut first = near.min(last);
        for _ in 0..MOST {
            if first == 0 || along(first) <= low {
                break;
            }
            first -= 1;
        }
        let mut weights: Vec<(u32, f64)> = Vec::new();
        let mut total = 0.0;
        for k in first..(first + MOST).min(last + 1) {
            let [mut from, mut to] = [along(k), along(k + 1)];
            let [start, size] = [from, to - from];
            if start >= high {
                break;
            }
            if size <= 0.0 {
                return None;
            }
            let slack = BEYOND * size;
            if k == 0 && low >= from - slack {
                from = from.min(low);
            }
            if k == last && high <= to + slack {
                to = to.max(high);
            }
            let (mut of_first, mut of_second) = (0.0, 0.0);
            for neighbour in self.neighbours.into_iter().flatten() {
                let [one, other] = [self.at.min(neighbour), self.at.max(neighbour)];
                let [p, q] = [one.max(from), other.min(to)];
                if q <= p {
                    continue;
                }
                let psi = |t: f64| 2.0 - 3.0 * (t - self.at) / (neighbour - self.at);
                let phi = |t: f64| (t - start) / size;
                // Simpson's rule is exact for the product of two linear functions.
                for (t, share) in [(p, 1.0), (0.5 * (p + q), 4.0), (q, 1.0)] {
                    let part = share / 6.0 * (q - p) * psi(t);
                    of_first += part * (1.0 - phi(t));
                    of_second += part * phi(t);
                }
                total += q - p;
            }
            match weights.last_mut() {
                Some((vertex, weight)) if *vertex == k as u32 => *weight += of_first,
                _ => weights.push((k as u32, of_first)),
            }
            weights.push((k as u32 + 1, of_second));
        }
        if (total - (high - low)).abs() > BEYOND * (high - low) {
            return None;
        }
        let sum: f64 = weights.iter().map(|(_, w)| w).sum();
        weights.retain(|(_, w)| w.abs() > NONE * sum);
        let sum: f64 = weights.iter().map(|(_, w)| w).sum();
        weights.iter_mut().for_each(|(_, w)| *w /= sum);
        Some(weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A uniform pressure p on the points, p times the length that each stands for, is a uniform pressure on the vertices; and the mean
    /// place of linear coordinates is that of the point.
    #[test]
    fn a_uniform_pressure_stays_uniform() {
        let points = [0.0, 0.3, 0.5, 0.9, 1.3, 1.6];
        let vertices = [0.0, 0.22, 0.61, 0.7, 1.1, 1.25, 1.6];
        let mut carried = [0.0; 7];
        for (k, at) in points.iter().enumerate() {
            let before = k.checked_sub(1).map(|b| points[b]);
            let after = points.get(k + 1).copied();
            let footprint = Footprint {
                at: *at,
                neighbours: [before, after],
            };
            let stands_for = 0.5 * (after.unwrap_or(*at) - before.unwrap_or(*at));
            for near in 0..6 {
                let weights = footprint.weights(7, near, |v| vertices[v]).unwrap();
                let sum: f64 = weights.iter().map(|w| w.1).sum();
                let mean: f64 = weights.iter().map(|(v, w)| vertices[*v as usize] * w).sum();
                assert!((sum - 1.0).abs() < 1e-14 && (mean - at).abs() < 1e-14);
                if near == k.min(5) {
                    for (v, w) in weights {
                        carried[v as usize] += w * stands_for;
                    }
                }
            }
        }
        for (v, carried) in carried.iter().enumerate() {
            let before = vertices[v.saturating_sub(1)];
            let after = vertices[(v + 1).min(6)];
            assert!((carried - 0.5 * (after - before)).abs() < 1e-14, "{v}");
        }
    }

    #[test]
    fn points_of_matching_meshes_face_one_vertex() {
        let along = |k: usize| 0.1 * k as f64;
        for k in 0..=10usize {
            let footprint = Footprint {
                at: along(k),
                neighbours: [k.checked_sub(1).map(along), (k < 10).then(|| along(k + 1))],
            };
            let weights = footprint.weights(11, k.min(9), along).unwrap();
            assert_eq!(weights, [(k as u32, 1.0)]);
        }
    }

    #[test]
    fn a_chain_that_does_not_cover_the_segments_of_a_point_has_no_weights() {
        let along = |k: usize| 0.1 * k as f64;
        let beyond = Footprint {
            at: 0.95,
            neighbours: [Some(0.85), Some(1.05)],
        };
        assert_eq!(beyond.weights(11, 9, along), None);
        let alone = Footprint {
            at: 0.5,
            neighbours: [None, None],
        };
        assert_eq!(alone.weights(11, 5, along), None);
    }
}
