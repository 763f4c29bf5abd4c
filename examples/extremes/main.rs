//! The extremes: scenes that make simulations explode, each with a criterion that is physics.
//!
//! `cargo run --release --example extremes` runs them all and prints the table of `docs/extremes.md`; words after it choose
//! rows by the begin of their names (`-- mass step`). A row `held` where its criterion is met; `told` where a limit was
//! reached and the program said so, in words that name the cause; all else is `BROKEN` and ends with exit code 1. `-- quick`
//! leaves out what takes minutes.

mod bench;
mod rows;

use bench::Verdict;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let mut broken = 0;
    for group in rows::ALL {
        let named =
            |w: &String| group.name.starts_with(w.as_str()) || (w == "quick" && group.quick);
        if !wanted.is_empty() && !wanted.iter().any(named) {
            continue;
        }
        println!("\n**{}**: {}.\n", group.name, group.criterion);
        println!("| value | found | verdict |");
        println!("|---|---|---|");
        for row in (group.run)() {
            let verdict = match &row.verdict {
                Verdict::Held => "held".to_owned(),
                Verdict::Told(words) => format!("told: {words}"),
                Verdict::Broken(words) => {
                    broken += 1;
                    format!("**BROKEN** {words}")
                }
            };
            println!("| {} | {} | {verdict} |", row.value, row.found);
        }
    }
    if broken > 0 {
        eprintln!("{broken} rows are broken");
        std::process::exit(1);
    }
}
