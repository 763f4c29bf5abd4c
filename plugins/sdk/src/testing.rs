//! Checks common to laws of one kind, for the tests of a law.
//!
//! They panic with the values that violate a requirement. `fretwork law certify` makes more tests
//! on the compiled library.

use crate::abi::{FLAG_MOMENT, FLAG_TENSION_ONLY};
use crate::{CohesionLaw, ContactLaw, DamageLaw, Intact, Parameters, Site, WearLaw};
use std::fmt::Debug;

/// Returns the law with the default of every parameter, with the minimum, and with the maximum.
fn extremes<L: Parameters>() -> [L; 3] {
    [0, 1, 2].map(|end| {
        let values = L::FIELDS
            .iter()
            .map(|f| [f.default, f.minimum, f.maximum][end]);
        L::read(&values.collect::<Vec<f64>>())
    })
}

/// A bond under a damage law, whose opening the test prescribes step by step.
#[derive(Clone, Debug)]
pub struct Bond<'a, L> {
    law: &'a L,
    state: Vec<f64>,
    /// Input of the law; its damage is that of the bond.
    pub site: Site,
}

impl<'a, L: DamageLaw> Bond<'a, L> {
    /// Returns a new bond with this damage, in steps of 1 ms.
    pub fn new(law: &'a L, damage: f64) -> Self {
        let site = Site {
            damage,
            h: 1e-3,
            ..Site::default()
        };
        let state = L::VARIABLES.iter().map(|v| v.initial).collect();
        Self { law, state, site }
    }

    /// Opens the bond to a given state and returns its damage there.
    pub fn lead(&mut self, intact: &Intact) -> f64 {
        self.site.damage = self.law.grow(&self.site, intact, &mut self.state);
        self.site.damage
    }

    /// The internal variables.
    pub fn state(&self) -> &[f64] {
        &self.state
    }
}

/// Returns the undamaged bond of a stiffness (Pa/m), opened by `u` (m) along its normal, whose
/// energy decreases with (1 - D)^m.
pub fn opened(stiffness: f64, u: f64, m: f64) -> Intact {
    Intact {
        energy: 0.5 * stiffness * u * u,
        traction: [stiffness * u, 0.0, 0.0],
        degradation: m,
        ..Intact::default()
    }
}

/// Checks for any finite bond and the minimum, default and maximum of every parameter that D is in
/// \[D_i, 1\] and variables are finite.
///
/// # Panics
/// Panics if the law leaves that range.
pub fn damage_stays_in_range<L: DamageLaw + Debug>() {
    let sizes = [0.0, 1e-300, 1e-12, 1e-3, 1.0, 1e5, 1e6, 1e30, 1e300];
    let damages = [0.0, 0.4, 1.0 - 1e-16, 1.0];
    for law in extremes::<L>() {
        for case in 0..9 * 9 * 9 * 4 * 4 {
            let (energy, t, s) = (sizes[case % 9], sizes[case / 9 % 9], sizes[case / 81 % 9]);
            let intact = Intact {
                energy,
                traction: [-t, t, t],
                degradation: [0.5, 1.0, 2.0, 9.0][case / 729 % 4],
                ..Intact::default()
            };
            let site = Site {
                damage: damages[case / 2916],
                h: s,
                ..Site::default()
            };
            let mut state = vec![s; L::VARIABLES.len()];
            let d = law.grow(&site, &intact, &mut state);
            assert!(d >= site.damage && d <= 1.0, "{law:?} {intact:?} {s}: {d}");
            assert!(state.iter().all(|x| x.is_finite()), "{law:?} {intact:?}");
        }
    }
}

/// Checks that damage does not decrease on a random walk of the opening by 0.2 um per step, for
/// bonds of 1e12 and 1e14 Pa/m.
///
/// # Panics
/// Panics if damage decreases or leaves \[0, 1\], or if the path causes no damage.
pub fn damage_never_falls<L: DamageLaw + Default + Debug>() {
    let law = L::default();
    for (k, m) in [1e12, 1e14]
        .into_iter()
        .flat_map(|k| [0.5, 1.0, 2.0].map(|m| (k, m)))
    {
        let (mut seed, mut u) = (1u64, 0.0f64);
        let mut bond = Bond::new(&law, 0.0);
        for _ in 0..2000 {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            u = (u + ((seed >> 33) as f64 / 2f64.powi(31) - 0.5) * 4e-7).abs();
            let intact = Intact {
                traction: [-0.6 * k * u, k * u, 0.0],
                ..opened(k, u, m)
            };
            let d = bond.site.damage;
            let new = bond.lead(&intact);
            assert!(new >= d && new <= 1.0, "{law:?} {m} {u}: {new} after {d}");
        }
        let damaged = bond.site.damage > 0.0 || k < 1e14;
        assert!(damaged, "{law:?}: the path does no damage");
    }
}

