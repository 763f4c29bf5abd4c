//! The program: its commands, input, files and plugins; a run can be resumed and repeated bit by
//! bit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]

mod accuracy;
mod another_run;
mod bad_input;
mod case_formats;
mod certify;
mod check_features;
mod check_methods;
mod contact_patch;
mod deformed_state;
mod end_of_run;
mod facts;
mod fclib;
mod fit;
mod grains;
mod growth;
mod half_space_page;
mod heat;
mod holders;
mod language_server;
mod law_drive;
mod law_inputs;
mod law_new;
mod layers;
mod library_features;
mod line_length;
mod material;
mod material_laws;
mod new_case;
mod pages;
mod patch;
mod patch_windows;
mod plugin_loading;
mod quantities;
mod rebuilt_program;
mod release_files;
mod report;
mod results;
mod resume;
mod same_bits;
mod samples;
#[path = "../support/scene.rs"]
mod scene;
mod shipped_inputs;
mod solve;
mod study;
#[path = "../support/temp.rs"]
mod temp;
mod trade;
mod wear_coefficient;
