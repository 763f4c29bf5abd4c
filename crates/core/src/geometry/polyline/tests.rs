//! Tests of profiles.

use super::*;

fn closest_points(profile: &Polyline, x: f64, y: f64, reach: f64) -> Vec<ClosestPoint<V>> {
    let mut out = Vec::new();
    profile.closest_points(&V::new(x, y), reach, &mut out);
    out
}

fn chain(points: &[[f64; 2]], period: Option<f64>) -> Polyline {
    Polyline::new(points.iter().map(|p| V::from(*p)).collect(), period).unwrap()
}

/// Points that lie on vertices of a flat chain to rounding, above it and in it, have one contact
/// each with the normal of the chain.
#[test]
fn points_at_vertices_of_a_flat_chain_touch_its_faces() {
    let size = 0.1;
    for slope in [0.0, 0.3] {
        let at = |x: f64| V::new(x, slope * x);
        let points = (0..=20).map(|k| at(f64::from(k) * size)).collect();
        let line = Polyline::new(points, None).unwrap();
        let outward = V::new(-slope, 1.0).normalize();
        for k in 1..20 {
            for off in [0.0, 1e-17, -1e-17, 3e-17, -3e-17] {
                for gap in [0.0, 1e-17, -1e-17, 1e-12, -1e-12, 1e-3, -1e-3] {
                    let centre = at(f64::from(k) * size + off) + outward * gap;
                    let mut out = Vec::new();
                    line.closest_points(&centre, 0.01, &mut out);
                    assert!(!out.is_empty(), "{slope} {k} {off:e} {gap:e}");
                    for touch in out {
                        assert!((touch.normal - outward).norm() < 1e-12, "{touch:?}");
                        assert!((touch.distance - gap).abs() < 1e-15, "{touch:?}");
                    }
                }
            }
        }
    }
}

/// A deformable surface ends where its loads end, not where its solid ends: a point that strain
/// moves beyond its end by less than half a segment is above the line of the last segment, or
/// behind it. The corner of a profile has a side.
#[test]
fn a_surface_goes_on_beyond_its_ends() {
    let flat = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    let profile = chain(&flat, None);
    let mut surface = chain(&flat, None);
    surface.move_vertices(&flat.map(V::from));
    for beyond in [1e-6, 1e-3, 0.3] {
        for height in [0.2, 1e-4, 0.0, -1e-4, -0.1] {
            for x in [-beyond, 2.0 + beyond] {
                let found = closest_points(&surface, x, height, 0.5);
                let [touch] = &found[..] else {
                    panic!("{x} {height}: {found:?}")
                };
                assert_eq!((touch.normal, touch.distance), (V::y(), height));
            }
            let corner = closest_points(&profile, 2.0 + beyond, height, 0.5);
            let way = V::new(beyond, height);
            assert!((corner[0].normal - way.normalize()).norm() < 1e-6);
        }
        // A lower point is beside the end of the surface.
        for x in [-beyond, 2.0 + beyond] {
            for touch in closest_points(&surface, x, -0.3, 0.5) {
                assert!(touch.normal.y < 0.0 && touch.distance > 0.0, "{touch:?}");
            }
        }
    }
}

#[test]
fn a_flat_seam_gives_one_contact() {
    let flat = chain(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], None);
    for x in [0.2, 0.999, 1.0, 1.001, 1.7] {
        let t = closest_points(&flat, x, 0.3, 0.5);
        assert!(!t.is_empty() && t.len() <= 2, "{x}: {t:?}");
        assert!(t.iter().all(|t| t.normal == V::new(0.0, 1.0)));
    }
    assert_eq!(closest_points(&flat, 0.7, 0.3, 0.5).len(), 1);
}

#[test]
fn below_a_valley_is_behind_it() {
    let valley = chain(&[[-2.0, 1.0], [0.0, 0.0], [2.0, 1.0]], None);
    let again = chain(&[[0.0, 0.0], [2.0, 1.0], [4.0, 0.0]], Some(4.0));
    for (x, depth) in [(0.0, 1e-9), (0.0, 0.3), (0.05, 0.3), (-0.1, 0.3)] {
        for t in [
            closest_points(&valley, x, -depth, 0.5),
            closest_points(&again, x, -depth, 0.5),
        ] {
            assert_eq!(t.len(), 1, "{x}, {depth}: {t:?}");
            assert_eq!(t[0].distance, -x.hypot(depth));
            assert!(t[0].normal.y > 0.9);
        }
    }
}

#[test]
fn a_summit_is_touched_once_and_a_valley_twice() {
    let roof = chain(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]], None);
    let t = closest_points(&roof, 1.0, 1.4, 0.5);
    assert_eq!(t.len(), 1);
    assert!((t[0].distance - 0.4).abs() < 1e-15 && t[0].feature % 2 == 1);
    let valley = chain(&[[0.0, 1.0], [1.0, 0.0], [2.0, 1.0]], None);
    assert_eq!(closest_points(&valley, 1.0, 0.5, 0.6).len(), 2);
}

#[test]
fn the_inside_is_negative() {
    let flat = chain(&[[0.0, 0.0], [2.0, 0.0]], None);
    assert!((closest_points(&flat, 1.0, -0.1, 0.5)[0].distance + 0.1).abs() < 1e-15);
}

#[test]
fn periodic_images_have_one_name() {
    let saw = chain(&[[0.0, 0.0], [0.5, 0.2], [1.0, 0.0]], Some(1.0));
    for x in [0.1, 0.49, 0.5, 0.97, 0.0] {
        let (near, far) = (
            closest_points(&saw, x, 0.35, 0.4),
            closest_points(&saw, x + 7.0, 0.35, 0.4),
        );
        assert_eq!(near.len(), far.len());
        for (a, b) in near.iter().zip(&far) {
            assert_eq!(a.feature, b.feature);
            assert!((a.closest_point - b.closest_point + V::new(7.0, 0.0)).norm() < 1e-12);
        }
    }
    assert!(!closest_points(&saw, 1e-9, 0.1, 0.2).is_empty());
}

#[test]
fn bad_profiles_are_refused() {
    let v = V::new;
    assert_eq!(
        Polyline::new(vec![v(0.0, 0.0)], None).unwrap_err(),
        ProfileError::TooFew(1)
    );
    assert!(Polyline::new(vec![v(0.0, 0.0), v(0.0, 0.0)], None).is_err());
    assert!(Polyline::new(vec![v(0.0, 0.0), v(1.0, 0.1)], Some(1.0)).is_err());
    assert!(Polyline::new(vec![v(0.0, f64::NAN), v(1.0, 0.1)], None).is_err());
}
