//! Damage to files: to bytes, and to the tokens of texts. Equal generators give equal damage.

use rand::RngExt;
use rand_pcg::Pcg64;
use std::ops::Range;

/// Numbers that are most likely to cause errors.
const NUMBERS: [&str; 32] = [
    "NaN",
    "inf",
    "-inf",
    "0",
    "-0.0",
    "-1",
    "1",
    "2",
    "3",
    "1e308",
    "-1e308",
    "1e-320",
    "1e-308",
    "1e300",
    "1e150",
    "1e-150",
    "1e20",
    "1e9",
    "1e-9",
    "1e-17",
    "0.5",
    "65535",
    "65536",
    "1000000",
    "10000000",
    "100000000",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551615",
    "1e400",
];

/// Integers that are most likely to cause errors in binary files.
const WHOLE: [u64; 16] = [
    0,
    1,
    2,
    3,
    7,
    8,
    0x7f,
    0xff,
    0xffff,
    0x7fff_ffff,
    0xffff_ffff,
    0x1_0000_0000,
    1 << 40,
    i64::MAX as u64,
    i64::MAX as u64 + 1,
    u64::MAX,
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Number,
    Word,
    Text,
    Open,
    Close,
    Mark,
    Space,
}

type Token = (Kind, String);

/// Splits a text into tokens, which joined are the text again.
fn tokens(text: &str) -> Vec<Token> {
    let mut out: Vec<Token> = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let until = |stop: &dyn Fn(char) -> bool| rest.find(stop).unwrap_or(rest.len());
        let number = |c: char| c.is_ascii_digit() || ".eE+-_".contains(c);
        let (kind, length) = if first.is_whitespace() {
            (Kind::Space, until(&|c| !c.is_whitespace()))
        } else if rest.starts_with("//") || first == '#' {
            (Kind::Space, until(&|c| c == '\n'))
        } else if first == '"' {
            let end = rest[1..].find('"').map_or(rest.len(), |k| k + 2);
            (Kind::Text, end)
        } else if first.is_ascii_digit() || "-+.".contains(first) {
            (Kind::Number, until(&|c| !number(c)))
        } else if first.is_alphabetic() || first == '_' {
            (Kind::Word, until(&|c| !(c.is_alphanumeric() || c == '_')))
        } else if "([{".contains(first) {
            (Kind::Open, 1)
        } else if ")]}".contains(first) {
            (Kind::Close, 1)
        } else {
            (Kind::Mark, first.len_utf8())
        };
        out.push((kind, rest[..length].to_owned()));
        rest = &rest[length..];
    }
    out
}

/// Returns the group that opens at a token, including its brackets.
fn group(tokens: &[Token], open: usize) -> Range<usize> {
    let mut depth = 0usize;
    for (k, (kind, _)) in tokens.iter().enumerate().skip(open) {
        match kind {
            Kind::Open => depth += 1,
            Kind::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return open..k + 1;
        }
    }
    open..tokens.len()
}

/// A token of a kind, at random.
fn any(tokens: &[Token], kind: Kind, rng: &mut Pcg64) -> Option<usize> {
    let all: Vec<usize> = (0..tokens.len()).filter(|k| tokens[*k].0 == kind).collect();
    (!all.is_empty()).then(|| all[rng.random_range(0..all.len())])
}

/// Returns a replacement for a number: an extreme, one of another size, or of another type.
fn number(old: &str, rng: &mut Pcg64) -> String {
    let value: f64 = old.parse().unwrap_or(1.0);
    match rng.random_range(0..6) {
        0..=2 => NUMBERS[rng.random_range(0..NUMBERS.len())].to_owned(),
        3 => format!("{:e}", value * 10f64.powi(rng.random_range(-12..=12))),
        4 => {
            let factor = 10u64.pow(rng.random_range(0..=6));
            let digits = old.chars().all(|c| c.is_ascii_digit());
            match old.parse::<u64>() {
                Ok(n) if digits => n.saturating_mul(factor).to_string(),
                _ => format!("{}", -value),
            }
        }
        _ => rng.random_range(0..=12).to_string(),
    }
}

/// Changes some tokens, lines or bytes of a text, with material from `others`.
pub fn text(seed: &str, others: &[String], rng: &mut Pcg64) -> Vec<u8> {
    let mut list = tokens(seed);
    let lender = tokens(&others[rng.random_range(0..others.len())]);
    let rounds = 1 + (0..5).take_while(|_| rng.random_range(0..2) == 0).count();
    for _ in 0..rounds {
        if list.is_empty() {
            break;
        }
        change(&mut list, &lender, rng);
    }
    let mut out: Vec<u8> = list.into_iter().flat_map(|t| t.1.into_bytes()).collect();
    if rng.random_range(0..8) == 0 {
        let other = others[rng.random_range(0..others.len())].as_bytes();
        out = bytes(&out, other, rng);
    }
    out
}

