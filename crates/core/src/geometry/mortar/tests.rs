//! Tests of the weights of mean positions: transfer of pressure, and reproduction of positions.

use super::*;

/// Returns the weights of a point of a chain on another chain; both follow the same line, the first
/// in the opposite direction.
fn on_chain(points: &[f64], k: usize, vertices: &[f64]) -> Option<Vec<(u32, f64)>> {
    star_on_chain(points, k, vertices)?
        .faced()
        .map(|f| f.weights)
}

/// Returns the facets at that point, with the overlapping facets of the other surface.
fn star_on_chain(points: &[f64], k: usize, vertices: &[f64]) -> Option<Star> {
    let at = |j: usize| [points[j] - points[k], 0.0];
    let before = k.checked_sub(1).map(|b| ([at(k), at(b), [0.0; 2]], 0));
    let after = (k + 1 < points.len()).then(|| ([at(k + 1), at(k), [0.0; 2]], 1));
    let mut star = Star::new(before.into_iter().chain(after), 2)?;
    for v in 0..vertices.len() - 1 {
        let at = [v, v + 1].map(|v| [vertices[v] - points[k], 0.0]);
        star.add_facet(&[v as u32, v as u32 + 1], &at);
    }
    Some(star)
}

/// Points of equal worn depth, each acting on its length of the surface, give equal depths at all
/// vertices of meshes of any sizes.
#[test]
fn an_even_depth_stays_even() {
    let coarse = [0.0, 0.8, 1.6];
    let fine = [0.0, 0.1, 0.2, 0.3, 0.5, 0.61, 0.7, 0.9, 1.1, 1.25, 1.5, 1.6];
    for (points, vertices) in [(&coarse[..], &fine[..]), (&fine[..], &coarse[..])] {
        let stands_for = |all: &[f64], k: usize| {
            0.5 * (all[(k + 1).min(all.len() - 1)] - all[k.saturating_sub(1)])
        };
        let mut worn = vec![0.0; vertices.len()];
        for k in 0..points.len() {
            let shares = star_on_chain(points, k, vertices)
                .unwrap()
                .faced()
                .unwrap()
                .shares;
            let sum: f64 = shares.iter().map(|s| s.1).sum();
            assert!((sum - 1.0).abs() < 1e-14 && shares.iter().all(|s| s.1 > 0.0));
            for (v, share) in shares {
                worn[v as usize] += share * stands_for(points, k);
            }
        }
        for (v, worn) in worn.iter().enumerate() {
            assert!((worn / stands_for(vertices, v) - 1.0).abs() < 1e-13, "{v}");
        }
    }
}

/// A point beside a surface faces the part that its facets face, down to half of a facet, and a
/// linear function is reproduced at the point.
#[test]
fn a_point_beyond_the_end_faces_what_its_facets_face() {
    let vertices: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    for (beyond, faces) in [(1e-4, true), (0.1, true), (0.19, true), (0.3, false)] {
        let points = [1.0 + beyond - 0.4, 1.0 + beyond, 1.4 + beyond];
        let star = star_on_chain(&points, 1, &vertices).unwrap();
        assert_eq!(star.faced(), None);
        let found = star.faced_in_part();
        assert_eq!(found.is_some(), faces, "{beyond}");
        let Some(found) = found else { continue };
        let mean: f64 = found
            .weights
            .iter()
            .map(|(v, w)| vertices[*v as usize] * w)
            .sum();
        assert!((mean - points[1]).abs() < 1e-12, "{beyond}: {mean}");
        assert!(found.shares.iter().all(|s| s.1 > 0.0));
    }
}

/// Two layers below a facet are distinguished from one.
#[test]
fn two_layers_have_no_mean_place() {
    let points = [0.0, 0.4, 0.8];
    let mut star = star_on_chain(&points, 1, &[0.0, 0.5, 0.9]).unwrap();
    assert!(star.faced().is_some());
    star.add_facet(&[7, 8], &[[-0.1, 0.0], [0.2, 0.0]]);
    assert_eq!(star.faced(), None);
}

