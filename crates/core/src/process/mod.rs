//! Processes that act on a simulation between its steps.
pub mod circuit;
pub mod jump;
