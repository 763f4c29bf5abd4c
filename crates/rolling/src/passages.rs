//! Profiles that wear as bodies roll over each other many times.
//!
//! Every point of a row passes through the whole row of the patch, so that a passage takes the same
//! depth everywhere along the rolling, the sum over the row of what its cells take, and the profile
//! changes across it. A jump of N passages is implicit: its pressures are those of the bodies that
//! they have worn,
//!
//! ```text
//! e = h + N k_row sum_x p + u_z(p) - delta,    k_row: depth of a passage over sum_x p
//! ```
//!
//! with k_row from the start of the jump. Explicit jumps oscillate where a jump wears more than the
//! elastic approach of a row. A jump is made at once and in two halves; their difference is the
//! error of the halves, which also corrects them to second order.

use crate::extent::Extent;
use crate::fields::{Field, Vector, dot, length};
use crate::friction::{Cells, Friction};
use crate::motion::{Creepage, rigid_slip};
use crate::normal::{NormalError, wearing};
use crate::patch::{Patch, PatchError, balanced};
use crate::profile::Profile;
use crate::pull::{self, Pulled};
use crate::surfaces::Surfaces;
use fretwork_elastic::half_space::CellGrid;
use serde::Serialize;

/// A law of wear.
pub trait Wears {
    /// Returns the depth that goes off in a passage by each cell (m), for slips of the cells (m)
    /// where tractions slip.
    fn worn(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<f64>;
}

/// Depth in proportion to pressure and slip (1/Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Archard(pub f64);

impl Wears for Archard {
    fn worn(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<f64> {
        let pairs = cells.pressure.iter().zip(slip);
        pairs.map(|(p, s)| self.0 * p * length(*s)).collect()
    }
}

/// What stays as profiles wear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// The creepages.
    Creepage(Creepage),
    /// The force on the first body along the rolling (N); its creepage follows from it. The spin
    /// stays.
    Force {
        /// The force.
        force: f64,
        /// The creepage to begin with.
        start: Creepage,
    },
}

/// Two bodies that roll over each other.
pub struct Passages<'a> {
    /// The new bodies under their load.
    pub patch: Patch<'a>,
    /// How they move.
    pub drive: Drive,
    /// Friction.
    pub law: &'a dyn Friction,
    /// Speed of rolling (m/s).
    pub speed: f64,
    /// Wear.
    pub wears: &'a dyn Wears,
    /// Depth of each body over that of the law for one passage that is counted.
    pub parts: [f64; 2],
    /// Largest width of the patch (m), for which the undeformed distance holds.
    pub widest: f64,
}

/// Returns the half-width (m) of a cut of a volume per length (m²) that is worn flat into bodies of
/// a relative radius R across (m): w³ = 3 R V/2.
pub fn flat(volume: f64, radius: f64) -> f64 {
    (1.5 * radius * volume).cbrt()
}

/// The bodies after a jump.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Jump {
    /// Passages so far.
    pub passages: f64,
    /// Largest depth of each body (m).
    pub depth: [f64; 2],
    /// Volume worn of each body per length along the rolling (m²).
    pub volume: [f64; 2],
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Width of the patch across the rolling (m).
    pub width: f64,
    /// Creepage along the rolling.
    pub creepage: f64,
    /// Force on the first body over the load, along and across.
    pub adhesion: [f64; 2],
    /// Sum of the errors of the jumps in depth so far (m), each by halving.
    pub error: f64,
}

/// The bodies after some passages.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Moment {
    /// Passages so far.
    pub passages: f64,
    /// Depth worn.
    pub profile: Profile,
    /// Largest pressure of each row (Pa).
    pub pressure: Vec<f64>,
    /// Traction over pressure of each row, from their sums.
    pub friction: Vec<f64>,
}

/// The way of two bodies through all passages.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Course {
    /// The start, and the end of each jump.
    pub jumps: Vec<Jump>,
    /// The start, and the moments that were asked for.
    pub moments: Vec<Moment>,
    /// Number of jumps that were made again, shorter, since they erred by too much.
    pub repeated: usize,
    /// Volume that the law took off each body per length (m²), counted jump by jump.
    pub taken: [f64; 2],
}

