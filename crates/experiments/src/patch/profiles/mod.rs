//! Profiles of both bodies across the motion: read from files, put in their places, and the contact
//! about which they touch under the load.

mod read;
mod shown;
#[cfg(test)]
mod tests;

pub use read::{ProfileSpec, ProfilesSpec};
pub use shown::{Contact, Other};

use super::bodies::{Bodies, Distance};
use super::setup::grid;
use super::spec::{MotionSpec, PatchFile, value};
use crate::Error;
use fretwork_observe::quantity::quantity;
use fretwork_rolling::{Curve, Pair, Radius, Surfaces, Touching, TouchingError, normal};
use fretwork_scene::InputError;
use read::Place;

/// Both profiles in their places, and their contact.
#[derive(Clone, Debug)]
pub struct Profiles {
    /// The first one put down on the second one, by this (m).
    pair: Pair,
    down: f64,
    places: [Place; 2],
    touching: Touching,
    /// The patch along the tangent (m), and its approach (m), once it is settled.
    pressed: [f64; 2],
    approach: f64,
    spin: bool,
    vertical: bool,
}

/// Half of the width over which curvatures are fitted to begin with (m).
const NEAR: f64 = 1.5e-3;
/// Cells of the grid on which the middle of the patch is found.
const CELLS: usize = 48;
/// Distance of the middle of the patch from the origin of its frame over its width at which it is
/// found, and the most times that it is moved.
const SETTLED: f64 = 5e-3;
const TIMES: usize = 12;

impl Profiles {
    /// Reads the profiles of a file.
    ///
    /// # Errors
    /// A file is no profile, or the profiles do not touch as bodies that roll do.
    pub fn read(file: &PatchFile) -> Result<Option<Self>, InputError> {
        let (spec, source) = (&file.spec, &file.source);
        let Some(given) = &spec.profiles else {
            return Ok(None);
        };
        let bodies = [&spec.bodies.0, &spec.bodies.1];
        if bodies.iter().any(|b| b.across.is_some()) || spec.distance.is_some() {
            return Err(source.error_at(
                "profiles",
                "the profiles are the surfaces across the motion: leave out the bodies' `across` and the `distance`",
            ));
        }
        let fretting = matches!(spec.motion, MotionSpec::Fretting(_));
        if given.spin && (fretting || spec.third_body.is_some()) {
            return Err(source.error_at(
                "profiles.spin",
                "spin is that of bodies that roll, without a `third_body`, whose windows slip along the rolling: leave it out",
            ));
        }
        let names = ["profiles.first", "profiles.second"];
        let mut profiles = Vec::new();
        let mut places = Vec::new();
        let mut radii = [None; 2];
        for (k, profile) in [&given.first, &given.second].into_iter().enumerate() {
            let (own, place) = profile.read(file, names[k])?;
            if let Some(radius) = &bodies[k].radius {
                let radius = value(source, &format!("bodies.{k}.radius"), radius, "m")?;
                // It is that of the file's y = 0, which turns with the profile.
                let height = own.knows(0.0).then(|| own.at(0.0) * place.turn.cos());
                radii[k] = Some((radius, height));
            }
            profiles.push(place.put(&own).ok_or_else(|| {
                source.error_at(
                    &format!("{}.turn", names[k]),
                    format!(
                        "turned by {}, the height of the profile is no function of y: leave out the rows of its file that overhang",
                        quantity(place.turn, "rad")
                    ),
                )
            })?);
            places.push(place);
        }
        let [first, second] = [&profiles[0], &profiles[1]];
        let fail = |error: TouchingError| untouched(file, error, [first, second]);
        let mut pair = Pair {
            profiles: [first.clone(), second.clone()],
            radii: [None; 2],
        };
        let [at, down] = pair.put_down().map_err(fail)?;
        for (k, radius) in radii.into_iter().enumerate() {
            let own = |height: f64| if k == 0 { height - down } else { height };
            pair.radii[k] = radius.map(|(radius, height)| Radius {
                radius,
                height: height.map_or_else(|| pair.profiles[k].at(at), own),
            });
        }
        let touching = pair.about(at).map_err(fail)?;
        Ok(Some(Self {
            pair,
            down,
            places: [places[0], places[1]],
            touching,
            pressed: [-NEAR, NEAR],
            approach: 0.0,
            spin: given.spin,
            vertical: given.vertical,
        }))
    }

    /// Returns the distance of the bodies in the frame of their contact.
    pub fn distance(&self) -> Distance {
        let touching = &self.touching;
        Distance {
            curvatures: [
                touching.along.at(0.0),
                touching.distance.curvature(self.pressed),
            ],
            profile: Some(touching.distance.clone()),
            along: Some(touching.along.clone()),
        }
    }

    /// Returns the normal force under a load of the file (N): the vertical load is that of the
    /// normal force alone, without the forces across the rolling.
    pub fn normal_force(&self, load: f64) -> f64 {
        match self.vertical {
            true => load / self.touching.inclination.cos(),
            false => load,
        }
    }

    /// Spin creepage that adds to that of the motion (1/m).
    pub fn added_spin(&self) -> f64 {
        if self.spin { self.touching.spin() } else { 0.0 }
    }