/// A facet that is turned away is left out, at a corner with one side that goes up.
#[test]
fn a_facet_that_is_turned_away_faces_nothing() {
    let own = [
        ([[0.0; 2], [-0.4, 0.0], [0.0; 2]], 0),
        ([[-0.01, 0.0], [0.0; 2], [0.0; 2]], 1),
    ];
    let mut star = Star::new(own, 2).unwrap();
    for v in 0..10u32 {
        let at = [v, v + 1].map(|v| [0.1 * f64::from(v) - 0.5, 0.0]);
        star.add_facet(&[v, v + 1], &at);
    }
    let weights = star.faced().unwrap().weights;
    let mean: f64 = weights
        .iter()
        .map(|(v, w)| w * (0.1 * f64::from(*v) - 0.5))
        .sum();
    assert!(mean.abs() < 1e-14, "{weights:?}");
}

/// Returns triangles over a square whose grid lines have these positions, by their corners, all
/// anticlockwise; diagonals alternate.
fn grid(lines: &[f64]) -> (Vec<TangentialPoint>, Vec<[u32; 3]>) {
    let n = lines.len() as u32;
    let at = lines.iter().flat_map(|y| lines.iter().map(|x| [*x, *y]));
    let mut triangles = Vec::new();
    for j in 0..n - 1 {
        for i in 0..n - 1 {
            let [a, b, c, d] = [
                j * n + i,
                j * n + i + 1,
                (j + 1) * n + i + 1,
                (j + 1) * n + i,
            ];
            let cut = match (i + j) % 2 {
                0 => [[a, b, c], [a, c, d]],
                _ => [[a, b, d], [b, c, d]],
            };
            triangles.extend(cut);
        }
    }
    (at.collect(), triangles)
}

/// Returns the weights of a point of one grid on another, and its tributary area.
fn on_grid(
    (points, own): &(Vec<TangentialPoint>, Vec<[u32; 3]>),
    k: usize,
    (vertices, triangles): &(Vec<TangentialPoint>, Vec<[u32; 3]>),
) -> (Option<Vec<(u32, f64)>>, f64) {
    let from = |p: TangentialPoint| [p[0] - points[k][0], p[1] - points[k][1]];
    let about = own.iter().filter_map(|t| {
        let place = t.iter().position(|p| *p == k as u32)?;
        let mut corners = t.map(|p| from(points[p as usize]));
        // Seen from the other side.
        corners.swap((place + 1) % 3, (place + 2) % 3);
        Some((corners, place))
    });
    let mut star = Star::new(about, 3).unwrap();
    let area = star.facets.iter().map(|f| f.size / 3.0).sum();
    for t in triangles {
        let at = t.map(|v| from(vertices[v as usize]));
        assert!(star.is_near(&at) || !star.add_facet(t, &at));
        star.add_facet(t, &at);
    }
    (star.faced().map(|f| f.weights), area)
}

/// A uniform pressure p on the points, p times the tributary length of each, gives a uniform
/// pressure on the vertices; and the mean position, in linear coordinates, is that of the point.
#[test]
fn a_uniform_pressure_stays_uniform() {
    let points = [0.0, 0.3, 0.5, 0.9, 1.3, 1.6];
    let vertices = [0.0, 0.22, 0.61, 0.7, 1.1, 1.25, 1.6];
    let stands_for =
        |all: &[f64], k: usize| 0.5 * (all[(k + 1).min(all.len() - 1)] - all[k.saturating_sub(1)]);
    let mut carried = [0.0; 7];
    for (k, at) in points.iter().enumerate() {
        let weights = on_chain(&points, k, &vertices).unwrap();
        let sum: f64 = weights.iter().map(|w| w.1).sum();
        let mean: f64 = weights.iter().map(|(v, w)| vertices[*v as usize] * w).sum();
        assert!((sum - 1.0).abs() < 1e-14 && (mean - at).abs() < 1e-14);
        for (v, w) in weights {
            carried[v as usize] += w * stands_for(&points, k);
        }
    }
    for (v, carried) in carried.iter().enumerate() {
        assert!((carried - stands_for(&vertices, v)).abs() < 1e-14, "{v}");
    }
}

