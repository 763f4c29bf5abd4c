//! Checks common to laws of one kind, for the tests of a law.
//!
//! They panic with the values that violate a requirement. `fretwork law certify` tests more, from outside.

use crate::{CohesionLaw, DamageLaw, Intact, Site};
use std::fmt::Debug;

/// For any finite bond and the minimum, default and maximum of every parameter: D in \[D_i, 1\], variables finite.
///
/// # Panics
/// If the law leaves that range.
pub fn damage_stays_in_range<L: DamageLaw + Debug>() {
    let sizes = [0.0, 1e-300, 1e-12, 1e-3, 1.0, 1e5, 1e6, 1e30, 1e300];
    let damages = [0.0, 0.4, 1.0 - 1e-16, 1.0];
    for end in 0..3 {
        let values = L::FIELDS
            .iter()
            .map(|f| [f.default, f.minimum, f.maximum][end]);
        let law = L::read(&values.collect::<Vec<f64>>());
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
            let state = vec![s; L::VARIABLES.len()];
            let mut next = state.clone();
            let d = law.grow(&site, &intact, &state, &mut next);
            assert!(d >= site.damage && d <= 1.0, "{law:?} {intact:?} {s}: {d}");
            assert!(next.iter().all(|x| x.is_finite()), "{law:?} {intact:?}");
        }
    }
}

/// Damage does not decrease on a random walk of the opening by 0.2 um per step, for a bond of 1e12 Pa/m.
///
/// # Panics
/// If it decreases, leaves \[0, 1\], or the path causes no damage.
pub fn damage_never_falls<L: DamageLaw>(law: &L) {
    let (mut seed, mut u) = (1u64, 0.0f64);
    for m in [0.5, 1.0, 2.0] {
        let (mut d, mut state) = (0.0, vec![0.0; L::VARIABLES.len()]);
        for _ in 0..2000 {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            u = (u + ((seed >> 33) as f64 / 2f64.powi(31) - 0.5) * 4e-7).abs();
            let intact = Intact {
                energy: 0.5e12 * u * u,
                traction: [-0.6e12 * u, 1e12 * u, 0.0],
                degradation: m,
                ..Intact::default()
            };
            let site = Site {
                damage: d,
                h: 1e-3,
                ..Site::default()
            };
            let mut next = state.clone();
            let new = law.grow(&site, &intact, &state, &mut next);
            assert!(new >= d && new <= 1.0, "{m} {u}: {new} after {d}");
            (d, state) = (new, next);
        }
        assert!(d > 0.0, "the path does damage");
    }
}

/// Response of a bond to monotonic opening.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pull {
    /// Area under the traction (J/m^2).
    pub area: f64,
    /// Largest traction (Pa).
    pub peak: f64,
    /// D at the end.
    pub damage: f64,
}

/// A bond of stiffness `k` (Pa/m) and exponent `m`, opened to `reach` (m) by `steps` equal steps along
/// \[0.6, 0, 0.8\].
pub fn pull<L: DamageLaw>(law: &L, k: f64, m: f64, reach: f64, steps: u32) -> Pull {
    let mut state = vec![0.0; L::VARIABLES.len()];
    let mut next = state.clone();
    open(reach, steps, |u, d| {
        let t = k * u;
        let intact = Intact {
            energy: 0.5 * t * u,
            traction: [0.6 * t, 0.0, 0.8 * t],
            degradation: m,
            ..Intact::default()
        };
        let site = Site {
            damage: d,
            ..Site::default()
        };
        next.copy_from_slice(&state);
        let d = law.grow(&site, &intact, &state, &mut next);
        state.copy_from_slice(&next);
        (d, (1.0 - d).powf(m) * t)
    })
}

/// As [`pull`], for a cohesion that breaks by itself, along a unit vector (n, t1, t2).
pub fn pull_breaking<L: CohesionLaw>(law: &L, direction: [f64; 3], reach: f64, steps: u32) -> Pull {
    open(reach, steps, |u, d| {
        let site = Site {
            opening: direction.map(|x| x * u),
            damage: d,
            ..Site::default()
        };
        let d = law.commit(&site, &[], &mut []);
        let t = law.traction(&Site { damage: d, ..site }, &[]).traction;
        (d, t.iter().zip(direction).map(|(t, x)| t * x).sum())
    })
}

/// `at` returns damage and traction from the opening and the previous damage.
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

/// Openings that overflow give finite numbers, and a broken bond has zero traction and energy.
///
/// # Panics
/// If this does not hold.
pub fn bond_stays_finite<L: CohesionLaw>(law: &L) {
    for damage in [0.0, 0.3, 1.0] {
        let site = Site {
            opening: [1e300, -1e300, 1e300],
            rotation: [1e300; 3],
            area: 1e300,
            dimension: 2,
            damage,
            ..Site::default()
        };
        let (t, e) = (law.traction(&site, &[]), law.energy(&site, &[]));
        assert!(e.is_finite() && t.traction.iter().chain(&t.moment).all(|x| x.is_finite()));
        assert!(damage < 1.0 || (e == 0.0 && t.traction == [0.0; 3] && t.moment == [0.0; 3]));
    }
}

/// An attraction over an area that overflows its stress is finite.
///
/// # Panics
/// If this does not hold, or the force is not attractive.
pub fn attraction_stays_finite<L: CohesionLaw>(law: &L) {
    let site = Site {
        area: 1e-300,
        radius: 1e300,
        dimension: 3,
        ..Site::default()
    };
    let state = vec![1.0; L::VARIABLES.len()];
    let t = law.traction(&site, &state).tension_strength;
    assert!(t.is_finite() && t > 0.0, "{t}");
}
