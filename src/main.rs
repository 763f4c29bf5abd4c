//! The command line of Fretwork.

fn main() -> std::process::ExitCode {
    fretwork::cli::main()
}
