//! Error of a solution: the natural map of the De Saxce form, in a scale-free norm.
//!
//! The residual of a contact is a velocity:
//!
//! ```text
//! r_c = (p_c - proj_Kc(p_c - rho_c (u_c + mu_c |u_t,c| e_n))) / rho_c
//! rho_c = 1 / lambda_max(W_cc)
//! ```
//!
//! [`Norm::Velocity`], with Euclidean norms over all contacts:
//!
//! ```text
//! error = |r| / max(|u|, |u_free|)
//! ```
//!
//! The strictest norm: velocities must be right, whatever the load.
//!
//! [`Norm::Balance`]:
//!
//! ```text
//! error = max( |r| / max(|u|, |u_free|, |p/rho|), f^2 )
//! f = |sum_c p_c . r_c| / |v - v_free|_M^2
//! ```
//!
//! The first part is the usual error measure of the literature (whose maximum also contains the
//! impulses), made scale-free. As an average over contacts it can be small before the load has been
//! transmitted through a packing. The second part detects this: f is the unbalanced fraction of the
//! step's work, so that f^2 is the kinetic energy of the part that is not supported, relative to
//! the part that is.
//!
//! A third part, (sum_c |p_c . r_c| / (max(1, N/20) |v - v_free|_M^2))^2 over N contacts, matters
//! in small sets only: where a heavy body rests on light ones, p/rho is far above all velocities,
//! and in a rocking body powers of opposite sign cancel in the sum. The part is the largest over
//! all sets of contacts connected through movable bodies, each with its own N and work
//! ([`super::rocking`]), so that the error of a stack does not depend on other stacks in the scene.
//!
//! [`Norm::Power`], the power of the residuals over that of slip, for contacts that are springs:
//!
//! ```text
//! error = sum_c |p_c . r_c| / sum_c |p_t,c . (u_t,c + s_t,c)|
//! ```
//!
//! `Balance` compares residuals with p/rho, which with scaled inertia is far above the velocities
//! of a slow flow; `Power` compares the power of the residuals with the heat of friction. Where
//! nothing slips, at rest and where sliding reverses, the error of `Balance` times 5e5 takes its
//! place.
//!
//! r_c is the residual of the natural map or [`lost`], whichever is larger. The work of the step is
//! bounded below by sum_c rho_c |u_free,c|^2: where no load is transmitted, the work itself is an
//! error. It contains the work on the compliance of contacts, sum_c c |p_c|^2, as W does in the
//! matrix form: in a column of springs that holds itself |v - v_free|_M^2 vanishes.
//!
//! For bodies that move fast together, and for impulses that hold each other, the relative
//! velocities are rounding errors; those below the rounding of the body velocities, or of the
//! impulses where that exceeds all free velocities, count as zero. Impulses that leave nothing but
//! rounding of the velocities are no solution, see [`Sums::lost_in_rounding`].
//!
//! Where contacts act on dynamical systems (finite elements, half-spaces) the error is at least
//! that of their single tractions, see [`super::traction`], times the default tolerance of the norm
//! over 1e-3: with the default tolerances each traction is accurate to 1e-3 of the largest.
//!
//! The error does not change when a scene is scaled in length, mass or time.
//!
//! [`Norm::Field`], the error measure of the literature (`fc3d_compute_error` of Siconos) for
//! problems from files, with rho = 1:
//!
//! ```text
//! error = |r| / max(|u|, |u_free|, |p|)
//! ```
//!
//! It adds impulses and velocities and therefore depends on units. Solvers also enforce two
//! conditions that it does not contain: [`lost`], and |r| / max(|u|, |u_free|) where that exceeds
//! one half; without the latter a problem without a solution would be "solved" by unbounded
//! impulses.

use crate::lanes::{Lane, Mask};
use serde::{Deserialize, Serialize};

/// How the residual is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Norm {
    /// Residuals relative to velocities and impulses of the contacts, combined with the global
    /// balance of work.
    #[default]
    Balance,
    /// Residuals relative to the current velocities.
    Velocity,
    /// Power of the residuals relative to that of friction: the relative error of the heat of slip
    /// in a step.
    Power,
    /// The error measure of the literature, for problems from files.
    #[serde(skip)]
    Field,
}

impl Norm {
    /// The bound on the error of a case without `tolerance`: 1e-4 of velocities or forces, half of
    /// the heat of slip. (Absolute values of the residuals' power are summed; of the net error of
    /// friction it is a bound by far: `docs/dev/sensitivity.md`.)
    pub fn default_tolerance(self) -> f64 {
        match self {
            Self::Power => 0.5,
            Self::Balance | Self::Velocity | Self::Field => 1e-4,
        }
    }

