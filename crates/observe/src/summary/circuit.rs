//! Tribological circuit in the summary.

use crate::steady::Flow;
use fretwork_core::wear::ledger::{Contents, Flows};
use serde::Serialize;

/// Mean flows over the second half of the account, with their confidence intervals (kg/s; kg/(m s) in 2D);
/// null if there were too few updates.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Rates {
    /// Source flow.
    pub Qs: Option<Flow>,
    /// Attached flow: mass bonded again.
    pub Qa: Option<Flow>,
    /// Ejected flow.
    pub Qe: Option<Flow>,
    /// Recirculated flow.
    pub Qr: Option<Flow>,
    /// Wear flow.
    pub Qw: Option<Flow>,
    /// Qs - Qa - Qw, block by block: its interval contains zero in steady sliding.
    pub Qs_less_Qw: Option<Flow>,
    /// Rate of change of the mass in the contact.
    pub M: Option<Flow>,
}

/// A first body that grains can belong to.
#[derive(Clone, Debug, Serialize)]
pub struct Base {
    /// Its name.
    pub name: String,
    /// Number of grains attached to it at the end.
    pub grains: usize,
}

/// The tribological circuit; see [`fretwork_core::wear::ledger`].
#[derive(Clone, Debug, Serialize)]
pub struct CircuitSummary {
    /// Start of the account (s).
    pub start: f64,
    /// Window of the rates (s).
    pub window: [f64; 2],
    /// Contents at the end.
    pub contents: Contents,
    /// Cumulative flows since the start.
    pub flows: Flows,
    /// Residual of the balance.
    pub residual: Contents,
    /// Unit of the mean flows: kg/s; in 2D kg/(m s), per metre of depth.
    pub rates_unit: &'static str,
    /// Mean flows.
    pub rates: Rates,
    /// First bodies.
    pub bases: Vec<Base>,
    /// Number of debris pieces that came loose.
    pub pieces: u64,
    /// Number of grains of the largest piece.
    pub largest_piece: usize,
    /// Fraction of the run's wall time used by the account.
    pub cost_share: f64,
}

impl CircuitSummary {
    /// Report lines.
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let (c, f, r) = (&self.contents, &self.flows, &self.rates);
        let tied: Vec<String> = self
            .bases
            .iter()
            .map(|b| format!("{} to {}", b.grains, b.name))
            .collect();
        let flow = |q: &Option<Flow>| {
            q.map_or("not known".to_owned(), |q| {
                format!("{:.2e} +- {:.1e}", q.mean, q.half_width)
            })
        };
        let steady = |q: &Option<Flow>| match q {
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