/// A uniform pressure between two triangulated planes with any crossing of triangles stays uniform.
#[test]
fn a_uniform_pressure_stays_uniform_in_space() {
    let few = grid(&[0.0, 0.3, 0.5, 0.9, 1.6]);
    let many = grid(&[0.0, 0.22, 0.5, 0.7, 1.1, 1.25, 1.6]);
    for (points, vertices) in [(&few, &many), (&many, &few), (&many, &many)] {
        let mut carried = vec![0.0; vertices.0.len()];
        for (k, at) in points.0.iter().enumerate() {
            let (weights, area) = on_grid(points, k, vertices);
            let weights = weights.unwrap();
            let mean = weights.iter().fold([0.0; 3], |m, (v, w)| {
                let [x, y] = vertices.0[*v as usize];
                [m[0] + w, m[1] + w * x, m[2] + w * y]
            });
            for (found, expected) in mean.iter().zip([1.0, at[0], at[1]]) {
                assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            }
            for (v, w) in weights {
                carried[v as usize] += w * area;
            }
        }
        for (v, carried) in carried.iter().enumerate() {
            let third = |t: &[u32; 3]| signed_size(&t.map(|c| vertices.0[c as usize])) / 3.0;
            let about = vertices.1.iter().filter(|t| t.contains(&(v as u32)));
            let area: f64 = about.map(third).sum();
            assert!((carried - area).abs() < 1e-13, "{v}: {carried} {area}");
        }
    }
}

#[test]
fn points_of_matching_meshes_face_one_vertex() {
    let along: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let mesh = grid(&along);
    for k in 0..=10usize {
        let weights = on_chain(&along, k, &along).unwrap();
        assert_eq!(weights, [(k as u32, 1.0)]);
        let (weights, _) = on_grid(&mesh, 11 * k + 3, &mesh);
        assert_eq!(weights.unwrap(), [(11 * k as u32 + 3, 1.0)]);
    }
}

/// Where the other surface ends below the facets of a point, linear functions are still reproduced
/// at the point, and weights stay small.
#[test]
fn the_end_of_a_surface_below_the_facets_of_a_point() {
    let vertices: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let weights = on_chain(&[0.85, 0.95, 1.35], 1, &vertices).unwrap();
    let mean: f64 = weights.iter().map(|(v, w)| vertices[*v as usize] * w).sum();
    assert!((mean - 0.95).abs() < 1e-14 && weights.iter().all(|w| w.1.abs() < 1.0));
    let lines: Vec<f64> = vertices.iter().map(|x| 1.17 * x).collect();
    let (few, many) = (grid(&lines), grid(&vertices));
    for (k, at) in few.0.iter().enumerate() {
        let (weights, _) = on_grid(&few, k, &many);
        if at[0] > 1.0 || at[1] > 1.0 {
            assert_eq!(weights, None);
            continue;
        }
        let mean = weights.unwrap().iter().fold([0.0; 3], |m, (v, w)| {
            let [x, y] = many.0[*v as usize];
            assert!(w.abs() < 2.0);
            [m[0] + w, m[1] + w * x, m[2] + w * y]
        });
        for (found, expected) in mean.iter().zip([1.0, at[0], at[1]]) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }
}

#[test]
fn points_without_facets_beside_a_surface_or_turned_away_have_no_weights() {
    assert_eq!(on_chain(&[0.5], 0, &[0.0, 1.0]), None);
    assert_eq!(on_chain(&[0.9, 1.1], 1, &[0.0, 1.0]), None);
    assert_eq!(on_chain(&[0.5, 0.3], 0, &[0.0, 1.0]), None);
}
