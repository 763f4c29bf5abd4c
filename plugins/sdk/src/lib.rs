#![doc = include_str!("../README.md")]

pub mod ffi;
mod grid;
mod intact;
mod output;
mod site;
mod spring;
pub mod table;
pub mod testing;
mod traits;

pub use fretwork_abi as abi;
pub use grid::{Reading, Table};
pub use intact::Intact;
pub use output::{Conductance, Friction, Traction, bounded};
pub use site::Site;
pub use spring::{Spring, damping_ratio};
pub use traits::{
    CohesionLaw, ContactLaw, DamageLaw, Law, Parameters, TransportLaw, Variable, WearLaw, ramp,
    require,
};
