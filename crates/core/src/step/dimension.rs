//! Simulations whose dimension is found at run time.
//!
//! [`Simulation::step`] and [`Simulation::detect`] look it up, so that the step is compiled here,
//! once for each dimension, and not again in every crate that makes steps.

use super::one_step::one_step;
use super::{Simulation, StepError, StepReport};
use crate::contact::detect::{CollisionScene, detect};
use crate::geometry::space::{Dim2, Dim3, Space};
use std::any::Any;

/// A simulation by its dimension, to be changed.
#[derive(Debug)]
pub enum InDimensionMut<'a> {
    /// Two dimensions.
    Dim2(&'a mut Simulation<Dim2>),
    /// Three dimensions.
    Dim3(&'a mut Simulation<Dim3>),
}

impl<'a> InDimensionMut<'a> {
    /// The simulation, whose type parameter is one of the two dimensions.
    pub fn of<S: Space>(simulation: &'a mut Simulation<S>) -> Self {
        let simulation: &mut dyn Any = simulation;
        if simulation.is::<Simulation<Dim2>>() {
            return match simulation.downcast_mut() {
                Some(plane) => Self::Dim2(plane),
                None => unreachable!("it is of this type"),
            };
        }
        match simulation.downcast_mut() {
            Some(space) => Self::Dim3(space),
            None => unreachable!("there are two and three dimensions"),
        }
    }

    /// Makes one step ([`Simulation::step`]).
    ///
    /// # Errors
    /// Those of [`Simulation::step`].
    pub fn step(self) -> Result<StepReport, StepError> {
        match self {
            Self::Dim2(simulation) => one_step(simulation),
            Self::Dim3(simulation) => one_step(simulation),
        }
    }

    /// Detects the contacts ([`Simulation::detect`]).
    pub fn detect(self) {
        match self {
            Self::Dim2(simulation) => touching(simulation),
            Self::Dim3(simulation) => touching(simulation),
        }
    }
}

fn touching<S: Space>(s: &mut Simulation<S>) {
    let scene = CollisionScene::new(&s.shapes, &s.state.bodies, &s.table);
    detect(&mut s.state.network, &scene, [0.0; 2], false);
}

impl<S: Space> Simulation<S> {
    /// One step of h. Processes act at its named moments, see [`crate::process`]; those that are
    /// due between the last step and this one first, where [`Simulation::between_steps`] was not
    /// called.
    ///
    /// # Errors
    /// A law or a process failed, the method does not support what the laws require, or a velocity
    /// is not finite; the state is then that of the failed step, or of the end of the previous one
    /// if a process failed between the two. A surface was worn through in the previous step; the
    /// state is then that at its end.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        InDimensionMut::of(self).step()
    }

    /// Detects the contacts at the current positions, without an alert distance.
    pub fn detect(&mut self) {
        InDimensionMut::of(self).detect();
    }
}
