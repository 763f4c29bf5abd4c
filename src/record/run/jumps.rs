//! Jumps over cycles in a run.

use super::Recorder;
use crate::geometry::space::Space;
pub(super) use crate::process::jump::Jumps;
use crate::record::friction::Cycles;
use crate::record::statistics::Column;
use crate::scene::build::Dimensional;
use crate::scene::case::Case;
use crate::step::Simulation;

/// Starts the jumps, if the case has them and a further cycle fits into the run.
pub(super) fn begin<S: Space>(case: &Case, cycles: &Cycles, s: &Simulation<S>) -> Option<Jumps> {
    let spec = case.jump.clone()?;
    let count = |time: f64| (time / case.time.step).round() as u64;
    let steps = [count(cycles.period()?), count(case.time.end)];
    Some(Jumps::new(
        spec,
        steps,
        cycles.number(s.time + s.scheme.h),
        s,
    ))
}

/// Column of the statistics.
pub(super) fn column() -> Column {
    Column::new("cycles", "", "cycles, including those jumped over")
}

impl<S: Dimensional> Recorder<'_, S> {
    /// Processes a step for the jumps. Returns whether the requested number of cycles is reached.
    pub(super) fn jump(&mut self) -> bool {
        let (Some(jumps), Some((cycles, _))) = (&mut self.jumps, &mut self.cycles) else {
            return false;
        };
        let s = &mut self.simulation;
        let (number, cycle_multiplier) = (jumps.number(), jumps.cycle_multiplier());
        let mut work = 0.0;
        if let Some(cycle) = cycles.list.last_mut().filter(|c| c.cycle == number) {
            cycle.jumped = cycle_multiplier - 1;
            work = cycle.work;
        }
        jumps.follow(s, cycles.number(s.time + s.scheme.h), self.worn, work)
    }

    /// Value of the statistics' column.
    pub(super) fn cycles_represented(&self) -> Option<f64> {
        let (jumps, (cycles, _)) = (self.jumps.as_ref()?, self.cycles.as_ref()?);
        let share = cycles.share(self.simulation.time);
        // A cycle that ended with this step is counted as complete.
        Some(jumps.cycles(if share < 1.0 { share } else { 0.0 }))
    }
}
