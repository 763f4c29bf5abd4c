//! Patches of bodies that roll, slide or fret, against closed forms and other programs.

mod fretting;
mod grids;
mod pressed;
mod steady_rolling;
