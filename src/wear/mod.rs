//! Wear and the tribological circuit: what first bodies lose, and where it goes.
pub mod circuit;
pub mod ledger;
pub mod ties;
