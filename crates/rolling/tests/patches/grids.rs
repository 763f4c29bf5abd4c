//! What the results of a patch depend on: cells, first guess, units.

use super::pressed::{centred, hertz, steel};
use fretwork_rolling::{Coulomb, Creepage, Patch};

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
