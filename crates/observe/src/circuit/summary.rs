//! Summary of the tribological circuit at the end of a run.

use crate::quantity::unit::{MASS, ONE, PASCAL, SECOND, WEAR_RATE, WORD};
use crate::quantity::{Field, Findings, Role, Schema, Topic, field, part, parts, values};
use crate::steady::MeanFlow;
use crate::warning::Warning;
use crate::wear::NO_CIRCUIT;
use fretwork_core::wear::ledger::{Flows, MassByPlace};
use serde::Serialize;

crate::described! {
    /// Mean flows over the second half of the account, with their confidence intervals (kg/s; kg/(m
    /// s) in 2D); null if there were too few updates.
    #[derive(Clone, Copy, Debug, Default, Serialize)]
    #[allow(non_snake_case)]
    pub struct Rates {
        /// Source flow.
        pub Qs: Option<MeanFlow> = part::<MeanFlow>(),
        /// Attached flow: mass bonded again.
        pub Qa: Option<MeanFlow> = part::<MeanFlow>(),
        /// Ejected flow.
        pub Qe: Option<MeanFlow> = part::<MeanFlow>(),
        /// Recirculated flow.
        pub Qr: Option<MeanFlow> = part::<MeanFlow>(),
        /// Wear flow.
        pub Qw: Option<MeanFlow> = part::<MeanFlow>(),
        /// Qs - Qa - Qw, block by block: its interval contains zero in steady sliding.
        pub Qs_less_Qw: Option<MeanFlow> = part::<MeanFlow>(),
        /// Rate of change of the mass in the contact.
        pub M: Option<MeanFlow> = part::<MeanFlow>(),
    }
}

crate::described! {
    /// A first body that grains can belong to.
    #[derive(Clone, Debug, Serialize)]
    pub struct Base {
        /// Name of the base.
        pub name: String => WORD,
        /// Number of grains attached to it at the end.
        pub grains: usize => ONE,
        /// Specific wear rate k = V/(P s) of its grains that came loose; null without one of the
        /// circuit, or where none came loose.
        pub specific_rate: Option<f64> => WEAR_RATE,
        /// Archard's coefficient K = k H of these grains, with its own hardness.
        pub archard_coefficient: Option<f64> => ONE,
        /// Its hardness H; null where its material has none.
        pub hardness: Option<f64> => PASCAL,
    }
}

/// Grains and their mass.
const AMOUNT: Schema = Schema::Part(&[
    field("grains", ONE, "number of grains"),
    field("mass", MASS, "mass of these grains"),
]);

const fn amount(name: &'static str, doc: &'static str) -> Field {
    Field {
        name,
        doc,
        schema: AMOUNT,
    }
}

/// Grains and their mass in each place.
const CONTENTS: Schema = Schema::Part(&[
    amount("tied", "tied to first bodies"),
    amount("contact", "in the contact"),
    amount("ejected", "in ejection zones"),
    amount("lost", "lost for good"),
]);

/// Flows between the places.
const FLOWS: Schema = Schema::Part(&[
    amount("source", "from first bodies to the contact"),
    amount("attached", "from the contact to first bodies, by new bonds"),
    amount("ejected", "from the contact to ejection zones"),
    amount("recirculated", "from ejection zones back to the contact"),
    amount("wear", "from ejection zones to lost"),
]);

crate::described! {
    /// The tribological circuit: places of grains and flows between them.
    #[derive(Clone, Debug, Serialize)]
    pub struct CircuitSummary {
        /// Start of the account.
        pub start: f64 => SECOND,
        /// Window of the mean flows.
        pub window: [f64; 2] = values(SECOND),
        /// Grains and their mass in each place at the end.
        pub contents: MassByPlace = CONTENTS,
        /// Cumulative flows since the start.
        pub flows: Flows = FLOWS,
        /// Residual of the balance.
        pub residual: MassByPlace = CONTENTS,
        /// Unit of the mean flows: kg/s; in 2D kg/(m s), per metre of depth.
        pub rates_unit: &'static str => WORD,
        /// Mean flows.
        pub rates: Rates = part::<Rates>(),
        /// First bodies.
        pub bases: Vec<Base> = parts::<Base>(),
        /// Specific wear rate k = V/(P s) of the grains that came loose, s the distance of slip
        /// since the start of the account; null without a friction test, or with grains of several
        /// materials.
        pub specific_rate: Option<f64> => WEAR_RATE,
        /// Archard's coefficient K = k H of these grains, with the hardness H of the first body
        /// that lost them; null where that has none, and where several lost grains.
        pub archard_coefficient: Option<f64> => ONE,
        /// Number of debris pieces that came loose.
        pub pieces: u64 => ONE,
        /// Number of grains of the largest piece.
        pub largest_piece: usize => ONE,
        /// Fraction of the run's wall time used by the account.
        pub cost_share: f64 => ONE,
    }
}

