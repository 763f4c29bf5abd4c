//! The friction test as an observer: forces and sliding of the rubbed body, its cycles, and their
//! evaluation.

use super::figures;
use super::fretting;
use super::friction::{Cycles, FrictionTotals, Sample};
use super::friction_report;
use super::layer::{LayerBalance, Rubbing};
use super::output::Output;
use super::quantity::unit::{FORCE, LOAD_PATH, METRE, ONE, Unit};
use super::quantity::{Findings, Role, Topic};
use super::run_state::damage_ratio;
use super::statistics::Column;
use super::wear::{LoadPath, WearSummary};
use crate::observer::{Observer, RunEnd};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::process::sliding::{SlidingBody, SlidingPart};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Observes a friction test.
#[derive(Debug)]
pub struct FrictionTest {
    body: SlidingBody,
    sample: Sample,
    before: FrictionTotals,
    /// Whether wear is booked to bodies with paths of their own: more than two of them can slide.
    several: bool,
    state: FrictionTestState,
}

/// State of the test carried from step to step.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct FrictionTestState {
    cycles: Cycles,
    layer: LayerBalance,
    /// Displacement of the body so far (m).
    slide: f64,
    /// Tangential force of the last step (N; N/m).
    force: f64,
    /// Volume worn off first bodies (m^3; m^3/m).
    worn: f64,
    /// Normal force times sliding distance before the first cycle (N m; N).
    load_path: f64,
    /// Work of sliding before the first cycle (J; J/m).
    work: f64,
    /// Normal force times sliding distance of each first body by its name, over all of its
    /// contacts, where there are more than two (J; J/m).
    paths: BTreeMap<String, f64>,
}

impl FrictionTest {
    /// Files of its figures.
    pub const FIGURES: [&str; 3] = [
        "fretting_loops.png",
        "friction_coefficient.png",
        "friction_history.png",
    ];

    /// Creates a test of a body with these cycles, from the current state on.
    pub fn new(body: SlidingBody, cycles: Cycles, run: &dyn RunView) -> Self {
        Self {
            body,
            sample: Sample::default(),
            before: FrictionTotals::default(),
            several: run.laws().iter().any(|l| l.wear().is_some()) && first_bodies(run) > 2,
            state: FrictionTestState {
                cycles,
                layer: LayerBalance::new(run),
                slide: 0.0,
                force: 0.0,
                worn: 0.0,
                load_path: 0.0,
                work: 0.0,
                paths: BTreeMap::new(),
            },
        }
    }

    /// Returns the cumulative quantities so far.
    fn cumulated(&self, run: &dyn RunView) -> FrictionTotals {
        FrictionTotals {
            balance: self.state.layer.balance(run),
            broken: run.bonds_broken(),
            worn: self.state.worn,
        }
    }

    /// Returns the path of a first body under its loads relative to that of the rubbed one: 0 of
    /// one that did not slide, 1 where there are no others than these two.
    fn share(&self, run: &dyn RunView, body: &str) -> f64 {
        let own = match self.body.part {
            SlidingPart::Driven(place) => Some(run.bodies().driven[place].name.clone()),
            SlidingPart::System { system, .. } => run.system(system).map(|s| s.name().to_owned()),
        };
        let of = |name: &str| self.state.paths.get(name).copied();
        let own = own.and_then(|own| of(&own)).filter(|path| *path > 0.0);
        own.map_or(1.0, |own| of(body).unwrap_or(0.0) / own)
    }

    /// Returns Q, P and the sliding distance of the last step.
    fn measure(&self, run: &dyn RunView) -> Sample {
        let (drive, normal) = run.rubbing(&self.body);
        Sample {
            time: run.time(),
            q: drive.force,
            p: normal,
            slide: drive.slide,
            travel: drive.travel,
            moved: drive.moved,
            work: drive.work(self.state.force),
        }
    }
}

/// Returns the number of first bodies of a run, without grains that deform.
fn first_bodies(run: &dyn RunView) -> usize {
    let bodies = run.bodies();
    let deforms = |system: &usize| {
        let carried = run.bodies_of_system(*system).first();
        let carrier = carried.and_then(|body| bodies.carrier(*body as usize));
        carrier.is_some_and(|carrier| !carrier.grain)
    };
    bodies.driven.len() + (0..run.system_count()).filter(deforms).count()
}

