//! Processes that a case requests at given moments of a step, and the friction test that cycle
//! jumps follow.

use super::case::Case;
use super::circuit;
use super::phases::{drives_of_holder, holder_name};
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_core::process::circuit::Intervals;
use fretwork_core::process::cycle::CycleClock;
use fretwork_core::process::sliding::{SlidingBody, SlidingPart};
use fretwork_core::view::{RunSetup, RunView};

/// The friction test of a case, in its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionTest {
    /// The rubbed body.
    pub body: SlidingBody,
    /// Cycles.
    pub clock: CycleClock,
    /// Start of the measured motion (s). Where the motion has no period, friction is measured from
    /// a later time.
    pub start: f64,
}

impl FrictionTest {
    /// Finds the test of a case in its scene; `None` where the case has none.
    pub fn of(case: &Case, s: &dyn RunView) -> Option<Self> {
        let test = case.friction.as_ref()?;
        let (rubbed, dof) = rubbed(case, s)?;
        // What it rubs against may move instead of the body itself.
        let own = dof.function().filter(|f| f.period().is_some());
        let moves = own.or_else(|| others(case, s, test.along));
        let period = test.period.or(moves.and_then(TimeFunction::period));
        let start = match moves {
            Some(TimeFunction::Sine { start, .. }) => test.start.max(*start),
            _ => test.start,
        };
        Some(Self {
            body: SlidingBody {
                part: rubbed,
                along: test.along,
                normal: test.normal,
            },
            clock: CycleClock::new(start, period, case.time.end),
            start,
        })
    }
}

/// Returns the motion of the first body that moves to and fro along an axis, or turns so.
fn others<'a>(case: &'a Case, s: &'a dyn RunView, along: usize) -> Option<&'a TimeFunction> {
    let dimension = s.dimension();
    let driven = s.bodies().driven.iter().flat_map(move |d| {
        let turns = d.dofs.iter().skip(dimension);
        d.dofs.get(along).into_iter().chain(turns)
    });
    let half_spaces = case.half_spaces.iter().filter_map(move |b| {
        let dofs = &b.dofs;
        [&dofs.x, &dofs.y, &dofs.z][along].as_ref()
    });
    let elastic = case.elastic.iter().flat_map(|b| &b.supports);
    let elastic = elastic.filter_map(move |s| [&s.x, &s.y, &s.z][along].as_ref());
    let all = driven.chain(half_spaces).chain(elastic);
    all.filter_map(Dof::function).find(|f| f.period().is_some())
}

/// Returns the rubbed body of the test of a case in its scene, and its drive.
fn rubbed<'a>(case: &'a Case, s: &'a dyn RunView) -> Option<(SlidingPart, &'a Dof)> {
    let test = case.friction.as_ref()?;
    let driven = s.bodies().driven;
    if let Some(place) = driven.iter().position(|d| d.name == test.body) {
        return Some((SlidingPart::Driven(place), &driven[place].dofs[test.along]));
    }
    let (part, dof) = held(case, &test.body, test.along)?;
    let system = s.system_named(&test.body)?;
    let holders = s.system(system)?.holders();
    let holder = holders
        .iter()
        .position(|h| h.part == part && h.axis == test.along)?;
    Some((SlidingPart::System { system, holder }, dof))
}

/// Returns the part of a deformable body that is held along an axis, and its drive: the first that
/// moves or has a force, or otherwise the first.
pub(crate) fn held<'a>(case: &'a Case, body: &str, along: usize) -> Option<(&'a str, &'a Dof)> {
    if let Some(half_space) = case.half_spaces.iter().find(|b| b.name == body) {
        let dofs = &half_space.dofs;
        let dof = [&dofs.x, &dofs.y, &dofs.z][along].as_ref();
        return Some(("holder", dof.unwrap_or(&Dof::Fixed)));
    }
    let elastic = case.elastic.iter().find(|b| b.name == body)?;
    let supports = elastic.supports.iter();
    let held: Vec<(&str, &Dof)> = supports
        .filter_map(|s| Some((s.part.as_str(), [&s.x, &s.y, &s.z][along].as_ref()?)))
        .collect();
    let moves = |(part, dof): &&(&str, &Dof)| {
        let name = holder_name(body, part);
        let own = Some((*dof).clone());
        drives_of_holder(case, &name, along, &own).any(|d| !matches!(d, Dof::Fixed))
    };
    let driven = held.iter().find(moves);
    driven.or(held.first()).copied()
}

/// Adds the processes of a case to its simulation before the first step: cycle jumps and the
/// tribological circuit. Recession by wear was added with the surfaces that wear.
pub fn install(case: &Case, s: &mut dyn RunSetup) {
    add_jumps(case, s);
    if let (Some(spec), Some(words)) = (circuit::install(case, s), &case.circuit) {
        let intervals = Intervals {
            every: words.every,
            rows: (case.output.every > 1).then_some(case.output.every),
        };
        s.add_circuit(spec, words.start, intervals);
    }
}

/// Adds jumps over cycles, if the case has them and its friction test has cycles.
fn add_jumps(case: &Case, s: &mut dyn RunSetup) {
    let (Some(spec), Some(test)) = (case.jump.clone(), FrictionTest::of(case, s)) else {
        return;
    };
    let Some(period) = test.clock.period else {
        return;
    };
    let count = |time: f64| (time / case.time.step).round() as u64;
    let steps = [count(period), count(case.time.end)];
    s.add_jumps(spec, test.clock, test.body, steps);
}
