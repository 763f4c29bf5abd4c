//! Physics: closed forms, identities and results of other programs, through the public library.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

mod angular_layer;
mod attraction;
mod blocks;
mod bond_energy;
mod bond_formation;
mod bonded;
mod bricks;
mod compliant;
mod elastic;
mod extremes;
mod fast_springs;
mod flush;
mod friction;
mod held;
mod hollow;
mod imposed;
mod library;
mod masonry;
mod midpoint;
mod midpoint_load;
mod mindlin;
mod momentum;
mod packing;
mod peer_traps;
mod periodic_cell;
mod pinched;
mod processes;
mod programme;
mod projection;
mod pull_off;
mod rate;
mod restitution;
mod rolling;
#[path = "../support/scene.rs"]
mod scene;
mod scenes;
mod solids;
mod solvers;
mod squeezed;
mod stepping;
mod sweep;
mod systems;
#[path = "../support/temp.rs"]
mod temp;
mod third_body;
mod verification;
mod wear;
