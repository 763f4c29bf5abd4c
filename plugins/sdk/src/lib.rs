//! Write a Fretwork interface law in safe Rust.
//!
//! A law is a struct of parameters (see [`parameters!`]) and one of the traits [`ContactLaw`],
//! [`CohesionLaw`], [`DamageLaw`], [`WearLaw`], [`TransportLaw`], written for a single contact. The macro [`export!`]
//! exports it as a plugin: batches, columns, panics and messages are handled here.
//!
//! ```
//! use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};
//!
//! parameters! {
//!     /// Coulomb friction.
//!     pub struct Coulomb {
//!         mu: "" = 0.3, 0.0, f64::INFINITY, "friction coefficient";
//!     }
//! }
//!
//! impl Law for Coulomb {
//!     const NAME: &'static str = "coulomb";
//!     const DOC: &'static str = "friction proportional to the normal force";
//!     const REFERENCE: &'static str = "C. A. Coulomb, Theorie des machines simples (1785)";
//! }
//!
//! impl ContactLaw for Coulomb {
//!     fn friction(&self, _site: &Site, _state: &[f64]) -> Friction {
//!         Friction { mu: self.mu, ..Friction::default() }
//!     }
//! }
//! ```

pub mod border;
pub mod table;
pub mod testing;
mod traits;

pub use fretwork_abi as abi;
pub use traits::{
    CohesionLaw, Conductance, ContactLaw, DamageLaw, Friction, Intact, Law, Parameters, Site,
    Spring, Traction, TransportLaw, Variable, WearLaw, bounded, damping_ratio, ramp,
};
