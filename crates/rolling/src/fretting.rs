//! Cycles of a fretting contact: displacement or force to and fro under a constant load, with the
//! tractions carried from shift to shift.

use crate::fields::{Field, Vector};
use crate::friction::{Cells, Friction};
use crate::motion::Motion;
use crate::surfaces::Surfaces;
use crate::tangential::{TangentialError, Tractions, tangential};

/// A contact that frets. Its pressures stay as they are: tractions of unlike bodies do not change
/// them (L. E. Goodman, Journal of Applied Mechanics 29, 1962).
#[derive(Clone, Copy)]
pub struct Fretting<'a> {
    /// Both surfaces.
    pub surfaces: &'a Surfaces,
    /// Pressure of each cell (Pa).
    pub pressure: &'a [f64],
    /// Law of friction; slip is that of a step.
    pub law: &'a dyn Friction,
    /// Direction of the motion, of length 1.
    pub along: Vector,
    /// Time of a step (s), by which laws of friction tell the velocity of slip.
    pub step: f64,
}

/// Half of the range of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amplitude {
    /// Of the displacement of distant points of the bodies (m).
    Displacement(f64),
    /// Of the tangential force (N).
    Force(f64),
}

/// A closed cycle, from the largest displacement over the smallest one and back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loop {
    /// Displacement of the first body (m) and force that drives it (N), step by step.
    pub points: Vec<[f64; 2]>,
    /// Those of the first loading, where it was followed.
    pub loading: Vec<[f64; 2]>,
    /// Tractions on the first body at the points (Pa).
    pub traction: Vec<Field>,
    /// Largest tractions of the cells at the first point (Pa), where the cycle was followed.
    pub bound: Vec<f64>,
    /// Load (N).
    pub load: f64,
    /// Half of the range of the displacement (m) and of the force (N).
    pub amplitude: [f64; 2],
    /// Half of the width of the loop at no force (m), what is not elastic of the displacement.
    pub opening: f64,
    /// Energy dissipated in the cycle (J), that of slip.
    pub energy: f64,
    /// Energy dissipated in each cell (J/m²).
    pub dissipated: Vec<f64>,
    /// Pressure times the path of slip of each cell (Pa m).
    pub rubbed: Vec<f64>,
    /// Which cells touch and never slip.
    pub sticks: Vec<bool>,
    /// Share of the patch that never slips.
    pub stuck: f64,
    /// Depth worn off each cell (m), or nothing without wear.
    pub worn: Vec<f64>,
    /// Largest slip of a cell in a step (m).
    pub fastest: f64,
    /// Number of Newton's steps, and of iterations of the linear equations.
    pub iterations: [usize; 2],
    /// Whether no step has a branch of lower friction.
    pub unique: bool,
}

/// Reason why there is no cycle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrettingError {
    /// A step has no solution.
    #[error(transparent)]
    Tangential(#[from] TangentialError),
    /// Friction does not hold the force.
    #[error(
        "the contact slides away: friction holds forces below {limit:.6e} N, and {force:.6e} N is asked for; take a lower force, or an amplitude of displacement"
    )]
    Slides {
        /// Wanted (N).
        force: f64,
        /// What all places together carry (N).
        limit: f64,
    },
    /// The shift to a force is not found.
    #[error("no shift gives the force of {wanted:.4e} N: {reached:.4e} N are reached")]
    Force {
        /// Wanted (N).
        wanted: f64,
        /// Reached (N).
        reached: f64,
    },
    /// The amplitude is not positive.
    #[error("the amplitude must be positive and finite, got {0}")]
    Amplitude(f64),
    /// Masing's rule does not hold.
    #[error(
        "friction is not that of the pressure alone, so that Masing's rule does not give the cycle: follow it step by step"
    )]
    Changes,
}

/// Residual of the tractions over the largest bound.
const TOLERANCE: f64 = 1e-7;
/// Error of a force that is sought, over the amplitude, and the largest number of trials.
const FORCE: (f64, usize) = (1e-6, 60);

/// A place of the cycle.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) displacement: f64,
    force: f64,
    found: Tractions,
}

impl Loop {
    /// Returns A = E_d/(4 Q* delta*) (S. Fouvry, Ph. Kapsa, L. Vincent, Wear 200, 1996).
    pub fn energy_ratio(&self) -> f64 {
        self.energy / (4.0 * self.amplitude[0] * self.amplitude[1])
    }

    /// Returns the opening over the amplitude of displacement.
    pub fn slip_ratio(&self) -> f64 {
        self.opening / self.amplitude[0]
    }

    /// Returns Q*/P.
    pub fn adhesion(&self) -> f64 {
        self.amplitude[1] / self.load
    }

