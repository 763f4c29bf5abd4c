//! Simulations whose dimension is found at run time.
//!
//! [`Simulation::step`] and [`Simulation::detect`] look the dimension up, so that the step is
//! compiled here, once for each dimension, and not again in every crate that calls it.

use super::one_step::one_step;
use super::{Simulation, StepError, StepReport};
use crate::contact::detect::{CollisionScene, detect};
use crate::geometry::space::{Dim2, Dim3, Space};
use std::any::Any;

/// Calls the function for the dimension of a simulation.
fn by_dimension<S: Space, R>(
    simulation: &mut Simulation<S>,
    plane: fn(&mut Simulation<Dim2>) -> R,
    space: fn(&mut Simulation<Dim3>) -> R,
) -> R {
    let simulation: &mut dyn Any = simulation;
    if let Some(simulation) = simulation.downcast_mut() {
        return plane(simulation);
    }
    match simulation.downcast_mut() {
        Some(simulation) => space(simulation),
        None => unreachable!("there are two and three dimensions"),
    }
}

fn detect_touching<S: Space>(s: &mut Simulation<S>) {
    let scene = CollisionScene::new(&s.shapes, &s.state.bodies, &s.table);
    detect(&mut s.state.network, &scene, [0.0; 2], false);
}

// These four have no type parameter, so that the step is compiled here and not again in each crate
// that calls it.

#[inline(never)]
fn step_in_plane(simulation: &mut Simulation<Dim2>) -> Result<StepReport, StepError> {
    one_step(simulation)
}

#[inline(never)]
fn step_in_space(simulation: &mut Simulation<Dim3>) -> Result<StepReport, StepError> {
    one_step(simulation)
}

#[inline(never)]
fn detect_in_plane(simulation: &mut Simulation<Dim2>) {
    detect_touching(simulation);
}

#[inline(never)]
fn detect_in_space(simulation: &mut Simulation<Dim3>) {
    detect_touching(simulation);
}

impl<S: Space> Simulation<S> {
    /// Makes one step of h. Processes act at its named moments, see [`crate::process`]; the moment
    /// between the last step and this one comes first, where [`Simulation::between_steps`] was not
    /// called.
    ///
    /// # Errors
    /// Fails if a law or a process failed, the method does not support what the laws require, or a
    /// velocity is not finite; the state is then that of the failed step, or of the end of the
    /// previous one if a process failed between the two. Fails also if a surface was worn through
    /// in the previous step; the state is then that at its end.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        by_dimension(self, step_in_plane, step_in_space)
    }

    /// Detects the contacts at the current positions, without an alert distance.
    pub fn detect(&mut self) {
        by_dimension(self, detect_in_plane, detect_in_space);
    }
}
