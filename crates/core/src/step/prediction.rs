//! Contacts that close within a step, found before the solve or from its velocities; in the second case the
//! step is solved again.

use super::motion::StepStart;
use super::{Scheme, Simulation, StepError, StepReport};
use crate::contact::Key;
use crate::contact::detect::{self, Motion};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::columns::StepInfo;
use crate::threads::{fill, pays};

/// Maximum number of solves of a step: each may close contacts that the previous one did not.
const MAX_SOLVES: usize = 6;
/// Relative change of a surface's spin from which it counts as a jump.
const TURNS: f64 = 0.01;
/// About what it takes to copy the velocity of a body (ns).
const COPY: f64 = 3.0;

impl<S: Space> Simulation<S> {
    /// Reports tunnelling during the first half move. Each step checks the paths of the bodies between two
    /// detections at its final velocities; this misses the very first move and the velocity added by a jump
    /// of an imposed motion. `before` holds the velocities and spins of the driven bodies before their
    /// jumps.
    pub(super) fn watch_first_move(&mut self, before: &[(S::Vector, S::Spin)]) {
        let Scheme { h, theta } = self.options.scheme;
        let length = (1.0 - theta) * h;
        let (network, bodies) = (&mut self.state.network, &self.state.bodies);
        if self.state.steps == 0 {
            let velocity = |b: usize| (bodies.velocity[b], bodies.spin[b]);
            if detect::is_calm(network, &self.shapes, bodies, velocity, length, false) {
                return;
            }
        } else if !self.velocities_jump(before, length) {
            return;
        }
        detect::report_first_move(
            &mut self.state.network,
            &self.shapes,
            &self.state.bodies,
            &self.table,
            self.state.time,
            length,
        );
    }

    /// Reports penetrations and passages in the move before detection if a process has applied an impulse.
    pub(super) fn watch_push(&mut self) {
        let Scheme { h, theta } = self.options.scheme;
        let length = (1.0 - theta) * h;
        let (network, bodies) = (&mut self.state.network, &self.state.bodies);
        let velocity = |b: usize| (bodies.velocity[b], bodies.spin[b]);
        if self.workspace.pushed
            && !detect::is_calm(network, &self.shapes, bodies, velocity, length, false)
        {
            let (shapes, table) = (&self.shapes, &self.table);
            detect::report_first_move(network, shapes, bodies, table, self.state.time, length);
        }
    }

    /// Returns whether the jumps of imposed velocities give a body a large displacement within a time (s).
    fn velocities_jump(&self, before: &[(S::Vector, S::Spin)], time: f64) -> bool {
        let bodies = &self.state.bodies;
        let mut driven = bodies.driven.iter().zip(before);
        driven.any(|(driven, (v, w))| {
            let b = driven.body as usize;
            let jump = (bodies.velocity[b] - *v).norm();
            let turn = (bodies.spin[b] - *w).norm();
            let lever = self.state.network.extents.lever(b);
            let surfaces = self.shapes.surfaces.iter();
            // The extent of the surface is unknown.
            let sweeps = turn > TURNS * bodies.spin[b].norm().max(w.norm())
                && surfaces.filter(|s| s.body as usize == b).any(|s| {
                    !s.shape
                        .keeps_place(&S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]))
                });
            time * (jump + turn * lever) > self.state.network.fast || sweeps
        })
    }

    /// Reports impacts with restitution that were only kept from closing, because other impacts of the step
    /// preceded them.
    fn report_held_back(&mut self) {
        for k in &self.workspace.evaluator.held_back {
            if self.workspace.solved.contact_steps[*k].solution.impulse != S::Vector::zero() {
                let pair = self.state.network.contacts[*k].bodies;
                let step_size = &mut self.state.network.step_size;
                step_size.record_held_back(self.state.time, &self.state.bodies, pair);
            }
        }
    }

    /// Adds the contacts that the free velocities (without contact impulses) would close in the step.
    pub(super) fn add_predicted_contacts(&mut self, free: &[(S::Vector, S::Spin)]) {
        // Over a step that has grown nothing moves: what falls without contacts is held by those at hand. The velocities after the
        // solve tell whether that is so.
        if self.options.grown > 0 {
            return;
        }
        let motion = Motion {
            velocities: free,
            time: self.state.time,
            h: self.options.scheme.h,
            parallel: self.options.solver.parallel,
        };
        let (network, bodies) = (&mut self.state.network, &self.state.bodies);
        let (h, parallel) = (motion.h, motion.parallel);
        if detect::is_calm(network, &self.shapes, bodies, |b| free[b], h, parallel) {
            return;
        }
        detect::add_predicted(network, &self.shapes, bodies, &self.table, &motion);
    }

    /// Solves the step, and repeats while the resulting velocities close contacts that were not part of the
    /// problem.
    pub(super) fn solve(
        &mut self,
        start: &StepStart<S>,
        free: &[(S::Vector, S::Spin)],
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        self.solve_with_all(start, free, info, report)?;
        self.report_held_back();
        Ok(())
    }

    fn solve_with_all(
        &mut self,
        start: &StepStart<S>,
        free: &[(S::Vector, S::Spin)],
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let mut last: Vec<(Key, S::Vector)> = Vec::new();
        self.forget_system_contacts();
        for solves in 1.. {
            self.place_actions();
            self.find_system_contacts();
            self.relative_velocities();
            self.geometry_of_forms(free, info.h);
            for (form, contact) in self
                .workspace
                .forms
                .iter_mut()
                .zip(&self.state.network.contacts)
            {
                // From the solve before.
                if let Ok(at) = last.binary_search_by_key(&contact.key, |c| c.0) {
                    form.impulse = last[at].1;
                }
            }
            self.couple(start, free, info, report)?;
            report.solves = solves as u32;
            let (network, bodies) = (&mut self.state.network, &self.state.bodies);
            let velocity = |b: usize| (bodies.velocity[b], bodies.spin[b]);
            let parallel = self.options.solver.parallel;
            if detect::is_calm(network, &self.shapes, bodies, velocity, info.h, parallel) {
                return Ok(());
            }
            let (mut velocities, divide) = (Vec::new(), pays(parallel, bodies.len(), COPY));
            fill(divide, &mut velocities, bodies.len(), velocity);
            let motion = Motion {
                velocities: &velocities,
                time: self.state.time,
                h: info.h,
                parallel,
            };
            if solves == MAX_SOLVES {
                detect::report_passing(network, &self.shapes, bodies, &self.table, &motion);
                return Ok(());
            }
            let found = detect::find_missed(network, &self.shapes, bodies, &self.table, &motion);
            if found.is_empty() {
                return Ok(());
            }
            let solved = network
                .contacts
                .iter()
                .zip(&self.workspace.solved.contact_steps);
            last = solved.map(|(c, s)| (c.key, s.solution.impulse)).collect();
            network.merge_contacts(found);
            start.restore(&mut self.state.bodies);
            self.restart_systems();
            self.reach_mean_places(false);
            self.initialise_contacts(info)?;
        }
        Ok(())
    }
}
