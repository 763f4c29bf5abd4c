//! Running conditions of a fretting contact over load and amplitude of displacement: what sticks,
//! slips in part or slides, the energy of a cycle and wear, and the boundaries between regimes (O.
//! Vingsbo, S. Söderberg, Wear 126, 1988; Z. R. Zhou, L. Vincent, Wear 181-183, 1995).

use crate::fretting::FrettingError;
use crate::normal::NormalError;
use fretwork_elastic::Elasticity;
use serde::Serialize;

/// How a contact frets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Regime {
    /// All but a narrow ring sticks.
    Stick,
    /// Part of the patch sticks, the rest slips.
    PartialSlip,
    /// All of the patch slides in a cycle.
    GrossSlip,
    /// The bodies slide farther than the patch is wide: no place stays covered.
    Reciprocating,
}

impl Regime {
    /// Returns the name of the regime.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::PartialSlip => "partial slip",
            Self::GrossSlip => "gross slip",
            Self::Reciprocating => "reciprocating sliding",
        }
    }
}

/// Where a regime ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Share of the patch that slips in [`Regime::Stick`] at most. A convention: elastic bodies
    /// slip at the edge under the smallest displacement.
    pub ring: f64,
    /// Energy ratio A at the onset of gross slip: 0.2 for a sphere on a flat, which serves for
    /// loops that are measured (S. Fouvry, Ph. Kapsa, L. Vincent, Wear 200, 1996).
    pub energy_ratio: f64,
    /// Amplitude over half of the width of the patch along the motion above which the bodies
    /// slide to and fro.
    pub cover: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            ring: 0.05,
            energy_ratio: 0.2,
            cover: 1.0,
        }
    }
}

/// Conditions under a load and an amplitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Conditions {
    /// Load (N).
    pub load: f64,
    /// Amplitude of displacement (m) and of force (N).
    pub amplitude: [f64; 2],
    /// Amplitude over half of the width of the patch along the motion.
    pub cover: f64,
    /// Share of the patch that never slips.
    pub stuck: f64,
    /// Energy of a cycle (J).
    pub energy: f64,
    /// Pressure times path of slip in a cycle, summed over the patch (N m).
    pub rubbed: f64,
    /// Largest pressure times path of slip of a place (Pa m).
    pub most_rubbed: f64,
    /// Opening of the loop over the amplitude.
    pub slip_ratio: f64,
    /// Volume (m³) and largest depth (m) worn in a cycle by the law, 0 where it has no wear.
    pub worn: [f64; 2],
}

impl Conditions {
    /// Returns A = E_d/(4 Q* delta*).
    pub fn energy_ratio(&self) -> f64 {
        self.energy / (4.0 * self.amplitude[0] * self.amplitude[1])
    }

    /// Returns Q*/P.
    pub fn adhesion(&self) -> f64 {
        self.amplitude[1] / self.load
    }

    /// Returns the regime, with the boundaries under this load.
    pub fn regime(&self, boundaries: &Boundaries, limits: &Limits) -> Regime {
        if self.stuck > 0.0 {
            match self.amplitude[0] <= boundaries.stick {
                true => Regime::Stick,
                false => Regime::PartialSlip,
            }
        } else if self.cover >= limits.cover {
            Regime::Reciprocating
        } else {
            Regime::GrossSlip
        }
    }

    /// Returns the volume worn (m³) and the largest depth (m) in a number of cycles by a wear
    /// coefficient k (1/Pa), dh = k p ds, of bodies whose pressures wear does not change.
    pub fn wear(&self, coefficient: f64, cycles: f64) -> [f64; 2] {
        [self.rubbed, self.most_rubbed].map(|r| coefficient * cycles * r)
    }
}

/// Reason why there are no conditions.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunningError {
    /// The load is not held by pressures.
    #[error("under {load:.4e} N: {source}")]
    Normal {
        /// Load (N).
        load: f64,
        /// Why.
        source: NormalError,
    },
    /// A cycle has no solution.
    #[error("under {load:.4e} N at an amplitude of {displacement:.4e} m: {source}")]
    Fretting {
        /// Load (N).
        load: f64,
        /// Amplitude (m).
        displacement: f64,
        /// Why.
        source: FrettingError,
    },
    /// Without friction everything slips.
    #[error("the coefficient of friction must be positive and finite, got {0}")]
    Friction(f64),
    /// An axis of the map is not made of positive numbers.
    #[error("loads and amplitudes must be positive and finite, got {0}")]
    Axis(f64),
}

/// Refuses a coefficient of friction that is not positive.
///
/// # Errors
/// It is not.
pub(crate) fn check_friction(friction: f64) -> Result<(), RunningError> {
    match friction > 0.0 && friction.is_finite() {
        true => Ok(()),
        false => Err(RunningError::Friction(friction)),
    }
}

/// A contact under one load.
pub trait Loaded {
    /// Returns the conditions at an amplitude of displacement (m), without the slip ratio.
    ///
    /// # Errors
    /// A cycle has no solution.
    fn conditions(&self, displacement: f64) -> Result<Conditions, RunningError>;

    /// Returns the opening of the loop over the amplitude.
    ///
    /// # Errors
    /// A cycle has no solution.
    fn slip_ratio(&self, of: &Conditions) -> Result<f64, RunningError>;

    /// Returns about the displacement at the onset of gross slip (m).
    fn scale(&self) -> f64;

    /// Returns half of the width of the patch along the motion (m).
    fn half_width(&self) -> f64;
}

