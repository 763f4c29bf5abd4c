//! A cycle of a friction test, and how its contact slides.

use super::quantity::unit::{ENERGY, FORCE, LOAD_PATH, METRE, ONE, VOLUME, WORD};
use serde::{Deserialize, Serialize};

/// A_t: energy ratio E_d/(4 Q delta) from which the whole contact slides. It is the value for an
/// elastic sphere on a flat at the end of partial slip; S. Fouvry, Ph. Kapsa, L. Vincent,
/// "Quantification of fretting damage", Wear 200 (1996) 186.
pub const TRANSITION_ENERGY_RATIO: f64 = 0.2;

/// Slip ratio from which the whole contact slides, whatever the energy ratio: at the end of partial
/// slip of an elastic sphere it is 0.26, by the loop of K. L. Johnson, Contact Mechanics (1985),
/// 7.4.
pub const SLIDING_SLIP_RATIO: f64 = 0.5;

/// Slope of the tangential force at the ends of the strokes, relative to that after the reversals,
/// below which the whole contact slides: of an elastic sphere it is below only from 0.9999 mu P on.
pub const SLIDING_STIFFNESS: f64 = 0.05;

/// Sliding path relative to the motion of the bodies below which they move together: a free ball on
/// a vibrating plate rolls or is carried.
const TOGETHER: f64 = 1e-3;

/// How a contact slides.
///
/// # Examples
/// ```
/// use fretwork_observe::cycle::SlipRegime;
///
/// // A loop that is a rectangle of height 2 Q and width 2 delta dissipates 4 Q delta: gross slip.
/// let (q, delta) = (30.0, 5e-6);
/// let dissipated: f64 = 2.0 * q * 2.0 * delta;
/// let ratio = dissipated / (4.0 * q * delta);
/// assert_eq!(SlipRegime::of(ratio, 1.0, None), SlipRegime::Gross);
/// // A thin loop: most of the displacement is elastic, and the force rises to its end.
/// assert_eq!(SlipRegime::of(0.05, 0.1, Some(0.6)), SlipRegime::Partial);
/// // An elastic body between the drive and a contact that slides at the end.
/// assert_eq!(SlipRegime::of(0.13, 0.15, Some(0.0)), SlipRegime::Gross);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SlipRegime {
    /// Partial slip: part of the contact sticks in every cycle.
    #[default]
    Partial,
    /// Some cycles have partial slip, some gross slip.
    Mixed,
    /// Gross slip: the whole contact slides in every cycle.
    Gross,
}

impl SlipRegime {
    /// Returns the regime of one cycle by its energy ratio; by its slip ratio where impacts raise
    /// the largest force: a contact that slips over half of the stroke slides; and by the stiffness
    /// at the end of its strokes, where elastic bodies between the drive and the contact make the
    /// loop thin: a force that does not rise any more is that of sliding.
    pub fn of(energy_ratio: f64, slip_ratio: f64, end_stiffness: Option<f64>) -> Self {
        let slides = energy_ratio >= TRANSITION_ENERGY_RATIO
            || slip_ratio >= SLIDING_SLIP_RATIO
            || end_stiffness.is_some_and(|k| k < SLIDING_STIFFNESS);
        match slides {
            true => Self::Gross,
            false => Self::Partial,
        }
    }

    /// Returns the name of the regime.
    pub fn name(self) -> &'static str {
        match self {
            Self::Partial => "partial slip",
            Self::Mixed => "mixed",
            Self::Gross => "gross slip",
        }
    }
}

crate::described! {
    /// One cycle, or the evaluated part of the run if there are no cycles.
    #[derive(Clone, Debug, Default, Serialize, Deserialize)]
    pub struct Cycle {
        /// Number, from 1.
        pub cycle: u32 => ONE,
        /// Whether it was completed.
        pub complete: bool => WORD,
        /// Work of the tangential force over the cycle, E_d.
        pub work: f64 => ENERGY,
        /// Elastic energy that the tangential force stores over the cycle, of a reciprocating
        /// motion: a first cycle from rest stores what the later ones begin with.
        pub stored: f64 => ENERGY,
        /// Mean normal force.
        pub normal_force: f64 => FORCE,
        /// Largest tangential force.
        pub tangential_amplitude: f64 => FORCE,
        /// Length of the sliding path.
        pub path: f64 => METRE,
        /// Length of the path of the body along the axis, or of what it rubs against if that is
        /// longer: they move together where the sliding path is far shorter.
        pub moved: f64 => METRE,
        /// Integral of P |d delta|: normal force times the path.
        pub load_path: f64 => LOAD_PATH,
        /// Coefficient of sliding: |Q|/P while the contact slides, weighted by the path; null in
        /// partial slip.
        pub friction_coefficient: Option<f64> => ONE,
        /// Energetic coefficient: integral of Q d delta over integral of P |d delta|, which counts
        /// the elastic part of the path; 0 if the body was not pressed.
        pub energetic_coefficient: f64 => ONE,
        /// The energetic coefficient by the energy ledger: (dissipation + change of stored energy -
        /// other work of the driven bodies) over the integral of P |d delta|.
        pub friction_from_dissipation: f64 => ONE,
        /// Bonds broken in the cycle.
        pub broken: u64 => ONE,
        /// Damage ratio at the end of the cycle.
        pub damage_ratio: f64 => ONE,
        /// A = E_d / (4 Q delta).
        pub energy_ratio: f64 => ONE,
        /// Half the stroke, delta*.
        pub amplitude: f64 => METRE,
        /// Half of the loop's width at Q = 0, the sliding amplitude.
        pub sliding: f64 => METRE,
        /// Slip ratio: sliding/amplitude, the part of the stroke that is not elastic.
        pub slip_ratio: f64 => ONE,
        /// Mean of |Q|/P at the reversals of the motion.
        pub reversal_ratio: f64 => ONE,
        /// Partial or gross slip, from energy ratio, slip ratio, and the stiffness at the end of
        /// the strokes.
        pub regime: SlipRegime => WORD,
        /// Volume worn off first bodies.
        pub wear_volume: f64 => VOLUME,
        /// Number of further cycles that it represents by a jump: wear and damage are of all of
        /// them, the rest is of one.
        pub jumped: u32 => ONE,
    }
}

impl Cycle {
    /// Returns normal force times the path of slip (J; J/m in 2D) of one cycle of a reciprocating
    /// motion with a coefficient of sliding: E_d without the energy that stays stored, over the
    /// coefficient. It leaves out what is elastic, whatever the shape of the loop.
    pub fn slip_load_path(&self, coefficient: f64) -> f64 {
        (self.work - self.stored) / coefficient
    }

    /// Returns whether the body and what it rubs against move together, without sliding.
    pub fn moves_together(&self) -> bool {
        self.path < TOGETHER * self.moved
    }

    /// Returns whether the motion turns back over more than a twentieth of its path.
    pub fn reverses(&self) -> bool {
        2.0 * self.amplitude < 0.95 * self.path
    }

    /// Returns the largest |Q| over the mean P; `None` if the body was not pressed.
    pub fn peak_ratio(&self) -> Option<f64> {
        (self.normal_force > 0.0).then(|| self.tangential_amplitude / self.normal_force)
    }
}
