//! Tests of bonds that open along straight lines between mode I and mode II. Their largest traction
//! lies on the envelope of the law's reference, and the work of separation is the energy of the
//! reference for that mode.

use crate::cohesion::{
    camanho_davila::CamanhoDavila, tvergaard_hutchinson::TvergaardHutchinson,
    xu_needleman::XuNeedleman,
};
use crate::damage::{
    exponential_softening::ExponentialSoftening, linear_softening::LinearSoftening, mac::MacDamage,
    trapezoidal::Trapezoidal,
};
use fretwork_law::{CohesionLaw, DamageLaw, Intact, Parameters, Site};
use std::f64::consts::{E, SQRT_2};

/// Angles from the normal (degrees).
const ANGLES: [f64; 5] = [0.0, 20.0, 45.0, 70.0, 90.0];
const STEPS: u32 = 100_000;

/// Returns the largest normal and shear traction at one time, by their norm (Pa), and the work
/// (J/m^2).
#[derive(Default)]
struct Pulled {
    peak: [f64; 2],
    work: f64,
}

/// Opens a bond along a line at an angle; `at` returns the traction, normal and shear, at an
/// opening in these directions.
fn pull(angle: f64, reach: f64, mut at: impl FnMut([f64; 2]) -> [f64; 2]) -> Pulled {
    let (s, c) = angle.to_radians().sin_cos();
    let (mut out, mut last) = (Pulled::default(), [0.0; 2]);
    for k in 1..=STEPS {
        let u = reach * f64::from(k) / f64::from(STEPS);
        let t = at([c * u, s * u]);
        out.work += 0.5 * ((last[0] + t[0]) * c + (last[1] + t[1]) * s) * reach / f64::from(STEPS);
        if t[0].hypot(t[1]) > out.peak[0].hypot(out.peak[1]) {
            out.peak = t;
        }
        last = t;
    }
    out
}

/// Opens a bond under a cohesion law that breaks without a damage law.
fn of_cohesion<L: CohesionLaw + Parameters>(values: &[f64], angle: f64, reach: f64) -> Pulled {
    let law = L::read(values);
    let mut site = Site::default();
    pull(angle, reach, |[n, t]| {
        site.opening = [n, 0.6 * t, 0.8 * t];
        site.damage = law.commit(&site, &mut []);
        let [n, t1, t2] = law.traction(&site, &[]).traction;
        [n, t1.hypot(t2)]
    })
}

/// A damage law on a linear bond whose traction falls with (1 - D)^m.
fn of_damage<L: DamageLaw + Parameters>(
    values: &[f64],
    m: f64,
    k: [f64; 2],
    angle: f64,
    reach: f64,
) -> Pulled {
    let law = L::read(values);
    let mut site = Site {
        h: 1.0,
        ..Site::default()
    };
    pull(angle, reach, |[n, t]| {
        let traction = [k[0] * n, k[1] * t];
        let intact = Intact {
            energy: 0.5 * (traction[0] * n + traction[1] * t),
            traction: [traction[0], traction[1], 0.0],
            degradation: m,
            ..Intact::default()
        };
        site.opening = [n, t, 0.0];
        site.damage = law.grow(&site, &intact, &mut []);
        traction.map(|t| (1.0 - site.damage).powf(m) * t)
    })
}

/// Returns a function that compares values at one angle (degrees).
fn near(angle: f64) -> impl Fn(&str, f64, f64, f64) {
    move |what, found, expected, tolerance| {
        let near = (found / expected - 1.0).abs() < tolerance;
        assert!(
            near,
            "{what} at {angle} degrees: {found:e} for {expected:e}"
        );
    }
}

#[test]
fn mixed_mode_of_cohesion_laws_is_that_of_their_references() {
    const XU: [f64; 4] = [2e6, 1e-6, 1.5e-6, 1e-5];
    const CAMANHO: [f64; 6] = [1e13, 5e6, 8e6, 10.0, 30.0, 1.8];
    const PLATEAU: [f64; 4] = [1e13, 1e6, 5.0, 0.5];
    for angle in ANGLES {
        let near = near(angle);
        let xu = of_cohesion::<XuNeedleman>(&XU, angle, 4e-5);
        near("xu-needleman", xu.work, E * 2e6 * 1e-6, 1e-4);

        let camanho = of_cohesion::<CamanhoDavila>(&CAMANHO, angle, 2e-5);
        let [n, t] = camanho.peak;
        let energy = 10.0 + 20.0 * angle.to_radians().sin().powi(2).powf(1.8);
        near(
            "camanho-davila, envelope",
            (n / 5e6).hypot(t / 8e6),
            1.0,
            1e-3,
        );
        near("camanho-davila", camanho.work, energy, 1e-3);

        let plateau = of_cohesion::<TvergaardHutchinson>(&PLATEAU, angle, 2e-5);
        let [n, t] = plateau.peak;
        near("tvergaard-hutchinson, envelope", n.hypot(t), 1e6, 1e-3);
        near("tvergaard-hutchinson", plateau.work, 5.0, 1e-3);
    }
    // The strengths of Xu and Needleman in pure modes are sigma at delta_n, and sqrt(2 e) sigma
    // delta_n/delta_t at delta_t/sqrt(2).
    let pure = |angle| of_cohesion::<XuNeedleman>(&XU, angle, 2e-5).peak;
    near(0.0)("xu-needleman, strength", pure(0.0)[0], 2e6, 1e-6);
    let shear = SQRT_2 * E.sqrt() * 2e6 / 1.5;
    near(90.0)("xu-needleman, strength", pure(90.0)[1], shear, 1e-6);
}

/// The shear stiffness is half of the normal one and three times it: the traction reaches the
/// strength, and the area is the energy.
#[test]
fn mixed_mode_of_damage_laws_is_that_of_their_references() {
    const STRENGTH: f64 = 3e5;
    const ENERGY: f64 = 0.5;
    for (angle, ratio) in ANGLES.iter().flat_map(|a| [(*a, 0.5), (*a, 3.0)]) {
        let (near, k) = (near(angle), [1e12, ratio * 1e12]);
        let check = |what: &str, Pulled { peak: [n, t], work }: Pulled| {
            near(what, n.hypot(t), STRENGTH, 2e-3);
            near(what, work, ENERGY, 2e-3);
        };
        for m in [1.0, 2.0] {
            let values = [STRENGTH, ENERGY];
            let linear = of_damage::<LinearSoftening>(&values, m, k, angle, 1e-5);
            check("linear-softening", linear);
            let values = [STRENGTH, ENERGY, 1e-4];
            let exponential = of_damage::<ExponentialSoftening>(&values, m, k, angle, 3e-5);
            check("exponential-softening", exponential);
            let values = [STRENGTH, ENERGY, 0.5];
            check(
                "trapezoidal",
                of_damage::<Trapezoidal>(&values, m, k, angle, 1e-5),
            );
        }
        // At the onset psi = w/2 for m = 2; the energy stored at the cut is released too.
        let (w, cut) = (0.1, 1e-3);
        let mac = of_damage::<MacDamage>(&[w, 0.0, cut, 1e30], 2.0, k, angle, 5e-5);
        near("mac", mac.work, w * (1.0 - 0.5 * cut), 2e-3);
    }
}
