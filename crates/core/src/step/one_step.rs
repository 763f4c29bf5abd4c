//! One time step, in the order of the picture in [`super`].

use super::answers::effective_mass;
use super::motion::{self, StepStart};
use super::{Scheme, Simulation, StepError, StepReport};
use crate::contact::detect::{Impact, detect, record_edges};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::columns::StepInfo;
use crate::laws::{Interface, SpringForm};
use crate::threads::{count, map_chunks, pays};
use std::time::Instant;

/// Contacts of a task.
const CHUNK: usize = 1024;
/// About what it takes to look whether a contact is one of a driven body, and whether it carries an impulse (ns).
const RECEIVED: f64 = 5.0;
const ACTS: f64 = 5.0;

/// Velocity and spin of each body.
type Motions<S> = Vec<(<S as Space>::Vector, <S as Space>::Spin)>;

impl<S: Space> Simulation<S> {
    /// See [`Simulation::step`].
    pub(super) fn one_step(&mut self) -> Result<StepReport, StepError> {
        self.refuse_projection_of_systems()?;
        self.between_steps()?;
        self.check_worn_through()?;
        let mut report = StepReport::default();
        let info = self.step_info();
        self.workspace.evaluator.parallel = self.options.solver.parallel;
        self.begin_step()?;
        let (start, free) = self.detect_contacts(&info, &mut report)?;
        self.solve(&start, &free, &info, &mut report)?;
        self.commit_laws(&info, &mut report)?;
        self.book_expansion();
        self.conduct()?;
        self.book(&start, &mut report);
        self.book_momentum(&start, &mut report);
        self.watch_edges();
        self.move_to_end();
        self.end_step(&mut report)?;
        Ok(report)
    }

    /// Data of the current step for the laws.
    fn step_info(&self) -> StepInfo {
        let Scheme { h, theta } = self.options.scheme;
        StepInfo {
            dimension: S::D as u32,
            time: self.state.time,
            h,
            theta,
            correction: self.options.correction,
        }
    }

    /// Gives bodies of finite elements the free strain of their temperatures, applies the schedule, starts imposed motion, and has processes apply their
    /// forces.
    fn begin_step(&mut self) -> Result<(), StepError> {
        self.begin_records();
        self.state.auto_state.begin_step();
        self.strain_systems();
        let driven = self.state.bodies.motion_of_driven();
        self.begin_motion();
        self.watch_first_move(&driven);
        self.workspace.pushed = false;
        self.act(|process, simulation| process.before_detection(simulation))?;
        self.watch_push();
        Ok(())
    }

    /// Begins the records that the network keeps of a single step.
    fn begin_records(&mut self) {
        let network = &mut self.state.network;
        network.bond_breaks.clear();
        network.bonds_formed.clear();
        if self.options.record_dissipation || self.heat.is_some() {
            network.dissipation.get_or_insert_default();
        }
        if !self.state.scars.is_empty() {
            network.losses.get_or_insert_default();
        }
    }

