//! Wear of first and third bodies, and mean mass flows, from the start of the friction test on:
//! earlier processes, such as deposition and compression of grains, are not flows of the contact.

use super::chart::Axis;
use super::figures::history;
use super::first_bodies::{self, BodyWear, WearMaterials};
use super::output::Output;
use super::quantity::unit::{LOAD_PATH, MASS_FLOW, ONE, PASCAL, SECOND, VOLUME, WEAR_RATE, WORD};
use super::quantity::{Findings, Role, Topic, Wording, number, parts, quantity, with_half_width};
use super::statistics::Column;
use super::warning::Warning;
use crate::observer::{Observer, RunEnd};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::process::jump::Jumps;
use fretwork_core::step::StepReport;
use fretwork_core::threads::{map_ranges, worth_dividing};
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt::Write as _;

crate::described! {
    /// Wear and mean mass flows since the start of the friction test, or of the run without one.
    #[derive(Clone, Debug, Default, Serialize)]
    #[allow(non_snake_case)]
    pub struct WearSummary {
        /// Unit of the flows: kg/s; in 2D kg/(m s), per metre of depth.
        pub unit: &'static str => WORD,
        /// Start of Qs (of the wear law) and Qi; flows of a circuit start with the circuit.
        pub start: f64 => SECOND,
        /// Source: mass worn off first bodies by the wear law, or, with a circuit, mass of the
        /// grains that came loose from them.
        pub Qs: f64 => MASS_FLOW,
        /// Internal: mass of the third body that crosses a section, mean of |m v_x|/L.
        pub Qi: f64 => MASS_FLOW,
        /// Ejected: with a circuit the mass that reached its zones; without one zero in a contact
        /// that is periodic along the sliding, and null (not measured) in an open one.
        pub Qe: Option<f64> => MASS_FLOW,
        /// Lost: ejected and not recirculated; as `Qe`.
        pub Qw: Option<f64> => MASS_FLOW,
        /// Volume worn off first bodies by the wear law.
        pub volume_first_bodies: f64 => VOLUME,
        /// Volume worn in contacts without a surface of a first body: between grains, and of first
        /// bodies without a surface, balls and blocks.
        pub volume_third_body: f64 => VOLUME,
        /// Specific wear rate of `volume_third_body` in a case without grains, where it is of first
        /// bodies; null with grains, which slip by other paths than the friction test.
        pub rate_third_body: Option<f64> => WEAR_RATE,
        /// Normal force times distance of slip: the integral of P |ds| over the run, without the
        /// elastic part of reciprocating strokes; null without a friction test.
        pub load_path: Option<f64> => LOAD_PATH,
        /// Specific wear rate k = V/(P s) of all first bodies, the sum of those of each; null where
        /// none is known.
        pub specific_rate: Option<f64> => WEAR_RATE,
        /// Wear of the first bodies that lost material.
        pub bodies: Vec<BodyWear> = parts::<BodyWear>(),
    }
}

/// Why a case has no wear.
pub(crate) const NO_WEAR: &str = "no interface of the case has a wear law";
/// Why a case has no flows of grains.
pub(crate) const NO_CIRCUIT: &str = "the case has no circuit of grains (`circuit`)";

/// Names and explanations of the flows, in the order of the terminal.
const FLOWS: [(&str, &str, &str); 4] = [
    (
        "Qs",
        "source flow Qs",
        "mass that comes loose from the first bodies, per time",
    ),
    (
        "Qe",
        "ejected flow Qe",
        "mass that leaves the contact, per time",
    ),
    (
        "Qw",
        "wear flow Qw",
        "mass that is lost: ejected and not recirculated, per time",
    ),
    (
        "Qi",
        "internal flow Qi",
        "mass of third body that crosses a section of the contact, per time",
    ),
];

impl WearSummary {
    /// Path of the specific wear rate of all first bodies in a summary.
    pub const RATE: &str = "wear.specific_rate";

    /// Returns name and specific wear rate (m³/(N m)) of the first bodies of a summary that have
    /// one.
    pub fn rates(summary: &Value) -> Vec<(String, f64)> {
        let bodies = summary["wear"]["bodies"].as_array();
        let rate = |body: &Value| {
            let name = body["body"].as_str()?.to_owned();
            Some((name, body["specific_rate"].as_f64()?))
        };
        bodies.into_iter().flatten().filter_map(rate).collect()
    }

