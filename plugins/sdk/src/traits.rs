//! The traits that the author of a law implements, for one contact.

use core::ffi::CStr;
use fretwork_abi::FwField;

/// A struct of parameters; declared by [`crate::parameters!`].
pub trait Parameters: Sized {
    /// The schema.
    const FIELDS: &'static [FwField];
    /// Version of the package that declares it.
    const PACKAGE_VERSION: &'static str;
    /// From values in the order of the schema.
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
    /// Write it to the results.
    pub output: bool,
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
    /// `FLAG_*` of the ABI.
    const FLAGS: u64 = 0;
    /// Internal variables, at most [`crate::border::MOST_VARIABLES`].
    const VARIABLES: &'static [Variable] = &[];

    /// The fracture energy (J/m^2) that a bond dissipates under slow monotonic loading at this angle from the
    /// normal (rad; 0 is mode I, pi/2 mode II), if the law declares one: checked by `fretwork law certify`.
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

/// Input of a law for one contact. Vectors are (n, t1, t2), SI units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Site {
    /// Gap (m), positive when open.
    pub gap: f64,
    /// Area (m^2).
    pub area: f64,
    /// Reduced radius (m).
    pub radius: f64,
    /// Time since the contact formed (s).
    pub age: f64,
    /// Time for which it has carried a compressive impulse without interruption (s).
    pub pressed: f64,
    /// Bond elongation (m).
    pub opening: [f64; 3],
    /// Rotation of the bond (rad): twist about n, bending about t1 and t2; in two dimensions the second is
    /// that about the axis out of the plane. Zero without `FLAG_MOMENT`.
    pub rotation: [f64; 3],
    /// Relative velocity (m/s).
    pub velocity: [f64; 3],
    /// Impulse (N s).
    pub impulse: [f64; 3],
    /// Damage D; 1 without a bond.
    pub damage: f64,
    /// Overlap (m), with `FLAG_COMPLIANT`: at the start of a step an estimate of that at its end, for which the law gives
    /// force and stiffness; at the end of a step that which is there.
    pub overlap: f64,
    /// Effective mass along the normal (kg; kg/m in 2D), with `FLAG_COMPLIANT` at the start of a step; 0 if neither body can
    /// move.
    pub effective_mass: f64,
    /// Force of the tangential spring along t1 and t2 (N; N/m in 2D), with `FLAG_COMPLIANT`; positive where the candidate was displaced
    /// along them.
    pub spring_t: [f64; 2],
    /// The same at the start of the step, in commit (N; N/m in 2D).
    pub spring_before_t: [f64; 2],
    /// Temperature of the contact (K) at the start of the step, where the case computes heat; 0 elsewhere.
    pub temperature: f64,
    /// Temperatures of candidate and antagonist there (K).
    pub temperatures: [f64; 2],
    /// Thermal conductivity of the pair, 2 k1 k2/(k1 + k2) (W/(m K)); as `temperature`.
    pub conductivity: f64,
    /// Electrical resistivity of the pair, (rho1 + rho2)/2 (ohm m); 0 where no current flows.
    pub resistivity: f64,
    /// Time step (s).
    pub h: f64,
    /// Theta of the time scheme.
    pub theta: f64,
    /// Time at the start of the step (s).
    pub time: f64,
    /// 2 or 3.
    pub dimension: u32,
}

impl Site {
    /// Norm of the tangential opening (m).
    #[inline]
    pub fn tangential_opening(&self) -> f64 {
        self.opening[1].hypot(self.opening[2])
    }

    /// Normal opening if positive, otherwise zero (m).
    #[inline]
    pub fn normal_opening(&self) -> f64 {
        self.opening[0].max(0.0)
    }

    /// Compressive force (N; N/m in 2D), zero in tension.
    #[inline]
    pub fn force(&self) -> f64 {
        if self.h > 0.0 {
            (self.impulse[0] / self.h).max(0.0)
        } else {
            0.0
        }
    }

    /// Half-width (m) of the spot on which the compressive force is carried where surfaces of this hardness (Pa) yield: of a circle, in 2D of a strip.
    pub fn plastic_spot(&self, hardness: f64) -> f64 {
        let area = self.force() / hardness;
        match self.dimension {
            2 => 0.5 * area,
            _ => (area / std::f64::consts::PI).sqrt(),
        }
    }

