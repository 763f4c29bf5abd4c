//! Fuzz-like tests: no text makes the parser panic or hang.

use super::*;
use std::time::{Duration, Instant};

#[test]
fn deep_nesting_is_refused() {
    for (open, close) in [
        ("[", "]"),
        ("(", ")"),
        ("{1:", "}"),
        ("Some(", ")"),
        ("(a:", ")"),
    ] {
        let deep = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        let mut source = Source::from_text("deep.ron", deep);
        let error = source.parse::<Case>().unwrap_err();
        assert!(error.message.contains("more than 128 levels"), "{error}");
        assert!(error.line == 1 && error.column > 128);
        assert!(source.set::<Case>("a=1").is_err());
    }
    let comment = format!("{}1", "/*".repeat(100_000));
    let error = Source::from_text("c.ron", comment)
        .parse::<u8>()
        .unwrap_err();
    assert!(error.message.contains("comment is never closed"));
    // Nesting in a skipped value, and nesting inserted by `--set`, count as well.
    let fine = format!("{}1{}", "[".repeat(100), "]".repeat(100));
    let mut source = Source::from_text("d.ron", format!("(a: {fine})"));
    source
        .set::<Case>(&format!("a{}={fine}", ".0".repeat(50)))
        .unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert!(error.set().is_some() && error.message.contains("more than 128"));
}

/// A small deterministic generator, so that the mutations are reproducible.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

#[test]
fn mutations_never_panic() {
    const SCRAPS: &[&str] = &[
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "\"",
        "'",
        "/*",
        "*/",
        "//",
        "r#\"",
        "\"#",
        "b\"",
        "#![",
        "\\",
        "é",
        "\u{2028}",
        "\r\n",
        "\t",
        "Some(",
        "None",
        "..",
        "-",
        "NaN",
        "1e999",
        "\u{feff}",
        "日本",
        "\0",
        "\x1b[31m",
        "b'",
        "r#",
        "\u{85}",
        "_",
        "name: \"wheel\",",
    ];
    const SETS: &[&str] = &[
        "loading.amplitude=-1",
        "bodies.wheel.mass=\"é\"",
        "drive.0=(1, 2)",
        "drive.0.frequency=q",
        "materials.x=(young: 0)",
        "interfaces.0.cohesion=mac",
        "seed=[\n1,\n2]",
        "loading.new=é",
    ];
    let rounds = if cfg!(debug_assertions) {
        4_000
    } else {
        20_000
    };
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let begun = Instant::now();
    let mut refused = 0;
    for round in 0..rounds {
        let mut bytes = text().into_bytes();
        for _ in 0..1 + random.below(4) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] = random.below(256) as u8,
                1 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
                2 => bytes.truncate(at.max(1)),
                _ => {
                    let scrap = SCRAPS[random.below(SCRAPS.len())];
                    bytes.splice(at..at, scrap.bytes());
                }
            }
            if bytes.is_empty() {
                bytes.push(b'(');
            }
        }
        let mut source = Source::from_text("f.ron", String::from_utf8_lossy(&bytes));
        for _ in 0..random.below(3) {
            if let Err(error) = source.set::<Case>(SETS[random.below(SETS.len())]) {
                assert!(!error.compact().is_empty());
            }
        }
        if let Err(error) = source.parse::<Case>() {
            refused += 1;
            let lines = source.original.matches('\n').count() + 1;
            assert!((1..=lines).contains(&error.line), "round {round}");
            assert!(error.column >= 1);
            if round % 8 == 0 {
                assert!(!error.render(round % 16 == 0).is_empty());
            }
        }
    }
    assert!(refused > rounds / 4);
    // Bound on the time: quadratic behaviour would take minutes.
    let limit = Duration::from_secs(60);
    assert!(begun.elapsed() < limit, "{:?}", begun.elapsed());
}

#[test]
fn noise_never_panics() {
    let mut random = Random(88_172_645_463_325_252);
    for _ in 0..2_000 {
        let length = random.below(200);
        let bytes: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
        let mut source = Source::from_text("n.ron", String::from_utf8_lossy(&bytes));
        let argument = String::from_utf8_lossy(&bytes).replace('\0', "=");
        let _ = source.set::<Case>(&argument);
        if let Err(error) = source.parse::<Case>() {
            assert!(!error.render(false).is_empty());
        }
    }
}
