//! The place on a surface that a point of another surface faces on average over the facets at the
//! point: the mortar method with dual shape functions. Contacts of points with their nearest place
//! alone do not carry a uniform pressure from one mesh to another that does not match; with these
//! weights they do. Facets are segments in the plane and triangles in space.
//!
//! With the coordinates t along the contact from the point, the dual function psi of the point, the
//! shape function phi_k of a vertex of the other surface, and C the part of a facet at the point
//! that the other surface covers, seen along the normal,
//!
//! ```text
//! w_k = int_C psi phi_k dt / int_C psi dt        gap = n . (x - sum_k w_k x_k)
//! psi = c (1 + b . t)        int_C psi t dt = 0        int_C psi dt = int_C phi dt
//! ```
//!
//! psi is orthogonal to the shape functions of all other points of its surface, so that the contact
//! acts on its point alone; these are the linear functions that vanish at the point. On a facet
//! that is covered as a whole psi is 2 - 3 s on a segment, s = 1 at its other end, and 3 phi -
//! phi_2 - phi_3 on a triangle with the shape functions phi_2, phi_3 of the other corners. Where
//! the other surface ends below a facet psi is found anew on what is covered. The weights sum to 1,
//! and sum w_k t_k is the place of the point. They may be negative.
//!
//! The volume worn at a point is taken from below its facets: vertex k gives the share s_k =
//! int_C phi phi_k dt / int_C phi dt of it, with the shape function phi of the point. Shares sum to
//! 1, and none is negative. A depth that is the same at all points, on the areas that they stand
//! for, is the same at all vertices, since the phi of all points sum to 1.
//!
//! Sources: B. I. Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989; S. Hueeber and B. I. Wohlmuth,
//! Comput. Methods Appl. Mech. Eng. 194 (2005) 3147; M. A. Puso and T. A. Laursen, Comput. Methods
//! Appl. Mech. Eng. 193 (2004) 601 (facets in space); T. Cichosz and M. Bischoff, Comput. Methods
//! Appl. Mech. Eng. 200 (2011) 1317 (facets that are covered in part).

use super::overlap::{Along, integrate, shape_functions, signed_size};

/// Share of a facet that counts for nothing: what is covered of it, or is covered twice, or by
/// which the point lies beside the other surface.
const ROUNDING: f64 = 1e-6;
/// Weights of rounding.
const NONE: f64 = 1e-12;
/// Largest sum of the sizes of weights of a point beside the other surface: with one facet of which
/// half is covered it is 4.5, and 1.7 where all is.
const FARTHEST: f64 = 4.5;
/// Smallest determinant of the second moments of what is covered, over the product of these, from
/// which on it is an area.
const FLAT: f64 = 1e-12;

/// The facets at a point, and their overlap with another surface.
#[derive(Clone, Debug)]
pub struct Star {
    facets: Vec<StarFacet>,
    /// Whether the point itself faces the other surface.
    covered: bool,
}

/// A facet at the point.
#[derive(Clone, Debug)]
struct StarFacet {
    /// D corners.
    corners: [Along; 3],
    count: usize,
    /// The point among them.
    point: usize,
    /// Length (m) or area (m^2).
    size: f64,
    /// Over what is covered of it the integrals of 1, the coordinates, their squares, and their
    /// product.
    one: f64,
    first: Along,
    squares: Along,
    product: f64,
    /// Over the same the integrals of the shape functions of vertices of the other surface.
    vertices: Vec<VertexIntegral>,
    /// Integral of the shape function of the point over the same.
    own: f64,
}

/// Integrals of the shape function of a vertex of the other surface over what is covered of a
/// facet.
#[derive(Clone, Copy, Debug, Default)]
struct VertexIntegral {
    vertex: u32,
    alone: f64,
    /// With the coordinates.
    with: Along,
    /// With the shape function of the point.
    own: f64,
}

/// The vertices of another surface that a point faces, in increasing order, with numbers that sum
/// to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Faced {
    /// The weights of the mean place.
    pub weights: Vec<(u32, f64)>,
    /// The shares of what is worn off; none is negative.
    pub shares: Vec<(u32, f64)>,
}

/// Sums up the numbers of each vertex, leaves out those of rounding, and has the others sum to 1;
/// none where they sum to nothing.
fn normalised(mut all: Vec<(u32, f64)>) -> Option<Vec<(u32, f64)>> {
    all.sort_by_key(|(vertex, _)| *vertex);
    let mut sums: Vec<(u32, f64)> = Vec::with_capacity(all.len());
    for (vertex, number) in all {
        match sums.last_mut() {
            Some((last, sum)) if *last == vertex => *sum += number,
            _ => sums.push((vertex, number)),
        }
    }
    let total = |sums: &[(u32, f64)]| sums.iter().map(|s| s.1).sum::<f64>();
    let sum = total(&sums);
    sums.retain(|(_, number)| number.abs() > NONE * sum);
    let sum = total(&sums);
    sums.iter_mut().for_each(|(_, number)| *number /= sum);
    (!sums.is_empty() && sum > 0.0).then_some(sums)
}

