//! What is told of the contact of two profiles: numbers, lines, notes and pictures.

use super::Profiles;
use crate::page::section;
use fretwork_observe::quantity::{number, quantity};
use fretwork_view::{Axis, Block, Chart, Section, Series};
use serde::Serialize;

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

/// Profiles are shown as far as this from their contact (m).
const SHOWN: f64 = 0.05;
/// Change of the inclination over a patch that is no longer small beside the plane of half-spaces
/// (rad).
const FLAT: f64 = 0.2;

impl Profiles {
    /// Returns pictures of both profiles and of their distance.
    pub fn section(&self) -> Section {
        let axis = |name: &str, unit: &str| Axis::new(name, unit);
        let touching = &self.touching;
        let profile = |k: usize| {
            let rows = self.pair.profiles[k].places().iter();
            let rows = rows.filter(|y| (*y - touching.middle[0]).abs() < SHOWN);
            let rows = rows.map(|y| (1e3 * y, 1e3 * self.pair.profiles[k].at(*y)));
            Series::new(["first body", "second body"][k], rows.collect())
        };
        let profiles = Chart::new("profiles", axis("across", "mm"), axis("height", "mm"));
        let [from, to] = self.pressed;
        let half = to - from;
        let rows = touching.distance.places().iter();
        let rows = rows.filter(|s| (from - half..=to + half).contains(*s));
        let rows = rows.map(|s| (1e3 * s, 1e6 * touching.distance.at(*s)));
        let distance = Chart::new(
            "distance before the bodies approach",
            axis("along the tangent", "mm"),
            axis("distance", "um"),
        );
        let charts = [
            profiles.with(profile(0)).with(profile(1)),
            distance.with(Series::new("", rows.collect())),
        ];
        let blocks = charts.map(|chart| Block::Figure(Box::new(chart)));
        section("Profiles", blocks.into())
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
