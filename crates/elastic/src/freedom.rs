//! Degrees of freedom of a mesh with supports: the generalised coordinate of each displacement of
//! each point.

use crate::error::BodyError;
use crate::mesh::Mesh;
use crate::support::Support;
use fretwork_core::bodies::Dof;
use fretwork_core::geometry::space::Space;
use std::marker::PhantomData;

/// A coordinate that is held: the common displacement of a part along an axis.
#[derive(Clone, Debug)]
pub struct HeldCoordinate {
    /// Index of the support.
    pub support: usize,
    /// Name of the part.
    pub part: String,
    /// Index of the coordinate.
    pub coordinate: u32,
    /// Drive at the start; the body has the current one.
    pub drive: Dof,
}

/// The coordinates: those that move freely first, then those that are imposed.
#[derive(Clone, Debug)]
pub struct Freedoms<S: Space> {
    of: Vec<u32>,
    /// Number of coordinates that move freely.
    pub free: usize,
    /// Axis of each coordinate.
    pub axis: Vec<u8>,
    /// Held coordinates, those that are imposed last and in their order.
    pub held: Vec<HeldCoordinate>,
    /// Coordinates with a force, and imposed coordinates, by their index in `held`.
    forces: Vec<usize>,
    imposed: Vec<usize>,
    space: PhantomData<S>,
}

impl<S: Space> Freedoms<S> {
    /// Numbers the coordinates of a mesh.
    ///
    /// # Errors
    /// The mesh has no such part, a point belongs to two parts with different drives along an axis,
    /// or a drive imposes motion at one time and a force at another.
    pub fn new(mesh: &Mesh<S>, supports: &[Support]) -> Result<Self, BodyError> {
        let d = S::D;
        // Holder of each displacement: support and axis.
        let mut held: Vec<Option<usize>> = vec![None; mesh.points().len() * d];
        for (s, support) in supports.iter().enumerate() {
            let Some(points) = mesh.points_of(&support.part) else {
                let names: Vec<&str> = mesh.part_names().collect();
                return Err(BodyError::NoPart(support.part.clone(), names.join(", ")));
            };
            for (axis, drive) in support.axes.iter().enumerate().take(d) {
                let Some(drive) = drive else { continue };
                if drive.imposes() && drive.yields() {
                    return Err(BodyError::Changes(support.part.clone()));
                }
                for point in &points {
                    let slot = &mut held[*point as usize * d + axis];
                    match *slot {
                        Some(other) => {
                            let other: &Support = &supports[other];
                            // At a common corner of two parts with equal drives either may be used.
                            let same = other.axes[axis].as_ref() == Some(drive)
                                && other.later(axis).eq(support.later(axis))
                                && drive.imposes();
                            if !same {
                                let [one, two] = [&other.part, &support.part].map(Clone::clone);
                                return Err(BodyError::Twice(one, two, ["x", "y", "z"][axis]));
                            }
                        }
                        None => *slot = Some(s),
                    }
                }
            }
        }
        Ok(Self::number(supports, &held))
    }

    fn number(supports: &[Support], held: &[Option<usize>]) -> Self {
        let d = S::D;
        let mut out = Self {
            of: vec![u32::MAX; held.len()],
            free: 0,
            axis: Vec::new(),
            held: Vec::new(),
            forces: Vec::new(),
            imposed: Vec::new(),
            space: PhantomData,
        };
        for imposed in [false, true] {
            let mut known = vec![[u32::MAX; 3]; supports.len()];
            for (k, holder) in held.iter().enumerate() {
                let axis = k % d;
                let drive = holder.and_then(|s| supports[s].axes[axis].as_ref());
                if drive.is_some_and(Dof::imposes) != imposed {
                    continue;
                }
                let next = out.axis.len() as u32;
                let coordinate = match holder {
                    Some(s) if known[*s][axis] != u32::MAX => known[*s][axis],
                    Some(s) => {
                        known[*s][axis] = next;
                        next
                    }
                    None => next,
                };
                out.of[k] = coordinate;
                if coordinate < next {
                    continue;
                }
                out.axis.push(axis as u8);
                let (Some(s), Some(drive)) = (holder, drive) else {
                    continue;
                };
                if imposed {
                    out.imposed.push(out.held.len());
                } else {
                    out.forces.push(out.held.len());
                }
                out.held.push(HeldCoordinate {
                    support: *s,
                    part: supports[*s].part.clone(),
                    coordinate,
                    drive: drive.clone(),
                });
            }
            if !imposed {
                out.free = out.axis.len();
            }
        }
        out
    }

    /// Returns coordinates that may have a force, with their drives; `drives` has one entry per
    /// entry of `held`.
    pub fn forces<'a>(&'a self, drives: &'a [Dof]) -> impl Iterator<Item = (usize, &'a Dof)> {
        let of = |k: &usize| (self.held[*k].coordinate as usize, &drives[*k]);
        self.forces.iter().map(of)
    }

    /// Returns imposed coordinates with their drives, in their order.
    pub fn imposed<'a>(&'a self, drives: &'a [Dof]) -> impl Iterator<Item = (usize, &'a Dof)> {
        let of = |k: &usize| (self.held[*k].coordinate as usize, &drives[*k]);
        self.imposed.iter().map(of)
    }

    /// The place in `held` of a part along an axis.
    pub fn find(&self, part: &str, axis: usize) -> Option<usize> {
        let along = |h: &HeldCoordinate| usize::from(self.axis[h.coordinate as usize]) == axis;
        self.held.iter().position(|h| h.part == part && along(h))
    }

    /// Number of coordinates.
    pub fn total(&self) -> usize {
        self.axis.len()
    }

    /// Returns the coordinate that is the displacement of a point along an axis.
    pub fn of(&self, point: u32, axis: usize) -> usize {
        self.of[point as usize * S::D + axis] as usize
    }
}
