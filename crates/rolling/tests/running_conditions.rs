//! Maps of running conditions of a sphere on a flat: by cells against the closed forms of Mindlin
//! (K. L. Johnson, Contact Mechanics, 1985, 7.4), which give A = 0.2 and a slip ratio of 0.26 at
//! the onset of gross slip.

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{Solid, effective_modulus, point};
use fretwork_rolling::Coulomb;
use fretwork_rolling::cells::ByCells;
use fretwork_rolling::mindlin::Mindlin;
use fretwork_rolling::running::{Conditions, Contacts, Limits, Map, Regime, RunningError, map};

const MU: f64 = 0.6;
const CURVATURE: f64 = 20.0;
fn steel(poisson: f64) -> [Solid; 2] {
    [Solid {
        young: 210e9,
        poisson,
    }; 2]
}

fn mindlin(poisson: f64) -> Mindlin {
    Mindlin {
        bodies: steel(poisson),
        curvatures: [CURVATURE; 2],
        friction: MU,
    }
}

/// Returns the radius of the patch (m).
fn radius(load: f64, poisson: f64) -> f64 {
    point(load, [CURVATURE; 2], effective_modulus(&steel(poisson))).along
}

fn by_cells(poisson: f64, loads: &[f64], displacements: &[f64]) -> Result<Map, RunningError> {
    const CELLS: usize = 32;
    let body = Elasticity {
        young: 210e9,
        poisson,
        density: 7800.0,
    };
    let grid = |load: f64| {
        let half = 1.1 * radius(load, poisson);
        CellGrid {
            from: [-half; 2],
            size: [2.0 * half / CELLS as f64; 2],
            cells: [CELLS; 2],
        }
    };
    let contacts = ByCells {
        bodies: [body; 2],
        layer: 0.0,
        distance: &|[x, y]| 0.5 * CURVATURE * (x * x + y * y),
        grid: &grid,
        law: &Coulomb(MU),
        along: [1.0, 0.0],
        speed: 1.0,
        quarter: 8,
    };
    map(&contacts, loads, displacements, &Limits::default())
}

fn near(got: f64, expected: f64, relative: f64) {
    assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
}

#[test]
fn mindlins_boundaries_are_those_of_his_formulas() {
    let loads = [20.0, 160.0];
    let found = map(&mindlin(0.3), &loads, &[1e-6], &Limits::default());
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    for (load, edges) in loads.iter().zip(&found.boundaries) {
        let a = radius(*load, 0.3);
        let gross = 3.0 * MU * load / (16.0 * a) * 2.0 * 1.7 / steel(0.3)[0].shear();
        near(edges.gross_slip, gross, 1e-3);
        near(edges.energy_ratio, gross, 2e-3);
        near(edges.stick, 0.05 * gross, 1e-3);
        near(edges.reciprocating, a, 1e-9);
    }
    // The onset of gross slip grows with P^(2/3).
    let [low, high] = [0, 1].map(|k| found.boundaries[k].gross_slip);
    near(high / low, 4.0, 2e-3);
    let onset = map(&mindlin(0.3), &[20.0], &[low], &Limits::default());
    let onset = onset.unwrap_or_else(|e| panic!("{e}")).conditions[0][0];
    near(onset.slip_ratio, 0.26, 0.01);
    near(onset.energy_ratio(), 0.2, 0.01);
}

