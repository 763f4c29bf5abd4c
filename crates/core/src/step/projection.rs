//! Projection of positions: penetrations are removed by displacing bodies, without changing velocities.
//!
//! The smallest displacement that leaves no penetration, min 1/2 |dq|_M^2 with g + n . (relative dq) >= 0,
//! is the frictionless contact problem of bodies at rest over a unit of time, and is solved by the same
//! solver. An intact bond keeps its two sides together (u = 0). Moreau, "Numerical aspects of the sweeping
//! process", Comput. Methods Appl. Mech. Eng. 177 (1999), projects in every step; here a step is projected
//! only when a penetration exceeds a bound.
//!
//! Velocities do not change, so that kinetic energy is kept; bond openings do not change, so that elastic
//! energy is kept. Work against gravity and imposed forces is booked in the ledger as work of the
//! correction.
//!
//! Dynamical systems do not take part: a scene with one is refused.

use super::{Scheme, Simulation, StepError};
use crate::bodies::Bodies;
use crate::contact::detect::detect;
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::Interface;
use crate::solve::error::Norm;
use crate::solve::{ContactForm, Options, Problem, nlgs};
use crate::threads::largest;

/// Result of a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// Deepest penetration before it, as a fraction of the smaller body's length.
    pub before: f64,
    /// Deepest penetration left.
    pub after: f64,
    /// Iterations of the solver.
    pub sweeps: u32,
    /// Work done on driven bodies against imposed forces and moments (J; J/m in 2D).
    pub against_loads: f64,
}

/// Displacement of a body's centre (m) and its rotation (rad).
type Move<S> = (<S as Space>::Vector, <S as Space>::Spin);

/// Relative tolerance of the displacements. The remainder is removed by the next projection.
const TOLERANCE: f64 = 1e-3;
/// Iteration limit: no solution exists where bodies have no room to move apart.
const MAX_SWEEPS: u32 = 5000;
/// About what it takes to find how deep a contact is (ns).
const DEPTH: f64 = 3.0;

impl<S: Space> Simulation<S> {
    /// Refuses projection in a scene with dynamical systems, which it would leave where they are.
    ///
    /// # Errors
    /// Projection is on and there are systems.
    pub(super) fn refuse_projection_of_systems(&self) -> Result<(), StepError> {
        match self.state.systems.get(0) {
            Some(system) if self.options.projection > 0.0 => Err(StepError::SystemProjection {
                step: self.state.steps + 1,
                system: system.name().to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// Removes penetrations if one exceeds the bound, repeats detection, and books the work.
    pub(super) fn project(&mut self) -> Option<Projected> {
        if self.options.projection <= 0.0 {
            return None;
        }
        let before = self.deepest_overlap();
        if before <= self.options.projection {
            return None;
        }
        pose(
            &mut self.workspace.problem,
            &self.state.bodies,
            &self.state.network,
            &self.laws,
        );
        let options = Options {
            tolerance: TOLERANCE,
            norm: Norm::Velocity,
            max_iterations: MAX_SWEEPS,
            parallel: self.options.solver.parallel,
            ..Options::default()
        };
        let solved = nlgs::solve(&mut self.workspace.problem, &options);
        let moves: Vec<Move<S>> = (0..self.state.bodies.len())
            .map(|b| self.workspace.problem.velocity(b))
            .collect();
        if !moves.iter().all(|(x, w)| x.is_finite() && w.is_finite()) {
            return None;
        }
        let against_loads = self.book_moves(&moves);
        for (b, (shift, turn)) in moves.iter().enumerate() {
            displace(&mut self.state.bodies, b, shift, turn);
        }
        let driven = &self.state.bodies.driven;
        if driven
            .iter()
            .any(|d| moves[d.body as usize].1 != S::Spin::zero())
        {
            // A rotating surface moves more than its frame does.
            self.state.network.forget_neighbours();
        }
        // No time passes: bond openings follow the normals and are not rotated by spins again.
        detect(
            &mut self.state.network,
            &self.shapes,
            &self.state.bodies,
            &self.table,
            [self.state.time, 0.0],
            self.options.solver.parallel,
        );
        self.state.projection_work += against_loads;
        Some(Projected {
            before,
            after: self.deepest_overlap(),
            sweeps: solved.iterations,
            against_loads,
        })
    }

    /// Returns the deepest penetration that a displacement can remove, as a fraction of the smaller body's
    /// length (a grain's radius; walls do not count).
    pub fn deepest_overlap(&self) -> f64 {
        let (bodies, network, laws) = (
            &self.state.bodies,
            &self.state.network,
            self.laws.as_slice(),
        );
        let grain = bodies.grain_flags();
        let parallel = self.options.solver.parallel;
        largest(parallel, network.contacts.len(), DEPTH, |k| {
            Self::overlap(&network.contacts[k], (bodies, network, laws), &grain)
        })
    }

    /// The same of one contact; `grain` tells which bodies are grains.
    #[inline]
    pub(super) fn overlap(
        c: &Contact<S>,
        (bodies, network, laws): (&Bodies<S>, &Network<S>, &[Interface]),
        grain: &[bool],
    ) -> f64 {
        // One that was found on its way has the place where it closes.
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

    /// Books the work of displacements against gravity and imposed forces; returns the latter (J).
    fn book_moves(&mut self, moves: &[Move<S>]) -> f64 {
        let bodies = &self.state.bodies;
        let Scheme { h, theta } = self.options.scheme;
        let weights = moves.iter().zip(&bodies.mass);
        let potential: f64 = weights
            .map(|((shift, _), mass)| -mass * self.state.gravity.dot(shift))
            .sum();
        let mut external = 0.0;
        for driven in &bodies.driven {
            let (shift, turn) = &moves[driven.body as usize];
            for (k, dof) in driven.dofs.iter().enumerate() {
                let force = dof
                    .over(self.state.time, h)
                    .force(self.state.time + theta * h);
                external += force * if k < S::D { shift[k] } else { turn[k - S::D] };
            }
        }
        self.state.energy.book_projection(potential, external);
        -external
    }
}

/// Displaces and rotates a body. For anisotropic inertia its spin rotates with it, so that kinetic energy is
/// kept.
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
    /// Times total moved mass times deepest penetration: larger than any impulse of this problem.
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
            // Overlaps are taken out along normals, about which arms along them do not turn.
            apart: false,
            shift_n: if kept { 0.0 } else { contact.gap },
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: hold,
            cohesion: hold,
            elastic: None,
            compliance: [0.0; 2],
            impulse: S::Vector::zero(),
        });
    }
}