    /// Returns what is told of the contact, under a normal force (N).
    pub fn contact(&self, force: f64) -> Contact {
        let touching = &self.touching;
        let signs = [1.0, -1.0];
        let across = |k: usize| signs[k] * touching.profiles[k].curvature(self.pressed);
        let others = touching.others(self.pressed, self.approach).into_iter();
        Contact {
            places: self.on_profiles(0.0),
            inclination: touching.inclination,
            inclinations: touching.inclinations(self.pressed),
            rolling_radii: touching.radii,
            along: touching.along.at(0.0),
            across: [across(0), across(1)],
            spin: touching.spin(),
            spin_used: self.spin,
            vertical_load: force * touching.inclination.cos(),
            others: others
                .map(|[s, distance]| Other {
                    places: self.on_profiles(s),
                    distance,
                    inclination: touching.inclinations([s, s])[1],
                })
                .collect(),
        }
    }

    /// Returns a place of the frame on each profile, by the places of its file (m).
    fn on_profiles(&self, s: f64) -> [f64; 2] {
        let at = self.touching.place(s);
        let heights = [self.down, 0.0];
        [0, 1].map(|k| self.places[k].own(at, heights[k] + self.pair.profiles[k].at(at)))
    }

    /// Refuses rows farther apart than the cells of a grid under the patch.
    fn check_rows(&self, file: &PatchFile, cell: f64) -> Result<(), InputError> {
        for (k, name) in ["first", "second"].into_iter().enumerate() {
            let rows = self.touching.profiles[k].places().windows(2);
            let under = rows.filter(|w| w[1] > self.pressed[0] && w[0] < self.pressed[1]);
            let widest = under.map(|w| w[1] - w[0]).fold(0.0, f64::max);
            if widest > cell {
                let most = (file.spec.cells as f64 * cell / widest) as usize / 2 * 2;
                return Err(file.source.error_at(
                    &format!("profiles.{name}.file"),
                    format!(
                        "rows of the profile are {} apart under the patch, and cells are {} wide: give closer rows, or at most {most} `cells`",
                        quantity(widest, "m"),
                        quantity(cell, "m")
                    ),
                ));
            }
        }
        Ok(())
    }
}

/// Puts the frame of two profiles about the centre of the pressures of a load (N); returns the
/// normal force (N).
///
/// # Errors
/// The patch is not found, or the rows of a profile are too far apart for its cells.
pub fn settle(file: &PatchFile, bodies: &mut Bodies, load: f64) -> Result<f64, Error> {
    let Some(mut profiles) = bodies.profiles.clone() else {
        return Ok(load);
    };
    let mut force = profiles.normal_force(load);
    for _ in 0..TIMES {
        let grid = grid(bodies, force, CELLS)?;
        let surfaces = Surfaces::new(grid, bodies.elasticity, 0.0);
        let distance = (0..grid.len()).map(|c| bodies.distance.at(grid.middle(c)));
        let distance: Vec<f64> = distance.collect();
        let found = normal(&surfaces, &distance, force, None);
        let found = found.map_err(|e| Error::Failed(e.to_string()))?;
        let cells = found.pressure.iter().enumerate();
        let cells = cells.filter(|(_, p)| **p > 0.0);
        let mut cells: Vec<(f64, f64)> = cells.map(|(c, p)| (grid.middle(c)[1], *p)).collect();
        // Rows without pressure part two patches: the frame is that of the larger pressure.
        let top = cells.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let top = top.map_or(0.0, |cell| cell.0);
        let (mut ends, next) = ([top; 2], 1.5 * grid.size[1]);
        for (s, _) in cells.iter().filter(|c| c.0 > top) {
            if s - ends[1] < next {
                ends[1] = *s;
            }
        }
        for (s, _) in cells.iter().rev().filter(|c| c.0 < top) {
            if ends[0] - s < next {
                ends[0] = *s;
            }
        }
        cells.retain(|(s, _)| (ends[0]..=ends[1]).contains(s));
        let half = 0.5 * grid.size[1];
        let ends = [ends[0] - half, ends[1] + half];
        let centre = cells.iter().map(|(s, p)| s * p).sum::<f64>()
            / cells.iter().map(|(_, p)| p).sum::<f64>();
        profiles.pressed = ends;
        profiles.approach = found.approach;
        bodies.distance = profiles.distance();
        if centre.abs() <= SETTLED * (ends[1] - ends[0]) {
            break;
        }
        let moved = profiles.pair.about(profiles.touching.place(centre));
        profiles.touching = moved.map_err(|e| Error::Failed(e.to_string()))?;
        profiles.pressed = ends.map(|s| s - centre);
        bodies.distance = profiles.distance();
        force = profiles.normal_force(load);
    }
    profiles.check_rows(file, grid(bodies, force, file.spec.cells)?.size[1])?;
    bodies.profiles = Some(profiles);
    Ok(force)
}

/// Returns why two profiles do not touch as bodies that roll do.
fn untouched(file: &PatchFile, error: TouchingError, both: [&Curve; 2]) -> InputError {
    let range = |k: usize| {
        let [from, to] = both[k].ends().map(|x| quantity(x, "m"));
        format!("from {from} to {to}")
    };
    match error {
        TouchingError::Apart => file.source.error_at(
            "profiles",
            format!(
                "the profiles do not overlap: with its `shift` the first one goes {}, the second one {}",
                range(0),
                range(1)
            ),
        ),
        TouchingError::AtEnd { body, at } => file.source.error_at(
            &format!("profiles.{}", ["first", "second"][body]),
            format!(
                "the bodies touch at the end of this profile, y = {}: measure it farther, mend a `shift`, or give `down: true` to a file whose z points downwards",
                quantity(at, "m")
            ),
        ),
    }
}
