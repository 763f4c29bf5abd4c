//! Patches at the ends of what is asked of them: slender ellipses, incompressible and unlike
//! bodies, no friction and much of it, creepages and speeds over six orders, several contacts.

use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{Kalker, PointPatch, Solid, effective_modulus, point};
use fretwork_rolling::fields::length;
use fretwork_rolling::{
    Coulomb, Creepage, Falling, Friction, NormalError, Patch, PatchError, Rolling, Surfaces, normal,
};

const LOAD: f64 = 75e3;

fn steel(poisson: f64) -> Elasticity {
    Elasticity {
        young: 210e9,
        poisson,
        density: 7850.0,
    }
}

fn solids(bodies: [Elasticity; 2]) -> [Solid; 2] {
    bodies.map(|b| Solid {
        young: b.young,
        poisson: b.poisson,
    })
}

/// Returns curvatures of a patch with semi-axes in a ratio.
fn curvatures(ratio: f64, bodies: [Elasticity; 2]) -> ([f64; 2], PointPatch) {
    let modulus = effective_modulus(&solids(bodies));
    let of = |log: f64| {
        let curvatures = [2.0, 2.0 * log.exp()];
        (curvatures, point(LOAD, curvatures, modulus))
    };
    let (mut low, mut high) = (-12.0, 12.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let found = of(middle).1;
        match found.along / found.across < ratio {
            true => low = middle,
            false => high = middle,
        }
    }
    of(0.5 * (low + high))
}

fn around(half: [f64; 2], cells: usize) -> CellGrid {
    CellGrid {
        from: half.map(|h| -h),
        size: half.map(|h| 2.0 * h / cells as f64),
        cells: [cells; 2],
    }
}

struct Case {
    bodies: [Elasticity; 2],
    curvatures: [f64; 2],
    hertz: PointPatch,
}

impl Case {
    fn new(ratio: f64, bodies: [Elasticity; 2]) -> Self {
        let (curvatures, hertz) = curvatures(ratio, bodies);
        Self {
            bodies,
            curvatures,
            hertz,
        }
    }

    fn rolls(&self, along: f64, law: &dyn Friction, speed: f64, cells: usize) -> Rolling {
        let [a, b] = self.curvatures;
        let distance = move |[x, y]: [f64; 2]| 0.5 * (a * x * x + b * y * y);
        let patch = Patch {
            bodies: self.bodies,
            layer: 0.0,
            distance: &distance,
            load: LOAD,
        };
        let half = [1.1 * self.hertz.along, 1.1 * self.hertz.across];
        let creepage = Creepage {
            along,
            ..Creepage::default()
        };
        let found = patch.rolls(around(half, cells), &creepage, law, speed);
        found.unwrap_or_else(|e| panic!("{along} at {speed}: {e}"))
    }
}

/// Slender patches have the pressure of Hertz; those that are long across the motion consist of
/// strips that creep as Carter's, 1 - (1 - z)² at z = xi/xi_s, xi_s = mu a/R with their own a.
#[test]
fn slender_patches() {
    for ratio in [0.05, 0.3, 3.0, 20.0] {
        let case = Case::new(ratio, [steel(0.3); 2]);
        let slides = case.rolls(0.1, &Coulomb(0.4), 1.0, 32);
        let off = slides.pressure.largest() / case.hertz.pressure - 1.0;
        assert!(off.abs() < 0.01, "{ratio}: {off}");
        assert!((slides.adhesion() / 0.4 - 1.0).abs() < 1e-4, "{ratio}");
        assert!(slides.tractions.unique);
        let along = 0.2 * case.hertz.along * case.curvatures[0];
        let share = |cells| case.rolls(along, &Coulomb(0.4), 1.0, cells).adhesion() / 0.4;
        let coarse = share(32);
        println!("{ratio}: {coarse}");
        assert!((0.1..0.9).contains(&coarse), "{ratio}: {coarse}");
        if ratio == 0.05 {
            let off = [coarse, share(64)].map(|s| s / carters_strips() - 1.0);
            assert!(
                off[0].abs() < 0.015 && off[1].abs() < 0.6 * off[0].abs(),
                "{off:?}"
            );
        }
    }
}

