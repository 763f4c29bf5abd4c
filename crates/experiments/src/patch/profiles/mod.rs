//! Profiles of both bodies across the motion: read from files, put in their places, and the contact
//! about which they touch under the load.

#[cfg(test)]
mod tests;

use super::bodies::{Bodies, Distance};
use super::setup::grid;
use super::spec::{MotionSpec, PatchFile, value};
use crate::Error;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::{Curve, Pair, Radius, Surfaces, Touching, TouchingError, normal};
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::measured::MeasuredTable;
use fretwork_scene::units;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Profiles of both bodies, the first of which is above.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfilesSpec {
    /// That of the first body.
    pub first: ProfileSpec,
    /// That of the second body.
    pub second: ProfileSpec,
    /// Whether the spin of the contact angle adds to that of the motion.
    #[serde(default)]
    pub spin: bool,
    /// Whether the load is vertical, not along the normal of the contact.
    #[serde(default)]
    pub vertical: bool,
}

/// A profile in its place: mirrored, then turned about the origin of its file, then shifted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfileSpec {
    /// A CSV file with headings, relative to the file of the patch.
    pub file: PathBuf,
    /// Heading of the places across the motion.
    #[serde(default = "y")]
    pub y: String,
    /// Heading of the heights.
    #[serde(default = "z")]
    pub z: String,
    /// Whether places are counted the other way round.
    #[serde(default)]
    pub mirrored: bool,
    /// Whether heights are counted downwards.
    #[serde(default)]
    pub down: bool,
    /// Angle by which it is turned, from y to z upwards (rad).
    #[serde(default)]
    pub turn: Option<NumberSpec>,
    /// Distance by which it is shifted along y (m).
    #[serde(default)]
    pub shift: Option<NumberSpec>,
}

fn y() -> String {
    "y".into()
}

fn z() -> String {
    "z".into()
}

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

/// How a profile is put in its place.
#[derive(Clone, Copy, Debug)]
struct Place {
    sign: f64,
    turn: f64,
    shift: f64,
}

/// What is told of the contact of two profiles, in SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Contact {
    /// Middle of the patch, the centre of its pressures, on each profile, by the places of its
    /// file.
    pub places: [f64; 2],
    /// Contact angle: inclination of the common tangent there.
    pub inclination: f64,
    /// Least and largest inclination over the patch.
    pub inclinations: [f64; 2],
    /// Rolling radii there, of bodies that are no plane along the motion.
    pub rolling_radii: [Option<f64>; 2],
    /// Relative curvature along the motion there, in the frame of the contact.
    pub along: f64,
    /// Curvatures of the profiles across the motion, fitted over the patch: above 0 where a body is
    /// convex.
    pub across: [f64; 2],
    /// Spin creepage of the contact angle.
    pub spin: f64,
    /// Whether it adds to that of the motion.
    pub spin_used: bool,
    /// Vertical part of the normal force.
    pub vertical_load: f64,
    /// Other places that are closer than the approach of the bodies: place on each profile,
    /// distance and inclination.
    pub others: Vec<Other>,
}

/// A place beside the patch at which the bodies may touch too.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Other {
    /// The place on each profile, by the places of its file.
    pub places: [f64; 2],
    /// The distance before the bodies approach.
    pub distance: f64,
    /// Inclination there.
    pub inclination: f64,
}

/// Half of the width over which curvatures are fitted to begin with (m).
const NEAR: f64 = 1.5e-3;
/// Cells of the grid on which the middle of the patch is found.
const CELLS: usize = 48;
/// Distance of the middle of the patch from the origin of its frame over its width at which it is
/// found, and the most times that it is moved.
const SETTLED: f64 = 5e-3;
const TIMES: usize = 12;
/// Change of the inclination over a patch that is no longer small beside the plane of half-spaces
/// (rad).
const FLAT: f64 = 0.2;

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
        let cells: Vec<(f64, f64)> = cells.map(|(c, p)| (grid.middle(c)[1], *p)).collect();
        let half = 0.5 * grid.size[1];
        let ends = cells
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], (s, _)| {
                [from.min(s - half), to.max(s + half)]
            });
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