/// Response of a bond to monotonic opening.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pull {
    /// Area under the traction (J/m^2).
    pub area: f64,
    /// Largest traction (Pa).
    pub peak: f64,
    /// Damage at the end.
    pub damage: f64,
}

impl Pull {
    /// Checks that the bond is broken, and that its area is this energy (J/m^2) within a relative
    /// error of 1e-4.
    ///
    /// # Panics
    /// Panics if this does not hold.
    pub fn took(&self, energy: f64) {
        assert!((self.area / energy - 1.0).abs() < 1e-4, "{self:?}");
        assert_eq!(self.damage, 1.0);
    }
}

/// Opens a bond of stiffness `k` (Pa/m) and exponent `m` to `reach` (m) by `steps` equal steps
/// along \[0.6, 0, 0.8\].
pub fn pull<L: DamageLaw>(law: &L, k: f64, m: f64, reach: f64, steps: u32) -> Pull {
    let mut bond = Bond::new(law, 0.0);
    open(reach, steps, |u, _| {
        let t = k * u;
        let d = bond.lead(&Intact {
            traction: [0.6 * t, 0.0, 0.8 * t],
            ..opened(k, u, m)
        });
        (d, (1.0 - d).powf(m) * t)
    })
}

/// Makes a [`pull`] test of a cohesion law that breaks without a damage law, along a unit vector
/// (n, t1, t2).
pub fn pull_breaking<L: CohesionLaw>(law: &L, direction: [f64; 3], reach: f64, steps: u32) -> Pull {
    open(reach, steps, |u, d| {
        let site = Site {
            opening: direction.map(|x| x * u),
            damage: d,
            ..Site::default()
        };
        let d = law.commit(&site, &mut []);
        let t = law.traction(&Site { damage: d, ..site }, &[]).traction;
        (d, t.iter().zip(direction).map(|(t, x)| t * x).sum())
    })
}

/// Opens a bond; `at` returns damage and traction from the opening and the previous damage.
fn open(reach: f64, steps: u32, mut at: impl FnMut(f64, f64) -> (f64, f64)) -> Pull {
    let du = reach / f64::from(steps);
    let (mut out, mut last) = (Pull::default(), 0.0);
    for step in 1..=steps {
        let (damage, t) = at(du * f64::from(step), out.damage);
        out.damage = damage;
        out.area += 0.5 * (last + t) * du;
        out.peak = out.peak.max(t);
        last = t;
    }
    out
}

/// Checks that openings that overflow give finite numbers, and that a broken bond has zero traction
/// and energy. An attraction over an area that overflows its stress must be finite.
///
/// # Panics
/// Panics if this does not hold, or if the force is not attractive.
pub fn cohesion_stays_finite<L: CohesionLaw + Default + Debug>() {
    for damage in [0.0, 0.3, 1.0] {
        let (law, state) = (L::default(), vec![1.0; L::VARIABLES.len()]);
        let site = Site {
            opening: [1e300, -1e300, 1e300],
            rotation: [1e300; 3],
            area: 1e300,
            dimension: 2,
            damage,
            ..Site::default()
        };
        let (t, e) = (law.traction(&site, &state), law.energy(&site, &state));
        let finite = t.traction.iter().chain(&t.moment).all(|x| x.is_finite());
        assert!(e.is_finite() && finite, "{law:?} {t:?} {e}");
        let nothing = e == 0.0 && t.traction == [0.0; 3] && t.moment == [0.0; 3];
        assert!(damage < 1.0 || nothing, "{law:?} {t:?} {e}");
    }
    if L::DEGRADATION == 0.0 {
        let [first, _, last] = extremes::<L>();
        for law in [first, last] {
            let site = Site {
                area: 1e-300,
                radius: 1e300,
                dimension: 3,
                ..Site::default()
            };
            let state = vec![1.0; L::VARIABLES.len()];
            let t = law.traction(&site, &state).tension_strength;
            assert!(t.is_finite() && t > 0.0, "{law:?} {t}");
        }
    }
}

