//! Data with which laws are evaluated in the course of a step.

use crate::geometry::space::Space;
use crate::laws::evaluator::LawEvaluator;
use crate::laws::{LawStep, StepInfo};
use crate::step::Simulation;

/// Returns the evaluator of laws, and the contacts at which it evaluates them.
pub(super) fn law_step<'a, S: Space>(
    s: &'a mut Simulation<S>,
    info: &'a StepInfo,
) -> (&'a mut LawEvaluator, LawStep<'a, S>) {
    let step = LawStep {
        laws: &s.laws,
        history: &mut s.state.law_history,
        network: &mut s.state.network,
        before: &s.workspace.solved.before,
        info,
    };
    (&mut s.workspace.evaluator, step)
}
