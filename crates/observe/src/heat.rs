//! Temperatures, heat flows and the contact resistance of a run.

mod checks;

pub use checks::{HalfSpaceCheck, HeatChecks, without_heat};

use super::chart::{Axis, Series};
use super::figures::history;
use super::output::Output;
use super::picture::{Picture, PictureContent};
use super::quantity::unit::{CURRENT, ENERGY, KELVIN, ONE, POWER, RESISTANCE, Unit};
use super::quantity::{Findings, Role, Topic};
use super::statistics::Column;
use crate::observer::{Observer, RunEnd};
use checks::{ContactShares, checks};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::heat::{BodyNodes, Heat, HeatLedger, HeatState, Store};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};

/// State of the observer carried from row to row.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct HeatObserverState {
    /// Lowest temperature at the start (K).
    lowest: f64,
    /// Highest temperature so far (K).
    highest: f64,
    /// Residual of the account of heat over its scale.
    off: f64,
    /// Heat that each first body had received at the last row (J; J/m in 2D), and the time of that
    /// row (s).
    received: Vec<f64>,
    time: f64,
    /// Heat at contacts outside the range of half-spaces.
    shares: ContactShares,
    /// The last row and its time: a second request for the same time gives the same row.
    row: Option<(f64, Vec<f64>)>,
}

/// Observes the heat of a run, and its electric circuit if there is one.
#[derive(Debug)]
pub struct HeatObserver {
    /// Names of the first bodies, in the order of [`Heat::first_bodies`].
    names: Vec<String>,
    circuit: bool,
    state: HeatObserverState,
}

impl HeatObserver {
    /// Creates the observer from the current state; `None` where no heat is computed.
    pub fn of(run: &dyn RunView) -> Option<Self> {
        let (heat, state) = (run.heat()?, run.heat_state()?);
        let temperatures = || state.nodes.iter().map(|n| n.temperature);
        Some(Self {
            names: heat.first_bodies.iter().map(|b| b.0.clone()).collect(),
            circuit: heat.circuit.is_some(),
            state: HeatObserverState {
                lowest: temperatures().fold(f64::INFINITY, f64::min),
                highest: temperatures().fold(0.0, f64::max),
                off: state.ledger.relative_residual(),
                received: state.received.clone(),
                time: run.time(),
                shares: ContactShares::default(),
                row: None,
            },
        })
    }

    fn row(&mut self, run: &dyn RunView) -> Vec<f64> {
        let (Some(heat), Some(state)) = (run.heat(), run.heat_state()) else {
            return vec![f64::NAN; Observer::columns(self).len()];
        };
        let [highest, mean] = of_grains(run, heat, state);
        let mut row = vec![highest, mean];
        let of_body = |(_, nodes): &(String, std::ops::Range<usize>)| {
            state.mean_temperature(nodes.clone()).unwrap_or(f64::NAN)
        };
        row.extend(heat.first_bodies.iter().map(of_body));
        let span = heat.clock * (run.time() - self.state.time);
        let flows = state.received.iter().zip(&self.state.received);
        row.extend(flows.map(|(now, before)| match span > 0.0 {
            true => (now - before) / span,
            false => 0.0,
        }));
        row.extend(state.ledger.entries().map(|e| e.2));
        if self.circuit {
            let circuit = &state.circuit;
            row.extend(match run.time() > heat.start {
                true => [1.0 / circuit.conductance, circuit.voltage, circuit.current],
                // The bodies are not connected yet.
                false => [f64::NAN; 3],
            });
        }
        (self.state.received, self.state.time) = (state.received.clone(), run.time());
        row
    }
}