/// Checks that traction and moment of a bond are the slopes of its energy along opening and
/// rotation. A bond that acts in tension only must store nothing in compression.
///
/// # Panics
/// Panics if this does not hold.
pub fn traction_is_the_slope_of_the_energy<L: CohesionLaw + Debug>(law: &L) {
    let at = |moved: [f64; 6], damage: f64| Site {
        opening: [moved[0], moved[1], moved[2]],
        rotation: [moved[3], moved[4], moved[5]],
        damage,
        area: 1e-10,
        dimension: 3,
        ..Site::default()
    };
    let tension_only = L::FLAGS & FLAG_TENSION_ONLY != 0;
    let turns = if L::FLAGS & FLAG_MOMENT != 0 {
        1e-2
    } else {
        0.0
    };
    for (normal, damage) in [(2e-7, 0.0), (5e-8, 0.3), (-2e-7, 0.3)] {
        if normal < 0.0 && tension_only {
            let energy = law.energy(&at([normal, 0.0, 0.0, 0.0, 0.0, 0.0], damage), &[]);
            assert_eq!(energy, 0.0, "{law:?}");
            continue;
        }
        let here = [normal, 3e-7, -1e-7, turns, 2.0 * turns, -turns];
        let answer = law.traction(&at(here, damage), &[]);
        let slopes = [answer.traction, answer.moment].concat();
        for k in (0..6).filter(|k| here[*k] != 0.0) {
            let step = 1e-4 * here[k].abs();
            let [less, more] = [-step, step].map(|d| {
                let mut moved = here;
                moved[k] += d;
                law.energy(&at(moved, damage), &[])
            });
            let slope = (more - less) / (2.0 * step);
            let off = (slope - slopes[k]).abs();
            assert!(
                off <= 1e-5 * slopes[k].abs(),
                "{law:?} {k}: {slope} {answer:?}"
            );
        }
    }
}

/// Returns the friction coefficient of a law without internal variables at a velocity (n, t1, t2)
/// (m/s).
pub fn friction_at<L: ContactLaw>(law: &L, velocity: [f64; 3]) -> f64 {
    let site = Site {
        velocity,
        ..Site::default()
    };
    law.friction(&site, &[]).mu
}

/// Returns a contact in 3D under a compressive force (N), over 1 m^2 and a step of 1 s.
pub fn compressed(force: f64) -> Site {
    Site {
        impulse: [force, 0.0, 0.0],
        area: 1.0,
        h: 1.0,
        dimension: 3,
        ..Site::default()
    }
}

/// Checks that friction at any velocity and radius is finite and not negative.
///
/// # Panics
/// Panics if it is not.
pub fn friction_stays_finite<L: ContactLaw + Default + Debug>() {
    let (law, state) = (L::default(), vec![0.0; L::VARIABLES.len()]);
    for v in [0.0, 1e-320, -1e-320, -1e300, f64::MAX, f64::MIN] {
        for radius in [0.0, 1e-320, -1e300, f64::MAX] {
            let site = Site {
                velocity: [v; 3],
                radius,
                ..Site::default()
            };
            let f = law.friction(&site, &state);
            let values = [
                f.mu,
                f.restitution_n,
                f.restitution_t,
                f.rolling,
                f.spinning,
            ];
            let good = values.iter().all(|x| x.is_finite() && *x >= 0.0);
            assert!(good, "{law:?} {v} {radius}: {f:?}");
        }
    }
}

/// Checks that the volume at any area, time step, slip and work is finite and not negative.
///
/// # Panics
/// Panics if it is not.
pub fn wear_stays_finite<L: WearLaw + Default + Debug>() {
    let law = L::default();
    let values = [0.0, 1e-320, -1.0, 1e300, f64::MAX];
    for case in 0..5 * 5 * 5 {
        let site = Site {
            damage: 1.0,
            area: values[case % 5],
            h: values[case / 5 % 5],
            friction_work: values[case / 25],
            ..Site::default()
        };
        let v = law.volume(&site, &mut vec![1.0; L::VARIABLES.len()]);
        assert!(v.is_finite() && v >= 0.0, "{law:?} {site:?}: {v}");
    }
}
