//! Recording of a run: observers, from [`fretwork_observe`]; with the feature `results` also the
//! run loop and its files, from [`fretwork_store`]; with the feature `view` also pictures, from
//! [`fretwork_view`].
#[cfg(feature = "results")]
pub mod run;

pub use crate::RunView;
pub use fretwork_observe::picture::{Paint, Picture, PictureContent};
pub use fretwork_observe::{
    biaxial, choice, circuit, coordination, cycle, encoding, first_bodies, fretting, friction,
    friction_report, heat, jump, layer, loops, measure, mesh_fields, observer, output, placement,
    quantity, scars, scatter, series, solving, statistics, steady, strain, stress, summary,
    tractions, warning,
};
#[cfg(feature = "results")]
pub use fretwork_store::{checkpoint, fclib, meshes, results, shapes, views};
#[cfg(feature = "view")]
pub use fretwork_view::picture;

pub use fretwork_observe::run_state::UnconvergedSteps;
pub use observer::{Observer, Observers, RunEnd};
#[cfg(feature = "results")]
pub use run::{
    OnProgress, Progress, Run, RunError, RunOptions, check_names, run, run_observers,
    statistics_columns, stopped,
};
pub use summary::Summary;