/// Q/(mu P) of strips of half length a sqrt(1 - t²) and load 1 - t² over t = y/b, at half of the
/// creepage of full slip of the middle one, z = 1/(2 sqrt(1 - t²)).
fn carters_strips() -> f64 {
    let count = 10_000;
    let places = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
    let parts = places.map(|t| {
        let z = f64::min(0.5 / (1.0 - t * t).sqrt(), 1.0);
        (1.0 - t * t) * z * (2.0 - z)
    });
    parts.sum::<f64>() / f64::from(count) * 1.5
}

/// Small creepages give Kalker's force, G a b c11 xi, for compressible and incompressible bodies.
#[test]
fn small_creepages_of_bodies_of_any_poisson_number() {
    for poisson in [0.0, 0.25, 0.5] {
        let case = Case::new(1.0, [steel(poisson); 2]);
        let found = case.rolls(1e-6, &Coulomb(0.4), 1.0, 40);
        let c11 = Kalker::new(1.0, poisson).unwrap().c11;
        let expected = steel(poisson).shear() * case.hertz.along * case.hertz.across * c11 * 1e-6;
        let off = found.force[0].abs() / expected - 1.0;
        println!("{poisson}: {off}");
        assert!(off.abs() < 0.03, "{poisson}: {off}");
    }
}

/// Creepages from 1e-6 to 0.5: the force grows to mu P and no further, and in full slip its energy
/// is what slip dissipates.
#[test]
fn creepages_over_six_orders() {
    let case = Case::new(0.8, [steel(0.3); 2]);
    let mut before = 0.0;
    for along in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5] {
        let found = case.rolls(along, &Coulomb(0.4), 1.0, 24);
        let share = found.adhesion() / 0.4;
        assert!(
            share >= before - 1e-6 && share < 1.0 + 1e-6,
            "{along}: {share}"
        );
        before = share;
        // Elastic slip does no work in steady rolling of like bodies, but for an error of the cells
        // that is some of the energy where nearly all sticks.
        let off = found.dissipation / found.t_gamma - 1.0;
        println!("{along}: {share}, {off}");
        assert!(found.dissipation >= 0.0 && off < 0.05, "{along}: {off}");
        assert!(along < 0.1 || off.abs() < 0.01, "{along}: {off}");
    }
    assert!((before - 1.0).abs() < 1e-6);
}

/// Without friction there is no force; with a coefficient of 2 the bodies stick longer, and slide
/// at twice the load.
#[test]
fn no_friction_and_much_of_it() {
    let case = Case::new(1.0, [steel(0.3); 2]);
    let none = case.rolls(0.01, &Coulomb(0.0), 1.0, 24);
    assert_eq!(none.force, [0.0; 2]);
    let much = case.rolls(0.01, &Coulomb(2.0), 1.0, 24);
    let slides = case.rolls(0.3, &Coulomb(2.0), 1.0, 24);
    assert!(much.adhesion() > 1.0 && much.adhesion() < 2.0);
    assert!((slides.adhesion() - 2.0).abs() < 1e-3);
}

/// Steel on a soft incompressible body: pressures and tractions settle, and the force stays below
/// mu P.
#[test]
fn unlike_bodies() {
    let rubber = Elasticity {
        young: 5e9,
        poisson: 0.5,
        density: 1000.0,
    };
    let case = Case::new(1.0, [steel(0.3), rubber]);
    let mut before = 0.0;
    for along in [1e-5, 1e-3, 0.01, 0.1] {
        let found = case.rolls(along, &Coulomb(0.5), 1.0, 24);
        let share = found.adhesion() / 0.5;
        assert!(
            share >= before - 1e-3 && share < 1.0 + 1e-6,
            "{along}: {share}"
        );
        before = share;
    }
    assert!((before - 1.0).abs() < 1e-3, "{before}");
}

/// Friction that falls over 0.01 to 150 m/s: where all slides it is that at the velocity of slip.
#[test]
fn speeds_over_four_orders() {
    let case = Case::new(0.5, [steel(0.28); 2]);
    let law = Falling {
        at_rest: 0.33,
        kinetic: 0.14,
        half: 1.25,
        memory: 3e-6,
    };
    for speed in [0.01, 1.0, 30.0, 150.0] {
        for along in [1e-6, 1e-3, 0.02, 0.5] {
            let found = case.rolls(along, &law, speed, 24);
            let share = found.adhesion();
            assert!(share > 0.0 && share < 0.3301, "{along} at {speed}: {share}");
            let fast = found.tractions.slip.iter().all(|s| s[0].is_finite());
            assert!(fast && found.tractions.residual < 1e-6);
            if along == 0.5 {
                let mu = 0.14 + 0.19 * (-along * speed / 1.25).exp2();
                assert!((share / mu - 1.0).abs() < 0.02, "{speed}: {share} {mu}");
            }
        }
    }
}

