//! Projection of positions: penetrations are removed by displacing bodies, without changing
//! velocities.
//!
//! The smallest displacement that leaves no penetration, min 1/2 |dq|_M^2 with g + n . (relative
//! dq) >= 0, is the frictionless contact problem of bodies at rest over a unit of time, and is
//! solved by the same solver. An intact bond keeps its two sides together (u = 0). Moreau,
//! "Numerical aspects of the sweeping process", Comput. Methods Appl. Mech. Eng. 177 (1999),
//! projects in every step; here a step is projected only when a penetration exceeds a bound.
//!
//! Velocities do not change, so that kinetic energy is kept; bond openings do not change, so that
//! elastic energy is kept. Work against gravity and imposed forces is added to the ledger as work
//! of the correction.
//!
//! Dynamical systems do not take part: a scene with one is refused.

use crate::bodies::Bodies;
use crate::contact::detect::{CollisionScene, detect};
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::Interface;
use crate::solve::error::Norm;
use crate::solve::{ContactForm, Problem, SolverOptions, nlgs};
use crate::step::{ProjectionReport, Scheme, Simulation, StepError};
use crate::threads::largest;

/// Displacement of a body's centre (m) and its rotation (rad).
type Move<S> = (<S as Space>::Vector, <S as Space>::Spin);

/// Relative tolerance of the displacements. The next projection removes the remainder.
const TOLERANCE: f64 = 1e-3;
/// Iteration limit: no solution exists where bodies have no room to move apart.
const MAX_SWEEPS: u32 = 5000;
/// Approximate time to compute the depth of a contact (ns).
const DEPTH: f64 = 3.0;

/// Refuses projection in a scene with dynamical systems, which projection does not move.
///
/// # Errors
/// Projection is requested and there are systems.
pub(in crate::step) fn check_bodies<S: Space>(s: &Simulation<S>) -> Result<(), StepError> {
    match s.state.systems.get(0) {
        Some(system) if s.options.projection > 0.0 => Err(StepError::SystemProjection {
            step: s.state.steps + 1,
            system: system.name().to_owned(),
        }),
        _ => Ok(()),
    }
}

/// Removes penetrations if one exceeds the bound, repeats detection, and adds the work to the
/// ledger.
pub(in crate::step) fn project<S: Space>(s: &mut Simulation<S>) -> Option<ProjectionReport> {
    if s.options.projection <= 0.0 {
        return None;
    }
    let before = deepest_overlap(s);
    if before <= s.options.projection {
        return None;
    }
    pose(
        &mut s.workspace.problem,
        &s.state.bodies,
        &s.state.network,
        &s.laws,
    );
    let options = SolverOptions {
        tolerance: TOLERANCE,
        norm: Norm::Velocity,
        max_iterations: MAX_SWEEPS,
        parallel: s.options.solver.parallel,
        ..SolverOptions::default()
    };
    let solved = nlgs::solve(&mut s.workspace.problem, &options);
    let moves: Vec<Move<S>> = (0..s.state.bodies.len())
        .map(|b| s.workspace.problem.velocity(b))
        .collect();
    if !moves.iter().all(|(x, w)| x.is_finite() && w.is_finite()) {
        return None;
    }
    let against_loads = record_moves(s, &moves);
    for (b, (shift, turn)) in moves.iter().enumerate() {
        displace(&mut s.state.bodies, b, shift, turn);
    }
    let driven = &s.state.bodies.driven;
    if driven
        .iter()
        .any(|d| moves[d.body as usize].1 != S::Spin::zero())
    {
        // A rotating surface moves more than its origin does.
        s.state.network.forget_neighbours();
    }
    // No time passes: bond openings follow the normals and are not rotated by spins again.
    let scene = CollisionScene::new(&s.shapes, &s.state.bodies, &s.table);
    let (time, parallel) = ([s.state.time, 0.0], s.options.solver.parallel);
    detect(&mut s.state.network, &scene, time, parallel);
    s.state.projection_work += against_loads;
    Some(ProjectionReport {
        before,
        after: deepest_overlap(s),
        sweeps: solved.iterations,
        against_loads,
    })
}

/// The deepest penetration, for [`Simulation::deepest_overlap`].
pub(in crate::step) fn deepest_overlap<S: Space>(s: &Simulation<S>) -> f64 {
    let (bodies, network, laws) = (&s.state.bodies, &s.state.network, s.laws.as_slice());
    let grain = bodies.grain_flags();
    let parallel = s.options.solver.parallel;
    largest(parallel, network.contacts.len(), DEPTH, |k| {
        overlap(&network.contacts[k], (bodies, network, laws), &grain)
    })
}

