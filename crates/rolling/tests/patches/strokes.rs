//! Strokes of a sphere with the error of their grid, and laws with a state that stays in cells.

use super::pressed::{centred, hertz, steel};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::{Amplitude, Bound, Coulomb, Friction, Patch, Strokes, Vector};
use std::sync::Mutex;

const MU: f64 = 0.6;
const LOAD: f64 = 100.0;
const CURVATURE: f64 = 20.0;

fn with_patch<R>(call: impl FnOnce(&Patch<'_>, &dyn Fn(usize) -> CellGrid, f64) -> R) -> R {
    let body = steel(200e9, 0.0);
    let hertz = hertz([body; 2], LOAD, [CURVATURE; 2]);
    let patch = Patch {
        bodies: [body; 2],
        layer: 0.0,
        distance: &|[x, y]| 0.5 * CURVATURE * (x * x + y * y),
        load: LOAD,
    };
    // delta = (3 mu P/(16 a)) sum (2 - nu)/G, with G = E/2 at nu = 0.
    let gross = 3.0 * MU * LOAD / (16.0 * hertz.along) * 2.0 * 2.0 / (0.5 * body.young);
    call(
        &patch,
        &|cells| centred([cells; 2], [1.1 * hertz.along; 2]),
        gross,
    )
}

fn strokes(law: &dyn Friction, amplitude: Amplitude, quarter: usize) -> Strokes<'_> {
    Strokes {
        law,
        along: [1.0, 0.0],
        amplitude,
        quarter,
        step: 1e-3,
    }
}

/// Mindlin's force and energy (K. L. Johnson, Contact Mechanics, 1985, 7.4) lie within twice the
/// error that is given, in partial and in gross slip, by displacement and by force.
#[test]
fn mindlins_numbers_lie_within_the_error_of_the_grid() {
    with_patch(|patch, grid, gross| {
        for d in [0.4, 0.7, 0.9, 1.5] {
            let left = f64::max(1.0 - d, 0.0);
            let force = 1.0 - left.powf(1.5);
            let energy = 8.0 * (d - 0.4 * (1.0 - left.powf(2.5))) - 4.0 * force * d;
            let (force, energy) = (force * MU * LOAD, energy * MU * LOAD * gross);
            let stroke = strokes(&Coulomb(MU), Amplitude::Displacement(d * gross), 2);
            let found = patch.frets_refined(grid(40), &stroke);
            let found = found.unwrap_or_else(|e| panic!("{e}"));
            println!(
                "{d}: {:?} {force}, {:?} {energy}",
                found.amplitude[1], found.energy
            );
            let off = (found.amplitude[1].value - force).abs();
            assert!(
                off < 2.0 * found.amplitude[1].error + 1e-6 * force,
                "{found:?}"
            );
            let off = (found.energy.value - energy).abs();
            assert!(
                off < 2.0 * found.energy.error,
                "{:?} {energy}",
                found.energy
            );
            assert!(
                found.energy.error < 0.1 * energy,
                "{:?} {energy}",
                found.energy
            );
            if d < 1.0 {
                let stroke = strokes(&Coulomb(MU), Amplitude::Force(force), 2);
                let found = patch.frets_refined(grid(40), &stroke);
                let found = found.unwrap_or_else(|e| panic!("{e}"));
                let off = (found.amplitude[0].value - d * gross).abs();
                assert!(
                    off < 2.0 * found.amplitude[0].error,
                    "{:?}",
                    found.amplitude
                );
            }
        }
    });
}

/// Friction that grows from mu to twice as much over the way slipped in a cell.
#[derive(Debug, Default)]
struct Roughens {
    way: Mutex<Vec<f64>>,
}

/// Way over which it grows (m).
const OVER: f64 = 2e-6;

impl Roughens {
    fn mu(way: f64) -> f64 {
        MU * (2.0 - (-way / OVER).exp())
    }
}

