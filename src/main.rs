//! The command line of Fretwork.

// A terminal or pipe that takes no more must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

fn main() -> std::process::ExitCode {
    fretwork::cli::main()
}