    /// Returns the formula, for reports.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Balance => {
                "max(|r|/max(|u|, |u_free|, |p/rho|), (sum p.r / |v - v_free|_M^2)^2, (sum |p.r| / (max(1, N/20) |v - v_free|_M^2))^2 of each connected set), r = (p - proj_K(p - rho (u + mu |u_t| n)))/rho"
            }
            Self::Velocity => {
                "|r|/max(|u|, |u_free|), r = (p - proj_K(p - rho (u + mu |u_t| n)))/rho"
            }
            Self::Power => {
                "sum |p.r| / sum |p_t.(u_t + s_t)|, or 5e5 times the error of Balance where that is less; r = (p - proj_K(p - rho (u + mu |u_t| n)))/rho"
            }
            Self::Field => "|r|/max(|u|, |u_free|, |p|), r = p - proj_K(p - (u + mu |u_t| n))",
        }
    }
}

/// Returns the violation of Signorini's law that the natural map does not detect: it shrinks u_n <
/// 0 by 1 + mu^2 where the contact slides, so that with a large mu even a zero impulse would pass
/// for a solution. This is the missing part of min(p_n/rho, u_n), which is 0 in Signorini's law.
#[inline(always)]
pub fn lost<L: Lane>(p_n: L, u_n: L, mu: L) -> L {
    let squared = (mu * mu).least(L::all(f64::MAX));
    p_n.least(u_n) * (squared / (L::all(1.0) + squared))
}

/// Returns the squared residual of a contact: the larger of the natural map's and [`lost`].
#[inline(always)]
pub fn residual<L: Lane>(natural: L, p_n: L, u_n: L, mu: L) -> L {
    let most = p_n.least(u_n);
    // The result cannot exceed this bound, which is rarely above the natural residual; this saves
    // the division.
    let enough = (most * most).at_most(natural);
    if enough.all() {
        return natural;
    }
    let lost = lost(p_n, u_n, mu);
    L::select(enough, natural, natural.greatest(lost * lost))
}

/// Returns the residual relative to the velocities alone where it is of order one, which detects
/// unbounded impulses of a problem without a solution.
pub fn unbounded(residual: f64) -> f64 {
    if residual > 0.5 { residual } else { 0.0 }
}

/// Error of single tractions that corresponds to the default tolerances.
const TRACTION: f64 = 1e-3;
/// Error of single tractions below which it counts as zero, whatever the tolerance.
const FINEST: f64 = 1e-6;
/// Squared relative rounding error of a relative velocity.
pub(super) const ROUNDINGS: f64 = 256.0 * f64::EPSILON * f64::EPSILON;

/// Number of contacts of a set up to which the sum of absolute powers of the residuals has the
/// bound of their sum. In larger sets the bound grows in proportion to the number, which a packing
/// in two or three dimensions does not reach.
const MAX_ABSOLUTE_POWER_SET: f64 = 20.0;

/// Error of [`Norm::Power`] over that of [`Norm::Balance`] where nothing slips: 0.5 corresponds to
/// 1e-6.
const AT_REST: f64 = 5e5;

/// Reference values for the residual.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    /// |u_free|^2 (m^2/s^2).
    pub free: f64,
    /// Sum of rho |u_free|^2 (J).
    pub energy: f64,
    /// Squared rounding error of all relative velocities (m^2/s^2): residuals below it count as
    /// zero.
    pub noise: f64,
    /// |v - v_free|_M^2, and the work on the compliance of contacts (J).
    pub work: f64,
    /// Number of contacts.
    pub contacts: usize,
}

impl Scale {
    /// Adds the contributions of other contacts.
    pub(super) fn add(&mut self, other: &Self) {
        self.free += other.free;
        self.energy += other.energy;
        self.noise += other.noise;
        self.work += other.work;
        self.contacts += other.contacts;
    }
}

/// Errors of a solution, independent of the norm that decides on convergence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorParts {
    /// Force balance: the unbalanced share of the step's work, |sum p.r| / |v - v_free|_M^2.
    pub force_balance: f64,
    /// Velocity: the residual velocities over those of the contacts, |r| / max(|u|, |u_free|).
    pub velocity: f64,
    /// Contact law: the error of [`Norm::Power`], the energy of the residuals over the heat of
    /// slip.
    pub contact_law: f64,
    /// Heat of slip, sum |p_t.(u_t + s_t)| (J).
    pub slip_energy: f64,
    /// Energy of the residuals, |sum p.r| (J).
    pub residual_energy: f64,
}

