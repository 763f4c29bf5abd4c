//! Non-linear Gauss-Seidel (NLGS): contact by contact, with velocities updated in place and warm
//! start.

use super::accelerate::Acceleration;
use super::chosen::SolvePath;
use super::error::{ErrorParts, Norm};
use super::form::RowPlace;

use super::kinds::{RowsOfKind, of_kind};
use super::local::solver::Method;
use super::measure::{error, free_velocity, measure, scale};
use super::momentum::MomentumIteration;
use super::nodal::NodalSystem;
use super::problem::Problem;
use super::row::{self, SolverBodies};
use crate::geometry::space::Space;

/// Solver options.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// Error to reach.
    pub tolerance: f64,
    /// Norm of the error, see [`super::error`].
    pub norm: Norm,
    /// Maximum number of iterations.
    pub max_iterations: u32,
    /// Iterations between two convergence tests; the first test comes after half as many.
    pub test_every: u32,
    /// Over-relaxation factor in \[1, 2) applied to the impulse increment of each contact.
    pub relaxation: f64,
    /// Whether momentum and Anderson acceleration are used.
    pub accelerated: bool,
    /// Solution method.
    pub method: Method,
    /// Whether the colours of an iteration, and the pairs of detection, are distributed over
    /// threads; the results are the same.
    pub parallel: bool,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-4,
            norm: Norm::Balance,
            max_iterations: 10_000,
            test_every: 10,
            relaxation: 1.45,
            accelerated: true,
            method: Method::Auto,
            parallel: false,
        }
    }
}

/// Report of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Iterations done.
    pub iterations: u32,
    /// Error, recomputed from the impulses at the end.
    pub error: f64,
    /// Parts of the error.
    pub parts: ErrorParts,
    /// Whether the error is within the tolerance.
    pub converged: bool,
    /// Whether the impulses grew until the velocities were lost in their rounding, see
    /// [`Sums::lost_in_rounding`]: the problem has no solution.
    pub unbounded: bool,
    /// Whether another solution with more energy was found, in which a loaded contact slides that
    /// sticks in the accepted one, or the reverse: the step has several solutions.
    pub several: bool,
    /// Whether a loaded contact began to slide in a set of contacts that was too large for a search
    /// for another solution, see [`Problem::is_not_searched`].
    pub not_searched: bool,
    /// Whether that contact is of a body squeezed by bodies with imposed or controlled motion.
    pub pinched: bool,
    /// Index, as pushed, of the contact with the largest residual; `None` without contacts.
    pub worst: Option<usize>,
    /// The method that ended the solve.
    pub used: Method,
    /// The choices of `auto`.
    pub chosen: SolvePath,
}

/// Sorts the rows, computes velocities from the current impulses, and evaluates the error.
pub(super) fn arrange<S: Space>(problem: &mut Problem<S>, options: &SolverOptions) -> Report {
    if problem.contacts() == 0 {
        return Report {
            converged: true,
            ..Report::default()
        };
    }
    sort(problem);
    problem.solve_held();
    check_convergence(problem, options)
}

/// Computes velocities from the current impulses and evaluates the error.
pub(super) fn check_convergence<S: Space>(
    problem: &mut Problem<S>,
    options: &SolverOptions,
) -> Report {
    let free = free_velocity(problem, options.parallel);
    problem.reload(options.parallel);
    let sums = measure(problem, options.parallel);
    let scale = scale(problem, free, &sums, options.parallel);
    let error = error(problem, (options.norm, options.tolerance), &sums, &scale);
    let converged = error <= options.tolerance;
    Report {
        error,
        parts: sums.parts(&scale),
        converged,
        unbounded: sums.lost_in_rounding(free.free, converged),
        worst: problem.pushed(sums.worst_at),
        ..Report::default()
    }
}