/// A way to find the conditions of a contact.
pub trait Contacts {
    /// Returns the contact under a load (N).
    ///
    /// # Errors
    /// The load is not held.
    fn under(&self, load: f64) -> Result<Box<dyn Loaded + '_>, RunningError>;
}

/// Amplitudes of displacement (m) under a load at which regimes end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Boundaries {
    /// Load (N).
    pub load: f64,
    /// End of stick.
    pub stick: f64,
    /// Onset of gross slip: nothing sticks.
    pub gross_slip: f64,
    /// Onset of gross slip by the energy ratio.
    pub energy_ratio: f64,
    /// Onset of reciprocating sliding.
    pub reciprocating: f64,
}

/// A map of running conditions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Map {
    /// Conditions by load, and for each by amplitude.
    pub conditions: Vec<Vec<Conditions>>,
    /// Boundaries by load.
    pub boundaries: Vec<Boundaries>,
}

/// Relative error of a boundary.
const BOUNDARY: f64 = 1e-3;
/// Largest number of times that a range is doubled, or halved.
const DOUBLINGS: usize = 60;

/// Shares of the patch that slip, whose rings are wider than cells. The displacement of a narrower
/// ring follows from theirs by a power of the share, the first for a sphere on a flat (Mindlin).
const RINGS: [f64; 2] = [0.2, 0.4];

/// Returns the map over loads (N) and amplitudes of displacement (m).
///
/// # Errors
/// A load is not held, a cycle has no solution, or a number is not positive.
pub fn map(
    contacts: &dyn Contacts,
    loads: &[f64],
    displacements: &[f64],
    limits: &Limits,
) -> Result<Map, RunningError> {
    let axes = loads.iter().chain(displacements);
    if let Some(wrong) = axes.copied().find(|v| !(*v > 0.0 && v.is_finite())) {
        return Err(RunningError::Axis(wrong));
    }
    let mut out = Map::default();
    for load in loads {
        let loaded = contacts.under(*load)?;
        let mut row = Vec::with_capacity(displacements.len());
        for displacement in displacements {
            let mut conditions = loaded.conditions(*displacement)?;
            conditions.slip_ratio = loaded.slip_ratio(&conditions)?;
            row.push(conditions);
        }
        out.conditions.push(row);
        out.boundaries.push(boundaries(&*loaded, *load, limits)?);
    }
    Ok(out)
}

/// Returns the boundaries under a load (N).
///
/// # Errors
/// A cycle has no solution.
pub fn boundaries(
    loaded: &dyn Loaded,
    load: f64,
    limits: &Limits,
) -> Result<Boundaries, RunningError> {
    let of = |passed: &dyn Fn(&Conditions) -> bool| {
        boundary(loaded.scale(), |displacement| {
            Ok(passed(&loaded.conditions(displacement)?))
        })
    };
    let gross_slip = of(&|c| c.stuck <= 0.0)?;
    let slips = |share: f64| of(&|c| 1.0 - c.stuck > share);
    let stick = match limits.ring < RINGS[0] {
        true => {
            let [one, other] = [slips(RINGS[0])?, slips(RINGS[1])?];
            match other.is_finite() {
                true => {
                    let power = (other / one).ln() / (RINGS[1] / RINGS[0]).ln();
                    one * (limits.ring / RINGS[0]).powf(power)
                }
                // Not so much slips under any displacement.
                false => one,
            }
        }
        false => slips(limits.ring)?,
    };
    Ok(Boundaries {
        load,
        stick,
        gross_slip,
        energy_ratio: of(&|c| c.energy_ratio() >= limits.energy_ratio)?,
        reciprocating: (limits.cover * loaded.half_width()).max(gross_slip),
    })
}

/// Returns A at the onset of gross slip of a strip of a length and half-width (m) along the motion,
/// displaced in its middle: 1/(4 K), with K = ln(2 L/a) + 1/2 + nu/(1 - nu), from Cattaneo's force
/// and the compliance of a strip on half-spaces. Of unlike bodies nu/(1 - nu) is the mean, weighted
/// by their compliances (1 - nu)/G.
pub fn strip_transition(bodies: &[Elasticity; 2], length: f64, half_width: f64) -> f64 {
    let sum = |of: fn(&Elasticity) -> f64| bodies.iter().map(of).sum::<f64>();
    let along = sum(|b| (1.0 - b.poisson) / b.shear());
    let ratio = sum(|b| b.poisson / b.shear()) / along;
    0.25 / ((2.0 * length / half_width).ln() + 0.5 + ratio)
}

/// Returns the smallest amplitude at which a condition holds that holds for all larger ones, by
/// bisection about a scale; infinite if it holds nowhere.
///
/// # Errors
/// Those of the condition.
pub fn boundary(
    scale: f64,
    passed: impl Fn(f64) -> Result<bool, RunningError>,
) -> Result<f64, RunningError> {
    let (mut low, mut high) = (scale, scale);
    if passed(scale)? {
        for _ in 0..DOUBLINGS {
            high = low;
            low *= 0.5;
            if !passed(low)? {
                break;
            }
        }
    } else {
        let mut found = false;
        for _ in 0..DOUBLINGS {
            low = high;
            high *= 2.0;
            found = passed(high)?;
            if found {
                break;
            }
        }
        if !found {
            return Ok(f64::INFINITY);
        }
    }
    while high - low > BOUNDARY * high {
        let middle = 0.5 * (low + high);
        match passed(middle)? {
            true => high = middle,
            false => low = middle,
        }
    }
    Ok(0.5 * (low + high))
}
