//! Patches of bodies that roll, slide or fret, against closed forms and other programs.

mod fretting;
mod grids;
mod line;
mod pressed;
mod scar;
mod steady_rolling;
mod strokes;
