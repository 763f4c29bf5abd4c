//! Number of elements across a contact of deformable bodies, and its effect on the heat of partial
//! slip.
//!
//! Where a part of a contact sticks, heat is produced only in the slip strip, of w elements. The
//! relative error of this heat is
//!
//! * 0.3/w at most in cycles of a tangential force, against Cattaneo and Mindlin: 24, 14, 7, 3.6
//!   and 1.6 % at w = 1.2, 1.3, 2.3, 2.7 and 5.5;
//! * 1/(w + 0.6) in rolling by one cell a step, too low, against Carter: 56, 39, 22, 12, 6 and 3.6
//!   % at w = 1, 2, 4, 8, 16 and 28
//!
//! (`tests/physics/elastic/resolution.rs`; `docs/half_spaces.md`). A strip of less than an element
//! may have no heat at all.

use super::quantity::unit::{ONE, WORD};
use super::quantity::{Findings, Topic};
use super::tractions::loaded;
use super::warning::Warning;
use fretwork_core::view::RunView;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Relative error of the heat of cycles times the number of elements across the slip strip.
const OF_CYCLES: f64 = 0.3;
/// Number of elements that is added in the error of the heat of rolling.
const OF_ROLLING: f64 = 0.6;
/// Smallest number of contacts with one body that form a contact of surfaces.
const MIN_CONTACTS: usize = 4;
/// Share of the largest load of a contact above which a contact counts: some methods leave small
/// forces on points that do not touch.
const TRACE: f64 = 1e-3;
/// Share of the load of a body that a counterpart must carry for the two to form a contact of
/// surfaces.
const MIN_LOAD_SHARE: f64 = 0.5;
/// Number of elements across a contact below which the error of cycles is a lower bound: with four
/// elements the estimate is 29 % for an error of 63 %.
const MIN_RESOLVED_ELEMENTS: f64 = 8.0;
/// Errors of the heat above which a note, and a serious warning, are given.
const LIMITS: [f64; 2] = [0.05, 0.2];

crate::described! {
    /// Number of elements across the contact of a deformable body, over the rows of the statistics.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Resolution {
        /// Name of the body.
        pub body: String => WORD,
        /// Loaded elements over the width of the contact, in 3D over its mean diameter, at the row
        /// where these are fewest while it slips in part, and otherwise at the last row with a
        /// load.
        pub across: f64 => ONE,
        /// Elements over what sticks there; null where it never sticks and slips at once.
        pub stick: Option<f64> => ONE,
        /// Elements over the width of each strip that slips there; null where it never sticks and
        /// slips at once.
        pub slip: Option<f64> => ONE,
        /// Estimated error of the heat of friction over the run, as a share: too low in rolling.
        pub heat_error: f64 => ONE,
        /// Heat over the rows, and that times its error.
        #[serde(skip)]
        sums: [f64; 2],
        /// Heat of all contacts up to the last row.
        #[serde(skip)]
        before: f64,
        /// Whether the material of the body, or of its counterpart, passes through the surface, at
        /// the last row with a load.
        #[serde(skip)]
        rolls: bool,
    }
}

/// State that is kept over a pause.
pub type ResolutionState = (f64, Option<f64>, Option<f64>, [f64; 2], f64, bool);

impl Resolution {
    /// Creates the result of a system with contacts.
    pub fn new(body: &str) -> Self {
        Self {
            body: body.to_owned(),
            ..Self::default()
        }
    }

    /// Returns the state, to continue after a pause.
    pub fn state(&self) -> ResolutionState {
        (
            self.across,
            self.stick,
            self.slip,
            self.sums,
            self.before,
            self.rolls,
        )
    }

    /// Restores the state after a pause.
    pub fn restore(&mut self, (across, stick, slip, sums, before, rolls): ResolutionState) {
        (self.across, self.stick, self.slip) = (across, stick, slip);
        (self.sums, self.before, self.rolls) = (sums, before, rolls);
        self.heat_error = share(sums);
    }

