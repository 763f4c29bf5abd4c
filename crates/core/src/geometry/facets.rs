//! Triangles of a surface in 3D, and contact points of a ball on them without ghost contacts at
//! their seams.

use super::shape::{ClosestPoint, Fan};
use nalgebra::Vector3;
use std::collections::HashMap;

type V = Vector3<f64>;

/// A triangle of a surface; its corners are anticlockwise seen from the open side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<V> {
    /// Corners (m).
    pub corners: [V; 3],
    /// Names of the corners, equal in all facets that share them.
    pub names: [u64; 3],
    /// Name of the facet.
    pub name: u32,
}

/// A part of a facet (corner, edge or face): which of its corners belong to it.
type FacetPart = [bool; 3];

impl Facet<V> {
    /// Returns the unit normal, towards the open side.
    pub fn normal(&self) -> V {
        let [a, b, c] = self.corners;
        (b - a).cross(&(c - a)).normalize()
    }

    /// Returns the angle at a corner (rad).
    pub fn angle(&self, k: usize) -> f64 {
        let (u, v) = (
            self.corners[(k + 1) % 3] - self.corners[k],
            self.corners[(k + 2) % 3] - self.corners[k],
        );
        u.cross(&v).norm().atan2(u.dot(&v))
    }

    /// Returns the names of a part, sorted, with unused entries last.
    pub fn part(&self, part: FacetPart) -> [u64; 3] {
        let mut names = [u64::MAX; 3];
        for k in 0..3 {
            if part[k] {
                names[k] = self.names[k];
            }
        }
        names.sort_unstable();
        names
    }

    /// Returns whether all corners of a part belong to the facet.
    pub fn has(&self, part: &[u64; 3]) -> bool {
        part.iter()
            .all(|n| *n == u64::MAX || self.names.contains(n))
    }
}

/// A part of the surface that is nearest to the centre on at least one facet.
struct NearestPart {
    part: [u64; 3],
    /// Number of its corners.
    corners: usize,
    /// Number of facets that found it.
    count: usize,
    closest_point: V,
    /// The first such facet.
    first: usize,
}

/// Finds all points where the surface is locally nearest to a ball centred at `centre` within
/// `reach` (m), in the order of their features. `facets` are all that intersect the box of that
/// size about it.
pub fn closest_points(facets: &[Facet<V>], centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
    closest_points_within(facets, centre, reach, 0.0, out);
}

