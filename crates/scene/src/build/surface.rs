//! Surfaces of first bodies.

use super::{Builder, in_dimension};
use crate::case::{ShapeSpec, Side};
use crate::source::{InputError, split_path};
use crate::{height_grid, profile, profile_file, standard};
use fretwork_core::assembly;
use fretwork_core::geometry::any_shape::AnySurface;
use fretwork_core::geometry::mesh::Mesh;
use nalgebra::Vector3;

/// Limit on the points of a random surface.
const MAX_POINTS: usize = 1_000_000;
/// Limit on points times waves of a rough profile, which bounds the time to generate it.
const MAX_TERMS: f64 = 2e8;

/// Parameters of a random profile, see [`ShapeSpec::RoughProfile`].
pub(super) struct Roughness {
    pub points: usize,
    pub rms: f64,
    pub hurst: f64,
    pub longest: Option<f64>,
    pub shortest: f64,
}

/// A surface, and its offset in the frame of its body (m).
pub(super) type Placed = (Vector3<f64>, AnySurface);

impl Builder<'_> {
    pub(super) fn surface(&self, here: &str, shape: &ShapeSpec) -> Result<Placed, InputError> {
        let centred = |surface| (Vector3::zeros(), surface);
        match shape {
            ShapeSpec::HalfSpace { normal, at } => self.half_space(here, normal, at),
            ShapeSpec::Drum { radius, axis } => self.drum(here, *radius, *axis).map(centred),
            ShapeSpec::Profile { points, file, side } => {
                let points = self.profile_points(here, points, file.as_deref())?;
                self.chain(here, points, *side).map(centred)
            }
            ShapeSpec::StandardProfile {
                name,
                spacing,
                from,
                to,
                inclination,
                side,
            } => {
                let cut = standard::Cut {
                    spacing: *spacing,
                    from: *from,
                    to: *to,
                    inclination: *inclination,
                };
                let points = standard::points(*name, &cut)
                    .map_err(|(field, why)| self.fail(format!("{here}.{field}"), why))?;
                let side = side.unwrap_or(standard::side(*name));
                self.chain(here, points, side).map(centred)
            }
            ShapeSpec::RoughProfile {
                points,
                rms,
                hurst,
                longest,
                shortest,
                height,
                side,
            } => {
                let roughness = Roughness {
                    points: *points,
                    rms: *rms,
                    hurst: *hurst,
                    longest: *longest,
                    shortest: *shortest,
                };
                self.rough_profile(here, &roughness, *height, *side)
                    .map(centred)
            }
            ShapeSpec::HeightField {
                points,
                spacing,
                heights,
                rms,
            } => self
                .height_field(here, *points, *spacing, (heights, *rms))
                .map(centred),
            ShapeSpec::Mesh { file, scale, at } => {
                let at = self.vector(&format!("{here}.at"), at)?;
                let (points, triangles) = self.mesh_file(here, file, *scale)?;
                let mesh = Mesh::new(points, triangles);
                let mesh = mesh.map_err(|e| self.fail(format!("{here}.file"), e.to_string()))?;
                Ok((
                    at,
                    in_dimension::mesh(self.dimension(), mesh)
                        .map_err(|why| self.fail(here, why))?,
                ))
            }
            ShapeSpec::Balls(_)
            | ShapeSpec::Cluster { .. }
            | ShapeSpec::Plate { .. }
            | ShapeSpec::Polygon { .. }
            | ShapeSpec::Polyhedron { .. }
            | ShapeSpec::Box { .. }
            | ShapeSpec::Capsule { .. } => Err(self.fail(here, "this shape is not a surface")),
        }
    }

    fn half_space(&self, here: &str, normal: &[f64], at: &[f64]) -> Result<Placed, InputError> {
        let n = self.vector(&format!("{here}.normal"), normal)?;
        if n.norm() == 0.0 {
            return Err(self.fail(format!("{here}.normal"), "a normal must not be null"));
        }
        let at = self.vector(&format!("{here}.at"), at)?;
        let shown = self.assembly.periodic().period[0].map_or(1.0, |p| 0.5 * p);
        let normal = (n * (1.0 / n.norm())).into();
        let plane = assembly::half_space(self.dimension(), normal, shown);
        Ok((at, plane))
    }

    fn drum(&self, here: &str, radius: f64, axis: usize) -> Result<AnySurface, InputError> {
        let radius = self.radius(&format!("{here}.radius"), radius)?;
        if axis > 2 {
            let message = format!("axis {axis} does not exist; use 0, 1 or 2");
            return Err(self.fail(format!("{here}.axis"), message));
        }
        Ok(AnySurface::drum(self.dimension(), radius, axis))
    }

    /// Returns the points of a profile, from the case or from a file.
    fn profile_points(
        &self,
        here: &str,
        points: &[(f64, f64)],
        file: Option<&str>,
    ) -> Result<Vec<(f64, f64)>, InputError> {
        match (points.is_empty(), file) {
            (true, Some(file)) => profile_file::read(&self.folder.join(file))
                .map_err(|e| self.source.named_at(&format!("{here}.file"), e)),
            (_, None) => Ok(points.to_vec()),
            (false, Some(_)) => {
                let message = "a profile is given by `points` or by a `file`, not by both";
                Err(self.fail(format!("{here}.file"), message))
            }
        }
    }

    /// Returns a random profile over one period.
    fn rough_profile(
        &self,
        here: &str,
        roughness: &Roughness,
        height: f64,
        side: Side,
    ) -> Result<AnySurface, InputError> {
        let Some(period) = self.assembly.periodic().period[0] else {
            return Err(self.fail(here, "a rough profile needs a periodic x"));
        };
        let points = roughness.points;
        let z = self.rough_heights(here, roughness, period)?;
        let x = |k: usize| period * k as f64 / points as f64;
        let mut chain: Vec<(f64, f64)> = z
            .iter()
            .enumerate()
            .map(|(k, z)| (x(k), height + z))
            .collect();
        chain.push((period, chain[0].1));
        in_dimension::profile(self.dimension(), chain, side, Some(period))
            .map_err(|why| self.fail(here, why))
    }

    /// Returns random heights at equal distances over a period (m).
    pub(super) fn rough_heights(
        &self,
        here: &str,
        roughness: &Roughness,
        period: f64,
    ) -> Result<Vec<f64>, InputError> {
        let Roughness {
            points,
            rms,
            hurst,
            longest,
            shortest,
        } = *roughness;
        let valid = points >= 3
            && rms >= 0.0
            && shortest > 0.0
            && longest.is_none_or(|l| l > 0.0)
            && rms.is_finite()
            && hurst.is_finite();
        if !valid {
            let message =
                "a rough profile needs at least 3 points, rms >= 0, shortest > 0 and longest > 0";
            return Err(self.fail(here, message));
        }
        let longest = longest.unwrap_or(period);
        self.few_terms(here, points, period, (longest, shortest))?;
        // Each body has its own seed: rail and wheel must not be mirror images.
        let salt = here
            .bytes()
            .fold(17u64, |h, b| h.wrapping_mul(31).wrapping_add(u64::from(b)));
        let seed = self.case.seed ^ salt;
        Ok(profile::rough(
            points, period, rms, hurst, longest, shortest, seed,
        ))
    }

    /// Creates a field of given heights, or of random heights with a standard deviation.
    fn height_field(
        &self,
        here: &str,
        points: (usize, usize),
        spacing: (f64, f64),
        (heights, rms): (&[f64], Option<f64>),
    ) -> Result<AnySurface, InputError> {
        let bad = |message: String| self.fail(here, message);
        let count = points.0.saturating_mul(points.1);
        if count > 10_000_000 {
            return Err(bad("a height field has at most 10,000,000 points".into()));
        }
        let heights = match rms {
            Some(rms) => profile::noise(count, rms, self.case.seed ^ 0x5eed),
            None => {
                self.refuse_other_rows(here, heights, points)?;
                heights.to_vec()
            }
        };
        let p = self.assembly.periodic().period;
        let fits = |axis: usize, n: usize, s: f64| {
            p[axis].is_some_and(|p| (n as f64 * s / p - 1.0).abs() < 1e-9)
        };
        let periodic = [fits(0, points.0, spacing.0), fits(1, points.1, spacing.1)];
        in_dimension::height_field(self.dimension(), points, spacing, heights, periodic)
            .map_err(bad)
    }

    /// Rejects heights whose lines in the case are the columns of the grid, or places with heights.
    fn refuse_other_rows(
        &self,
        here: &str,
        heights: &[f64],
        (nx, ny): (usize, usize),
    ) -> Result<(), InputError> {
        let at = format!("{here}.heights");
        let text = self.source.text();
        let path = split_path(&at).unwrap_or_default();
        let Ok(node) = self.source.tree().find(text, &path) else {
            return Ok(());
        };
        let entries = node.group().map_or(&[][..], |list| list.entries.as_slice());
        let spans: Vec<_> = entries.iter().map(|e| e.value.span.clone()).collect();
        let rows = height_grid::rows_of_list(text, &spans, heights);
        match height_grid::misfit(&rows, [nx, ny]) {
            Some(why) => Err(self.fail(
                at,
                format!("the grid has {nx} heights along x in {ny} rows: {why}"),
            )),
            None => Ok(()),
        }
    }

    /// Rejects a rough profile that would take long to generate.
    fn few_terms(
        &self,
        here: &str,
        points: usize,
        period: f64,
        (longest, shortest): (f64, f64),
    ) -> Result<(), InputError> {
        if points > MAX_POINTS {
            let message = format!("a rough profile has at most {MAX_POINTS} points, got {points}");
            return Err(self.fail(format!("{here}.points"), message));
        }
        let waves = profile::waves(points, period, longest, shortest);
        let count = (waves.end() - waves.start()) as f64 + 1.0;
        if points as f64 * count > MAX_TERMS {
            let message = format!(
                "{points} points with {count} waves take too long to make: points times waves may be {MAX_TERMS:e} at \
                 most; take fewer points, or a larger `shortest`"
            );
            return Err(self.fail(format!("{here}.points"), message));
        }
        Ok(())
    }

    /// Creates a profile from its points; one that spans the period is periodic.
    fn chain(
        &self,
        here: &str,
        points: Vec<(f64, f64)>,
        side: Side,
    ) -> Result<AnySurface, InputError> {
        let spans = |p: &f64| {
            points.len() > 1 && ((points[points.len() - 1].0 - points[0].0) / p - 1.0).abs() < 1e-9
        };
        let period = self.assembly.periodic().period[0].filter(spans);
        in_dimension::profile(self.dimension(), points, side, period)
            .map_err(|why| self.fail(here, why))
    }
}