/// Iterates in place until the problem is solved or the iteration limit is reached.
pub fn solve<S: Space>(problem: &mut Problem<S>, options: &SolverOptions) -> Report {
    if problem.contacts() == 0 {
        return Report {
            converged: true,
            ..Report::default()
        };
    }
    sort(problem);
    let free = free_velocity(problem, options.parallel);
    problem.reload(options.parallel);
    let every = options.test_every.max(1);
    let mut report = Report::default();
    let mut acceleration = options
        .accelerated
        .then(|| Acceleration::new(problem, every, options.parallel));
    let (mut relaxation, mut caution) = (options.relaxation, RelaxationControl::default());
    let large = problem.systems.iter().any(NodalSystem::is_large);
    // A warm start needs few iterations, so that the first test comes early.
    let mut next = every.div_ceil(2);
    loop {
        let last = next.min(options.max_iterations);
        while report.iterations < last {
            let momentum = acceleration.as_mut();
            let momentum = momentum.and_then(|a| a.momentum(problem, report.iterations));
            // The iteration before a test is not relaxed, so that its impulses are admissible; an
            // iteration with momentum is not relaxed either.
            let plain = report.iterations + 1 == last || momentum.is_some();
            let relaxation = if plain { 1.0 } else { relaxation };
            sweep(problem, relaxation, options.parallel, momentum);
            report.iterations += 1;
        }
        let ended = report.iterations >= options.max_iterations;
        // The velocities have accumulated rounding errors, so that convergence is decided with
        // velocities recomputed from the impulses. The first tests, which often succeed, recompute
        // them at once. So do all tests with large systems, where the velocities of all nodes cost
        // the same in either case, and the pass over the other contacts little in comparison.
        let fresh = report.iterations <= every || large;
        if fresh {
            problem.reload(options.parallel);
        } else {
            problem.settle_systems();
        }
        let mut sums = measure(problem, options.parallel);
        let scale_now = scale(problem, free, &sums, options.parallel);
        if ended || sums.error(options.norm, &scale_now) <= options.tolerance {
            if !fresh {
                problem.reload(options.parallel);
                if let Some(acceleration) = &mut acceleration {
                    acceleration.reloaded(problem);
                }
                sums = measure(problem, options.parallel);
            }
            let scale = scale(problem, free, &sums, options.parallel);
            let limit = (options.norm, options.tolerance);
            report.error = error(problem, limit, &sums, &scale);
            report.parts = sums.parts(&scale);
            report.converged = report.error <= options.tolerance;
            report.unbounded = sums.lost_in_rounding(free.free, report.converged);
            if ended || report.converged {
                report.worst = problem.pushed(sums.worst_at);
                return report;
            }
        }
        let early = next < every;
        next = if early {
            every
        } else {
            next.saturating_add(every)
        };
        if early {
            continue;
        }
        if acceleration.as_ref().is_none_or(Acceleration::relaxes) {
            let cautious = caution.next_relaxation(sums.residual, relaxation);
            if let Some(acceleration) = &mut acceleration
                && cautious != relaxation
            {
                acceleration.forget();
            }
            relaxation = cautious;
        }
        if let Some(acceleration) = &mut acceleration {
            acceleration.on_failed_test(problem, report.iterations, sums.residual);
        }
    }
}

/// Sorts the contacts and computes velocities from their impulses, as needed before [`sweeps`].
pub fn prepare<S: Space>(problem: &mut Problem<S>) {
    sort(problem);
    problem.reload(false);
}

/// Runs iterations without convergence tests, for benchmarks. The problem must have been
/// [`prepare`]d.
pub fn sweeps<S: Space>(problem: &mut Problem<S>, count: u32, relaxation: f64, parallel: bool) {
    for _ in 0..count {
        sweep(problem, relaxation, parallel, None);
    }
    problem.settle_systems();
}

impl Report {
    /// Adds another solve of the same step: iterations are summed, findings of several solutions
    /// are kept, and the rest is taken from the last solve.
    pub fn add(&mut self, other: &Self) {
        *self = Self {
            iterations: self.iterations + other.iterations,
            chosen: self.chosen.or(other.chosen),
            several: self.several || other.several,
            not_searched: self.not_searched || other.not_searched,
            pinched: self.pinched || other.pinched,
            ..*other
        };
    }
}

/// Controls the relaxation. Over-relaxation has no convergence proof with friction; where the
/// residual grows or cycles, it is reduced.
struct RelaxationControl {
    least: f64,
    tests: u32,
}

impl Default for RelaxationControl {
    fn default() -> Self {
        Self {
            least: f64::INFINITY,
            tests: 0,
        }
    }
}

impl RelaxationControl {
    /// Growth of the squared residual that triggers a reduction.
    const GROWTH: f64 = 4.0;
    /// Number of tests without a reduction of the squared residual by a hundredth that triggers a
    /// reduction.
    const PATIENCE: u32 = 20;

    /// Returns the relaxation to continue with, given the squared residual at a test.
    fn next_relaxation(&mut self, residual: f64, relaxation: f64) -> f64 {
        if residual < 0.99 * self.least {
            (self.least, self.tests) = (residual, 0);
            return relaxation;
        }
        self.tests += 1;
        if residual <= Self::GROWTH * self.least && self.tests < Self::PATIENCE {
            return relaxation;
        }
        (self.least, self.tests) = (residual, 0);
        let less = 1.0 + 0.5 * (relaxation - 1.0);
        if less > 1.05 { less } else { 1.0 }
    }
}

