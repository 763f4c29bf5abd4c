//! What all benches do first.

/// Ends the process where the bench was compiled without optimisation, as by `cargo build
/// --benches`: its times would be those of no program.
pub fn refuse_unoptimised() {
    if cfg!(debug_assertions) {
        eprintln!(
            "this bench was built without optimisation: run it by `cargo bench --bench NAME`"
        );
        std::process::exit(2);
    }
}
