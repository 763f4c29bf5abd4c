//! Time-dependent external actions on a scene: phases, gravity, servo pressures, gates.

mod gravity;
mod imposed;
mod impossible;
mod loads;
pub(super) mod phases;
pub(super) mod schedule;
mod step_bounds;

pub use gravity::GravityDrive;
pub(super) use imposed::{begin_motion, end_motion, set_in_motion};
pub use impossible::ImpossibleMotions;
pub(super) use impossible::watch_imposed;
pub(super) use loads::{end_phase, set_holder_drives};
pub use phases::{Changes, Phase, StartedPhase, Until};
pub use schedule::Control;
pub use step_bounds::StepBounds;
