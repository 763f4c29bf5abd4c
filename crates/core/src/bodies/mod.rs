//! Rigid bodies: their state, inertia, and the degrees of freedom that are driven; and dynamical
//! systems that are more than rigid.
pub mod compliance;
pub mod conduction;
pub mod contactor;
pub mod drive;
pub mod dynamical_system;
pub mod horizon;
mod imposed_motion;
pub mod integral;
pub mod nodes;
pub mod path;
pub mod pressure;
pub mod state;
pub mod system_report;
pub mod systems;
mod table;
pub mod tensor;
pub mod time_function;

pub use compliance::{Compliance, block_of, column_of};
pub use conduction::Conduction;
pub use contactor::{Carrier, Contactor, ContactorMotion, ContactorShape};
pub use drive::{Dof, Driven, Stage};
pub use dynamical_system::{
    DynamicalSystem, Holder, SystemStep, SystemWork, compliance_by_solving, compliance_of_points,
    von_mises,
};
pub use horizon::STEPS_A_PERIOD;
pub use nodes::Nodes;
pub use state::Bodies;
pub(crate) use system_report::padded;
pub use system_report::{DeformedMesh, SystemSize, TouchingSurface};
pub use systems::{HeldAxis, Systems, TurningNode};
pub use time_function::TimeFunction;
