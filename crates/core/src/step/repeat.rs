//! Repeating steps from a saved state: steps with other options, after which the original state is
//! restored.

use super::{Options, Simulation, State, control};
use crate::encoding::EncodingError;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::Interface;

/// The state of one process: its name and its bytes.
pub type ProcessState = (String, Vec<u8>);

/// Reason why steps cannot be repeated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RepeatError {
    /// A process may do what cannot be undone.
    #[error(
        "the process `{process}` does not declare that its steps can be repeated (Process::repeats)"
    )]
    Process {
        /// Name of the process.
        process: String,
    },
    /// A process cannot be saved or restored.
    #[error("the state of a process cannot be saved or put back for repeated steps: {0}")]
    Code(#[from] EncodingError),
}

/// All data of a simulation that steps may change, to restore it.
#[derive(Debug)]
pub struct SavedSimulation<S: Space> {
    state: State<S>,
    options: Options,
    laws: Vec<Interface>,
    processes: Vec<ProcessState>,
}

impl<S: Space> Simulation<S> {
    /// Continues from the state of a simulation that was built from the same case. The next step
    /// gives the same bits as in that simulation. Returns false, and changes nothing, if the state
    /// belongs to another case, or if this simulation has made steps already; it must then be built
    /// again, since laws and surfaces depend on the state. A decoded state is restored here, not
    /// assigned to `state`, which would leave dynamical systems without their data.
    #[must_use]
    pub fn restore(&mut self, mut state: State<S>) -> bool {
        if self.state.steps > 0 || !fits(&state, self) || !state.systems.resume(&self.state.systems)
        {
            return false;
        }
        self.state = state;
        for scar in &self.state.scars {
            scar.reapply_depth(&mut self.shapes);
        }
        self.notify(|process, simulation| process.follow_state(simulation));
        // Results may be read before the next step.
        self.state
            .systems
            .deform(&self.state.bodies, &mut self.shapes);
        self.state.control.set_parameters(&mut self.laws);
        control::set_holder_drives(self);
        self.measure_areas();
        true
    }

    /// Returns the states of the processes, in their order.
    ///
    /// # Errors
    /// A state cannot be encoded.
    pub fn save_processes(&self) -> Result<Vec<ProcessState>, EncodingError> {
        let list = self.processes.iter();
        list.map(|p| Ok((p.name().to_owned(), p.save()?))).collect()
    }

    /// Restores the states of the processes that [`Simulation::save_processes`] returned for a
    /// simulation with the same processes.
    ///
    /// # Errors
    /// The states belong to other processes, or one cannot be read; processes before it are then
    /// restored already.
    pub fn restore_processes(&mut self, from: &[ProcessState]) -> Result<(), EncodingError> {
        let names = self.processes.iter().map(|p| p.name());
        if !names.eq(from.iter().map(|(name, _)| name.as_str())) {
            return Err(EncodingError::other("processes"));
        }
        let mut pairs = self.processes.iter_mut().zip(from);
        pairs.try_for_each(|(process, (_, bytes))| process.restore(bytes))
    }

    /// Whether steps can be repeated.
    ///
    /// # Errors
    /// Returns an error with the first process that does not permit repetition.
    pub fn repeatable(&self) -> Result<(), RepeatError> {
        let other = self.processes.iter().find(|p| !p.repeats());
        other.map_or(Ok(()), |p| {
            Err(RepeatError::Process {
                process: p.name().to_owned(),
            })
        })
    }

    /// Continues with another step length (s). The impulses of contacts, from which the solver
    /// starts and which laws read, are scaled to keep the forces.
    pub fn change_step(&mut self, h: f64) {
        let ratio = h / self.options.scheme.h;
        self.options.scheme.h = h;
        for contact in &mut self.state.network.contacts {
            contact.impulse = contact.impulse * ratio;
            contact.moment = contact.moment * ratio;
        }
    }

    /// Continues with steps that each span `count` steps of the case (at least 1) of `h` (s).
    /// Events remain at steps of the case, see [`super::control::StepBounds`].
    pub fn span_steps(&mut self, h: f64, count: u32) {
        let count = count.max(1);
        let spanned = h * f64::from(count);
        if self.options.scheme.h != spanned {
            self.change_step(spanned);
        }
        self.options.grown = count - 1;
    }

    /// Lets `trial` make steps from the current state, with options that it may change, and then
    /// restores the state: the next step gives the same bits as without the trial.
    ///
    /// # Errors
    /// Steps cannot be repeated; nothing was changed then, unless a process could not be restored.
    pub fn repeat<R>(&mut self, trial: impl FnOnce(&mut Self) -> R) -> Result<R, RepeatError> {
        let saved = self.save()?;
        let result = trial(self);
        self.put_back(saved)?;
        Ok(result)
    }

    /// Lets `trial` make steps; if it fails, restores the state before it.
    ///
    /// # Errors
    /// Steps cannot be repeated; nothing was changed then, unless a process could not be restored.
    pub fn attempt<R, E>(
        &mut self,
        trial: impl FnOnce(&mut Self) -> Result<R, E>,
    ) -> Result<Result<R, E>, RepeatError> {
        let saved = self.save()?;
        let result = trial(self);
        if result.is_err() {
            self.put_back(saved)?;
        }
        Ok(result)
    }