/// Without Poisson's ratio the closed forms are exact; with it slip depends on the direction from
/// the middle, which changes its largest value but hardly the sums.
#[test]
fn a_map_by_cells_is_mindlins() {
    let (loads, displacements) = ([50.0, 200.0], [2e-8, 4e-7, 1e-6, 3e-6, 4e-4]);
    let limits = Limits::default();
    for (poisson, most) in [(0.0, 0.06), (0.3, 0.25)] {
        let closed = map(&mindlin(poisson), &loads, &displacements, &limits);
        let closed = closed.unwrap_or_else(|e| panic!("{e}"));
        let found = by_cells(poisson, &loads, &displacements).unwrap_or_else(|e| panic!("{e}"));
        let mut regimes = Vec::new();
        let regime = |map: &Map, conditions: &Conditions| {
            let edges = map.boundaries.iter().find(|b| b.load == conditions.load);
            conditions.regime(edges.unwrap(), &limits)
        };
        let rows = found.conditions.iter().zip(&closed.conditions);
        for (got, expected) in rows.flat_map(|(row, expected)| row.iter().zip(expected)) {
            regimes.push(regime(&found, got));
            assert_eq!(
                regime(&found, got),
                regime(&closed, expected),
                "{got:?} {expected:?}"
            );
            near(got.amplitude[1], expected.amplitude[1], 0.015);
            near(got.cover, expected.cover, 0.06);
            if expected.stuck < 0.9 {
                near(got.energy, expected.energy, 0.05);
                near(got.rubbed, expected.rubbed, 0.05);
                near(got.most_rubbed, expected.most_rubbed, most);
                let off = (got.slip_ratio - expected.slip_ratio).abs();
                assert!(off < 0.015, "{got:?} {expected:?}");
            }
            let [volume, depth] = got.wear(1e-13, 1e5);
            assert!((volume - 1e-8 * got.energy / MU).abs() <= 1e-6 * volume);
            assert!((depth - 1e-8 * got.most_rubbed).abs() <= 1e-12 * depth);
        }
        for regime in [
            Regime::Stick,
            Regime::PartialSlip,
            Regime::GrossSlip,
            Regime::Reciprocating,
        ] {
            assert!(regimes.contains(&regime), "{regimes:?}");
        }
        for (got, expected) in found.boundaries.iter().zip(&closed.boundaries) {
            println!("stick {} {}", got.stick, expected.stick);
            near(got.stick, expected.stick, 0.2);
            near(got.gross_slip, expected.gross_slip, 0.1 * poisson + 0.02);
            near(got.energy_ratio, expected.energy_ratio, 0.05);
            near(got.reciprocating, expected.reciprocating, 0.06);
        }
    }
}

/// Ellipses that are five times as long along the motion as across it, and the other way round.
#[test]
fn ellipses_have_the_closed_forms_too() {
    for curvatures in [[4.0, 50.0], [50.0, 4.0]] {
        let closed = Mindlin {
            curvatures,
            ..mindlin(0.0)
        };
        let hertz = |load| point(load, curvatures, effective_modulus(&steel(0.0)));
        let body = Elasticity {
            young: 210e9,
            poisson: 0.0,
            density: 7800.0,
        };
        let contacts = ByCells {
            bodies: [body; 2],
            layer: 0.0,
            distance: &|[x, y]| 0.5 * (curvatures[0] * x * x + curvatures[1] * y * y),
            grid: &|load| {
                let patch = hertz(load);
                let half = [1.1 * patch.along, 1.1 * patch.across];
                CellGrid {
                    from: half.map(|h| -h),
                    size: half.map(|h| h / 16.0),
                    cells: [32; 2],
                }
            },
            law: &Coulomb(MU),
            along: [1.0, 0.0],
            speed: 1.0,
            quarter: 8,
        };
        let (loads, displacements) = ([100.0], [5e-7, 5e-6]);
        let limits = Limits::default();
        let [closed, found] = [&closed as &dyn Contacts, &contacts]
            .map(|c| map(c, &loads, &displacements, &limits).unwrap_or_else(|e| panic!("{e}")));
        for (got, expected) in found.conditions[0].iter().zip(&closed.conditions[0]) {
            near(got.amplitude[1], expected.amplitude[1], 0.015);
            near(got.energy, expected.energy, 0.05);
        }
        let [got, expected] = [found.boundaries[0], closed.boundaries[0]];
        near(got.gross_slip, expected.gross_slip, 0.03);
        near(got.energy_ratio, expected.energy_ratio, 0.05);
        near(got.reciprocating, expected.reciprocating, 0.06);
    }
}

#[test]
fn numbers_that_are_not_positive_are_refused() {
    let smooth = Mindlin {
        friction: 0.0,
        ..mindlin(0.3)
    };
    let refused = map(&smooth, &[1.0], &[1e-6], &Limits::default()).err();
    assert_eq!(refused, Some(RunningError::Friction(0.0)));
    let refused = |loads: &[f64], displacements: &[f64]| {
        map(&mindlin(0.3), loads, displacements, &Limits::default()).err()
    };
    assert_eq!(
        refused(&[1.0, -2.0], &[1e-6]),
        Some(RunningError::Axis(-2.0))
    );
    assert_eq!(refused(&[1.0], &[0.0]), Some(RunningError::Axis(0.0)));
}
