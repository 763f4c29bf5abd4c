//! Fracture energy of a bond under any law: the value that the law declares, or the work of a slow
//! pull to failure.

use super::{Bench, BenchMotion, BenchOutputs};
use crate::laws::{Interface, LawError};
use fretwork_abi::FLAG_BREAKS;

/// First opening of a search (m).
const FIRST: f64 = 1e-13;
/// Largest opening of a search (m).
const LAST: f64 = 1.0;
/// Speed of a slow pull (m/s).
const SLOW: f64 = 1e-6;
/// Ratio of the speeds at which a bond is pulled, and relative difference of the energies above
/// which the law counts as dependent on speed.
const FASTER: f64 = 1e6;
const SAME: f64 = 1e-3;
/// Share of the peak traction below which a bond that does not break counts as broken. At this
/// share the tail of the law MAC has released all but a thousandth of its energy.
const LITTLE: f64 = 1e-5;
/// Steps of a pull up to just beyond its peak.
const STEPS: usize = 2000;

impl Interface {
    /// Returns the fracture energy (J/m^2) that the laws declare for an opening at an angle (rad)
    /// from the normal: the value of the damage law, or of the cohesion law if there is no damage
    /// law. `None` where no value is declared, and where both laws damage the bond.
    pub fn declared_fracture_energy(&self, angle: f64) -> Option<f64> {
        let cohesion = self.cohesion()?;
        let law = match self.damage() {
            Some(_) if cohesion.has(FLAG_BREAKS) => return None,
            Some(damage) => damage,
            None => cohesion,
        };
        law.plugin.fracture_energy(&law.parameters, angle)
    }

    /// Returns whether laws that act on bonds have internal variables, so that the energy to break
    /// a bond depends on its history.
    pub fn bonds_remember(&self) -> bool {
        self.variables_of_bonds().next().is_some()
    }
}

impl Bench {
    /// Returns the work (J/m^2) of opening a new bond slowly, at an angle (rad) from the normal,
    /// until it breaks. All of it is released by damage, or by damping, which is negligible at this
    /// speed. `None` where the bond does not break within 1 m.
    ///
    /// # Errors
    /// The law's error.
    pub fn slow_fracture_energy(&mut self, angle: f64) -> Result<Option<f64>, LawError> {
        self.work_to_break(&Direction::at(angle), SLOW, 0.0)
    }

    /// Breaks a bond whose normal and tangential opening (m), twist and bending (rad) grow in
    /// proportion.
    ///
    /// # Errors
    /// The law's error.
    pub fn slow_fracture_energy_towards(
        &mut self,
        opening: [f64; 2],
        rotation: [f64; 2],
    ) -> Result<Option<f64>, LawError> {
        self.work_to_break(&Direction { opening, rotation }, SLOW, 0.0)
    }

    /// Returns whether the energy to break a new bond depends on neither speed nor pressure, as
    /// tried by pulls in both modes.
    ///
    /// # Errors
    /// The law's error.
    pub fn fracture_energy_is_constant(&mut self) -> Result<bool, LawError> {
        for angle in [0.0, std::f64::consts::FRAC_PI_2] {
            let to = Direction::at(angle);
            let Some(slow) = self.work_to_break(&to, SLOW, 0.0)? else {
                continue;
            };
            let pressure = self.peak(&to)?;
            for (speed, pressure) in [(SLOW * FASTER, 0.0), (SLOW, pressure)] {
                let other = self.work_to_break(&to, speed, pressure)?;
                if !other.is_some_and(|w| (w / slow - 1.0).abs() < SAME) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Returns the largest traction of a slow pull (Pa).
    fn peak(&mut self, to: &Direction) -> Result<f64, LawError> {
        let pull = self.pull(coarse(), to, SLOW, 0.0)?;
        Ok(pull.peak)
    }

    fn work_to_break(
        &mut self,
        to: &Direction,
        speed: f64,
        pressure: f64,
    ) -> Result<Option<f64>, LawError> {
        let search = self.pull(coarse(), to, speed, pressure)?;
        let (Some(broken), true) = (search.broken, search.peak > 0.0) else {
            return Ok(None);
        };
        let near = 1.06 * search.peak_at;
        let steps = STEPS as f64;
        let rise = (1..=STEPS).map(|k| near * k as f64 / steps);
        let ratio = (1.06 * broken / near).max(1.0);
        let rest = (1..=STEPS).map(|k| near * ratio.powf(k as f64 / steps));
        let fine = self.pull(rise.chain(rest), to, speed, pressure)?;
        Ok(fine.broken.map(|_| fine.work))
    }

    /// Opens a new bond through a list of openings (m) until it breaks.
    fn pull(
        &mut self,
        openings: impl Iterator<Item = f64>,
        to: &Direction,
        speed: f64,
        pressure: f64,
    ) -> Result<BondPull, LawError> {
        let mut state = [self.fresh()];
        let mut pull = BondPull::default();
        let (mut before, mut carried) = (0.0, 0.0);
        for u in openings {
            let ([n, t], [twist, bend]) = (to.opening, to.rotation);
            let opening = [u * n, u * t, 0.0];
            let motion = BenchMotion {
                opening,
                rotation: [u * twist, u * bend, 0.0],
                gap: opening[0],
                pressure,
                ..BenchMotion::default()
            };
            let answer = self.step(&mut state, &[motion], (u - before) / speed)?[0];
            let traction = to.along(&answer);
            pull.work += 0.5 * (traction + carried) * (u - before);
            if traction > pull.peak {
                (pull.peak, pull.peak_at) = (traction, u);
            }
            (before, carried) = (u, traction);
            if answer.damage >= 1.0 || (pull.peak > 0.0 && traction < LITTLE * pull.peak) {
                pull.broken = Some(u);
                break;
            }
        }
        Ok(pull)
    }
}

/// Direction of a pull: normal and tangential opening, twist and bending, per unit of the path
/// length. For an opening of unit length the path length is the opening.
#[derive(Clone, Copy, Debug)]
struct Direction {
    opening: [f64; 2],
    rotation: [f64; 2],
}

impl Direction {
    /// Returns an opening without rotation, at an angle (rad) from the normal.
    fn at(angle: f64) -> Self {
        Self {
            opening: [angle.cos(), angle.sin()],
            rotation: [0.0; 2],
        }
    }

    /// Returns the traction along the opening plus the moment along the rotation: work per unit of
    /// the path length (J/m^2).
    fn along(&self, answer: &BenchOutputs) -> f64 {
        let ([n, t], [twist, bend]) = (self.opening, self.rotation);
        answer.traction[0] * n
            + answer.traction[1] * t
            + answer.moment[0] * twist
            + answer.moment[1] * bend
    }
}

/// A pull.
#[derive(Clone, Copy, Debug, Default)]
struct BondPull {
    /// Work (J/m^2).
    work: f64,
    /// Largest traction (Pa), and the opening at which it occurs (m).
    peak: f64,
    peak_at: f64,
    /// Opening at which the bond broke (m).
    broken: Option<f64>,
}

/// Returns openings over all scales.
fn coarse() -> impl Iterator<Item = f64> {
    let steps = ((LAST / FIRST).ln() / 1.05f64.ln()).ceil() as i32;
    (0..=steps).map(|k| FIRST * 1.05f64.powi(k))
}
