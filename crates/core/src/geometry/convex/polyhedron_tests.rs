//! Polyhedra against each other and against surfaces, compared with independent computations.

use super::polyhedron::Polyhedron;
use super::{ContactPoint, ContactTolerances, Core, CorePair};
use crate::geometry::mesh::Mesh;
use crate::geometry::shape::{HalfSpace, Surface};
use crate::geometry::space::Dim3;
use nalgebra::{UnitQuaternion, Vector3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::{FRAC_PI_2, PI};

type V = Vector3<f64>;

const EXACT: ContactTolerances = ContactTolerances {
    reach: 1e9,
    slack: 0.0,
    held: false,
};
const FINE: ContactTolerances = ContactTolerances {
    reach: 0.1,
    slack: 1e-6,
    held: false,
};

fn met(
    a: &Polyhedron,
    b: &Polyhedron,
    apart: V,
    roundings: [f64; 2],
    tolerances: &ContactTolerances,
) -> Vec<ContactPoint<V>> {
    let mut out = Vec::new();
    let pair = CorePair {
        cores: [a, b],
        apart,
        roundings,
        tolerances: *tolerances,
    };
    Polyhedron::contact_points(&pair, &mut out);
    out
}

fn direction(rng: &mut Pcg64) -> V {
    loop {
        let v = V::from_fn(|_, _| rng.random_range(-1.0..1.0));
        if v.norm() > 0.1 && v.norm() < 1.0 {
            return v.normalize();
        }
    }
}

/// A cuboid or the hull of points on an ellipsoid, rotated.
fn random(rng: &mut Pcg64) -> Polyhedron {
    let turn = UnitQuaternion::from_scaled_axis(direction(rng) * rng.random_range(0.0..3.0));
    let mut size = || rng.random_range(0.3..1.0);
    let axes = V::new(size(), size(), size());
    let core = if rng.random_range(0.0..1.0) < 0.3 {
        Polyhedron::cuboid(axes.into())
    } else {
        let n = rng.random_range(4..14);
        let points: Vec<V> = (0..n)
            .map(|_| direction(rng).component_mul(&axes))
            .collect();
        match Polyhedron::hull(&points) {
            Ok(hull) => hull,
            Err(_) => return random(rng),
        }
    };
    let centre = core.points().iter().sum::<V>() / core.points().len() as f64;
    let points = core.points().iter().map(|p| p - centre).collect();
    Polyhedron::from_faces(points, core.topology().faces.clone())
        .unwrap()
        .turned(&turn)
}

/// Returns the distance by the GJK algorithm of the library parry.
fn library(a: &Polyhedron, b: &Polyhedron, apart: V) -> f64 {
    let of = |p: &Polyhedron| {
        let points: Vec<Vector> = p
            .points()
            .iter()
            .map(|p| Vector::new(p.x, p.y, p.z))
            .collect();
        ConvexPolyhedron::from_convex_hull(&points).unwrap()
    };
    let at = Pose::from_translation(Vector::new(apart.x, apart.y, apart.z));
    query::distance(&at, &of(a), &Pose::IDENTITY, &of(b))
        .unwrap()
        .distance
}

/// Returns the smallest depth over all face normals and all products of edges (separating axes),
/// negative.
fn depth(a: &Polyhedron, b: &Polyhedron, apart: V) -> f64 {
    let edges = |p: &Polyhedron| -> Vec<V> {
        (0..p.topology().edges.len())
            .map(|e| p.ends(e)[1] - p.ends(e)[0])
            .collect()
    };
    let mut axes: Vec<V> = a.normals().iter().map(|n| -n).collect();
    axes.extend(b.normals());
    for u in edges(a) {
        for v in edges(b) {
            if let Some(n) = u.cross(&v).try_normalize(1e-9) {
                axes.extend([n, -n]);
            }
        }
    }
    let along = |n: &V| {
        let low = a
            .points()
            .iter()
            .map(|p| (p + apart).dot(n))
            .fold(f64::INFINITY, f64::min);
        let high = b
            .points()
            .iter()
            .map(|p| p.dot(n))
            .fold(f64::NEG_INFINITY, f64::max);
        low - high
    };
    axes.iter().map(along).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn gaps_and_normals_are_those_of_the_nearest_points() {
    let mut rng = Pcg64::seed_from_u64(11);
    let (mut faces, mut edges, mut deep) = (0, 0, 0);
    for k in 0..4000 {
        let (a, b) = (random(&mut rng), random(&mut rng));
        let apart = direction(&mut rng) * rng.random_range(0.2..2.5);
        let r = [0.1, 0.05];
        let points = met(&a, &b, apart, r, &EXACT);
        let gap = points.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
        let axis = depth(&a, &b, apart);
        let distance = if axis > 0.0 {
            library(&a, &b, apart)
        } else {
            axis
        };
        assert!(
            (gap + 0.15 - distance).abs() < 1e-7,
            "{k}: {gap} {distance} {axis}"
        );
        for m in &points {
            // The distance of the two contact points is the gap, along the normal.
            let way = m.on_candidate - m.on_antagonist;
            assert!((way - m.normal * m.gap).norm() < 1e-12, "{k}: {m:?}");
            assert!((m.normal.norm() - 1.0).abs() < 1e-12);
        }
        if axis <= 0.0 {
            deep += 1;
        } else if points.len() == 1 && points[0].share == 0.0 {
            edges += 1;
        } else {
            faces += 1;
        }
    }
    assert!(
        faces > 400 && edges > 400 && deep > 400,
        "{faces} {edges} {deep}"
    );
}

#[test]
fn a_pair_is_the_same_seen_from_the_other_side() {
    let mut rng = Pcg64::seed_from_u64(12);
    for k in 0..2000 {
        let (a, b) = (random(&mut rng), random(&mut rng));
        let apart = direction(&mut rng) * rng.random_range(0.5..1.5);
        let one = met(&a, &b, apart, [0.0; 2], &EXACT);
        let two = met(&b, &a, -apart, [0.0; 2], &EXACT);
        assert_eq!(one.len(), two.len(), "{k}");
        for m in &one {
            let other = two
                .iter()
                .find(|o| (o.on_antagonist + apart - m.on_candidate).norm() < 1e-9);
            let other = other.unwrap_or_else(|| panic!("{k}: {one:?} {two:?}"));
            assert!((other.normal + m.normal).norm() < 1e-9 && (other.gap - m.gap).abs() < 1e-12);
        }
    }
}

#[test]
fn stacked_boxes_touch_at_four_points_with_a_quarter_of_the_face_each() {
    let (top, low) = (
        Polyhedron::cuboid([2.0, 2.0, 2.0]),
        Polyhedron::cuboid([6.0, 6.0, 2.0]),
    );
    let points = met(&top, &low, V::new(0.5, 0.3, 2.25), [0.1, 0.1], &FINE);
    assert_eq!(points.len(), 4);
    for p in &points {
        assert!((p.normal - V::z()).norm() < 1e-15 && (p.gap - 0.05).abs() < 1e-14);
        assert!((PI * p.share * p.share - 1.0).abs() < 1e-13);
    }
    // The bodies have equal width: no corner is outside the other face by more than the slack, and
    // names do not depend on the noise.
    let names = |points: &[ContactPoint<V>]| points.iter().map(|m| m.feature).collect::<Vec<_>>();
    let known = names(&met(&top, &top, V::new(0.0, 0.0, 2.0), [0.0; 2], &FINE));
    for shift in [0.0, 1e-12, -1e-9, 5e-7] {
        for gap in [-1e-9, 0.0, 1e-13, 1e-9, 0.05] {
            let points = met(
                &top,
                &top,
                V::new(shift, -shift, 2.0 + gap),
                [0.0; 2],
                &FINE,
            );
            assert_eq!(names(&points), known, "{shift:e} {gap:e} {points:?}");
            assert!(points.iter().all(|m| (m.normal - V::z()).norm() < 1e-15));
            assert!(points.iter().all(|m| (m.gap - gap).abs() < 1e-15));
        }
    }
    // Rotated by 45 degrees the overlap is an octagon: the area of the smaller square without four
    // corners.
    let turned = top.turned(&UnitQuaternion::from_scaled_axis(
        V::z() * (0.5 * FRAC_PI_2),
    ));
    let points = met(&turned, &top, V::new(0.0, 0.0, 2.01), [0.0; 2], &FINE);
    assert_eq!(points.len(), 8);
    let area: f64 = points.iter().map(|p| PI * p.share * p.share).sum();
    assert!((area - 8.0 * (2f64.sqrt() - 1.0)).abs() < 1e-12, "{area}");
    // Next to each other's corners: one point, along the line between the corners.
    let points = met(&top, &top, V::new(2.02, 2.03, 2.06), [0.0; 2], &FINE);
    assert_eq!(points.len(), 1);
    assert!((points[0].gap - 0.07).abs() < 1e-14);
    assert!((points[0].normal - V::new(2.0, 3.0, 6.0) / 7.0).norm() < 1e-12);
}

#[test]
fn edges_that_cross_touch_at_one_point() {
    let quarter = UnitQuaternion::from_scaled_axis(V::x() * (0.5 * FRAC_PI_2));
    let roof = Polyhedron::cuboid([4.0, 1.0, 1.0]).turned(&quarter);
    let other = UnitQuaternion::from_scaled_axis(V::y() * (0.5 * FRAC_PI_2));
    let ridge = Polyhedron::cuboid([1.0, 4.0, 1.0]).turned(&other);
    for gap in [0.04, 1e-9, -0.03] {
        let apart = V::new(0.3, -0.2, 2f64.sqrt() + gap);
        let points = met(&ridge, &roof, apart, [0.0; 2], &FINE);
        assert_eq!(points.len(), 1, "{gap}");
        assert!((points[0].gap - gap).abs() < 1e-14, "{gap} {points:?}");
        assert!(
            (points[0].normal - V::z()).norm() < 1e-12,
            "{gap} {points:?}"
        );
        assert!((points[0].on_antagonist - V::new(0.3, 0.0, 0.5 * 2f64.sqrt())).norm() < 1e-12);
    }
}

#[test]
fn capsules_side_by_side_crossed_and_on_a_box() {
    let lying = Polyhedron::segment(V::new(-1.0, 0.0, 0.0), V::new(1.0, 0.0, 0.0));
    let points = met(&lying, &lying, V::new(0.5, 0.15, 0.2), [0.1, 0.1], &FINE);
    assert_eq!(points.len(), 2);
    assert!(points.iter().all(|m| (m.gap - 0.05).abs() < 1e-15));
    assert!(
        points
            .iter()
            .all(|m| (m.normal - V::new(0.0, 0.6, 0.8)).norm() < 1e-14)
    );
    let across = lying.turned(&UnitQuaternion::from_scaled_axis(V::z() * FRAC_PI_2));
    let points = met(&across, &lying, V::new(0.2, 0.4, 0.25), [0.1, 0.1], &FINE);
    assert!(points.len() == 1 && (points[0].gap - 0.05).abs() < 1e-15);
    assert!((points[0].normal - V::z()).norm() < 1e-14);
    // The edges are in one plane, end to end and far from the intersection of their lines.
    let points = met(&across, &lying, V::new(1.1, 1.12, 0.0), [0.1, 0.05], &FINE);
    assert_eq!(points.len(), 1);
    assert!((points[0].gap + 0.15 - 0.1f64.hypot(0.12)).abs() < 1e-14);
    let block = Polyhedron::cuboid([3.0, 1.0, 1.0]);
    let points = met(&lying, &block, V::new(0.2, 0.1, 0.65), [0.1, 0.0], &FINE);
    assert_eq!(points.len(), 2);
    assert!(
        points
            .iter()
            .all(|m| (m.gap - 0.05).abs() < 1e-14 && m.normal == V::z())
    );
    // The capsule stands on the block: its lower end touches.
    let standing = lying.turned(&UnitQuaternion::from_scaled_axis(V::y() * FRAC_PI_2));
    let points = met(&standing, &block, V::new(0.2, 0.1, 1.62), [0.1, 0.0], &FINE);
    assert!(
        points.len() == 1 && (points[0].gap - 0.02).abs() < 1e-14,
        "{points:?}"
    );
    // The capsule passes through the block.
    let points = met(&standing, &block, V::new(0.2, 0.49, 0.0), [0.1, 0.0], &FINE);
    let least = points.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
    assert!((least + 0.11).abs() < 1e-14, "{points:?}");
}

/// A flat floor of triangles of unequal size, bent up by `slope` to the right of x = 0.
fn floor(slope: f64) -> Mesh {
    let n = 9u32;
    let x = |i: u32| f64::from(i) * 0.7 - 2.8 + if i % 2 == 1 { 0.2 } else { 0.0 };
    let mut points = Vec::new();
    for j in 0..n {
        for i in 0..n {
            // The middle column is the bend.
            let along = if i == 4 { 0.0 } else { x(i) };
            points.push(V::new(along, x(j), slope * along.max(0.0)));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..n - 1 {
        for i in 0..n - 1 {
            let k = j * n + i;
            triangles.extend([[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]);
        }
    }
    Mesh::new(points, triangles).unwrap()
}

fn on(
    core: &Polyhedron,
    surface: &dyn Surface<Dim3>,
    at: V,
    rounding: f64,
) -> Vec<ContactPoint<V>> {
    let mut out = Vec::new();
    core.contact_points_with_surface(surface, &at, rounding, &FINE, &mut out);
    out
}

#[test]
fn a_box_lies_on_four_corners_of_a_floor() {
    let floor = HalfSpace::<Dim3> {
        normal: V::z(),
        shown: 1.0,
    };
    let block = Polyhedron::cuboid([1.0, 2.0, 1.0]);
    let points = on(&block, &floor, V::new(7.0, 1.0, 0.63), 0.1);
    assert_eq!(points.len(), 4);
    assert!(
        points
            .iter()
            .all(|m| (m.gap - 0.03).abs() < 1e-15 && m.on_candidate.z - 0.03 < 1e-15)
    );
    assert!(
        points
            .iter()
            .all(|m| (PI * m.share * m.share - 0.5).abs() < 1e-14)
    );
}

#[test]
fn a_box_slides_over_the_seams_of_a_flat_mesh() {
    let floor = floor(0.0);
    let mut rng = Pcg64::seed_from_u64(13);
    let block = Polyhedron::cuboid([1.0, 1.3, 0.4]);
    for k in 0..300 {
        let turned = block.turned(&UnitQuaternion::from_scaled_axis(
            V::z() * rng.random_range(0.0..6.0),
        ));
        let noise = UnitQuaternion::from_scaled_axis(direction(&mut rng) * 1e-9);
        let mut place = || rng.random_range(-1.5..1.5);
        let at = V::new(place(), place(), 0.21);
        for core in [&turned, &turned.turned(&noise)] {
            let points = on(core, &floor, at, 0.0);
            assert_eq!(points.len(), 4, "{k} {at:?} {points:?}");
            assert!(
                points
                    .iter()
                    .all(|m| (m.normal - V::z()).norm() < 1e-8 && (m.gap - 0.01).abs() < 1e-8)
            );
        }
    }
    // Corner first, tilted: one point with a vertical normal.
    let tilted = block.turned(&UnitQuaternion::from_scaled_axis(V::new(0.5, 0.4, 0.0)));
    let lowest = tilted.points().iter().map(|p| p.z).fold(0.0, f64::min);
    for k in 0..100 {
        let points = on(
            &tilted,
            &floor,
            V::new(0.017 * f64::from(k) - 0.8, 0.3, 0.02 - lowest),
            0.0,
        );
        assert_eq!(points.len(), 1, "{k} {points:?}");
        assert!((points[0].normal - V::z()).norm() < 1e-12 && (points[0].gap - 0.02).abs() < 1e-12);
    }
}

#[test]
fn a_box_over_a_ridge_touches_along_it() {
    // Flat, then down by 45 degrees: half over the ridge, it touches with two corners and where its
    // long edges cross the ridge.
    let ridge = floor(-1.0);
    let block = Polyhedron::cuboid([1.0, 1.3, 0.4]);
    let points = on(&block, &ridge, V::new(0.1, 0.1, 0.21), 0.0);
    assert!(
        points
            .iter()
            .all(|m| (m.normal - V::z()).norm() < 1e-12 && (m.gap - 0.01).abs() < 1e-12)
    );
    let corners = points
        .iter()
        .filter(|m| (m.on_antagonist.x + 0.4).abs() < 1e-12)
        .count();
    let over = points
        .iter()
        .filter(|m| m.on_antagonist.x.abs() < 1e-9)
        .count();
    assert!(
        corners == 2 && over >= 2 && corners + over == points.len(),
        "{points:?}"
    );
}

#[test]
fn a_ball_shaped_corner_in_a_valley_touches_both_sides() {
    let valley = floor(1.0);
    let block = Polyhedron::cuboid([1.0, 1.0, 1.0]);
    // The lower right edge of the block is near both sides of the bend: 0.05 above the floor, and
    // equally far from the slope.
    let right = 0.5 + 0.05 * (2f64.sqrt() - 1.0);
    let points = on(&block, &valley, V::new(-right, 0.2, 0.55), 0.0);
    let flat = points
        .iter()
        .filter(|m| (m.normal - V::z()).norm() < 1e-12)
        .count();
    let slope = V::new(-1.0, 0.0, 1.0).normalize();
    let steep: Vec<_> = points
        .iter()
        .filter(|m| (m.normal - slope).norm() < 1e-12)
        .collect();
    assert!(
        flat == 4 && steep.len() == 2 && points.len() == 6,
        "{points:?}"
    );
    assert!(steep.iter().all(|m| (m.gap - 0.05).abs() < 1e-12));
}

/// A valley along y of this slope on both sides, of unequal triangles.
fn crease(slope: f64) -> Mesh {
    let mut points = Vec::new();
    for (k, y) in [-3.0, -1.1, 0.2, 1.4, 3.0].into_iter().enumerate() {
        let shift = if k % 2 == 1 { 0.3 } else { 0.0 };
        for x in [-3.0, -1.5 + shift, 0.0, 1.2 - shift, 3.0] {
            points.push(V::new(x, y, slope * f64::abs(x)));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..4 {
        for i in 0..4 {
            let k = 5 * j + i;
            triangles.extend([[k, k + 1, k + 6], [k, k + 6, k + 5]]);
        }
    }
    Mesh::new(points, triangles).unwrap()
}

#[test]
fn an_apex_in_a_crease_is_held_from_both_sides() {
    let points = [
        V::new(0.0, 0.0, 0.0),
        V::new(0.2, 0.0, 1.0),
        V::new(-0.2, 0.1, 1.0),
        V::new(0.0, -0.2, 1.1),
    ];
    let gem = Polyhedron::hull(&points).unwrap();
    for slope in [0.1, 1.0, 3.0] {
        let valley = crease(slope);
        for x in [0.0, 1e-9, 1e-6, -1e-3, 0.01] {
            for y in [0.0, 0.2, 0.7, 1.4] {
                for depth in [0.02, 0.0, -1e-6, -1e-3, -0.05] {
                    let at = V::new(x, y, depth + slope * f64::abs(x));
                    let points = on(&gem, &valley, at, 0.0);
                    // Every slope within range pushes, and no contact is from behind.
                    let of = |sign: f64| points.iter().any(|m| m.normal.x * sign > 0.05);
                    let near = if x >= 0.0 { of(-1.0) } else { of(1.0) };
                    assert!(near, "{slope} {x} {y} {depth} {points:?}");
                    if x == 0.0 {
                        assert!(of(1.0) && of(-1.0), "{slope} {x} {y} {depth} {points:?}");
                    }
                    assert!(points.iter().all(|m| m.normal.z > 0.0), "{points:?}");
                }
            }
        }
    }
}

#[test]
fn a_corner_deep_below_a_seam_comes_out() {
    // Deeper than the slack, on the seams of a flat floor and beside them.
    let floor = floor(0.0);
    let block = Polyhedron::cuboid([1.0, 1.3, 0.4]);
    let tilted = block.turned(&UnitQuaternion::from_scaled_axis(V::new(0.5, 0.4, 0.1)));
    let low = tilted.lowest(&V::z());
    let apex = tilted.points()[low];
    for seam in [0.0, 0.7, -0.7] {
        for beside in [0.0, 1e-12, 1e-7, 1e-4, 0.01] {
            for depth in [1e-5, 1e-3, 0.05] {
                let at = V::new(seam + beside, 0.1, -depth) - apex;
                let points = on(&tilted, &floor, at, 0.0);
                let least = points.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
                assert!(
                    (least + depth).abs() < 1e-12,
                    "{seam} {beside} {depth} {points:?}"
                );
                assert!(points.iter().all(|m| (m.normal - V::z()).norm() < 1e-12));
            }
        }
    }
}
