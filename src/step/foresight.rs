//! Contacts that close within a step: known before it is solved, or found by its velocities, and then it is solved again.

use super::motion::Before;
use super::{Simulation, StepError, StepReport};
use crate::contact::Key;
use crate::contact::detect::{self, Motion};
use crate::geometry::space::Space;
use crate::laws::columns::StepInfo;

/// Solves of a step at most: each may send bodies into others that the one before did not.
const MOST_SOLVES: usize = 6;

impl<S: Space> Simulation<S> {
    /// Adds the contacts that the velocities without contacts would close in the step.
    pub(super) fn foresee(&mut self, free: &[(S::Vector, S::Spin)]) {
        let motion = Motion {
            velocities: free,
            time: self.time,
            h: self.scheme.h,
        };
        let (network, bodies) = (&mut self.network, &self.bodies);
        let all = free.iter().copied();
        if detect::is_calm(network, &self.shapes, bodies, all, motion.h) {
            return;
        }
        detect::foresee(network, &self.shapes, bodies, &self.table, &motion);
    }

    /// Solves the step, and again while its velocities send bodies into others that were not solved for.
    pub(super) fn solve(
        &mut self,
        start: &Before<S>,
        free: &[(S::Vector, S::Spin)],
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let mut last: Vec<(Key, S::Vector)> = Vec::new();
        for solves in 1.. {
            self.relative_velocities();
            self.geometry_of_forms(info.h);
            for (form, contact) in self.forms.iter_mut().zip(&self.network.contacts) {
                // From the solve before.
                if let Ok(at) = last.binary_search_by_key(&contact.key, |c| c.0) {
                    form.impulse = last[at].1;
                }
            }
            self.couple(start, free, info, report)?;
            let velocities = self.bodies.velocity.iter().copied();
            let velocities = velocities.zip(self.bodies.spin.iter().copied());
            let (network, bodies) = (&mut self.network, &self.bodies);
            if detect::is_calm(network, &self.shapes, bodies, velocities.clone(), info.h) {
                return Ok(());
            }
            let velocities: Vec<_> = velocities.collect();
            let motion = Motion {
                velocities: &velocities,
                time: self.time,
                h: info.h,
            };
            if solves == MOST_SOLVES {
                detect::report_passing(network, &self.shapes, bodies, &self.table, &motion);
                return Ok(());
            }
            let found = detect::overlooked(network, &self.shapes, bodies, &self.table, &motion);
            if found.is_empty() {
                return Ok(());
            }
            let solved = network.contacts.iter().zip(&self.solved.sites);
            last = solved.map(|(c, s)| (c.key, s.solution.impulse)).collect();
            network.take_in(found);
            start.restore(&mut self.bodies);
            let remembered = self.passes.remember(&self.laws, &mut self.network, info);
            remembered.map_err(|e| self.law_error(e))?;
        }
        Ok(())
    }
}
