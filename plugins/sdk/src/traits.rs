//! The traits that the author of a law implements, for one contact.

use crate::{Conductance, Friction, Intact, Site, Spring, Traction};
use core::ffi::CStr;
use fretwork_abi::FwField;

/// A struct of parameters; declared by [`crate::parameters!`].
pub trait Parameters: Sized {
    /// The schema.
    const FIELDS: &'static [FwField];
    /// Version of the package that declares the parameters.
    const PACKAGE_VERSION: &'static str;
    /// Reads the parameters from values in the order of the schema.
    fn read(values: &[f64]) -> Self;
}

/// An internal variable of a law; its texts are C strings, `c"slip"`.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name, `[a-z][a-z0-9_]*`.
    pub name: &'static CStr,
    /// SI unit, empty for a pure number.
    pub unit: &'static CStr,
    /// One line for the user.
    pub doc: &'static CStr,
    /// Value on a new contact.
    pub initial: f64,
    /// Whether the variable is written to the results.
    pub output: bool,
}

impl Variable {
    /// Returns a variable that is 0 on a new contact and is not written to the results.
    pub const fn new(name: &'static CStr, unit: &'static CStr, doc: &'static CStr) -> Self {
        Self {
            name,
            unit,
            doc,
            initial: 0.0,
            output: false,
        }
    }

    /// Sets the value of the variable on a new contact.
    #[must_use]
    pub const fn starting_at(self, initial: f64) -> Self {
        Self { initial, ..self }
    }

    /// Writes the variable to the results.
    #[must_use]
    pub const fn written(self) -> Self {
        Self {
            output: true,
            ..self
        }
    }
}

/// Description of a law.
pub trait Law: Parameters {
    /// Name of the law in cases, of a-z, 0-9 and `-`.
    const NAME: &'static str;
    /// One line for the user.
    const DOC: &'static str;
    /// Paper or DOI.
    const REFERENCE: &'static str;
    /// The law's own version; that of its package by default.
    const VERSION: &'static str = Self::PACKAGE_VERSION;
    /// Flags of the law, `FLAG_*` of the ABI.
    const FLAGS: u64 = 0;
    /// Internal variables, at most [`crate::ffi::MAX_VARIABLES`].
    const VARIABLES: &'static [Variable] = &[];

    /// The fracture energy (J/m^2) that a bond dissipates under slow monotonic loading at this
    /// angle from the normal (rad; 0 is mode I, pi/2 mode II), if the law declares one. `fretwork
    /// law certify` checks it.
    fn fracture_energy(&self, _angle: f64) -> Option<f64> {
        None
    }

    /// Checks relations between parameters; their ranges are checked by the host.
    ///
    /// # Errors
    /// A message for the user.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }
}

/// Interpolates linearly from `low` at x = `from` to `high` at x = `to`, with constant values
/// outside.
pub fn ramp(x: f64, [from, to]: [f64; 2], [low, high]: [f64; 2]) -> f64 {
    let share = ((x - from) / (to - from)).clamp(0.0, 1.0);
    (1.0 - share) * low + share * high
}

/// `Err` with a message for the user unless a relation between parameters holds.
///
/// # Errors
/// The message.
pub fn require(holds: bool, message: &str) -> Result<(), String> {
    match holds {
        true => Ok(()),
        false => Err(message.to_owned()),
    }
}

/// Laws of friction, restitution and rolling.
pub trait ContactLaw: Law {
    /// Computes the friction at the start of a step.
    fn friction(&self, site: &Site, state: &[f64]) -> Friction;
    /// The spring of a compliant contact at the start of a step, with `FLAG_COMPLIANT`; `damping`
    /// is [`Self::damping`].
    fn spring(&self, _site: &Site, _state: &[f64], _damping: f64) -> Spring {
        Spring::default()
    }
    /// A value that depends only on the parameters and is computed once per batch for
    /// [`Self::spring`]: the damping ratio.
    fn damping(&self) -> f64 {
        0.0
    }
    /// Updates the internal variables at the end of a step.
    fn commit(&self, _site: &Site, _state: &mut [f64]) {}
}

/// Laws of traction against opening.
pub trait CohesionLaw: Law {
    /// Exponent m of psi = (1 - D)^m psi_0; 0 if damage has no effect.
    const DEGRADATION: f64 = 0.0;
    /// Computes traction and stiffness at the site's opening and damage.
    fn traction(&self, site: &Site, state: &[f64]) -> Traction;
    /// Energy stored at the site's opening and damage (J/m^2): 0 for an attraction without opening.
    fn energy(&self, _site: &Site, _state: &[f64]) -> f64 {
        0.0
    }
    /// Updates the internal variables at the end of a step and returns the damage, which is
    /// unchanged unless the law has `FLAG_BREAKS`. The host keeps it from decreasing.
    fn commit(&self, site: &Site, _state: &mut [f64]) -> f64 {
        site.damage
    }
}

/// Laws of the growth of damage.
pub trait DamageLaw: Law {
    /// Computes the damage at the end of the step from the opening there, and updates the internal
    /// variables. The host keeps the damage from decreasing.
    fn grow(&self, site: &Site, intact: &Intact, state: &mut [f64]) -> f64;
}

/// Laws of wear.
pub trait WearLaw: Law {
    /// Computes the volume removed over the step (m^3), mostly from [`Site::slip`] and
    /// [`Site::friction_work`], and updates the internal variables.
    fn volume(&self, site: &Site, state: &mut [f64]) -> f64;
}

/// Laws of the transport of heat and charge through a contact.
pub trait TransportLaw: Law {
    /// Computes the conductances over the step from the state at its end, and updates the internal
    /// variables. They must not be negative, and must not change if candidate and antagonist are
    /// exchanged.
    fn conductance(&self, site: &Site, state: &mut [f64]) -> Conductance;
}
