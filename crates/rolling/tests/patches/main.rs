//! Patches of bodies that roll, slide or fret, against closed forms and other programs.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

mod fretting;
mod grids;
mod line;
mod manchester;
mod onset;
mod pressed;
mod scar;
mod steady_rolling;
mod strokes;