fn change(list: &mut Vec<Token>, lender: &[Token], rng: &mut Pcg64) {
    match rng.random_range(0..20) {
        0..=8 => {
            if let Some(k) = any(list, Kind::Number, rng) {
                list[k].1 = number(&list[k].1.clone(), rng);
            }
        }
        9 | 10 => {
            let kind = [Kind::Word, Kind::Text][rng.random_range(0..2)];
            if let (Some(k), Some(from)) = (any(list, kind, rng), any(lender, kind, rng)) {
                list[k] = lender[from].clone();
            }
        }
        11 => {
            let kind = [Kind::Word, Kind::Text][rng.random_range(0..2)];
            if let (Some(k), Some(from)) = (any(list, kind, rng), any(list, kind, rng)) {
                list.swap(k, from);
            }
        }
        12 => drop(list.remove(rng.random_range(0..list.len()))),
        13 => {
            // The change is in a field, a line or part of one.
            let at = rng.random_range(0..list.len());
            let end = (at + rng.random_range(1..40)).min(list.len());
            list.drain(at..end);
        }
        14 => {
            if let Some(k) = any(list, Kind::Open, rng) {
                let copy = list[group(list, k)].to_vec();
                let comma = (Kind::Mark, ",".to_owned());
                let copies = rng.random_range(1..4);
                let all: Vec<Token> = (0..copies)
                    .flat_map(|_| copy.iter().cloned().chain([comma.clone()]))
                    .collect();
                list.splice(k..k, all);
            }
        }
        15 | 16 => {
            if let (Some(k), Some(from)) =
                (any(list, Kind::Open, rng), any(lender, Kind::Open, rng))
            {
                let new = lender[group(lender, from)].to_vec();
                list.splice(group(list, k), new);
            }
        }
        17 => {
            let at = rng.random_range(0..list.len());
            let depth = [2, 100, 20_000][rng.random_range(0..3)];
            let open = ["[", "(", "Some(", "{"][rng.random_range(0..4)];
            list.insert(at, (Kind::Mark, open.repeat(depth)));
        }
        18 => {
            let lines: Vec<usize> = (0..list.len())
                .filter(|k| list[*k].0 == Kind::Space && list[*k].1.contains('\n'))
                .collect();
            if lines.len() > 2 {
                let a = rng.random_range(0..lines.len() - 1);
                let line = list[lines[a]..lines[a + 1]].to_vec();
                let to = lines[rng.random_range(0..lines.len())];
                list.splice(to..to, line);
            }
        }
        _ => {
            let at = rng.random_range(0..list.len());
            let from = rng.random_range(0..lender.len().max(1));
            if let Some(token) = lender.get(from) {
                list.insert(at, token.clone());
            }
        }
    }
}

/// Signatures in HDF5 files; the bytes after them tell how to read the rest.
const SIGNS: [&[u8]; 9] = [
    b"\x89HDF", b"TREE", b"HEAP", b"SNOD", b"OHDR", b"FRHP", b"FADB", b"EAHD", b"BTHD",
];

/// Returns a position in a file, half of the time near one of its signatures.
fn place(bytes: &[u8], rng: &mut Pcg64) -> usize {
    if rng.random_range(0..2) == 0 {
        let from = rng.random_range(0..bytes.len());
        let rest = &bytes[from..];
        if let Some(k) = SIGNS
            .iter()
            .filter_map(|s| memchr::memmem::find(rest, s))
            .min()
        {
            return (from + k + rng.random_range(0..96)).min(bytes.len() - 1);
        }
    }
    if rng.random_range(0..2) == 0 {
        // Headers of objects have no signature in older files; most non-zero bytes are headers or
        // data.
        let from = rng.random_range(0..bytes.len());
        return (from..bytes.len()).find(|k| bytes[*k] != 0).unwrap_or(from);
    }
    rng.random_range(0..bytes.len())
}

/// Changes some bytes of a file, or joins the head of one and the tail of another.
pub fn bytes(seed: &[u8], other: &[u8], rng: &mut Pcg64) -> Vec<u8> {
    let mut out = seed.to_vec();
    let rounds = 1 + (0..6).take_while(|_| rng.random_range(0..2) == 0).count();
    for _ in 0..rounds {
        if out.is_empty() {
            break;
        }
        let at = place(&out, rng);
        let end = (at + rng.random_range(1..=64)).min(out.len());
        match rng.random_range(0..12) {
            0..=2 => out[at] ^= 1 << rng.random_range(0..8),
            3 => out[at] = rng.random_range(0..=255),
            4..=6 => {
                let width = 1 << rng.random_range(0..4);
                let at = if rng.random_range(0..2) == 0 {
                    at
                } else {
                    at / width * width
                };
                let value = WHOLE[rng.random_range(0..WHOLE.len())].to_le_bytes();
                for (byte, new) in out[at..].iter_mut().zip(&value[..width]) {
                    *byte = *new;
                }
            }
            7 => drop(out.drain(at..end)),
            8 => {
                let copy = out[at..end].to_vec();
                let to = rng.random_range(0..out.len());
                out.splice(to..to, copy);
            }
            9 => {
                let to = place(&out, rng);
                let copy = out[at..end].to_vec();
                for (byte, new) in out[to..].iter_mut().zip(copy) {
                    *byte = new;
                }
            }
            10 => out.truncate(at),
            _ if !other.is_empty() => {
                let from = if rng.random_range(0..2) == 0 {
                    at
                } else {
                    rng.random_range(0..other.len())
                };
                out.truncate(at);
                out.extend_from_slice(other.get(from..).unwrap_or_default());
            }
            _ => {}
        }
    }
    out
}