impl<S: Space> Problem<S> {
    /// Stores the components of all impulses and moments, in the order of the iteration.
    pub(super) fn store(&self, out: &mut Vec<f64>) {
        out.clear();
        for rows in &self.rows {
            of_kind!(rows, rows => rows.store(out));
        }
        let of_systems = self.of_systems.iter();
        of_systems.for_each(|row| row::store(row.impulse(), out));
        self.moments.iter().for_each(|row| row.store(out));
    }

    /// Restores the components, and recomputes the velocities.
    pub(super) fn restore(&mut self, mut from: &[f64]) {
        let from = &mut from;
        for rows in &mut self.rows {
            of_kind!(rows, rows => rows.restore(from));
        }
        let of_systems = self.of_systems.iter_mut();
        of_systems.for_each(|row| row.set_impulse(row::restore(from)));
        self.moments.iter_mut().for_each(|row| row.restore(from));
        self.reload(false);
    }

    /// Sets impulses and moments in the order pushed, and recomputes the velocities. A contact
    /// without an impulse (`None`, where both bodies are immovable) is solved for the current
    /// velocities.
    pub(super) fn adopt(&mut self, impulses: &[Option<S::Vector>], moments: &[Option<S::Spin>]) {
        for (k, impulse) in impulses.iter().enumerate() {
            match impulse {
                Some(impulse) => self.set(self.places[k], impulse),
                None => self.solve_at_rest(self.places[k]),
            }
        }
        for (k, moment) in moments.iter().enumerate() {
            match moment {
                Some(moment) => self.moments[k].set(moment),
                None => self.solve_moment(k),
            }
        }
        self.reload(false);
    }

    /// Sets the impulses and moments of some contacts, and recomputes the velocities.
    pub(super) fn adopt_some(&mut self, impulses: &[(u32, S::Vector)], moments: &[(u32, S::Spin)]) {
        for (k, impulse) in impulses {
            self.set(self.places[*k as usize], impulse);
        }
        for (k, moment) in moments {
            self.moments[*k as usize].set(moment);
        }
        self.reload(false);
    }

    /// Sets the impulse of a contact; the caller updates the velocities.
    fn set(&mut self, place: RowPlace, impulse: &S::Vector) {
        match place {
            RowPlace::Row { kind, row } => {
                of_kind!(&mut self.rows[kind as usize], rows => rows.row_mut(row).set(impulse));
            }
            RowPlace::System(r) => self.of_systems[r as usize].set(impulse),
        }
    }

    /// Solves a contact between immovable bodies for the current velocities.
    fn solve_at_rest(&mut self, place: RowPlace) {
        let bodies = &mut self.solver_bodies;
        match place {
            RowPlace::Row { kind, row } => {
                of_kind!(&mut self.rows[kind as usize], rows => rows.solve_at(row, bodies));
            }
            RowPlace::System(r) => {
                self.of_systems[r as usize].update(bodies, &mut self.systems, 1.0);
            }
        }
    }

    /// Returns rho of the natural map; 0 for a contact that moves nothing.
    fn rho(&self, place: RowPlace) -> f64 {
        match place {
            RowPlace::Row { kind, row } => {
                of_kind!(&self.rows[kind as usize], rows => rows.row(row).rho())
            }
            RowPlace::System(r) => self.of_systems[r as usize].rho(),
        }
    }

    /// Solves the contacts and moments that move nothing: their impulses follow from given
    /// velocities, and methods that check the start first would leave them at their initial values.
    fn solve_held(&mut self) {
        for k in 0..self.places.len() {
            if self.rho(self.places[k]) == 0.0 {
                self.solve_at_rest(self.places[k]);
            }
        }
        for k in 0..self.moments.len() {
            if !self.moments[k].turns() {
                self.solve_moment(k);
            }
        }
    }

    /// Solves a moment for the current velocities, which it does not change.
    fn solve_moment(&mut self, k: usize) {
        let pn = self.normal(self.moments[k].place);
        let row = &mut self.moments[k];
        let [i, j] = row.bodies.map(|b| b as usize);
        let (mut a, mut b) = (self.solver_bodies[i], self.solver_bodies[j]);
        row.update(pn, &mut a, &mut b, &mut self.systems, 1.0);
    }

    /// Computes v = v_free + M^-1 H p.
    pub(super) fn reload(&mut self, parallel: bool) {
        self.set_free(parallel);
        let solver_bodies = SolverBodies::new(&mut self.solver_bodies);
        for rows in &mut self.rows {
            of_kind!(rows, rows => rows.load(&solver_bodies, parallel));
        }
        for row in &self.of_systems {
            row.load(&mut self.solver_bodies, &mut self.systems);
        }
        let solver_bodies = SolverBodies::new(&mut self.solver_bodies);
        let systems = &mut self.systems;
        for row in &self.moments {
            solver_bodies.alone(row.bodies, |a, b| row.load(a, b, systems));
        }
        self.settle_systems();
    }