    /// Conductance of a spot of this half-width (m) between bodies of conductivity `k`: 2 k a of a circle. In 2D that of a strip, counted to the
    /// distance 2 R on either side, R the reduced radius: pi k/(2 asinh(2 R/a)) per metre of depth. 0 without a spot.
    pub fn constriction(&self, k: f64, half_width: f64) -> f64 {
        if half_width <= 0.0 {
            return 0.0;
        }
        match self.dimension {
            2 => {
                // asinh x in fewer operations than that of the library: x is well above 1e-3.
                let x = 2.0 * self.radius / half_width;
                0.5 * std::f64::consts::PI * k / (x + (x * x + 1.0).sqrt()).ln()
            }
            _ => 2.0 * k * half_width,
        }
    }

    /// The same of the electric current, by the resistivity of the pair; 0 where no current flows.
    pub fn electric_constriction(&self, half_width: f64) -> f64 {
        match self.resistivity > 0.0 {
            true => self.constriction(1.0 / self.resistivity, half_width),
            false => 0.0,
        }
    }

    /// Compressive pressure over the area (Pa), zero in tension.
    #[inline]
    pub fn pressure(&self) -> f64 {
        let force = self.h * self.area;
        if force > 0.0 {
            (self.impulse[0] / force).max(0.0)
        } else {
            0.0
        }
    }
}

/// Output of a transport law (per metre of depth in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conductance {
    /// Thermal (W/K).
    pub thermal: f64,
    /// Electrical (S).
    pub electric: f64,
}

/// Output of a contact law.
#[derive(Clone, Copy, Debug, Default)]
pub struct Friction {
    /// Friction coefficient.
    pub mu: f64,
    /// Normal restitution.
    pub restitution_n: f64,
    /// Tangential restitution.
    pub restitution_t: f64,
    /// Tension strength c_n (Pa).
    pub tension_strength: f64,
    /// Shear cohesion c_t (Pa).
    pub shear_cohesion: f64,
    /// Rolling friction length (m).
    pub rolling: f64,
    /// Spinning friction length (m).
    pub spinning: f64,
}

/// The unilateral spring of a compliant contact at the site's overlap (N, N/m; per metre of depth in 2D).
#[derive(Clone, Copy, Debug, Default)]
pub struct Spring {
    /// Compressive force.
    pub force_n: f64,
    /// Its slope with the overlap.
    pub stiffness_n: f64,
    /// Normal damping (N s/m).
    pub damping_n: f64,
    /// Tangential force at the start of the step: the site's `spring_t`, unless the law changes it.
    pub force_t: [f64; 2],
    /// Its slope; 0 for a rigid tangential contact.
    pub stiffness_t: f64,
    /// Its slope when it unloads, where that is another; 0 otherwise. Displacement beyond that of this slope is slip.
    pub unloading_t: f64,
    /// Energy that it holds (J), where that is not T^2/2 over the slope on unloading; 0 otherwise.
    pub energy_t: f64,
    /// Tangential damping (N s/m).
    pub damping_t: f64,
}

impl Spring {
    /// A linear spring of stiffness k along the normal and `ratio` times k along the tangents, with a damping ratio ([`damping_ratio`]).
    pub fn linear(site: &Site, stiffness: f64, ratio: f64, damping: f64) -> Self {
        let k_t = (ratio * stiffness).min(f64::MAX);
        Self {
            force_n: (stiffness * site.overlap).min(f64::MAX),
            stiffness_n: stiffness,
            damping_n: 2.0 * damping * (stiffness * site.effective_mass).sqrt(),
            force_t: site.spring_t,
            stiffness_t: k_t,
            unloading_t: k_t,
            energy_t: 0.0,
            damping_t: 0.0,
        }
    }
}

/// A value that goes linearly from `low` to `high` while x goes from `from` to `to`, and stays so outside.
pub fn ramp(x: f64, [from, to]: [f64; 2], [low, high]: [f64; 2]) -> f64 {
    let share = ((x - from) / (to - from)).clamp(0.0, 1.0);
    (1.0 - share) * low + share * high
}