/// A groove that is a little wider than the wheel: curvatures of opposite sign, whose sum counts.
#[test]
fn a_wheel_in_a_groove() {
    let bodies = [steel(0.3); 2];
    let curvatures = [1.0 / 0.46, 1.0 / 0.25 - 1.0 / 0.3];
    let hertz = point(LOAD, curvatures, effective_modulus(&solids(bodies)));
    let case = Case {
        bodies,
        curvatures,
        hertz,
    };
    let found = case.rolls(0.01, &Coulomb(0.3), 1.0, 32);
    assert!((found.pressure.largest() / hertz.pressure - 1.0).abs() < 0.01);
    assert!((found.pressure.approach / hertz.approach - 1.0).abs() < 0.01);
}

/// Two crests far from each other carry half of the load each, with the pressure of Hertz under
/// half of the load; bodies of other heights touch at one of them first.
#[test]
fn two_contacts() {
    let bodies = [steel(0.3); 2];
    let load = 10e3;
    let modulus = effective_modulus(&solids(bodies));
    let hertz = point(0.5 * load, [2.0, 10.0], modulus);
    let apart = 12.0 * hertz.across;
    let lift = |higher: f64| {
        move |[x, y]: [f64; 2]| {
            let side = y.abs() - 0.5 * apart;
            let up = if y > 0.0 { higher } else { 0.0 };
            x * x + 5.0 * side * side + up
        }
    };
    let half = [1.3 * hertz.along, 0.5 * apart + 1.4 * hertz.across];
    let grid = CellGrid {
        from: half.map(|h| -h),
        size: [2.0 * half[0] / 24.0, 2.0 * half[1] / 128.0],
        cells: [24, 128],
    };
    let solve = |higher: f64| {
        let distance = lift(higher);
        let patch = Patch {
            bodies,
            layer: 0.0,
            distance: &distance,
            load,
        };
        let creepage = Creepage {
            along: 0.02,
            spin: 0.1,
            ..Creepage::default()
        };
        patch.rolls(grid, &creepage, &Coulomb(0.3), 1.0).unwrap()
    };
    let alike = solve(0.0);
    let off = alike.pressure.largest() / hertz.pressure - 1.0;
    assert!(off.abs() < 0.03, "{off}");
    let side = |found: &Rolling, upper: bool| {
        let cells = (0..grid.len()).filter(|c| (grid.middle(*c)[1] > 0.0) == upper);
        cells.map(|c| found.pressure.pressure[c]).sum::<f64>() * grid.area(3) / load
    };
    assert!((side(&alike, true) - 0.5).abs() < 1e-6);
    let one = solve(0.3 * hertz.approach);
    assert!(side(&one, true) < 0.45 && side(&one, true) > 0.0);
    assert!(length(one.force) <= 0.3 * load * (1.0 + 1e-9));
}

/// What has no solution says so: a patch that leaves its grid, a load that is none, a distance that
/// is no number.
#[test]
fn what_has_no_solution() {
    let bodies = [steel(0.3); 2];
    let grid = around([1e-3; 2], 16);
    let surfaces = Surfaces::new(grid, bodies, 0.0);
    let distance: Vec<f64> = (0..grid.len())
        .map(|c| grid.middle(c).iter().map(|x| x * x).sum())
        .collect();
    assert_eq!(
        normal(&surfaces, &distance, LOAD, None),
        Err(NormalError::Border)
    );
    for load in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = normal(&surfaces, &distance, load, None);
        assert!(matches!(refused, Err(NormalError::Load(_))), "{refused:?}");
    }
    let mut broken = distance;
    broken[7] = f64::NAN;
    assert_eq!(
        normal(&surfaces, &broken, 1.0, None),
        Err(NormalError::Distance(7))
    );
    let flat = |_: [f64; 2]| 0.0;
    let patch = Patch {
        bodies,
        layer: 0.0,
        distance: &flat,
        load: LOAD,
    };
    let refused = patch.rolls(grid, &Creepage::default(), &Coulomb(0.3), 1.0);
    assert!(matches!(
        refused,
        Err(PatchError::Normal(NormalError::Border))
    ));
}
