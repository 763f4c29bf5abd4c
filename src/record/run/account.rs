//! The tribological circuit in a run: start, updates, output and summary.

use super::{Recorder, RunError};
use crate::geometry::space::{Space, VectorLike};
use crate::process::circuit::Circuit;
use crate::record::results::Results;
use crate::record::series::Series;
use crate::record::statistics::Column;
use crate::record::steady;
use crate::record::summary::{Base, CircuitSummary, Rates, Wear};
use crate::report::Paint;
use crate::scene::build::Dimensional;
use crate::scene::case::Case;
use crate::scene::circuit;
use crate::step::Simulation;
use crate::wear::ledger::{Flows, Ledger, Place};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// State of the circuit's account.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(super) struct Account<S: Space> {
    start: f64,
    every: u64,
    /// The circuit; `None` before its start time.
    pub circuit: Option<Circuit<S>>,
    /// Number of debris pieces that came loose, and of grains in them.
    pieces: (u64, u64),
    largest: usize,
    broken: u64,
    debris: u64,
    /// Time and cumulative flows at each update.
    series: Series<(f64, Flows, f64)>,
}

impl<S: Space> Account<S> {
    pub fn new(case: &Case) -> Self {
        let spec = case.circuit.as_ref();
        Self {
            start: spec.map_or(0.0, |c| c.start),
            every: spec.map_or(1, |c| c.every),
            circuit: None,
            pieces: (0, 0),
            largest: 0,
            broken: 0,
            debris: 0,
            series: Series::default(),
        }
    }

    /// Columns of the statistics; empty without a circuit.
    pub fn columns(case: &Case) -> Vec<Column> {
        if case.circuit.is_none() {
            return Vec::new();
        }
        let kg = if case.dimension == 2 { "kg/m" } else { "kg" };
        let c = Column::new;
        vec![
            c("tied_grains", "", "grains attached to first bodies"),
            c("M_grains", "", "grains in the contact"),
            c(
                "source_grains",
                "",
                "grains that came loose, since the start",
            ),
            c("attached_grains", "", "grains that bonds attached again"),
            c("ejected_grains", "", "grains that left the contact"),
            c("recirculated_grains", "", "grains that came back"),
            c("lost_grains", "", "grains that wore: lost for good"),
            c("M", kg, "mass in the contact"),
            c("source", kg, "mass that came loose, since the start"),
            c("attached", kg, "mass that bonds attached again"),
            c("ejected", kg, "mass that left the contact"),
            c("recirculated", kg, "mass that came back"),
            c("lost", kg, "mass that wore: lost for good"),
            c("ledger_grains", "", "residual of the grain balance; 0"),
            c("ledger_mass", kg, "residual of the mass balance; rounding"),
        ]
    }