/// Damping ratio zeta of a linear spring, d = 2 zeta sqrt(k m), whose impacts rebound with this share of the approach velocity when the contact
/// ends as soon as its force is zero, not when the overlap is (T. Schwager, T. Poschel, Granular Matter 9 (2007) 465, eqs. 20 to
/// 22). The same ratio holds for Hertz' spring with d = 2 zeta sqrt(5/6) sqrt(k m) at each overlap, k the slope.
///
/// The ratio of restitution 0 is infinite; that of 1e-6 is given instead.
pub fn damping_ratio(restitution: f64) -> f64 {
    thread_local! {
        // A law asks for the same one in each batch.
        static LAST: std::cell::Cell<(f64, f64)> = const { std::cell::Cell::new((1.0, 0.0)) };
    }
    let (asked, ratio) = LAST.get();
    if asked == restitution {
        return ratio;
    }
    let ratio = find_damping_ratio(restitution);
    LAST.set((restitution, ratio));
    ratio
}

fn find_damping_ratio(restitution: f64) -> f64 {
    let wanted = restitution.clamp(1e-6, 1.0);
    if wanted == 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1e4);
    for _ in 0..60 {
        // Of 1e4 in the end 1e-14.
        let middle = 0.5 * (low + high);
        if rebound(middle) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Restitution of a linear spring with damping ratio zeta.
fn rebound(zeta: f64) -> f64 {
    use std::f64::consts::PI;
    let share = 2.0 * zeta * zeta;
    if zeta < 1.0 {
        let w = (1.0 - zeta * zeta).sqrt();
        let angle = (2.0 * zeta * w).atan2(1.0 - share);
        (-zeta / w * (PI - angle)).exp()
    } else if zeta == 1.0 {
        (-2.0f64).exp()
    } else {
        let w = (zeta * zeta - 1.0).sqrt();
        // (zeta + w)/(zeta - w) = (zeta + w)^2
        (-zeta / w * 2.0 * (zeta + w).ln()).exp()
    }
}

/// Output of a cohesion law: traction at the current opening and damage, with its stiffness.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traction {
    /// Traction (Pa); a positive normal component is attractive.
    pub traction: [f64; 3],
    /// Normal stiffness, tangent or secant (Pa/m).
    pub stiffness_n: f64,
    /// Tangential stiffness (Pa/m).
    pub stiffness_t: f64,
    /// Normal damping (Pa s/m).
    pub damping_n: f64,
    /// Tangential damping (Pa s/m).
    pub damping_t: f64,
    /// Attraction without opening, c_n (Pa).
    pub tension_strength: f64,
    /// Shear cohesion, c_t (Pa).
    pub shear_cohesion: f64,
    /// Moment over the area (N m/m^2) against the rotation, with `FLAG_MOMENT`.
    pub moment: [f64; 3],
    /// Twisting stiffness over the area (N m/m^2 per rad).
    pub stiffness_twist: f64,
    /// Bending stiffness over the area (N m/m^2 per rad).
    pub stiffness_bend: f64,
}

impl Traction {
    /// An attractive force of the contact (N; N/m in 2D), as a stress over its area.
    pub fn attraction(force: f64, site: &Site) -> Self {
        Self {
            // A very small area overflows.
            tension_strength: (force / site.area).min(f64::MAX),
            ..Self::default()
        }
    }

    /// Linear in the opening, with stiffnesses (Pa/m) along the normal and the tangents.
    pub fn linear(site: &Site, stiffness_n: f64, stiffness_t: f64) -> Self {
        let [n, t1, t2] = site.opening;
        Self {
            traction: [stiffness_n * n, stiffness_t * t1, stiffness_t * t2].map(bounded),
            stiffness_n,
            stiffness_t,
            ..Self::default()
        }
    }
}

/// Replaces overflows by finite numbers, since non-finite numbers stop the run.
pub fn bounded(x: f64) -> f64 {
    x.clamp(-f64::MAX, f64::MAX)
}

/// The undamaged bond at this opening, for damage laws.
#[derive(Clone, Copy, Debug, Default)]
pub struct Intact {
    /// Stored energy psi_0 (J/m^2).
    pub energy: f64,
    /// Traction (Pa).
    pub traction: [f64; 3],
    /// Moment over the area (N m/m^2).
    pub moment: [f64; 3],
    /// Exponent m of psi = (1 - D)^m psi_0.
    pub degradation: f64,
}

impl Intact {
    /// The tensile part of the traction: (normal if positive, norm of the tangential part) (Pa).
    #[inline]
    pub fn pull(&self) -> [f64; 2] {
        [
            self.traction[0].max(0.0),
            self.traction[1].hypot(self.traction[2]),
        ]
    }

