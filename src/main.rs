//! The command line of Fretwork.

// A failed write to a terminal or pipe must not end a run: all output goes through `cli::output`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

#[global_allocator]
static ALLOCATOR: fretwork::huge_pages::HugePages = fretwork::huge_pages::HugePages;

fn main() -> std::process::ExitCode {
    fretwork::cli::main()
}