    /// Copies all data that steps may change.
    fn save(&self) -> Result<SavedSimulation<S>, RepeatError> {
        self.repeatable()?;
        Ok(SavedSimulation {
            processes: self.save_processes()?,
            state: self.state.clone(),
            options: self.options,
            laws: self.laws.clone(),
        })
    }

    fn put_back(&mut self, saved: SavedSimulation<S>) -> Result<(), RepeatError> {
        let worn = self.state.scars.iter().zip(&saved.state.scars);
        let worn: Vec<bool> = worn.map(|(now, then)| !now.same_depths(then)).collect();
        self.state = saved.state;
        self.options = saved.options;
        self.laws = saved.laws;
        let scars = self.state.scars.iter().zip(worn);
        for (scar, _) in scars.filter(|(_, worn)| *worn) {
            scar.reapply_depth(&mut self.shapes);
        }
        self.processes.truncate(saved.processes.len());
        self.restore_processes(&saved.processes)?;
        self.notify(|process, simulation| process.follow_state(simulation));
        Ok(())
    }
}

/// Returns whether the state belongs to this scene and permits a step: its lists are as long as
/// those of the scene, indices are in range, and numbers of motion are finite.
fn fits<S: Space>(state: &State<S>, scene: &Simulation<S>) -> bool {
    let built = &scene.state;
    let scars = state.scars.iter().zip(&built.scars);
    let heat = state.heat.iter().zip(&built.heat);
    state.bodies.len() == built.bodies.len()
        && state.bodies.fits(&built.bodies)
        && state.bodies.carriers == built.bodies.carriers
        && state
            .network
            .fits(&built.network, &scene.shapes, &state.bodies)
        && state.received.len() == built.received.len()
        && state.started.len() == built.started.len()
        && state.scars.len() == built.scars.len()
        && scars.into_iter().all(|(a, b)| a.fits(b))
        && state.heat.is_some() == built.heat.is_some()
        && heat.into_iter().all(|(a, b)| a.fits(b))
        && state.law_history.fits(scene.laws.len())
        && state.time.is_finite()
        && state.gravity.is_finite()
        && (state.control).fits(&scene.phases, &scene.laws, &state.bodies.driven)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polyline::Polyline;
    use crate::geometry::space::Dim2;
    use crate::laws::sample_laws::interface;
    use crate::wear::Scar;
    use nalgebra::Vector2;

    /// A surface that a trial wears is restored to its worn state before the trial.
    #[test]
    fn a_trial_leaves_no_wear() {
        let chain = [0.0, 1.0, 2.0].map(|x| Vector2::new(x, 0.0)).to_vec();
        let mut s = Simulation::<Dim2>::of_disks(&[]);
        s.add_surface(Polyline::new(chain, None).unwrap());
        let scar = Scar::new("rail".into(), 0, &s.shapes.surfaces[0], 1.0, 1).unwrap();
        s.state.scars.push(scar);
        let wear = |s: &mut Simulation<Dim2>, x: f64| {
            let scar = &mut s.state.scars[0];
            scar.wear_at(&s.shapes, &Vector2::new(x, 0.0), 0.1).unwrap();
            scar.apply_depth(&mut s.shapes, 1.0);
        };
        let outline = |s: &Simulation<Dim2>| s.shapes.surfaces[0].shape.outline();
        wear(&mut s, 0.5);
        let before = outline(&s);
        let trial = |s: &mut Simulation<Dim2>| {
            wear(s, 1.5);
            assert_ne!(outline(s), before);
        };
        s.repeat(trial).unwrap();
        assert_eq!(outline(&s), before);
        let failed = s.attempt(|s| {
            trial(s);
            Err::<(), _>("no")
        });
        assert_eq!(failed.unwrap(), Err("no"));
        assert_eq!(outline(&s), before);
        assert!((s.state.scars[0].volume() - 0.1).abs() < 1e-15);
    }

    /// In a step that spans four steps of the case contacts have the impulses of the same forces.
    #[test]
    fn forces_stay_where_steps_grow() {
        let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)];
        let mut s = Simulation::<Dim2>::of_disks(&disks).with_law(interface([]));
        s.options.scheme.h = 0.25;
        s.step().unwrap();
        let impulse = |s: &Simulation<Dim2>| s.state.network.contacts[0].impulse.x;
        s.state.network.contacts[0].impulse.x = 2.0;
        s.span_steps(0.25, 4);
        assert_eq!(
            (s.options.scheme.h, s.options.grown, impulse(&s)),
            (1.0, 3, 8.0)
        );
        s.span_steps(0.25, 0);
        assert_eq!(
            (s.options.scheme.h, s.options.grown, impulse(&s)),
            (0.25, 0, 2.0)
        );
        s.span_steps(0.25, 1);
        assert_eq!(impulse(&s), 2.0);
    }
}
