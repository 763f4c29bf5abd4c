//! What a run leaves behind: ledgers, statistics, the results file, the summary.
pub mod ledger;
