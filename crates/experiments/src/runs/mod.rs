//! Runs of a case in separate processes, each stored under a key of all that determines it, so that
//! none is made twice.
//!
//! [`launcher`] starts runs, [`stored`] evaluates how they ended, [`key`] names them, [`trial`]
//! times a few steps of one, also under load (`loaded`), [`pool`] makes several at once; [`output`]
//! reads the numbers that they leave, [`available`] lists those that a case has. [`randomness`]
//! determines whether the seed of a case matters, [`perturbation`] distinguishes runs where it does
//! not; [`window`] reads the course of a friction test.

pub mod available;
pub mod key;
pub mod launcher;
mod loaded;
pub mod output;
pub mod perturbation;
pub mod pool;
pub mod randomness;
pub mod stored;
pub mod trial;
pub mod unit;
pub mod window;
