//! Attraction without opening at a gap other than that of detection, by another call of the
//! cohesion law.

use super::batch::locate;
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::Source;
use super::interface::Interface;
use super::trial::{LawStep, TrialRequest};
use crate::geometry::space::Space;

/// Approximate time of a call per contact (ns).
const EACH: f64 = 80.0;

impl Interface {
    /// Returns whether the cohesion law has no opening: an attraction as a function of the gap.
    pub fn attracts(&self) -> bool {
        self.cohesion().is_some() && !self.opens()
    }
}

impl LawEvaluator {
    /// Returns the contacts on which an attraction acts, for each interface that has one.
    pub fn attracted(&self, laws: &[Interface]) -> Vec<(usize, Vec<usize>)> {
        let all = laws.iter().enumerate().filter(|(_, law)| law.attracts());
        let all = all.map(|(index, _)| (index, self.members[index].near().to_vec()));
        all.filter(|(_, members)| !members.is_empty()).collect()
    }

    /// Returns the attraction (N; N/m in 2D) of contacts of an interface, each at a gap (m); a
    /// contact may occur several times. A contact that touches keeps the internal variables of its
    /// law, such as a neck or a bridge.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn attraction_at<S: Space>(
        &mut self,
        step: &mut LawStep<'_, S>,
        index: usize,
        members: &[usize],
        gaps: &[f64],
    ) -> Result<Vec<f64>, LawError> {
        let Some(cohesion) = step.laws[index].cohesion() else {
            return Ok(vec![0.0; members.len()]);
        };
        self.evaluate_with(step, index, members, gaps, EACH, |batch, request| {
            let TrialRequest {
                source,
                before,
                members,
                given: gaps,
            } = *request;
            let Source {
                law, network, info, ..
            } = source;
            let failed = |e| locate(law, network, members, e);
            batch.gather_before(&source, members, before, &[cohesion]);
            let touching = |at: &usize| network.contacts[*at].gap <= 0.0;
            if cohesion.variables() > 0 && members.iter().any(touching) {
                batch
                    .run_afresh(cohesion, info, 0.0, Call::Commit)
                    .map_err(failed)?;
                let first = cohesion.first_variable;
                for v in first..first + cohesion.variables() {
                    let columns = &mut batch.columns;
                    let states = columns.state[v].iter_mut().zip(&columns.state_next[v]);
                    for ((state, next), at) in states.zip(members) {
                        if touching(at) {
                            *state = *next;
                        }
                    }
                }
            }
            batch.columns.gap.copy_from_slice(gaps);
            batch
                .run_afresh(cohesion, info, 0.0, Call::Prepare)
                .map_err(failed)?;
            let columns = &batch.columns;
            let all = columns.out.tension_strength.iter().zip(&columns.area);
            Ok(all.map(|(strength, area)| strength * area).collect())
        })
    }
}