impl Observer for FrictionTest {
    fn name(&self) -> String {
        "friction test".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn before_step(&mut self, run: &dyn RunView) {
        self.before = self.cumulated(run);
    }

    fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        self.sample = self.measure(run);
        let (body, sample) = (&self.body, &self.sample);
        let test = Rubbing {
            body,
            work: sample.work,
        };
        self.state.layer.follow(run, Some(test));
        self.state.worn += report.totals.worn_first;
        self.state.force = self.sample.q;
        let after = self.cumulated(run);
        let (sample, state) = (&self.sample, &mut self.state);
        state.slide += sample.slide;
        if state.cycles.number(run.time()) == 0 {
            state.load_path += sample.p * sample.travel;
            state.work += sample.work;
        }
        state.cycles.add(
            sample,
            run.options().scheme.h,
            self.before,
            after,
            damage_ratio(run),
        );
        if self.several {
            let multiplier = run.cycle_multiplier();
            for (name, path) in run.first_body_paths(self.body.normal) {
                *state.paths.entry(name.to_owned()).or_default() += multiplier * path;
            }
        }
        // The current cycle may represent several, see the process of cycle jumps.
        let number = state.cycles.number(run.time());
        if let Some(cycle) = state.cycles.list.last_mut().filter(|c| c.cycle == number) {
            cycle.jumped = run.cycle_multiplier() as u32 - 1;
        }
    }

    fn columns(&self) -> Vec<Column> {
        let c = |name, unit: Unit, doc| Column::new(name, unit, doc);
        vec![
            c(
                "delta",
                METRE,
                "displacement of the body under test, relative to what it rubs against",
            ),
            c("Q", FORCE, "tangential force that moves it"),
            c("P", FORCE, "normal force"),
            c("mu", ONE, "|Q|/P"),
        ]
    }

    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        let Sample { q, p, .. } = self.sample;
        let ratio = if p > 0.0 { q.abs() / p } else { 0.0 };
        vec![self.state.slide, q, p, ratio]
    }

    fn cycle(&self, time: f64) -> Option<(u32, u32)> {
        let cycles = &self.state.cycles;
        Some((cycles.number(time), cycles.total()))
    }

    fn slides(&self) -> Option<bool> {
        let cycles = &self.state.cycles;
        cycles.oscillates().then(|| cycles.slides())
    }

    fn caption(&self, run: &dyn RunView) -> Vec<String> {
        let cycles = &self.state.cycles;
        let mut caption = Vec::new();
        let number = cycles.number(run.time());
        if number > 0 && cycles.oscillates() {
            caption.push(format!("cycle {number} of {}", cycles.total()));
        }
        if let Some(mu) = cycles.list.last().and_then(|c| c.friction_coefficient) {
            caption.push(format!("friction coefficient {mu:.3}"));
        }
        caption
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let (before, work) = (self.state.load_path, self.state.work);
        let before = self.state.cycles.slip_before(before, work);
        let path = self.state.cycles.slip_load_path().map(|p| before + p);
        let doc = "normal force times distance of slip: the integral of P |ds| over the run; of a reciprocating motion the energy of the cycles over the coefficient of sliding, without what is elastic";
        found.keep(LoadPath {
            slip: path,
            imposed: self.state.load_path + self.state.cycles.load_path(),
        });
        found.begin(Topic::Wear, Role::Detail);
        found.add("wear.load_path", path, LOAD_PATH, doc);
        if let (Some(path), Some(mut wear)) = (
            path.filter(|p| *p > 0.0),
            found.get::<WearSummary>().cloned(),
        ) {
            wear.rate(|body| path * self.share(end.simulation, body), found);
        }
        Observer::report_so_far(self, found);
    }

    fn report_so_far(&self, found: &mut Findings) {
        let cycles = &self.state.cycles;
        let fretting = fretting::FrettingOutcome::new(&cycles.list).filter(|_| cycles.oscillates());
        friction_report::report(cycles, fretting, found);
    }

    fn file_names(&self) -> Vec<String> {
        Self::FIGURES.map(str::to_owned).to_vec()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let known = &end.uncertainty.friction_coefficient;
        figures::friction_test(&self.state.cycles, known)
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.state = decode(from)?;
        Ok(())
    }

    fn set_end(&mut self, end: f64, later: bool) -> Result<(), &'static str> {
        if later && !self.state.cycles.oscillates() {
            return Err("a friction test without a period counts the second half of the whole run");
        }
        self.state.cycles.lengthen(end);
        Ok(())
    }
}