    /// Norm of the tensile traction (Pa): sqrt(<t_n>^2 + |t_t|^2).
    #[inline]
    pub fn traction_length(&self) -> f64 {
        let [n, t] = self.pull();
        n.hypot(t)
    }

    /// The opening of a linear bond that carries this traction and stores this energy, 2 psi_0/|t| (m).
    /// With one stiffness for both directions it is sqrt(<u_n>^2 + |u_t|^2).
    #[inline]
    pub fn opening(&self) -> f64 {
        let t = self.traction_length();
        if t > 0.0 { 2.0 * self.energy / t } else { 0.0 }
    }

    /// Stiffness |t|/opening (Pa/m); zero without tensile traction.
    #[inline]
    pub fn stiffness(&self) -> f64 {
        let t = self.traction_length();
        if self.energy > 0.0 {
            0.5 * t * t / self.energy
        } else {
            0.0
        }
    }

    /// The damage at which the bond carries `traction`: (1 - D)^m |t_0| = traction; 0 if the undamaged bond
    /// carries less.
    #[inline]
    pub fn damage_for(&self, traction: f64) -> f64 {
        let t = self.traction_length();
        if t <= traction || t <= 0.0 {
            return 0.0;
        }
        let left = (traction / t).max(0.0);
        if self.degradation == 1.0 {
            1.0 - left
        } else {
            1.0 - left.powf(1.0 / self.degradation)
        }
    }

    /// The driving force Y = -d psi/d D = m (1 - D)^(m - 1) psi_0 (J/m^2).
    #[inline]
    pub fn release_rate(&self, damage: f64) -> f64 {
        // The common exponents avoid the power function, which costs more than the rest of a law.
        match self.degradation {
            1.0 => self.energy,
            2.0 => 2.0 * (1.0 - damage) * self.energy,
            m => m * (1.0 - damage).powf(m - 1.0) * self.energy,
        }
    }
}

/// Friction, restitution, rolling.
pub trait ContactLaw: Law {
    /// At the start of a step.
    fn friction(&self, site: &Site, state: &[f64]) -> Friction;
    /// The spring of a compliant contact at the start of a step, with `FLAG_COMPLIANT`; `damping` is
    /// [`Self::damping`].
    fn spring(&self, _site: &Site, _state: &[f64], _damping: f64) -> Spring {
        Spring::default()
    }
    /// A number of its parameters alone that [`Self::spring`] is given, and that is computed once a batch: the damping
    /// ratio.
    fn damping(&self) -> f64 {
        0.0
    }
    /// New internal variables at the end of a step; they are unchanged by default.
    fn commit(&self, _site: &Site, _state: &[f64], _next: &mut [f64]) {}
}

/// Traction against opening.
pub trait CohesionLaw: Law {
    /// m of psi = (1 - D)^m psi_0; 0 if damage does not enter.
    const DEGRADATION: f64;
    /// Traction and stiffness at the site's opening and damage.
    fn traction(&self, site: &Site, state: &[f64]) -> Traction;
    /// Energy stored at the site's opening and damage (J/m^2).
    fn energy(&self, site: &Site, state: &[f64]) -> f64;
    /// New internal variables and, with `FLAG_BREAKS`, D at the end of a step, from the opening at its end.
    /// The host keeps D from decreasing. By default both are unchanged.
    fn commit(&self, site: &Site, _state: &[f64], _next: &mut [f64]) -> f64 {
        site.damage
    }
}

/// Growth of damage.
pub trait DamageLaw: Law {
    /// D at the end of the step, from the opening at its end. The host keeps it from decreasing.
    fn grow(&self, site: &Site, intact: &Intact, state: &[f64], next: &mut [f64]) -> f64;
}

/// Wear: removed volume.
pub trait WearLaw: Law {
    /// Volume removed over the step (m^3), from the slip (m) and the friction work (J) over it.
    fn volume(
        &self,
        site: &Site,
        slip: f64,
        friction_work: f64,
        state: &[f64],
        next: &mut [f64],
    ) -> f64;
}

/// Transport of heat and charge through a contact.
pub trait TransportLaw: Law {
    /// Conductances over the step, from the state at its end, the slip (m) and the friction work (J) over it. They are not negative,
    /// and the same where candidate and antagonist are exchanged.
    fn conductance(
        &self,
        site: &Site,
        slip: f64,
        friction_work: f64,
        state: &[f64],
        next: &mut [f64],
    ) -> Conductance;
}
