//! Elastic half-spaces: their cells, profiles and drives.

use super::surface::Roughness;
use super::{Builder, Origin};
use crate::case::{CellSpec, CellTouch, HalfSpaceProfile, HalfSpaceSpec, Side};
use crate::height_grid;
use crate::material::Sourced;
use crate::source::InputError;
use fretwork_core::assembly::AnySystem;
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_elastic::half_space::{
    self, CellGrid, Cells, FilledSide, HalfSpaceError, Profile, Reach,
};
use std::collections::BTreeMap;

/// Smallest theta: the error of a contact force on a stiff half-space is multiplied by -(1 -
/// theta)/theta in a step, and near 1/2 single steps gain energy.
const MIN_THETA: f64 = 0.55;

/// Creepage of one surface over another that is permitted in addition to rolling by one cell per
/// step.
const MAX_CREEPAGE: f64 = 0.01;

impl Builder<'_> {
    /// Returns the half-spaces of the case, in its order.
    pub(super) fn half_spaces(
        &mut self,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<Vec<AnySystem>, InputError> {
        let mut out = Vec::new();
        for (k, spec) in self.case.half_spaces.iter().enumerate() {
            let system = self.elastic_half_space(&format!("half_spaces.{k}"), spec, properties)?;
            let contactors = system.contactors().len();
            self.origins
                .extend((0..contactors).map(|_| Origin::HalfSpace(k)));
            out.push(system);
        }
        let theta = self.case.time.theta;
        if !out.is_empty() && theta < MIN_THETA {
            let message = format!(
                "elastic half-spaces have no inertia, and at theta = {theta} their forces alternate from step to step; set `theta: 1.0` in `time`, or {MIN_THETA} at least"
            );
            return Err(self.fail("time.theta", message));
        }
        Ok(out)
    }

    fn elastic_half_space(
        &self,
        here: &str,
        spec: &HalfSpaceSpec,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<AnySystem, InputError> {
        let (elasticity, material) = self.elasticity(here, &spec.material, properties)?;
        let grid = self.cells(here, spec)?;
        let axes = self.holder(&format!("{here}.dofs"), spec)?;
        let repeats = self.repeats(here, spec, &grid)?;
        if let Some(rolling) = &spec.rolling {
            let moves = match spec.profile {
                HalfSpaceProfile::Flat | HalfSpaceProfile::Summit { .. } => false,
                HalfSpaceProfile::Wave { x, .. } => x.is_finite(),
                HalfSpaceProfile::Rough { .. } | HalfSpaceProfile::Heights { .. } => true,
            };
            if moves || spec.wears.is_some() {
                let message = "the profile and the scar of a half-space stay in place, and its material passes: a surface that rolls is flat, a summit, or a wave across; take `rolling` away, or give it such a profile without `wears`";
                return Err(self.fail(format!("{here}.rolling"), message));
            }
            self.check_rolling(&format!("{here}.rolling"), rolling, &grid)?;
        }
        let built = half_space::HalfSpaceSpec {
            name: &spec.name,
            material: elasticity,
            fills: match spec.side {
                Side::Below => FilledSide::Below,
                Side::Above => FilledSide::Above,
            },
            position: self
                .vector(&format!("{here}.position"), &spec.position)?
                .into(),
            repeats,
            reach: self.reach(&format!("{here}.depth"), spec)?,
            profile: self.height_profile(&format!("{here}.profile"), spec, &grid)?,
            grid,
            mass: spec.mass,
            axes: &axes,
            rolling: spec.rolling.clone(),
            touching: match spec.touches {
                CellTouch::Points => Cells::Points,
                CellTouch::Surface => Cells::Surface,
            },
            surface_material: material,
        };
        built.build(self.dimension()).map_err(|error| {
            let below = match &error {
                HalfSpaceError::Material(_) => "material",
                HalfSpaceError::Depth(..) => "depth",
                HalfSpaceError::Mass(_) | HalfSpaceError::NoMass(_) => "mass",
                HalfSpaceError::Changes(_) => "dofs",
                HalfSpaceError::Few("y", _) => "y",
                HalfSpaceError::Size(_) | HalfSpaceError::Few(..) | HalfSpaceError::Many(_) => "x",
                HalfSpaceError::Height(_) => "profile",
                HalfSpaceError::NoSurface(_) => "touches",
            };
            self.fail(format!("{here}.{below}"), error.to_string())
        })
    }

    fn cells(&self, here: &str, spec: &HalfSpaceSpec) -> Result<CellGrid, InputError> {
        let line = |name: &str, line: &CellSpec| {
            let CellSpec { from, to, size } = *line;
            if !(from.is_finite() && to.is_finite() && to > from) {
                let message = format!("`to` must be above `from`, got {from} and {to}");
                return Err(self.fail(format!("{here}.{name}.to"), message));
            }
            if !(size > 0.0 && size.is_finite()) {
                let message = format!("the size of a cell must be positive, got {size}");
                return Err(self.fail(format!("{here}.{name}.size"), message));
            }
            let cells = ((to - from) / size).round();
            if cells > 1e6 {
                let message = format!(
                    "cells of {size} m are more than a million in a line; make them larger"
                );
                return Err(self.fail(format!("{here}.{name}.size"), message));
            }
            let cells = cells.max(1.0) as usize;
            Ok((from, (to - from) / cells as f64, cells))
        };
        let x = line("x", &spec.x)?;
        let y = match (self.dimension(), &spec.y) {
            (2, None) => (-0.5, 1.0, 1),
            (3, Some(y)) => line("y", y)?,
            (2, Some(_)) => {
                let message = "a case in two dimensions has cells along x alone; leave `y` out";
                return Err(self.fail(format!("{here}.y"), message));
            }
            _ => {
                let message = "a half-space in three dimensions needs its cells along `y` too";
                return Err(self.fail(here, message));
            }
        };
        Ok(CellGrid {
            from: [x.0, y.0],
            size: [x.1, y.1],
            cells: [x.2, y.2],
        })
    }

    fn reach(&self, here: &str, spec: &HalfSpaceSpec) -> Result<Reach, InputError> {
        match (spec.periodic, spec.depth) {
            (true, Some(depth)) => Ok(Reach::Periodic(depth)),
            (false, Some(depth)) if self.dimension() == 2 => Ok(Reach::Infinite(depth)),
            (false, None) if self.dimension() == 3 => Ok(Reach::Infinite(f64::INFINITY)),
            (false, Some(_)) => {
                let message = "in three dimensions displacements vanish at infinity; leave `depth` out, or let the cells be `periodic`";
                Err(self.fail(here, message))
            }
            (_, None) => {
                let message = "a half-space in two dimensions, or one that is periodic, has no displacement without a `depth` below the load at which it is zero: give the distance to its holder";
                let whole = here.strip_suffix(".depth").unwrap_or(here);
                Err(self.fail(whole, message))
            }
        }
    }

    /// Whether the surface repeats with the period of the case.
    fn repeats(
        &self,
        here: &str,
        spec: &HalfSpaceSpec,
        grid: &CellGrid,
    ) -> Result<bool, InputError> {
        let [x, across @ ..] = self.assembly.periodic().period;
        if across.iter().any(Option::is_some) || (self.dimension() == 3 && x.is_some()) {
            let message = "an elastic half-space can repeat along x in two dimensions; take other periods of the case away";
            return Err(self.fail(here, message));
        }
        let Some(period) = x else {
            return Ok(false);
        };
        if !spec.periodic || (grid.extent()[0] / period - 1.0).abs() > 1e-9 {
            let message = format!(
                "in a case with a period of {period} m the cells of an elastic half-space repeat with it: let them extend over {period} m, with `periodic: true`"
            );
            return Err(self.fail(format!("{here}.x"), message));
        }
        Ok(true)
    }

    fn holder(&self, here: &str, spec: &HalfSpaceSpec) -> Result<Vec<Dof>, InputError> {
        let axes = [&spec.dofs.x, &spec.dofs.y, &spec.dofs.z];
        let mut out = Vec::new();
        for (axis, dof) in ["x", "y", "z"].iter().zip(axes) {
            if let Some(dof) = dof {
                self.check_holder(&format!("{here}.{axis}"), axis, dof)?;
            }
            out.push(dof.clone().unwrap_or(Dof::Fixed));
        }
        out.truncate(self.dimension());
        Ok(out)
    }

    /// Checks that a rolling surface passes at most one cell per step.
    fn check_rolling(
        &self,
        here: &str,
        rolling: &TimeFunction,
        grid: &CellGrid,
    ) -> Result<(), InputError> {
        if let Some(why) = rolling.error() {
            return Err(self.fail(here, why));
        }
        let h = self.case.time.step;
        let fastest = match rolling {
            TimeFunction::Constant(x) => x.abs(),
            TimeFunction::Ramp { from, to, .. } => from.abs().max(to.abs()),
            TimeFunction::Sine {
                amplitude, offset, ..
            } => amplitude.abs() + offset.abs(),
            TimeFunction::Table(points) => points.iter().fold(0.0, |m, p| p.1.abs().max(m)),
        };
        // A small creepage in addition to a velocity of one cell per step is permitted.
        if fastest * h > (1.0 + MAX_CREEPAGE) * grid.size[0] {
            let message = format!(
                "at {fastest} m/s the surface rolls by {:.3e} m in a step, more than a cell of {:.3e} m: shorten `time.step` to {:.3e} s or make the cells larger",
                fastest * h,
                grid.size[0],
                grid.size[0] / fastest
            );
            return Err(self.fail(here, message));
        }
        Ok(())
    }

    fn height_profile(
        &self,
        here: &str,
        spec: &HalfSpaceSpec,
        grid: &CellGrid,
    ) -> Result<Profile, InputError> {
        let positive = |name: &str, value: f64| {
            if value > 0.0 {
                return Ok(value);
            }
            let message =
                format!("the length along {name} of a profile must be positive, got {value} m");
            Err(self.fail(format!("{here}.{name}"), message))
        };
        match &spec.profile {
            HalfSpaceProfile::Flat => Ok(Profile::Flat),
            HalfSpaceProfile::Summit { x, y } => Ok(Profile::Paraboloid([
                positive("x", *x)?,
                positive("y", *y)?,
            ])),
            HalfSpaceProfile::Wave { amplitude, x, y } => {
                let lengths = [positive("x", *x)?, positive("y", *y)?];
                for (k, length) in lengths.iter().enumerate().take(self.dimension() - 1) {
                    let (size, waves) = (grid.size[k], grid.extent()[k] / length);
                    if *length < 4.0 * size {
                        let message = format!(
                            "a wave of {length} m has less than four cells of {size} m; make the cells smaller"
                        );
                        return Err(self.fail(here, message));
                    }
                    if spec.periodic && (waves - waves.round()).abs() > 1e-6 {
                        let message = format!(
                            "cells that repeat hold a whole number of waves, and these {waves}; change the length of the wave or the extent of the cells"
                        );
                        return Err(self.fail(here, message));
                    }
                }
                Ok(Profile::Wave(*amplitude, lengths))
            }
            HalfSpaceProfile::Rough {
                rms,
                hurst,
                longest,
                shortest,
            } => {
                if self.dimension() == 3 {
                    return Err(self.fail(
                        here,
                        "a rough profile is one in two dimensions; give `Heights` in three",
                    ));
                }
                let roughness = Roughness {
                    points: grid.cells[0],
                    rms: *rms,
                    hurst: *hurst,
                    longest: *longest,
                    shortest: *shortest,
                };
                let heights = self.rough_heights(here, &roughness, grid.extent()[0])?;
                Ok(Profile::Heights(heights))
            }
            HalfSpaceProfile::Heights { file, scale } => {
                let heights = height_grid::read(&self.folder.join(file), grid.cells)
                    .map_err(|e| self.source.named_at(&format!("{here}.file"), e))?;
                let heights = heights.into_iter().map(|z| z * scale).collect();
                Ok(Profile::Heights(heights))
            }
        }
    }
}
