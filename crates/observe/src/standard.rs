//! What a run of a case is observed by.

use super::accuracy::{ChosenSettings, report_accuracy};
use super::biaxial::Biaxial;
use super::case_checks::CaseChecks;
use super::circuit::{BrokenBonds, CircuitAccount};
use super::deformable::Deformable;
use super::fracture::Fracture;
use super::friction::Cycles;
use super::friction_test::FrictionTest;
use super::heat::HeatObserver;
use super::jump::CycleJumps;
use super::measure::measures;
use super::observer::{Observers, RunEnd};
use super::quantity::Findings;
use super::run_state::{DrivenBodies, Phases, RunState};
use super::scars::Scars;
use super::statistics::Table;
use super::strain::LocalShear;
use super::summary::{RunFacts, Summary, Uncertainty};
use super::typed::in_dimension;
use super::wear::Wear;
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::Kind;
use fretwork_core::step::{InDimension, Simulation};
use fretwork_core::view::RunView;
use fretwork_scene::case::{Case, InterfaceSpec};
use fretwork_scene::processes;
use std::time::Duration;

/// The observers of a run of a case, from the current state of its simulation on, in the order of
/// the columns of the statistics. `density` is that of the first bodies (kg/m^3).
pub fn observers(case: &Case, run: &dyn RunView, density: f64) -> Observers {
    match run.in_dimension() {
        InDimension::Dim2(s) => list(case, s, density),
        InDimension::Dim3(s) => list(case, s, density),
    }
}

/// What a run of a case will say, as far as it is known before its first step: values are those of
/// the start, and what a case cannot have says why.
pub fn declared(case: &Case, run: &dyn RunView) -> Findings {
    let observers = observers(case, run, 0.0);
    let end = RunEnd {
        simulation: run,
        table: &Table::new(observers.columns(), run.dimension()),
        title: "",
        uncertainty: &Uncertainty::default(),
        wall: Duration::ZERO,
    };
    let mut found = observers.report(&end);
    Uncertainty::default().report(&mut found);
    report_accuracy(None, &mut found);
    let facts = RunFacts {
        dimension: run.dimension(),
        ..RunFacts::default()
    };
    Summary { run: facts, found }.quantities()
}

fn list<S: Space>(case: &Case, s: &Simulation<S>, density: f64) -> Observers {
    let test = processes::FrictionTest::of(case, s);
    let mut all = Observers::default();
    all.push(in_dimension::<S, _>(CaseChecks::of(case, s)));
    all.push(in_dimension::<S, _>(RunState::new(
        s,
        test.map(|t| t.clock),
    )));
    let start = test.map_or(0.0, |t| t.start);
    let along = case.friction.as_ref().map_or(0, |t| t.along);
    let wears = s.laws.iter().any(|l| l.wear().is_some());
    let wear = Wear::new([start, case.inertia_scaling, density], along, wears);
    all.push(in_dimension::<S, _>(wear));
    if let Some(test) = test {
        let cycles = Cycles::of(test.clock, case.time.end);
        all.push(in_dimension::<S, _>(FrictionTest::new(
            test.body, cycles, s,
        )));
    }
    if let Some(biaxial) = case.biaxial.as_ref().and_then(|b| Biaxial::new(b, s)) {
        all.push(in_dimension::<S, _>(biaxial));
    }
    all.push(in_dimension::<S, _>(Scars::of(s)));
    all.push(in_dimension::<S, _>(Phases::of(s)));
    let loops = test.filter(|t| t.clock.period.is_some());
    let loops = loops.and(case.friction.as_ref());
    let drawn = loops.map(|t| (t.body.clone(), t.along));
    all.push(in_dimension::<S, _>(DrivenBodies::of(s, drawn)));
    if !s.state.systems.is_empty() {
        all.push(in_dimension::<S, _>(Deformable::of(case, s)));
    }
    if let Some(heat) = HeatObserver::of(s) {
        all.push(in_dimension::<S, _>(heat));
    }
    if case.jump.is_some() {
        all.push(in_dimension::<S, _>(CycleJumps));
    }
    if case.accuracy.is_some() {
        all.push(in_dimension::<S, _>(ChosenSettings));
    }
    let cohesion = |i: &InterfaceSpec| i.law(Kind::COHESION).is_some();
    let bonds = case.interfaces.iter().any(cohesion);
    all.push(in_dimension::<S, _>(BrokenBonds::new(bonds)));
    all.push(in_dimension::<S, _>(Fracture::of(case, s)));
    if let Some(circuit) = &case.circuit {
        all.push(in_dimension::<S, _>(CircuitAccount::new(circuit.start)));
    }
    if let Some(top) = case.output.shear {
        all.push(in_dimension::<S, _>(LocalShear::new(s, top)));
    }
    all.append(measures::<S>(
        &case.measures,
        case.inertia_scaling,
        s.heat().is_some(),
    ));
    all
}
