//! Damaged input at scale: whatever a file holds, its reader answers with what it is of or with a
//! sentence. It does not panic, does not hang, and does not hold more memory than `campaign` allows
//! for the size of the file.
//!
//! `FRETWORK_FUZZ=N` tries N inputs of each kind, `FRETWORK_FUZZ_SEED=S` others,
//! `FRETWORK_FUZZ_FROM=K` from number K on.

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
