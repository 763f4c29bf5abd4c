//! Loops of a sphere on a flat against Mindlin's closed forms (K. L. Johnson, Contact Mechanics,
//! 1985, 7.4; R. D. Mindlin, H. Deresiewicz, Journal of Applied Mechanics 20, 1953).

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{PartialSlip, Solid, effective_modulus, point};
use fretwork_rolling::fretting::{Amplitude, Fretting, FrettingError, Loop};
use fretwork_rolling::{Coulomb, Falling, Surfaces, normal};
use std::f64::consts::PI;

const MU: f64 = 0.6;
const LOAD: f64 = 100.0;
const CURVATURE: f64 = 20.0;

struct Sphere {
    surfaces: Surfaces,
    pressure: Vec<f64>,
    radius: f64,
    slip: PartialSlip,
}

fn sphere(cells: usize, poisson: f64) -> Sphere {
    let solids = [Solid {
        young: 200e9,
        poisson,
    }; 2];
    let hertz = point(LOAD, [CURVATURE; 2], effective_modulus(&solids));
    let body = Elasticity {
        young: 200e9,
        poisson,
        density: 7800.0,
    };
    let half = 1.1 * hertz.along;
    let grid = CellGrid {
        from: [-half; 2],
        size: [2.0 * half / cells as f64; 2],
        cells: [cells; 2],
    };
    let distance: Vec<f64> = (0..grid.len())
        .map(|c| {
            let [x, y] = grid.middle(c);
            0.5 * CURVATURE * (x * x + y * y)
        })
        .collect();
    let surfaces = Surfaces::new(grid, [body; 2], 0.0);
    let pressure = normal(&surfaces, &distance, LOAD, None).unwrap_or_else(|e| panic!("{e}"));
    Sphere {
        surfaces,
        pressure: pressure.pressure,
        radius: hertz.along,
        slip: PartialSlip::of(&hertz, LOAD, MU, &solids),
    }
}

impl Sphere {
    fn frets(&self) -> Fretting<'_> {
        Fretting {
            surfaces: &self.surfaces,
            pressure: &self.pressure,
            law: &Coulomb(MU),
            along: [1.0, 0.0],
            step: 1.0,
        }
    }
}

fn ok(found: Result<Loop, FrettingError>) -> Loop {
    found.unwrap_or_else(|e| panic!("{e}"))
}

fn near(got: f64, expected: f64, relative: f64) {
    assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
}

/// Energy of a cycle of an amplitude d over the displacement at gross slip, over mu P times that
/// displacement: eight times the integral of the loading curve less 4 Q d.
fn energy(d: f64) -> f64 {
    let left = (1.0 - d).max(0.0);
    let force = 1.0 - left.powf(1.5);
    8.0 * (d - 0.4 * (1.0 - left.powf(2.5))) - 4.0 * force * d
}

/// In partial slip step by step, and by Masing's rule: force, energy, opening and stuck area are
/// Mindlin's; the energy is that of Mindlin and Deresiewicz by force too.
#[test]
fn a_loop_is_mindlins() {
    let sphere = sphere(40, 0.0);
    let (frets, unit) = (sphere.frets(), MU * LOAD * sphere.slip.displacement);
    let d: f64 = 0.75;
    let amplitude = Amplitude::Displacement(d * sphere.slip.displacement);
    let share = 1.0 - (1.0 - d).powf(1.5);
    // Opening: the force vanishes where 1 - (1 - u)^(3/2) is half of the amplitude.
    let opening = d - 2.0 * (1.0 - (1.0 - 0.5 * share).powf(2.0 / 3.0));
    let stepped = ok(frets.cycles(amplitude, 4, 1));
    let ruled = ok(frets.by_masing(amplitude, 4));
    for found in [&stepped, &ruled] {
        near(found.amplitude[1], share * MU * LOAD, 0.01);
        near(found.energy, energy(d) * unit, 0.02);
        near(found.opening, opening * sphere.slip.displacement, 0.06);
        near(found.stuck, 1.0 - d, 0.06);
        let dense = found.dissipated.iter().zip(&found.rubbed);
        for (dissipated, rubbed) in dense {
            assert!((dissipated - MU * rubbed).abs() < 1e-3 * ruled.dissipated[0].max(1.0));
        }
        assert_eq!(found.points.len(), 17);
    }
    near(ruled.opening, opening * sphere.slip.displacement, 0.02);
    near(stepped.energy, ruled.energy, 2e-3);
    // Without Poisson's ratio the rule gives the tractions too.
    for (a, b) in stepped.traction.iter().zip(&ruled.traction) {
        let largest = b.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
        for (a, b) in a.iter().zip(b) {
            assert!((a[0] - b[0]).abs() < 1e-2 * largest, "{a:?} {b:?}");
        }
    }
    let forced = ok(frets.by_masing(Amplitude::Force(share * MU * LOAD), 1));
    near(forced.amplitude[0], d * sphere.slip.displacement, 0.02);
    // By force, E = (24/5) mu P delta* (1 - (1 - q)^(5/3) - (5/6) q (1 + (1 - q)^(2/3))).
    let q = share;
    let part = 5.0 * q / 6.0 * (1.0 + (1.0 - q).powf(2.0 / 3.0));
    let closed = 4.8 * (1.0 - (1.0 - q).powf(5.0 / 3.0) - part);
    assert!((closed / energy(d) - 1.0).abs() < 1e-12);
    near(forced.energy, closed * unit, 0.03);
    // The circle that sticks is Cattaneo's.
    let area = forced.stuck * PI * sphere.radius.powi(2);
    near(
        (area / PI).sqrt() / sphere.radius,
        sphere.slip.stuck(q * MU * LOAD),
        0.04,
    );
    let stepped = ok(frets.cycles(Amplitude::Force(share * MU * LOAD), 2, 1));
    near(stepped.amplitude[1], share * MU * LOAD, 1e-5);
    near(stepped.energy, forced.energy, 5e-3);
}

