//! What the results of a patch depend on: cells, first guess, units.

use super::pressed::{centred, hertz, steel};
use fretwork_rolling::{Coulomb, Creepage, Estimate, Patch, Rolling};

/// Extrapolated forces of two grids agree within the error of the coarser one, in partial slip,
/// with spin and for unlike bodies.
#[test]
fn the_error_of_the_grid_covers_finer_ones() {
    let curvatures = [2.2, 3.3];
    let distance = |[x, y]: [f64; 2]| 0.5 * (curvatures[0] * x * x + curvatures[1] * y * y);
    let (load, mu) = (75e3, 0.4);
    for bodies in [
        [steel(210e9, 0.3); 2],
        [steel(210e9, 0.3), steel(3e9, 0.45)],
    ] {
        let hertz = hertz(bodies, load, curvatures);
        let half = [1.2 * hertz.along, 1.2 * hertz.across];
        let patch = Patch {
            bodies,
            layer: 0.0,
            distance: &distance,
            load,
        };
        // Slip begins at about mu times the slope of the surfaces.
        let unit = mu * hertz.along * curvatures[0];
        for creepage in [
            Creepage {
                along: 0.4 * unit,
                ..Creepage::default()
            },
            Creepage {
                along: 0.3 * unit,
                across: -0.3 * unit,
                spin: 0.5 * unit / hertz.along,
            },
        ] {
            let of = |cells| {
                let found = patch.refined(centred([cells; 2], half), &creepage, &Coulomb(mu), 1.0);
                found.unwrap_or_else(|e| panic!("{bodies:?} {creepage:?} {cells}: {e}"))
            };
            let [coarse, fine] = [32, 64].map(of);
            for k in 0..2 {
                let off = (coarse.force[k] - fine.force[k]).abs();
                let allowed = coarse.error[k] + fine.error[k];
                assert!(off <= allowed, "{bodies:?} {creepage:?}: {off} {allowed}");
                assert!(fine.error[k] < 0.012 * mu * load, "{:?}", fine.error);
            }
            // The power of the drive is that of slip but for an error of first order.
            let lost = [&coarse, &fine].map(|r| {
                let supplied = r.fine.t_gamma + r.fine.resistance;
                (1.0 - r.fine.dissipation / supplied).abs()
            });
            assert!(lost[1] < 0.08 && lost[1] < 0.6 * lost[0] + 1e-3, "{lost:?}");
        }
    }
}

/// The energy of slip by which unlike bodies wear, T gamma and the work of their pressures, falls
/// to the first order of the cells: what is stated on grids of 24 and 48 cells agrees with that on
/// 96 within the errors, with both of one sign and where they cancel. There the error tells that it
/// is not known.
#[test]
fn wear_of_unlike_bodies_has_its_error() {
    let bodies = [steel(210e9, 0.3), steel(60e9, 0.25)];
    let (load, curvatures) = (75e3, [1.0 / 0.46, 1.0 / 0.3]);
    let hertz = hertz(bodies, load, curvatures);
    let patch = Patch {
        bodies,
        layer: 0.0,
        distance: &|[x, y]| 0.5 * (curvatures[0] * x * x + curvatures[1] * y * y),
        load,
    };
    let stated = |along: f64, cells: usize| {
        let wide = f64::max(1.1, 1.005 / (1.0 - 4.0 / cells as f64));
        let grid = centred([cells; 2], [wide * hertz.along, wide * hertz.across]);
        let creepage = Creepage {
            along,
            ..Creepage::default()
        };
        let found = patch.refined(grid, &creepage, &Coulomb(0.3), 1.0).unwrap();
        let energy = |r: &Rolling| r.t_gamma + r.resistance;
        Estimate::of_sum(energy(&found.fine), found.coarse.each_ref().map(energy))
    };
    for (along, known) in [(0.0, true), (0.001, false), (0.0012, false), (0.003, true)] {
        let all = [24, 48, 96].map(|cells| stated(along, cells));
        println!("{along}: {all:?}");
        for coarse in &all[..2] {
            let off = (coarse.value - all[2].value).abs();
            assert!(off <= coarse.error + all[2].error, "{along}: {all:?}");
        }
        assert!(
            !known || all[2].error < 0.05 * all[2].value,
            "{along}: {all:?}"
        );
        let large = all[0].error > 0.25 * all[0].value;
        assert_eq!(large, !known, "{along}: {all:?}");
    }
}
