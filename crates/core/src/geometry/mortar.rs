//! The mortar method with dual shape functions: the position on a surface that faces a point of
//! another surface, averaged over the facets at the point. Contacts of points with their nearest
//! positions do not transfer a uniform pressure between meshes that do not match; contacts with
//! these averages do. Facets are segments in the plane and triangles in space.
//!
//! Here t are the tangential coordinates relative to the point, psi is the dual function of the
//! point, phi_k is the shape function of vertex k of the other surface, and C is the part of a
//! facet at the point that the other surface covers, seen along the normal:
//!
//! ```text
//! w_k = int_C psi phi_k dt / int_C psi dt        gap = n . (x - sum_k w_k x_k)
//! psi = c (1 + b . t)        int_C psi t dt = 0        int_C psi dt = int_C phi dt
//! ```
//!
//! psi is orthogonal to the shape functions of all other points of its surface, which are the
//! linear functions that vanish at the point, so that the contact acts on its own point only. On a
//! completely covered facet psi is 2 - 3 s on a segment, with s = 1 at its other end, and 3 phi -
//! phi_2 - phi_3 on a triangle, with the shape functions phi_2 and phi_3 of the other corners.
//! Where the other surface covers a facet in part, psi is computed on the covered part. The weights
//! sum to 1 and may be negative; sum w_k t_k is the position of the point.
//!
//! The volume worn at a point is removed from the other surface opposite its facets: vertex k
//! receives the fraction s_k = int_C phi phi_k dt / int_C phi dt, with the shape function phi of
//! the point. The fractions sum to 1, and none is negative. A uniform depth at all points, on their
//! tributary areas, gives a uniform depth at all vertices, since the phi of all points sum to 1.
//!
//! Sources: B. I. Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989; S. Hueeber and B. I. Wohlmuth,
//! Comput. Methods Appl. Mech. Eng. 194 (2005) 3147; M. A. Puso and T. A. Laursen, Comput. Methods
//! Appl. Mech. Eng. 193 (2004) 601 (facets in space); T. Cichosz and M. Bischoff, Comput. Methods
//! Appl. Mech. Eng. 200 (2011) 1317 (facets that are covered in part).

use super::overlap::{TangentialPoint, integrate, shape_functions, signed_size};

/// Negligible fraction of a facet, for its covered part, the part covered twice, and the distance
/// of the point from the other surface.
const ROUNDING: f64 = 1e-6;
/// Weights below this fraction of their sum are rounding errors.
const NONE: f64 = 1e-12;
/// Largest sum of the magnitudes of the weights of a point beyond the border of the other surface.
/// It is 4.5 for one facet of which half is covered, and 1.7 for one covered completely.
const FARTHEST: f64 = 4.5;
/// Smallest determinant of the second moments of a covered part, relative to their product, for
/// which the part is an area rather than a line.
const FLAT: f64 = 1e-12;

/// The facets at a point, and the integrals over their overlap with another surface.
#[derive(Clone, Debug)]
pub struct Star {
    facets: Vec<StarFacet>,
    /// Whether the point itself faces the other surface.
    covered: bool,
}

/// A facet at the point.
#[derive(Clone, Debug, Default)]
struct StarFacet {
    /// D corners.
    corners: [TangentialPoint; 3],
    count: usize,
    /// Index of the point among them.
    point: usize,
    /// Length (m) or area (m^2).
    size: f64,
    /// Size of the covered part, and the integrals over it of the coordinates, of their squares,
    /// and of their product.
    covered: f64,
    first: TangentialPoint,
    squares: TangentialPoint,
    product: f64,
    /// Integrals over the covered part for vertices of the other surface.
    vertices: Vec<VertexIntegral>,
    /// Integral over the covered part of the shape function of the point.
    of_point: f64,
}

/// Integrals over the covered part of a facet with the shape function of a vertex of the other
/// surface.
#[derive(Clone, Copy, Debug, Default)]
struct VertexIntegral {
    vertex: u32,
    /// Integral of the shape function.
    plain: f64,
    /// Integrals of its products with the coordinates.
    moments: TangentialPoint,
    /// Integral of its product with the shape function of the point.
    with_point: f64,
}

/// The vertices of another surface that a point faces, in increasing order; weights and shares each
/// sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct FacedVertices {
    /// Weights of the mean position.
    pub weights: Vec<(u32, f64)>,
    /// Fractions of the worn volume; none is negative.
    pub shares: Vec<(u32, f64)>,
}

/// Sums the numbers of each vertex, drops those of rounding, and scales the others to sum to 1;
/// `None` if their sum is not positive.
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

