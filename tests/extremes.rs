//! The extremes that take seconds: each holds, or the program says why it does not. The whole table:
//! `cargo run --release --example extremes`.

#[path = "../examples/extremes/bench.rs"]
mod bench;
#[path = "../examples/extremes/rows/mod.rs"]
mod rows;

use bench::Verdict;

#[test]
fn no_extreme_fails_in_silence() {
    let mut held = 0;
    for group in rows::ALL.iter().filter(|g| g.quick) {
        for row in (group.run)() {
            match row.verdict {
                Verdict::Held => held += 1,
                Verdict::Told(words) => assert!(words.len() > 20, "{}: {words}", group.name),
                Verdict::Broken(words) => {
                    panic!(
                        "{} ({}), {}: {}; {words}",
                        group.name, group.criterion, row.value, row.found
                    )
                }
            }
        }
    }
    // What is told is a limit of the scene: most hold.
    assert!(held >= 68, "{held}");
}
