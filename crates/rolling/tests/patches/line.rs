//! A cylinder on a flat, as one row of cells as long as the cylinder: the middle of a strip of
//! length L on half-spaces, which far from its ends is in plane strain.
//!
//! Per body a line load f moves the middle of the strip by f/(pi G) ((1 - nu) ln(L/|x|) + nu) along
//! itself and by f/(pi G) (1 - nu) ln(L/|x|) into the body, for |x| << L: the integrals of
//! Cerruti's and Boussinesq's displacements (K. L. Johnson, Contact Mechanics, 1985, 3.2). Their
//! mean over a semi-ellipse of half-width a has ln(2 L/a) + 1/2 in place of the logarithm.

use super::pressed::{hertz_line, steel};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::fretting::{Amplitude, Fretting, Loop};
use fretwork_rolling::running::strip_transition;
use fretwork_rolling::{Coulomb, Creepage, Patch, Pressure, Strokes, Surfaces};
use std::f64::consts::PI;

const MU: f64 = 0.5;
const LOAD: f64 = 2e3;
const LENGTH: f64 = 20e-3;
const CURVATURE: f64 = 20.0;
const NU: f64 = 0.3;
const YOUNG: f64 = 210e9;

fn grid(cells: usize) -> (CellGrid, f64) {
    let half = hertz_line(steel(YOUNG, NU), LOAD / LENGTH, CURVATURE);
    let grid = CellGrid {
        from: [-1.1 * half, -0.5 * LENGTH],
        size: [2.2 * half / cells as f64, LENGTH],
        cells: [cells, 1],
    };
    (grid, half)
}

