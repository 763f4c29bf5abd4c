//! Laws asked in the course of a step.

use crate::geometry::space::Space;
use crate::laws::Step;
use crate::laws::StepInfo;
use crate::laws::evaluator::LawEvaluator;
use crate::step::Simulation;

/// What calls laws, and what they are asked of.
pub(super) fn asks<'a, S: Space>(
    s: &'a mut Simulation<S>,
    info: &'a StepInfo,
) -> (&'a mut LawEvaluator, Step<'a, S>) {
    let step = Step {
        laws: &s.laws,
        history: &mut s.state.law_history,
        network: &mut s.state.network,
        before: &s.workspace.solved.before,
        info,
    };
    (&mut s.workspace.evaluator, step)
}