/// Contribution of a contact to the convergence test.
#[derive(Clone, Copy, Debug, Default)]
pub struct Residual<L = f64> {
    /// |p - proj(p - rho (u + mu |u_t| n))|^2 / rho^2 (m^2/s^2).
    pub squared: L,
    /// |u|^2 (m^2/s^2).
    pub velocity: L,
    /// |p / rho|^2 (m^2/s^2).
    pub impulse: L,
    /// Power p . r with the residual velocity r (J).
    pub power: L,
    /// |p . r|, or rho |r|^2 where that is larger, as at a contact without the impulse that it
    /// should have (J).
    pub unbalanced: L,
    /// |p_t . (u_t + s_t)|, the work of slip (J).
    pub slip: L,
}

/// Sums over contacts, added in a fixed order that does not depend on the number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Sum of squared residuals (m^2/s^2).
    pub residual: f64,
    /// Sum of squared relative velocities (m^2/s^2).
    pub velocity: f64,
    /// Sum of squared impulses, as velocities |p/rho|^2 (m^2/s^2).
    pub impulse: f64,
    /// Sum of p . r (J).
    pub power: f64,
    /// Sum of |p . r|, or of rho |r|^2 where it is larger (J).
    pub unbalanced: f64,
    /// Sum of |p_t . (u_t + s_t)| (J).
    pub slip: f64,
    /// Largest squared residual (m^2/s^2).
    pub worst: f64,
    /// Index of the contact with that residual, in the order of the iteration.
    pub worst_at: usize,
    /// Error of single tractions on dynamical systems, see [`super::traction`], and the squared
    /// residual behind it (m^2/s^2).
    pub traction: [f64; 2],
}

impl Sums {
    /// Adds one contact.
    #[inline(always)]
    pub fn add(&mut self, r: &Residual, at: usize) {
        self.add_moment(r);
        if r.squared > self.worst {
            self.worst = r.squared;
            self.worst_at = at;
        }
    }

    /// Adds a residual that is excluded from the search for the worst contact.
    #[inline(always)]
    pub fn add_moment(&mut self, r: &Residual) {
        self.residual += r.squared;
        self.velocity += r.velocity;
        self.impulse += r.impulse;
        self.power += r.power;
        self.unbalanced += r.unbalanced;
        self.slip += r.slip;
    }

    /// Adds the sums of another range of contacts.
    pub fn merge(&mut self, other: &Self) {
        self.residual += other.residual;
        self.velocity += other.velocity;
        self.impulse += other.impulse;
        self.power += other.power;
        self.unbalanced += other.unbalanced;
        self.slip += other.slip;
        if other.worst > self.worst {
            self.worst = other.worst;
            self.worst_at = other.worst_at;
        }
        if other.traction[0] > self.traction[0] {
            self.traction = other.traction;
        }
    }

    /// Returns the squared rounding error of velocities that follow from the impulses, where it
    /// exceeds all velocities without impulses (`free` as in [`Scale`]); 0 elsewhere, where the
    /// masses of bodies may differ by any factor.
    pub(super) fn rounding(&self, free: f64) -> f64 {
        /// Squared ratio by which it must exceed them.
        const EXCEEDS: f64 = 4.0;
        let rounding = ROUNDINGS * self.impulse;
        if rounding > EXCEEDS * free {
            rounding
        } else {
            0.0
        }
    }

    /// Returns whether the velocities are lost in the rounding of the impulses. The impulses of a
    /// problem without a solution grow until then, as W p of squeezed bodies vanishes. Without
    /// convergence W p may have any value. `free` as in [`Scale`].
    pub fn lost_in_rounding(&self, free: f64, converged: bool) -> bool {
        let rounding = self.rounding(free);
        let moves = self.velocity.max(free) > 0.0;
        let vanishes = 16.0 * rounding > self.velocity || (!converged && free > 0.0);
        moves && rounding > 0.0 && vanishes
    }

    /// Returns the part of the error that needs no sum over bodies.
    fn local(&self, norm: Norm, free: f64) -> f64 {
        over(self.residual.sqrt(), self.against(norm, free))
    }

    /// Returns the reference value of the residual.
    pub fn against(&self, norm: Norm, free: f64) -> f64 {
        match norm {
            Norm::Velocity => self.velocity.max(free),
            Norm::Balance | Norm::Power | Norm::Field => self.velocity.max(free).max(self.impulse),
        }
        .sqrt()
    }

    /// Returns the error; the absolute residual where the reference value is zero.
    pub fn error(&self, norm: Norm, scale: &Scale) -> f64 {
        if self.residual <= scale.noise {
            return 0.0;
        }
        let of_tractions = norm.default_tolerance() / TRACTION * self.traction_error(scale);
        self.error_of_all(norm, scale).max(of_tractions)
    }

