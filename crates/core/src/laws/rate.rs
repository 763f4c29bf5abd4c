//! Friction at a sliding velocity other than that at the start of the step, by another call of the
//! contact law.

use super::batch::{LawBatch, locate};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::Source;
use super::trial::{LawStep, TrialRequest};
use crate::geometry::space::Space;

/// Approximate time per contact of the two calls (ns).
const EACH: f64 = 120.0;

/// Sliding velocities at which a law is tried to find whether it depends on them (m/s).
const TRIED: [f64; 7] = [0.0, 1e-9, 1e-6, 1e-3, 3e-2, 1.0, 1e2];

/// Largest number of contacts of an interface on which dependence on velocity is tried, spread over
/// all of them: it may depend on the state of a contact or the size of its bodies.
const SAMPLE: usize = 16;

/// Relative change of the velocity for the slope of friction, and relative change of friction that
/// is more than rounding.
const NEARBY: f64 = 1e-4;
const ROUNDING: f64 = 1e-13;

/// Friction of a contact at a sliding velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionAt {
    /// Friction coefficient mu.
    pub mu: f64,
    /// Derivative of mu by the velocity (s/m).
    pub slope: f64,
}

impl LawEvaluator {
    /// Finds the interfaces whose friction depends on the sliding velocity, by trials on some of
    /// their contacts in the state of the step. An error at a trial velocity is not reported.
    pub fn rate_dependent<S: Space>(
        &mut self,
        step: &mut LawStep<'_, S>,
    ) -> Vec<(usize, Vec<usize>)> {
        let mut found = Vec::new();
        for (index, law) in step.laws.iter().enumerate() {
            if law.constant_contact() {
                continue;
            }
            let all = &self.members[index].all;
            let every = all.len().div_ceil(SAMPLE).max(1);
            let sample: Vec<usize> = all.iter().copied().step_by(every).collect();
            if sample.is_empty() {
                continue;
            }
            let source = Source {
                law,
                index,
                network: &*step.network,
                info: step.info,
            };
            let members: Vec<usize> = sample.iter().flat_map(|at| [*at; TRIED.len()]).collect();
            let depends = self.pool.with(|batch| {
                batch.gather_before(&source, &members, step.before, &[law.contact()]);
                let [_, t1, t2] = &mut batch.columns.velocity;
                let each = t1.chunks_exact_mut(TRIED.len());
                each.for_each(|of_contact| of_contact.copy_from_slice(&TRIED));
                t2.fill(0.0);
                let called = batch.run_afresh(law.contact(), step.info, 0.0, Call::Prepare);
                let mut friction = batch.columns.out.friction.chunks(TRIED.len());
                called.is_err() || friction.any(|mu| mu.iter().any(|x| *x != mu[0]))
            });
            if depends {
                found.push((index, self.members[index].all.clone()));
            }
        }
        found
    }

    /// Returns the friction of contacts of an interface, each at a tangential velocity.
    ///
    /// # Errors
    /// The law's error, with the contact.
    pub fn friction_at<S: Space>(
        &mut self,
        step: &mut LawStep<'_, S>,
        index: usize,
        members: &[usize],
        velocities: &[S::Tangent],
    ) -> Result<Vec<FrictionAt>, LawError> {
        self.evaluate_with(step, index, members, velocities, EACH, |batch, request| {
            let TrialRequest { source, before, .. } = *request;
            batch.gather_before(&source, request.members, before, &[source.law.contact()]);
            for (k, at) in request.members.iter().enumerate() {
                let normal = &source.network.contacts[*at].normal;
                let [v1, v2] = S::components(normal, &request.given[k]);
                let [_, t1, t2] = &mut batch.columns.velocity;
                t1[k] = v1;
                if S::D == 3 {
                    t2[k] = v2;
                }
            }
            batch.friction_and_slope(&source, request.members)
        })
    }
}

impl LawBatch {
    /// Returns friction at the velocities in the columns, and its slope from another call at
    /// slightly larger velocities.
    fn friction_and_slope<S: Space>(
        &mut self,
        source: &Source<'_, S>,
        members: &[usize],
    ) -> Result<Vec<FrictionAt>, LawError> {
        let Source {
            law, network, info, ..
        } = *source;
        let ask = |batch: &mut Self| -> Result<Vec<f64>, LawError> {
            batch
                .run_afresh(law.contact(), info, 0.0, Call::Prepare)
                .map_err(|e| locate(law, network, members, e))?;
            Ok(batch.columns.out.friction[..members.len()].to_vec())
        };
        let friction = ask(self)?;
        let speed = |batch: &Self, k: usize| {
            let [_, t1, t2] = &batch.columns.velocity;
            t1[k].hypot(t2.get(k).copied().unwrap_or(0.0))
        };
        let speeds: Vec<f64> = (0..members.len()).map(|k| speed(self, k)).collect();
        let [_, t1, t2] = &mut self.columns.velocity;
        t1.iter_mut().chain(t2).for_each(|v| *v *= 1.0 + NEARBY);
        let nearby = ask(self)?;
        let of = |k: usize| {
            let change = nearby[k] - friction[k];
            let by = NEARBY * speeds[k];
            let known = by > 0.0 && change.abs() > ROUNDING * friction[k];
            FrictionAt {
                mu: friction[k],
                slope: if known { change / by } else { 0.0 },
            }
        };
        Ok((0..members.len()).map(of).collect())
    }
}
