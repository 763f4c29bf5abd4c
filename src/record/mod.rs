//! What a run leaves behind: ledgers, statistics, pictures, the results file, the summary.
pub mod biaxial;
pub mod choice;
pub mod circuit;
pub mod coordination;
pub mod fclib;
pub mod figures;
pub mod fretting;
pub mod friction;
pub mod jump;
pub mod layer;
pub mod ledger;
pub mod loops;
pub mod measure;
pub mod picture;
pub mod results;
pub mod run;
pub mod scars;
pub mod solving;
pub mod statistics;
pub mod steady;
pub mod strain;
pub mod stress;
pub mod summary;
pub mod views;

pub use run::{Progress, RunError, RunOptions, run};
pub use summary::Summary;