    /// Adds a row of the statistics: the state of a system after its last step, with the heat of
    /// friction of all contacts so far (J; J/m). `rolls` says for each system whether its material
    /// passes.
    pub fn add(&mut self, run: &dyn RunView, system: usize, rolls: &[bool], heat: f64) {
        let made = (heat - self.before).max(0.0);
        self.before = heat;
        let Some(strip) = Strip::of(run, system) else {
            return;
        };
        let passes = |system: Option<usize>| {
            let of = system.and_then(|system| rolls.get(system));
            of.copied().unwrap_or(false)
        };
        self.rolls = passes(Some(system)) || passes(strip.system);
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

    /// Returns whether the error is a lower bound: in cycles, where few elements do not resolve the
    /// strips.
    fn is_least(&self) -> bool {
        !self.rolls
            && self.across < MIN_RESOLVED_ELEMENTS
            && self.heat_error > 0.0
            && self.heat_error < 1.0
    }

    /// Returns a sentence on the numbers of elements and their effect on the heat, for the summary.
    pub fn line(&self) -> String {
        let error = 100.0 * self.heat_error;
        let about = if self.across < MIN_RESOLVED_ELEMENTS {
            "more than"
        } else {
            "about"
        };
        match (self.stick, self.slip) {
            (Some(stick), Some(slip)) => format!(
                "{:.0}, {stick:.0} over what sticks and {slip:.1} over a strip that slips where these are fewest; error of the heat of friction {about} {error:.1} %",
                self.across
            ),
            _ => format!(
                "{:.0}; it never slips in part (a strip of less than an element would slip without heat)",
                self.across
            ),
        }
    }

    /// Returns a warning on the effect on the result, and whether the result is not trustworthy
    /// because of it.
    pub fn warning(&self) -> Option<(bool, String)> {
        let [note, reason] = LIMITS;
        (self.heat_error > note).then(|| {
            let strips = match (self.stick, self.slip) {
                (Some(stick), Some(slip)) => {
                    format!(", {stick:.0} over what sticks and {slip:.1} over each strip that slips")
                }
                _ => String::new(),
            };
            let way = match (self.rolls, self.is_least()) {
                (true, _) => "is too low by about",
                (false, true) => "may be off by more than",
                (false, false) => "may be off by",
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

/// Adds the contacts of all bodies, with a sentence and a warning for the one with the largest
/// error of the heat. Two bodies that touch each other have one contact.
pub(crate) fn report(contacts: Vec<Resolution>, found: &mut Findings) {
    let all = contacts.iter().enumerate();
    let Some((k, worst)) = all.max_by(|(_, a), (_, b)| a.heat_error.total_cmp(&b.heat_error))
    else {
        return;
    };
    found.parts::<Resolution>("resolution", &contacts, "");
    found.edit(&format!("resolution.{k}.across"), |q| {
        q.about(Topic::Measures)
            .secondary(format!("elements across the contact of {}", worst.body));
        q.sentence("elements across", worst.line());
    });
    found.warn(worst.warning().map(|(reason, text)| match reason {
        true => Warning::serious("COARSE CONTACT", text),
        false => Warning::note("COARSE CONTACT", text),
    }));
}

fn share([all, off]: [f64; 2]) -> f64 {
    if off > 0.0 { off / all } else { 0.0 }
}

/// Number of elements over a contact, over its stick area, and over the width of each slip strip.
struct Strip {
    across: f64,
    stick: f64,
    slip: f64,
    /// The system that carries most of the load, where the counterpart is a system.
    system: Option<usize>,
}

/// A point in contact.
#[derive(Clone, Copy, Debug)]
struct LoadedPoint {
    place: Vector3<f64>,
    /// Normal of the counterpart times the load, and the load (N; N/m).
    pushes: Vector3<f64>,
    load: f64,
    slips: bool,
}

/// A body, or a system of bodies, on the other side.
type Counterpart = (u32, u32);
/// A point of a deformable body may touch several facets at their corner; points of other bodies
/// are distinguished by their contacts.
type Point = (u32, usize);

impl Strip {
    /// Returns the result of a system and the body that carries most of its load; `None` where it
    /// touches many bodies.
    fn of(run: &dyn RunView, system: usize) -> Option<Self> {
        // Bodies of one system are one counterpart.
        let mut all: BTreeMap<Counterpart, BTreeMap<Point, LoadedPoint>> = BTreeMap::new();
        let mut total = 0.0;
        let bodies = run.bodies();
        for (k, acting) in loaded(run, system).into_iter().enumerate() {
            let other = acting.contact.bodies[1 - acting.side];
            let carrier = bodies.carrier(other as usize);
            let counterpart = carrier.map_or((1, other), |c| (0, c.system));
            let own = acting.contact.bodies[acting.side];
            let load = acting.force.norm();
            total += load;
            let candidate = acting.contact.bodies[0];
            let is_point = bodies.carrier(candidate as usize).is_some();
            let point = (candidate, if is_point { 0 } else { k });
            let points = all.entry(counterpart).or_default();
            let of_point = points.entry(point).or_insert(LoadedPoint {
                place: Vector3::from(bodies.position.at(own as usize))
                    + Vector3::from(acting.contact.arms[acting.side]),
                pushes: Vector3::zeros(),
                load: 0.0,
                slips: true,
            });
            let towards = if acting.side == 0 { load } else { -load };
            of_point.pushes += Vector3::from(acting.contact.normal) * towards;
            of_point.load += load;
            of_point.slips &= acting.contact.slides;
        }
        let lists = all.into_iter().map(|((kind, other), points)| {
            let system = (kind == 0).then_some(other as usize);
            (system, points.into_values().collect::<Vec<_>>())
        });
        let sum = |list: &[LoadedPoint]| list.iter().map(|c| c.load).sum::<f64>();
        let (other, most) = lists.max_by(|(_, a), (_, b)| sum(a).total_cmp(&sum(b)))?;
        if sum(&most) < MIN_LOAD_SHARE * total {
            return None;
        }
        let strip = Self::across(run.dimension(), most)?;
        Some(Self {
            system: other,
            ..strip
        })
    }

    /// Returns the result of the points that touch one counterpart; `None` where these are few.
    fn across(dimension: usize, mut most: Vec<LoadedPoint>) -> Option<Self> {
        let largest = most.iter().map(|c| c.load).fold(0.0, f64::max);
        most.retain(|c| c.load >= TRACE * largest);
        if most.len() < MIN_CONTACTS {
            return None;
        }
        let count = most.len() as f64;
        let slipping = most.iter().filter(|c| c.slips).count() as f64;
        if dimension == 3 {
            let diameter = |n: f64| 2.0 * (n / std::f64::consts::PI).sqrt();
            let (across, stick) = (diameter(count), diameter(count - slipping));
            return Some(Self {
                across,
                stick,
                slip: 0.5 * (across - stick),
                system: None,
            });
        }
        // Points are in the order along the mean tangent.
        let normal = most.iter().fold(Vector3::zeros(), |sum, c| sum + c.pushes);
        let along = |c: &LoadedPoint| c.place[0] * normal[1] - c.place[1] * normal[0];
        most.sort_by(|a, b| along(a).total_cmp(&along(b)));
        let begins = |k: usize| most[k].slips && (k == 0 || !most[k - 1].slips);
        let strips = (0..most.len()).filter(|k| begins(*k)).count().max(1);
        Some(Self {
            across: count,
            stick: count - slipping,
            slip: slipping / strips as f64,
            system: None,
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
            ..Resolution::new("flat")
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
        (kept.sums, kept.rolls) = ([2.0, 1.0], true);
        let mut other = Resolution::new("flat");
        other.restore(kept.state());
        assert_eq!(other, kept);
    }

    /// Returns points along a line in the plane, loaded as in Hertz' contact, of which the outer
    /// ones slip, with small forces beyond.
    fn along_a_line(towards: [f64; 2], traces: usize) -> Vec<LoadedPoint> {
        let normal = Vector3::new(-towards[1], towards[0], 0.0);
        let of = |k: i32, load: f64, slips: bool| LoadedPoint {
            place: Vector3::new(towards[0], towards[1], 0.0) * (1e-3 * f64::from(k)),
            pushes: normal * load,
            load,
            slips,
        };
        let load = |k: i32| (1.0 - (f64::from(k) / 20.0).powi(2)).sqrt();
        // The contact sticks from -9 to 9, and slips in ten elements at either side.
        let mut points: Vec<LoadedPoint> =
            (-19..=19).map(|k| of(k, load(k), k.abs() > 9)).collect();
        points.extend((0..traces as i32).map(|k| of(20 + k, 1e-7, k % 2 == 0)));
        // The points are in no particular order.
        points.sort_by_key(|p| ((p.place[0] + p.place[1]) * 1e6) as i64 * 7919 % 1009);
        points
    }

    /// The result is the same for any orientation of the surface, and for any small forces on
    /// points that do not touch.
    #[test]
    fn strips_are_counted_along_the_surface() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        for towards in [[1.0, 0.0], [0.0, 1.0], [half, -half], [-1.0, 0.0]] {
            for traces in [0, 80] {
                let strip = Strip::across(2, along_a_line(towards, traces)).unwrap();
                let counts = (strip.across, strip.stick, strip.slip);
                assert_eq!(counts, (39.0, 19.0, 10.0), "{towards:?}, {traces} traces");
            }
        }
    }
}
