//! The tribological circuit: what breaks is reported with where its energy went.

mod circuit;
mod events;
mod jump;
mod scar;
mod scar_files;
mod solids;