fn with_patch<R>(call: impl FnOnce(&Patch<'_>) -> R) -> R {
    call(&Patch {
        bodies: [steel(YOUNG, NU); 2],
        layer: 0.0,
        distance: &|[x, _]| 0.5 * CURVATURE * x * x,
        load: LOAD,
    })
}

fn pressed(cells: usize) -> (Surfaces, Pressure, f64) {
    let (grid, half) = grid(cells);
    let found = with_patch(|patch| patch.pressed(grid)).unwrap_or_else(|e| panic!("{e}"));
    (found.0, found.1, half)
}

fn near(got: f64, expected: f64, by: f64) {
    assert!((got / expected - 1.0).abs() < by, "{got:e} {expected:e}");
}

/// ln(2 L/a) + 1/2 + nu/(1 - nu), and 2 mu P (1 - nu)/(pi G L).
fn scale(half: f64) -> [f64; 2] {
    let shear = 0.5 * YOUNG / (1.0 + NU);
    [
        (2.0 * LENGTH / half).ln() + 0.5 + NU / (1.0 - NU),
        2.0 * MU * LOAD * (1.0 - NU) / (PI * shear * LENGTH),
    ]
}

#[test]
fn pressures_are_those_of_hertz_in_the_plane() {
    let modulus = YOUNG / (2.0 * (1.0 - NU * NU));
    let mut off = Vec::new();
    for cells in [33, 65, 129] {
        let (_, pressure, half) = pressed(cells);
        let line = LOAD / LENGTH;
        let largest = (line * modulus * CURVATURE / PI).sqrt();
        near(pressure.largest(), largest, 0.01);
        let approach = 2.0 * line / (PI * modulus) * ((2.0 * LENGTH / half).ln() + 0.5);
        near(pressure.approach, approach, 2e-3);
        off.push((pressure.approach / approach - 1.0).abs());
    }
    assert!(off.iter().all(|o| *o < 2e-4), "{off:?}");
}

/// Cattaneo's and Mindlin's strip: what sticks is sqrt(1 - Q/(mu P)) of the width, displacement and
/// energy follow from the compliance of the strip, and at the onset of gross slip A is 1/(4 K),
/// with K = ln(2 L/a) + 1/2 + nu/(1 - nu), for 1/5 of a sphere.
#[test]
fn a_loop_is_cattaneos_strip() {
    let loops = |cells: usize, q: f64| -> (Loop, f64) {
        let (surfaces, pressure, half) = pressed(cells);
        let frets = Fretting {
            surfaces: &surfaces,
            pressure: &pressure.pressure,
            law: &Coulomb(MU),
            along: [1.0, 0.0],
            step: 1.0,
        };
        let found = frets.by_masing(Amplitude::Force(q * MU * LOAD), 2);
        (found.unwrap_or_else(|e| panic!("{cells} {q}: {e}")), half)
    };
    for q in [0.3, 0.6, 0.9, 0.999] {
        let closed = |half: f64| {
            let [k, unit] = scale(half);
            let left: f64 = 1.0 - q;
            let moved = k * q + 0.5 * left * left.ln();
            let area = 0.5 * k * q * q
                + 0.5 * (-0.25 - 0.5 * left * left * left.ln() + 0.25 * left * left);
            [
                unit * moved,
                unit * MU * LOAD * (4.0 * q * moved - 8.0 * area),
            ]
        };
        let mut off = Vec::new();
        for cells in [64, 256] {
            let (found, half) = loops(cells, q);
            let [moved, energy] = closed(half);
            near(found.amplitude[0], moved, 2e-3);
            near(found.energy, energy, 0.05);
            off.push((found.energy / energy - 1.0).abs());
            let stuck = f64::sqrt(1.0 - q);
            assert!(
                (found.stuck - stuck).abs() < 2.5 / cells as f64,
                "{q} {found:?}"
            );
        }
        assert!(off[1] < 0.012, "{q}: {off:?}");
    }
    let (found, half) = loops(256, 0.9999);
    let closed = strip_transition(&[steel(YOUNG, NU); 2], LENGTH, half);
    near(closed, 0.25 / scale(half)[0], 1e-12);
    near(found.energy_ratio(), closed, 0.02);
}

/// The error of the grid holds what the extrapolated numbers are off.
#[test]
fn strokes_of_a_strip_have_the_error_of_their_grid() {
    let (grid, half) = grid(64);
    let [k, unit] = scale(half);
    let q: f64 = 0.6;
    let displacement = unit * (k * q + 0.5 * (1.0 - q) * (1.0 - q).ln());
    let strokes = Strokes {
        law: &Coulomb(MU),
        along: [1.0, 0.0],
        amplitude: Amplitude::Displacement(displacement),
        quarter: 4,
        step: 1.0,
    };
    let found = with_patch(|patch| patch.frets_refined(grid, &strokes));
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    let off = (found.amplitude[1].value - q * MU * LOAD).abs();
    assert!(
        off < 2.0 * found.amplitude[1].error + 1e-3 * MU * LOAD,
        "{found:?}"
    );
    assert!(
        found.amplitude[1].error < 0.01 * MU * LOAD,
        "{:?}",
        found.amplitude
    );
    assert!(found.stuck.error < 0.1 && found.worn.value == 0.0);
}

/// Carter's strip rolls by the same cells (F. W. Carter, Proc. R. Soc. A 112, 1926): the force is
/// 1 - (1 - xi/xi_0)² of mu P, with xi_0 = mu a/R.
#[test]
fn a_strip_rolls_as_carters() {
    let (grid, half) = grid(128);
    let full = MU * half * CURVATURE;
    let creepage = Creepage {
        along: 0.4 * full,
        ..Creepage::default()
    };
    let found = with_patch(|patch| patch.refined(grid, &creepage, &Coulomb(MU), 1.0));
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    near(found.force[0], -0.64 * MU * LOAD, 0.01);
}

/// Forces are Carter's within the error of their grid, until what sticks is smaller than a cell.
#[test]
fn a_strip_rolls_as_carters_within_the_error_of_its_grid() {
    let mut wrong = Vec::new();
    for cells in [48, 64, 96, 128, 192] {
        let (grid, half) = grid(cells);
        for part in [0.02, 0.05, 0.1, 0.139, 0.2, 0.3, 0.5, 0.694, 0.8, 0.9] {
            let creepage = Creepage {
                along: part * MU * half * CURVATURE,
                ..Creepage::default()
            };
            let found = with_patch(|p| p.refined(grid, &creepage, &Coulomb(MU), 1.0)).unwrap();
            let carter = -(1.0 - (1.0 - part).powi(2)) * MU * LOAD;
            let off = (found.force[0] - carter).abs();
            if off > found.error[0] {
                wrong.push((cells, part, off / carter, found.error[0] / carter));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
