//! Rigid bodies: their state, inertia, and the degrees of freedom that are driven; and dynamical systems that are more than
//! rigid.
pub mod compliance;
pub mod conduction;
pub mod contactor;
pub mod delay;
pub mod drive;
pub mod dynamical_system;
pub mod horizon;
pub mod integral;
pub mod nodes;
pub mod path;
pub mod pressure;
pub mod stages;
pub mod state;
pub mod system_report;
pub mod systems;
pub mod tensor;

pub use compliance::{Compliance, block_of, column_of};
pub use conduction::Conduction;
pub use contactor::{Contactor, ContactorMotion, ContactorShape};
pub use drive::{Dof, Driven, TimeFunction};
pub use dynamical_system::{
    DeformedMesh, DynamicalSystem, Holder, SystemStep, SystemWork, compliance_by_solving,
    compliance_of_points, von_mises,
};
pub use horizon::STEPS_A_PERIOD;
pub use nodes::Nodes;
pub use stages::Stage;
pub use state::Bodies;
pub use system_report::{SystemSize, TouchingSurface};
pub use systems::{Carrier, HeldAxis, Systems, TurningNode};
