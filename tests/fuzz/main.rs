//! Damaged input at scale: for any content of a file its reader returns a value or an error
//! message. It does not panic, does not hang, and does not hold more memory than `campaign` allows
//! for the size of the file.
//!
//! `FRETWORK_FUZZ=N` tries N inputs of each kind, `FRETWORK_FUZZ_SEED=S` changes the seed, and
//! `FRETWORK_FUZZ_FROM=K` begins with number K.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

mod binary;
mod campaign;
mod cases;
mod data;
#[path = "../support/counting.rs"]
mod memory;
mod mutate;

#[global_allocator]
static COUNTING: memory::Counting = memory::Counting;