    /// Moves the bodies to q_m and finds the contacts there; gives the motion at the start of the step and the velocities
    /// without contacts at its end.
    fn detect_contacts(
        &mut self,
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(StepStart<S>, Motions<S>), StepError> {
        let StepInfo { time, h, theta, .. } = *info;
        let mut start = StepStart::new(&self.state.bodies);
        self.workspace.spring_energy = self.spring_energy();
        let clock = Instant::now();
        let parallel = self.options.solver.parallel;
        motion::advance(&mut self.state.bodies, (1.0 - theta) * h, parallel);
        self.begin_systems((1.0 - theta) * h);
        let (network, bodies) = (&mut self.state.network, &self.state.bodies);
        detect(
            network,
            &self.shapes,
            bodies,
            &self.table,
            [time, h],
            parallel,
        );
        self.reach_mean_places(true);
        report.projected = self.project();
        start.take_rotated_spins(&self.state.bodies);
        self.state.started = start.of_driven(&self.state.bodies);
        let (bodies, gravity) = (&self.state.bodies, &self.state.gravity);
        let mut free = motion::free_velocities(bodies, gravity, time, h, theta, parallel);
        self.free_systems(&mut free);
        self.add_predicted_contacts(&free);
        self.reach_mean_places(false);
        self.begin_expansion();
        self.initialise_contacts(info)?;
        report.timing.detect = clock.elapsed();
        Ok((start, free))
    }

    /// Gives contacts their temperatures and new ones their memory, and forms the bonds that are due.
    pub(super) fn initialise_contacts(&mut self, info: &StepInfo) -> Result<(), StepError> {
        self.gather_temperatures();
        let remembered = self.workspace.evaluator.initialise_contacts(
            &self.laws,
            &mut self.state.law_history,
            &mut self.state.network,
            info,
        );
        remembered.map_err(|e| self.law_error(e))
    }

    /// Has laws update damage, bonds and wear with the impulses of the step.
    fn commit_laws(&mut self, info: &StepInfo, report: &mut StepReport) -> Result<(), StepError> {
        let clock = Instant::now();
        let committed = self.workspace.evaluator.commit(
            &self.laws,
            &mut self.state.law_history,
            &mut self.state.network,
            &self.workspace.solved.step(info),
        );
        report.totals = committed.map_err(|e| self.law_error(e))?;
        self.act(|process, simulation| process.after_solve(simulation))?;
        self.state.network.locate_breaks(&self.state.bodies);
        report.timing.laws += clock.elapsed();
        Ok(())
    }

    /// Moves the bodies from q_m to the end of the step.
    fn move_to_end(&mut self) {
        let Scheme { h, theta } = self.options.scheme;
        let parallel = self.options.solver.parallel;
        motion::advance(&mut self.state.bodies, theta * h, parallel);
        self.carry_systems();
        self.end_expansion();
        self.end_motion();
    }

    /// Counts the step, checks its result, and has phases and processes follow it.
    fn end_step(&mut self, report: &mut StepReport) -> Result<(), StepError> {
        let steps = &self.workspace.solved.contact_steps;
        let acts = |k: usize| steps[k].solution.impulse != S::Vector::zero();
        let parallel = self.options.solver.parallel;
        report.active = count(parallel, steps.len(), ACTS, acts);
        let beyond = self.workspace.evaluator.beyond();
        report.contacts = steps.len() - beyond.filter(|k| !acts(*k)).count();
        debug_assert_eq!(
            report.contacts,
            self.state.network.contact_count(false),
            "contacts of the step"
        );
        self.state.steps += 1;
        self.finite()?;
        self.watch_rounding();
        self.end_phase();
        self.act(|process, simulation| process.after_move(simulation, report))?;
        self.state.settled = false;
        Ok(())
    }

    /// Ends the step of dynamical systems and books the step in the energy ledger.
    fn book(&mut self, start: &StepStart<S>, report: &mut StepReport) {
        let received = self.received();
        self.watch_imposed(&received, report);
        let totals = &report.totals;
        let Scheme { h, theta } = self.options.scheme;
        let mut work = start.work(
            &self.state.bodies,
            &received,
            &self.state.gravity,
            self.state.time,
            [h, theta],
            self.options.solver.parallel,
        );
        if self.state.steps == 0 {
            let springs = self.workspace.springs.iter().flatten();
            self.workspace.spring_energy = springs.map(SpringForm::initial_energy).sum();
            work.external += self.workspace.spring_energy;
        }
        let springs = self.spring_energy();
        work.scheme += totals.springs - (springs - self.workspace.spring_energy);
        work.expansion += self.workspace.expanding.work;
        let (moving, stored) = self.end_systems(theta * h, &mut work);
        let (mut kinetic, mut elastic) = (
            self.state
                .bodies
                .sum_kinetic_energy(self.options.solver.parallel),
            self.state.network.bond_energy() + springs,
        );
        if !self.state.systems.is_empty() {
            (kinetic, elastic) = (kinetic + moving, elastic + stored);
        }
        self.state.energy.book(totals, &work, kinetic, elastic);
        self.state.received = received;
    }

    /// Records bodies that are stopped by the edges of neighbours that were flush.
    fn watch_edges(&mut self) {
        let tolerance = self.solver_in_force().tolerance;
        let (solved, bodies) = (&self.workspace.solved, &self.state.bodies);
        record_edges(
            &mut self.state.network,
            &self.shapes,
            bodies,
            [self.state.time, self.options.scheme.h],
            tolerance,
            |k, contact| {
                let compliant = solved.springs.get(k).is_some_and(Option::is_some);
                (!compliant).then(|| Impact {
                    before: solved.contact_steps[k].before,
                    mass: effective_mass(bodies, contact),
                })
            },
        );
    }

    /// Energy in the springs of compliant contacts (J).
    fn spring_energy(&self) -> f64 {
        if self.laws.iter().any(Interface::compliant) {
            let parallel = self.options.solver.parallel;
            self.state.network.sum_spring_energy(parallel)
        } else {
            0.0
        }
    }

    /// Impulses and moments that contacts gave to the driven bodies, in their order (N s, N m s).
    fn received(&self) -> Motions<S> {
        let (driven, contacts) = (&self.state.bodies.driven, &self.state.network.contacts);
        let mut place = vec![u32::MAX; self.state.bodies.len()];
        for (driven, d) in driven.iter().zip(0..) {
            place[driven.body as usize] = d;
        }
        let divide = pays(self.options.solver.parallel, contacts.len(), RECEIVED);
        let parts = map_chunks(divide, contacts, CHUNK, |_, contacts| {
            let mut received = Vec::new();
            for contact in contacts {
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    let d = place[contact.bodies[side] as usize];
                    if d != u32::MAX {
                        let impulse = contact.impulse * sign;
                        let moment =
                            S::moment(&contact.levers()[side], &impulse) + contact.moment * sign;
                        received.push((d, impulse, moment));
                    }
                }
            }
            received
        });
        let mut received = vec![(S::Vector::zero(), S::Spin::zero()); driven.len()];
        for (d, impulse, moment) in parts.into_iter().flatten() {
            let all = &mut received[d as usize];
            all.0 += impulse;
            all.1 += moment;
        }
        received
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::network::{Contact, ContactGeometry, Key};
    use crate::geometry::space::Dim2;
    use nalgebra::{Vector1, Vector2};

    /// A driven candidate receives impulse and moment of its contact, a driven antagonist the opposite: r x p + M about its own centre. About a
    /// common point both cancel.
    #[test]
    fn driven_bodies_receive_the_moments_of_their_contacts() {
        let centres = [[0.0, 2.0], [1.0, -1.0]];
        let mut s = Simulation::of_disks(&centres.map(|at| (at, 0.5)));
        s.drive(1, Default::default());
        s.drive(0, Default::default());
        let place = Vector2::new(0.5, 0.25);
        let centres = centres.map(Vector2::from);
        let arms = centres.map(|c| place - c);
        let geometry = ContactGeometry {
            gap: 0.0,
            normal: Vector2::new(0.0, 1.0),
            arms,
            radius: 0.25,
        };
        let key = Key {
            candidate: 0,
            antagonist: 1,
            feature: 0,
        };
        let mut contact = Contact::<Dim2>::new(key, [0, 1], 0, geometry, 0.0);
        contact.impulse = Vector2::new(3.0, 5.0);
        contact.moment = Vector1::new(7.0);
        s.state.network.contacts = vec![contact.clone(), contact.clone()];
        let cross = |a: Vector2<f64>, b: Vector2<f64>| a.x * b.y - a.y * b.x;
        let [antagonist, candidate] = s.received()[..] else {
            panic!("two driven bodies")
        };
        let p = contact.impulse;
        assert_eq!((candidate.0, antagonist.0), (2.0 * p, -2.0 * p));
        assert_eq!(candidate.1.x, 2.0 * (cross(arms[0], p) + 7.0));
        assert_eq!(antagonist.1.x, -2.0 * (cross(arms[1], p) + 7.0));
        let of = |(p, m): (Vector2<f64>, Vector1<f64>), at| cross(at, p) + m.x;
        assert_eq!(of(candidate, centres[0]) + of(antagonist, centres[1]), 0.0);
    }
}
