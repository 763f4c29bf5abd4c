//! The contact network: who touches whom, where, and what each contact remembers.
pub mod detect;
pub mod events;
pub mod haste;
pub mod memory;
pub mod network;

pub use events::{Break, Life, Loss, Spent};
pub use haste::Haste;
pub use memory::{Bond, Memory};
pub use network::{Contact, Key, Network};
