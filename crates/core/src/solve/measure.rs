//! Sums for the error of a step's problem, at the current velocities.

use super::error::{Scale, Sums};
use super::form::Problem;
use super::row::{Free, Measure, Row, SolverBodies, visit};
use crate::geometry::space::Space;
use rayon::prelude::*;

/// Contacts per task. Sums are formed per chunk and added in order.
const CHUNK: usize = 512;

/// Sums over the contacts; the worst contact is searched among the rows in the order of the iteration.
pub(super) fn measure<S: Space>(problem: &mut Problem<S>, parallel: bool) -> Sums {
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    let mut sums = Sums::default();
    let (a, b) = (problem.plain.len(), problem.full.len());
    measure_rows(&mut problem.plain, &solver_bodies, 0, parallel, &mut sums);
    measure_rows(&mut problem.full, &solver_bodies, a, parallel, &mut sums);
    measure_rows(
        &mut problem.general,
        &solver_bodies,
        a + b,
        parallel,
        &mut sums,
    );
    let first = a + b + problem.general.len();
    for (k, row) in problem.of_systems.iter().enumerate() {
        sums.add(
            &row.residual(&problem.solver_bodies, &problem.systems),
            first + k,
        );
    }
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    for row in &problem.moments {
        let (i, j) = solver_bodies.read(row.bodies);
        let pn = problem.normal(row.place);
        sums.add_moment(&row.residual(pn, &i, &j, &problem.systems));
    }
    sums
}

fn measure_rows<S: Space, R: Row<S>>(
    rows: &mut [R],
    solver_bodies: &SolverBodies<S>,
    offset: usize,
    parallel: bool,
    sums: &mut Sums,
) {
    let chunk = |(c, rows): (usize, &mut [R])| {
        let mut part = Measure::default();
        visit(rows, &[0, rows.len() as u32], solver_bodies, &mut part);
        part.sums(offset + c * CHUNK)
    };
    if parallel {
        let parts = rows.par_chunks_mut(CHUNK).enumerate().map(chunk);
        let parts: Vec<Sums> = parts.collect();
        parts.iter().for_each(|part| sums.merge(part));
    } else {
        let parts = rows.chunks_mut(CHUNK).enumerate().map(chunk);
        parts.for_each(|part| sums.merge(&part));
    }
}

/// Computes the reference values of the error.
pub(super) fn scale<S: Space>(problem: &Problem<S>, free: Scale) -> Scale {
    let mut work = 0.0;
    let bodies = problem
        .solver_bodies
        .iter()
        .zip(&problem.free)
        .zip(problem.masses.iter().zip(&problem.lengths));
    for ((body, (v, w)), (mobility, length)) in bodies {
        work += mobility.energy(&(body.v - *v), &(body.s * (1.0 / length) - *w));
    }
    if !problem.systems.is_empty() {
        work += problem.work_on_systems();
    }
    Scale { work, ..free }
}

/// Computes the reference values that depend on the free velocities; leaves these in the body records.
pub(super) fn free_velocity<S: Space>(problem: &mut Problem<S>) -> Scale {
    problem.set_free();
    let solver_bodies = SolverBodies::new(&mut problem.solver_bodies);
    let mut free = [Free::default(), Free::default(), Free::default()];
    squared(&mut problem.plain, &solver_bodies, &mut free[0]);
    squared(&mut problem.full, &solver_bodies, &mut free[1]);
    squared(&mut problem.general, &solver_bodies, &mut free[2]);
    let mut out = Scale::default();
    for part in free.map(|f| f.scale()) {
        out.free += part.free;
        out.energy += part.energy;
        out.noise += part.noise;
    }
    for row in &problem.of_systems {
        let part = row.scale(&problem.solver_bodies, &problem.systems);
        out.free += part.free;
        out.energy += part.energy;
        out.noise += part.noise;
    }
    out
}

fn squared<S: Space, R: Row<S>>(rows: &mut [R], solver_bodies: &SolverBodies<S>, free: &mut Free) {
    visit(rows, &[0, rows.len() as u32], solver_bodies, free);
}

impl<S: Space> Problem<S> {
    /// Sets every body to its free velocity.
    pub(super) fn set_free(&mut self) {
        let bodies = self
            .solver_bodies
            .iter_mut()
            .zip(&self.free)
            .zip(&self.lengths);
        for ((body, free), length) in bodies {
            body.v = free.0;
            body.s = free.1 * *length;
        }
        self.free_systems();
    }
}
