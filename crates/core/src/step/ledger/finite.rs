//! Checks that the state is finite at the end of each step, before any output is recorded.

use crate::contact::Occurrence;
use crate::geometry::space::{Space, VectorLike};
use crate::step::{Simulation, StepError};
use crate::threads::any;

/// Motion lost to rounding from which a warning is issued, as a fraction of the alert distance: for
/// spheres, a millionth of the radius.
const LOST: f64 = 2e-5;
/// Approximate time to check a position (ns).
const LOOK: f64 = 2.0;

/// Checks the state at the end of the step, and records motion that is lost to rounding.
///
/// # Errors
/// Returns an error that names the first quantity that is not finite, and its body.
pub(in crate::step) fn check_finite<S: Space>(s: &mut Simulation<S>) -> Result<(), StepError> {
    find_overflow(s)?;
    watch_rounding(s);
    Ok(())
}

/// Checks that the state and the ledger are finite.
///
/// # Errors
/// Returns an error that names the first quantity that is not finite, and its body.
fn find_overflow<S: Space>(s: &Simulation<S>) -> Result<(), StepError> {
    let overflow = |quantity: String, value: f64| StepError::Overflow {
        step: s.state.steps,
        time: s.state.time,
        quantity,
        value,
    };
    let bodies = &s.state.bodies;
    // Velocities were checked after the solve.
    let lost = |b: usize| !bodies.position[b].is_finite();
    if any(s.options.solver.parallel, bodies.len(), LOOK, lost)
        && let Some(b) = (0..bodies.len()).find(|b| lost(*b))
    {
        let place = bodies.position[b].padded();
        let value = place.into_iter().find(|x| !x.is_finite());
        let quantity = format!("the position of {}", bodies.name(b as u32));
        return Err(overflow(quantity, value.unwrap_or(f64::NAN)));
    }
    let e = &s.state.energy;
    if !e.kinetic.is_finite()
        && let Some(b) = (0..bodies.len()).find(|b| !bodies.energy_of(*b).is_finite())
    {
        let quantity = format!("the kinetic energy of {}", bodies.name(b as u32));
        return Err(overflow(quantity, bodies.energy_of(b)));
    }
    match e.entries().into_iter().find(|(_, _, x)| !x.is_finite()) {
        Some((name, _, value)) => Err(overflow(format!("the energy entry `{name}`"), value)),
        None => Ok(()),
    }
}

/// Records bodies whose displacement in a step is below the floating-point spacing of their
/// position, so that they do not move although they should.
fn watch_rounding<S: Space>(s: &mut Simulation<S>) {
    if s.state.bodies.lost.is_empty() {
        return;
    }
    let least = LOST * s.state.network.alert;
    let lost = &s.state.bodies.lost;
    let stuck = |b: usize| lost[b].norm() > least;
    if any(s.options.solver.parallel, lost.len(), LOOK, stuck)
        && let Some(body) = (0..lost.len()).find(|b| stuck(*b))
    {
        let (time, bodies) = (s.state.time, &s.state.bodies);
        let first = || Occurrence::new(time, bodies, &[body as u32]);
        s.state.network.step_size.record_lost_motion(first);
    }
}