impl Course {
    /// Returns the difference between the volume that the law took and that which the profiles
    /// miss, over the former.
    pub fn ledger(&self) -> f64 {
        let Some(last) = self.jumps.last() else {
            return 0.0;
        };
        let pairs = self.taken.iter().zip(last.volume);
        let off = pairs.filter(|(taken, _)| **taken > 0.0);
        off.map(|(taken, missing)| (missing / taken - 1.0).abs())
            .fold(0.0, f64::max)
    }
}

/// Sizes of jumps.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// Passages in all.
    pub count: f64,
    /// Error of a jump in depth over the depth that it takes.
    pub share: f64,
    /// Largest jump.
    pub longest: f64,
    /// Passages at which the profile is kept, ascending.
    pub moments: Vec<f64>,
}

/// Residual of the tangential problem over the largest bound.
const TOLERANCE: f64 = 1e-6;
/// Share of a force to which its creepage is found, and the smallest creepage to begin with.
const FORCE: f64 = 1e-5;
const LEAST: f64 = 1e-6;
/// Number of passages of the first jump.
const FIRST: f64 = 10.0;
/// Smallest jump, at which the error is taken as it is.
const SMALLEST: f64 = 1.0;
/// Number of times that a grid which the patch leaves is laid anew for a jump.
const LAID: usize = 40;

/// Pressures, tractions and wear of bodies as they are.
struct State {
    surfaces: Surfaces,
    pressure: Vec<f64>,
    traction: Field,
    creepage: Creepage,
    /// Depth that a passage takes of the interface over the sum of the pressures of a row (m/Pa).
    rate: Vec<f64>,
}