impl ProfileSpec {
    /// Reads the profile: by the places and heights of its file, upwards and ascending.
    fn read(&self, file: &PatchFile, at: &str) -> Result<(Curve, Place), InputError> {
        let source = &file.source;
        let number = |name: &str, given: &Option<NumberSpec>, unit: &str| {
            let number = given.as_ref();
            let number = number.map(|n| value(source, &format!("{at}.{name}"), n, unit));
            Ok::<f64, InputError>(number.transpose()?.unwrap_or(0.0))
        };
        let place = Place {
            sign: if self.mirrored { -1.0 } else { 1.0 },
            turn: number("turn", &self.turn, "rad")?,
            shift: number("shift", &self.shift, "m")?,
        };
        let path = format!("{at}.file");
        let table = MeasuredTable::read(&file.beside(&self.file));
        let table = table.map_err(|e| source.named_at(&path, e))?;
        let column = |name: &str| -> Result<Vec<f64>, InputError> {
            let column = table
                .required(name)
                .map_err(|e| source.named_at(&path, e))?;
            let unit = &table.headings[column].unit;
            if unit.is_empty() {
                let why = format!(
                    "the heading `{name}` has no unit: write it as `{name} [mm]`, in the unit of its numbers"
                );
                return Err(source.error_at(&path, why));
            }
            let in_metres = |v: f64| units::convert(v, unit, "m");
            let values = table.values(column)?.into_iter().map(in_metres);
            let values: Result<Vec<f64>, _> = values.collect();
            values.map_err(|e| source.error_at(&path, format!("column `{name}`: {}", e.message)))
        };
        let rows = column(&self.y)?.into_iter().zip(column(&self.z)?);
        let down = if self.down { -1.0 } else { 1.0 };
        let rows: Vec<[f64; 2]> = rows.map(|(y, z)| [y, down * z]).collect();
        let onwards = rows.len() > 1 && rows[1][0] > rows[0][0];
        let back = rows
            .windows(2)
            .find(|w| w[0][0] == w[1][0] || (w[1][0] > w[0][0]) != onwards);
        if let Some(back) = back {
            let why = format!(
                "the profile overhangs: after {} = {} comes {}, so that the height is no function of it; leave out the rows beyond, or sort them",
                self.y,
                quantity(back[0][0], "m"),
                quantity(back[1][0], "m")
            );
            return Err(source.error_at(&path, why));
        }
        match rows.len() < 3 {
            true => Err(source.error_at(&path, "a profile has three rows or more")),
            false => Curve::through(rows)
                .map(|curve| (curve, place))
                .ok_or_else(|| source.error_at(&path, "a profile has finite numbers")),
        }
    }
}

impl Place {
    /// Returns a profile in its place, if it is a function there.
    fn put(self, own: &Curve) -> Option<Curve> {
        let (sin, cos) = self.turn.sin_cos();
        let rows = own.places().iter().zip(own.values());
        let turned = rows.map(|(y, z)| {
            let y = self.sign * y;
            [y * cos - z * sin + self.shift, y * sin + z * cos]
        });
        let turned: Vec<[f64; 2]> = turned.collect();
        let onwards = turned
            .windows(2)
            .all(|w| (w[1][0] - w[0][0]) * self.sign > 0.0);
        onwards.then(|| Curve::through(turned)).flatten()
    }

    /// Returns the place in the file of a point in its place (m).
    fn own(self, at: f64, height: f64) -> f64 {
        let (sin, cos) = self.turn.sin_cos();
        self.sign * ((at - self.shift) * cos + height * sin)
    }
}

impl Contact {
    /// Returns lines with their labels.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let places = self.places.map(|y| quantity(y, "m"));
        let degrees = |angle: f64| number(angle.to_degrees(), 4);
        let [low, high] = self.inclinations.map(degrees);
        let radii = self.rolling_radii.iter().flatten();
        let radii: Vec<String> = radii.map(|r| quantity(*r, "m")).collect();
        let [first, second] = self.across.map(|c| quantity(1.0 / c, "m"));
        let used = match self.spin_used {
            true => "added to that of the motion",
            false => "not used; `spin: true` adds it",
        };
        vec![
            (
                "contact",
                format!(
                    "at {} of the first profile and {} of the second, inclined by {} deg ({low} to {high} over the patch)",
                    places[0],
                    places[1],
                    degrees(self.inclination)
                ),
            ),
            (
                "radii",
                format!(
                    "rolling {}, along the motion {}, across {first} and {second}",
                    radii.join(" and "),
                    quantity(1.0 / self.along, "m")
                ),
            ),
            (
                "spin of the angle",
                format!("{}, {used}", quantity(self.spin, "1/m")),
            ),
            (
                "vertical load",
                format!("{} of the normal force", quantity(self.vertical_load, "N")),
            ),
        ]
    }

    /// Returns what limits the trust in a patch of these profiles.
    pub fn notes(&self) -> Vec<String> {
        let others = self.others.iter().map(|other| {
            format!(
                "NOT ONE PATCH: at {} of the first profile the bodies are {} apart, less than they approach, and inclined by {} deg: they may touch there too, and each contact has its own normal and load",
                quantity(other.places[0], "m"),
                quantity(other.distance, "m"),
                number(other.inclination.to_degrees(), 3)
            )
        });
        let mut notes: Vec<String> = others.collect();
        let turns = self.inclinations[1] - self.inclinations[0];
        if turns > FLAT {
            notes.push(format!(
                "NOT IN RANGE: the surfaces turn by {} deg over the patch, and half-spaces are plane",
                number(turns.to_degrees(), 3)
            ));
        }
        notes
    }
}
