//! The tribological circuit: breaks of bonds are reported with the spending of their energy.

mod booked;
mod circuit;
mod events;
mod jump;
mod scar;
mod scar_files;
mod solids;
