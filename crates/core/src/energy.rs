//! The energy ledger of a run: supplied, stored and dissipated energy, and the residual of the
//! balance.

use crate::laws::Totals;
use serde::{Deserialize, Serialize};

/// Name, description and value of an entry of a ledger.
pub type LedgerEntry = (&'static str, &'static str, f64);

/// Lists the entries of a ledger by its fields, except those named first. Every field is named, so
/// that a new one does not compile until it is listed.
macro_rules! entries {
    ($ledger:expr, $($no_entry:ident),+; $($name:ident: $doc:literal,)+) => {{
        let Self { $($name,)+ $($no_entry: _,)+ } = *$ledger;
        [$((stringify!($name), $doc, $name)),+]
    }};
}
pub(crate) use entries;

/// Energies since the start (J; per metre of depth in 2D).
///
/// With theta = 1/2 the balance closes to rounding and to the solver's tolerance: kinetic +
/// potential + elastic + fracture + friction + impact + adhesion + viscous + correction + scheme
/// plus carried minus external work and expansion equals the initial energy.
///
/// Dynamical systems enter the entries of rigid bodies and bonds: their motion in `kinetic`, the
/// energy of their deformation in `elastic`, their weight in `potential`, their damping in
/// `viscous`, forces and motions imposed on them in `external_work`, and their numerical
/// dissipation in `scheme`. The impulses of contacts do work on a system through the velocities of
/// its nodes; this work has no entry of its own, like the work on rigid bodies: summed over both
/// sides of a contact it is the friction, impact and adhesion of the contact, the change of its
/// bond, and the work of the correction. Energy that a system stores when it is added counts as
/// external work, its kinetic energy as initial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy of bodies and dynamical systems now.
    pub kinetic: f64,
    /// Potential energy of bodies and dynamical systems in gravity now, zero at the start.
    pub potential: f64,
    /// Energy stored in bonds, compliant contacts and dynamical systems now.
    pub elastic: f64,
    /// Energy released by damage.
    pub fracture: f64,
    /// Energy dissipated by friction, at contacts of bodies and of dynamical systems.
    pub friction: f64,
    /// Energy dissipated by impacts, of bodies and of nodes of dynamical systems.
    pub impact: f64,
    /// Work done against cohesion without an opening.
    pub adhesion: f64,
    /// Energy dissipated by damping of bonds, compliant contacts and dynamical systems.
    pub viscous: f64,
    /// Work of removing penetrations, negative where energy is added; see `solver.correction` and
    /// `solver.projection`.
    pub correction: f64,
    /// Energy dissipated by the scheme, (theta - 1/2) |v+ - v|_M^2, and for dynamical systems
    /// [`crate::bodies::SystemWork::scheme`]; zero at theta = 1/2 except for nonlinear systems and
    /// for compliant contacts, whose springs are integrated by implicit Euler.
    pub scheme: f64,
    /// Kinetic energy that bodies had when they were removed from the scene.
    pub carried: f64,
    /// Work that bodies do by thermal expansion, taken from their heat.
    pub expansion: f64,
    /// Work of imposed forces and motions, and the energy stored in dynamical systems when they
    /// were added and in compliant contacts at the start.
    pub external_work: f64,
    /// Residual of the balance.
    pub residual: f64,
    /// Kinetic energy at the start, of bodies and dynamical systems.
    pub initial_kinetic: f64,
    /// Largest scale of the balance so far: the work done or the energy held.
    pub scale: f64,
    /// Energy that friction of compliant contacts returned, summed over the steps in which the sum
    /// of their friction work is negative. A law of friction cannot create energy. Rigid contacts
    /// do so only within the error of a step, since their friction work is p_t . u_t.
    pub given_by_friction: f64,
}

/// Work of the bodies over one step (J).
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyWork {
    /// Change of potential energy.
    pub potential: f64,
    /// Work of imposed forces and motions.
    pub external: f64,
    /// Energy dissipated by damping in dynamical systems.
    pub damping: f64,
    /// Energy dissipated by the scheme.
    pub scheme: f64,
    /// Work of thermal expansion.
    pub expansion: f64,
}

impl Energy {
    /// Adds one step to the ledger.
    pub fn add_step(&mut self, totals: &Totals, work: &BodyWork, kinetic: f64, elastic: f64) {
        self.kinetic = kinetic;
        self.elastic = elastic;
        self.potential += work.potential;
        self.external_work += work.external;
        self.expansion += work.expansion;
        self.scheme += work.scheme;
        self.fracture += totals.fracture;
        self.friction += totals.friction;
        self.given_by_friction += (-totals.friction_of_springs).max(0.0);
        self.impact += totals.impact;
        self.adhesion += totals.adhesion;
        self.viscous += totals.viscous + work.damping;
        self.correction += totals.correction;
        let sinks = self.fracture
            + self.friction
            + self.impact
            + self.adhesion
            + self.viscous
            + self.correction
            + self.scheme
            + self.carried;
        let held = self.kinetic - self.initial_kinetic + self.potential + self.elastic;
        self.residual = held + sinks - self.external_work - self.expansion;
        let seen = [
            self.external_work,
            self.expansion,
            self.potential,
            self.kinetic,
            self.initial_kinetic,
            sinks,
        ];
        self.scale = seen.iter().fold(self.scale, |m, x| m.max(x.abs()));
    }

    /// Records a displacement of bodies at constant velocity: the change of potential energy and
    /// the work of imposed forces along it (J). The next recorded step closes the balance.
    pub fn add_projection(&mut self, potential: f64, external: f64) {
        self.potential += potential;
        self.external_work += external;
        self.correction -= potential - external;
    }