/// Finds the points where the surface is locally nearest to a ball, as [`closest_points`] does. A
/// point that is nearer to a corner than the share `at_corner` of an edge is moved to the corner.
pub fn closest_points_within(
    facets: &[Facet<V>],
    centre: &V,
    reach: f64,
    at_corner: f64,
    out: &mut Vec<ClosestPoint<V>>,
) {
    let start = out.len();
    let mut found: Vec<NearestPart> = Vec::new();
    for (k, facet) in facets.iter().enumerate() {
        let [a, b, c] = facet.corners;
        let (closest_point, mut used) = nearest(*centre, a, b, c);
        // If the centre is in line with a corner, rounding decides whether a facet finds the corner
        // or an edge at it; all facets around the corner must agree.
        for (k, corner) in facet.corners.iter().enumerate() {
            let edge = (facet.corners[(k + 1) % 3] - corner).norm();
            if at_corner > 0.0 && (closest_point - corner).norm() <= at_corner * edge {
                used = std::array::from_fn(|i| i == k);
            }
        }
        if (closest_point - centre).norm() >= reach {
            continue;
        }
        let part = facet.part(used);
        match found.iter_mut().find(|f| f.part == part) {
            Some(f) => f.count += 1,
            None => found.push(NearestPart {
                part,
                corners: used.iter().filter(|u| **u).count(),
                count: 1,
                closest_point,
                first: k,
            }),
        }
    }
    let around = |part: [u64; 3]| facets.iter().filter(move |g| g.has(&part));
    // An edge or a corner counts if all facets around it find it; otherwise a face is nearer.
    found.retain(|f| f.count >= around(f.part).count());
    let up = |f: &NearestPart| pseudo_normal(around(f.part), &f.part, f.corners);
    let arm = |f: &NearestPart| centre - f.closest_point;
    let nearest = |f: &&NearestPart, g: &&NearestPart| {
        arm(f).norm_squared().total_cmp(&arm(g).norm_squared())
    };
    // A vector of the size of rounding errors has no direction.
    let tiny = 1e-13 * (centre.norm() + reach);
    // The nearest part determines whether the centre is inside or outside: parts behind it face
    // away.
    let inside = found
        .iter()
        .min_by(nearest)
        .is_some_and(|f| arm(f).dot(&up(f)) < 0.0);
    for f in &found {
        let (up, arm) = (up(f), arm(f));
        let length = arm.norm();
        if (arm.dot(&up) < 0.0) != inside && length > tiny {
            continue;
        }
        // A tangential part of the size of rounding errors is ignored too: a point that touches a
        // seam within a plane would be pushed along the plane.
        let aligned = (arm - up * arm.dot(&up)).norm() <= tiny;
        let face = f.corners == 3 || aligned;
        let rises = |g: &Facet<V>| {
            let over =
                |c: &V| (c - f.closest_point).dot(&up) > BEHIND * (c - f.closest_point).norm();
            g.corners.iter().any(over)
        };
        if (inside || length <= tiny) && around(f.part).any(rises) {
            // The centre is at or below the bottom of a crease, behind the planes of all its sides.
            out.extend(around(f.part).map(|g| {
                let (normal, distance) = (g.normal(), arm.dot(&g.normal()));
                ClosestPoint {
                    closest_point: centre - normal * distance,
                    normal,
                    distance,
                    feature: g.name * 8,
                }
            }));
            continue;
        }
        out.push(ClosestPoint {
            closest_point: f.closest_point,
            normal: if face || inside || length <= tiny {
                up
            } else {
                arm / length
            },
            distance: if inside { -length } else { length },
            feature: feature(facets, f.first, &f.part, f.corners),
        });
    }
    out[start..].sort_by_key(|t| t.feature);
}

/// Calls a function with each corner of the facets, the mean normal there and its feature.
pub fn vertices(facets: &[Facet<V>], mut call: impl FnMut(V, V, u32)) {
    let mut places: Vec<(u64, V, usize)> = Vec::new();
    for (k, facet) in facets.iter().enumerate() {
        let named = facet.names.into_iter().zip(facet.corners);
        places.extend(named.map(|(name, at)| (name, at, k)));
    }
    places.sort_by_key(|(name, _, k)| (*name, *k));
    places.dedup_by_key(|(name, _, _)| *name);
    for (name, at, first) in places {
        let part = [name, u64::MAX, u64::MAX];
        let about = facets.iter().filter(|f| f.has(&part));
        let outward = pseudo_normal(about, &part, 1);
        call(at, outward, feature(facets, first, &part, 1));
    }
}

/// Adds the facets `within` a distance (m) of a place, with vectors from it to their corners.
pub fn fan(facets: &[Facet<V>], at: &V, within: f64, out: &mut Fan<V>) {
    for facet in facets {
        let [a, b, c] = facet.corners;
        if (nearest(*at, a, b, c).0 - at).norm() <= within {
            out.normals.push(facet.normal());
            out.spokes.extend(facet.corners.iter().map(|x| x - at));
        }
    }
}

/// Returns the mean normal at a part, weighted by the angles of the facets, which determines inside
/// or outside. Baerentzen and Aanaes, "Signed distance computation using the angle weighted
/// pseudonormal", IEEE TVCG 11 (2005).
fn pseudo_normal<'a>(
    about: impl Iterator<Item = &'a Facet<V>>,
    part: &[u64; 3],
    corners: usize,
) -> V {
    let weight = |f: &Facet<V>| {
        let at = f.names.iter().position(|n| *n == part[0]);
        match at.filter(|_| corners == 1) {
            Some(k) => f.angle(k),
            None => 1.0,
        }
    };
    let sum: V = about.map(|f| f.normal() * weight(f)).sum();
    sum.try_normalize(0.0).unwrap_or_else(V::z)
}