/// In gross slip the loop is that of the limit of partial slip, and a rectangle of height 2 mu P
/// for the rest; its slip ratio and A follow.
#[test]
fn gross_slip_adds_a_rectangle() {
    let sphere = sphere(32, 0.0);
    let (frets, unit) = (sphere.frets(), MU * LOAD * sphere.slip.displacement);
    for d in [1.3, 5.0] {
        let amplitude = Amplitude::Displacement(d * sphere.slip.displacement);
        let ruled = ok(frets.by_masing(amplitude, 2));
        let stepped = ok(frets.cycles(amplitude, 3, 2));
        let expected = (0.8 + 4.0 * (d - 1.0)) * unit;
        assert!((energy(d) * unit / expected - 1.0).abs() < 1e-12);
        for found in [&ruled, &stepped] {
            near(found.energy, expected, 0.02);
            near(found.adhesion(), MU, 1e-5);
            near(found.energy_ratio(), energy(d) / (4.0 * d), 0.02);
            assert_eq!(found.stuck, 0.0);
        }
        let opening = d - 2.0 * (1.0 - 0.5f64.powf(2.0 / 3.0));
        near(ruled.slip_ratio(), opening / d, 0.02);
        near(stepped.energy, ruled.energy, 1e-3);
    }
    let held = frets.by_masing(Amplitude::Force(1.01 * MU * LOAD), 1);
    assert!(
        matches!(held, Err(FrettingError::Slides { .. })),
        "{held:?}"
    );
}

/// At Poisson's ratios of metals, tractions across the motion change a cycle by Masing's rule by
/// less than a hundredth.
#[test]
fn tractions_across_the_motion_break_masings_rule_little() {
    let sphere = sphere(32, 0.3);
    let frets = sphere.frets();
    for d in [0.5, 0.9, 2.0] {
        let amplitude = Amplitude::Displacement(d * sphere.slip.displacement);
        let ruled = ok(frets.by_masing(amplitude, 1));
        let stepped = ok(frets.cycles(amplitude, 8, 1));
        near(ruled.energy, stepped.energy, 0.01);
        near(ruled.amplitude[1], stepped.amplitude[1], 0.01);
        near(stepped.work(), stepped.energy, 0.05);
    }
}

#[test]
fn what_masings_rule_does_not_hold_for_is_refused() {
    let sphere = sphere(16, 0.3);
    let law = Falling {
        at_rest: 0.6,
        kinetic: 0.3,
        half: 1e-6,
        memory: 1e-6,
    };
    let frets = Fretting {
        law: &law,
        ..sphere.frets()
    };
    let amplitude = Amplitude::Displacement(0.8 * sphere.slip.displacement);
    assert_eq!(frets.by_masing(amplitude, 1), Err(FrettingError::Changes));
    let none = sphere.frets().cycles(Amplitude::Displacement(0.0), 1, 1);
    assert_eq!(none, Err(FrettingError::Amplitude(0.0)));
}
