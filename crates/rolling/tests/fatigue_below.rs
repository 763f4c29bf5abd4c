//! Crack criteria below a fretting sphere, against closed forms of the stresses at the surface (G.
//! M. Hamilton, L. E. Goodman, Journal of Applied Mechanics 33, 1966), and the map of responses.

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{Solid, effective_modulus, point};
use fretwork_rolling::cells::ByCells;
use fretwork_rolling::fatigue::history::{histories, opposite};
use fretwork_rolling::fatigue::materials::STEEL_30NCD16;
use fretwork_rolling::fatigue::{Block, Criterion, Crossland, swt};
use fretwork_rolling::response::{Body, Response, Thresholds, Wears, map};
use fretwork_rolling::{Below, Coulomb, Field};
use std::f64::consts::PI;

const NU: f64 = 0.3;
const MU: f64 = 0.8;
const CURVATURE: f64 = 20.0;

fn grid(half: f64, cells: usize) -> CellGrid {
    CellGrid {
        from: [-half; 2],
        size: [2.0 * half / cells as f64; 2],
        cells: [cells; 2],
    }
}

/// Within the circle the traction mu p of gross slip stretches the surface by s_xx = -+ mu p0 pi x
/// (4 + nu)/8 and s_yy = -+ 3 nu mu p0 pi x/8, in turns, and the pressure stays: J2 and the largest
/// hydrostatic stress of a cycle follow, with a shear stress of mu p at the middle.
#[test]
fn a_cycle_of_gross_slip_has_crosslands_index() {
    let cells = 81;
    let grid = grid(1.2, cells);
    let pressure: Vec<f64> = (0..grid.len())
        .map(|cell| {
            let [x, y] = grid.middle(cell);
            (1.0 - x * x - y * y).max(0.0).sqrt()
        })
        .collect();
    let forth: Field = pressure.iter().map(|p| [MU * p, 0.0]).collect();
    let back = opposite(&forth);
    let below = Below::new(grid, NU, &[0.0]);
    let point = Block {
        side: 0.0,
        layers: 1,
    };
    let cycle = [forth, back];
    let found = histories(&below, &point, &pressure, &cycle, &[]);
    let law = Crossland {
        bending: 1.0,
        torsion: 0.65,
    };
    let row = cells / 2;
    for column in [row, 20, 60] {
        let cell = grid.cell([column, row]);
        let x = grid.middle(cell)[0];
        let (p, stretch) = (pressure[cell], MU * PI * x / 8.0);
        // By the traction: s_xx, s_yy, s_xz; its cycle is straight.
        let [xx, yy, xz] = [-stretch * (4.0 + NU), -stretch * 3.0 * NU, MU * p];
        let mean = (xx + yy) / 3.0;
        let squares = (xx - mean).powi(2) + (yy - mean).powi(2) + mean * mean;
        let amplitude = (0.5 * squares + xz * xz).sqrt();
        // The pressure has s_xx + s_yy = -(1 + 2 nu) p and s_zz = -p at the surface.
        let pressed = -(2.0 + 2.0 * NU) * p / 3.0;
        let highest = pressed + mean.abs();
        let expected = (amplitude + law.pressure_factor() * highest) / law.torsion;
        let index = law.index(&found[cell]);
        assert!(
            (index / expected - 1.0).abs() < 0.02,
            "{x}: {index} {expected}"
        );
    }
    // A stress of the body far away adds to both places of the cycle.
    let far = [
        [0.3, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-0.3, 0.0, 0.0, 0.0, 0.0, 0.0],
    ];
    let pulled = histories(&below, &point, &pressure, &cycle, &far);
    let cell = grid.cell([10, 10]);
    for (k, by) in [(0, 0.3), (1, -0.3)] {
        assert!((pulled[cell][k][0] - found[cell][k][0] - by).abs() < 1e-12);
    }
}

/// At the edge of the patch, under a traction of gross slip, the plane of Smith, Watson and Topper
/// lies across the motion; averaging over a block lowers it.
#[test]
fn the_critical_plane_lies_across_the_motion_at_the_edge() {
    let grid = grid(1.2, 61);
    let pressure: Vec<f64> = (0..grid.len())
        .map(|cell| {
            let [x, y] = grid.middle(cell);
            1e9 * (1.0 - x * x - y * y).max(0.0).sqrt()
        })
        .collect();
    let forth: Field = pressure.iter().map(|p| [MU * p, 0.0]).collect();
    let cycle = [forth.clone(), opposite(&forth)];
    let body = Elasticity {
        young: 210e9,
        poisson: NU,
        density: 7800.0,
    };
    let edge = grid.cell([5, 30]);
    let mut found = Vec::new();
    for side in [1e-6, 0.2, 0.5] {
        let block = Block { side, layers: 4 };
        let below = Below::new(grid, NU, &block.depths());
        let cycles = histories(&below, &block, &pressure, &cycle, &[]);
        found.push(swt(&body, &cycles[edge]));
    }
    let [x, ..] = found[0].normal;
    assert!(x.abs() > 0.97, "{found:?}");
    assert!(found[0].parameter > found[1].parameter, "{found:?}");
    assert!(found[1].parameter > found[2].parameter, "{found:?}");
}

