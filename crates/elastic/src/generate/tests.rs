//! Blocks fill their boxes, and columns of cells join correctly.

use super::*;
use crate::element::Simplex;
use fretwork_core::geometry::space::{Dim2, Dim3};

fn volume<S: Space>(mesh: &Mesh<S>) -> f64 {
    mesh.elements()
        .map(|e| Simplex::<S>::new(&mesh.corners(e)).unwrap().volume)
        .sum()
}

#[test]
fn blocks_fill_their_box() {
    let mesh = block::<Dim2>(&[even(0.0, 3.0, 5), even(-1.0, 1.0, 4)]).unwrap();
    assert!((volume(&mesh) - 6.0).abs() < 1e-12);
    assert_eq!((mesh.elements().len(), mesh.facets()), (80, 18));
    assert_eq!(mesh.points_of("top").unwrap().len(), 6);
    let mesh = block::<Dim3>(&[even(0.0, 3.0, 3), even(-1.0, 1.0, 2), even(0.0, 0.5, 4)]);
    let mesh = mesh.unwrap();
    assert!((volume(&mesh) - 3.0).abs() < 1e-12);
    assert_eq!(mesh.facets(), 2 * 2 * (6 + 12 + 8));
    let area = |name: &str| -> f64 {
        let facets = mesh.part(name).unwrap().iter();
        facets.map(|f| mesh.facet_area(*f as usize)).sum()
    };
    for (name, expected) in [("left", 1.0), ("back", 1.5), ("bottom", 6.0)] {
        assert!((area(name) - expected).abs() < 1e-12, "{name}");
    }
}

#[test]
fn graded_coordinates_end_where_they_should() {
    let x = graded(0.0, -2.0, 0.1, 1.5);
    assert_eq!((x[0], x[x.len() - 1]), (0.0, -2.0));
    assert!((x[1] + 0.1).abs() < 0.02, "{x:?}");
    assert!(x.windows(2).all(|w| w[1] < w[0]));
}
