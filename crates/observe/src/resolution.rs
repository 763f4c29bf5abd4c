//! How many elements lie across a contact of deformable bodies, and what that does to the heat of partial slip.
//!
//! Where a part of a contact sticks, heat is made in the strip that slips alone, of w elements. Its heat is off by a share of
//!
//! * 0.3/w at most in cycles of a tangential force, against Cattaneo and Mindlin: 24, 14, 7, 3.6 and 1.6 % at w = 1.2, 1.3, 2.3, 2.7 and 5.5;
//! * 1/(w + 0.6) in rolling by one cell a step, too low, against Carter: 56, 39, 22, 12, 6 and 3.6 % at w = 1, 2, 4, 8, 16 and 28
//!
//! (`tests/physics/elastic/resolution.rs`; `docs/half_spaces.md`). A strip of less than an element may have no heat at all.

use super::tractions::loaded;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Error of the heat of cycles times the elements across what slips.
const OF_CYCLES: f64 = 0.3;
/// Elements that the error of the heat of rolling is short of.
const OF_ROLLING: f64 = 0.6;
/// Fewest contacts with one body that are a contact of surfaces.
const FEWEST: usize = 4;
/// Share of the load of a body that a counterpart carries where the two are a contact of surfaces.
const MOST: f64 = 0.5;
/// Error of the heat from which it is worth a note, and from which it is a reason not to trust it.
const LIMITS: [f64; 2] = [0.05, 0.2];

/// Elements across the contact of a deformable body, over the rows of the statistics.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Resolution {
    /// Name of the body.
    pub body: String,
    /// Loaded elements over the width of the contact, in 3D over its mean diameter, at the row where these are fewest while it slips in
    /// part, and otherwise at the last row with a load.
    pub across: f64,
    /// Elements over what sticks there, and over the width of each strip that slips; none where it never sticks and slips at once.
    pub stick: Option<f64>,
    /// See `stick`.
    pub slip: Option<f64>,
    /// Estimated error of the heat of friction over the run, as a share: too low in rolling.
    pub heat_error: f64,
    /// Heat over the rows, and that times its error (J; J/m).
    #[serde(skip)]
    sums: [f64; 2],
    /// Heat of all contacts up to the last row (J; J/m).
    #[serde(skip)]
    before: f64,
    /// Whether its material, or that of what touches it, passes.
    #[serde(skip)]
    rolls: bool,
}

/// What is kept over a pause.
pub type State = (f64, Option<f64>, Option<f64>, [f64; 2], f64);

impl Resolution {
    /// Of a system that touches.
    pub fn new(body: &str, rolls: bool) -> Self {
        Self {
            body: body.to_owned(),
            rolls,
            ..Self::default()
        }
    }

    /// All of it, to go on after a pause.
    pub fn state(&self) -> State {
        (self.across, self.stick, self.slip, self.sums, self.before)
    }

    /// Goes on after a pause.
    pub fn restore(&mut self, (across, stick, slip, sums, before): State) {
        (self.across, self.stick, self.slip) = (across, stick, slip);
        (self.sums, self.before) = (sums, before);
        self.heat_error = share(sums);
    }

    /// Adds a row of the statistics: the state of a system after its last step, with the heat of friction of all contacts so far (J; J/m).
    pub fn add<S: Space>(&mut self, s: &Simulation<S>, system: usize, heat: f64) {
        let made = (heat - self.before).max(0.0);
        self.before = heat;
        let Some(strip) = Strip::of(s, system) else {
            return;
        };
        let partial = strip.stick > 0.0 && strip.slip > 0.0;
        if partial && self.slip.is_none_or(|w| strip.slip < w) {
            (self.across, self.stick, self.slip) =
                (strip.across, Some(strip.stick), Some(strip.slip));
        } else if self.slip.is_none() {
            self.across = strip.across;
        }
        let error = match (partial, self.rolls) {
            (false, _) => 0.0,
            (true, true) => 1.0 / (strip.slip + OF_ROLLING),
            (true, false) if strip.slip < 1.0 => 1.0,
            (true, false) => OF_CYCLES / strip.slip,
        };
        self.sums[0] += made;
        self.sums[1] += made * error.min(1.0);
        self.heat_error = share(self.sums);
    }

    /// The counts and what they do to the heat, for the summary.
    pub fn line(&self) -> String {
        let error = 100.0 * self.heat_error;
        match (self.stick, self.slip) {
            (Some(stick), Some(slip)) => format!(
                "{:.0}, {stick:.0} over what sticks and {slip:.1} over a strip that slips where these are fewest; error of the heat of friction about {error:.1} %",
                self.across
            ),
            _ => format!(
                "{:.0}; it never slips in part (a strip of less than an element would slip without heat)",
                self.across
            ),
        }
    }