impl Friction for Roughens {
    fn bounds(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<Bound> {
        let way = self.way.lock().unwrap();
        let of = |(p, (way, slip)): (&f64, (&f64, &Vector))| Bound {
            traction: Self::mu(way + length(*slip)) * p,
            slope: MU / OVER * (-(way + length(*slip)) / OVER).exp() * p,
        };
        let cells = cells.pressure.iter().zip(way.iter().zip(slip));
        cells.map(of).collect()
    }

    fn renew(&self, cells: usize) {
        *self.way.lock().unwrap() = vec![0.0; cells];
    }

    fn passed(&self, _: Cells<'_>, slip: &[Vector]) -> Vec<f64> {
        let mut way = self.way.lock().unwrap();
        way.iter_mut().zip(slip).for_each(|(w, s)| *w += length(*s));
        Vec::new()
    }
}

/// Far above the elastic displacement each cell slips by the displacement less its elastic part,
/// and the energy of a cycle is the integral of mu(s) P ds over its way; trials for a force leave
/// the state of the cells as it is.
#[test]
fn a_law_with_a_state_follows_the_way_of_its_cells() {
    with_patch(|patch, grid, gross| {
        let law = Roughens::default();
        let d = 40.0 * gross;
        let stroke = strokes(&law, Amplitude::Displacement(d), 40);
        let found = patch
            .frets(grid(16), &stroke)
            .unwrap_or_else(|e| panic!("{e}"));
        // The integral of 2 - exp(-s/D) from the end of the loading on.
        let ways = [d, 5.0 * d];
        let [low, high] = ways.map(|s| 2.0 * s + OVER * (-s / OVER).exp());
        let energy = MU * LOAD * (high - low);
        let off = found.cycle.energy / energy - 1.0;
        // The elastic part of four quarters is some gross slips each.
        assert!(off.abs() < 0.06, "{off}");
        let way = law.way.lock().unwrap().clone();
        let most = way.iter().copied().fold(0.0, f64::max);
        assert!(most < 5.0 * d && most > 4.6 * d, "{most} {d}");
        let forced = strokes(&law, Amplitude::Force(0.5 * MU * LOAD), 6);
        let forced = patch
            .frets(grid(16), &forced)
            .unwrap_or_else(|e| panic!("{e}"));
        let by_force = law.way.lock().unwrap().clone();
        let rubbed = forced.cycle.rubbed.iter().zip(&forced.pressure.pressure);
        let ways = rubbed.zip(&by_force).filter(|((_, p), _)| **p > 0.0);
        let sums = ways.fold([0.0; 2], |sum, ((rubbed, p), way)| {
            [sum[0] + rubbed / p, sum[1] + way]
        });
        // Loading and cycle: five quarters, of which each trial would count once more.
        assert!(sums[1] > sums[0] && sums[1] < 1.6 * sums[0], "{sums:?}");
    });
}

/// A law with a state has the error of its steps too.
#[test]
fn steps_err_where_friction_has_a_state() {
    with_patch(|patch, grid, gross| {
        let law = Roughens::default();
        let of = |quarter: usize| {
            let stroke = strokes(&law, Amplitude::Displacement(1.2 * gross), quarter);
            let found = patch.frets_refined(grid(32), &stroke);
            found.unwrap_or_else(|e| panic!("{e}")).energy
        };
        let (coarse, fine) = (of(4), of(16));
        assert!(
            (coarse.value - fine.value).abs() < coarse.error,
            "{coarse:?} {fine:?}"
        );
    });
}

/// At small amplitudes the ring that slips is thinner than the cells, which have no energy or that
/// of some cells: Mindlin's energy lies within the error.
#[test]
fn the_energy_of_a_ring_thinner_than_the_cells_lies_within_its_error() {
    with_patch(|patch, grid, gross| {
        for cells in [40, 56, 80] {
            for d in [1e-6, 1e-3, 0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.3] {
                let left: f64 = 1.0 - d;
                let force = 1.0 - left.powf(1.5);
                let energy = 8.0 * (d - 0.4 * (1.0 - left.powf(2.5))) - 4.0 * force * d;
                // The difference of large numbers, for small ones 0.5 d³.
                let energy = if d < 0.01 { 0.5 * d * d * d } else { energy };
                let energy = energy * MU * LOAD * gross;
                let stroke = strokes(&Coulomb(MU), Amplitude::Displacement(d * gross), 2);
                let found = patch.frets_refined(grid(cells), &stroke);
                let found = found.unwrap_or_else(|e| panic!("{e}"));
                let off = (found.energy.value - energy).abs();
                assert!(off <= found.energy.error, "{cells} {d}: {:?}", found.energy);
                let known = found.energy.error < 0.2 * energy;
                assert!(d < 0.2 || known, "{cells} {d}: {:?}", found.energy);
            }
        }
    });
}
