//! Sums for the error of a step's problem, at the current velocities.

use super::error::{Norm, Scale, Sums};
use super::kinds::of_kind;
use super::problem::Problem;
use super::rocking;
use super::row::SolverBodies;
use crate::geometry::space::Space;
use crate::threads::{for_chunks, map_ranges, worth_dividing};

/// Number of bodies per task. Sums are formed per chunk and added in order.
const CHUNK: usize = 2048;
/// Approximate time to compute the work of a body (ns).
const WORK: f64 = 5.0;

/// Sums over the contacts; the worst contact is searched among the rows in the order of the
/// iteration.
pub(super) fn measure<S: Space>(problem: &mut Problem<S>, parallel: bool) -> Sums {
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    let (mut sums, mut first) = (Sums::default(), 0);
    for rows in &mut problem.rows {
        of_kind!(rows, rows => {
            rows.measure(&solver_bodies, first, parallel, &mut sums);
            first += rows.len();
        });
    }
    if !problem.of_systems.is_empty() {
        measure_systems(problem, first, &mut sums);
    }
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    for row in &problem.moments {
        let (i, j) = solver_bodies.read(row.bodies);
        let pn = problem.normal(row.place);
        sums.add_moment(&row.residual(pn, &i, &j, &problem.systems));
    }
    sums
}

/// Adds the contacts with systems, which are counted from `first`.
fn measure_systems<S: Space>(problem: &mut Problem<S>, first: usize, sums: &mut Sums) {
    let mut tractions = std::mem::take(&mut problem.tractions);
    tractions.begin(&problem.of_systems, &problem.systems, problem.masses.len());
    for (k, row) in problem.of_systems.iter().enumerate() {
        let residual = row.residual(&problem.solver_bodies, &problem.systems);
        sums.add(&residual, first + k);
        tractions.add(row, &residual);
    }
    sums.traction = tractions.worst(&problem.of_systems);
    problem.tractions = tractions;
}

/// Unbalanced share of the work of the step below which the squared share is negligible for any
/// tolerance.
const BALANCED: f64 = 1e-6;
/// Number of contacts up to which powers of either sign matter, see [`super::error`].
const MAX_CONTACTS_WITH_SIGNS: usize = 500;

/// Computes the reference values of the error from its sums.
pub(super) fn scale<S: Space>(
    problem: &mut Problem<S>,
    free: Scale,
    sums: &Sums,
    parallel: bool,
) -> Scale {
    let count = problem.solver_bodies.len();
    let parts = map_ranges(
        worth_dividing(parallel, count, WORK),
        count,
        CHUNK,
        |bodies| {
            let of = |b: usize| {
                let (body, (v, w)) = (&problem.solver_bodies[b], &problem.free[b]);
                let spin = body.s * (1.0 / problem.lengths[b]);
                problem.masses[b].energy(&(body.v - *v), &(spin - *w))
            };
            bodies.map(of).sum::<f64>()
        },
    );
    let mut work: f64 = parts.iter().sum();
    if !problem.systems.is_empty() {
        work += problem.work_on_systems();
    }
    // Compliance of contacts is small compared with the motion of bodies, except where bodies hold
    // each other: only then is this pass needed.
    let few = problem.contacts() <= MAX_CONTACTS_WITH_SIGNS;
    let unbalanced = if few {
        sums.unbalanced
    } else {
        sums.power.abs()
    };
    if problem.compliant && unbalanced > BALANCED * work.max(free.energy) {
        work += work_on_compliance(problem, parallel);
    }
    Scale {
        work,
        noise: free.noise + sums.rounding(free.free),
        contacts: problem.contacts(),
        ..free
    }
}

/// Returns the error in a norm; where the sums over all contacts are within the tolerance, also
/// that of each connected set.
pub(super) fn error<S: Space>(
    problem: &mut Problem<S>,
    (norm, tolerance): (Norm, f64),
    sums: &Sums,
    scale: &Scale,
) -> f64 {
    let error = sums.error(norm, scale);
    if norm != Norm::Balance || error > tolerance || sums.residual <= scale.noise {
        return error;
    }
    error.max(rocking::worst(problem, sums, scale))
}

/// The work on the compliance of contacts.
fn work_on_compliance<S: Space>(problem: &mut Problem<S>, parallel: bool) -> f64 {
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    let mut work = 0.0;
    for rows in &problem.rows {
        work += of_kind!(rows, rows => rows.work_on_compliance(&solver_bodies, parallel));
    }
    let of_systems = problem.of_systems.iter();
    let of_systems =
        of_systems.map(|row| row.work_on_compliance(&problem.solver_bodies, &problem.systems));
    work + of_systems.sum::<f64>()
}

/// Computes the reference values that depend on the free velocities; leaves these velocities in the
/// body records.
pub(super) fn free_velocity<S: Space>(problem: &mut Problem<S>, parallel: bool) -> Scale {
    problem.set_free(parallel);
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    let mut out = Scale::default();
    for rows in &mut problem.rows {
        out.add(&of_kind!(rows, rows => rows.free(&solver_bodies, parallel)));
    }
    for row in &problem.of_systems {
        out.add(&row.scale(&problem.solver_bodies, &problem.systems));
    }
    out
}

impl<S: Space> Problem<S> {
    /// Sets every body to its free velocity.
    pub(super) fn set_free(&mut self, parallel: bool) {
        let divide = worth_dividing(parallel, self.solver_bodies.len(), WORK);
        let (free, lengths) = (&self.free, &self.lengths);
        for_chunks(divide, &mut self.solver_bodies, CHUNK, |first, bodies| {
            for (body, b) in bodies.iter_mut().zip(first..) {
                body.v = free[b].0;
                body.s = free[b].1 * lengths[b];
            }
        });
        self.free_systems();
    }
}