    /// Adds wear and flows; `wears` says whether the case has a wear law, `without_surface` names
    /// what wears in contacts without a surface.
    pub(crate) fn report(&self, wears: bool, without_surface: &str, found: &mut Findings) {
        found.begin(Topic::Wear, Role::Detail);
        found.part("wear", self, "wear and mean flows of matter");
        let volume = VOLUME.symbol(found.dimension());
        for (k, body) in self
            .bodies
            .iter()
            .enumerate()
            .filter(|(_, b)| b.volume != 0.0)
        {
            let doc = format!("volume worn off `{}`", body.body);
            let added = found.add(&format!("wear.bodies.{k}.volume"), body.volume, VOLUME, doc);
            added.secondary(format!("worn off {}", body.body));
            added.sentence(format!("wear of {}", body.body), of_body(body, volume, ""));
        }
        let third = self.volume_third_body;
        found.edit("wear.volume_third_body", |q| {
            if third > 0.0 {
                q.secondary(format!("wear {without_surface}"));
            }
            if !wears {
                q.lacks(NO_WEAR);
            }
        });
        let (first, bodies) = (self.volume_first_bodies, self.bodies.len());
        found.edit("wear.volume_first_bodies", |q| {
            if first > 0.0 {
                q.secondary("wear of first bodies");
            }
            if bodies < 2 {
                q.silent();
            }
            if !wears {
                q.lacks(NO_WEAR);
            }
        });
        let no_test = found.quantity("friction_coefficient").and_then(|q| q.lacks);
        found.edit(Self::RATE, |q| {
            q.headline("specific wear rate").silent();
            q.lacks = no_test.or((!wears).then_some(NO_WEAR));
        });
        if wears {
            show_flows(found);
        } else {
            found.edit("wear.Qs", |q| {
                q.lacks(NO_WEAR);
            });
        }
        for name in ["wear.Qe", "wear.Qw"] {
            found.edit(name, |q| {
                q.lacks(NO_CIRCUIT);
            });
        }
    }
}

impl WearSummary {
    /// Sets the specific wear rates of the bodies, by the integral of P |ds| of each; those that
    /// did not slide have none.
    pub(crate) fn rate(&mut self, load_path: impl Fn(&str) -> f64, found: &mut Findings) {
        let volume = VOLUME.symbol(found.dimension());
        let materials = found.get::<WearMaterials>().cloned().unwrap_or_default();
        let third = self.volume_third_body;
        // Each contact counts in the paths of both of its bodies.
        let bare = materials.without_surface.iter();
        let path = 0.5 * bare.map(|body| load_path(body)).sum::<f64>();
        if third > 0.0 && path > 0.0 && materials.no_surface {
            let rate = third / path;
            self.rate_third_body = Some(rate);
            let doc = "specific wear rate k = V/(P s) of first bodies without a surface";
            found.add("wear.rate_third_body", rate, WEAR_RATE, doc);
            let text = format!(
                "{}, k {}; which of the bodies of a contact loses it is not told",
                quantity(third, volume),
                quantity(rate, WEAR_RATE.symbol(found.dimension()))
            );
            let label = format!("wear {}", materials.without_surface());
            found.edit("wear.volume_third_body", |q| {
                q.sentence(label, text);
            });
        }
        let mut total = None;
        for (k, body) in self.bodies.iter_mut().enumerate() {
            let rate = body.volume / load_path(&body.body);
            if !rate.is_finite() {
                continue;
            }
            *total.get_or_insert(0.0) += rate;
            body.specific_rate = Some(rate);
            let hard = materials.hardness.iter().find(|h| h.body == body.body);
            let doc = format!("specific wear rate k = V/(P s) of `{}`", body.body);
            let path = format!("wear.bodies.{k}.specific_rate");
            let added = found.add(&path, rate, WEAR_RATE, doc);
            if body.volume != 0.0 {
                let label = format!("specific wear rate of {}", body.body);
                added.secondary(label).silent();
            }
            if let Some(hard) = hard {
                let coefficient = rate * hard.value;
                body.archard_coefficient = Some(coefficient);
                body.hardness = Some(hard.value);
                let at = format!("wear.bodies.{k}");
                let doc = format!("Archard's coefficient K = k H of `{}`", body.body);
                found.add(&format!("{at}.archard_coefficient"), coefficient, ONE, doc);
                let doc = format!("hardness H of `{}`: {}", body.body, hard.text);
                found.add(&format!("{at}.hardness"), hard.value, PASCAL, doc);
            }
            let mut own = materials.own_hardness.iter();
            let own = own.find(|h| h.body == body.body);
            let softer = hard.zip(own).is_some_and(|(h, own)| h.value < own.value);
            let booked = match softer {
                true => {
                    "; booked to it as the body with the surface, though its counterpart is softer"
                }
                false => "",
            };
            let hard = hard.map(|h| archard(rate * h.value, None, &h.text) + booked);
            let text = of_body(body, volume, &hard.unwrap_or_default());
            found.edit(&format!("wear.bodies.{k}.volume"), |q| {
                if let Wording::Sentence(label, _) = q.wording.clone() {
                    q.sentence(label, text);
                }
            });
        }
        self.specific_rate = total;
        if let Some(total) = total {
            found.edit(Self::RATE, |q| q.value = total.into());
        }
    }
}

