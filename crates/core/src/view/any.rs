//! A simulation of either dimension.

use super::{RunControl, RunSetup, RunView};
use crate::geometry::space::{Dim2, Dim3, Space};
use crate::step::{Simulation, StepError, StepReport};
use std::any::Any;
use std::ops::{ControlFlow, Deref, DerefMut};

/// A simulation of either dimension. It dereferences to [`RunControl`], by which it is stepped, and
/// [`RunView`], by which it is read; [`AnySimulation::get`] gives the simulation in its dimension.
#[derive(Debug)]
pub enum AnySimulation {
    /// Two dimensions.
    Plane(Box<Simulation<Dim2>>),
    /// Three dimensions.
    Space(Box<Simulation<Dim3>>),
}

/// Evaluates an expression with the simulation in its dimension: `in_dimension!(simulation, |s|
/// f(s))`, where `simulation` is an [`AnySimulation`](crate::view::AnySimulation), or a reference
/// to one. The expression is compiled for both dimensions.
#[macro_export]
macro_rules! in_dimension {
    ($simulation:expr, |$s:ident| $body:expr) => {
        match $simulation {
            $crate::view::AnySimulation::Plane($s) => $body,
            $crate::view::AnySimulation::Space($s) => $body,
        }
    };
}

// Functions that make a trait object of a simulation are compiled in this crate only: a copy
// inlined elsewhere would compile all methods of the trait again, and with them the step.
impl AnySimulation {
    /// The simulation for reading.
    #[inline(never)]
    pub fn view(&self) -> &dyn RunView {
        in_dimension!(self, |s| &**s)
    }

    /// Returns the simulation before its first step, for setup.
    #[inline(never)]
    pub fn setup(&mut self) -> &mut dyn RunSetup {
        in_dimension!(self, |s| &mut **s)
    }

    /// Returns the simulation in dimension `S`; `None` if it has the other dimension.
    pub fn get<S: Space>(&self) -> Option<&Simulation<S>> {
        let simulation: &dyn Any = in_dimension!(self, |s| &**s);
        simulation.downcast_ref()
    }

    /// Returns the mutable simulation in dimension `S`; `None` if it has the other dimension.
    pub fn get_mut<S: Space>(&mut self) -> Option<&mut Simulation<S>> {
        let simulation: &mut dyn Any = in_dimension!(self, |s| &mut **s);
        simulation.downcast_mut()
    }

    /// Makes steps until a time (s), or until `after`, which is called after each step, breaks; see
    /// [`Simulation::run_until`].
    ///
    /// # Errors
    /// The errors of [`Simulation::run_until`].
    pub fn run_until<B>(
        &mut self,
        time: f64,
        mut after: impl FnMut(&dyn RunView, &StepReport) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, StepError> {
        let mut reason = None;
        self.run_while(time, &mut |s, report| match after(s, report) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            ControlFlow::Break(why) => {
                reason = Some(why);
                ControlFlow::Break(())
            }
        })?;
        Ok(match reason {
            Some(why) => ControlFlow::Break(why),
            None => ControlFlow::Continue(()),
        })
    }

    #[inline(never)]
    fn run_while(
        &mut self,
        time: f64,
        after: &mut dyn FnMut(&dyn RunView, &StepReport) -> ControlFlow<()>,
    ) -> Result<(), StepError> {
        let ended = in_dimension!(self, |s| s.run_until(time, |s, report| after(s, report)));
        ended.map(|_| ())
    }

    /// Converts to the simulation in dimension `S`.
    ///
    /// # Errors
    /// Returns the simulation itself, if it has the other dimension.
    pub fn into_dimension<S: Space>(self) -> Result<Simulation<S>, Self> {
        if self.get::<S>().is_none() {
            return Err(self);
        }
        let simulation: Box<dyn Any> = in_dimension!(self, |s| s);
        match simulation.downcast() {
            Ok(simulation) => Ok(*simulation),
            Err(_) => unreachable!("it has this dimension"),
        }
    }
}

impl<S: Space> From<Simulation<S>> for AnySimulation {
    fn from(simulation: Simulation<S>) -> Self {
        let simulation: Box<dyn Any> = Box::new(simulation);
        match simulation.downcast() {
            Ok(plane) => Self::Plane(plane),
            Err(other) => match other.downcast() {
                Ok(space) => Self::Space(space),
                Err(_) => unreachable!("there are two and three dimensions"),
            },
        }
    }
}

impl Deref for AnySimulation {
    type Target = dyn RunControl;
    #[inline(never)]
    fn deref(&self) -> &Self::Target {
        in_dimension!(self, |s| &**s)
    }
}

impl DerefMut for AnySimulation {
    #[inline(never)]
    fn deref_mut(&mut self) -> &mut Self::Target {
        in_dimension!(self, |s| &mut **s)
    }
}

impl<S: Space> Simulation<S> {
    /// Returns the simulation without its dimension, for reading.
    pub fn view(&self) -> &dyn RunView {
        self
    }
}