/// Returns the overlap of one contact, see [`Simulation::deepest_overlap`]; `grain` says which
/// bodies are grains.
#[inline]
pub(in crate::step) fn overlap<S: Space>(
    c: &Contact<S>,
    (bodies, network, laws): (&Bodies<S>, &Network<S>, &[Interface]),
    grain: &[bool],
) -> f64 {
    // A contact predicted within the step has the geometry at the time of closing.
    if c.gap >= 0.0 || c.closing || laws[usize::from(c.law)].compliant() {
        return 0.0;
    }
    let [i, j] = c.bodies.map(|b| b as usize);
    let along = |b: usize| c.normal.scaled_by(&bodies.inverse_mass[b]).dot(&c.normal);
    let held = network.bond(c).is_some_and(|b| b.intact());
    if held || along(i) + along(j) <= 0.0 {
        return 0.0;
    }
    let least = match (grain[i], grain[j]) {
        (true, false) => bodies.length[i],
        (false, true) => bodies.length[j],
        _ => bodies.length[i].min(bodies.length[j]),
    };
    -c.gap / least
}

/// Adds the work of displacements against gravity and imposed forces to the ledger; returns the
/// work against imposed forces (J).
fn record_moves<S: Space>(s: &mut Simulation<S>, moves: &[Move<S>]) -> f64 {
    let bodies = &s.state.bodies;
    let Scheme { h, theta } = s.options.scheme;
    let weights = moves.iter().zip(&bodies.mass);
    let potential: f64 = weights
        .map(|((shift, _), mass)| -mass * s.state.gravity.dot(shift))
        .sum();
    let mut external = 0.0;
    for driven in &bodies.driven {
        let (shift, turn) = &moves[driven.body as usize];
        for (k, dof) in driven.dofs.iter().enumerate() {
            let force = dof.over(s.state.time, h).force(s.state.time + theta * h);
            external += force * if k < S::D { shift[k] } else { turn[k - S::D] };
        }
    }
    s.state.energy.add_projection(potential, external);
    -external
}

/// Displaces and rotates a body. For anisotropic inertia its spin rotates with it, so that kinetic
/// energy is kept.
fn displace<S: Space>(bodies: &mut Bodies<S>, b: usize, shift: &S::Vector, turn: &S::Spin) {
    bodies.position[b] += *shift;
    if *turn == S::Spin::zero() {
        return;
    }
    let from = bodies.rotation[b];
    bodies.rotation[b] = S::turned(&from, turn);
    if bodies.tensor(b).is_some() {
        let own = S::unrotate_spin(&from, &bodies.spin[b]);
        bodies.spin[b] = S::rotate_spin(&bodies.rotation[b], &own);
    }
}

/// Sets up the problem of bodies at rest, with gaps to close or open in a unit of time.
fn pose<S: Space>(
    problem: &mut Problem<S>,
    bodies: &Bodies<S>,
    network: &Network<S>,
    laws: &[Interface],
) {
    /// Factor on total moved mass times deepest penetration: larger than any impulse of this
    /// problem.
    const UNBREAKABLE: f64 = 1e6;
    problem.clear();
    for b in 0..bodies.len() {
        problem.push_body(
            S::Vector::zero(),
            S::Spin::zero(),
            bodies.inverse_mass[b],
            bodies.inverse_tensor(b),
            bodies.length[b],
        );
    }
    let deepest = network.contacts.iter().map(|c| -c.gap).fold(0.0, f64::max);
    let grip = UNBREAKABLE * deepest * bodies.mass.iter().sum::<f64>();
    for contact in &network.contacts {
        let held = network.bond(contact).is_some_and(|b| b.intact());
        // The overlap of a spring carries its load.
        let kept = held || (contact.gap < 0.0 && laws[usize::from(contact.law)].compliant());
        let hold = if held { grip } else { 0.0 };
        problem.push(&ContactForm {
            bodies: contact.bodies,
            normal: contact.normal,
            arms: contact.arms,
            central: contact.central,
            // Overlaps are removed along normals; arms along the normal cause no rotation.
            shift_n: if kept { 0.0 } else { contact.gap },
            tension: hold,
            cohesion: hold,
            ..ContactForm::default()
        });
    }
}