    /// Returns the index, as pushed, of the contact at a position in the iteration.
    fn pushed(&self, at: usize) -> Option<usize> {
        let (mut place, mut first) = (None, 0);
        for (kind, rows) in self.rows.iter().enumerate() {
            let count = of_kind!(rows, rows => rows.len());
            if place.is_none() && at < first + count {
                let (kind, row) = (kind as u8, (at - first) as u32);
                place = Some(RowPlace::Row { kind, row });
            }
            first += count;
        }
        let place = place.unwrap_or_else(|| RowPlace::System((at - first) as u32));
        self.places.iter().position(|p| *p == place)
    }
}

/// Sorts the rows of each kind by colour, where they were not pushed in that order.
fn sort<S: Space>(problem: &mut Problem<S>) {
    let sorted = |rows: &RowsOfKind<S>| of_kind!(rows, rows => rows.sorted());
    if !problem.rows.iter().all(sorted) {
        let movable = problem.movable(false);
        for rows in &mut problem.rows {
            of_kind!(rows, rows => rows.sort(&movable));
        }
        problem.place_in_order(false);
    }
    for row in &mut problem.moments {
        row.place = problem.places[row.form.contact as usize];
    }
}

/// Solves every contact once; with momentum from extrapolated impulses and velocities.
fn sweep<S: Space>(
    problem: &mut Problem<S>,
    relaxation: f64,
    parallel: bool,
    momentum: Option<&mut MomentumIteration<S>>,
) {
    match momentum {
        None => {
            let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
            for rows in &mut problem.rows {
                of_kind!(rows, rows => rows.sweep(&solver_bodies, relaxation, parallel));
            }
        }
        Some(momentum) => sweep_extrapolated(problem, relaxation, parallel, momentum),
    }
    for row in &mut problem.of_systems {
        row.update(&mut problem.solver_bodies, &mut problem.systems, relaxation);
    }
    for k in 0..problem.moments.len() {
        let pn = problem.normal(problem.moments[k].place);
        let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
        let (row, systems) = (&mut problem.moments[k], &mut problem.systems);
        solver_bodies.alone(row.bodies, |a, b| row.update(pn, a, b, systems, relaxation));
    }
}

fn sweep_extrapolated<S: Space>(
    problem: &mut Problem<S>,
    relaxation: f64,
    parallel: bool,
    momentum: &mut MomentumIteration<S>,
) {
    let factor = momentum.advance(&mut problem.solver_bodies, parallel);
    for (row, before) in problem.moments.iter_mut().zip(&mut momentum.moments) {
        let now = row.moment();
        row.set(&(now + (now - *before) * factor));
        *before = now;
    }
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    for (rows, before) in problem.rows.iter_mut().zip(&mut momentum.impulses) {
        let from = (&mut before[..], factor);
        of_kind!(rows, rows => rows.sweep_extrapolated(&solver_bodies, relaxation, parallel, from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::form::ContactForm;
    use nalgebra::Vector2;

    /// The excess of the relaxation over 1 is halved where the residual grows to more than four
    /// times the smallest one, or does not fall by a hundredth in twenty tests, and set to zero
    /// below 0.05.
    #[test]
    fn caution_reduces_the_relaxation() {
        let mut caution = RelaxationControl::default();
        for residual in [1.0, 0.5, 1.9, 0.4] {
            assert_eq!(caution.next_relaxation(residual, 1.5), 1.5);
        }
        assert_eq!(caution.next_relaxation(1.7, 1.5), 1.25);
        assert_eq!(caution.next_relaxation(6.7, 1.25), 1.25);
        for _ in 0..18 {
            assert_eq!(caution.next_relaxation(1.69, 1.25), 1.25);
        }
        assert_eq!(caution.next_relaxation(1.69, 1.25), 1.125);
        assert_eq!(caution.next_relaxation(10.0, 1.09), 1.0);
    }

    /// A contact with a bond is pushed first, then a plain one, which comes first in an iteration.
    #[test]
    fn contacts_are_found_as_they_were_pushed() {
        let mut problem = Problem::of_unit_bodies(3);
        let normal = Vector2::new(0.0, 1.0);
        let plain = ContactForm {
            normal,
            arms: [-normal, normal],
            friction: 0.5,
            ..ContactForm::default()
        };
        let bonded = ContactForm {
            bodies: [1, 2],
            elastic: Some(crate::solve::form::Elastic::none()),
            ..plain
        };
        problem.push(&bonded);
        problem.push(&plain);
        let counts = problem.rows.each_ref().map(|r| of_kind!(r, r => r.len()));
        assert_eq!(counts, [1, 1, 0, 0]);
        assert_eq!((problem.pushed(0), problem.pushed(1)), (Some(1), Some(0)));
    }
}