/// From where to where corners reach along an axis (m).
fn range(corners: &[Along], axis: usize) -> [f64; 2] {
    let along = corners.iter().map(|c| c[axis]);
    along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

impl StarFacet {
    fn corners(&self) -> &[Along] {
        &self.corners[..self.count]
    }

    /// Adds what it has in common with a facet of the other surface; gives its size.
    fn face(&mut self, vertices: &[u32], at: &[Along]) -> f64 {
        let own = self.corners;
        let (mut one, mut parts) = (0.0, [VertexIntegral::default(); 3]);
        integrate(&own[..self.count], at, |t, weight| {
            one += weight;
            let of_point = weight * shape_functions(&own[..self.count], t)[self.point];
            self.own += of_point;
            for (axis, t) in t.iter().enumerate() {
                self.first[axis] += weight * t;
                self.squares[axis] += weight * t * t;
            }
            self.product += weight * t[0] * t[1];
            for (part, phi) in parts.iter_mut().zip(shape_functions(at, t)) {
                part.alone += weight * phi;
                part.with[0] += weight * phi * t[0];
                part.with[1] += weight * phi * t[1];
                part.own += of_point * phi;
            }
        });
        self.one += one;
        if one > 0.0 {
            let parts = vertices.iter().zip(parts);
            self.vertices
                .extend(parts.map(|(k, part)| VertexIntegral { vertex: *k, ..part }));
        }
        one
    }

    /// b and c of the dual function; none where nothing, or a line of no area, is covered.
    fn dual(&self) -> Option<(Along, f64)> {
        if self.one <= ROUNDING * self.size {
            return None;
        }
        let ([x, y], [xx, yy], xy) = (self.first, self.squares, self.product);
        let b = match self.count {
            2 => [-x / xx, 0.0],
            _ => {
                let determinant = xx * yy - xy * xy;
                if determinant <= FLAT * xx * yy {
                    return None;
                }
                [
                    (xy * y - yy * x) / determinant,
                    (xy * x - xx * y) / determinant,
                ]
            }
        };
        let sum = self.one + b[0] * x + b[1] * y;
        (sum > FLAT * self.one).then(|| (b, self.own / sum))
    }
}

impl Star {
    /// The facets at a point, each with its D corners in coordinates from the point and the place
    /// of the point among them. None where there is no facet that faces a surface whose facets are
    /// positive; others are left out.
    pub fn new(
        facets: impl IntoIterator<Item = ([Along; 3], usize)>,
        count: usize,
    ) -> Option<Self> {
        let facet = |(corners, point): ([Along; 3], usize)| {
            let size = -signed_size(&corners[..count]);
            (size > 0.0).then(|| StarFacet {
                corners,
                count,
                point,
                size,
                one: 0.0,
                first: [0.0; 2],
                squares: [0.0; 2],
                product: 0.0,
                vertices: Vec::new(),
                own: 0.0,
            })
        };
        let facets: Vec<StarFacet> = facets.into_iter().filter_map(facet).collect();
        let covered = false;
        (!facets.is_empty()).then_some(Self { facets, covered })
    }

    /// Whether a facet of the other surface may face it.
    pub fn is_near(&self, at: &[Along]) -> bool {
        let meets = |own: &[Along]| {
            (0..2).all(|axis| {
                let [from, to] = range(own, axis);
                let [low, high] = range(at, axis);
                low <= to && from <= high
            })
        };
        self.facets.iter().any(|f| meets(f.corners()))
    }

    /// Takes a facet of the other surface, its D vertices and their coordinates; gives whether it
    /// covers more than rounding.
    pub fn face(&mut self, vertices: &[u32], at: &[Along]) -> bool {
        let mut covers = false;
        for facet in &mut self.facets {
            covers |= facet.face(vertices, at) > ROUNDING * facet.size;
        }
        let shares = &shape_functions(at, [0.0; 2])[..at.len()];
        self.covered |= shares.iter().all(|share| *share >= -ROUNDING);
        covers
    }

    /// The vertices of the other surface that the point faces. None where it faces two layers of
    /// it, or is beside it: of one that is `beyond` its border what is covered of its facets
    /// counts, up to about half of one.
    pub fn faced(&self, beyond: bool) -> Option<Faced> {
        let twice = |f: &StarFacet| f.one > (1.0 + ROUNDING) * f.size;
        if !(self.covered || beyond) || self.facets.iter().any(twice) {
            return None;
        }
        let (mut weights, mut shares) = (Vec::new(), Vec::new());
        for facet in &self.facets {
            let terms = facet.vertices.iter();
            shares.extend(terms.clone().map(|term| (term.vertex, term.own)));
            if let Some((b, c)) = facet.dual() {
                let psi = |t: &VertexIntegral| c * (t.alone + b[0] * t.with[0] + b[1] * t.with[1]);
                weights.extend(terms.map(|term| (term.vertex, psi(term))));
            }
        }
        let weights = normalised(weights)?;
        let sizes: f64 = weights.iter().map(|(_, weight)| weight.abs()).sum();
        if !self.covered && sizes > FARTHEST {
            return None;
        }
        // None is negative but by rounding.
        shares
            .iter_mut()
            .for_each(|(_, share)| *share = share.max(0.0));
        let shares = normalised(shares)?;
        Some(Faced { weights, shares })
    }
}

#[cfg(test)]
mod tests;
