//! Response of the material of a fretting contact over load and amplitude: no damage, cracks, wear,
//! or both (Z. R. Zhou, L. Vincent, Wear 181-183, 1995), on the axes of the running conditions.
//!
//! A crack is expected where the index of a criterion reaches 1 for the averaged cycle, wear where
//! its largest depth after a number of cycles reaches a limit. In partial slip stresses grow with
//! the amplitude and wear is little; in gross slip stresses stay as they are, and wear, which grows
//! with the path of slip, takes away what would crack.

use crate::below::Below;
use crate::cells::{ByCells, Contact};
use crate::fatigue::history::{histories, opposite};
use crate::fatigue::{Block, Criterion};
use crate::fretting::Loop;
use crate::running::{Conditions, Loaded, RunningError, boundary};
use crate::stress::Stress;
use serde::Serialize;

/// How the material responds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// Neither cracks nor wear.
    None,
    /// Cracks.
    Crack,
    /// Wear.
    Wear,
    /// Wear of material that would crack.
    Both,
}

/// What tells the responses apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Criterion for cracks in the body, at the number of cycles.
    pub criterion: Criterion,
    /// Poisson's ratio of the body.
    pub poisson: f64,
    /// Which of both bodies: 0 or 1.
    pub body: usize,
    /// Stress of the body without the contact at the largest displacement (Pa), which follows the
    /// displacement through the cycle: that of fretting fatigue, or none.
    pub bulk: Stress,
    /// Block over which stresses are averaged.
    pub block: Block,
    /// Wear of the body.
    pub wear: Wears,
    /// Number of cycles.
    pub cycles: f64,
    /// Depth of wear that counts (m).
    pub depth: f64,
}

/// How a body wears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wears {
    /// By a wear coefficient k (1/Pa).
    Coefficient(f64),
    /// By this multiple of what the law of the contact wears.
    Law(f64),
}

/// Damage at a load and an amplitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Damage {
    /// Running conditions, without the slip ratio.
    pub conditions: Conditions,
    /// Largest index of the criterion in a cell.
    pub crack: f64,
    /// The cell.
    pub at: usize,
    /// Largest depth of wear after all cycles (m).
    pub worn: f64,
}

/// Amplitudes of displacement (m) under a load from which on damage is expected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Onsets {
    /// Load (N).
    pub load: f64,
    /// Of cracks; infinite if friction is too low for them.
    pub crack: f64,
    /// Of wear.
    pub wear: f64,
}

/// A map of responses.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ResponseMap {
    /// Damage by load, and for each by amplitude.
    pub damage: Vec<Vec<Damage>>,
    /// Onsets by load.
    pub onsets: Vec<Onsets>,
}

impl Damage {
    /// Returns the response.
    pub fn response(&self, thresholds: &Thresholds) -> Response {
        match (self.crack >= 1.0, self.worn >= thresholds.depth) {
            (false, false) => Response::None,
            (true, false) => Response::Crack,
            (false, true) => Response::Wear,
            (true, true) => Response::Both,
        }
    }
}

/// Returns the map over loads (N) and amplitudes of displacement (m).
///
/// # Errors
/// A load is not held, or a cycle has no solution.
pub fn map(
    contacts: &ByCells<'_>,
    loads: &[f64],
    displacements: &[f64],
    thresholds: &Thresholds,
) -> Result<ResponseMap, RunningError> {
    let mut out = ResponseMap::default();
    for load in loads {
        let body = Body::new(contacts.contact(*load)?, thresholds);
        let row = displacements.iter().map(|d| body.damage(*d));
        out.damage.push(row.collect::<Result<_, _>>()?);
        out.onsets.push(body.onsets()?);
    }
    Ok(out)
}

/// A body of a contact under a load.
pub struct Body<'a> {
    /// The contact.
    pub contact: Contact<'a>,
    below: Below,
    thresholds: &'a Thresholds,
}

impl<'a> Body<'a> {
    /// Prepares the body below the patch.
    pub fn new(contact: Contact<'a>, thresholds: &'a Thresholds) -> Self {
        let depths = thresholds.block.depths();
        Self {
            below: Below::new(contact.surfaces.grid, thresholds.poisson, &depths),
            contact,
            thresholds,
        }
    }

    /// Returns the amplitudes of displacement from which on damage is expected.
    ///
    /// # Errors
    /// A cycle has no solution.
    pub fn onsets(&self) -> Result<Onsets, RunningError> {
        let scale = self.contact.scale();
        let cracks = |displacement: f64| Ok(self.damage(displacement)?.crack >= 1.0);
        Ok(Onsets {
            load: self.contact.load,
            // From the onset of gross slip on stresses grow no more.
            crack: match cracks(2.0 * scale)? {
                true => boundary(scale, cracks)?,
                false => f64::INFINITY,
            },
            wear: boundary(scale, |d| {
                let conditions = self.contact.conditions(d)?;
                Ok(self.worn(&conditions) >= self.thresholds.depth)
            })?,
        })
    }

    /// Returns the damage at an amplitude of displacement (m).
    ///
    /// # Errors
    /// The cycle has no solution.
    pub fn damage(&self, displacement: f64) -> Result<Damage, RunningError> {
        let cycle = self.contact.cycle(displacement)?;
        let conditions = self.contact.conditions(displacement)?;
        let (crack, at) = self.crack(&cycle);
        Ok(Damage {
            worn: self.worn(&conditions),
            conditions,
            crack,
            at,
        })
    }

    /// Returns the largest index of a cycle, and its cell.
    pub fn crack(&self, cycle: &Loop) -> (f64, usize) {
        let turned: Vec<_>;
        let traction = match self.thresholds.body {
            0 => &cycle.traction,
            _ => {
                turned = cycle.traction.iter().map(|t| opposite(t)).collect();
                &turned
            }
        };
        let (pressure, block) = (&self.contact.pressure, &self.thresholds.block);
        let largest = cycle.amplitude[0];
        let parts = cycle.points.iter().map(|[at, _]| at / largest);
        let bulk: Vec<Stress> = parts
            .map(|part| self.thresholds.bulk.map(|s| part * s))
            .collect();
        let cycles = histories(&self.below, block, pressure, traction, &bulk);
        let indices = cycles.iter().map(|c| self.thresholds.criterion.index(c));
        let cells = indices.enumerate().map(|(cell, index)| (index, cell));
        cells.fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// Returns the largest depth of wear after all cycles (m).
    fn worn(&self, conditions: &Conditions) -> f64 {
        let cycles = self.thresholds.cycles;
        match self.thresholds.wear {
            Wears::Coefficient(k) => conditions.wear(k, cycles)[1],
            Wears::Law(part) => part * cycles * conditions.worn[1],
        }
    }
}
