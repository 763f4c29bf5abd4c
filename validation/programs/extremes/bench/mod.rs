//! Short scene descriptions, runs of some steps, and verdicts.

mod run;
mod sketch;
mod verdict;

pub use run::{carried, go, overlap, watch};
pub use sketch::{G, Sketch, ball, floor, grains, place, plane, up, volume};
pub use verdict::{Cause, Expected, Group, HELD, Row, Verdict, held_though, refused, reported};