    /// Values of the columns.
    pub fn row(&self) -> Vec<f64> {
        let none = Ledger::default();
        let ledger = self.circuit.as_ref().map_or(&none, |c| &c.ledger);
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

    /// Processes the last step: broken bonds as events, and an update of the account when it is due.
    pub fn follow(
        &mut self,
        case: &Case,
        s: &mut Simulation<S>,
        results: &mut Results,
        last: bool,
    ) -> Result<(), RunError> {
        for b in &s.network.bond_breaks {
            let at = s.shapes.periodic.wrapped(b.place).padded();
            let id = |k: usize| s.bodies.id[b.bodies[k] as usize] as f64;
            self.broken += 1;
            results.append_break(&[
                self.broken as f64,
                s.time,
                id(0),
                id(1),
                f64::from(b.law),
                at[0],
                at[1],
                at[2],
                b.life.mode_mix(),
                b.opening[0],
                b.opening[1],
                b.area,
                b.life.work.iter().sum(),
                b.life.fracture,
                b.life.viscous,
                b.life.friction,
                f64::from(u8::from(!b.damaged)),
            ])?;
        }
        if case.circuit.is_none() || s.time < self.start - 0.5 * s.scheme.h {
            return Ok(());
        }
        let Some(circuit) = &mut self.circuit else {
            return self.begin(case, s);
        };
        circuit.note(s);
        // A row of the statistics needs the state at its step.
        let row = case.output.every > 1 && s.steps.is_multiple_of(case.output.every);
        if !s.steps.is_multiple_of(self.every) && !row && !last {
            return Ok(());
        }
        circuit.update(s);
        let ledger = &circuit.ledger;
        self.series
            .add((s.time, ledger.flows, ledger.contents.contact.mass));
        for d in &circuit.debris {
            self.pieces.0 += 1;
            self.pieces.1 += d.grains.len() as u64;
            self.largest = self.largest.max(d.grains.len());
            self.debris += 1;
            let at = d.place.padded();
            let row = [
                self.debris as f64,
                d.time,
                d.grains.len() as f64,
                d.mass,
                at[0],
                at[1],
                at[2],
                s.bodies.id[d.base as usize] as f64,
                d.mode_mix,
                d.energy,
                d.bonds as f64,
            ];
            let grains: Vec<f64> = d.grains.iter().map(|g| *g as f64).collect();
            results.append_debris(&row, &grains)?;
        }
        Ok(())
    }

    fn begin(&mut self, case: &Case, s: &Simulation<S>) -> Result<(), RunError> {
        let Some(spec) = circuit::install(case, s) else {
            return Ok(());
        };
        let circuit = Circuit::new(spec, s);
        for base in circuit.bases() {
            if circuit.tied_to(*base) == 0 {
                let driven = s.bodies.driven.iter().find(|d| d.body == *base);
                return Err(RunError::NoBonds {
                    body: driven.map_or(String::new(), |d| d.name.clone()),
                    time: s.time,
                });
            }
        }
        self.circuit = Some(circuit);
        Ok(())
    }

    /// Colours of balls and convex parts by their place in the circuit; empty before the account begins.
    pub fn paints(&self, s: &Simulation<S>) -> Vec<Paint> {
        let Some(circuit) = &self.circuit else {
            return Vec::new();
        };
        let balls = s.shapes.balls.iter().map(|b| b.body);
        let bodies = balls.chain(s.shapes.pieces.iter().map(|p| p.body));
        let paint = |body: u32| match circuit.place(body as usize) {
            Some(Place::Tied(base)) => {
                Paint::Tied(circuit.bases().iter().position(|b| *b == base).unwrap_or(0))
            }
            Some(Place::Contact) => Paint::Loose,
            Some(_) => Paint::Out,
            None => Paint::Grey,
        };
        bodies.map(paint).collect()
    }

    /// The circuit's part of the summary.
    pub fn summary(&self, s: &Simulation<S>, wall: Duration) -> Option<CircuitSummary> {
        let circuit = self.circuit.as_ref()?;
        let end = self.series.last().map_or(self.start, |p| p.0);
        let middle = 0.5 * (self.start + end);
        let flow = |of: &dyn Fn(&Flows, f64) -> f64| {
            let points: Vec<(f64, f64)> = self
                .series
                .points()
                .map(|(t, f, m)| (*t, of(f, *m)))
                .collect();
            steady::flow(&points, middle, end)
        };
        let name = |b: u32| {
            s.bodies
                .driven
                .iter()
                .find(|d| d.body == b)
                .map(|d| d.name.clone())
        };
        let bases = circuit.bases().iter().map(|b| Base {
            name: name(*b).unwrap_or_default(),
            grains: circuit.tied_to(*b),
        });
        Some(CircuitSummary {
            start: self.start,
            window: [middle, end],
            contents: circuit.ledger.contents,
            flows: circuit.ledger.flows,
            residual: circuit.ledger.residual(),
            rates_unit: Wear::unit(S::D),
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
            pieces: self.pieces.0,
            largest_piece: self.largest,
            cost_share: circuit.cost.as_secs_f64() / wall.as_secs_f64().max(1e-9),
        })
    }
}

impl<S: Dimensional> Recorder<'_, S> {
    /// Updates the account after the last step.
    pub(super) fn account(&mut self, last: bool) -> Result<(), RunError> {
        let case = &self.loaded.case;
        self.account
            .follow(case, &mut self.simulation, &mut self.results, last)
    }
}
