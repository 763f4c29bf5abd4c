//! The profiles of a file: how they are given, read and put in their places.

use crate::patch::columns::column;
use crate::patch::spec::{PatchFile, value};
use fretwork_observe::quantity::quantity;
use fretwork_rolling::Curve;
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::measured::MeasuredTable;
use serde::Deserialize;
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

/// How a profile is put in its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    sign: f64,
    pub turn: f64,
    shift: f64,
}

impl ProfileSpec {
    /// Reads the profile: by the places and heights of its file, upwards and ascending.
    pub(super) fn read(&self, file: &PatchFile, at: &str) -> Result<(Curve, Place), InputError> {
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
        let lengths = |name: &str| column(source, &path, &table, (name, "m"));
        let rows = lengths(&self.y)?.into_iter().zip(lengths(&self.z)?);
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
    pub(super) fn put(self, own: &Curve) -> Option<Curve> {
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
    pub(super) fn own(self, at: f64, height: f64) -> f64 {
        let (sin, cos) = self.turn.sin_cos();
        self.sign * ((at - self.shift) * cos + height * sin)
    }
}