impl Passages<'_> {
    /// Wears both bodies, from a grid around the new patch; `follow` gets each jump.
    ///
    /// # Errors
    /// The patch has no solution.
    pub fn wear(
        &self,
        grid: &CellGrid,
        steps: &Steps,
        follow: &mut dyn FnMut(&Jump),
    ) -> Result<Course, PatchError> {
        let mut profile = Profile::new(grid);
        let mut extent = Extent::new(grid);
        let mut course = Course::default();
        let mut now = Jump::default();
        let mut state = self.laid(&mut profile, &mut extent, None, 0.0)?;
        self.record(&state, &profile, &mut now);
        course.jumps.push(now);
        course.moments.push(moment(&state, &profile, 0.0));
        follow(&now);
        let stops = steps.moments.iter().copied().chain([steps.count]);
        let mut jump = FIRST;
        for stop in stops {
            while now.passages < stop * (1.0 - 1e-12) {
                let left = stop - now.passages;
                let taken = jump.min(steps.longest).min(left);
                let Some(made) = self.jump(&profile, &state, taken)? else {
                    jump = 0.5 * taken;
                    extent.widen(&mut profile);
                    state = self.laid(&mut profile, &mut extent, Some(&state), now.passages)?;
                    continue;
                };
                let allowed = steps.share * made.depth;
                // The error of a jump over its depth is of first order.
                let factor = match made.error > 0.0 {
                    true => (0.8 * allowed / made.error).clamp(0.3, 2.0),
                    false => 2.0,
                };
                let cut = taken < jump && factor >= 1.0;
                if made.error > allowed && taken > SMALLEST {
                    course.repeated += 1;
                    jump = (taken * factor).max(SMALLEST);
                    continue;
                }
                if !cut {
                    jump = (taken * factor).max(SMALLEST);
                }
                now.passages = if taken == left {
                    stop
                } else {
                    now.passages + taken
                };
                now.error += made.error;
                for (sum, volume) in course.taken.iter_mut().zip(made.volume) {
                    *sum += volume;
                }
                profile = made.profile;
                state = self.laid(&mut profile, &mut extent, Some(&state), now.passages)?;
                self.record(&state, &profile, &mut now);
                course.jumps.push(now);
                follow(&now);
                if now.width > self.widest {
                    return Err(PatchError::Wide {
                        passages: now.passages,
                        width: now.width,
                    });
                }
            }
            if course.moments.last().is_none_or(|m| m.passages < stop) {
                course.moments.push(moment(&state, &profile, stop));
            }
        }
        Ok(course)
    }

    /// Wears by a jump; `None` if the patch leaves its grid.
    fn jump(
        &self,
        profile: &Profile,
        state: &State,
        passages: f64,
    ) -> Result<Option<Made>, PatchError> {
        let inside = |error: PatchError| match error {
            PatchError::Normal(NormalError::Border) => Ok(None),
            other => Err(other),
        };
        let tried = || -> Result<Made, PatchError> {
            let whole = self.taken(profile, state, passages)?;
            let first = self.taken(profile, state, 0.5 * passages)?;
            let mut middle = profile.clone();
            self.take(&mut middle, &first);
            let then = self.state(&middle, state.surfaces.grid, Some(state))?;
            let second = self.taken(&middle, &then, 0.5 * passages)?;
            let mut made = Made {
                profile: profile.clone(),
                ..Made::default()
            };
            let all: f64 = self.parts.iter().sum();
            let halves = first.iter().zip(&second).map(|(a, b)| a + b);
            let rows = halves.zip(&whole).map(|(halves, whole)| {
                made.error = made.error.max(all * (halves - whole).abs());
                made.depth = made.depth.max(all * halves);
                // To second order, unless a row would grow.
                let better = 2.0 * halves - whole;
                if better >= 0.0 { better } else { halves }
            });
            let rows: Vec<f64> = rows.collect();
            self.take(&mut made.profile, &rows);
            let sum: f64 = rows.iter().sum::<f64>() * profile.width;
            made.volume = self.parts.map(|part| part * sum);
            Ok(made)
        };
        tried().map(Some).or_else(inside)
    }

    /// Takes depths of the interface off a profile.
    fn take(&self, profile: &mut Profile, rows: &[f64]) {
        for (depth, part) in profile.depth.iter_mut().zip(self.parts) {
            for (depth, row) in depth.iter_mut().zip(rows) {
                *depth += part * row;
            }
        }
    }

    /// Returns the depth that passages take of the interface in each row (m), with the pressures at
    /// their end.
    fn taken(
        &self,
        profile: &Profile,
        state: &State,
        passages: f64,
    ) -> Result<Vec<f64>, PatchError> {
        let all: f64 = self.parts.iter().sum();
        let surfaces = &state.surfaces;
        let mut distance = self.distance(profile, &surfaces.grid);
        if surfaces.couple() {
            let opened = surfaces.normal_by_traction(&state.traction);
            distance.iter_mut().zip(opened).for_each(|(h, u)| *h += u);
        }
        let compliance: Vec<f64> = state.rate.iter().map(|k| all * passages * k).collect();
        let start = Some(&state.pressure[..]);
        let found = wearing(
            surfaces,
            &distance,
            self.patch.load,
            Some(&compliance),
            start,
        )?;
        let rows = found
            .pressure
            .chunks(surfaces.grid.cells[0])
            .zip(&state.rate);
        Ok(rows
            .map(|(p, rate)| passages * rate * p.iter().sum::<f64>())
            .collect())
    }

    fn distance(&self, profile: &Profile, grid: &CellGrid) -> Vec<f64> {
        let columns = grid.cells[0];
        (0..grid.len())
            .map(|cell| (self.patch.distance)(grid.middle(cell)) + profile.both(cell / columns))
            .collect()
    }

    /// Returns the state of bodies, on a grid that holds the patch with some room.
    fn laid(
        &self,
        profile: &mut Profile,
        extent: &mut Extent,
        start: Option<&State>,
        passages: f64,
    ) -> Result<State, PatchError> {
        for _ in 0..LAID {
            let grid = extent.grid(profile);
            match self.state(profile, grid, start) {
                Ok(state) => {
                    if extent.fits(profile, &grid, &state.pressure) {
                        return Ok(state);
                    }
                }
                Err(PatchError::Normal(NormalError::Border)) => extent.widen(profile),
                Err(other) => return Err(other),
            }
        }
        Err(PatchError::Spread(passages))
    }

    fn state(
        &self,
        profile: &Profile,
        grid: CellGrid,
        start: Option<&State>,
    ) -> Result<State, PatchError> {
        // Pressures and tractions of the same cells are good to begin with.
        let start = start.filter(|s| s.surfaces.grid == grid);
        let surfaces = Surfaces::new(grid, self.patch.bodies, self.patch.layer);
        let distance = self.distance(profile, &grid);
        let mut last = start.map(|s| (s.pressure.clone(), s.traction.clone()));
        let mut slip = Vec::new();
        let mut solve = |creepage: &Creepage| -> Result<f64, PatchError> {
            let begin = last.as_ref().map(|(p, t)| (&p[..], &t[..]));
            let law = (self.law, self.speed);
            let (pressure, tractions) = self
                .patch
                .steady(&surfaces, &distance, begin, creepage, law, TOLERANCE)?;
            let force = tractions.traction.iter().map(|t| t[0]).sum::<f64>() * grid.area(3);
            slip = tractions.slip;
            last = Some((pressure.pressure, tractions.traction));
            Ok(force)
        };
        let creepage = match self.drive {
            Drive::Creepage(creepage) => {
                solve(&creepage)?;
                creepage
            }
            Drive::Force {
                force,
                start: begin,
            } => {
                let from = start.map_or(begin, |s| s.creepage);
                let sign = -force.signum();
                let at = |size: f64| Creepage {
                    along: sign * size,
                    ..from
                };
                let carried = |size: f64| -> Result<f64, PatchError> {
                    let force = solve(&at(size))?;
                    Ok(-sign * force)
                };
                let first = from.along.abs().max(LEAST);
                match pull::creepage(force.abs(), first, FORCE, carried)? {
                    Pulled::At(size) => at(size),
                    Pulled::Most(most) => {
                        let wanted = force.abs();
                        return Err(PatchError::Force { wanted, most });
                    }
                }
            }
        };
        let (pressure, traction) = last.unwrap_or_default();
        let cells = Cells {
            grid: &grid,
            pressure: &pressure,
            speed: self.speed,
        };
        let rigid = rigid_slip(&grid, &creepage);
        let part = -grid.area(3) / grid.size[0];
        let supplied = part * dot(&traction, &rigid) + self.patch.resistance(&surfaces, &pressure);
        let slip = balanced(&slip, supplied, part * dot(&traction, &slip));
        let worn = self.wears.worn(cells, &slip);
        let columns = grid.cells[0];
        let rows = worn.chunks(columns).zip(pressure.chunks(columns));
        let rate = rows.map(|(worn, p)| {
            let sum: f64 = p.iter().sum();
            (sum > 0.0).then(|| worn.iter().sum::<f64>() / sum)
        });
        let rate: Vec<Option<f64>> = rate.collect();
        Ok(State {
            rate: filled(&rate),
            surfaces,
            pressure,
            traction,
            creepage,
        })
    }

    fn record(&self, state: &State, profile: &Profile, now: &mut Jump) {
        let grid = &state.surfaces.grid;
        let part = grid.area(3) / self.patch.load;
        now.depth = profile.deepest();
        now.volume = profile.volume();
        now.pressure = state.pressure.iter().copied().fold(0.0, f64::max);
        let rows = state.pressure.chunks(grid.cells[0]);
        let touching = rows.filter(|row| row.iter().any(|p| *p > 0.0)).count();
        now.width = touching as f64 * grid.size[1];
        now.creepage = state.creepage.along;
        now.adhesion = [0, 1].map(|k| state.traction.iter().map(|t| t[k]).sum::<f64>() * part);
    }
}

