//! The extremes: scenes that make simulations explode, each with a criterion that is physics.
//!
//! `cargo run --release --example extremes` runs them all and prints the table of `docs/dev/extremes.md`; words after it choose
//! rows by the begin of their names (`-- mass step`). Each row declares what is to come of it: `held` where its criterion is
//! met; `told` where a limit is reached and the program says so, in words that name that cause and what to change; all else is
//! `BROKEN` and ends with exit code 1. `-- quick` leaves out what takes minutes.

mod bench;
mod rows;

use bench::Verdict;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let (mut held, mut told, mut broken) = (0, 0, 0);
    for group in rows::ALL {
        let named =
            |w: &String| group.name.starts_with(w.as_str()) || (w == "quick" && group.quick);
        if !wanted.is_empty() && !wanted.iter().any(named) {
            continue;
        }
        println!("\n**{}**: {}.\n", group.name, group.criterion);
        println!("| | value | found | verdict |");
        println!("|---|---|---|---|");
        for (dimension, run) in group.runs {
            for row in run() {
                let verdict = match &row.verdict {
                    Verdict::Held(words) => {
                        held += 1;
                        let but = if words.is_empty() { "" } else { "; told: " };
                        format!("held{but}{words}")
                    }
                    Verdict::Told(words) => {
                        told += 1;
                        format!("told: {words}")
                    }
                    Verdict::Broken(words) => {
                        broken += 1;
                        format!("**BROKEN** {words}")
                    }
                };
                println!(
                    "| {dimension}D | {} | {} | {verdict} |",
                    row.value, row.found
                );
            }
        }
    }
    println!("\n{held} rows held, {told} were told.");
    if broken > 0 {
        eprintln!("{broken} rows are broken");
        std::process::exit(1);
    }
}