/// Returns the highest temperature of grains and first bodies, and the mean temperature of the
/// grains weighted by heat capacity (K).
fn of_grains(run: &dyn RunView, heat: &Heat, state: &HeatState) -> [f64; 2] {
    let removed = run.bodies().removed;
    let grain = run.grain_flags();
    let (mut highest, mut sum, mut capacities) = (0.0f64, 0.0, 0.0);
    // Meshes are included once, with the first bodies, not with each body that represents a
    // contactor.
    for (_, nodes) in &heat.first_bodies {
        let temperatures = state.nodes[nodes.clone()].iter().map(|n| n.temperature);
        highest = temperatures.fold(highest, f64::max);
    }
    for (body, nodes) in heat.nodes.iter().enumerate() {
        if removed[body] || matches!(nodes, BodyNodes::Mesh(..)) {
            continue;
        }
        for node in &state.nodes[nodes.range()] {
            highest = highest.max(node.temperature);
            if let (true, Store::Lumped(capacity)) = (grain[body], &node.store) {
                sum += capacity * node.temperature;
                capacities += capacity;
            }
        }
    }
    let mean = match capacities > 0.0 {
        true => sum / capacities,
        false => f64::NAN,
    };
    [highest, mean]
}

impl Observer for HeatObserver {
    fn name(&self) -> String {
        "heat".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        if let (Some(heat), Some(state)) = (run.heat(), run.heat_state()) {
            let [highest, _] = of_grains(run, heat, state);
            self.state.highest = self.state.highest.max(highest);
            self.state.off = state.ledger.relative_residual();
            self.state.shares.add(run, heat, state);
        }
    }