    /// The error over all contacts.
    fn error_of_all(&self, norm: Norm, scale: &Scale) -> f64 {
        let local = self.local(norm, scale.free);
        match norm {
            Norm::Velocity => local,
            Norm::Field => local.max(unbounded(over(
                self.residual.sqrt(),
                self.velocity.max(scale.free).sqrt(),
            ))),
            Norm::Balance => self.balance(local, scale).max(self.rocking(scale)),
            Norm::Power if self.slip > 0.0 => {
                (self.unbalanced / self.slip).min(AT_REST * self.balance(local, scale))
            }
            Norm::Power => AT_REST * self.balance(local, scale),
        }
    }

    /// Returns the error of single tractions on dynamical systems, relative to the largest of each
    /// system; 0 where it is at most [`FINEST`], or where the residuals of these contacts are
    /// within the rounding of velocities.
    fn traction_error(&self, scale: &Scale) -> f64 {
        let [error, residual] = self.traction;
        if residual <= scale.noise || error <= FINEST {
            return 0.0;
        }
        error
    }

    /// Returns the parts of the error.
    pub fn parts(&self, scale: &Scale) -> ErrorParts {
        if self.residual <= scale.noise {
            return ErrorParts {
                slip_energy: self.slip,
                ..ErrorParts::default()
            };
        }
        ErrorParts {
            force_balance: over(self.power.abs(), scale.work.max(scale.energy)),
            velocity: self.local(Norm::Velocity, scale.free),
            contact_law: self.error_of_all(Norm::Power, scale),
            slip_energy: self.slip,
            residual_energy: self.power.abs(),
        }
    }

    /// Returns the third part of the error in the norm Balance.
    pub(super) fn rocking(&self, scale: &Scale) -> f64 {
        let allowed = (scale.contacts as f64 / MAX_ABSOLUTE_POWER_SET).max(1.0);
        over(self.unbalanced, allowed * scale.work.max(scale.energy)).powi(2)
    }

    /// Returns the first two parts of the error in the norm Balance. Where no load is transmitted
    /// the work itself is an error, relative to the upper bound of the contacts' work.
    fn balance(&self, local: f64, scale: &Scale) -> f64 {
        local.max(over(self.power, scale.work.max(scale.energy)).powi(2))
    }
}

fn over(x: f64, scale: f64) -> f64 {
    if scale > 0.0 { x / scale } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of unbalanced work is its squared share of the work; above
    /// [`MAX_ABSOLUTE_POWER_SET`] contacts its bound grows in proportion to their number.
    #[test]
    fn more_contacts_may_rock_more() {
        let sums = Sums {
            unbalanced: 6.0,
            ..Sums::default()
        };
        for (times, error) in [(0.5, 4.0), (1.0, 4.0), (2.0, 1.0), (3.0, 4.0 / 9.0)] {
            let scale = Scale {
                work: 3.0,
                energy: 2.0,
                contacts: (times * MAX_ABSOLUTE_POWER_SET) as usize,
                ..Scale::default()
            };
            assert!((sums.rocking(&scale) - error).abs() < 1e-15, "{times}");
        }
    }

    /// The power of residuals is compared with that of slip. Where nothing or little slips, a power
    /// of 1e-3 of the work gives 0.5, the default tolerance: its square times [`AT_REST`].
    #[test]
    fn the_power_of_residuals_is_compared_with_slip() {
        let scale = Scale {
            work: 1.0,
            contacts: 1,
            ..Scale::default()
        };
        for (slip, error) in [(2.0, 5e-4), (0.0, 0.5), (1e-3, 0.5)] {
            let sums = Sums {
                power: 1e-3,
                unbalanced: 1e-3,
                slip,
                ..Sums::default()
            };
            let found = sums.error_of_all(Norm::Power, &scale);
            assert!((found - error).abs() < 1e-15, "{slip}: {found}");
        }
    }

    /// Velocities are lost if they are less than sixteen roundings of impulses that have grown to
    /// 1e20 m/s; velocities of ordinary impulses are not lost.
    #[test]
    fn velocities_drown_in_the_rounding_of_their_impulses() {
        let sums = |impulse: f64| Sums {
            impulse: impulse * impulse,
            velocity: 1.0,
            ..Sums::default()
        };
        assert!(sums(1e20).lost_in_rounding(1.0, true));
        assert!(!sums(1.0).lost_in_rounding(1.0, true));
        assert!(!sums(0.0).lost_in_rounding(0.0, false));
    }
}