    /// What that means for the result, and whether it is a reason not to trust it.
    pub fn warning(&self) -> Option<(bool, String)> {
        let [note, reason] = LIMITS;
        (self.heat_error > note).then(|| {
            let strips = match (self.stick, self.slip) {
                (Some(stick), Some(slip)) => {
                    format!(", {stick:.0} over what sticks and {slip:.1} over each strip that slips")
                }
                _ => String::new(),
            };
            let way = if self.rolls {
                "is too low by about"
            } else {
                "may be off by"
            };
            let text = format!(
                "{:.0} elements of `{}` lie across the contact{strips} where these are fewest: the heat of friction {way} {:.0} %; take \
                 smaller elements where the bodies touch (docs/half_spaces.md, accuracy)",
                self.across,
                self.body,
                100.0 * self.heat_error
            );
            (self.heat_error > reason, text)
        })
    }
}

fn share([all, off]: [f64; 2]) -> f64 {
    if off > 0.0 { off / all } else { 0.0 }
}

/// Elements over a contact, over what sticks, and over the width of each strip that slips.
struct Strip {
    across: f64,
    stick: f64,
    slip: f64,
}

/// Of a point in contact: its place along the strip, what it carries, and whether it slips.
type Loaded = (f64, f64, bool);
/// A body, or a system of bodies, on the other side.
type Counterpart = (u32, u32);
/// A point of a deformable body may touch several facets at their corner; points of other bodies are told apart by their contacts.
type Point = (u32, usize);

impl Strip {
    /// Of a system and the body that carries most of its load; none where it touches many bodies.
    fn of<S: Space>(s: &Simulation<S>, system: usize) -> Option<Self> {
        // Bodies of one system are one counterpart.
        let mut all: BTreeMap<Counterpart, BTreeMap<Point, Loaded>> = BTreeMap::new();
        let mut total = 0.0;
        for (k, acting) in loaded(s, system).enumerate() {
            let other = acting.contact.bodies[1 - acting.side];
            let carrier = s.state.bodies.carrier(other as usize);
            let counterpart = carrier.map_or((1, other), |c| (0, c.system));
            let own = acting.contact.bodies[acting.side];
            let place = s.state.bodies.position[own as usize] + acting.contact.arms[acting.side];
            let load = acting.force.norm();
            total += load;
            let slides = acting.contact.slides;
            let candidate = acting.contact.bodies[0];
            let is_point = s.state.bodies.carrier(candidate as usize).is_some();
            let point = (candidate, if is_point { 0 } else { k });
            let points = all.entry(counterpart).or_default();
            let of_point = points.entry(point).or_insert((place[0], 0.0, slides));
            of_point.1 += load;
            of_point.2 &= slides;
        }
        let load = |list: &[Loaded]| list.iter().map(|c| c.1).sum::<f64>();
        let lists = all
            .into_values()
            .map(|points| points.into_values().collect());
        let mut most: Vec<Loaded> =
            lists.max_by(|a: &Vec<Loaded>, b| load(a).total_cmp(&load(b)))?;
        if most.len() < FEWEST || load(&most) < MOST * total {
            return None;
        }
        let count = most.len() as f64;
        let slipping = most.iter().filter(|c| c.2).count() as f64;
        if S::D == 3 {
            let diameter = |n: f64| 2.0 * (n / std::f64::consts::PI).sqrt();
            let (across, stick) = (diameter(count), diameter(count - slipping));
            return Some(Self {
                across,
                stick,
                slip: 0.5 * (across - stick),
            });
        }
        most.sort_by(|a, b| a.0.total_cmp(&b.0));
        let begins = |k: usize| most[k].2 && (k == 0 || !most[k - 1].2);
        let strips = (0..most.len()).filter(|k| begins(*k)).count().max(1);
        Some(Self {
            across: count,
            stick: count - slipping,
            slip: slipping / strips as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(heat_error: f64, slip: Option<f64>) -> Resolution {
        Resolution {
            across: 8.0,
            stick: slip.map(|_| 6.0),
            slip,
            heat_error,
            ..Resolution::new("flat", false)
        }
    }

    #[test]
    fn coarse_contacts_are_told() {
        assert_eq!(of(0.04, Some(7.0)).warning(), None);
        let (serious, text) = of(0.15, Some(2.0)).warning().unwrap();
        assert!(!serious && text.contains("off by 15 %"), "{text}");
        assert!(text.contains("8 elements of `flat`") && text.contains("2.0 over each strip"));
        assert!(of(0.3, Some(1.0)).warning().unwrap().0);
    }

    #[test]
    fn a_pause_loses_nothing() {
        let mut kept = of(0.5, Some(2.0));
        kept.sums = [2.0, 1.0];
        let mut other = Resolution::new("flat", false);
        other.restore(kept.state());
        assert_eq!(other, kept);
    }
}
