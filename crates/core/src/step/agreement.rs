//! Solves a step again until what laws gave for it agrees with what it came to.

use super::motion::StepStart;
use super::{Simulation, StepError, StepReport};
use crate::geometry::space::Space;
use crate::laws::Step;
use crate::laws::columns::StepInfo;
use crate::laws::evaluator::LawEvaluator;
use crate::solve;
use std::time::Instant;

/// Difference between the attraction used and that over the gaps passed, over the load of the contact, that is let stand.
const TOLERANCE: f64 = 1e-4;
/// Solves of a step, at most, and those in which attractions follow: one contact takes up to eight, and among many some may jump between
/// gaps that hold and gaps that do not.
const MOST: u32 = 40;
const MOST_OF_ATTRACTION: u32 = 12;
/// Iterations of a solve whose laws are not those of the solution yet.
const BRIEF: u32 = 100;

/// How laws and the step agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Number of solves: more than 1 where friction depends on velocity, or attraction on the gap.
    pub solves: u32,
    /// Sum over contacts of the difference between the friction used and that of the laws at the velocity of sliding reached, over
    /// the sum of the friction.
    pub friction: f64,
    /// Sum over contacts of the difference between the attraction used and that over the gaps passed, over the sum of their loads.
    pub attraction: f64,
}

impl<S: Space> Simulation<S> {
    /// Solves the contacts with the forms that laws prepared, and collects what they did.
    pub(super) fn solve_in_agreement(
        &mut self,
        start: &StepStart<S>,
        free: &[(S::Vector, S::Spin)],
        options: &solve::Options,
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let clock = Instant::now();
        let mut attractions = self.begin_attractions();
        let sliding = self.begin_sliding(info);
        let mut sliding = sliding.map_err(|e| self.law_error(e))?;
        report.timing.laws += clock.elapsed();
        let mut agreement = Agreement::default();
        let brief = solve::Options {
            max_iterations: options.max_iterations.min(BRIEF),
            ..*options
        };
        // Laws that follow the velocity are brought near to their solution first.
        let mut to_the_end = sliding.is_empty();
        loop {
            let clock = Instant::now();
            self.solve_contacts(free, if to_the_end { options } else { &brief }, report)?;
            report.timing.solve += clock.elapsed();
            self.collect_contact_steps();
            agreement.solves += 1;
            let solved = to_the_end || report.solver.converged;
            let clock = Instant::now();
            // After the last solve nothing is linearised anew: its forms are those of the solution.
            let again = agreement.solves < MOST;
            let friction = self.compare_sliding(&mut sliding, again, info);
            let friction = friction.map_err(|e| self.law_error(e))?;
            let tolerance = if agreement.solves < MOST_OF_ATTRACTION {
                TOLERANCE
            } else {
                f64::INFINITY
            };
            let attraction = self.compare_attractions(&mut attractions, tolerance, info);
            let attraction = attraction.map_err(|e| self.law_error(e))?;
            (agreement.friction, agreement.attraction) = (friction.share, attraction.share());
            report.timing.laws += clock.elapsed();
            if attraction.worst <= tolerance && (friction.agrees || !again) {
                if solved {
                    break;
                }
                to_the_end = true;
            }
            to_the_end |= agreement.solves + 1 >= MOST;
            let both = self
                .workspace
                .forms
                .iter_mut()
                .zip(&self.workspace.solved.contact_steps);
            both.for_each(|(form, step)| form.impulse = step.solution.impulse);
        }
        let told = report.solver.converged.then(|| self.is_not_searched());
        [report.solver.not_searched, report.solver.pinched] = told.unwrap_or_default();
        self.settle_sliding(sliding);
        self.settle_attractions(attractions, info.h);
        self.collect_spring_steps();
        self.collect_moment_steps(start);
        report.agreement = agreement;
        Ok(())
    }

    /// What calls laws, and what they are asked of.
    pub(super) fn asks<'a>(
        &'a mut self,
        info: &'a StepInfo,
    ) -> (&'a mut LawEvaluator, Step<'a, S>) {
        let step = Step {
            laws: &self.laws,
            history: &mut self.state.law_history,
            network: &mut self.state.network,
            before: &self.workspace.solved.before,
            info,
        };
        (&mut self.workspace.evaluator, step)
    }
}
