//! The third part of the norm [`Norm::Balance`](super::error::Norm::Balance) by connected sets:
//! errors of one set are not balanced by other sets, which it does not touch. It is computed where
//! the sums over all contacts are within the tolerance.

use super::connected::ConnectedSets;
use super::error::{Scale, Sums};
use super::kinds::of_kind;
use super::problem::Problem;
use super::row::{Moving, Row, RowKind, SolverBody, noise};
use super::rows::Rows;
use crate::geometry::space::Space;
use crate::lanes::{Batch, LaneVector};

/// Share of the sums over all contacts above which their difference from the sums of the other sets
/// is more than rounding.
const KNOWN: f64 = 1e-6;
/// Smallest share of the work of all contacts that is used as the work of a set: a grain that
/// sticks to a wall carries no load, and its small residuals are no error.
const MIN_WORK_SHARE: f64 = 1e-4;

/// Returns the error of the worst set, given the sums over all contacts; 0 where all contacts are
/// in one set.
pub(super) fn worst<S: Space>(problem: &mut Problem<S>, sums: &Sums, scale: &Scale) -> f64 {
    let sets = problem.take_connected();
    let worst = if sets.len() < 2 {
        0.0
    } else {
        of_sets(problem, &sets, sums, scale)
    };
    problem.connected = sets;
    worst
}

fn of_sets<S: Space>(
    problem: &mut Problem<S>,
    sets: &ConnectedSets,
    sums: &Sums,
    scale: &Scale,
) -> f64 {
    // In a packing nearly all contacts are in one set, whose sums follow from the total by
    // subtracting the other sets.
    let largest = (0..sets.len()).max_by_key(|k| sets.contacts(*k));
    let most = largest
        .filter(|k| problem.systems.is_empty() && 2 * sets.contacts(*k) > problem.contacts());
    let mut all = apart(problem, sets, most);
    if let Some(most) = most {
        let rest = |total: f64, of: fn(&(Sums, Scale)) -> f64| {
            let others = all.iter().map(of).sum::<f64>();
            (total - others).max(0.0)
        };
        let unbalanced = rest(sums.unbalanced, |s| s.0.unbalanced);
        let work = rest(scale.work, |s| s.1.work);
        let energy = rest(scale.energy, |s| s.1.energy);
        let residual = rest(sums.residual, |s| s.0.residual);
        let total = scale.work.max(scale.energy);
        if unbalanced <= KNOWN * sums.unbalanced {
            // The error is below that of any tolerance.
        } else if work.max(energy) > KNOWN * total {
            all[most].0.unbalanced = unbalanced;
            all[most].0.residual = residual;
            all[most].1 = Scale {
                work,
                energy,
                contacts: sets.contacts(most),
                ..*scale
            };
        } else {
            all = apart(problem, sets, None);
        }
    }
    let least = MIN_WORK_SHARE * scale.work.max(scale.energy);
    let known = (0..sets.len()).filter(|k| !sets.with_systems(*k));
    let errors = known.map(|k| {
        let (sums, scale) = &all[k];
        let noise = scale.noise + sums.rounding(scale.free);
        if sums.residual <= noise {
            return 0.0;
        }
        sums.rocking(&Scale {
            work: scale.work.max(least),
            ..*scale
        })
    });
    errors.fold(0.0, f64::max)
}

/// Returns the sums of each set but one.
fn apart<S: Space>(
    problem: &mut Problem<S>,
    sets: &ConnectedSets,
    without: Option<usize>,
) -> Vec<(Sums, Scale)> {
    let mut out = vec![(Sums::default(), Scale::default()); sets.len()];
    let read = |b: usize| {
        let mut body = problem.solver_bodies[b];
        let (v, w) = &problem.free[b];
        (body.v, body.s) = (*v, *w * problem.lengths[b]);
        body
    };
    let free = |bodies: [u32; 2]| bodies.map(|b| read(b as usize));
    let now = |bodies: [u32; 2]| bodies.map(|b| problem.solver_bodies[b as usize]);
    let of = |bodies: [u32; 2]| sets.of(bodies).filter(|set| Some(*set) != without);
    for rows in &problem.rows {
        of_kind!(rows, rows => add(rows, of, now, free, &mut out));
    }
    for row in &problem.moments {
        if let Some(set) = of(row.bodies) {
            let [a, b] = now(row.bodies);
            let pn = problem.normal(row.place);
            let residual = row.residual(pn, &a, &b, &problem.systems);
            out[set].0.add_moment(&residual);
        }
    }
    for (b, body) in problem.solver_bodies.iter().enumerate() {
        let set = sets.of_body(b as u32).filter(|set| Some(*set) != without);
        if let Some(set) = set {
            let (v, w) = &problem.free[b];
            let spin = body.s * (1.0 / problem.lengths[b]);
            out[set].1.work += problem.masses[b].energy(&(body.v - *v), &(spin - *w));
        }
    }
    out
}

/// Adds the contacts of rows to the sums of their sets.
fn add<S: Space, K: RowKind<S>>(
    rows: &Rows<S, K>,
    of: impl Fn([u32; 2]) -> Option<usize>,
    now: impl Fn([u32; 2]) -> [SolverBody<S>; 2],
    free: impl Fn([u32; 2]) -> [SolverBody<S>; 2],
    out: &mut [(Sums, Scale)],
) {
    for (row, pair) in rows.all().iter().zip(rows.pairs()) {
        let Some(set) = of(*pair) else {
            continue;
        };
        let (sums, scale) = &mut out[set];
        let [a, b] = now(*pair);
        let [i, j] = [&a, &b].map(Moving::of);
        sums.add_moment(&Row::residual(Batch::one(row), &i, &j));
        scale.work += row.work_on_compliance(&a, &b);
        let [a, b] = free(*pair);
        let [a, b] = [&a, &b].map(Moving::of);
        let [speed, rho, mu] = Row::speed(Batch::one(row), &a, &b);
        let own = a.v.dot(&a.v) + a.s.dot(&a.s) + b.v.dot(&b.v) + b.s.dot(&b.s);
        scale.free += speed;
        scale.energy += rho * speed;
        scale.noise += noise(own, mu);
        scale.contacts += 1;
    }
}