/// Marks the results that cases without a circuit do not have.
pub(crate) fn report_none(found: &mut Findings) {
    found.begin(Topic::Wear, Role::Detail);
    let doc = "the tribological circuit; null without one";
    found.parts::<CircuitSummary>("circuit", &None::<CircuitSummary>, doc);
    found.edit("circuit", |q| {
        q.lacks(NO_CIRCUIT);
    });
}

impl CircuitSummary {
    /// Adds contents, flows and rates, and warns of grains that are missing.
    pub(super) fn report(&self, found: &mut Findings) {
        found.begin(Topic::Wear, Role::Detail);
        found.part("circuit", self, "");
        let at = [
            "contents.contact.grains",
            "flows.source.grains",
            "rates_unit",
        ];
        for (at, (label, text)) in at.into_iter().zip(self.lines()) {
            let short = format!("circuit, {label}");
            found.edit(&format!("circuit.{at}"), |q| {
                q.secondary(short).sentence(label, text);
            });
        }
        let r = &self.residual;
        let off = [&r.tied, &r.contact, &r.ejected, &r.lost];
        let off: i64 = off.iter().map(|a| a.grains.abs()).sum();
        found.warn((off > 0).then(|| {
            let text = format!("the circuit's account misses {off} grains: this is a defect of the program, please report it");
            Warning::serious("GRAINS DO NOT ADD UP", text)
        }));
    }

    /// Returns labels and sentences for the terminal.
    fn lines(&self) -> Vec<(&'static str, String)> {
        let (c, f, r) = (&self.contents, &self.flows, &self.rates);
        let tied: Vec<String> = self
            .bases
            .iter()
            .map(|b| format!("{} to {}", b.grains, b.name))
            .collect();
        let flow = |q: &Option<MeanFlow>| {
            q.map_or("not known".to_owned(), |q| {
                format!("{:.2e} +- {:.1e}", q.mean, q.half_width)
            })
        };
        let steady = |q: &Option<MeanFlow>| match q {
            Some(q) if q.steady => "no trend",
            Some(_) => "TREND",
            None => "too few updates",
        };
        let equal = match (&r.Qs, &r.Qw, &r.Qs_less_Qw) {
            (Some(s), Some(w), Some(d)) if d.may_be_zero() => {
                if d.half_width < s.mean.max(w.mean) {
                    "equal within the interval"
                } else {
                    "not comparable: the interval of their difference is wider than their values"
                }
            }
            (Some(_), Some(_), Some(_)) => "they differ",
            _ => "no verdict",
        };
        vec![
            (
                "grains",
                format!(
                    "attached {}, {} in the contact, {} ejected, {} lost",
                    tied.join(", "),
                    c.contact.grains,
                    c.ejected.grains,
                    c.lost.grains
                ),
            ),
            (
                "passed",
                format!(
                    "{} came loose in {} pieces (largest {}), {} attached again, {} ejected, {} came back, {} lost",
                    f.source.grains,
                    self.pieces,
                    self.largest_piece,
                    f.attached.grains,
                    f.ejected.grains,
                    f.recirculated.grains,
                    f.wear.grains
                ),
            ),
            (
                "flows, second half",
                format!(
                    "Qs {} ({}), Qw {} ({}), {equal}; Qe {}, Qr {}, Qa {} {}",
                    flow(&r.Qs),
                    steady(&r.Qs),
                    flow(&r.Qw),
                    steady(&r.Qw),
                    flow(&r.Qe),
                    flow(&r.Qr),
                    flow(&r.Qa),
                    self.rates_unit
                ),
            ),
        ]
    }
}