    /// Returns every entry of the balance: name, description, value (J; J/m in 2D). The last entry
    /// is the sum of all before expansion, minus expansion, external work and initial kinetic
    /// energy.
    pub fn entries(&self) -> [LedgerEntry; 15] {
        entries!(self, scale, given_by_friction;
            kinetic: "kinetic energy",
            potential: "potential energy since the start",
            elastic: "energy stored in bonds, compliant contacts and deformable bodies",
            fracture: "energy released by damage since the start",
            friction: "energy dissipated by friction",
            impact: "energy dissipated by impacts",
            adhesion: "energy spent against cohesion without opening",
            viscous: "energy dissipated by damping of bonds, compliant contacts and deformable bodies",
            correction: "energy given by taking overlaps out, negative where it adds energy",
            scheme: "energy dissipated by the time integration; 0 at theta = 1/2 without compliant contacts",
            carried: "kinetic energy of bodies when they were removed",
            expansion: "work of thermal expansion, taken from heat",
            external_work: "work of imposed forces and motions",
            initial_kinetic: "kinetic energy at the start",
            residual: "what does not add up: all entries before expansion, less expansion, external_work and initial_kinetic",
        )
    }

    /// Raises the scale of the balance to an energy (J) that is stored and released within one
    /// step, because its rounding error enters the residual.
    pub fn raise_scale(&mut self, energy: f64) {
        self.scale = self.scale.max(energy.abs());
    }

    /// Returns the energy turned into heat and new surfaces.
    pub fn dissipated(&self) -> f64 {
        self.fracture + self.friction + self.impact + self.adhesion + self.viscous + self.correction
    }

    /// Returns the residual divided by the largest energy so far; zero when nothing moved.
    pub fn relative_residual(&self) -> f64 {
        if self.scale > 0.0 {
            self.residual.abs() / self.scale
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The supplied energy is divided equally among all other entries, so that none of them is as
    /// large: the residual is zero, and the scale is the supplied energy.
    #[test]
    fn the_scale_is_the_largest_energy_and_what_adds_up_has_no_residual() {
        let totals = Totals {
            friction: 1.0,
            impact: 1.0,
            adhesion: 1.0,
            viscous: 0.5,
            fracture: 1.0,
            correction: -1.0,
            ..Totals::default()
        };
        // Sinks: friction, impact, adhesion, fracture, viscous 1 each, the correction and the
        // scheme -1 and 1.
        let spent = BodyWork {
            potential: 1.0,
            damping: 0.5,
            scheme: 1.0,
            ..BodyWork::default()
        };
        let all = 5.0 + 3.0;
        let by_forces = BodyWork {
            external: all,
            ..spent
        };
        let by_expansion = BodyWork {
            expansion: all,
            ..spent
        };
        for (work, at_start) in [(by_forces, 0.0), (by_expansion, 0.0), (spent, all)] {
            let mut energy = Energy {
                initial_kinetic: at_start,
                ..Energy::default()
            };
            energy.add_step(&totals, &work, 1.0, 1.0);
            assert_eq!((energy.residual, energy.scale), (0.0, all), "{work:?}");
            assert_eq!(energy.dissipated(), 4.0);
            // The entries before expansion sum to the supplied energy.
            let sum: f64 = energy.entries()[..11].iter().map(|e| e.2).sum();
            assert_eq!(sum, energy.external_work + energy.expansion + at_start);
            // A smaller energy does not change the scale, a larger one raises it.
            energy.raise_scale(-1.0);
            assert_eq!(energy.scale, all);
            energy.raise_scale(-16.0);
            energy.residual = -4.0;
            assert_eq!(energy.relative_residual(), 0.25);
        }
    }

    /// Each energy alone raises the scale; without any energy the relative residual is zero.
    #[test]
    fn every_energy_raises_the_scale() {
        let scale = |given: Energy| {
            let mut energy = given;
            let (kinetic, elastic) = (energy.kinetic, energy.elastic);
            energy.add_step(&Totals::default(), &BodyWork::default(), kinetic, elastic);
            energy.scale
        };
        let zero = Energy::default();
        assert_eq!((scale(zero), zero.relative_residual()), (0.0, 0.0));
        let entries: [fn(&mut Energy) -> &mut f64; 13] = [
            |e| &mut e.external_work,
            |e| &mut e.expansion,
            |e| &mut e.potential,
            |e| &mut e.kinetic,
            |e| &mut e.initial_kinetic,
            |e| &mut e.fracture,
            |e| &mut e.friction,
            |e| &mut e.impact,
            |e| &mut e.adhesion,
            |e| &mut e.viscous,
            |e| &mut e.correction,
            |e| &mut e.scheme,
            |e| &mut e.carried,
        ];
        for (x, entry) in entries
            .iter()
            .flat_map(|entry| [(3.0, entry), (-3.0, entry)])
        {
            let mut given = zero;
            *entry(&mut given) = x;
            assert_eq!(scale(given), 3.0, "{given:?}");
        }
    }

    /// A body is lifted by h at constant velocity by a force equal to its weight: the balance is
    /// closed.
    #[test]
    fn a_projection_takes_its_work_from_the_correction() {
        let mut energy = Energy::default();
        energy.add_projection(2.0, 0.5);
        energy.add_step(&Totals::default(), &BodyWork::default(), 0.0, 0.0);
        assert_eq!((energy.potential, energy.external_work), (2.0, 0.5));
        assert_eq!((energy.correction, energy.residual), (-1.5, 0.0));
    }
}