/// Returns the range of corners along an axis (m).
fn range(corners: &[TangentialPoint], axis: usize) -> [f64; 2] {
    let along = corners.iter().map(|c| c[axis]);
    along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

impl StarFacet {
    fn corners(&self) -> &[TangentialPoint] {
        &self.corners[..self.count]
    }

    /// Adds the integrals over the overlap with a facet of the other surface; returns its size.
    fn add_overlap(&mut self, vertices: &[u32], at: &[TangentialPoint]) -> f64 {
        let own = self.corners;
        let (mut covered, mut parts) = (0.0, [VertexIntegral::default(); 3]);
        integrate(&own[..self.count], at, |t, weight| {
            covered += weight;
            let of_point = weight * shape_functions(&own[..self.count], t)[self.point];
            self.of_point += of_point;
            for (axis, t) in t.iter().enumerate() {
                self.first[axis] += weight * t;
                self.squares[axis] += weight * t * t;
            }
            self.product += weight * t[0] * t[1];
            for (part, phi) in parts.iter_mut().zip(shape_functions(at, t)) {
                part.plain += weight * phi;
                part.moments[0] += weight * phi * t[0];
                part.moments[1] += weight * phi * t[1];
                part.with_point += of_point * phi;
            }
        });
        self.covered += covered;
        if covered > 0.0 {
            let parts = vertices.iter().zip(parts);
            self.vertices
                .extend(parts.map(|(k, part)| VertexIntegral { vertex: *k, ..part }));
        }
        covered
    }

    /// Returns b and c of the dual function; `None` if no length or area is covered.
    fn dual(&self) -> Option<(TangentialPoint, f64)> {
        if self.covered <= ROUNDING * self.size {
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
        let sum = self.covered + b[0] * x + b[1] * y;
        (sum > FLAT * self.covered).then(|| (b, self.of_point / sum))
    }
}

impl Star {
    /// Takes the facets at a point, each with its D corners relative to the point and the index of
    /// the point among them. Facets that do not face a surface of positive facets are left out;
    /// `None` if no facet remains.
    pub fn new(
        facets: impl IntoIterator<Item = ([TangentialPoint; 3], usize)>,
        count: usize,
    ) -> Option<Self> {
        let facet = |(corners, point): ([TangentialPoint; 3], usize)| {
            let size = -signed_size(&corners[..count]);
            (size > 0.0).then(|| StarFacet {
                corners,
                count,
                point,
                size,
                ..StarFacet::default()
            })
        };
        let facets: Vec<StarFacet> = facets.into_iter().filter_map(facet).collect();
        let covered = false;
        (!facets.is_empty()).then_some(Self { facets, covered })
    }

    /// Returns whether a facet of the other surface may overlap those at the point.
    pub fn is_near(&self, at: &[TangentialPoint]) -> bool {
        let meets = |own: &[TangentialPoint]| {
            (0..2).all(|axis| {
                let [from, to] = range(own, axis);
                let [low, high] = range(at, axis);
                low <= to && from <= high
            })
        };
        self.facets.iter().any(|f| meets(f.corners()))
    }

    /// Adds a facet of the other surface, by its D vertices and their coordinates; returns whether
    /// it covers a part of a facet at the point.
    pub fn add_facet(&mut self, vertices: &[u32], at: &[TangentialPoint]) -> bool {
        let mut covers = false;
        for facet in &mut self.facets {
            covers |= facet.add_overlap(vertices, at) > ROUNDING * facet.size;
        }
        let shares = &shape_functions(at, [0.0; 2])[..at.len()];
        self.covered |= shares.iter().all(|share| *share >= -ROUNDING);
        covers
    }

    /// Returns the vertices of the other surface that the point faces; `None` if it faces two
    /// layers of the surface, or is beyond its border.
    pub fn faced(&self) -> Option<FacedVertices> {
        self.faced_in_part().filter(|_| self.covered)
    }

    /// Returns the vertices of the other surface that the point or the facets at it face. Beyond
    /// the border of the surface the covered parts of the facets count, down to about half of one
    /// facet.
    pub fn faced_in_part(&self) -> Option<FacedVertices> {
        let twice = |f: &StarFacet| f.covered > (1.0 + ROUNDING) * f.size;
        if self.facets.iter().any(twice) {
            return None;
        }
        let (mut weights, mut shares) = (Vec::new(), Vec::new());
        for facet in &self.facets {
            let terms = facet.vertices.iter();
            shares.extend(terms.clone().map(|term| (term.vertex, term.with_point)));
            if let Some((b, c)) = facet.dual() {
                let psi =
                    |t: &VertexIntegral| c * (t.plain + b[0] * t.moments[0] + b[1] * t.moments[1]);
                weights.extend(terms.map(|term| (term.vertex, psi(term))));
            }
        }
        let weights = normalised(weights)?;
        let sizes: f64 = weights.iter().map(|(_, weight)| weight.abs()).sum();
        if !self.covered && sizes > FARTHEST {
            return None;
        }
        // Rounding errors may make shares negative.
        shares
            .iter_mut()
            .for_each(|(_, share)| *share = share.max(0.0));
        let shares = normalised(shares)?;
        Some(FacedVertices { weights, shares })
    }
}

#[cfg(test)]
mod tests;