/// Makes the flows results of the case, with one sentence for all.
pub(crate) fn show_flows(found: &mut Findings) {
    let unit = MASS_FLOW.symbol(found.dimension());
    let circuit = found.number("circuit.start").is_some();
    // Without a circuit only the source is measured, and what grains carry.
    let known = FLOWS.iter().filter_map(|(name, ..)| {
        let q = found.number(&format!("wear.{name}"))?;
        (circuit || q != 0.0).then(|| format!("{name} {} {unit}", number(q, 3)))
    });
    let known: Vec<String> = known.collect();
    for (name, label, doc) in FLOWS {
        found.edit(&format!("wear.{name}"), |q| {
            if q.value.as_f64().is_some_and(|x| x != 0.0) {
                q.secondary(label).silent();
            }
            doc.clone_into(&mut q.doc);
        });
    }
    found.edit("wear.Qs", |q| {
        q.lacks = None;
        q.headline("source flow Qs").silent();
        if circuit {
            q.sentence("flows", known.join(", "));
        }
    });
}

/// K above which wear is more severe than that of unlubricated metals: J. F. Archard, W. Hirst,
/// Proc. R. Soc. A 236 (1956) 397, measured 2e-7 to 2e-2.
const MOST_SEVERE: f64 = 2e-2;

/// Returns Archard's coefficient as text, with its half-width where that is known, and with the
/// hardness.
pub(crate) fn archard(coefficient: f64, half: Option<f64>, hardness: &str) -> String {
    let severe = match coefficient > MOST_SEVERE {
        true => ", more than unlubricated metals wear (K up to 0.02)",
        false => "",
    };
    let value = match half {
        Some(half) => with_half_width(coefficient, half, ""),
        None => number(coefficient, 3),
    };
    format!(", K {value} (H {hardness}){severe}")
}

/// Returns volume, specific wear rate with `coefficient` after it, and depths as text.
fn of_body(w: &BodyWear, volume: &str, coefficient: &str) -> String {
    let mut text = quantity(w.volume, volume);
    if let Some(k) = w.specific_rate {
        let _ = write!(text, ", k {}{coefficient}", quantity(k, "m^3/(N m)"));
    }
    if let (Some(mean), Some(most)) = (w.depth_mean, w.depth_max) {
        let [mean, most] = [mean, most].map(|depth| quantity(depth, "m"));
        let _ = write!(text, "; {mean} deep on average where worn, {most} at most");
    }
    text
}

/// Normal force times distance over a run, by its friction test (J; J/m in 2D).
#[derive(Clone, Copy, Debug)]
pub struct LoadPath {
    /// Of slip; `None` where it is not known, in partial slip and before a cycle is complete.
    pub slip: Option<f64>,
    /// Of the whole path, the elastic part included.
    pub imposed: f64,
}

/// Observes wear.
#[derive(Clone, Debug)]
pub struct Wear {
    /// Axis of sliding.
    along: usize,
    /// Factor by which the masses of bodies are too large, see `inertia_scaling` of a case.
    scaling: f64,
    materials: WearMaterials,
    /// Whether an interface of the case has a wear law.
    wears: bool,
    state: WearObserverState,
}

/// State carried from step to step.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct WearObserverState {
    /// Volumes worn off first bodies and between grains (m^3; m^3/m).
    volumes: (f64, f64),
    flows: Flows,
}

impl Wear {
    /// Creates the observer of wear of first bodies, with flows along an axis from a time (s) on;
    /// the masses of bodies are too large by `scaling`; `wears` says whether an interface has a
    /// wear law.
    pub fn new(
        [start, scaling]: [f64; 2],
        materials: WearMaterials,
        along: usize,
        wears: bool,
    ) -> Self {
        Self {
            wears,
            along,
            scaling,
            materials,
            state: WearObserverState {
                volumes: (0.0, 0.0),
                flows: Flows::since(start),
            },
        }
    }
}

impl Observer for Wear {
    fn name(&self) -> String {
        "wear".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        let state = &mut self.state;
        state.volumes.0 += report.totals.worn_first;
        state.volumes.1 += report.totals.worn_third;
        state
            .flows
            .add(run, self.along, self.scaling, state.volumes.0);
    }

