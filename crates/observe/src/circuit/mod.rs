//! The tribological circuit as an observer: columns, events, and summary. The account itself is a
//! process, [`fretwork_core::process::circuit`].

mod summary;
mod worn;

pub(crate) use summary::report_none;
pub use summary::{Base, CircuitSummary, Rates};
pub use worn::WornGrains;
use worn::{LooseGrains, Loss, READS};

use super::figures;
use super::observer::{Event, EventTable};
use super::output::Output;
use super::picture::{Paint, Picture, PictureContent};
use super::quantity::Findings;
use super::quantity::unit::{AREA, ENERGY, MASS, MASS_FLOW, METRE, ONE, SECOND, Unit};
use super::series::DecimatedSeries;
use super::statistics::Column;
use super::steady;
use super::wear::show_flows;
use crate::observer::{Observer, RunEnd};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::process::circuit::{CircuitProcess, Debris, GrainCircuit};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use fretwork_core::wear::ledger::{Flows, GrainPlace, MassLedger};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Observes the bonds that break, and records an event for each.
#[derive(Clone, Copy, Debug)]
pub struct BrokenBonds {
    count: u64,
    /// Whether an interface of the case has a cohesion law.
    any: bool,
}

impl BrokenBonds {
    /// Starts the count for a case; `any` is whether its interfaces make bonds.
    pub fn new(any: bool) -> Self {
        Self { count: 0, any }
    }
}

/// Returns the columns of the coordinates of an event.
fn place() -> [Column; 3] {
    ["x", "y", "z"].map(|a| Column::new(a, "m", "where it was"))
}

impl Observer for BrokenBonds {
    fn name(&self) -> String {
        "broken bonds".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn event_tables(&self) -> Vec<EventTable> {
        let c = |name, unit: Unit, doc| Column::new(name, unit, doc);
        let mut columns = vec![
            c("id", ONE, "number of the break, from 1"),
            c("time", SECOND, "end of the step in which it broke"),
            c("body_1", ONE, "identity of the candidate"),
            c("body_2", ONE, "identity of the antagonist"),
            c("interface", ONE, "index of the interface"),
        ];
        columns.extend(place());
        columns.extend([
            c(
                "mode_mix",
                ONE,
                "fraction of sliding in the work of opening and sliding: 0 mode I, 1 mode II",
            ),
            c("opening_normal", METRE, "elongation at the end"),
            c(
                "opening_tangential",
                METRE,
                "norm of the tangential opening",
            ),
            c("area", AREA, "area of the bond"),
            c("work", ENERGY, "work done on the bond since it formed"),
            c("fracture", ENERGY, "energy released by damage"),
            c("viscous", ENERGY, "dissipated by its damping"),
            c(
                "friction",
                ENERGY,
                "dissipated by friction at the contact while it was intact",
            ),
            c(
                "cause",
                ONE,
                "0 damage, 1 its bodies moved out of range or one was removed",
            ),
        ]);
        let table = EventTable {
            name: "broken",
            columns,
            list: None,
        };
        self.any.then_some(table).into_iter().collect()
    }

    fn after_processes(&mut self, run: &dyn RunView) -> Vec<Event> {
        let mut events = Vec::new();
        let bodies = run.bodies();
        for b in run.bond_breaks() {
            let at = run.periodic().wrapped(Vector3::from(b.place));
            let id = |k: usize| bodies.id[b.bodies[k] as usize] as f64;
            self.count += 1;
            let row = vec![
                self.count as f64,
                run.time(),
                id(0),
                id(1),
                f64::from(b.law),
                at[0],
                at[1],
                at[2],
                b.energies.mode_mix(),
                b.opening[0],
                b.opening[1],
                b.area,
                b.energies.work.iter().sum(),
                b.energies.fracture,
                b.energies.viscous,
                b.energies.friction,
                f64::from(u8::from(!b.damaged)),
            ];
            events.push(Event {
                table: "broken",
                row,
                list: Vec::new(),
            });
        }
        events
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.count)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.count = decode(from)?;
        Ok(())
    }
}

/// Observes the circuit.
#[derive(Clone, Debug)]
pub struct CircuitAccount {
    start: f64,
    worn: WornGrains,
    state: CircuitObserverState,
}

/// State carried from step to step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct CircuitObserverState {
    /// Number of pieces that detached, and number of grains of the largest.
    pieces: u64,
    largest: usize,
    /// Normal force times the path of the rubbed body since the start of the account (J; J/m).
    load_path: f64,
    /// What each first body lost.
    losses: Vec<Loss>,
    /// Time, accumulated flows, mass in the contact, and load path (J; J/m), at each update.
    series: DecimatedSeries<(f64, Flows, f64, f64)>,
}

/// Returns the circuit of a simulation; `None` before its start.
fn circuit(run: &dyn RunView) -> Option<&GrainCircuit> {
    run.process::<CircuitProcess>()?.circuit()
}

