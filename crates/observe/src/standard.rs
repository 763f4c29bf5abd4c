//! Observers of a run of a case.

use super::accuracy::{ChosenSettings, report_accuracy};
use super::biaxial::Biaxial;
use super::case_checks::CaseChecks;
use super::circuit::{BrokenBonds, CircuitAccount, WornGrains};
use super::deformable::Deformable;
use super::first_bodies::WearMaterials;
use super::fracture::Fracture;
use super::friction::Cycles;
use super::friction_test::FrictionTest;
use super::grain_bonds::GrainBonds;
use super::heat::HeatObserver;
use super::jump::CycleJumps;
use super::law_tables::{LawTables, reads_table};
use super::measure::{ThirdBody, measures};
use super::observer::{Observers, RunEnd};
use super::quantity::Findings;
use super::run_state::{DrivenBodies, Phases, RunState};
use super::scars::Scars;
use super::solving::report_problems;
use super::statistics::Table;
use super::strain::LocalShear;
use super::summary::{RunFacts, Summary, Uncertainty};
use super::wear::Wear;
use fretwork_core::laws::Kind;
use fretwork_core::view::RunView;
use fretwork_scene::case::{Case, InterfaceSpec};
use fretwork_scene::processes;
use std::time::Duration;

/// Returns the observers of a run of a case, from the current state of its simulation on, in the
/// order of the columns of the statistics.
pub fn observers(case: &Case, run: &dyn RunView, materials: &WearMaterials) -> Observers {
    let test = processes::FrictionTest::of(case, run);
    let mut all = Observers::default();
    all.push(Box::new(CaseChecks::of(case, run)));
    all.push(Box::new(RunState::new(run, test.map(|t| t.clock))));
    let start = test.map_or(0.0, |t| t.start);
    let along = case.friction.as_ref().map_or(0, |t| t.along);
    let wears = run.laws().iter().any(|l| l.wear().is_some());
    let flows = [start, case.inertia_scaling];
    let wear = Wear::new(flows, materials.clone(), along, wears);
    all.push(Box::new(wear));
    if let Some(test) = test {
        let sizes = run.bodies().length.iter().filter(|length| **length > 0.0);
        let smallest = sizes.copied().fold(f64::INFINITY, f64::min);
        let cycles = Cycles::of(test.clock, case.time.end).with_length(smallest);
        all.push(Box::new(FrictionTest::new(test.body, cycles, run)));
    }
    if let Some(biaxial) = case.biaxial.as_ref().and_then(|b| Biaxial::new(b, run)) {
        all.push(Box::new(biaxial));
    }
    all.push(Box::new(Scars::of(run)));
    if run.laws().iter().any(reads_table) {
        all.push(Box::new(LawTables));
    }
    all.push(Box::new(Phases::of(run)));
    let loops = test.filter(|t| t.clock.period.is_some());
    let loops = loops.and(case.friction.as_ref());
    let drawn = loops.map(|t| (t.body.clone(), t.along));
    all.push(Box::new(DrivenBodies::of(run, drawn)));
    if run.system_count() > 0 {
        all.push(Box::new(Deformable::of(case, run)));
    }
    if let Some(heat) = HeatObserver::of(run) {
        all.push(Box::new(heat));
    }
    if case.jump.is_some() {
        all.push(Box::new(CycleJumps));
    }
    if case.accuracy.is_some() {
        all.push(Box::new(ChosenSettings));
    }
    let cohesion = |i: &InterfaceSpec| i.law(Kind::COHESION).is_some();
    let bonds = case.interfaces.iter().any(cohesion);
    all.push(Box::new(BrokenBonds::new(bonds)));
    if bonds {
        all.push(Box::new(GrainBonds));
    }
    all.push(Box::new(Fracture::of(case, run)));
    if let Some(circuit) = &case.circuit {
        let worn = WornGrains::new(test.map(|t| t.body), materials.clone());
        all.push(Box::new(CircuitAccount::new(circuit.start, worn)));
    }
    if let Some(top) = case.output.shear {
        all.push(Box::new(LocalShear::new(run, top)));
    }
    all.append(measures(&case.measures, case.inertia_scaling, run));
    all
}

/// Returns the files of the figures of observers that only some cases have. A run removes them from
/// its folder also where its case has no such observer, since they are those of another case.
pub fn figures_of_some_cases() -> impl Iterator<Item = &'static str> {
    let figures = FrictionTest::FIGURES.into_iter();
    let figures = figures.chain(Biaxial::FIGURES).chain(CycleJumps::FIGURES);
    figures.chain(CircuitAccount::FIGURES)
}

/// Returns the names of the pictures of observers that only some cases have, which a run removes as
/// the figures of [`figures_of_some_cases`].
pub fn pictures_of_some_cases() -> [&'static str; 3] {
    [
        LocalShear::PICTURE,
        CircuitAccount::PICTURE,
        ThirdBody::PICTURE,
    ]
}

/// Returns the results of a run of a case as far as they are known before its first step: values
/// are those of the start, and results that a case cannot have give the reason.
pub fn declared(case: &Case, run: &dyn RunView) -> Findings {
    declared_by(&observers(case, run, &WearMaterials::default()), run)
}

/// What a run with these observers will say, as far as it is known before its first step.
pub fn declared_by(observers: &Observers, run: &dyn RunView) -> Findings {
    let end = RunEnd {
        simulation: run,
        table: &Table::new(observers.columns(), run.dimension()),
        title: "",
        uncertainty: &Uncertainty::default(),
        wall: Duration::ZERO,
    };
    let mut found = observers.report(&end);
    report_problems(0, 0, &mut found);
    Uncertainty::default().report(&mut found);
    report_accuracy(None, &mut found);
    let facts = RunFacts {
        dimension: run.dimension(),
        ..RunFacts::default()
    };
    Summary { run: facts, found }.quantities()
}
