//! The energy ledger: what was put in, what is stored, what was dissipated, and what does not add up.

use crate::laws::Totals;
use serde::{Deserialize, Serialize};

/// Energies since the start (J; per metre of depth in 2D).
///
/// With theta = 1/2 the balance closes to rounding and to the solver's tolerance:
/// kinetic + potential + elastic + fracture + friction + impact + adhesion + viscous + correction
/// + scheme + carried
/// - external work = initial energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy now.
    pub kinetic: f64,
    /// Potential energy in gravity now, zero at the start.
    pub potential: f64,
    /// Energy stored in bonds and in dynamical systems now.
    pub elastic: f64,
    /// Released by damage.
    pub fracture: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by impacts.
    pub impact: f64,
    /// Spent against cohesion without opening.
    pub adhesion: f64,
    /// Dissipated by damping of bonds and in dynamical systems.
    pub viscous: f64,
    /// Given by taking overlaps out, negative; see `solver.correction` and `solver.projection`.
    pub correction: f64,
    /// Dissipated by the scheme, (theta - 1/2) |v+ - v|_M^2; zero at theta = 1/2.
    pub scheme: f64,
    /// Kinetic energy that bodies had when they were taken out of the scene.
    pub carried: f64,
    /// Work of imposed forces and motions.
    pub external_work: f64,
    /// What does not add up.
    pub residual: f64,
    /// Kinetic energy at the start.
    pub initial_kinetic: f64,
    /// Largest scale the balance has seen: the work done or the energy held.
    pub scale: f64,
}

/// What the bodies did over one step (J).
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyWork {
    /// Change of potential energy.
    pub potential: f64,
    /// Work of imposed forces and motions.
    pub external: f64,
    /// Dissipated by damping in dynamical systems.
    pub damping: f64,
    /// Dissipated by the scheme.
    pub scheme: f64,
}

impl Energy {
    /// Books one step.
    pub fn book(&mut self, totals: &Totals, work: &BodyWork, kinetic: f64, elastic: f64) {
        self.kinetic = kinetic;
        self.elastic = elastic;
        self.potential += work.potential;
        self.external_work += work.external;
        self.scheme += work.scheme;
        self.fracture += totals.fracture;
        self.friction += totals.friction;
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
        self.residual = held + sinks - self.external_work;
        let seen = [
            self.external_work,
            self.potential,
            self.kinetic,
            self.initial_kinetic,
            sinks,
        ];
        self.scale = seen.iter().fold(self.scale, |m, x| m.max(x.abs()));
    }

    /// Books a move of bodies that leaves their velocities: the energy that it gives against gravity, and the work
    /// of imposed forces along it (J). The step that is booked next closes the balance.
    pub fn lift(&mut self, potential: f64, external: f64) {
        self.potential += potential;
        self.external_work += external;
        self.correction -= potential - external;
    }

    /// Every entry of the balance: name, what it is, value (J; J/m in 2D). The last is the sum of those before it, with external
    /// work and the kinetic energy at the start taken off.
    pub fn entries(&self) -> [(&'static str, &'static str, f64); 14] {
        // Named one by one: a new entry of the ledger does not compile before it is here too.
        let Self {
            kinetic,
            potential,
            elastic,
            fracture,
            friction,
            impact,
            adhesion,
            viscous,
            correction,
            scheme,
            carried,
            external_work,
            initial_kinetic,
            residual,
            scale: _,
        } = *self;
        [
            ("kinetic", "kinetic energy", kinetic),
            ("potential", "potential energy since the start", potential),
            ("elastic", "energy stored in bonds", elastic),
            (
                "fracture",
                "energy released by damage since the start",
                fracture,
            ),
            ("friction", "energy dissipated by friction", friction),
            ("impact", "energy dissipated by impacts", impact),
            (
                "adhesion",
                "energy spent against cohesion without opening",
                adhesion,
            ),
            ("viscous", "energy dissipated by damping of bonds", viscous),
            (
                "correction",
                "energy given by taking overlaps out, negative where it adds energy",
                correction,
            ),
            (
                "scheme",
                "energy dissipated by the time integration; 0 at theta = 1/2",
                scheme,
            ),
            (
                "carried",
                "kinetic energy of bodies when they were taken out",
                carried,
            ),
            (
                "external_work",
                "work of imposed forces and motions",
                external_work,
            ),
            (
                "initial_kinetic",
                "kinetic energy at the start",
                initial_kinetic,
            ),
            (
                "residual",
                "what does not add up: all entries before external_work, less external_work and initial_kinetic",
                residual,
            ),
        ]
    }

    /// Counts an energy (J) that comes and goes within a step for the scale of the balance, which rounds by it.
    pub fn see(&mut self, energy: f64) {
        self.scale = self.scale.max(energy.abs());
    }

    /// Energy turned into heat and surfaces.
    pub fn dissipated(&self) -> f64 {
        self.fracture + self.friction + self.impact + self.adhesion + self.viscous + self.correction
    }

    /// Residual over the largest energy seen; zero when nothing moved.
    pub fn relative_residual(&self) -> f64 {
        if self.scale > 0.0 {
            self.residual.abs() / self.scale
        } else {
            0.0
        }
    }
}