/// What a jump makes.
#[derive(Default)]
struct Made {
    profile: Profile,
    /// Largest depth of the interface that it takes, and its error (m).
    depth: f64,
    error: f64,
    /// Volume that it takes of each body per length (m²).
    volume: [f64; 2],
}

/// Returns values of rows, those of the nearest row with one where there is none.
fn filled(rows: &[Option<f64>]) -> Vec<f64> {
    let known: Vec<(usize, f64)> = rows
        .iter()
        .enumerate()
        .filter_map(|(k, v)| Some((k, (*v)?)))
        .collect();
    let nearest = |k: usize| {
        let near = known.iter().min_by_key(|(other, _)| other.abs_diff(k));
        near.map_or(0.0, |(_, value)| *value)
    };
    (0..rows.len()).map(nearest).collect()
}

fn moment(state: &State, profile: &Profile, passages: f64) -> Moment {
    let columns = state.surfaces.grid.cells[0];
    let pressures = state.pressure.chunks(columns);
    let tractions = state.traction.chunks(columns);
    let friction = pressures.clone().zip(tractions).map(|(p, t)| {
        let sum: f64 = p.iter().sum();
        let pulled = [0, 1].map(|k| t.iter().map(|t| t[k]).sum::<f64>());
        if sum > 0.0 { length(pulled) / sum } else { 0.0 }
    });
    Moment {
        passages,
        profile: profile.clone(),
        pressure: pressures
            .map(|row| row.iter().copied().fold(0.0, f64::max))
            .collect(),
        friction: friction.collect(),
    }
}
