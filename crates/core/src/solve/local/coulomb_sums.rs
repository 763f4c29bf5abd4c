//! Sums of the error for problems in which all blocks obey Coulomb's law and rho is 1, as for
//! problems from files: four contacts at a time.

use super::law::{Law, natural};
use crate::solve::error::{Sums, lost};
use pulp::{Arch, Simd, WithSimd};

/// Contacts at a time.
const LANES: usize = 4;

/// One number per contact.
type FourContacts = [f64; LANES];

/// Returns the squared residuals, velocities and impulses; `None` if a block has another law.
pub fn sums<const D: usize>(p: &[[f64; D]], u: &[[f64; D]], laws: &[Law]) -> Option<Sums> {
    Arch::new().dispatch(Pass(p, u, laws))
}

/// [`sums`] for the vector instructions of this machine.
struct Pass<'a, const D: usize>(&'a [[f64; D]], &'a [[f64; D]], &'a [Law]);

impl<const D: usize> WithSimd for Pass<'_, D> {
    type Output = Option<Sums>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> Self::Output {
        let Self(p, u, laws) = self;
        let mut parts = PartialSums::default();
        let (ps, us, all) = (p.as_chunks(), u.as_chunks(), laws.as_chunks());
        for ((p, u), laws) in ps.0.iter().zip(us.0).zip(all.0) {
            parts.add(p, u, laws)?;
        }
        // Contacts without impulse or velocity add nothing.
        let (mut p, mut u) = ([[0.0; D]; LANES], [[0.0; D]; LANES]);
        let mut laws = [Law::Coulomb(0.0); LANES];
        p[..ps.1.len()].copy_from_slice(ps.1);
        u[..us.1.len()].copy_from_slice(us.1);
        laws[..all.1.len()].copy_from_slice(all.1);
        parts.add(&p, &u, &laws)?;
        Some(Sums {
            residual: parts.residual.iter().sum(),
            velocity: parts.velocity.iter().sum(),
            impulse: parts.impulse.iter().sum(),
            ..Sums::default()
        })
    }
}

/// Partial sums.
#[derive(Default)]
struct PartialSums {
    residual: FourContacts,
    velocity: FourContacts,
    impulse: FourContacts,
}

impl PartialSums {
    #[inline(always)]
    fn add<const D: usize>(
        &mut self,
        p: &[[f64; D]; LANES],
        u: &[[f64; D]; LANES],
        laws: &[Law; LANES],
    ) -> Option<()> {
        let mut mu = [0.0; LANES];
        for (mu, law) in mu.iter_mut().zip(laws) {
            let Law::Coulomb(coefficient) = law else {
                return None;
            };
            *mu = *coefficient;
        }
        for i in 0..LANES {
            let squared = |x: &[f64; D]| (0..D).map(|k| x[k] * x[k]).sum::<f64>();
            let left = squared(&natural(&p[i], &u[i], mu[i], 1.0));
            let unseen = lost(p[i][0], u[i][0], mu[i]);
            self.residual[i] += left.max(unseen * unseen);
            self.velocity[i] += squared(&u[i]);
            self.impulse[i] += squared(&p[i]);
        }
        Some(())
    }
}
