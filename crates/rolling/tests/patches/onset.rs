//! Strokes of a sphere up to the onset of gross slip: the order to which their numbers fall with
//! the cells, and whether what is stated contains the numbers of finer grids.

use super::pressed::{centred, hertz, steel};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::patch::coarser;
use fretwork_rolling::{
    Amplitude, Coulomb, FrettingError, Patch, RefinedStroke, StrokeError, Strokes,
};

const MU: f64 = 0.3;
const LOAD: f64 = 50.0;
const CURVATURE: f64 = 100.0;
/// Forces over mu P.
const PARTS: [f64; 6] = [0.05, 0.3, 0.667, 0.9, 0.99, 0.999];

/// Calls a function with the sphere, the grid of a number of cells that a patch has, and the
/// displacement at the onset of gross slip, delta = (3 mu P/(16 a)) sum (2 - nu)/G.
fn with_sphere<R>(
    poisson: f64,
    call: impl FnOnce(&Patch<'_>, &dyn Fn(usize) -> CellGrid, f64) -> R,
) -> R {
    let body = steel(210e9, poisson);
    let hertz = hertz([body; 2], LOAD, [CURVATURE; 2]);
    let patch = Patch {
        bodies: [body; 2],
        layer: 0.0,
        distance: &|[x, y]| 0.5 * CURVATURE * (x * x + y * y),
        load: LOAD,
    };
    let gross = 3.0 * MU * LOAD / (16.0 * hertz.along) * 2.0 * (2.0 - poisson) / body.shear();
    let grid = |cells: usize| {
        let wide = f64::max(1.1, 1.005 / (1.0 - 4.0 / cells as f64));
        centred([cells; 2], [wide * hertz.along; 2])
    };
    call(&patch, &grid, gross)
}

fn strokes(amplitude: Amplitude, quarter: usize) -> Strokes<'static> {
    Strokes {
        law: &Coulomb(MU),
        along: [1.0, 0.0],
        amplitude,
        quarter,
        step: 1.0,
    }
}

/// Mindlin's displacement over that at gross slip, and the energy of a cycle over mu P times it, of
/// a force over mu P (K. L. Johnson, Contact Mechanics, 1985, 7.4).
fn mindlin(part: f64) -> [f64; 2] {
    let left = (1.0 - part).powf(2.0 / 3.0);
    let d = 1.0 - left;
    [d, 8.0 * (d - 0.4 * (1.0 - left.powf(2.5))) - 4.0 * part * d]
}

/// Without Poisson's ratio, where Mindlin's forms are exact: force, displacement and energy fall to
/// more than the first order of the cells, by jumps, in the worst of all fractions and of two grids
/// half a cell apart. Twice the cells have less than half of the error.
#[test]
fn numbers_fall_faster_than_the_cells() {
    with_sphere(0.0, |patch, grid, gross| {
        let unit = MU * LOAD * gross;
        let worst = |cells: usize| {
            let finer = grid(2 * cells);
            let mut worst = [0.0f64; 2];
            for part in &PARTS[1..] {
                let [d, energy] = mindlin(*part);
                for grid in coarser(&finer) {
                    let by = strokes(Amplitude::Displacement(d * gross), 1);
                    let cycle = patch.frets(grid, &by).unwrap().cycle;
                    worst[0] = worst[0].max((cycle.amplitude[1] / (MU * LOAD) - part).abs());
                    worst[1] = worst[1].max((cycle.energy / unit - energy).abs());
                }
            }
            worst
        };
        let all = [12, 24, 48].map(worst);
        println!("force and energy on 12, 24, 48 cells: {all:?}");
        for pair in all.windows(2) {
            for (coarse, fine) in pair[0].iter().zip(pair[1]) {
                assert!(fine < 0.5 * coarse, "{all:?}");
            }
        }
    });
}

fn numbers(found: &RefinedStroke) -> [[f64; 2]; 4] {
    let [displacement, force] = found.amplitude;
    [displacement, force, found.energy, found.opening].map(|e| [e.value, e.error])
}

/// What is stated contains Mindlin's numbers, at Poisson's ratio 0, and those of a grid of half of
/// the cells' size at those of metals and of rubber, from the smallest forces to the onset of gross
/// slip and above, by displacement and by force.
#[test]
fn what_is_stated_contains_finer_grids() {
    for poisson in [0.0, 0.3, 0.5] {
        with_sphere(poisson, |patch, grid, gross| {
            let of = |amplitude, cells: usize| {
                let stroke = strokes(amplitude, 2);
                let found = patch.frets_refined(grid(cells), &stroke);
                numbers(&found.unwrap_or_else(|e| panic!("{poisson} {amplitude:?}: {e}")))
            };
            let fine = |amplitude| {
                let found = patch.frets(grid(48), &strokes(amplitude, 2)).unwrap().cycle;
                let [displacement, force] = found.amplitude;
                [displacement, force, found.energy, found.opening]
            };
            let parts = PARTS
                .iter()
                .filter(|p| poisson == 0.0 || !(0.1..0.95).contains(*p));
            for part in parts {
                let [d, energy] = mindlin(*part);
                let [d, force] = [d * gross, part * MU * LOAD];
                for amplitude in [Amplitude::Displacement(d), Amplitude::Force(force)] {
                    let stated = of(amplitude, 24);
                    // The force vanishes where a first loading has half of the amplitude.
                    let opening = d - 2.0 * gross * mindlin(0.5 * part)[0];
                    let expected = match poisson == 0.0 {
                        true => [d, force, energy * MU * LOAD * gross, opening],
                        false => fine(amplitude),
                    };
                    for ([value, error], expected) in stated.iter().zip(expected) {
                        // A force that is given is found to a millionth.
                        let off = (value - expected).abs();
                        assert!(
                            off <= error + 3e-6 * expected.abs(),
                            "{poisson} {part} {amplitude:?}: {stated:?} {expected:e}"
                        );
                    }
                }
            }
        });
    }
}

/// At the onset of gross slip slips are not all along the motion yet, and the force is below mu P;
/// sliding on, it grows towards it. Forces in between are held, in gross slip, and those above mu P
/// are refused with it.
#[test]
fn forces_up_to_all_bounds_are_held() {
    for (poisson, part) in [(0.0, 0.99999), (0.3, 0.9998), (0.5, 0.9998)] {
        with_sphere(poisson, |patch, grid, gross| {
            let of = |part: f64| {
                let stroke = strokes(Amplitude::Force(part * MU * LOAD), 4);
                patch.frets(grid(24), &stroke)
            };
            let held = of(part).unwrap().cycle;
            assert!((held.amplitude[1] / (part * MU * LOAD) - 1.0).abs() < 1e-5);
            assert!(held.amplitude[0] > 0.97 * gross && held.amplitude[0] < 2.0 * gross);
            assert!(
                poisson == 0.0 || held.stuck == 0.0,
                "{poisson}: {}",
                held.stuck
            );
            match of(1.001) {
                Err(StrokeError::Fretting(FrettingError::Slides { limit, .. })) => {
                    assert!((limit / (MU * LOAD) - 1.0).abs() < 1e-6, "{limit}");
                }
                other => panic!("{other:?}"),
            }
        });
    }
}
