//! Extreme scenes with a physical criterion each.
//!
//! `cargo run --release --example extremes` runs all of them and prints the table of
//! `docs/dev/extremes.md`; arguments select rows by the beginning of their names (`-- mass step`).
//! Each row declares its expected result: `met` if its criterion is met; `reported` if a limit is
//! reached and the program reports the cause and what to change; anything else is `BROKEN` and
//! gives exit code 1. `-- quick` omits rows that take minutes.

mod bench;
mod rows;

use bench::Verdict;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let (mut held, mut reported, mut broken) = (0, 0, 0);
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
                        let but = if words.is_empty() { "" } else { "; reported: " };
                        format!("met{but}{words}")
                    }
                    Verdict::Reported(words) => {
                        reported += 1;
                        format!("reported: {words}")
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
    println!("\n{held} rows are met, {reported} are reported.");
    if broken > 0 {
        eprintln!("{broken} rows are broken");
        std::process::exit(1);
    }
}