impl CircuitAccount {
    /// Name of its pictures.
    pub const PICTURE: &str = "circuit";

    /// Files of its figures.
    pub const FIGURES: [&str; 1] = ["circuit.png"];

    /// Starts the account of a circuit at a time (s).
    pub fn new(start: f64, worn: WornGrains) -> Self {
        Self {
            start,
            worn,
            state: CircuitObserverState::default(),
        }
    }

    /// A piece of debris as an event.
    fn event(&mut self, run: &dyn RunView, d: &Debris) -> Event {
        self.state.pieces += 1;
        self.state.largest = self.state.largest.max(d.grains.len());
        Loss::add(&mut self.state.losses, d);
        let at = d.place;
        Event {
            table: "debris",
            row: vec![
                self.state.pieces as f64,
                d.time,
                d.grains.len() as f64,
                d.mass,
                at[0],
                at[1],
                at[2],
                run.bodies().id[d.base as usize] as f64,
                d.mode_mix,
                d.energy,
                d.bonds as f64,
            ],
            list: d.grains.iter().map(|g| *g as f64).collect(),
        }
    }

    /// Returns the colours of balls and pieces by their place in the circuit; `None` before its
    /// start.
    fn paints(run: &dyn RunView) -> Vec<Paint> {
        let Some(circuit) = circuit(run) else {
            return Vec::new();
        };
        let balls = run.balls().into_iter().map(|b| b.body);
        let bodies = balls.chain(run.pieces().into_iter().map(|p| p.body));
        let paint = |body: u32| match circuit.place(body as usize) {
            Some(GrainPlace::Tied(base)) => {
                Paint::Tied(circuit.bases().iter().position(|b| *b == base).unwrap_or(0))
            }
            Some(GrainPlace::Contact) => Paint::Loose,
            Some(_) => Paint::Out,
            None => Paint::Grey,
        };
        bodies.map(paint).collect()
    }

    /// Returns the summary.
    fn summary(&self, run: &dyn RunView, wall: Duration) -> Option<CircuitSummary> {
        let circuit = circuit(run)?;
        let end = self.state.series.last().map_or(self.start, |p| p.0);
        let middle = 0.5 * (self.start + end);
        let flow = |of: &dyn Fn(&Flows, f64) -> f64| {
            let points: Vec<(f64, f64)> = self
                .state
                .series
                .points()
                .map(|(t, f, m, _)| (*t, of(f, *m)))
                .collect();
            steady::flow(&points, middle, end)
        };
        let name = |b: u32| {
            run.bodies()
                .driven
                .iter()
                .find(|d| d.body == b)
                .map(|d| d.name.clone())
        };
        let bases = circuit.bases().iter().map(|b| Base {
            name: name(*b).unwrap_or_default(),
            grains: circuit.tied_to(*b),
            specific_rate: None,
            archard_coefficient: None,
            hardness: None,
        });
        Some(CircuitSummary {
            start: self.start,
            window: [middle, end],
            contents: circuit.ledger.contents,
            flows: circuit.ledger.flows,
            residual: circuit.ledger.residual(),
            rates_unit: MASS_FLOW.symbol(run.dimension()),
            rates: Rates {
                Qs: flow(&|f, _| f.source.mass),
                Qa: flow(&|f, _| f.attached.mass),
                Qe: flow(&|f, _| f.ejected.mass),
                Qr: flow(&|f, _| f.recirculated.mass),
                Qw: flow(&|f, _| f.wear.mass),
                Qs_less_Qw: flow(&|f, _| f.source.mass - f.attached.mass - f.wear.mass),
                M: flow(&|_, m| m),
            },
            bases: bases.collect(),
            specific_rate: None,
            archard_coefficient: None,
            pieces: self.state.pieces,
            largest_piece: self.state.largest,
            cost_share: circuit.cost.as_secs_f64() / wall.as_secs_f64().max(1e-9),
        })
    }
}

impl Observer for CircuitAccount {
    fn name(&self) -> String {
        "tribological circuit".to_owned()
    }