    fn columns(&self) -> Vec<Column> {
        vec![
            Column::new("worn_first", VOLUME, "volume worn off first bodies"),
            Column::new(
                "worn_third",
                VOLUME,
                "volume worn in contacts without a surface of a first body",
            ),
        ]
    }

    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        vec![self.state.volumes.0, self.state.volumes.1]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let (run, state) = (end.simulation, &self.state);
        // Wear includes that of skipped cycles.
        let jumps = run.process::<Jumps>();
        let over = jumps.map_or(0.0, |j| j.jumped_at(run.time()) * j.period());
        // Nothing leaves a contact that is periodic along the sliding.
        let closed = run.periodic().period[self.along].map(|_| 0.0);
        let summary = WearSummary {
            unit: MASS_FLOW.symbol(run.dimension()),
            start: state.flows.start,
            Qs: state.flows.source(over) * self.materials.density,
            Qi: state.flows.internal(),
            Qe: closed,
            Qw: closed,
            volume_first_bodies: state.volumes.0,
            volume_third_body: state.volumes.1,
            rate_third_body: None,
            load_path: None,
            specific_rate: None,
            bodies: first_bodies::wear(run),
        };
        summary.report(self.wears, &self.materials.without_surface(), found);
        let elsewhere = &self.materials.other_motion;
        found.warn(
            (!elsewhere.is_empty()).then(|| Warning::note("OTHER MOTION", elsewhere.join("; "))),
        );
        found.keep(self.materials.clone());
    }

    fn file_names(&self) -> Vec<String> {
        vec!["worn_volume.png".to_owned()]
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let own = end.simulation.scars().into_iter();
        let own = own.map(|scar| (scar.name, format!("{}_worn", scar.name)));
        let elsewhere = self.materials.without_surface();
        let all = [
            ("first bodies", "worn_first"),
            (elsewhere.as_str(), "worn_third"),
        ];
        let all = all.map(|(label, column)| (label, column.to_owned()));
        // A single scar contains all wear of first bodies.
        let several = own.len() > 1;
        let series: Vec<(&str, String)> = all.into_iter().chain(own.filter(|_| several)).collect();
        let chart = history("Worn volume", Axis::of_rows("worn volume V"), &series)
            .note("What the wear laws removed since the start.");
        vec![Output::figure("worn_volume", [chart], 1)]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.state = decode(from)?;
        Ok(())
    }
}

/// Flows since the start of the friction test, or since the start of a run without one.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Flows {
    /// Start time (s).
    start: f64,
    /// Time since the start (s).
    time: f64,
    /// Volume worn off first bodies before the start (m^3; m^3/m).
    before: f64,
    /// Volume worn off first bodies since the start (m^3; m^3/m).
    worn: f64,
    /// Mass of the third body that crossed a section since the start (kg; kg/m).
    crossed: f64,
}

impl Flows {
    /// Creates flows from a time on.
    fn since(start: f64) -> Self {
        Self {
            start,
            ..Self::default()
        }
    }

    /// Adds a step: the sliding axis, the inertia scaling of the case, and the volume worn off
    /// first bodies so far.
    fn add(&mut self, run: &dyn RunView, along: usize, scaling: f64, worn: f64) {
        let h = run.options().scheme.h;
        if run.time() - 0.5 * h < self.start {
            self.before = worn;
            return;
        }
        self.time += h;
        self.worn = worn - self.before;
        self.crossed += h * internal_flow(run, along) / scaling;
    }

    /// Returns the volume worn off first bodies per second, with the time extended by this amount
    /// (m^3/s; m^3/(m s)); zero before the start.
    fn source(&self, over: f64) -> f64 {
        mean(self.worn, self.time + over)
    }

    /// Returns the mass that crosses a section per second (kg/s; kg/(m s)); zero before the start.
    fn internal(&self) -> f64 {
        mean(self.crossed, self.time)
    }
}

fn mean(amount: f64, time: f64) -> f64 {
    if time > 0.0 { amount / time } else { 0.0 }
}

/// Number of bodies of a task, and approximate time to compute the flow of one (ns).
const CHUNK: usize = 4096;
const EACH: f64 = 4.0;

/// Returns the mass of the third body that crosses a section per second: sum m |v| / L along the
/// sliding.
fn internal_flow(run: &dyn RunView, along: usize) -> f64 {
    let (bodies, grain) = (run.bodies(), run.grain_flags());
    let divide = worth_dividing(run.options().solver.parallel, bodies.len(), EACH);
    let parts = map_ranges(divide, bodies.len(), CHUNK, |range| {
        let (mut low, mut high, mut flow) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for b in range {
            let moves = bodies.inverse_mass.at(b)[along] > 0.0
                || bodies.carrier(b).is_some_and(|c| c.grain);
            if moves && bodies.length[b] > 0.0 {
                let x = bodies.position.at(b)[along];
                (low, high) = (low.min(x), high.max(x));
                if grain[b] {
                    flow += bodies.mass[b] * bodies.velocity.at(b)[along].abs();
                }
            }
        }
        (low, high, flow)
    });
    let (mut low, mut high, mut flow) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for (l, h, f) in parts {
        (low, high) = (low.min(l), high.max(h));
        flow += f;
    }
    let length = run.periodic().period[along].unwrap_or(high - low);
    if length.is_finite() && length > 0.0 {
        flow / length
    } else {
        0.0
    }
}
