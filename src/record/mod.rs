//! The run loop and its results: analysis by [`fretwork_observe`], files by [`fretwork_store`],
//! pictures by [`fretwork_view`].
pub mod run;

pub use crate::RunView;
pub use fretwork_observe::picture::{Paint, Picture, Shows};
pub use fretwork_observe::{
    biaxial, choice, circuit, code, coordination, first_bodies, fretting, friction,
    friction_report, heat, jump, layer, loops, measure, mesh_fields, observer, output, placement,
    quantity, scars, scatter, solving, statistics, steady, strain, stress, tractions, warning,
};
pub use fretwork_store::{checkpoint, fclib, meshes, results, series, shapes, summary, views};
pub use fretwork_view::picture;

pub use fretwork_observe::run_state::Missed;
pub use observer::{Observer, Observers, RunEnd};
pub use run::{
    OnProgress, Progress, Run, RunError, RunOptions, check_names, run, run_observers,
    statistics_columns, stopped,
};
pub use summary::Summary;
