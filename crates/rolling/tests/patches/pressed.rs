//! Ellipsoids pressed on each other, as tests of their patches begin.

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{PointPatch, Solid, effective_modulus, line, point};
use fretwork_rolling::{Pressure, Surfaces, normal};

/// Returns a steel of this modulus (Pa) and ratio.
pub fn steel(young: f64, poisson: f64) -> Elasticity {
    Elasticity {
        young,
        poisson,
        density: 7800.0,
    }
}

/// Returns the patch of Hertz under a load (N), with relative curvatures (1/m) along and across.
pub fn hertz(bodies: [Elasticity; 2], load: f64, curvatures: [f64; 2]) -> PointPatch {
    let solids = bodies.map(|b| Solid {
        young: b.young,
        poisson: b.poisson,
    });
    point(load, curvatures, effective_modulus(&solids))
}

/// Returns the half-width (m) of a line contact of two bodies alike under a load (N/m), with a
/// relative curvature (1/m).
pub fn hertz_line(body: Elasticity, load: f64, curvature: f64) -> f64 {
    let solid = Solid {
        young: body.young,
        poisson: body.poisson,
    };
    line(load, curvature, effective_modulus(&[solid; 2])).half_width
}

/// Returns a grid of cells that ends at +-`half` (m).
pub fn centred(cells: [usize; 2], half: [f64; 2]) -> CellGrid {
    CellGrid {
        from: half.map(|h| -h),
        size: [0, 1].map(|k| 2.0 * half[k] / cells[k] as f64),
        cells,
    }
}

/// Returns the distance (m) of ellipsoids before they touch, cell by cell.
pub fn distance(grid: &CellGrid, [along, across]: [f64; 2]) -> Vec<f64> {
    let cells = (0..grid.len()).map(|c| grid.middle(c));
    cells
        .map(|[x, y]| 0.5 * (along * x * x + across * y * y))
        .collect()
}

/// Presses two bodies alike with a layer of this flexibility, on a grid 1.1 times as wide as their
/// patch of Hertz.
pub fn pressed(
    body: Elasticity,
    layer: f64,
    (load, curvatures): (f64, [f64; 2]),
    cells: [usize; 2],
) -> (Surfaces, Pressure, PointPatch) {
    let hertz = hertz([body; 2], load, curvatures);
    let grid = centred(cells, [1.1 * hertz.along, 1.1 * hertz.across]);
    let distance = distance(&grid, curvatures);
    let surfaces = Surfaces::new(grid, [body; 2], layer);
    let pressure = normal(&surfaces, &distance, load, None).unwrap_or_else(|e| panic!("{e}"));
    (surfaces, pressure, hertz)
}
