//! The contact network: contacts, their geometry, and their memory.
pub mod detect;
pub mod events;
mod fits;
pub mod id;
pub mod memory;
pub mod network;
pub mod spring;
pub mod step_size;
pub mod thermal;

pub use events::{BondEnergies, Break, ContactDissipation, ContactWear};
pub use id::{ContactId, ContactNames, ContactorId, ContactorKind};
pub use memory::{Bond, BondState, Memory, SlideStatistics};
pub use network::{ActionPoint, Contact, Key, Network, ShapeIndex};
pub use spring::Spring;
pub use step_size::{Occurrence, StepSizeDiagnostics};
pub use thermal::{ContactHeat, ContactTemperature, HeatSide, MaterialPair};
