//! The tribological circuit: what breaks is told with where its energy went.

mod events;
mod scar;
mod scar_files;