    /// Returns the work of the drive in the cycle (J), the area of the loop between its points.
    pub fn work(&self) -> f64 {
        let pairs = self.points.windows(2);
        pairs
            .map(|w| 0.5 * (w[0][1] + w[1][1]) * (w[1][0] - w[0][0]))
            .sum()
    }
}

impl Fretting<'_> {
    /// Returns the load (N).
    pub fn load(&self) -> f64 {
        self.pressure.iter().sum::<f64>() * self.surfaces.grid.area(3)
    }

    /// Follows some cycles after a first loading, each quarter of them in a number of steps, and
    /// returns the last one. The opening is interpolated between points.
    ///
    /// # Errors
    /// A step has no solution, or friction does not hold the force.
    pub fn cycles(
        &self,
        amplitude: Amplitude,
        quarter: usize,
        cycles: usize,
    ) -> Result<Loop, FrettingError> {
        self.law.renew(self.pressure.len());
        let (mut place, loading) = self.first(amplitude, quarter)?;
        let mut out = Loop::default();
        for _ in 0..cycles.max(1) {
            (place, out) = self.cycle(&place, amplitude, quarter)?;
        }
        Ok(Loop { loading, ..out })
    }

    /// Loads a contact at rest, and returns the place at the largest displacement, and the way.
    pub(crate) fn first(
        &self,
        amplitude: Amplitude,
        quarter: usize,
    ) -> Result<(Place, Vec<[f64; 2]>), FrettingError> {
        let parts = quarter.max(1);
        let mut place = self.at_rest();
        let mut way = vec![[0.0; 2]];
        for k in 1..=parts {
            place = self.to(&place, amplitude, k as f64 / parts as f64)?;
            self.law.passed(self.cells(), &place.found.slip);
            way.push([place.displacement, place.force]);
        }
        Ok((place, way))
    }

    /// Follows a cycle from the largest displacement.
    pub(crate) fn cycle(
        &self,
        from: &Place,
        amplitude: Amplitude,
        quarter: usize,
    ) -> Result<(Place, Loop), FrettingError> {
        let parts = quarter.max(1);
        let n = self.pressure.len();
        let mut place = from.clone();
        let mut out = Loop {
            points: vec![[place.displacement, place.force]],
            traction: vec![place.found.traction.clone()],
            bound: place.found.bound.clone(),
            load: self.load(),
            dissipated: vec![0.0; n],
            rubbed: vec![0.0; n],
            sticks: self.pressure.iter().map(|p| *p > 0.0).collect(),
            unique: true,
            ..Loop::default()
        };
        for k in 1..=4 * parts {
            let back = 2 * parts;
            let part = k.abs_diff(back) as f64 / parts as f64 - 1.0;
            place = self.to(&place, amplitude, part)?;
            let worn = self.law.passed(self.cells(), &place.found.slip);
            out.worn.resize(worn.len(), 0.0);
            out.worn.iter_mut().zip(worn).for_each(|(to, w)| *to += w);
            out.points.push([place.displacement, place.force]);
            out.traction.push(place.found.traction.clone());
            out.unique &= place.found.unique;
            (0..2).for_each(|k| out.iterations[k] += place.found.iterations[k]);
            let found = place.found.traction.iter().zip(&place.found.slip);
            for (cell, (p, s)) in found.enumerate() {
                let slipped = s[0].hypot(s[1]);
                out.dissipated[cell] -= p[0] * s[0] + p[1] * s[1];
                out.rubbed[cell] += self.pressure[cell] * slipped;
                out.sticks[cell] &= place.found.sticks[cell];
                out.fastest = out.fastest.max(slipped);
            }
        }
        let range = |k: usize| {
            let values = out.points.iter().map(|p| p[k]);
            let (low, high) = (values.clone(), values);
            0.5 * (high.fold(f64::MIN, f64::max) - low.fold(f64::MAX, f64::min))
        };
        out.amplitude = [range(0), range(1)];
        out.opening = opening(&out.points);
        self.close(&mut out);
        Ok((place, out))
    }

    /// Goes to a part of the amplitude.
    fn to(&self, from: &Place, amplitude: Amplitude, part: f64) -> Result<Place, FrettingError> {
        match amplitude {
            Amplitude::Displacement(size) => {
                checked(size)?;
                self.shifted(from, part * size - from.displacement)
            }
            Amplitude::Force(size) => {
                checked(size)?;
                self.at_force(from, part * size, FORCE.0 * size)
            }
        }
    }

    pub(crate) fn cells(&self) -> Cells<'_> {
        Cells {
            grid: &self.surfaces.grid,
            pressure: self.pressure,
            speed: self.speed(),
        }
    }

    /// Returns the cycle from its first quarter by Masing's rule, each quarter in a number of
    /// steps: on the way back tractions have changed by twice those of a first loading over half of
    /// the way, and slip accordingly.
    ///
    /// The rule holds for Coulomb's friction of one coefficient, constant pressures and tractions
    /// along the motion, where each cell that slips on loading slips back likewise. Tractions
    /// across the motion, which grow with Poisson's ratio and vanish in the sum, break it little.
    ///
    /// # Errors
    /// The loading has no solution, friction does not hold the force, or depends on slip.
    pub fn by_masing(&self, amplitude: Amplitude, quarter: usize) -> Result<Loop, FrettingError> {
        let mut out = self.ruled(amplitude, quarter)?;
        let [displacement, force] = out.amplitude;
        // The force has vanished where a first loading has half of the amplitude.
        let half = self.displacement_under(0.5 * force)?;
        out.opening = (displacement - 2.0 * half).max(0.0);
        Ok(out)
    }

    /// Returns the cycle by Masing's rule, without its opening.
    pub(crate) fn ruled(
        &self,
        amplitude: Amplitude,
        quarter: usize,
    ) -> Result<Loop, FrettingError> {
        if !self.law.constant() {
            return Err(FrettingError::Changes);
        }
        self.law.renew(self.pressure.len());
        let rest = self.at_rest();
        let end = match amplitude {
            Amplitude::Displacement(size) => {
                checked(size)?;
                self.shifted(&rest, size)?
            }
            Amplitude::Force(size) => {
                checked(size)?;
                self.at_force(&rest, size, FORCE.0 * size)?
            }
        };
        // All quarters of the cycle wear as the first loading does.
        let worn = self.law.passed(self.cells(), &end.found.slip);
        let steps = 2 * quarter.max(1);
        let mut loading = Vec::with_capacity(steps + 1);
        loading.push(rest.clone());
        for k in 1..steps {
            let part = end.displacement * k as f64 / steps as f64;
            let mut place = self.shifted_from(&rest, part, loading.last())?;
            place.displacement = part;
            loading.push(place);
        }
        loading.push(end.clone());
        let mut out = Loop {
            load: self.load(),
            amplitude: [end.displacement, end.force],
            worn: worn.into_iter().map(|w| 4.0 * w).collect(),
            iterations: end.found.iterations,
            unique: end.found.unique,
            ..Loop::default()
        };
        for k in 0..=2 * steps {
            // The way back, and from there the way forth, which is the opposite of it.
            let (place, sign) = match k <= steps {
                true => (&loading[k], 1.0),
                false => (&loading[k - steps], -1.0),
            };
            let less = |end: f64, by: f64| sign * (end - 2.0 * by);
            let pairs = end.found.traction.iter().zip(&place.found.traction);
            out.traction.push(
                pairs
                    .map(|(e, p)| [less(e[0], p[0]), less(e[1], p[1])])
                    .collect(),
            );
            out.points.push([
                less(end.displacement, place.displacement),
                less(end.force, place.force),
            ]);
        }
        for (cell, s) in end.found.slip.iter().enumerate() {
            let way = match end.found.sticks[cell] {
                true => 0.0,
                false => 4.0 * s[0].hypot(s[1]),
            };
            out.rubbed.push(way * self.pressure[cell]);
            out.dissipated.push(way * end.found.bound[cell]);
        }
        out.sticks = end.found.sticks;
        self.close(&mut out);
        Ok(out)
    }

    /// Returns the first loading to a displacement (m), and the force (N).
    ///
    /// # Errors
    /// There is no solution.
    pub fn loaded(&self, displacement: f64) -> Result<(Tractions, f64), FrettingError> {
        let place = self.shifted(&self.at_rest(), displacement)?;
        Ok((place.found, place.force))
    }

    /// Returns the displacement (m) at a force (N) in first loading.
    ///
    /// # Errors
    /// There is no solution, or friction does not hold the force.
    pub fn displacement_under(&self, force: f64) -> Result<f64, FrettingError> {
        Ok(self
            .at_force(&self.at_rest(), force, FORCE.0 * force.abs())?
            .displacement)
    }

    /// Returns the displacement (m) over the force (N) of a traction that is spread as pressures
    /// are: the mean over the patch, weighted by them, and the largest. With the force mu P the
    /// last is the displacement at the onset of gross slip, but for tractions across the motion.
    pub fn compliance(&self) -> [f64; 2] {
        let load = self.load();
        let field = self.pressure.iter().map(|p| self.along.map(|a| a * p));
        let moved = self.surfaces.displacement(&field.collect::<Field>(), false);
        let area = self.surfaces.grid.area(3);
        let (mut sum, mut most) = (0.0, 0.0f64);
        for (u, p) in moved.iter().zip(self.pressure).filter(|(_, p)| **p > 0.0) {
            let along = (u[0] * self.along[0] + u[1] * self.along[1]) / load;
            sum += along * p * area / load;
            most = most.max(along);
        }
        [sum, most]
    }

    /// Returns the speed at which a cell passes in a step (m/s), to which laws refer.
    fn speed(&self) -> f64 {
        self.surfaces.grid.size[0] / self.step
    }

    fn at_rest(&self) -> Place {
        let n = self.pressure.len();
        Place {
            displacement: 0.0,
            force: 0.0,
            found: Tractions {
                traction: vec![[0.0; 2]; n],
                slip: vec![[0.0; 2]; n],
                bound: vec![0.0; n],
                sticks: self.pressure.iter().map(|p| *p > 0.0).collect(),
                ..Tractions::default()
            },
        }
    }

    fn shifted(&self, from: &Place, by: f64) -> Result<Place, FrettingError> {
        self.shifted_from(from, by, Some(from))
    }

    fn shifted_from(
        &self,
        from: &Place,
        by: f64,
        guess: Option<&Place>,
    ) -> Result<Place, FrettingError> {
        let motion = Motion::Shift {
            by: self.along.map(|a| a * by),
            from: from.found.traction.clone(),
        };
        let law = (self.law, self.speed());
        let start = guess.map(|g| &g.found.traction[..]);
        let found = tangential(self.surfaces, self.pressure, &motion, law, start, TOLERANCE)?;
        let area = self.surfaces.grid.area(3);
        let sum = |k: usize| found.traction.iter().map(|p| p[k]).sum::<f64>();
        Ok(Place {
            displacement: from.displacement + by,
            force: -(sum(0) * self.along[0] + sum(1) * self.along[1]) * area,
            found,
        })
    }

    /// Returns the place at a force, by regula falsi (Illinois) over the shift.
    fn at_force(&self, from: &Place, target: f64, tolerance: f64) -> Result<Place, FrettingError> {
        let tolerance = tolerance.max(TOLERANCE * self.load());
        let wanted = target - from.force;
        if wanted.abs() <= tolerance {
            return Ok(from.clone());
        }
        let mut low = [0.0, -wanted];
        let mut high = 2.0 * self.compliance()[0] * wanted;
        let mut place = self.shifted(from, high)?;
        let mut before = from.force;
        while (place.force - target) * wanted < 0.0 {
            // Where all slips, slips still turn into the motion, and the force grows up to the sum
            // of all bounds; with falling friction it does not grow.
            if !place.found.sticks.iter().any(|s| *s) {
                let limit = place.found.bound.iter().sum::<f64>() * self.surfaces.grid.area(3);
                let grows = (place.force - before) * wanted.signum() > 0.1 * tolerance;
                if target.abs() > limit - tolerance || !grows {
                    return Err(FrettingError::Slides {
                        force: target.abs(),
                        limit,
                    });
                }
            }
            before = place.force;
            low = [high, place.force - target];
            high *= 2.0;
            place = self.shifted_from(from, high, Some(&place))?;
        }
        let mut high = [high, place.force - target];
        for _ in 0..FORCE.1 {
            if (place.force - target).abs() <= tolerance {
                return Ok(place);
            }
            let by = (low[0] * high[1] - high[0] * low[1]) / (high[1] - low[1]);
            place = self.shifted_from(from, by, Some(&place))?;
            let off = place.force - target;
            if off * high[1] < 0.0 {
                low = high;
            } else {
                low[1] *= 0.5;
            }
            high = [by, off];
        }
        Err(FrettingError::Force {
            wanted: target,
            reached: place.force,
        })
    }

    fn close(&self, out: &mut Loop) {
        out.energy = out.dissipated.iter().sum::<f64>() * self.surfaces.grid.area(3);
        let count = |flags: &mut dyn Iterator<Item = bool>| flags.filter(|f| *f).count() as f64;
        let touching = count(&mut self.pressure.iter().map(|p| *p > 0.0));
        out.stuck = count(&mut out.sticks.iter().copied()) / touching.max(1.0);
    }
}

fn checked(amplitude: f64) -> Result<(), FrettingError> {
    match amplitude > 0.0 && amplitude.is_finite() {
        true => Ok(()),
        false => Err(FrettingError::Amplitude(amplitude)),
    }
}

/// Returns half of the distance of the places at which the force vanishes (m).
fn opening(points: &[[f64; 2]]) -> f64 {
    let pairs = points.windows(2);
    let crossings = pairs.filter(|w| (w[0][1] > 0.0) != (w[1][1] > 0.0));
    let places: Vec<f64> = crossings
        .map(|w| w[0][0] + (w[1][0] - w[0][0]) * w[0][1] / (w[0][1] - w[1][1]))
        .collect();
    match places[..] {
        [one, other, ..] => 0.5 * (one - other).abs(),
        _ => 0.0,
    }
}
