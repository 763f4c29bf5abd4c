//! Calls of laws outside the sequence of a step, with some inputs replaced; their internal
//! variables are discarded.

use super::batch::{BATCH, LawBatch};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::gather::Source;
use super::history::LawHistory;
use super::interface::Interface;
use super::step_result::Velocities;
use crate::contact::Network;
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use crate::threads::chunk_size;

/// Data with which laws are called: the contacts of the step, and what is known of them at its
/// start.
#[derive(Debug)]
pub struct LawStep<'a, S: Space> {
    /// The interfaces.
    pub laws: &'a [Interface],
    /// Reference values for the checks.
    pub history: &'a mut LawHistory,
    /// The contacts.
    pub network: &'a mut Network<S>,
    /// Velocities and overlaps at the start of the step.
    pub before: &'a Velocities<S>,
    /// Time and scheme.
    pub info: &'a StepInfo,
}

/// Contacts of one interface at which a law is evaluated, each with a value that replaces an input.
pub(super) struct TrialRequest<'a, S: Space, T> {
    pub source: Source<'a, S>,
    pub before: &'a Velocities<S>,
    pub members: &'a [usize],
    pub given: &'a [T],
}

impl LawEvaluator {
    /// Evaluates a law of an interface at contacts with given values, in batches that are divided
    /// among threads; `each` is the time of a call per contact (ns).
    pub(super) fn evaluate_with<S: Space, T: Sync, R: Send>(
        &mut self,
        step: &mut LawStep<'_, S>,
        index: usize,
        members: &[usize],
        given: &[T],
        each: f64,
        call: impl Fn(&mut LawBatch, &TrialRequest<'_, S, T>) -> Result<Vec<R>, LawError> + Sync,
    ) -> Result<Vec<R>, LawError> {
        let (law, before, info) = (&step.laws[index], step.before, step.info);
        let size = chunk_size(BATCH);
        let tasks: Vec<_> = members.chunks(size).zip(given.chunks(size)).collect();
        let of = |network: &Network<S>,
                  batch: &mut LawBatch,
                  (members, given): &mut (&[usize], &[T])| {
            let source = Source::new(law, index, network, info);
            call(
                batch,
                &TrialRequest {
                    source,
                    before,
                    members,
                    given,
                },
            )
        };
        let mut all = Vec::with_capacity(members.len());
        let divide = self.divides(members.len(), each);
        self.pool.evaluate(
            divide,
            &mut step.history.largest,
            step.network,
            tasks,
            of,
            |_, _, found| all.extend(found),
        )?;
        Ok(all)
    }
}