/// Cracks and wear of a map have their onsets: more amplitude never heals. In gross slip wear has
/// the closed form k p s of a displacement that is far above the onset of slip.
#[test]
fn responses_follow_the_amplitude() {
    let solid = Solid {
        young: 210e9,
        poisson: NU,
    };
    let body = Elasticity {
        young: 210e9,
        poisson: NU,
        density: 7800.0,
    };
    let hertz = |load| point(load, [CURVATURE; 2], effective_modulus(&[solid; 2]));
    let contacts = ByCells {
        bodies: [body; 2],
        layer: 0.0,
        distance: &|[x, y]| 0.5 * CURVATURE * (x * x + y * y),
        grid: &|load| grid(1.2 * hertz(load).along, 24),
        law: &Coulomb(MU),
        along: [1.0, 0.0],
        speed: 1.0,
        quarter: 8,
    };
    let thresholds = Thresholds {
        criterion: Criterion::Crossland(STEEL_30NCD16.crossland),
        poisson: NU,
        body: 0,
        bulk: [0.0; 6],
        block: Block {
            side: 20e-6,
            layers: 2,
        },
        wear: Wears::Coefficient(1e-14),
        cycles: 250e3,
        depth: 1e-6,
    };
    let (loads, displacements) = ([2.0, 500.0], [1e-7, 1e-6, 1e-5, 1e-4]);
    let found = map(&contacts, &loads, &displacements, &thresholds);
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    for (row, onsets) in found.damage.iter().zip(&found.onsets) {
        for damage in row {
            let amplitude = damage.conditions.amplitude[0];
            assert_eq!(
                damage.crack >= 1.0,
                amplitude > onsets.crack,
                "{onsets:?} {damage:?}"
            );
            assert_eq!(
                damage.worn >= 1e-6,
                amplitude > onsets.wear,
                "{onsets:?} {damage:?}"
            );
        }
        assert!(row.windows(2).all(|w| w[1].worn > w[0].worn));
        let far = row[3];
        let depth = 4.0 * 1e-14 * 250e3 * hertz(far.conditions.load).pressure * 1e-4;
        assert!((far.worn / depth - 1.0).abs() < 0.06, "{far:?} {depth}");
    }
    let responses = |row: usize| -> Vec<Response> {
        found.damage[row]
            .iter()
            .map(|d| d.response(&thresholds))
            .collect()
    };
    assert_eq!(responses(1)[0], Response::None);
    assert_eq!(responses(1)[3], Response::Both);
    let crack = |thresholds: &Thresholds, load: f64, displacement: f64| {
        let contact = contacts.contact(load).unwrap_or_else(|e| panic!("{e}"));
        let damage = Body::new(contact, thresholds).damage(displacement);
        damage.unwrap_or_else(|e| panic!("{e}")).crack
    };
    // The second body is the first one turned round.
    let turned = Thresholds {
        body: 1,
        ..thresholds
    };
    let (one, other) = (found.damage[1][2].crack, crack(&turned, 500.0, 1e-5));
    assert!((one / other - 1.0).abs() < 1e-6, "{one} {other}");
    // Half of the strength in bending is half of the way to cracks, all over the body.
    let bent = Thresholds {
        bulk: [354e6, 0.0, 0.0, 0.0, 0.0, 0.0],
        ..thresholds
    };
    let index = crack(&bent, 2.0, 1e-9);
    assert!((0.49..0.6).contains(&index), "{index}");
    // In tension across the edge both criteria expect cracks.
    let planes = Thresholds {
        criterion: Criterion::Swt {
            body: STEEL_30NCD16.body,
            life: STEEL_30NCD16.strain_life,
            cycles: 250e3,
        },
        ..thresholds
    };
    let [low, high] = [1e-7, 1e-5].map(|d| crack(&planes, 500.0, d));
    assert!(low < 1.0 && high > 1.0, "{low} {high}");
}
