//! Characteristic scales of a bond under any law: stiffness, strength, and the openings at peak
//! traction and at failure, found by driving new bonds on the bench from 0.1 pm to 1 m.

use super::{Bench, BenchMotion};
use crate::laws::LawError;

/// First opening of a search (m).
const FIRST: f64 = 1e-13;

/// Largest opening of a search (m).
const LAST: f64 = 1.0;

/// Fraction of the peak traction below which a bond counts as broken.
const LITTLE: f64 = 0.01;

/// Response of a bond to one mode of opening.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mode {
    /// Slope of the traction at the origin (Pa/m).
    pub stiffness: f64,
    /// Largest traction (Pa) and the opening at which it occurs (m); `None` where traction rises to
    /// the end of the search.
    pub peak: Option<(f64, f64)>,
    /// Opening (m) at which damage reaches 1, or beyond which the traction stays below a hundredth
    /// of the peak; `None` where neither happens.
    pub broken: Option<f64>,
}

/// The scales of a bond.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BondScale {
    /// Normal opening.
    pub normal: Mode,
    /// Tangential opening without pressure.
    pub shear: Mode,
}

/// Direction of opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OpeningDirection {
    /// Motion along the normal.
    Normal,
    /// Motion along a tangent.
    Shear,
}

impl OpeningDirection {
    fn motion(self, opening: f64) -> BenchMotion {
        let k = usize::from(self == Self::Shear);
        let mut motion = BenchMotion::default();
        motion.opening[k] = opening;
        motion.gap = motion.opening[0];
        motion
    }
}

/// A point of a path: opening (m), traction in its direction (Pa), damage.
type PathPoint = (f64, f64, f64);

impl Bench {
    /// Returns the scales of a bond that is opened at a given speed (m/s); `None` if the law makes
    /// no bonds.
    ///
    /// # Errors
    /// The law's error.
    pub fn scale(&mut self, speed: f64) -> Result<Option<BondScale>, LawError> {
        if !self.law().opens() {
            return Ok(None);
        }
        Ok(Some(BondScale {
            normal: Mode::find(self, OpeningDirection::Normal, speed)?,
            shear: Mode::find(self, OpeningDirection::Shear, speed)?,
        }))
    }
}

impl Mode {
    fn find(bench: &mut Bench, direction: OpeningDirection, speed: f64) -> Result<Self, LawError> {
        // First a coarse search over all scales, then a fine one around the peak and on to failure.
        let steps = ((LAST / FIRST).ln() / 1.05f64.ln()).ceil() as i32;
        let coarse = (0..=steps).map(|k| FIRST * 1.05f64.powi(k));
        let coarse = path(bench, direction, speed, coarse, true)?;
        let Some(near) = peak(&coarse) else {
            return Ok(Self::default());
        };
        let ends = broken(&coarse);
        let rises = ends.is_none() && near.0 >= 0.9 * LAST;
        let about = if rises { 1e-9 } else { near.0 };
        let points = (1..=200).map(|k| 0.8 * about * f64::from(k) / 200.0);
        let finely = (1..=1000).map(|k| about * (0.8 + 0.5 * f64::from(k) / 1000.0));
        let last = ends.map_or(1.3 * about, |b| 1.1 * b).min(2.0 * LAST);
        let tail = ((last / (1.3 * about)).ln() / 1.005f64.ln())
            .max(0.0)
            .ceil() as i32;
        let tail = (1..=tail).map(|k| 1.3 * about * 1.005f64.powi(k));
        let fine = path(
            bench,
            direction,
            speed,
            points.chain(finely).chain(tail),
            true,
        )?;
        // Two small openings at the same speed have the same damping traction, which cancels in the
        // difference.
        let small = [5e-4, 1e-3].map(|x| x * about);
        let start = path(bench, direction, speed, small.into_iter(), false)?;
        let stiffness = match start[..] {
            [a, b] => (b.1 - a.1) / (b.0 - a.0),
            _ => 0.0,
        };
        Ok(Self {
            stiffness: stiffness.max(0.0),
            peak: peak(&fine).filter(|_| !rises).map(|p| (p.1, p.0)),
            broken: broken(&fine).or(ends).filter(|_| !rises),
        })
    }
}

/// Drives a new bond through a list of openings, optionally stopping at failure.
fn path(
    bench: &mut Bench,
    direction: OpeningDirection,
    speed: f64,
    openings: impl Iterator<Item = f64>,
    to_break: bool,
) -> Result<Vec<PathPoint>, LawError> {
    let mut state = [bench.fresh()];
    let mut points: Vec<PathPoint> = Vec::new();
    let (mut before, mut most) = (0.0, 0.0f64);
    for u in openings {
        let answer = bench.step(&mut state, &[direction.motion(u)], (u - before) / speed)?[0];
        let traction = answer.traction[usize::from(direction == OpeningDirection::Shear)];
        points.push((u, traction, answer.damage));
        most = most.max(traction);
        let done = answer.damage >= 1.0 || (most > 0.0 && traction < LITTLE * most);
        if to_break && done {
            break;
        }
        before = u;
    }
    Ok(points)
}

fn peak(points: &[PathPoint]) -> Option<PathPoint> {
    let carried = points.iter().filter(|p| p.1 > 0.0);
    carried.copied().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns the opening at which a path ended in failure.
fn broken(points: &[PathPoint]) -> Option<f64> {
    let (most, last) = (peak(points)?.1, points.last()?);
    (last.2 >= 1.0 || last.1 < LITTLE * most).then_some(last.0)
}

/// Returns the gap (m) beyond which a law that attracts without bonds pulls with less than a
/// hundredth of its maximum, when opened from contact at a given speed (m/s); `None` where there is
/// no attraction, or where its range is unlimited.
///
/// # Errors
/// The law's error.
pub fn attraction_reach(bench: &mut Bench, speed: f64) -> Result<Option<f64>, LawError> {
    let mut state = [bench.fresh()];
    let touch = BenchMotion {
        pressure: 1e6,
        ..BenchMotion::default()
    };
    let mut most = bench.step(&mut state, &[touch], 1.0)?[0].strength[0];
    let mut gap = FIRST;
    while gap < LAST {
        let motion = OpeningDirection::Normal.motion(gap);
        let pull = bench.step(&mut state, &[motion], 0.05 * gap / speed)?[0].strength[0];
        most = most.max(pull);
        if pull < LITTLE * most {
            return Ok(Some(gap));
        }
        gap *= 1.05;
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path ends in failure at full damage, or where the traction is less than a hundredth of its
    /// peak.
    #[test]
    fn a_path_is_broken_where_it_ends_in_failure() {
        let carries = (1.0, 100.0, 0.0);
        for (last, end) in [
            ((2.0, 50.0, 0.5), None),
            ((2.0, 50.0, 1.0), Some(2.0)),
            ((3.0, 0.5, 0.5), Some(3.0)),
        ] {
            assert_eq!(broken(&[(0.0, 0.0, 0.0), carries, last]), end);
            assert_eq!(peak(&[(0.0, 0.0, 0.0), carries, last]), Some(carries));
        }
        // A bond that never carried a traction cannot fail.
        assert_eq!(broken(&[(1.0, 0.0, 1.0)]), None);
        assert_eq!(broken(&[]), None);
    }
}
