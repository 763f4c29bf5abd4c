//! Rows of the table, by extreme parameter.

mod bonds;
mod faces;
mod geometry;
mod inertia;
mod little;
mod motion;
mod packed;
mod time;

use super::bench::Group;

/// All groups, in the order of the table.
pub const ALL: &[Group] = &[
    inertia::MASS,
    inertia::SIZE,
    inertia::COLUMN,
    inertia::HIGH_COLUMN,
    packed::FRICTION,
    bonds::STIFFNESS,
    bonds::TORN,
    time::STEP,
    time::LONG_STEP,
    time::JUMP,
    time::MANY,
    packed::WEDGE,
    packed::ROD,
    faces::WALL,
    faces::FACES,
    motion::SPEED,
    motion::CORNERS,
    little::WEIGHTLESS,
    little::FEW,
    geometry::COINCIDENT,
    geometry::LENGTH,
    packed::TOLERANCE,
];

/// Groups that the tests run instead of those that are not quick.
#[allow(dead_code, reason = "the table has the whole groups")]
pub const IN_THEIR_PLACE: &[Group] = &[time::FEW_LONG_STEPS];