/// Returns the name of a part, from the lowest name of the facets around it.
fn feature(facets: &[Facet<V>], first: usize, part: &[u64; 3], corners: usize) -> u32 {
    let owner = facets
        .iter()
        .filter(|g| g.has(part))
        .min_by_key(|g| g.name)
        .unwrap_or(&facets[first]);
    let place = |name: u64| owner.names.iter().position(|n| *n == name).unwrap_or(0) as u32;
    owner.name * 8
        + match corners {
            // An edge is numbered by the corner opposite to it.
            2 => 1 + (3 - place(part[0]) - place(part[1])),
            1 => 4 + place(part[0]),
            _ => 0,
        }
}

/// A convex edge of a surface: a sharp one, or one with a facet on one side only; of a surface that
/// deforms any edge.
#[derive(Clone, Copy, Debug)]
pub struct Ridge {
    /// Ends (m), in the direction of the side of its first facet.
    pub ends: [V; 2],
    /// Names of the ends.
    pub names: [u64; 2],
    /// The first facet.
    pub facet: u32,
    /// Index of the edge in that facet.
    pub side: u8,
    /// Normals of the facets on both sides; at an open border the second is the reverse of the
    /// first.
    normals: [V; 2],
}

/// Tolerance, relative to the distance, for a facet in front of a normal to count as behind it.
const BEHIND: f64 = 1e-6;

impl Ridge {
    /// Returns whether a direction perpendicular to the edge is between the normals of its facets.
    pub fn holds(&self, direction: &V) -> bool {
        let along = self.ends[1] - self.ends[0];
        let [m, n] = &self.normals;
        m.cross(direction).dot(&along) >= 0.0 && direction.cross(n).dot(&along) >= 0.0
    }

    /// Returns the sum of the normals of its facets; zero at an open border.
    pub fn outward(&self) -> V {
        self.normals[0] + self.normals[1]
    }
}

/// Returns all convex edges, or with `all` those of creases and planes too.
pub fn ridges(facets: &[Facet<V>], all: bool) -> Vec<Ridge> {
    let mut out = Vec::new();
    let mut about: HashMap<[u64; 2], Vec<usize>> = HashMap::new();
    let pair = |a: u64, b: u64| [a.min(b), a.max(b)];
    for (f, facet) in facets.iter().enumerate() {
        for k in 0..3 {
            let edge = pair(facet.names[k], facet.names[(k + 1) % 3]);
            about.entry(edge).or_default().push(f);
        }
    }
    for (f, facet) in facets.iter().enumerate() {
        let normal = facet.normal();
        for k in 0..3 {
            let (a, b) = (k, (k + 1) % 3);
            let names = [facet.names[a], facet.names[b]];
            let beside = about[&pair(names[0], names[1])].iter().find(|g| **g != f);
            let other = match beside {
                Some(g) if *g < f => continue,
                Some(g) => {
                    let n = facets[*g].normal();
                    let along = facet.corners[b] - facet.corners[a];
                    if !all && normal.cross(&n).dot(&along) <= BEHIND * along.norm() {
                        continue;
                    }
                    n
                }
                None => -normal,
            };
            out.push(Ridge {
                ends: [facet.corners[a], facet.corners[b]],
                names,
                facet: facet.name,
                side: k as u8,
                normals: [normal, other],
            });
        }
    }
    out
}

/// Returns whether all facets around a corner lie behind a normal there.
pub fn behind(facets: &[Facet<V>], name: u64, place: &V, normal: &V) -> bool {
    let height = |c: &V| (c - place).dot(normal);
    let about = facets.iter().filter(|f| f.names.contains(&name));
    about
        .flat_map(|f| &f.corners)
        .all(|c| height(c) <= BEHIND * (c - place).norm())
}

/// Returns the nearest point of a triangle and the corners involved (one: a corner, two: an edge,
/// three: the face). Ericson, Real-Time Collision Detection (2005), section 5.1.5.
pub fn nearest(p: V, a: V, b: V, c: V) -> (V, [bool; 3]) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, [true, false, false]);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, [false, true, false]);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), [true, true, false]);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, [false, false, true]);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), [true, false, true]);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (
            b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))),
            [false, true, true],
        );
    }
    let denominator = 1.0 / (va + vb + vc);
    (
        a + ab * (vb * denominator) + ac * (vc * denominator),
        [true; 3],
    )
}
