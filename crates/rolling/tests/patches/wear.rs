//! Profiles that wear.

use super::pressed::{centred, distance, steel};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::profile::{Rolls, Wear, Worn};
use fretwork_rolling::{Coulomb, Creepage, Surfaces};

const COEFFICIENT: f64 = 1.24e-13;

/// A rail head of 0.3 m across under a wheel of 0.46 m, 75 kN, creepage 0.5 %.
fn worn(passages: f64, share: f64, half: f64) -> (Worn, Vec<Worn>, CellGrid) {
    let grid = centred([32, 44], [7.8e-3, half]);
    let distance = distance(&grid, [2.0 / 0.92, 2.0 / 0.6]);
    let body = steel(2.0 * 80.8e9 * 1.3, 0.3);
    let surfaces = Surfaces::new(grid, [body; 2], 0.0);
    let rolls = Rolls {
        surfaces: &surfaces,
        distance: &distance,
        load: 75e3,
        creepage: Creepage {
            along: 5e-3,
            ..Creepage::default()
        },
        law: &Coulomb(0.43),
        speed: 27.8,
        wear: Wear {
            coefficients: [0.0, COEFFICIENT],
            passages: [1.0; 2],
        },
    };
    let mut all = Vec::new();
    let end = rolls
        .wear(passages, share, &mut |w| all.push(w.clone()))
        .unwrap_or_else(|e| panic!("{e}"));
    (end, all, grid)
}

#[test]
fn a_rail_wears_by_the_power_of_slip_and_flattens() {
    let (end, all, grid) = worn(8000.0, 0.02, 9.9e-3);
    let depth = &end.depth[1];
    let volume: f64 = depth.iter().sum::<f64>() * grid.size[1];
    assert!((end.volume[1] / volume - 1.0).abs() < 1e-12);
    assert_eq!(end.volume[0], 0.0);
    // Archard's wear is k over mu of the energy of slip, Q xi for each length rolled, but for the
    // error of the cells.
    let energy = all.windows(2).map(|w| {
        let adhesion = 0.5 * (w[0].adhesion[0] + w[1].adhesion[0]);
        (w[1].passages - w[0].passages) * adhesion * 75e3 * 5e-3
    });
    let expected = COEFFICIENT / 0.43 * energy.sum::<f64>();
    assert!(
        (volume / expected - 1.0).abs() < 0.06,
        "{volume} {expected}"
    );
    // Pressures fall as the scar widens, smoothly.
    assert!(all.windows(2).all(|w| w[1].pressure < w[0].pressure));
    assert!(end.pressure < 0.8 * all[0].pressure);
    let deepest = depth.iter().copied().fold(0.0, f64::max);
    let rough = depth
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
        .fold(0.0, f64::max);
    assert!(rough < 0.1 * deepest, "{rough} {deepest}");
    // A trial in explicit jumps of 250 passages gave 41.3 um.
    assert!(
        (deepest / 41.3e-6 - 1.0).abs() < 0.03,
        "{deepest} {}",
        end.jumps
    );
}

/// The error of a jump by halving is about that against jumps a quarter as long, and long jumps do
/// not oscillate.
#[test]
fn jumps_converge() {
    let coarse = worn(2e4, 0.1, 14e-3);
    let fine = worn(2e4, 0.02, 14e-3);
    let depth = |w: &Worn| w.depth[1].iter().copied().fold(0.0, f64::max);
    let off = (depth(&coarse.0) - depth(&fine.0)).abs();
    assert!(off < 2.0 * coarse.0.error, "{off} {}", coarse.0.error);
    assert!(off < 0.05 * depth(&fine.0));
    assert!(coarse.0.jumps < 60, "{}", coarse.0.jumps);
    let second = |w: &Worn| {
        let d = &w.depth[1];
        let parts = d.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs());
        parts.fold(0.0, f64::max) / depth(w)
    };
    assert!((second(&coarse.0) / second(&fine.0) - 1.0).abs() < 0.5);
}
