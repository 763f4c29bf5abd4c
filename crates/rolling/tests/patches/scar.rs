//! Scars and debris of many cycles of a sphere on a flat in gross slip, against Archard's law, the
//! scar of rigid bodies, and the balance of debris.

use super::pressed::{centred, distance, hertz, steel};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::{Amplitude, Bound, Cycles, Friction, Scar, Surfaces, Vector};
use std::f64::consts::PI;
use std::sync::Mutex;

const LOAD: f64 = 50.0;
const CURVATURE: f64 = 100.0;
const STROKE: f64 = 20e-6;
/// Wear coefficient (1/Pa).
const K: f64 = 1e-13;

/// Friction mu p less what debris takes of it, and wear k p s.
#[derive(Debug, Default)]
struct Worn {
    mu: f64,
    k: f64,
    /// Debris at which half of friction is left (m); none matters if it is 0.
    half: f64,
    debris: Mutex<Vec<f64>>,
}

impl Worn {
    fn mu(&self, debris: f64) -> f64 {
        match self.half > 0.0 {
            true => self.mu / (1.0 + debris / self.half),
            false => self.mu,
        }
    }
}

impl Friction for Worn {
    fn bounds(&self, cells: Cells<'_>, _: &[Vector]) -> Vec<Bound> {
        let debris = self.debris.lock().unwrap();
        let of = |(cell, p): (usize, &f64)| Bound {
            traction: self.mu(debris.get(cell).copied().unwrap_or(0.0)) * p,
            slope: 0.0,
        };
        cells.pressure.iter().enumerate().map(of).collect()
    }

    fn constant(&self) -> bool {
        self.half == 0.0
    }

    fn passed(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<f64> {
        let cells = cells.pressure.iter().zip(slip);
        cells.map(|(p, s)| self.k * p * length(*s)).collect()
    }

    fn cover(&self, debris: &[f64]) {
        *self.debris.lock().unwrap() = debris.to_vec();
    }
}

fn grid(cells: usize, wide: f64) -> CellGrid {
    let hertz = hertz([steel(210e9, 0.3); 2], LOAD, [CURVATURE; 2]);
    centred([cells; 2], [wide * hertz.along; 2])
}

fn follow(law: &Worn, grid: CellGrid, cycles: f64, share: f64, ejection: Option<f64>) -> Scar {
    let surfaces = Surfaces::new(grid, [steel(210e9, 0.3); 2], 0.0);
    let distance = distance(&grid, [CURVATURE; 2]);
    let course = Cycles {
        surfaces: &surfaces,
        distance: &distance,
        load: LOAD,
        law,
        along: [1.0, 0.0],
        amplitude: Amplitude::Displacement(STROKE),
        quarter: 4,
        step: 1e-3,
        ejection,
    };
    let found = course.follow(cycles, share, &mut |_| ());
    found.unwrap_or_else(|e| panic!("{e}"))
}

/// A worn volume of k P 4 (delta - elastic part) N, of a scar that flattens to that of rigid
/// bodies: depth D - r²/(2 R), V = pi R D², and a pressure that is the same everywhere. Volume
/// closes.
#[test]
fn a_ball_wears_by_archard_to_the_scar_of_a_rigid_one() {
    let law = Worn {
        mu: 0.3,
        k: K,
        ..Worn::default()
    };
    let cycles = 1.2e4;
    let found = follow(&law, grid(32, 4.2), cycles, 0.05, None);
    let most = K * LOAD * 4.0 * STROKE * cycles;
    println!(
        "{} jumps, {:e} of {most:e}, {:e}, {:e}, {:?}",
        found.jumps, found.volume, found.deepest, found.peak, found.error
    );
    assert!(found.volume < most && found.volume > 0.9 * most, "{most:e}");
    assert!(found.unaccounted() < 1e-12);
    assert!((found.between / found.volume - 1.0).abs() < 1e-12 && found.ejected == 0.0);
    let deep = (found.volume * CURVATURE / PI).sqrt();
    // The elastic approach rounds the rim.
    assert!((found.deepest / deep - 1.0).abs() < 0.05, "{deep:e}");
    let area = 2.0 * PI * deep / CURVATURE;
    assert!((found.area / area - 1.0).abs() < 0.2, "{area:e}");
    assert!(
        found.peak < 2.5 * LOAD / found.area,
        "{}",
        LOAD / found.area
    );
    assert!((found.amplitude[1] / (0.3 * LOAD) - 1.0).abs() < 1e-4);
}

/// Jumps of half the error change depth and volume by less than what is given.
#[test]
fn jumps_have_the_error_that_is_given() {
    let law = Worn {
        mu: 0.3,
        k: K,
        ..Worn::default()
    };
    let [rough, fine] = [0.1, 0.02].map(|share| follow(&law, grid(24, 3.0), 2e3, share, None));
    assert!(fine.jumps > rough.jumps, "{} {}", rough.jumps, fine.jumps);
    let off = (rough.deepest - fine.deepest).abs();
    assert!(
        off <= rough.error[0] + fine.error[0],
        "{off:e} {rough:?} {fine:?}"
    );
    assert!(rough.error[0] < 0.12 * rough.deepest);
}

/// Debris tends to k p l in each cell, where the law wears k p s and debris leaves over a way l:
/// by d rho/dN = k p s - rho s/l. Friction follows it.
#[test]
fn debris_comes_to_its_balance_and_friction_with_it() {
    let (k, way, half) = (1e-15, 1e-3, 0.5e-9);
    let law = Worn {
        mu: 0.5,
        k,
        half,
        ..Worn::default()
    };
    // Few cycles, which wear little: the pressure stays that of Hertz.
    let few = follow(&law, grid(24, 1.3), 100.0, 0.02, Some(way));
    assert!(
        few.unaccounted() < 1e-12 && few.ejected > 0.5 * few.volume,
        "{few:?}"
    );
    let (mut force, mut most) = (0.0, 0.0f64);
    let area = grid(24, 1.3).area(3);
    for (p, debris) in few
        .pressure
        .iter()
        .zip(&few.debris)
        .filter(|(p, _)| **p > 0.0)
    {
        let balance = k * p * way;
        most = most.max((debris - balance).abs() / (k * few.peak * way));
        force += 0.5 / (1.0 + balance / half) * p * area;
    }
    assert!(most < 0.05, "{most}");
    assert!(
        (few.amplitude[1] / force - 1.0).abs() < 0.02,
        "{} {force}",
        few.amplitude[1]
    );
}