    fn reads_results_of(&self) -> &'static [&'static str] {
        &READS
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        if run.time() > self.start {
            self.state.load_path += self.worn.load_path(run);
        }
    }

    fn event_tables(&self) -> Vec<EventTable> {
        let c = |name, unit: Unit, doc| Column::new(name, unit, doc);
        let mut columns = vec![
            c("id", ONE, "number of the piece, from 1"),
            c("time", SECOND, "time at which the account found it loose"),
            c("size", ONE, "grains in it"),
            c("mass", MASS, "its mass"),
        ];
        columns.extend(place());
        columns.extend([
            c("first_body", ONE, "identity of the first body that lost it"),
            c(
                "mode_mix",
                ONE,
                "fraction of sliding in the work on the bonds that freed it",
            ),
            c("energy", ENERGY, "energy released by damage of these bonds"),
            c("bonds", ONE, "number of these bonds"),
        ]);
        let doc = "identities of the grains of all pieces, one piece after another";
        vec![EventTable {
            name: "debris",
            columns,
            list: Some(c("grains", ONE, doc)),
        }]
    }

    fn after_processes(&mut self, run: &dyn RunView) -> Vec<Event> {
        let process = run.process::<CircuitProcess>();
        let circuit = process.filter(|p| p.is_up_to_date(run.steps()));
        let Some(circuit) = circuit.and_then(CircuitProcess::circuit) else {
            return Vec::new();
        };
        let ledger = &circuit.ledger;
        let contact = ledger.contents.contact.mass;
        let path = self.state.load_path;
        self.state
            .series
            .add((run.time(), ledger.flows, contact, path));
        let pieces = circuit.debris.iter();
        pieces.map(|d| self.event(run, d)).collect()
    }

    fn columns(&self) -> Vec<Column> {
        let c = |name, unit: Unit, doc| Column::new(name, unit, doc);
        vec![
            c("tied_grains", ONE, "grains tied to first bodies"),
            c("M_grains", ONE, "grains in the contact"),
            c(
                "source_grains",
                ONE,
                "grains that came loose, since the start",
            ),
            c("attached_grains", ONE, "grains that bonds tied again"),
            c("ejected_grains", ONE, "grains that left the contact"),
            c("recirculated_grains", ONE, "grains that came back"),
            c("lost_grains", ONE, "grains that wore: out for good"),
            c("M", MASS, "mass in the contact"),
            c("source", MASS, "mass that came loose, since the start"),
            c("attached", MASS, "mass that bonds tied again"),
            c("ejected", MASS, "mass that left the contact"),
            c("recirculated", MASS, "mass that came back"),
            c("lost", MASS, "mass that wore: out for good"),
            c("ledger_grains", ONE, "grains that do not add up; 0"),
            c("ledger_mass", MASS, "mass that does not add up; rounding"),
        ]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let none = MassLedger::default();
        let ledger = circuit(run).map_or(&none, |c| &c.ledger);
        let (c, f, r) = (&ledger.contents, &ledger.flows, ledger.residual());
        let rest = [r.tied, r.contact, r.ejected, r.lost];
        let flows = [f.source, f.attached, f.ejected, f.recirculated, f.wear];
        let mut row = vec![c.tied.grains as f64, c.contact.grains as f64];
        row.extend(flows.iter().map(|a| a.grains as f64));
        row.push(c.contact.mass);
        row.extend(flows.iter().map(|a| a.mass));
        row.push(rest.iter().map(|a| a.grains.abs()).sum::<i64>() as f64);
        row.push(rest.iter().map(|a| a.mass.abs()).sum());
        row
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        let paints = Self::paints(run);
        if paints.is_empty() {
            return Vec::new();
        }
        vec![Picture {
            name: Self::PICTURE,
            shows: PictureContent::Paints(paints),
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec![Self::PICTURE]
    }

    /// Grains that detached from first bodies are a source in addition to the wear law.
    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let run = end.simulation;
        for name in ["Qs", "Qe", "Qw"] {
            found.edit(&format!("wear.{name}"), |q| q.lacks = None);
        }
        let Some(circuit) = self.summary(run, end.wall) else {
            // The account has not begun.
            report_none(found);
            found.edit("circuit", |q| q.lacks = None);
            return show_flows(found);
        };
        let worn = found.number("wear.Qs").unwrap_or(0.0);
        let span = (run.time() - circuit.start).max(f64::MIN_POSITIVE);
        for (name, mass) in [
            ("Qs", circuit.flows.source.mass),
            ("Qe", circuit.flows.ejected.mass),
            ("Qw", circuit.flows.wear.mass),
        ] {
            let other = if name == "Qs" { worn } else { 0.0 };
            found.edit(&format!("wear.{name}"), |q| {
                q.value = (other + mass / span).into();
            });
        }
        circuit.report(found);
        let points = self.state.series.points();
        let mut history: Vec<(f64, f64)> = points.map(|(_, f, _, p)| (*p, f.source.mass)).collect();
        history.push((self.state.load_path, circuit.flows.source.mass));
        let bases: Vec<u32> = self::circuit(run).map_or(Vec::new(), |c| c.bases().to_vec());
        let loose = LooseGrains {
            losses: &self.state.losses,
            bases: &bases,
            history: &history,
        };
        self.worn.report(&loose, run, found);
        show_flows(found);
    }

    fn file_names(&self) -> Vec<String> {
        Self::FIGURES.map(str::to_owned).to_vec()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let summary = self.summary(end.simulation, end.wall);
        let figure = |c: CircuitSummary| figures::circuit::charts(c.window);
        summary.map(figure).into_iter().collect()
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.state = decode(from)?;
        Ok(())
    }
}
