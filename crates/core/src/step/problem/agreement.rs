//! Solves a step again until the values of the laws agree with its solution.

use super::{answers, attraction, posing, sliding};
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use crate::solve;
use crate::step::motion::StepStart;
use crate::step::{Agreement, Simulation, StepError, StepReport};
use std::time::Instant;

/// Accepted difference between the attraction used and that over the gaps passed, relative to the
/// load of the contact.
const TOLERANCE: f64 = 1e-4;
/// Largest number of solves of a step.
const MAX_SOLVES: u32 = 40;
/// Largest number of solves of a step in which attractions are updated: a single contact takes up
/// to eight, and among many contacts some may jump between gaps that hold and gaps that do not.
const MAX_ATTRACTION_UPDATES: u32 = 12;
/// Number of iterations of a solve whose laws do not agree with its solution yet.
const BRIEF: u32 = 100;

/// Solves the contacts with the forms that laws prepared, and collects the results.
pub(super) fn solve_in_agreement<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    free: &[(S::Vector, S::Spin)],
    options: &solve::SolverOptions,
    info: &StepInfo,
    report: &mut StepReport,
) -> Result<(), StepError> {
    let clock = Instant::now();
    let mut attractions = attraction::begin_attractions(s);
    let sliding = sliding::begin_sliding(s, info);
    let mut sliding = sliding.map_err(|e| s.law_error(e))?;
    report.timing.laws += clock.elapsed();
    let mut agreement = Agreement::default();
    let brief = solve::SolverOptions {
        max_iterations: options.max_iterations.min(BRIEF),
        ..*options
    };
    // Laws that depend on the velocity are first brought near to their solution.
    let mut to_the_end = sliding.is_empty();
    loop {
        let clock = Instant::now();
        posing::solve_contacts(s, free, if to_the_end { options } else { &brief }, report)?;
        report.timing.solve += clock.elapsed();
        answers::collect_contact_steps(s);
        agreement.solves += 1;
        let solved = to_the_end || report.solver.converged;
        let clock = Instant::now();
        // After the last solve nothing is linearised again: its forms belong to the solution.
        let again = agreement.solves < MAX_SOLVES;
        let friction = sliding::compare_sliding(s, &mut sliding, again, info);
        let friction = friction.map_err(|e| s.law_error(e))?;
        let tolerance = if agreement.solves < MAX_ATTRACTION_UPDATES {
            TOLERANCE
        } else {
            f64::INFINITY
        };
        let attraction = attraction::compare_attractions(s, &mut attractions, tolerance, info);
        let attraction = attraction.map_err(|e| s.law_error(e))?;
        (agreement.friction, agreement.attraction) = (friction.share, attraction.share());
        report.timing.laws += clock.elapsed();
        if attraction.worst <= tolerance && (friction.agrees || !again) {
            if solved {
                break;
            }
            to_the_end = true;
        }
        to_the_end |= agreement.solves + 1 >= MAX_SOLVES;
        let both = s
            .workspace
            .forms
            .iter_mut()
            .zip(&s.workspace.solved.contact_steps);
        both.for_each(|(form, step)| form.impulse = step.solution.impulse);
    }
    let searched = report.solver.converged.then(|| answers::is_not_searched(s));
    [report.solver.not_searched, report.solver.pinched] = searched.unwrap_or_default();
    sliding::settle_sliding(s, sliding);
    attraction::settle_attractions(s, attractions, info.h);
    answers::collect_spring_steps(s);
    answers::collect_moment_steps(s, start);
    report.agreement = agreement;
    Ok(())
}