    fn columns(&self) -> Vec<Column> {
        let mut all = vec![
            Column::new(
                "temperature_max",
                KELVIN,
                "highest temperature of grains and of the surfaces of first bodies",
            ),
            Column::new(
                "temperature_mean",
                "K",
                "mean temperature of the grains, by their heat capacities",
            ),
        ];
        let of_bodies = |quantity: &str, unit: Unit, doc| -> Vec<Column> {
            let names = self.names.iter();
            names
                .map(|name| Column::new(format!("{name}_{quantity}"), unit, doc))
                .collect()
        };
        all.extend(of_bodies(
            "temperature",
            KELVIN,
            "mean temperature of the surface of a first body, of finite elements that of its volume; not a number of an insulated one",
        ));
        all.extend(of_bodies(
            "heat_flow",
            POWER,
            "heat flow into a first body through its contacts, mean since the row before",
        ));
        all.extend(ledger_columns());
        if self.circuit {
            all.extend([
                Column::new(
                    "resistance",
                    RESISTANCE,
                    "electrical resistance between the bodies of the circuit; infinite where no contact joins them, not a number before the heat starts",
                ),
                Column::new("voltage", "V", "voltage between the bodies of the circuit"),
                Column::new("current", CURRENT, "current of the circuit"),
            ]);
        }
        all
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        if let Some((time, row)) = &self.state.row
            && *time == run.time()
        {
            return row.clone();
        }
        let row = self.row(run);
        self.state.row = Some((run.time(), row.clone()));
        row
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        let lowest = self.state.lowest;
        let above = |body: u32| {
            run.temperature(body as usize)
                .map_or(f64::NAN, |t| t - lowest)
        };
        let balls = run.balls().into_iter().map(|b| above(b.body));
        let pieces = run.pieces().into_iter().map(|p| above(p.body));
        vec![Picture {
            name: "temperature",
            shows: PictureContent::Values {
                values: balls.chain(pieces).collect(),
                label: "temperature above the lowest at the start (K)",
                top: (self.state.highest - lowest).max(1e-9),
            },
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec!["temperature"]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let last = |name: &str| {
            let column = end.table.column(name);
            column.last().copied().filter(|x| x.is_finite())
        };
        let mut ends: Vec<String> = self
            .names
            .iter()
            .filter_map(|name| Some((name, last(&format!("{name}_temperature"))?)))
            .map(|(name, t)| format!("{name} {t:.1} K"))
            .collect();
        ends.extend(last("temperature_mean").map(|t| format!("grains {t:.1} K on average")));
        let text = format!(
            "{}; highest over the run {:.1} K",
            ends.join(", "),
            self.state.highest
        );
        found.finding("temperatures", text, "temperatures at the end");
        let unit = RESISTANCE.symbol(end.simulation.dimension());
        if self.circuit {
            let column = end.table.column("resistance");
            let mut closed = column.iter().filter(|r| r.is_finite());
            let text = match (closed.next(), last("resistance")) {
                (Some(first), Some(end)) => {
                    format!("{first:.3e} {unit} when first measured, {end:.3e} {unit} at the end")
                }
                (Some(first), None) => {
                    format!("{first:.3e} {unit} when first measured, open at the end")
                }
                (None, _) => "never closed".to_owned(),
            };
            found.finding("contact resistance", text, "resistance of the circuit");
        }
        let doc = "highest temperature over the run";
        found.measure("temperature_max", self.state.highest, KELVIN, doc);
        let doc = "residual of the account of heat over the largest heat";
        found.measure("heat_residual_relative", self.state.off, ONE, doc);
        if end.simulation.grain_flags().contains(&true) {
            let doc = "mean temperature of the grains at the end";
            found.measure(
                "temperature_mean_end",
                last("temperature_mean"),
                KELVIN,
                doc,
            );
        }
        if self.circuit {
            let doc = "resistance of the circuit at the end";
            found.measure("resistance_end", last("resistance"), RESISTANCE, doc);
        }
        if let Some(checks) = checks(end.simulation, self.state.off, &self.state.shares) {
            found.begin(Topic::Run, Role::Diagnostic);
            found.part("heat", &checks, "");
            found.warn(checks.warnings());
        }
    }

    fn report_so_far(&self, found: &mut Findings) {
        let checks = HeatChecks {
            residual_relative: self.state.off,
            ..HeatChecks::default()
        };
        found.warn(checks.warnings());
    }

    fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let run = end.simulation;
        let (Some(heat), Some(state)) = (run.heat(), run.heat_state()) else {
            return Vec::new();
        };
        let surface = |(name, nodes): &(String, std::ops::Range<usize>)| {
            let of_body =
                |n: &&BodyNodes| matches!(n, BodyNodes::Pieces(..)) && n.range() == *nodes;
            let Some(BodyNodes::Pieces(first, pieces)) = heat.nodes.iter().find(of_body) else {
                return None;
            };
            let axes = pieces.axes.iter();
            let header: Vec<String> = axes
                .map(|a| format!("{} [m]", ["x", "y", "z"][a.axis]))
                .collect();
            let mut text = format!("{},temperature [K]\n", header.join(","));
            for piece in 0..pieces.count() {
                let middle = pieces.middle(piece);
                let places: Vec<String> = middle.iter().map(|x| format!("{x:e}")).collect();
                let node = &state.nodes[(first + piece) as usize];
                text += &format!("{},{:e}\n", places.join(","), node.temperature);
            }
            let file = format!("surface_temperature_{name}.csv");
            Some(Output::Text { file, text })
        };
        heat.first_bodies.iter().filter_map(surface).collect()
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let all = [
            ("highest", "temperature_max"),
            ("mean of grains", "temperature_mean"),
        ];
        let mut temperatures = history("Temperatures", Axis::of_rows("temperature"), &all);
        let mut flows = history::<&str>("Heat into first bodies", Axis::of_rows("heat flow"), &[]);
        for name in &self.names {
            let of = |part: &str| Series::rows(name, "time", format!("{name}_{part}"));
            temperatures.series.push(of("temperature"));
            flows.series.push(of("heat_flow"));
        }
        let mut panels = vec![temperatures, flows];
        if self.circuit {
            let resistance = Axis::of_rows("resistance");
            panels.push(history(
                "Contact resistance",
                resistance,
                &[("", "resistance")],
            ));
        }
        vec![Output::figure("heat", panels, 1)]
    }

    fn file_names(&self) -> Vec<String> {
        let surfaces = self.names.iter();
        let surfaces = surfaces.map(|name| format!("surface_temperature_{name}.csv"));
        surfaces.chain(["heat.png".to_owned()]).collect()
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.state = decode(from)?;
        Ok(())
    }
}

/// Returns the columns of the account of heat.
fn ledger_columns() -> Vec<Column> {
    let entries = HeatLedger::default().entries();
    let column = |(name, doc, _): (&str, &'static str, f64)| {
        Column::new(format!("heat_{name}"), ENERGY, doc)
    };
    entries.into_iter().map(column).collect()
}
